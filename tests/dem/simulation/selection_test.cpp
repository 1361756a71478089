#include "libdem/simulation/selection.hpp"

#include <gtest/gtest.h>

#include <set>

#include "tests/dem/grains.hpp"

namespace dem {
namespace {

// Every other grain of a pressed cube on a floor: the contacts left are exactly those of which both ends are left.
TEST(Selection, KeepsGrainsAndTheContactsAmongThem) {
  dem::Setup setup = support::glass_setup();
  setup.walls = {Wall{"floor", 0, Plane{Vec3(0, 0, -3 * 0.4625e-3 + 1e-6), Vec3::UnitZ()}, {}}};
  State state;
  state.particles = support::packed_cube(3, 1e-6, 0.01, 1);
  Simulation sim(setup, std::move(state));
  sim.advance(20);
  const State whole = sim.state();
  ASSERT_GT(whole.pairs.size(), 40u);
  ASSERT_GT(whole.wall_pairs.size(), 5u);
  std::vector<bool> keep(whole.particles.size());
  for (std::size_t i = 0; i < keep.size(); ++i) keep[i] = i % 3 != 1;
  const State part = selection(whole, keep);

  using Ids = std::pair<std::uint32_t, std::uint32_t>;
  std::set<Ids> expected, found;
  for (const State::Pair& c : whole.pairs)
    if (c.i % 3 != 1 && c.j % 3 != 1) expected.insert({whole.particles.id[c.i], whole.particles.id[c.j]});
  for (const State::Pair& c : part.pairs) found.insert({part.particles.id[c.i], part.particles.id[c.j]});
  EXPECT_EQ(found, expected);
  EXPECT_EQ(part.particles.size(), 18u);
  EXPECT_EQ(part.step, whole.step);
  std::size_t on_floor = 0;
  for (const State::WallPair& c : whole.wall_pairs) on_floor += c.i % 3 != 1;
  EXPECT_EQ(part.wall_pairs.size(), on_floor);

  // It can be simulated on, and its springs are those of before, turned into the contact's plane of now (by some 1e-6).
  Simulation rest(setup, part);
  EXPECT_EQ(rest.state().pairs.size(), part.pairs.size());
  for (std::size_t k = 0; k < part.pairs.size(); ++k)
    EXPECT_LE((rest.state().pairs[k].spring - part.pairs[k].spring).norm(), 1e-4 * part.pairs[k].spring.norm()) << k;
}

}  // namespace
}  // namespace dem
