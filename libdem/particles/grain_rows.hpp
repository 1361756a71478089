// How a running simulation keeps its grains: as rows that a contact loads whole, in the order of places in space (spatial_order
// in libdem/neighbors), so that grains that touch lie close to each other in memory.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "libdem/case/case.hpp"
#include "libdem/particles/large_pages.hpp"

namespace dem {

using Vec4 = Eigen::Matrix<double, 4, 1>;
inline Vec4 quad(const Vec3& v, double fourth) { return {v.x(), v.y(), v.z(), fourth}; }

// What moves a grain and where it is.
struct alignas(64) GrainRow {
  Vec4 place = Vec4::Zero();   // m: centre, radius
  Vec4 motion = Vec4::Zero();  // m/s: velocity, half a step before the place; then 1/m: one over the radius
  Vec4 spin = Vec4::Zero();    // rad/s: angular velocity, likewise; then kg: mass
  Vec4 arrival = Vec4::Zero();  // m/s: velocity at the place if the acceleration has stayed what it was at the place before;
                                // then 2^-level of the grain, 0 where all grains are due at every step
  auto position() const { return place.head<3>(); }
  auto velocity() const { return motion.head<3>(); }
  auto angular_velocity() const { return spin.head<3>(); }
  double radius() const { return place[3]; }
  double mass() const { return spin[3]; }
};

// What acts on a grain.
struct alignas(64) ForceRow {
  Vec4 force = Vec4::Zero();   // N: sum of the contacts' forces; then their compressive parts
  Vec4 torque = Vec4::Zero();  // N m; then 0
};

// Rows are handled in chunks of so many. What a chunk's contacts do to its own grains is summed by whoever handles the chunk, in
// a fixed order, so that sums do not depend on the number of threads. Behind the last grain stands one phantom per chunk,
// infinitely far away in effect: what fills blocks of contacts up. In the order of space a chunk is a box, about 8 grains wide: pairs that
// cross chunks cost more than others.
inline constexpr std::size_t chunk_rows = 512;
inline std::size_t chunks_of(std::size_t grains) { return (grains + chunk_rows - 1) / chunk_rows; }
inline GrainRow phantom() {
  GrainRow row;
  row.place = {1e30, 0, 0, 1};
  row.motion = {0, 0, 0, 1};
  row.spin = {0, 0, 0, 1};
  return row;
}

// What acts on the grains of a chunk.
using ForceSheet = std::array<ForceRow, chunk_rows>;

}  // namespace dem
