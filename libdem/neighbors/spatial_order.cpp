#include "libdem/neighbors/spatial_order.hpp"

#include <algorithm>
#include <array>
#include <span>

namespace dem {
namespace {

constexpr std::size_t smallest_part = 4;  // whose order matters no more
constexpr std::size_t worth_a_task = 2000;  // grains

struct Grain {
  Vec3 place;
  std::uint32_t row;
};

// Which end of an axis comes first: not decided before the first cut across it, then for each side of that cut the end that is further
// from it.
enum class First : std::uint8_t { undecided, low, high };
using Directions = std::array<First, 3>;

// By one coordinate, from its low end or its high one, then by the others, then by row.
struct Along {
  int axis;
  bool from_high;
  bool operator()(const Grain& a, const Grain& b) const {
    for (int k = 0; k < 3; ++k)
      if (const int x = (axis + k) % 3; a.place[x] != b.place[x]) return (a.place[x] < b.place[x]) != from_high;
    return a.row < b.row;
  }
};

int longest_axis(std::span<const Grain> grains) {
  Vec3 low = grains.front().place, high = low;
  for (const Grain& grain : grains) {
    low = low.cwiseMin(grain.place);
    high = high.cwiseMax(grain.place);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  return axis;
}

// How many come before the cut: whole groups as long as there are several.
std::size_t first_part(std::size_t count, std::size_t group) {
  if (count <= group) return count / 2;
  const std::size_t groups = (count + group - 1) / group;
  return (groups + 1) / 2 * group;
}

void put_in_order(std::span<Grain> grains, std::size_t group, Directions first) {
  const int axis = longest_axis(grains);
  const First direction = first[std::size_t(axis)];
  const Along along{axis, direction == First::high};
  if (grains.size() <= smallest_part) {
    std::sort(grains.begin(), grains.end(), along);
    return;
  }
  const std::size_t cut = first_part(grains.size(), group);
  std::nth_element(grains.begin(), grains.begin() + std::ptrdiff_t(cut), grains.end(), along);
  Directions before = first, behind = first;
  if (direction == First::undecided) {
    before[std::size_t(axis)] = First::low;
    behind[std::size_t(axis)] = First::high;
  }
  const std::span<Grain> one = grains.first(cut), other = grains.subspan(cut);
#pragma omp task if (one.size() > worth_a_task)
  put_in_order(one, group, before);
  put_in_order(other, group, behind);
}

}  // namespace

std::vector<std::uint32_t> spatial_order(const std::vector<Vec3>& position, std::size_t group) {
  std::vector<Grain> grains(position.size());
  for (std::size_t i = 0; i < grains.size(); ++i) grains[i] = {position[i], std::uint32_t(i)};
#pragma omp parallel if (grains.size() > worth_a_task)
#pragma omp single
  if (!grains.empty()) put_in_order(grains, group, {});
  std::vector<std::uint32_t> order(position.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = grains[i].row;
  return order;
}

}  // namespace dem
