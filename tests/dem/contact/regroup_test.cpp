#include "libdem/contact/regroup.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "tests/dem/pair_scene.hpp"

namespace dem {
namespace {

constexpr std::size_t width = PairContacts::width;
constexpr Resolution resolution{.step = 1e-6, .accuracy = 0.2, .highest = 3};

// Contacts as order_lanes() laid them out, after so many have ended and others have formed that no block is full: each block has one
// level, and its pairs remember numbers of their own.
PairContacts rattled(const support::Scene& s, double touching, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> draw(0, 1);
  PairContacts pairs = make_pair_contacts(order_lanes(s.list, s.table(), 2, support::level), s.table(), s.materials, resolution, true, true);
  for (std::size_t b = 0; b < pairs.block.size(); ++b) {
    Activity& activity = pairs.activity[b];
    activity.asleep = draw(random) < 0.5;
    activity.level = std::uint8_t(4 * draw(random));
    activity.wake = draw(random);
    for (std::size_t k = 0; k < width; ++k) {
      if (pairs.block[b].second[k] >= s.table().size() || draw(random) > touching) continue;
      activity.acts = true;
      activity.asleep = false;
      pairs.block[b].contact_radius[k] = draw(random);
      for (auto& column : pairs.block[b].spring) column[k] = draw(random);
      for (auto& column : pairs.rolling[b].torque) column[k] = draw(random);
      pairs.birth_step[width * b + k] = random() % 1000;
      pairs.last[width * b + k].duration = draw(random);
    }
  }
  return pairs;
}

using Pair = std::pair<std::uint32_t, std::uint32_t>;
Pair pair_of(const PairContacts& pairs, std::size_t lane) { return {pairs.first(lane), pairs.second(lane)}; }
Lanes lanes_of(const PairContacts& pairs) {
  Lanes lanes;
  for (std::size_t lane = 0; lane < pairs.lanes(); ++lane) lanes.push_back({pairs.first(lane), pairs.second(lane)});
  return lanes;
}
std::size_t acting(const PairContacts& pairs) {
  return std::size_t(std::count_if(pairs.activity.begin(), pairs.activity.end(), [](const Activity& a) { return a.acts; }));
}

// Everything that a pair of grains has.
auto contents(const PairContacts& pairs, std::size_t grains) {
  std::map<Pair, std::vector<double>> all;
  for (std::size_t lane = 0; lane < pairs.lanes(); ++lane) {
    if (pairs.second(lane) >= grains) continue;
    const std::size_t b = lane / width, k = lane % width;
    std::vector<double> one{double(pairs.kind[b].material_pair), pairs.contact_radius(lane), double(pairs.birth_step[lane]), pairs.last[lane].duration};
    for (const auto& column : pairs.block[b].spring) one.push_back(column[k]);
    for (const auto& column : pairs.rolling[b].torque) one.push_back(column[k]);
    one.push_back(pairs.block[b].cube_root[k]);
    if (pairs.acts(lane)) one.push_back(pairs.activity[b].level);
    EXPECT_TRUE(all.emplace(pair_of(pairs, lane), one).second);
  }
  return all;
}

TEST(Regroup, MovesPairsWithAllTheyHaveIntoFewerBlocks) {
  for (const std::size_t n : {std::size_t{2}, std::size_t{40}, std::size_t{1586}})
    for (const double touching : {0.0, 0.02, 0.3, 1.0}) {
      const support::Scene s = support::random_scene(n, n);
      const PairContacts before = rattled(s, touching, 3);
      PairContacts after = before;
      regroup(after, s.table(), s.materials, resolution);
      EXPECT_EQ(contents(before, n), contents(after, n));
      EXPECT_TRUE(fit(lanes_of(after), s.table()));
      // Full but for the last of each level, kind and chunk, or not moved as little was to be gained.
      std::map<std::tuple<std::size_t, bool, std::uint32_t, int>, std::size_t> contacts;
      for (std::size_t c = 0; c < after.chunk.size(); ++c)
        for (std::uint32_t b = after.chunk[c].begin; b < after.chunk[c].end; ++b)
          for (std::size_t k = 0; k < width; ++k)
            if (after.block[b].contact_radius[k] > 0) ++contacts[{c, b < after.chunk[c].inner_end, after.kind[b].material_pair, after.activity[b].level}];
      std::size_t needed = 0;
      for (const auto& [kind, count] : contacts) needed += (count + width - 1) / width;
      EXPECT_LE(8 * acting(after), 9 * needed) << n << " grains, " << touching;
      if (touching == 0.3 && n > 100) {
        EXPECT_LT(acting(after), 0.6 * double(acting(before)));
      }
      // Again: nothing to do.
      PairContacts again = after;
      regroup(again, s.table(), s.materials, resolution);
      EXPECT_EQ(lanes_of(again), lanes_of(after));
    }
}

// What blocks are known by is what it would be if they had been made so: a run that is resumed makes them anew.
TEST(Regroup, LeavesBlocksAsTheyWouldBeMadeOfTheirLanes) {
  constexpr std::size_t n = 1586;  // four chunks
  const support::Scene s = support::random_scene(n, 4);
  PairContacts pairs = rattled(s, 0.2, 5);
  regroup(pairs, s.table(), s.materials, resolution);
  const PairContacts made = make_pair_contacts(lanes_of(pairs), s.table(), s.materials, resolution, true, true);
  ASSERT_EQ(made.block.size(), pairs.block.size());
  for (std::size_t b = 0; b < made.block.size(); ++b) {
    EXPECT_EQ(pairs.block[b].cube_root, made.block[b].cube_root);
    EXPECT_EQ(pairs.kind[b].material_pair, made.kind[b].material_pair);
    EXPECT_EQ(pairs.kind[b].crossing, made.kind[b].crossing);
    EXPECT_EQ(pairs.kind[b].scale.radius, made.kind[b].scale.radius);
    EXPECT_EQ(pairs.kind[b].scale.speed, made.kind[b].scale.speed);
    EXPECT_EQ(pairs.activity[b].acts, std::any_of(pairs.block[b].contact_radius.begin(), pairs.block[b].contact_radius.end(), [](double a) { return a > 0; }));
  }
  EXPECT_EQ(pairs.crossing.size(), made.crossing.size());
  ASSERT_EQ(pairs.incoming.size(), made.incoming.size());
  for (std::size_t k = 0; k < made.incoming.size(); ++k) {
    EXPECT_EQ(pairs.incoming[k].row, made.incoming[k].row);
    EXPECT_EQ(pairs.incoming[k].crossing, made.incoming[k].crossing);
    EXPECT_EQ(pairs.incoming[k].block, made.incoming[k].block);
  }
  for (std::size_t c = 0; c < made.chunk.size(); ++c) EXPECT_EQ(pairs.chunk[c].senders, made.chunk[c].senders);
}

// A pair that is left alone until the odometer comes to a place is not left alone for longer.
TEST(Regroup, WakesNoPairLater) {
  constexpr std::size_t n = 1586;  // four chunks
  const support::Scene s = support::random_scene(n, 6);
  const PairContacts before = rattled(s, 0.1, 7);
  PairContacts after = before;
  regroup(after, s.table(), s.materials, resolution);
  const auto wakes = [&](const PairContacts& pairs) {
    std::map<Pair, double> at;
    for (std::size_t lane = 0; lane < pairs.lanes(); ++lane) {
      const Activity& a = pairs.activity[lane / width];
      if (pairs.second(lane) < n) at[pair_of(pairs, lane)] = a.asleep && !a.acts ? a.wake : -std::numeric_limits<double>::infinity();
    }
    return at;
  };
  const auto was = wakes(before), is = wakes(after);
  std::size_t moved = 0;
  for (const auto& [pair, wake] : is) {
    EXPECT_LE(wake, was.at(pair));
    moved += wake < was.at(pair);
  }
  EXPECT_LT(moved, was.size());
  for (std::size_t b = 0; b < after.block.size(); ++b) {
    if (after.activity[b].acts) {
      EXPECT_FALSE(after.activity[b].asleep);
    }
  }
}

}  // namespace
}  // namespace dem
