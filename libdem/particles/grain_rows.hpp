// How a running simulation keeps its grains: as rows that a contact loads whole, in the order of places in space (spatial_order
// in libdem/neighbors), so that grains that touch lie close to each other in memory.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
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

// Rows are handled in chunks. What a chunk's contacts do to its own grains is summed by whoever handles the chunk, in a fixed order, so
// that sums do not depend on the number of threads. Behind the last grain stands one phantom per chunk, infinitely far away in effect: what
// fills blocks of contacts up. In the order of space a chunk is a box: pairs that cross chunks cost more than others, and are the fewer the
// larger chunks are; but threads want many to share. So a chunk has the largest power of two of rows that leaves at least `many` chunks,
// within bounds: below them too many pairs would cross, above them a chunk's rows and forces would not fit a second-level cache.
class RowChunks {
 public:
  static constexpr std::size_t least_rows = 512, most_rows = 2048;
  static constexpr std::size_t many = 64;
  static constexpr std::size_t few = 3;  // below this many waking other threads costs more than they save

  explicit RowChunks(std::size_t grains)
      : grains_(grains), bits_(std::bit_width(std::clamp(grains / many, least_rows, most_rows)) - 1) {}
  std::size_t rows() const { return std::size_t{1} << bits_; }
  std::size_t count() const { return (grains_ + rows() - 1) >> bits_; }
  std::size_t of(std::size_t row) const { return row >> bits_; }
  std::size_t place(std::size_t row) const { return row & (rows() - 1); }  // in its chunk; of a phantom any
  std::size_t begin(std::size_t chunk) const { return chunk << bits_; }
  std::size_t end(std::size_t chunk) const { return std::min(begin(chunk + 1), grains_); }

 private:
  std::size_t grains_;
  int bits_;
};
inline GrainRow phantom() {
  GrainRow row;
  row.place = {1e30, 0, 0, 1};
  row.motion = {0, 0, 0, 1};
  row.spin = {0, 0, 0, 1};
  return row;
}

// What acts on the grains of a chunk.
using ForceSheet = std::array<ForceRow, RowChunks::most_rows>;

}  // namespace dem
