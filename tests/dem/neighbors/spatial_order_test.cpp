#include "libdem/neighbors/spatial_order.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "libdem/particles/grain_rows.hpp"

namespace dem {
namespace {

TEST(SpatialOrder, GoesThroughTheEightCellsOfACubeInMortonsOrder) {
  std::vector<Vec3> corners;
  for (int k = 7; k >= 0; --k) corners.emplace_back(k & 1, k >> 1 & 1, k >> 2 & 1);
  EXPECT_THAT(spatial_order(corners, 0.5), testing::ElementsAre(7, 6, 5, 4, 3, 2, 1, 0));
}

TEST(SpatialOrder, IsAPermutationThatKeepsTheOrderWithinACell) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> place(-1, 1);
  std::vector<Vec3> x;
  for (int k = 0; k < 1000; ++k) x.emplace_back(place(random), place(random), place(random));
  x.emplace_back(1e9, 0, 0);  // far beyond the last cell that has a number of its own
  std::vector<std::uint32_t> order = spatial_order(x, 10.0), every(x.size());
  std::iota(every.begin(), every.end(), 0u);
  EXPECT_EQ(order, every);
  order = spatial_order(x, 0.1);
  EXPECT_NE(order, every);
  std::sort(order.begin(), order.end());
  EXPECT_EQ(order, every);
  EXPECT_TRUE(spatial_order({}, 1).empty());
}

// What the order is for: of grains side by side in a cube of 32^3, most are in the same chunk of rows, while in an
// order row by row of the lattice none of the neighbours in z is.
TEST(SpatialOrder, KeepsNeighboursTogether) {
  constexpr std::size_t side = 32;
  std::vector<Vec3> x;
  for (std::size_t k = 0; k < side * side * side; ++k)
    x.emplace_back(double(k % side), double(k / side % side), double(k / side / side));
  const std::vector<std::uint32_t> order = spatial_order(x, 1);
  std::vector<std::size_t> chunk(x.size());
  for (std::size_t r = 0; r < order.size(); ++r) chunk[order[r]] = r / chunk_rows;
  std::size_t together = 0, pairs = 0;
  for (std::size_t k = 0; k + side * side < x.size(); ++k, ++pairs) together += chunk[k] == chunk[k + side * side];
  // A chunk is a block of 8 x 8 x 8 cells: 7 of 8 neighbours along an edge are in it.
  static_assert(chunk_rows == 512);
  EXPECT_NEAR(double(together) / double(pairs), 7.0 / 8.0, 0.05);
}

}  // namespace
}  // namespace dem
