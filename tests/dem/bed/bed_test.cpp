#include "libdem/bed/bed.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>

#include "libdem/errors.hpp"
#include "tests/dem/grains.hpp"

namespace dem {
namespace {

constexpr double radius = 4e-3;

Setup vessel() {
  dem::Setup setup = support::glass_setup();
  setup.walls = {Wall{"floor", 0, Plane{}, {}}, Wall{"cylinder", 0, Cylinder{Vec3::Zero(), Vec3::UnitZ(), radius}, {}}};
  return setup;
}

Bed thin_bed(std::uint64_t seed = 1) {
  Bed bed;
  bed.material = "glass";
  bed.mean_diameter = 0.925e-3;
  bed.depth = 4e-3;
  bed.seed = seed;
  return bed;
}

TEST(Bed, IsAtRestInItsVesselBelowItsCut) {
  omp_set_num_threads(1);
  const SettledBed bed = make_bed(vessel(), thin_bed(), 0, radius);
  const Particles& p = bed.state.particles;
  EXPECT_EQ(bed.report.grains, p.size());
  EXPECT_GT(p.size(), 150u);
  for (std::size_t i = 0; i < p.size(); ++i) {
    EXPECT_LE(p.position[i].z(), thin_bed().depth + 0.1e-3);  // the cut, and what stiffening and adhesion moved
    EXPECT_GE(p.position[i].z(), p.radius[i] - 1e-6);
    EXPECT_LE(p.position[i].head<2>().norm(), radius - p.radius[i] + 1e-6);
    EXPECT_GE(p.radius[i], 0.37e-3);
    EXPECT_LE(p.radius[i], 0.555e-3);
  }
  EXPECT_LT(bed.report.kinetic_energy, bed.report.rest_scale);
  EXPECT_LT(bed.report.largest_overlap, 1e-3);
  // A narrow vessel packs loosely; adhesive beads more so.
  EXPECT_GT(bed.report.solid_fraction, 0.4);
  EXPECT_LT(bed.report.solid_fraction, 0.64);
  EXPECT_GT(bed.report.coordination, 2);

  // Simulated on, it stays: no grain moves by more than a micrometre in a millisecond.
  Simulation sim(vessel(), bed.state);
  sim.advance(20000);
  double moved = 0;
  for (std::size_t i = 0; i < p.size(); ++i)
    moved = std::max(moved, (sim.particles().position[i] - p.position[i]).norm());
  EXPECT_LT(moved, 2e-6);
}

TEST(Bed, OneSeedGivesOneBedAnotherSeedAnother) {
  omp_set_num_threads(1);
  const SettledBed a = make_bed(vessel(), thin_bed(1), 0, radius), b = make_bed(vessel(), thin_bed(2), 0, radius);
  omp_set_num_threads(2);
  const SettledBed again = make_bed(vessel(), thin_bed(1), 0, radius);
  omp_set_num_threads(1);
  ASSERT_EQ(a.state.particles.size(), again.state.particles.size());
  for (std::size_t i = 0; i < a.state.particles.size(); ++i)
    EXPECT_EQ(a.state.particles.position[i], again.state.particles.position[i]);
  EXPECT_NE(a.state.particles.radius, b.state.particles.radius);
}

TEST(Bed, SaysWhatIsWrongWithACaseThatHasNone) {
  Bed none = thin_bed();
  none.depth = -2e-3;
  EXPECT_THROW(make_bed(vessel(), none, 0, radius), CaseError);
  dem::Setup weightless = vessel();
  weightless.gravity = Vec3::Zero();
  EXPECT_THROW(make_bed(weightless, thin_bed(), 0, radius), CaseError);
  EXPECT_THROW(make_bed(vessel(), thin_bed(), 0, radius, {}, [] { return true; }), BedInterrupted);
}

}  // namespace
}  // namespace dem
