#include "libdem/bed/settling_step.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "libdem/particles/particles.hpp"
#include "tests/dem/grains.hpp"

namespace dem {
namespace {

constexpr double modulus = 3.28125e10, radius = 2.3125e-4;  // E* and R* of two mean beads of the paper's case A

TEST(SettlingStep, ContactRadiusIsJkrs) {
  // Without load a_eq = 1.848186e-6 m (reference table of JKR's case A, seven digits); the stiffness there is 6/5 E* a.
  EXPECT_NEAR(contact_radius_under(0, 0.274, radius, modulus) / 1.848186e-6, 1, 1e-6);
  EXPECT_GT(stiffness_under(0, 0.274, radius, modulus), 7.2772e4);
  // Without adhesion Hertz's, F = 4/3 E* a^3/R*; adhesion makes it larger, under a large load by little.
  const double a = contact_radius_under(20, 0, radius, modulus);
  EXPECT_NEAR(4.0 / 3.0 * modulus * a * a * a / radius, 20, 1e-12 * 20);
  EXPECT_NEAR(contact_radius_under(20, 0.274, radius, modulus) / a, 1, 3e-3);
}

TEST(SettlingStep, ImpactForceIsThatOfChungAndOoisFirstTest) {
  // Two glass spheres of 10 mm at 20 m/s relative speed: 1.069689e4 N (Granular Matter 13 (2011) 643, test 1).
  const double mass = 2800 * sphere_volume(10e-3);
  EXPECT_NEAR(impact_force(20, mass / 2, 5e-3, 48e9 / (2 * (1 - 0.04))) / 1.069689e4, 1, 1e-6);
}

TEST(SettlingStep, IsHalfOfTheCriticalStepOfACubicLattice) {
  // Frictionless grains on a cubic lattice: neighbours against each other, omega^2 = 4 k/m, critical step 2/omega.
  const double mass = 1e-6, stiffness = 1e5;
  EXPECT_NEAR(settling_step(mass, stiffness, 0), 0.5 * 2 / std::sqrt(4 * stiffness / mass), 1e-20);
  EXPECT_LT(settling_step(mass, stiffness, 0.9), 0.5 * settling_step(mass, stiffness, 0));
}

// A cube of grains pressed together so that it flies apart, with everything that is elastic, gains no more energy than the
// scheme's error allows: an oscillation of frequency w is off by (w dt)^2/8 of its energy, 1/8 for the fastest (w dt = 1) and
// a hundredth on average, since w^2 falls from there to zero as contacts part. With a tenth of the step: a hundredth of that.
TEST(SettlingStep, KeepsTheEnergyOfAPressedPacking) {
  dem::Setup setup = support::glass_setup();
  setup.interactions = {{{1, 0.5, 0, 0}}};
  setup.gravity = Vec3::Zero();
  const double overlap = 1e-6, grain = 0.4625e-3, mass = 2500 * sphere_volume(grain);
  const double a = std::sqrt(0.5 * grain * overlap), force = 4.0 / 3.0 * modulus * a * overlap;
  const double tau = 2 * (1 - 0.2) / (2 - 0.2);  // 4 G*/E* of equal materials
  const double step = settling_step(mass, stiffness_under(force, 0, 0.5 * grain, modulus), tau);
  EXPECT_GT(step, 1e-7);  // twice and more of the paper's
  const double contacts = 3 * 5 * 5 * 4, stored = contacts * 0.4 * force * overlap;
  const auto released = [&](double dt) {
    setup.step = dt;
    State state;
    state.particles = support::packed_cube(5, overlap, 0, 1);
    Simulation sim(setup, state);
    sim.advance(std::uint64_t(std::ceil(2000 * step / dt)));
    return sim.kinetic_energy() / stored;
  };
  // All of the stored energy has become motion; grains have parted.
  const double coarse = released(step), fine = released(step / 10);
  EXPECT_NEAR(coarse, 1, 1e-2);
  EXPECT_NEAR(fine, 1, 1e-4);
}

}  // namespace
}  // namespace dem
