#include "libdem/simulation/guards.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "libdem/errors.hpp"
#include "tests/dem/grains.hpp"

namespace dem {
namespace {

using testing::HasSubstr;

// One grain, number 42, held between two planes that press it by `overlap` from either side; no gravity, no loss.
Setup between_planes(double radius, double overlap, double step) {
  dem::Setup setup = support::glass_setup(step);
  setup.interactions = {{{1, 0.5, 0, 0}}};
  setup.gravity = Vec3::Zero();
  const double place = radius - overlap;
  setup.walls = {Wall{"left", 0, Plane{Vec3(-place, 0, 0), Vec3::UnitX()}, {}},
                 Wall{"right", 0, Plane{Vec3(place, 0, 0), -Vec3::UnitX()}, {}}};
  return setup;
}

State one_grain(double radius, const Vec3& velocity = Vec3::Zero()) {
  State state;
  state.particles.add(42, 0, radius, Vec3::Zero(), velocity);
  return state;
}

std::string what_stops(Simulation& sim, std::uint64_t steps) {
  try {
    sim.advance(steps);
  } catch (const PhysicsError& e) {
    return e.what();
  }
  return "nothing";
}

constexpr double radius = 0.5e-3, overlap = 1e-6;

struct Frequencies {
  double normal, rotation;  // rad/s
};

// Of the grain between its two planes: sqrt(2 k_n/m) along the normal, sqrt(2 k_t R^2/I) turning, with k_n = 2 E* a and
// k_t = 8 G* a; moved sideways or turned about the normal it is slower.
Frequencies frequencies() {
  const double modulus = 63e9 / (2 * (1 - 0.04)), shear = 63e9 / 2.4 / (2 * 1.8);
  const double a = std::sqrt(radius * overlap), mass = 2500 * sphere_volume(radius);
  return {std::sqrt(4 * modulus * a / mass), std::sqrt(16 * shear * a * 2.5 / mass)};
}

TEST(Guards, TheStepStopsTheRunFromTheLimitOfLeapfrogOn) {
  const double limit = 2 / frequencies().rotation;
  Simulation allowed(between_planes(radius, overlap, 0.999 * limit), one_grain(radius));
  EXPECT_EQ(what_stops(allowed, 10), "nothing");
  Simulation refused(between_planes(radius, overlap, 1.001 * limit), one_grain(radius));
  const std::string why = what_stops(refused, 10);
  EXPECT_THAT(why, HasSubstr("above the stable limit"));
  EXPECT_THAT(why, HasSubstr("grain 42"));
  EXPECT_THAT(why, HasSubstr("t = "));
  EXPECT_THAT(why, testing::AnyOf(HasSubstr("wall 'left'"), HasSubstr("wall 'right'")));

  // Without friction springs only the normal vibration is left.
  const double slower = 2 / frequencies().normal;
  ASSERT_GT(slower, 1.4 * limit);
  dem::Setup smooth = between_planes(radius, overlap, 0.999 * slower);
  smooth.law.tangential = RowOf<Frictionless, TangentialLaws>::value;
  Simulation free(smooth, one_grain(radius));
  EXPECT_EQ(what_stops(free, 10), "nothing");
  smooth.step = 1.001 * slower;
  Simulation unstable(smooth, one_grain(radius));
  EXPECT_THAT(what_stops(unstable, 10), HasSubstr("above the stable limit"));
}

// That the limit is none too low: at nine tenths of it a grain that vibrates by a hundredth of its overlap does so for ever.
// Leapfrog's velocities, taken half a step before the place where the grain is at rest, then swing between
// +- v/cos(phi/2) with sin(phi/2) = w dt/2 = 0.9. The frequency of a Hertz contact depends on the amplitude by a percent or two.
TEST(Guards, BelowTheLimitVibrationsStay) {
  dem::Setup setup = between_planes(radius, overlap, 0.9 * 2 / frequencies().normal);
  setup.law.tangential = RowOf<Frictionless, TangentialLaws>::value;
  const double speed = 0.01 * overlap * frequencies().normal, mass = 2500 * sphere_volume(radius);
  Simulation sim(setup, one_grain(radius, Vec3(speed, 0, 0)));
  double early = 0, late = 0;
  for (int k = 0; k < 20000; ++k) {
    sim.advance(1);
    double& most = k < 10000 ? early : late;
    most = std::max(most, sim.kinetic_energy() / (0.5 * mass * speed * speed));
  }
  const double expected = 1 / (1 - 0.9 * 0.9);
  EXPECT_NEAR(early, expected, 0.05 * expected);
  EXPECT_NEAR(late, expected, 0.05 * expected);
}

TEST(Guards, AMotionThatIsNoNumberStopsTheRun) {
  State state = one_grain(radius);
  state.particles.velocity[0].y() = std::numeric_limits<double>::quiet_NaN();
  Simulation sim(between_planes(radius, overlap, 1e-8), std::move(state));
  const std::string why = what_stops(sim, 5);
  EXPECT_THAT(why, HasSubstr("no longer a number"));
  EXPECT_THAT(why, HasSubstr("grain 42"));
  EXPECT_THAT(why, HasSubstr("likely cause"));
}

TEST(Guards, ARunawayOverlapNamesBothBodies) {
  dem::Setup setup = support::glass_setup(1e-9);
  State pair;
  pair.particles.add(7, 0, radius, Vec3::Zero());
  pair.particles.add(8, 0, radius, Vec3(1.4 * radius, 0, 0));  // an overlap of 0.6 radii
  Simulation sim(setup, std::move(pair));
  const std::string why = what_stops(sim, 5);
  EXPECT_THAT(why, HasSubstr("runaway overlap of 300 um"));
  EXPECT_THAT(why, HasSubstr("grain 7"));
  EXPECT_THAT(why, HasSubstr("grain 8"));

  dem::Setup wall = between_planes(radius, 0.6 * radius, 1e-9);
  Simulation squeezed(wall, one_grain(radius));
  const std::string with = what_stops(squeezed, 5);
  EXPECT_THAT(with, HasSubstr("runaway overlap"));
  EXPECT_THAT(with, HasSubstr("wall 'left'"));
  EXPECT_THAT(with, HasSubstr("grain 42"));
}

// What a run shows of itself after it was stopped is its last state: it can be written and looked at.
TEST(Guards, TheStateThatStoppedTheRunCanStillBeSeen) {
  dem::Setup setup = support::glass_setup();
  setup.high = Vec3(1e-3, 1, 1);
  Particles grains;
  grains.add(42, 0, radius, Vec3::Zero(), Vec3(10, 0, 0));
  State state;
  state.particles = grains;
  Simulation sim(setup, std::move(state));
  EXPECT_THAT(what_stops(sim, 10000), HasSubstr("grain 42"));
  const View last = sim.view();
  EXPECT_GT(last.step, 0u);
  EXPECT_GT(last.position[0].x(), 1e-3);
}

}  // namespace
}  // namespace dem
