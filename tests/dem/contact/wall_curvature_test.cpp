#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "libdem/contact/pair_constants.hpp"
#include "libdem/simulation/simulation.hpp"
#include "tests/dem/grains.hpp"

namespace dem {
namespace {

// Force of an elliptical Hertz contact at a unit overlap, with the bodies' relative principal curvatures 1/r1 >= 1/r2, over that
// of a circular contact of curvature 1/R: F = (4/3) E* sqrt(R) d^(3/2). Exact: with eccentricity e of the ellipse of half axes
// a >= b, d = (3 F / (2 pi a E*)) K(e), 1/r1 and 1/r2 over (3 F/(pi E* a^3)) are B = (E/(1-e^2) - K)/e^2 and A = (K - E)/e^2
// (Johnson, Contact Mechanics, eq. 4.25 to 4.30, 1/r = 2A there).
double exact_force(double r1, double r2, double modulus, double overlap) {
  double low = 1e-9, high = 1 - 1e-9;
  const auto A = [](double e) { return (std::comp_ellint_1(e) - std::comp_ellint_2(e)) / (e * e); };
  const auto B = [](double e) { return (std::comp_ellint_2(e) / (1 - e * e) - std::comp_ellint_1(e)) / (e * e); };
  while (high - low > 1e-12) {
    const double e = 0.5 * (low + high);
    (B(e) / A(e) < r2 / r1 ? low : high) = e;
  }
  const double e = 0.5 * (low + high);
  // With s = 3F/(2 pi E*): d = s K/a and 1/(2 r2) = s A/a^3, so a^2 = 2 r2 d A/K.
  const double a = std::sqrt(2 * r2 * overlap * A(e) / std::comp_ellint_1(e));
  return 2 * std::numbers::pi * modulus / 3 * overlap * a / std::comp_ellint_1(e);
}

TEST(WallCurvature, EffectiveRadiusGivesTheForceOfTheExactEllipticalContact) {
  PairConstants<double> flat{};
  flat.effective_modulus = 1e9;
  flat.effective_radius = 1e-3;
  const double overlap = 1e-6;
  const auto force = [&](const PairConstants<double>& c) {
    return 4.0 / 3.0 * c.effective_modulus * std::sqrt(c.effective_radius) * std::pow(overlap, 1.5);
  };
  // A sphere of 1 mm in and on cylinders: the geometric mean of the curvatures is off by second order in their difference.
  for (const double cylinder : {27e-3, 10e-3, 4e-3, -27e-3, -4e-3}) {
    const double across = 1 / (1 / 1e-3 - 1 / cylinder), along = 1e-3;
    const double exact = exact_force(std::min(across, along), std::max(across, along), 1e9, overlap);
    const double bound = std::pow(std::log(across / along), 2) / 16;
    EXPECT_NEAR(force(on_curved_wall(flat, {1 / cylinder, 0})) / exact, 1, bound) << cylinder;
    EXPECT_GT(std::abs(force(flat) / exact - 1), 2 * bound) << cylinder << ": a flat wall would do as well";
  }
  // In a sphere: 1/R* = 1/R - 1/Rs exactly.
  const PairConstants<double> ball = on_curved_wall(flat, {1 / 5e-3, 1 / 5e-3});
  EXPECT_NEAR(ball.effective_radius, 1 / (1 / 1e-3 - 1 / 5e-3), 1e-18);
}

TEST(WallCurvature, AdhesionLengthFollowsTheEffectiveRadius) {
  PairConstants<double> flat{};
  flat.effective_modulus = 3.28125e10;
  flat.work_of_adhesion = 0.274;
  set_adhesion(flat);
  set_effective_radius(flat, 0.4625e-3);
  const PairConstants<double> curved = on_curved_wall(flat, {1 / 12.5e-3, 0});
  EXPECT_NEAR(curved.adhesion_length / adhesion_length(0.274, curved.effective_radius, 3.28125e10), 1, 1e-14);
}

TEST(WallCurvature, AHollowAsNarrowAsTheSphereIsBounded) {
  PairConstants<double> flat{};
  flat.effective_modulus = 3.28125e10;
  set_adhesion(flat);
  set_effective_radius(flat, 1e-3);
  for (const double hollow : {1e-3, 0.999e-3, 0.5e-3, 1.0001e-3}) {
    const PairConstants<double> c = on_curved_wall(flat, {1 / hollow, 0});
    EXPECT_DOUBLE_EQ(c.effective_radius, conforming * 1e-3) << hollow;
  }
  EXPECT_EQ(on_curved_wall(flat, {0, 0}).effective_radius, 1e-3);
}

// In a run: a grain is pressed into the bottom of a pipe by a micrometre.
TEST(WallCurvature, ChangesTheRunOnlyWhereItIsAskedFor) {
  const auto force_at = [](bool curvature, bool ledger) {
    dem::Setup setup = support::glass_setup();
    setup.gravity = Vec3::Zero();
    setup.walls = {Wall{"pipe", 0, Cylinder{Vec3::Zero(), Vec3::UnitY(), 12.5e-3}, {}}};
    setup.step = 5e-8;
    setup.wall_curvature = curvature;
    setup.keep_ledger = ledger;
    State state;
    state.particles.add(1, 0, 0.4625e-3, Vec3(0, 0, -(12.5e-3 - 0.4625e-3 + 1e-6)));
    const Simulation sim(setup, std::move(state));
    return sim.view().wall_pairs.at(0).elastic;
  };
  const dem::Setup setup = support::glass_setup();
  const MaterialTable table = make_material_table(setup.materials, setup.interactions);
  const PairConstants<double> flat = wall_constants(table(0, 0), {0.4625e-3, 1, 1});
  // The overlap is the difference of lengths of 0.01 m, known to 2e-18 m: 2e-12 of it.
  const auto jkr = [&](const PairConstants<double>& c) { return Jkr::evaluate(1e-6, c).elastic; };
  for (const bool ledger : {false, true}) {
    EXPECT_NEAR(force_at(false, ledger) / jkr(flat), 1, 1e-11);
    EXPECT_NEAR(force_at(true, ledger) / jkr(on_curved_wall(flat, {1 / 12.5e-3, 0})), 1, 1e-11);
  }
  EXPECT_GT(force_at(true, false), 1.005 * force_at(false, false));
}

}  // namespace
}  // namespace dem
