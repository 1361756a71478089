#include "libdem/contact/pair_blocks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <random>
#include <set>

#include "tests/dem/pair_scene.hpp"

namespace dem {
namespace {

using support::level, support::random_scene, support::Scene;

TEST(PairBlocks, HoldEveryPairOnceInBlocksOfOneKind) {
  constexpr std::size_t large = RowChunks::many * RowChunks::most_rows;  // a bed of larger chunks
  for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{40}, std::size_t{512}, std::size_t{513},
                              std::size_t{1586}, large + 50}) {
    const Scene s = random_scene(n, n);
    const RowChunks chunks(n);
    const Lanes lanes = order_lanes(s.list, s.table(), 2, level);
    ASSERT_EQ(lanes.size() % PairContacts::width, 0u);
    EXPECT_TRUE(fit(lanes, s.table()));
    std::multiset<std::pair<std::uint32_t, std::uint32_t>> found, expected;
    for (std::size_t k = 0; k < s.list.size(); ++k) expected.emplace(s.list.first[k], s.list.second[k]);
    for (std::size_t b = 0; b < lanes.size(); b += PairContacts::width) {
      const auto chunk = [&](std::uint32_t row) { return row / chunks.rows(); };
      const auto kind = [&](std::size_t k) {
        const auto [i, j] = lanes[k];
        return std::tuple(chunk(i), chunk(i) == chunk(j), std::minmax(s.material[i], s.material[j]), level(i, j));
      };
      for (std::size_t k = b; k < b + PairContacts::width; ++k) {
        const auto [i, j] = lanes[k];
        if (j >= n) {
          ASSERT_GT(k, b) << "a block without a pair";
          ASSERT_EQ(j, n + chunk(i));  // the chunk's own phantom
          ASSERT_EQ(chunk(i), chunk(lanes[b][0]));
          continue;
        }
        ASSERT_EQ(kind(k), kind(b));
        found.emplace(i, j);
      }
    }
    EXPECT_EQ(found, expected) << n << " grains";
  }
}

TEST(PairBlocks, LanesThatDoNotFitAreFound) {
  const Scene s = random_scene(600, 5);
  const Lanes lanes = order_lanes(s.list, s.table(), 2, level);
  const std::size_t last = lanes.size() - PairContacts::width;
  const std::vector<std::function<void(Lanes&)>> damages{
      [](Lanes& l) { l.pop_back(); },
      [](Lanes& l) { std::swap(l[1][0], l[1][1]); },
      [](Lanes& l) { l[2][1] = 600 + 2; },  // the phantom of another chunk
      [](Lanes& l) { l[0][1] = 600; },      // a block that begins with a phantom
      [](Lanes& l) {
        l[3] = {0, 599};
      },  // crosses, its block does not
      [&](Lanes& l) {
        std::swap_ranges(l.begin(), l.begin() + 8, l.begin() + std::ptrdiff_t(last));
      },  // chunks out of order
      [](Lanes& l) { l[4][1] = 4000000000; },
  };
  for (std::size_t k = 0; k < damages.size(); ++k) {
    Lanes damaged = lanes;
    damages[k](damaged);
    EXPECT_FALSE(fit(damaged, s.table())) << "damage " << k;
  }
}

TEST(PairBlocks, KnowTheirConstantsAndWhereTheyCross) {
  const std::size_t n = 1500;
  const Scene s = random_scene(n, 7);
  const Lanes lanes = order_lanes(s.list, s.table(), 2, level);
  const Resolution resolution{.step = 1e-6};
  const PairContacts pairs = make_pair_contacts(lanes, s.table(), s.materials, resolution, true, true);
  EXPECT_EQ(pairs.lanes(), lanes.size());
  EXPECT_EQ(pairs.last.size(), lanes.size());
  EXPECT_EQ(pairs.rolling.size(), pairs.block.size());
  std::map<std::uint32_t, std::uint32_t> crossing;  // row in `crossing`: second grain
  const std::size_t rows = RowChunks(n).rows();
  ASSERT_EQ(pairs.chunk.size(), (n + rows - 1) / rows);
  for (std::size_t c = 0; c < pairs.chunk.size(); ++c)
    for (std::uint32_t b = pairs.chunk[c].begin; b < pairs.chunk[c].end; ++b) {
      LevelScale least{std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity()};
      for (std::uint32_t k = 0; k < PairContacts::width; ++k) {
        const auto [i, j] = lanes[PairContacts::width * b + k];
        const LevelScale scale = level_scale(constants_of(pairs, PairContacts::width * b + k, s.rows, n, s.materials), resolution);
        least = {std::min(least.radius, scale.radius), std::min(least.speed, scale.speed)};
        ASSERT_EQ(pairs.block[b].first[k], i);
        ASSERT_EQ(pairs.block[b].second[k], j);
        ASSERT_EQ(i / rows, c);
        EXPECT_EQ(pairs.block[b].contact_radius[k], 0);
        if (j >= n) continue;
        ASSERT_EQ(b < pairs.chunk[c].inner_end, j / rows == c);
        if (b >= pairs.chunk[c].inner_end) {
          ASSERT_TRUE(crossing.emplace(pairs.kind[b].crossing + k, j).second);
        }
        const PairConstants<double>& kind = s.materials.pair[pairs.kind[b].material_pair];
        EXPECT_EQ(kind.work_of_adhesion, s.materials(s.material[i], s.material[j]).work_of_adhesion);
        const auto body = [&](std::uint32_t row) {
          const double mass = s.rows[row].mass(), radius = s.rows[row].radius();
          return BodyConstants{radius, mass, sphere_inertia(mass, radius)};
        };
        const PairConstants<double> expected = pair_constants(kind, body(i), body(j));
        EXPECT_EQ(pairs.block[b].cube_root[k], expected.cube_root);
        const PairConstants<double> given = constants_of(pairs, PairContacts::width * b + k, s.rows, s.table().size(), s.materials);
        for (const auto member : contact_constants<double>) EXPECT_EQ(given.*member, expected.*member);
        for (const auto member : radius_constants<double>) EXPECT_EQ(given.*member, expected.*member);
      }
      EXPECT_EQ(pairs.kind[b].scale.radius, least.radius);
      EXPECT_EQ(pairs.kind[b].scale.speed, least.speed);
    }
  // Every crossing is announced to the chunk of the second grain, once.
  std::map<std::uint32_t, std::uint32_t> announced;
  for (std::size_t c = 0; c < pairs.chunk.size(); ++c)
    for (std::uint32_t k = pairs.chunk[c].incoming_begin; k < pairs.chunk[c].incoming_end; ++k) {
      EXPECT_EQ(pairs.incoming[k].row / rows, c);
      EXPECT_TRUE(announced.emplace(pairs.incoming[k].crossing, pairs.incoming[k].row).second);
    }
  EXPECT_EQ(announced, crossing);
  EXPECT_GT(crossing.size(), 100u);
}

TEST(PairConstants, CubeRootsAreRoundedOnce) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> exponent(-60, 60);
  long double worst = 0;
  for (int round = 0; round < 100000; ++round) {
    const double x = std::exp2(exponent(random)), root = cube_root(x);
    const long double unit = std::ldexp(1.0L, std::ilogb(root) - 52);
    worst = std::max(worst, std::abs(root - std::cbrt((long double)(x))) / unit);
  }
  // Half a unit in the last place, and what the digits beyond it may be wrong by.
  EXPECT_LT(worst, 0.501L);
  EXPECT_GT(worst, 0.499L);
}

}  // namespace
}  // namespace dem
