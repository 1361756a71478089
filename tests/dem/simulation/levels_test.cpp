// Contacts that step at their own rate: what is resolved, and that what happens is what happens at a fine uniform step.
#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <set>

#include "libdem/contact/levels.hpp"
#include "libdem/contact/pair_constants.hpp"
#include "libdem/errors.hpp"
#include "libdem/geometry/wall_motion.hpp"
#include "libdem/simulation/simulation.hpp"
#include "tests/dem/stirred_pot.hpp"

namespace dem {
namespace {

constexpr std::uint8_t levels = 4;

State fresh(Particles grains) {
  State state;
  state.particles = std::move(grains);
  return state;
}

dem::Setup with_levels(dem::Setup setup) {
  setup.levels = levels;
  return setup;
}

PairConstants<double> glass_pair(double radius) {
  const dem::Setup setup = support::glass_setup();
  const double mass = 2500 * sphere_volume(radius);
  const BodyConstants body{radius, mass, sphere_inertia(mass, radius)};
  return pair_constants(make_material_table(setup.materials, setup.interactions).pair[0], body, body);
}

TEST(Levels, ResolveWhatTheirFormulaSays) {
  const PairConstants<double> c = glass_pair(0.4625e-3);
  const Resolution r{5e-8, 0.2, 8};
  const LevelScale scale = level_scale(c, r);
  const double mass = c.root_mass * c.root_mass;
  for (std::uint8_t level = 0; level < 8; ++level) {
    const double h = r.step * stride(level);
    EXPECT_EQ(per_stride(level), 1 / stride(level));
    // (1): omega h = 2 accuracy.
    const double radius = std::pow(2 * r.accuracy / h, 2) * mass / (2 * c.effective_modulus);
    EXPECT_TRUE(resolved(level, scale, 0.999 * radius, 0, 1));
    EXPECT_FALSE(resolved(level, scale, 1.001 * radius, 0, 1));
    // (2): the speed whose deepest overlap has omega h = accuracy, from the energy m v^2/2 = (8/15) E* sqrt(R*) d^(5/2).
    const double omega = r.accuracy / h;
    const double deepest_radius = omega * omega * mass / (2 * c.effective_modulus);
    const double depth = deepest_radius * deepest_radius / c.effective_radius;
    const double speed = std::sqrt(16.0 / 15 * c.effective_modulus * std::sqrt(c.effective_radius) * std::pow(depth, 2.5) / mass);
    EXPECT_TRUE(resolved(level, scale, 0, 0.999 * speed, 1));
    EXPECT_FALSE(resolved(level, scale, 0, 1.001 * speed, 1));
    // Half of omega h is half of the step.
    EXPECT_EQ(resolved(level + 1, scale, 0.999 * radius / 4, 0, 0.5), false);
    EXPECT_EQ(resolved(level + 1, scale, 0.999 * radius / 16, 0.999 * speed / 1024, 0.5), true);
  }
}

TEST(Levels, FallAtOnceAndRiseOneByOneWhereTheNextIsDue) {
  const LevelScale scale{1, 1};
  EXPECT_EQ(next_level(4, 0, 9, scale, {0.9, 0, 0}), 0);
  EXPECT_EQ(next_level(4, 4, 2, scale, {0, 0, 0}), 2);
  EXPECT_EQ(next_level(2, 2, 9, scale, {0, 0, 0}), 2);
  EXPECT_EQ(next_level(2, 5, 9, scale, {0, 0, 0}), 3);
  EXPECT_EQ(next_level(2, 5, 2, scale, {0, 0, 0}), 2);
  EXPECT_EQ(next_level(2, 5, 9, scale, {1.0 / 64 * 0.9, 0, 0}), 2) << "no room";
}

struct Impact {
  double peak = 0;  // N
  Vec3 velocity, spin;
};

// Two grains meet obliquely, one of them turning.
Impact collide(const dem::Setup& setup, double speed, double phase) {
  Particles grains;
  grains.add(1, 0, 0.4625e-3, Vec3(-0.4625e-3 - (1 + phase) * 16 * 5e-8 * speed, 0, 0), speed * Vec3(1, 0.4, 0));
  grains.add(2, 0, 0.4e-3, Vec3(0.4e-3, 0, 0), Vec3::Zero(), speed * Vec3(0, 300, 900));
  Simulation sim(setup, fresh(grains));
  const double mass = 2500 * sphere_volume(0.4625e-3), other = 2500 * sphere_volume(0.4e-3);
  const Vec3 before = mass * grains.velocity[0] + other * grains.velocity[1];
  const double longest = 16 * 5e-8 * 8 + 6e-6 * std::pow(speed, -0.2);
  const std::uint64_t unit = std::uint64_t(std::llround(8e-7 / setup.step));
  for (double t = 0; t < 2 * longest; t += 8e-7) sim.advance(unit);
  EXPECT_EQ(sim.contacts(), 0U);
  const Particles& p = sim.particles();
  EXPECT_LT((mass * p.velocity[0] + other * p.velocity[1] - before).norm(), 1e-14 * before.norm());
  return {sim.take_window().largest_compressive_force, p.velocity[0], p.angular_velocity[0]};
}

// How impacts at the speeds of a rheometer differ from those at a tenth of the step: at every phase of the meeting, and at speeds so
// close to each other that some are just slow enough for their level (levels are a factor of 32 apart in speed).
TEST(Levels, ImpactsAreThoseOfAFineStep) {
  for (int s = 0; s <= 16; ++s) {
    const double speed = 0.02 * std::pow(250.0, s / 16.0);
    dem::Setup setup = support::glass_setup(5e-9);
    setup.gravity = Vec3::Zero();
    const Impact reference = collide(setup, speed, 0);
    setup.step = 5e-8;
    for (int k = 0; k < 16; ++k) {
      const Impact impact = collide(with_levels(setup), speed, k / 16.0);
      const double impulse = speed - impact.velocity.x(), right = speed - reference.velocity.x();
      EXPECT_NEAR(impact.peak, reference.peak, 0.005 * reference.peak) << speed << " m/s, phase " << k;
      EXPECT_NEAR(impulse, right, 0.005 * right) << speed << " m/s, phase " << k;
      // The mean duration, impulse over peak force.
      EXPECT_NEAR(impulse / impact.peak, right / reference.peak, 0.005 * right / reference.peak) << speed << " m/s, phase " << k;
    }
  }
}

// A grain between two plates, one of which comes 50 um nearer, sideways at the same time, and goes back.
struct Squeeze {
  double peak = 0;      // N, on the grain
  Vec3 impulse;         // N s, on the moving plate
  double duration = 0;  // s, with more than 20 N
};
Squeeze squeeze(dem::Setup setup) {
  const double radius = 0.4625e-3;
  const auto pose = [&](double x, double gap) -> Vec3 { return Vec3(x, 0, 2 * radius + gap); };
  setup.walls = {Wall{"floor", 0, Plane{}, {}}, Wall{"plate", 0, Plane{Vec3::Zero(), -Vec3::UnitZ()}, {}}};
  const Vec3 apart = pose(0, 1e-6), in = pose(1e-4, -5e-5), out = pose(2e-4, 1e-6);
  setup.walls[1].motion.table = std::make_shared<const PoseTable>(
      std::vector<PoseRow>{{0, apart, {1, 0, 0, 0}}, {2e-4, in, {1, 0, 0, 0}}, {4e-4, out, {1, 0, 0, 0}}});
  Particles grain;
  grain.add(1, 0, radius, Vec3(0, 0, radius));
  Simulation sim(setup, fresh(grain));
  Squeeze result{0, Vec3::Zero(), 0};
  const std::uint64_t unit = std::uint64_t(std::llround(8e-7 / setup.step));
  for (int k = 0; k < 600; ++k) {
    sim.advance(unit);
    const Window window = sim.take_window();
    result.peak = std::max(result.peak, window.largest_compressive_force);
    result.impulse += 8e-7 * window.walls[1].force;
    if (window.largest_compressive_force > 20) result.duration += 8e-7;
  }
  return result;
}

TEST(Levels, ASqueezedGrainIsThatOfAFineStep) {
  dem::Setup setup = support::glass_setup(5e-9);
  const Squeeze right = squeeze(setup);
  EXPECT_GT(right.peak, 100);
  setup.step = 5e-8;
  const Squeeze found = squeeze(with_levels(setup));
  EXPECT_NEAR(found.peak, right.peak, 0.005 * right.peak);
  // Across the plate. Along it acts the rolling resistance, one percent of that, which constant torques at 200 N show in full
  // only at steps far below 5e-8 s: the torque is limited to what stops the spin within a step.
  EXPECT_NEAR(found.impulse.z(), right.impulse.z(), 0.005 * right.impulse.z());
  EXPECT_NEAR(found.duration, right.duration, 0.005 * right.duration + 8.1e-7);
}

// A grain that rolls between a soft floor and a stiff plate that moves: the two contacts wait for different times.
struct Rolled {
  double work = 0, made = 0, resistance = 0;  // J: of the plate, by the time steps, spent by rolling resistance
  std::set<std::uint8_t> levels;              // of its contacts
};
// Once it is squeezed by so much, m, and rolls.
Rolled roll_between_unlike_plates(dem::Setup setup, double overlap) {
  omp_set_num_threads(1);
  setup.keep_ledger = true;
  setup.materials.push_back(setup.materials[0]);
  setup.materials[1].young /= 20;
  setup.interactions.assign(2, std::vector<Interaction>(2, setup.interactions[0][0]));
  const double radius = 0.4625e-3;
  setup.walls = {Wall{"floor", 1, Plane{}, {}}, Wall{"plate", 0, Plane{Vec3::Zero(), -Vec3::UnitZ()}, {}}};
  const auto pose = [&](double x, double gap) -> Vec3 { return Vec3(x, 0, 2 * radius + gap); };
  setup.walls[1].motion.table = std::make_shared<const PoseTable>(std::vector<PoseRow>{
      {0, pose(0, 0), {1, 0, 0, 0}}, {2e-4, pose(0.5e-4, -overlap), {1, 0, 0, 0}}, {2e-3, pose(5e-4, -overlap), {1, 0, 0, 0}}});
  Particles grain;
  grain.add(1, 0, radius, Vec3(0, 0, radius));
  Simulation sim(setup, fresh(grain));
  const auto steps = [&](double time) { return std::uint64_t(std::llround(time / setup.step)); };
  sim.advance(steps(4e-4));
  Rolled result;
  const Ledger before = sim.ledger();
  for (int k = 0; k < 100; ++k) {
    sim.advance(steps(1.28e-5));
    for (const State::WallPair& contact : sim.state().wall_pairs) result.levels.insert(contact.level);
  }
  const Ledger after = sim.ledger();
  result.work = after.work() - before.work();
  result.made = after.spent.time_stepping - before.spent.time_stepping;
  result.resistance = after.spent.rolling - before.spent.rolling;
  return result;
}

// What the time steps make must be small against the work that rolling takes; with springs stretched by the last velocity and not the mean it
// was 1.4 % of it here, and more than all of it in a jam of some hundred newtons.
TEST(Levels, AGrainRolledBetweenUnlikePlatesMakesNoEnergy) {
  const Rolled own = roll_between_unlike_plates(with_levels(support::glass_setup()), 2e-5);
  EXPECT_GT(own.levels.size(), 1U) << "both contacts at the same level show nothing";
  EXPECT_GT(own.work, 0);
  EXPECT_GT(own.resistance, 0.5 * own.work);
  EXPECT_NEAR(own.made, 0, 0.001 * own.work);
}

// A constant torque may take only a share of the spin, here far less than it would: the share of the run's step, though one of the contacts
// steps at half that rate. By the contact's own step it would resist with three quarters.
TEST(Levels, AGrainIsResistedFromRollingAsAtEveryStep) {
  const dem::Setup setup = support::glass_setup(1e-7);
  const Rolled every = roll_between_unlike_plates(setup, 4e-5), own = roll_between_unlike_plates(with_levels(setup), 4e-5);
  EXPECT_EQ(own.levels, (std::set<std::uint8_t>{0, 1}));
  EXPECT_NEAR(own.resistance, every.resistance, 0.005 * every.resistance);  // as impacts are
  EXPECT_NEAR(own.work, every.work, 0.005 * every.work);
  const Rolled finer = roll_between_unlike_plates(support::glass_setup(5e-8), 4e-5);
  EXPECT_NEAR(finer.resistance, 2 * every.resistance, 0.1 * every.resistance) << "else the share does not limit it";
}

TEST(Levels, FreeGrainsKeepTheirMomentum) {
  omp_set_num_threads(1);
  dem::Setup setup = with_levels(support::glass_setup());
  setup.gravity = Vec3::Zero();
  const Particles grains = support::cloud(300, 10e-3, 0.5, 5);
  Simulation sim(setup, fresh(grains));
  const auto momentum = [](const Particles& p) {
    Vec3 sum = Vec3::Zero();
    double size = 0;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const Vec3 mv = 2500 * sphere_volume(p.radius[i]) * p.velocity[i];
      sum += mv;
      size += mv.norm();
    }
    return std::pair(sum, size);
  };
  const auto [before, size] = momentum(grains);
  sim.advance(80000);
  EXPECT_GT(sim.effort().evaluations.blocks, 1000U);
  EXPECT_LT((momentum(sim.particles()).first - before).norm(), 1e-13 * size);
}

TEST(Levels, TheLedgerClosesAndTheNumericalErrorStaysSmall) {
  omp_set_num_threads(1);
  Simulation sim(with_levels(support::stirred_pot()), fresh(support::grains_below_the_paddle()));
  Simulation uniform(support::stirred_pot(), fresh(support::grains_below_the_paddle()));
  sim.advance(20000);
  uniform.advance(20000);
  const Ledger l = sim.ledger(), u = uniform.ledger();
  const double moved = l.work_put_in() + l.initial - l.stored.total();
  EXPECT_NEAR(l.residual(), 0, 1e-11 * moved);
  EXPECT_LT(std::abs(l.spent.time_stepping), 0.01 * moved);
  EXPECT_LT(std::abs(l.spent.time_stepping), 3 * std::abs(u.spent.time_stepping)) << "made by levels, not by the step";
  EXPECT_LT(double(sim.effort().evaluations.blocks), 0.6 * double(sim.effort().evaluations.blocks_at_every_step));
}

void expect_same(const State& a, const State& b) {
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.particles.position, b.particles.position);
  EXPECT_EQ(a.particles.velocity, b.particles.velocity);
  EXPECT_EQ(a.particles.angular_velocity, b.particles.angular_velocity);
  EXPECT_EQ(a.force, b.force);
  EXPECT_EQ(a.torque, b.torque);
  EXPECT_EQ(a.layout.order, b.layout.order);
  EXPECT_EQ(a.layout.grain_level, b.layout.grain_level);
  EXPECT_EQ(a.layout.block_level, b.layout.block_level);
  EXPECT_EQ(a.layout.foresight, b.layout.foresight);
  ASSERT_EQ(a.pairs.size(), b.pairs.size());
  for (std::size_t k = 0; k < a.pairs.size(); ++k) {
    EXPECT_EQ(a.pairs[k].spring, b.pairs[k].spring);
    EXPECT_EQ(a.pairs[k].level, b.pairs[k].level);
  }
  EXPECT_EQ(a.wall_pairs.size(), b.wall_pairs.size());
  EXPECT_EQ(a.ledger.wall_work, b.ledger.wall_work);
  EXPECT_EQ(a.ledger.spent.time_stepping, b.ledger.spent.time_stepping);
}

