// Tables of one frame -> Snapshot: the columns of foreign data get their meaning here, whatever text they came from.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "libjam/snapshot/formats/table.hpp"
#include "libjam/snapshot/formats/walls.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jam {

struct FrameTables {
  double time = 0;  // s
  Table particles;
  std::optional<Table> pairs, walls, arrays, wall_states;
};

// What a frame says about its map: numbers that a wrong unit, density, gravity or wall motion would spoil.
struct FrameCheck {
  // Force balance |f - m g - sum of contacts| of the particles that touch no recovered wall; particles = 0: not known.
  std::size_t balanced = 0;
  double median_residual = 0, largest_residual = 0;  // N
  ParticleId largest_id = 0;
  double median_load = 0;  // N, median of the summed force magnitudes of the same particles
  // Distance of listed contact points from the triangle they are said to be on, at the pose of the map's motion.
  std::size_t points = 0;
  double largest_point_error = 0;  // m
  double mean_radius = 0;          // m
  bool loads_known = false;        // the whole force on the walls is listed, or given by their contacts
};

// Known fields of every kind of table, in the order in which ordered_fields puts them.
const std::vector<std::string>& known_particle_fields();
const std::vector<std::string>& known_pair_fields();
const std::vector<std::string>& known_wall_fields();
const std::vector<std::string>& known_wall_state_fields();

// Throws DataError (naming the map's origin) where the map contradicts itself: unknown or missing fields, walls of the
// same name, numbers that are not positive, recovered walls without an equation or without total forces.
void check_map(const ImportMap& map);

// Everything that does not change from frame to frame. A gap that the map leaves at zero is measured on the blade
// meshes and the vessel cylinder.
RunInfo run_info(const ImportMap& map);

// The order of a table's fields in `wall_arrays`: id, then 8 a wall that has an array.
std::vector<Field> array_fields(const ImportMap& map);

// Throws DataError naming file, line and value: duplicate or missing particles, contacts of a particle with itself,
// pairs listed twice or much too far apart, unknown walls, facets that the mesh has not. Loads on walls are the sums
// over the frame's contacts, with minus sign, torques about the wall's position, unless they are listed.
Snapshot assemble(const FrameTables& tables, const ImportMap& map, const RunInfo& info, FrameCheck* check = nullptr);

}  // namespace jam
