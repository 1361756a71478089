#include "libdem/case/derived.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "tests/dem/case/ft4.hpp"

namespace dem {
namespace {

using std::numbers::pi;

// Relative comparison, two-sided.
void expect_ratio(double value, double expected, double tolerance, const char* what) {
  EXPECT_NEAR(value / expected, 1, tolerance) << what << ": " << value << ", expected " << expected;
}

TEST(Derived, MotionFollowsTheHelix) {
  const Derived d = derive(ft4('a'));
  // Printed to six digits in the reference calculation.
  expect_ratio(d.axial_velocity, -21.7889e-3, 1e-5, "u");
  expect_ratio(d.angular_velocity, 21.1956, 1e-5, "omega");
  expect_ratio(d.travel, 43.578e-3, 1e-4, "travel");
  expect_ratio(d.turns, 6.747, 1e-4, "turns");
  // u and omega make up the tip speed again.
  EXPECT_NEAR(std::hypot(d.axial_velocity, d.angular_velocity * 11.75e-3), 0.25, 1e-15);
  EXPECT_NEAR(d.end_height, 52e-3 - d.travel, 1e-15);
  EXPECT_NEAR(d.gap, 0.75e-3, 1e-15);
  expect_ratio(d.gap_over_d90, 0.70, 0.01, "gap / D90");
}

TEST(Derived, EffectiveModuliOfThePaper) {
  expect_ratio(derive(ft4('a')).modulus, 3.28125e10, 1e-12, "E* A");
  expect_ratio(derive(ft4('a')).modulus_vessel, 3.28125e10, 1e-12, "E* A, vessel");
  expect_ratio(derive(ft4('a')).modulus_blade, 5.109489051095e10, 1e-12, "E* A, blade");
  expect_ratio(derive(ft4('b')).modulus, 3.28125e7, 1e-12, "E* B");
}

TEST(Derived, PullOffForceBondAndCohesionOfThePaper) {
  expect_ratio(derive(ft4('a')).pull_off_force, 2.985887467696e-4, 1e-12, "F_c A");
  // Four and five digits are what the reference prints.
  expect_ratio(derive(ft4('a')).bond, 58.76, 1e-4, "Bond A");
  expect_ratio(derive(ft4('b')).bond, 58.76, 1e-4, "Bond B");
  expect_ratio(derive(ft4('c')).bond, 3.707, 2e-4, "Bond C");
  expect_ratio(derive(ft4('a')).cohesion, 2.3269e-4, 3e-5, "Cohesion A");
  expect_ratio(derive(ft4('b')).cohesion, 2.3269e-2, 3e-5, "Cohesion B");
  // Scaling W with E^(2/5) keeps the cohesion number exactly.
  expect_ratio(derive(ft4('c')).cohesion, derive(ft4('a')).cohesion, 1e-12, "Cohesion C");
  // With the paper's rounded 0.017 J/m2 instead.
  Case rounded = ft4('c');
  rounded.interactions[0][0].work_of_adhesion = 0.017;
  expect_ratio(derive(rounded).cohesion, 2.2626e-4, 3e-5, "Cohesion C, rounded");
  expect_ratio(derive(rounded).pull_off_force, 1.852557917914e-5, 1e-12, "F_c C, rounded");
  expect_ratio(derive(rounded).bond, 3.646, 2e-4, "Bond C, rounded");
}

TEST(Derived, RayleighTimesAreThoseOfMeanAndSmallestGrain) {
  const Derived d = derive(ft4('a'));
  expect_ratio(d.rayleigh_mean, 4.932e-7, 2e-4, "T_R, mean");
  expect_ratio(d.rayleigh_smallest, 3.945e-7, 2e-4, "T_R, smallest");
  expect_ratio(d.step_over_rayleigh_mean, 0.101, 5e-3, "step / T_R, mean");
  expect_ratio(d.step_over_rayleigh_smallest, 0.127, 5e-3, "step / T_R, smallest");
  // T_R scales with the root of the stiffness: 0.40 % in test B.
  expect_ratio(derive(ft4('b')).step_over_rayleigh_smallest, d.step_over_rayleigh_smallest / std::sqrt(1000), 1e-12,
               "step / T_R, B");
}

TEST(Derived, HertzContactTimeMatchesTheIntegratedImpact) {
  expect_ratio(derive(ft4('a')).contact_time, 3.84e-6, 2e-3, "t_c A");
  expect_ratio(derive(ft4('b')).contact_time, 6.09e-5, 2e-3, "t_c B");
  // Chung and Ooi, test 1: glass spheres of 10 mm radius, 20 m/s; a closed form printed to seven digits.
  const Material glass{"glass", 2800, 48e9, 0.2};
  const double mass = glass.density * 4.0 / 3.0 * pi * 1e-6;
  expect_ratio(hertz_contact_time(mass / 2, 5e-3, effective_modulus(glass, glass), 20), 4.033945e-5, 1e-6, "test 1");
}

TEST(Derived, ForceOfAGrainSqueezedInTheGap) {
  const Case a = ft4('a'), b = ft4('b');
  // Diameter (mm), force (N) in test A and in B; the table gives three digits.
  const double table[][3] = {
      {0.80, 134, 0.149}, {0.85, 392, 0.433}, {0.925, 946, 1.05}, {1.00, 1679, 1.86}, {1.11, 3056, 3.38}};
  for (const auto& [d, force_a, force_b] : table) {
    expect_ratio(squeeze(a.materials[0], a.materials[1], a.materials[0], d * 1e-3, 0.75e-3).force, force_a, 5e-3, "A");
    expect_ratio(squeeze(b.materials[0], b.materials[1], b.materials[0], d * 1e-3, 0.75e-3).force, force_b, 5e-3, "B");
  }
  const Squeeze s = derive(a).mean_in_gap;
  expect_ratio(s.normal_stiffness, 3.3e7, 0.01, "k");   // two digits in the reference
  expect_ratio(s.critical_step, 2.0e-7, 0.03, "t_cr");  // two digits in the reference
  EXPECT_EQ(squeeze(a.materials[0], a.materials[1], a.materials[0], 0.74e-3, 0.75e-3).force, 0);
}

// A grain on the vessel (flat) that touches the tip's edge, `gap` away from the vessel: the line through both points leans against both
// normals by the angle whose tangent friction must hold.
double friction_to_hold(double diameter, double gap) {
  const double radius = diameter / 2;
  const Eigen::Vector2d centre(0, radius), on_vessel(0, 0), edge(std::sqrt(radius * radius - (radius - gap) * (radius - gap)), gap);
  const Eigen::Vector2d line = (edge - on_vessel).normalized(), normal = (centre - on_vessel).normalized(), other = (edge - centre).normalized();
  EXPECT_NEAR(line.dot(normal), line.dot(other), 1e-12);
  return std::tan(std::acos(line.dot(normal)));
}

TEST(Derived, FrictionDrawsGrainsIntoTheGapUpToADiameter) {
  Case c = ft4('a');
  const Derived d = derive(c);
  expect_ratio(friction_to_hold(d.drawn_in, 0.75e-3), 0.3, 1e-9, "mu");  // of glass on steel; on the vessel of glass it is 0.5
  EXPECT_EQ(d.entrance, d.gap);
  expect_ratio(d.drawn_in_share, (1.09 * 0.75 - 0.75) / (1.11 - 0.74), 1e-9, "share");  // sizes even by number from 0.74 to 1.11 mm
  EXPECT_EQ(d.largest_in_gap.force, squeeze(c.materials[0], c.materials[1], c.materials[0], d.drawn_in, d.gap).force);

  // Nothing is drawn in without friction, nor where all grains are larger than friction can hold or fit through the gap; with more
  // friction than the largest grain needs, that one is the limit.
  const auto with = [&](double on_blade, double on_vessel, double blade_diameter) {
    Case other = c;
    const std::size_t glass = material_index(c, "glass"), steel = material_index(c, "steel");
    other.interactions[glass][steel].friction = other.interactions[steel][glass].friction = on_blade;
    other.interactions[glass][glass].friction = on_vessel;
    std::get<TwistedBlade>(other.blade.shape).diameter = blade_diameter;
    return derive(other);
  };
  EXPECT_EQ(with(0, 0.5, 23.5e-3).largest_in_gap.force, 0);
  EXPECT_EQ(with(0.3, 0.5, 24.0e-3).largest_in_gap.force, 0);
  EXPECT_EQ(with(0.3, 0.5, 22.0e-3).largest_in_gap.force, 0);
  expect_ratio(with(0.5, 0.3, 23.5e-3).drawn_in, d.drawn_in, 1e-12, "the smaller friction");
  EXPECT_EQ(with(0.9, 0.9, 23.5e-3).largest_in_gap.force, squeeze(c.materials[0], c.materials[1], c.materials[0], d.largest_diameter, d.gap).force);

  // Flat tips with corners as far out: 0.9483 mm in their middle, by hand from R = 11.75, t = 1.5, h = 6 mm, beta = 30 deg.
  std::get<TwistedBlade>(c.blade.shape).tip_cut = TwistedBlade::TipCut::flat;
  const Derived flat = derive(c);
  EXPECT_EQ(flat.gap, d.gap);
  expect_ratio(flat.entrance, 0.9482872e-3, 1e-6, "entrance");
  expect_ratio(friction_to_hold(flat.drawn_in, flat.entrance), 0.3, 1e-9, "mu");
  EXPECT_GT(flat.largest_in_gap.force, 7 * d.largest_in_gap.force);  // of a squeeze 4 times as deep, Hertz
}

TEST(Derived, SqueezeStiffnessIsTheDerivativeOfItsForce) {
  const Case c = ft4('a');
  const auto force = [&](double d) {
    return squeeze(c.materials[0], c.materials[0], c.materials[0], d, 0.75e-3).force;
  };
  const double d = 0.9e-3, h = 1e-9;
  // Equal walls: closing the gap by x makes each overlap x/2, so dF/dgap = -k/4 with k the sum of both contacts. The
  // radius is that of the grain, so vary the gap and not the grain.
  const auto force_at = [&](double gap) {
    return squeeze(c.materials[0], c.materials[0], c.materials[0], d, gap).force;
  };
  const double slope = (force_at(0.75e-3 - h) - force_at(0.75e-3 + h)) / (2 * h);
  expect_ratio(4 * slope, squeeze(c.materials[0], c.materials[0], c.materials[0], d, 0.75e-3).normal_stiffness, 1e-6,
               "k");  // central difference
  EXPECT_GT(force(0.91e-3), force(0.9e-3));
}

TEST(Derived, BedOfThePaperHolds33To38ThousandGrains) {
  const Derived d = derive(ft4('a'));
  expect_ratio(d.grains_loose, 33.2e3, 5e-3, "loose");
  expect_ratio(d.grains_dense, 37.9e3, 5e-3, "dense");
  EXPECT_GT(d.grains, d.grains_loose);
  EXPECT_LT(d.grains, d.grains_dense);
}

TEST(Derived, EqualGrainsAreALimitOfTheSizeDistribution) {
  Case c = ft4('a');
  c.bed.size_low = c.bed.size_high = 1;
  const double bed = pi / 4 * 25e-3 * 25e-3 * 52e-3, grain = pi / 6 * std::pow(0.925e-3, 3);
  expect_ratio(derive(c).grains, 0.6 * bed / grain, 1e-12, "grains");
}

TEST(Derived, CountsStepsFramesAndBytes) {
  const Derived d = derive(ft4('a'));
  EXPECT_EQ(d.steps, 4e7);
  EXPECT_EQ(d.frames, 1001);  // 500 Hz for 2 s, both ends
  EXPECT_EQ(d.series_rows, 20000);
  EXPECT_EQ(d.checkpoints, 100);
  // A trial with 36 864 grains and 107 264 contacts took 4.13 MB per frame; this bed has fewer contacts and counts
  // walls.
  expect_ratio(d.bytes_per_frame / d.grains, 4.13e6 / 36864, 0.6, "bytes per grain");
}

}  // namespace
}  // namespace dem