TEST(Levels, AnyNumberOfThreadsAndAnyRestartGiveTheSameBytes) {
  dem::Setup setup = with_levels(support::stirred_pot());
  std::vector<State> ends;
  for (const int threads : {1, 2, 3}) {
    omp_set_num_threads(threads);
    Simulation sim(setup, fresh(support::grains_below_the_paddle()));
    sim.advance(8000);
    ends.push_back(sim.state());
  }
  omp_set_num_threads(1);
  expect_same(ends[0], ends[1]);
  expect_same(ends[0], ends[2]);
  Simulation part(setup, fresh(support::grains_below_the_paddle()));
  std::ptrdiff_t quiet = 0, quiet_at_walls = 0;
  for (const std::uint64_t steps : {16, 160, 2000, 1024, 16, 3200, 1584}) {
    part.advance(steps);
    const State::Layout before = part.state().layout;
    part = Simulation(setup, part.state());
    const State::Layout after = part.state().layout;
    EXPECT_EQ(before.first, after.first);
    EXPECT_EQ(before.second, after.second);
    EXPECT_EQ(before.block_level, after.block_level);
    EXPECT_EQ(before.block_wake, after.block_wake);
    EXPECT_EQ(before.block_quiet, after.block_quiet);
    const auto count_quiet = [](const std::vector<std::uint32_t>& until) { return std::ranges::count_if(until, [](std::uint32_t k) { return k > 0; }); };
    quiet += count_quiet(after.block_quiet);
    quiet_at_walls += count_quiet(after.wall_quiet);
  }
  EXPECT_GT(quiet, 10);
  EXPECT_GT(quiet_at_walls, 10);
  expect_same(part.state(), ends[0]);
}

TEST(Levels, RefuseWhatTheyCannotDo) {
  dem::Setup setup = with_levels(support::glass_setup());
  Particles grain;
  grain.add(1, 0, 1e-3, Vec3::Zero());
  Simulation sim(setup, fresh(grain));
  EXPECT_THROW(sim.advance(8), CaseError);
  sim.advance(32);
  State state = sim.state();
  state.step = 40;
  EXPECT_THROW(Simulation(setup, state), CaseError);
  state.step = 32;
  state.layout.grain_level[0] = 77;
  EXPECT_THROW(Simulation(setup, state), CaseError);
  setup.levels = most_levels + 1;
  EXPECT_THROW(Simulation(setup, fresh(grain)), CaseError);
  setup.levels = 2;
  setup.accuracy = 0;
  EXPECT_THROW(Simulation(setup, fresh(grain)), CaseError);
}

}  // namespace
}  // namespace dem
