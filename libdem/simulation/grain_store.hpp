// The grains of a running simulation: in the caller's order, which never changes, and as rows in the order of places in space,
// which changes whenever the lists are built.
#pragma once
#include <cstdint>
#include <vector>

#include "libdem/contact/pair_blocks.hpp"
#include "libdem/particles/grain_rows.hpp"
#include "libdem/particles/particles.hpp"

namespace dem {

struct GrainStore {
  // In the caller's order. Where the grains are and how they move follows the rows at show().
  Particles caller;
  bool shown = true;  // it does; false once rows have moved
  std::vector<double> caller_mass, caller_inertia;  // kg, kg m^2

  // In the order of rows.
  std::vector<std::uint32_t> order;   // the caller's row
  std::vector<std::uint32_t> row_of;  // the inverse: row here of the caller's row
  LargeArray<GrainRow> rows;         // and phantoms
  LargeArray<ForceRow> forces;       // at the end of an advance
  LargeArray<Vec4> spun;             // rad/s, half of the last change of the angular velocity; and phantoms
  std::vector<double> mass, inertia;  // kg, kg m^2
  std::vector<std::uint8_t> material;
  std::vector<std::uint32_t> id;
  std::vector<Vec4> listed;           // m, where the grains were when the lists were built; how far they may go until they must be again
  std::vector<std::uint8_t> level;    // a grain moves at every 2^level-th step, and lies where it will be then
  std::vector<std::uint8_t> asked;    // the level that its contacts ask for; and phantoms

  std::size_t size() const { return caller_mass.size(); }
  RowChunks chunks() const { return RowChunks(size()); }
  GrainTable table() const { return {rows, material}; }
};

GrainStore make_grain_store(Particles particles, const std::vector<Material>& materials);

// Lays the rows out anew: row r is the caller's row order[r]. Forces are zero, `listed` is left to whoever builds the lists.
void lay_out(GrainStore& grains, std::vector<std::uint32_t> order);

// Writes positions and velocities of the rows back into the caller's order, if they have moved since.
void show(GrainStore& grains);

}  // namespace dem
