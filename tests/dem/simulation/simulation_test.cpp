#include "libdem/simulation/simulation.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <numeric>
#include <set>

#include "libdem/errors.hpp"
#include "libdem/particles/grain_rows.hpp"
#include "tests/dem/grains.hpp"

namespace dem {
namespace {

State fresh(Particles grains) {
  State state;
  state.particles = std::move(grains);
  return state;
}

// Every byte of what moves and remembers.
void expect_same_bytes(const State& a, const State& b) {
  ASSERT_EQ(a.step, b.step);
  ASSERT_EQ(a.particles.size(), b.particles.size());
  const auto same = [](const std::vector<Vec3>& x, const std::vector<Vec3>& y) {
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(Vec3)) == 0;
  };
  EXPECT_TRUE(same(a.particles.position, b.particles.position));
  EXPECT_TRUE(same(a.particles.velocity, b.particles.velocity));
  EXPECT_TRUE(same(a.particles.angular_velocity, b.particles.angular_velocity));
  EXPECT_TRUE(same(a.force, b.force));
  EXPECT_TRUE(same(a.torque, b.torque));
  ASSERT_EQ(a.pairs.size(), b.pairs.size());
  for (std::size_t k = 0; k < a.pairs.size(); ++k) {
    EXPECT_EQ(a.pairs[k].i, b.pairs[k].i);
    EXPECT_EQ(a.pairs[k].j, b.pairs[k].j);
    EXPECT_EQ(a.pairs[k].spring, b.pairs[k].spring);
    EXPECT_EQ(a.pairs[k].birth_step, b.pairs[k].birth_step);
  }
  ASSERT_EQ(a.wall_pairs.size(), b.wall_pairs.size());
  for (std::size_t k = 0; k < a.wall_pairs.size(); ++k) {
    EXPECT_EQ(a.wall_pairs[k].spring, b.wall_pairs[k].spring);
    EXPECT_EQ(a.wall_pairs[k].feature, b.wall_pairs[k].feature);
  }
}

// A closed box around the origin; one of its sides pushes.
dem::Setup boxed(double half) {
  dem::Setup setup = support::glass_setup(1e-7);
  for (int axis = 0; axis < 3; ++axis)
    for (double side : {-1.0, 1.0}) {
      Vec3 normal = Vec3::Zero();
      normal[axis] = -side;
      setup.walls.push_back(Wall{"side", 0, Plane{-half * normal, normal}, {}});
    }
  setup.walls[0].motion.velocity = Vec3(0.2, 0, 0);
  return setup;
}

// Enough chunks for three threads to take several each, some of which wait for others' forces. Every contact at every step, and at its own rate.
TEST(Simulation, GivesTheSameBytesForAnyNumberOfThreads) {
  const Particles grains = support::packed_cube(12, 1e-7, 0.1, 7);
  ASSERT_GT(RowChunks(grains.size()).count(), 3u);
  for (const std::uint8_t levels : {0, 3}) {
    std::vector<State> ends;
    for (const int threads : {1, 2, 3}) {
      omp_set_num_threads(threads);
      dem::Setup setup = boxed(5.6e-3);
      setup.levels = levels;
      Simulation sim(setup, fresh(grains));
      sim.advance(2000);
      EXPECT_GT(sim.contacts(), 50u);
      ends.push_back(sim.state());
    }
    omp_set_num_threads(1);
    expect_same_bytes(ends[0], ends[1]);
    expect_same_bytes(ends[0], ends[2]);
  }
}

// A wall pushes into grains of which most lie still, so that reaches differ (neighbors/reach.hpp): whatever overlaps by brute force is
// among the contacts, whenever one looks.
TEST(Simulation, ListsMissNoContact) {
  omp_set_num_threads(1);
  for (const std::uint8_t levels : {0, 3}) {
    dem::Setup setup = boxed(7.5e-3);
    setup.levels = levels;
    setup.walls[0].motion.velocity = Vec3(2, 0, 0);
    Simulation sim(setup, fresh(support::packed_cube(16, 1e-7, 0.0, 7)));
    std::size_t unequal = 0, most = 0;
    for (int look = 0; look < 20; ++look) {
      sim.advance(240);
      const State::Layout layout = sim.state().layout;
      unequal += *std::min_element(layout.reach.begin(), layout.reach.end()) < 0.5 * layout.skin;
      const View view = sim.view();
      std::vector<std::pair<std::uint32_t, std::uint32_t>> overlapping, known;
      for (std::uint32_t i = 0; i < view.position.size(); ++i)
        for (std::uint32_t j = i + 1; j < view.position.size(); ++j)
          if ((view.position[j] - view.position[i]).norm() < view.radius[i] + view.radius[j]) overlapping.emplace_back(i, j);
      for (const PairRecord& pair : view.pairs) known.emplace_back(pair.i, pair.j);
      EXPECT_TRUE(std::includes(known.begin(), known.end(), overlapping.begin(), overlapping.end())) << "look " << look;
      most = std::max(most, overlapping.size());
    }
    EXPECT_GT(most, 100u) << int(levels);
    EXPECT_GT(unequal, 3u) << int(levels);
    EXPECT_GT(sim.effort().lists, 3u) << int(levels);
  }
}

// Grains in several chunks that stir long enough for the lists to be built anew between the stops, and right after them.
TEST(Simulation, ContinuesFromAnyStateExactly) {
  omp_set_num_threads(1);
  const Particles grains = support::packed_cube(9, 1e-7, 0.5, 3);
  Simulation whole(boxed(4.2e-3), fresh(grains)), part(boxed(4.2e-3), fresh(grains));
  std::uint64_t built = 0, listed = 0;
  for (const std::uint64_t steps : {1, 16, 700, 1000, 1, 1282, 2000}) {
    part.advance(steps);
    const State state = part.state();
    built += state.layout.listed_step != listed;
    listed = state.layout.listed_step;
    part = Simulation(boxed(4.2e-3), state);
    expect_same_bytes(part.state(), state);
  }
  whole.advance(5000);
  EXPECT_GT(built, 3u);
  EXPECT_GT(whole.contacts(), 10u);
  expect_same_bytes(whole.state(), part.state());
}

// A state of a program that keeps its grains otherwise: the same contacts with the same memory, sums in another order.
TEST(Simulation, ContinuesFromTheStateOfAnotherLayout) {
  omp_set_num_threads(1);
  Simulation first(boxed(4.2e-3), fresh(support::packed_cube(9, 1e-7, 0.1, 3)));
  first.advance(2000);
  State state = first.state();
  state.layout.chunk_rows = 256;
  for (std::uint32_t& second : state.layout.second) second = std::min(second, std::uint32_t(state.particles.size()));  // other phantoms
  Simulation second(boxed(4.2e-3), state);
  first.advance(100);
  second.advance(100);
  const State a = first.state(), b = second.state();
  ASSERT_EQ(a.pairs.size(), b.pairs.size());
  ASSERT_GT(a.pairs.size(), 10u);
  double difference = 0;
  for (std::size_t i = 0; i < a.particles.size(); ++i)
    difference = std::max(difference, (a.particles.position[i] - b.particles.position[i]).norm());
  EXPECT_LT(difference, 1e-15);  // m, of the micrometre that grains have moved
}

// Each step's contacts beside those of the step before: what has gone, and for how many steps it was there. Windows of any length, over
// rebuilt lists and a restart, hold the same counts; contacts of the start count as of unknown age.
TEST(Simulation, CountsHowLongEndedContactsLasted) {
  omp_set_num_threads(1);
  const Particles grains = support::packed_cube(6, 1e-7, 1.0, 11);
  Simulation single(boxed(2.9e-3), fresh(grains)), whole(boxed(2.9e-3), fresh(grains));
  using Key = std::array<std::uint64_t, 3>;  // row, row or wall, birth
  std::set<Key> pairs, wall_pairs;
  EndedContacts ended, ended_with_walls, counted, counted_with_walls;
  const auto note = [](std::set<Key>& before, const std::set<Key>& now, std::uint64_t step, EndedContacts& sum) {
    for (const Key& key : before)
      if (!now.contains(key)) sum.add(key[2], step);
    before = now;
  };
  constexpr std::uint64_t steps = 2500;
  for (std::uint64_t k = 0; k <= steps; ++k) {
    if (k > 0) single.advance(1);
    const View view = single.view();
    std::set<Key> now, now_with_walls;
    for (const PairRecord& c : view.pairs) now.insert({c.i, c.j, c.birth_step});
    for (const WallRecord& c : view.wall_pairs) now_with_walls.insert({c.i, c.wall, c.birth_step});
    note(pairs, now, k, ended);
    note(wall_pairs, now_with_walls, k, ended_with_walls);
  }
  const auto take = [&] {
    const Window window = whole.take_window();
    counted += window.ended_pairs;
    counted_with_walls += window.ended_wall_pairs;
  };
  for (const std::uint64_t stop : {1, 999, 500}) {
    whole.advance(stop);
    take();
  }
  whole = Simulation(whole.setup(), whole.state());
  whole.advance(steps - 1500);
  take();
  EXPECT_EQ(counted.count, ended.count);
  EXPECT_EQ(counted_with_walls.count, ended_with_walls.count);
  // 630 contacts at the start; by now nearly all of them and many others have ended, over several octaves.
  EXPECT_GT(ended.count[EndedContacts::octaves], 300u);
  EXPECT_GT(std::count_if(ended.count.begin(), ended.count.end() - 1, [](std::uint32_t n) { return n > 0; }), 3);
  EXPECT_GT(std::accumulate(ended_with_walls.count.begin(), ended_with_walls.count.end() - 1, 0u), 20u);
}

TEST(Simulation, RefusesAStateThatDoesNotFitTogether) {
  omp_set_num_threads(1);
  Simulation sim(boxed(4.162e-3), fresh(support::packed_cube(9, 1e-7, 0.1, 3)));
  sim.advance(100);
  const State sound = sim.state();
  ASSERT_GT(RowChunks(sound.particles.size()).count(), 1u);
  using Layout = State::Layout;
  const std::vector<std::function<void(Layout&)>> damages{
      [](Layout& l) { l.order[0] = l.order[1]; },
      [](Layout& l) { l.order.back() = 1000000; },
      [](Layout& l) { l.order.pop_back(); },
      [](Layout& l) { l.listed[3].x() = std::nan(""); },
      [](Layout& l) { l.first.pop_back(); },
      [](Layout& l) { l.first[5] = 4000000000; },
      [](Layout& l) { l.second[0] = 4000000000; },
      [](Layout& l) { std::swap(l.first[0], l.second[0]); },
      [](Layout& l) { std::swap(l.first.front(), l.first.back()); },
      [](Layout& l) { l.first.resize(8), l.second.resize(8); },  // contacts without a lane
      [](Layout& l) { l.skin = 0; },
      [](Layout& l) { l.reach.pop_back(); },
      [](Layout& l) { l.reach[3] = -1; },
      [](Layout& l) { l.reach[3] = 2 * l.skin; },
      [](Layout& l) { l.reach[3] = std::nan(""); },
      [](Layout& l) { l.next_look = std::nan(""); },
  };
  for (std::size_t k = 0; k < damages.size(); ++k) {
    State damaged = sound;
    damages[k](damaged.layout);
    EXPECT_THROW(Simulation(sim.setup(), damaged), CaseError) << "damage " << k;
  }
  const std::vector<std::function<void(State&)>> others{
      [](State& s) { s.force.pop_back(); },
      [](State& s) { s.pairs[0].j = 4000000000; },
      [](State& s) { std::swap(s.pairs[0].i, s.pairs[0].j); },
      [](State& s) { std::swap(s.pairs[0], s.pairs[1]); },
      [](State& s) { s.pairs[1] = s.pairs[0]; },
      [](State& s) { s.pairs[0].contact_radius = 0; },
      [](State& s) { s.wall_pairs[0].i = 4000000000; },
      [](State& s) { s.wall_pairs[0].wall = 6; },
      [](State& s) { s.wall_pairs[0].contact_radius = -1; },
      [](State& s) { std::swap(s.wall_pairs.front(), s.wall_pairs.back()); },
  };
  ASSERT_GT(sound.wall_pairs.size(), 1u);
  for (std::size_t k = 0; k < others.size(); ++k) {
    State damaged = sound;
    others[k](damaged);
    EXPECT_THROW(Simulation(sim.setup(), damaged), CaseError) << "damage " << k;
  }
}

// Without walls and gravity momentum changes by rounding only, whatever the grains do to each other.
TEST(Simulation, FreeGrainsKeepLinearAndAngularMomentum) {
  omp_set_num_threads(1);
  dem::Setup setup = support::glass_setup(1e-7);
  setup.gravity = Vec3::Zero();
  Simulation sim(setup, fresh(support::cloud(150, 7e-3, 1.0, 11)));
  const auto momentum = [&sim](double& scale) {
    const View v = sim.view();
    Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
    scale = 0;
    for (std::size_t i = 0; i < v.id.size(); ++i) {
      const double m = 2500 * sphere_volume(v.radius[i]);
      linear += m * v.velocity[i];
      angular += m * v.position[i].cross(v.velocity[i]) + sphere_inertia(m, v.radius[i]) * v.angular_velocity[i];
      scale += m * v.velocity[i].norm();
    }
    return std::make_pair(linear, angular);
  };
  double scale = 0;
  const auto before = momentum(scale);
  const double energy = sim.kinetic_energy();
  sim.advance(20000);
  EXPECT_LT(sim.kinetic_energy(), 0.9 * energy);  // they did collide
  double after_scale = 0;
  const auto after = momentum(after_scale);
  // 20,000 steps of about a hundred additions each, errors adding at random: 1e-16 sqrt(2e6) of the sum of sizes.
  EXPECT_NEAR((after.first - before.first).norm(), 0, 1e-12 * scale);
  EXPECT_NEAR((after.second - before.second).norm(), 0, 1e-12 * scale * 7e-3);
}

// Reference: v = (5/7) v0, any friction: the angular momentum about the line of contact is conserved.
TEST(Simulation, ASlidingGrainEndsRollingAtFiveSeventhsOfItsSpeed) {
  dem::Setup setup = support::glass_setup(2e-8);
  setup.interactions[0][0] = {0.5, 0.5, 0.0, 0.0};
  setup.walls = {Wall{"floor", 0, Plane{}, {}}};
  Particles grains;
  const double radius = 0.4625e-3, v0 = 0.002;
  grains.add(1, 0, radius, Vec3(0, 0, radius), Vec3(v0, 0, 0));
  Simulation sim(setup, fresh(grains));
  sim.advance(200000);  // 4 ms; sliding stops after (2/7) v0/(mu g) = 0.12 ms
  EXPECT_NEAR(sim.view().velocity[0].x(), 5.0 / 7.0 * v0, 2e-3 * v0);  // the grain settles into its weight at first
  EXPECT_NEAR(sim.view().angular_velocity[0].y() * radius, sim.view().velocity[0].x(), 1e-3 * v0);
}

// Reference: dv/dt = -(5/7) mu_r g for a grain that rolls without slip.
TEST(Simulation, RollingFrictionSlowsARollingGrain) {
  dem::Setup setup = support::glass_setup(2e-8);
  setup.interactions[0][0] = {0.5, 0.5, 0.05, 0.0};
  setup.walls = {Wall{"floor", 0, Plane{}, {}}};
  Particles grains;
  const double radius = 0.4625e-3, v0 = 0.01;
  grains.add(1, 0, radius, Vec3(0, 0, radius - 6.4e-10), Vec3(v0, 0, 0), Vec3(0, v0 / radius, 0));
  Simulation sim(setup, fresh(grains));
  sim.advance(50000);  // let it settle into its weight
  const double begin = sim.view().velocity[0].x(), start = sim.time();
  sim.advance(400000);
  const double slowing = (begin - sim.view().velocity[0].x()) / (sim.time() - start);
  EXPECT_NEAR(slowing, 5.0 / 7.0 * 0.05 * 9.81, 0.01 * slowing);
}

// Newton's third law and the power balance at a wall: what the wall puts in is what the grain has gained.
TEST(Simulation, AMovingWallPutsInTheEnergyThatItsGrainGains) {
  dem::Setup setup = support::glass_setup(1e-8);
  setup.gravity = Vec3::Zero();
  setup.interactions[0][0] = {1.0, 0.0, 0.0, 0.0};
  setup.walls = {Wall{"piston", 0, Plane{Vec3::Zero(), Vec3::UnitX()}, {Vec3::Zero(), Vec3(0.3, 0, 0), Vec3::Zero()}}};
  Particles grains;
  const double radius = 0.5e-3, mass = 2500 * sphere_volume(radius);
  grains.add(1, 0, radius, Vec3(radius + 1e-6, 0, 0));
  Simulation sim(setup, fresh(grains));
  sim.take_window();
  sim.advance(4000);
  const Window window = sim.take_window();
  EXPECT_EQ(sim.contacts(), 0u);
  // Elastic: leaves with twice the wall's speed; the tolerance is the step's square over the contact time's.
  EXPECT_NEAR(sim.particles().velocity[0].x(), 0.6, 1e-4);
  const double steps = double(window.last_step - window.first_step);
  EXPECT_NEAR(window.walls[0].power * steps * setup.step, 0.5 * mass * 0.6 * 0.6, 3e-4 * mass);
  EXPECT_NEAR(window.walls[0].force.x() * steps * setup.step, -mass * 0.6, 3e-4 * mass);
  EXPECT_LE(window.walls[0].force_min.x(), window.walls[0].force.x());
}

TEST(Simulation, CompressiveForceIsTheSumOfRepulsiveNormalForces) {
  omp_set_num_threads(1);
  Simulation sim(boxed(2.8e-3), fresh(support::packed_cube(6, 1e-7, 0.1, 5)));
  sim.advance(3000);
  const View v = sim.view();
  std::vector<double> sum(v.id.size());
  for (const PairRecord& c : v.pairs)
    for (const std::uint32_t i : {c.i, c.j}) sum[i] += std::max(c.elastic + c.damping, 0.0);
  for (const WallRecord& c : v.wall_pairs) sum[c.i] += std::max(c.elastic + c.damping, 0.0);
  for (std::size_t i = 0; i < sum.size(); ++i) EXPECT_NEAR(v.compressive_force[i], sum[i], 1e-12 * sum[i]);
}

TEST(Simulation, ALostGrainStopsTheRunWithItsNameAndPlace) {
  dem::Setup setup = support::glass_setup();
  setup.high = Vec3(1e-3, 1, 1);
  Particles grains;
  grains.add(42, 0, 0.5e-3, Vec3(0, 0, 0), Vec3(10, 0, 0));
  Simulation sim(setup, fresh(grains));
  try {
    sim.advance(10000);
    FAIL() << "nothing was thrown";
  } catch (const PhysicsError& e) {
    EXPECT_NE(std::string(e.what()).find("grain 42"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("left the domain"), std::string::npos) << e.what();
  }
}

TEST(Simulation, ARunawayOverlapStopsTheRunWithItsCause) {
  dem::Setup setup = support::glass_setup(1e-5);  // twenty times what is stable
  Particles grains;
  grains.add(1, 0, 0.5e-3, Vec3(0, 0, 0), Vec3(50, 0, 0));
  grains.add(2, 0, 0.5e-3, Vec3(1.1e-3, 0, 0), Vec3(-50, 0, 0));
  Simulation sim(setup, fresh(grains));
  EXPECT_THROW(sim.advance(100), PhysicsError);
}

}  // namespace
}  // namespace dem
