#include "libdem/neighbors/spatial_order.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace dem {
namespace {

// The lowest 21 bits, each followed by two zeros.
std::uint64_t spread(std::uint64_t bits) {
  bits &= 0x1fffff;
  bits = (bits | bits << 32) & 0x1f00000000ffff;
  bits = (bits | bits << 16) & 0x1f0000ff0000ff;
  bits = (bits | bits << 8) & 0x100f00f00f00f00f;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
  return (bits | bits << 2) & 0x1249249249249249;
}

}  // namespace

std::vector<std::uint32_t> spatial_order(const std::vector<Vec3>& position, double edge) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  for (const Vec3& x : position) low = low.cwiseMin(x);
  std::vector<std::pair<std::uint64_t, std::uint32_t>> key(position.size());
  for (std::size_t i = 0; i < position.size(); ++i) {
    const Vec3 cell = ((position[i] - low) / edge).cwiseMin(double((1 << 21) - 1));
    key[i] = {
        spread(std::uint64_t(cell.x())) | spread(std::uint64_t(cell.y())) << 1 | spread(std::uint64_t(cell.z())) << 2,
        std::uint32_t(i)};
  }
  std::sort(key.begin(), key.end());
  std::vector<std::uint32_t> order(position.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = key[i].second;
  return order;
}

}  // namespace dem
