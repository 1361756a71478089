#include "libdem/neighbors/spatial_order.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "libdem/particles/grain_rows.hpp"

namespace dem {
namespace {

std::vector<Vec3> random_places(std::size_t count, const Vec3& size) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Vec3> x;
  for (std::size_t k = 0; k < count; ++k) x.emplace_back(Vec3(unit(random), unit(random), unit(random)).cwiseProduct(size));
  return x;
}

TEST(SpatialOrder, GoesFromBothEndsOfARowToItsMiddle) {
  std::vector<Vec3> row;
  std::vector<std::uint32_t> expected;
  for (std::uint32_t k = 0; k < 40; ++k) {
    row.emplace_back(0, 0.5 * k, 0);
    expected.push_back(k < 24 ? k : 63 - k);  // three groups of eight before the cut, two behind it
  }
  EXPECT_EQ(spatial_order(row, 8), expected);
}

TEST(SpatialOrder, IsAPermutationThatDoesNotDependOnTheOrderOfPlaces) {
  std::vector<Vec3> x = random_places(1000, {1, 2, 0.3});
  x.emplace_back(1e9, 0, 0);
  std::vector<std::uint32_t> order = spatial_order(x, 64), every(x.size());
  std::vector<Vec3> sorted, sorted_again;
  for (const std::uint32_t i : order) sorted.push_back(x[i]);
  std::shuffle(x.begin(), x.end(), std::mt19937_64(4));
  for (const std::uint32_t i : spatial_order(x, 64)) sorted_again.push_back(x[i]);
  EXPECT_EQ(sorted, sorted_again);

  std::iota(every.begin(), every.end(), 0U);
  std::sort(order.begin(), order.end());
  EXPECT_EQ(order, every);
  EXPECT_TRUE(spatial_order({}, 64).empty());
  EXPECT_THAT(spatial_order(std::vector<Vec3>(9, Vec3(1, 2, 3)), 2), testing::UnorderedElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8));
}

// Between any two groups there is a plane across an axis, as whoever cuts in two leaves it; also where the last group is not full.
TEST(SpatialOrder, GroupsAreBoxesThatDoNotOverlap) {
  const std::size_t group = 32;
  const std::vector<Vec3> x = random_places(1500, {1, 0.7, 0.2});
  const std::vector<std::uint32_t> order = spatial_order(x, group);
  struct Box {
    Vec3 low, high;
  };
  std::vector<Box> boxes;
  for (std::size_t begin = 0; begin < x.size(); begin += group) {
    Box box{x[order[begin]], x[order[begin]]};
    for (std::size_t r = begin; r < std::min(begin + group, x.size()); ++r) {
      box.low = box.low.cwiseMin(x[order[r]]);
      box.high = box.high.cwiseMax(x[order[r]]);
    }
    boxes.push_back(box);
  }
  for (std::size_t a = 0; a < boxes.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      const auto beyond = [](const Box& one, const Box& other) { return (one.low.array() >= other.high.array()).any(); };
      EXPECT_TRUE(beyond(boxes[a], boxes[b]) || beyond(boxes[b], boxes[a])) << a << ' ' << b;
    }
}

// What the order is for: of grains side by side in a cube of 32^3, most are in the same group of rows, a block of 8^3, while in an
// order row by row of the lattice none of the neighbours in z is.
TEST(SpatialOrder, KeepsNeighboursTogether) {
  constexpr std::size_t side = 32;
  std::vector<Vec3> x;
  for (std::size_t k = 0; k < side * side * side; ++k)
    x.emplace_back(double(k % side), double(k / side % side), double(k / side / side));
  constexpr std::size_t group = 8 * 8 * 8;
  const std::vector<std::uint32_t> order = spatial_order(x, group);
  std::vector<std::size_t> block(x.size());
  for (std::size_t r = 0; r < order.size(); ++r) block[order[r]] = r / group;
  for (const std::size_t next : {std::size_t{1}, side, side * side}) {
    std::size_t together = 0, pairs = 0;
    for (std::size_t k = 0; k + next < x.size(); ++k)
      if (k / next % side + 1 < side) {
        together += block[k] == block[k + next];
        ++pairs;
      }
    // Of 31 neighbours along a row 28 are in one block.
    EXPECT_EQ(31 * together, 28 * pairs) << next;
  }
}

}  // namespace
}  // namespace dem
