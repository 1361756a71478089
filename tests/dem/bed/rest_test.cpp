#include "libdem/bed/rest.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/dem/grains.hpp"

namespace dem {
namespace {

constexpr double radius = 0.4625e-3, equilibrium = 4.6174936683e-9;

dem::Setup on_a_plane(double tilt_degrees, double adhesion = 0.274) {
  dem::Setup setup = support::glass_setup(1e-7);
  setup.interactions = {{{0.9, 0.5, 0.01, adhesion}}};
  const double tilt = tilt_degrees * std::acos(-1.0) / 180;
  setup.walls = {Wall{"floor", 0, Plane{Vec3::Zero(), Vec3(std::sin(tilt), 0, std::cos(tilt))}, {}}};
  return setup;
}

RestProbe probe_one(const dem::Setup& setup, double height) {
  State state;
  state.particles.add(7, 0, radius, height * std::get<Plane>(setup.walls[0].shape).normal);
  return probe_rest(setup, state);
}

TEST(Rest, AGrainThatHasJustBegunToFallIsUnsupported) {
  const RestProbe probe = probe_one(on_a_plane(0), 2 * radius);
  EXPECT_EQ(probe.unsupported, 1u);
  EXPECT_FALSE(probe.at_rest());
  // It falls freely by a thousandth of its diameter, to the rounding of the interval to whole steps.
  EXPECT_NEAR(probe.free_fall, 2e-3 * radius, 1e-3 * 2e-3 * radius);
  EXPECT_NEAR(probe.largest_displacement / probe.free_fall, 1, 1e-3);
  EXPECT_NEAR(probe.kinetic_energy / probe.rest_scale, 100, 0.5);
}

TEST(Rest, AGrainOnTheFloorIsSupported) {
  const RestProbe probe = probe_one(on_a_plane(0), radius - equilibrium);
  EXPECT_TRUE(probe.at_rest());
  // It trembles by what separates its equilibrium under its weight from that without, some m g/k = 1e-10 m.
  EXPECT_LT(probe.largest_displacement, 0.01 * probe.free_fall);
}

TEST(Rest, OneAdhesiveContactHoldsAGrainThatHangs) {
  EXPECT_TRUE(probe_one(on_a_plane(180), radius - equilibrium).at_rest());
  const RestProbe without = probe_one(on_a_plane(180, 0), radius);
  EXPECT_EQ(without.unsupported, 1u);
}

TEST(Rest, AGrainRollsOffASlope) {
  // Down a slope of 30 degrees it rolls with (5/7) g/2, less the rolling friction, which adhesion makes larger.
  const RestProbe steep = probe_one(on_a_plane(30), radius - equilibrium);
  EXPECT_EQ(steep.unsupported, 1u);
  EXPECT_LT(steep.largest_displacement, 0.36 * steep.free_fall);
  EXPECT_TRUE(probe_one(on_a_plane(1), radius - equilibrium).at_rest());
}

TEST(Rest, NothingIsAtRest) { EXPECT_TRUE(probe_rest(on_a_plane(0), {}).at_rest()); }

}  // namespace
}  // namespace dem
