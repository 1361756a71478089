#include "libdem/bed/bed.hpp"

#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <cmath>

#include "libdem/bed/rest.hpp"
#include "libdem/case/size_distribution.hpp"
#include "libdem/errors.hpp"
#include "libdem/scene/scene.hpp"
#include "tests/dem/case/ft4.hpp"
#include "tests/dem/grains.hpp"

namespace dem {
namespace {

constexpr double radius = 4e-3;
const BedRegion round{CylinderRegion{radius}};

Setup vessel() {
  dem::Setup setup = support::glass_setup();
  setup.walls = {Wall{"floor", 0, Plane{}, {}}, Wall{"cylinder", 0, Cylinder{Vec3::Zero(), Vec3::UnitZ(), radius}, {}}};
  return setup;
}

Bed thin_bed(std::uint64_t seed = 1, Bed::Sizes sizes = Bed::Sizes::by_number) {
  Bed bed;
  bed.material = "glass";
  bed.mean_diameter = 0.925e-3;
  bed.depth = 4e-3;
  bed.seed = seed;
  bed.sizes = sizes;
  return bed;
}

// m, how far each grain moves while the setup runs, the farthest first.
std::vector<double> movement(const Setup& setup, const State& state, std::uint64_t steps) {
  Simulation sim(setup, state);
  sim.advance(steps);
  std::vector<double> moved;
  for (std::size_t i = 0; i < state.particles.size(); ++i)
    moved.push_back((sim.particles().position[i] - state.particles.position[i]).norm());
  std::sort(moved.rbegin(), moved.rend());
  return moved;
}

// Largest distance between the distribution of the grains' sizes and the one they are drawn from, times sqrt(N): below 1.95 with
// a probability of 0.999 (Kolmogorov and Smirnov, asymptotic; a little less for small N, where it is on the safe side).
double kolmogorov_smirnov(const Bed& bed, const Particles& p) {
  std::vector<double> size;
  for (const double r : p.radius) size.push_back(2 * r / bed.mean_diameter);
  std::sort(size.begin(), size.end());
  double distance = 0;
  const double n = double(size.size());
  for (std::size_t i = 0; i < size.size(); ++i) {
    const double share = size_share_below(bed, size[i]);
    distance = std::max({distance, share - double(i) / n, double(i + 1) / n - share});
  }
  return distance * std::sqrt(n);
}

TEST(Bed, IsAtRestInItsVesselBelowItsCut) {
  omp_set_num_threads(1);
  const SettledBed bed = make_bed(vessel(), thin_bed(), 0, round);
  const Particles& p = bed.state.particles;
  const BedReport& r = bed.report;
  EXPECT_EQ(r.grains, p.size());
  EXPECT_GT(p.size(), 150u);
  for (std::size_t i = 0; i < p.size(); ++i) {
    EXPECT_LE(p.position[i].z(), thin_bed().depth + 0.1e-3);  // the cut, and what stiffening and adhesion moved
    EXPECT_GE(p.position[i].z(), p.radius[i] - 1e-6);
    EXPECT_LE(p.position[i].head<2>().norm(), radius - p.radius[i] + 1e-6);
    EXPECT_GE(p.radius[i], 0.37e-3);
    EXPECT_LE(p.radius[i], 0.555e-3);
    EXPECT_EQ(p.velocity[i], Vec3::Zero());
  }
  EXPECT_LE(r.unsupported, 1u);
  EXPECT_LT(r.kinetic_energy, r.rest_scale);
  EXPECT_LT(r.largest_displacement, (r.unsupported == 0 ? 0.1 : 1.0) * r.free_fall);
  // Its own weight presses a bead by some 1e-5 R; a few hundred beads carry little more.
  EXPECT_GT(r.overlaps.largest, 1e-5);
  EXPECT_LT(r.overlaps.largest, 1e-3);
  EXPECT_EQ(r.overlaps.squeezed, 0u);
  // A narrow vessel packs loosely; adhesive beads more so.
  EXPECT_GT(r.solid_fraction, 0.4);
  EXPECT_LT(r.solid_fraction, 0.64);
  // Two contacts hold a grain with friction and adhesion; six are the isostatic number of smooth ones.
  EXPECT_GT(r.mechanical_coordination, 2);
  EXPECT_LT(r.mechanical_coordination, 6);

  // Simulated on at the run's own step, it stays: in a millisecond no grain moves by more than two micrometres, but for the one that a
  // bed of this size may have unsupported, or that rolls off later: not by more than it would fall freely.
  const std::vector<double> moved = movement(vessel(), bed.state, 20000);
  EXPECT_LT(moved[0], 0.5 * 9.81 * 1e-3 * 1e-3);
  EXPECT_LT(moved[1], 2e-6);
}

TEST(Bed, OneSeedGivesOneBedForAnyNumberOfThreads) {
  omp_set_num_threads(1);
  const SettledBed a = make_bed(vessel(), thin_bed(), 0, round);
  omp_set_num_threads(2);
  dem::Setup other_step = vessel();
  other_step.step = 1e-8;  // of the run to come
  const SettledBed again = make_bed(other_step, thin_bed(), 0, round);
  omp_set_num_threads(1);
  EXPECT_EQ(a.state.particles.position, again.state.particles.position);
  EXPECT_EQ(a.state.particles.radius, again.state.particles.radius);
  EXPECT_EQ(a.report.grain_steps, again.report.grain_steps);
}

TEST(Bed, SeedsGiveOtherBedsOfTheSameStatistics) {
  omp_set_num_threads(1);
  for (const Bed::Sizes sizes : {Bed::Sizes::by_number, Bed::Sizes::by_mass}) {
    std::vector<SettledBed> beds;
    for (const std::uint64_t seed : {1, 2, 3}) {
      const Bed bed = thin_bed(seed, sizes);
      beds.push_back(make_bed(vessel(), bed, 0, round));
      EXPECT_LT(kolmogorov_smirnov(bed, beds.back().state.particles), 1.95);
    }
    for (std::size_t k = 0; k < beds.size(); ++k) {
      const BedReport &r = beds[k].report, &s = beds[(k + 1) % beds.size()].report;
      EXPECT_NE(beds[k].state.particles.radius, beds[(k + 1) % beds.size()].state.particles.radius);
      // Some 200 grains, half of them at a wall: a count that scatters by its square root, twice over, and packings that differ
      // by a few grains in their middle slice.
      EXPECT_NEAR(double(r.grains) / double(s.grains), 1, 0.2);
      EXPECT_NEAR(r.solid_fraction / s.solid_fraction, 1, 0.12);
      EXPECT_NEAR(r.mechanical_coordination, s.mechanical_coordination, 0.6);
    }
  }
}

TEST(Bed, StandsInABoxAndSpreadsToAHeapWithoutOne) {
  omp_set_num_threads(1);
  const BedRegion box{BoxRegion{0, 6e-3, -4e-3, 4e-3}};
  dem::Setup walled = support::glass_setup();
  walled.walls = {Wall{"floor", 0, Plane{}, {}}, Wall{"left", 0, Plane{Vec3::Zero(), Vec3::UnitX()}, {}},
                  Wall{"right", 0, Plane{Vec3(6e-3, 0, 0), -Vec3::UnitX()}, {}},
                  Wall{"front", 0, Plane{Vec3(0, -4e-3, 0), Vec3::UnitY()}, {}},
                  Wall{"back", 0, Plane{Vec3(0, 4e-3, 0), -Vec3::UnitY()}, {}}};
  const SettledBed bed = make_bed(walled, thin_bed(), 0, box);
  for (const Vec3& x : bed.state.particles.position) EXPECT_EQ(held_inside(box, x, 0.36e-3), x);
  EXPECT_GT(bed.report.solid_fraction, 0.4);
  EXPECT_LT(bed.report.solid_fraction, 0.64);

  dem::Setup blade = walled;  // only the recoater's front, the plane x = 0
  blade.walls.resize(2);
  const SettledBed heap = make_bed(blade, thin_bed(), 0, box);
  double farthest = 0;
  for (const Vec3& x : heap.state.particles.position) {
    EXPECT_GT(x.x(), 0.36e-3);
    farthest = std::max(farthest, x.x());
  }
  EXPECT_GT(farthest, 7e-3);  // it has spread
  EXPECT_LE(heap.report.unsupported, 1u);
}

TEST(Bed, SaysWhatIsWrongWithACaseThatHasNone) {
  Bed none = thin_bed();
  none.depth = -2e-3;
  EXPECT_THROW(make_bed(vessel(), none, 0, round), CaseError);
  dem::Setup weightless = vessel();
  weightless.gravity = Vec3::Zero();
  EXPECT_THROW(make_bed(weightless, thin_bed(), 0, round), CaseError);
  EXPECT_THROW(make_bed(vessel(), thin_bed(), 0, CylinderRegion{0.5e-3}), CaseError);
  EXPECT_THROW(make_bed(vessel(), thin_bed(), 0, round, {}, [] { return true; }), BedInterrupted);
}

// The floor is missing: the grains fall for ever, and that must not pass for a bed.
TEST(Bed, ThatNothingSupportsIsRefused) {
  dem::Setup bottomless = vessel();
  bottomless.walls.erase(bottomless.walls.begin());
  Bed few = thin_bed();
  few.depth = 1.2e-3;
  EXPECT_THROW(make_bed(bottomless, few, 0, round), std::runtime_error);
}

// The bed of the paper's case A at full size: 25 mm vessel, 52 mm deep, true stiffness. Minutes per bed.
TEST(BedValidation, FullSizeBedsOfTwoSeedsAgree) {
  Case c = ft4('a');
  const Scene rheometer = make_scene(c);
  const BedRegion region{CylinderRegion{0.5 * c.vessel.diameter}};
  std::vector<BedReport> reports;
  for (const std::uint64_t seed : {1, 2}) {
    c.bed.seed = seed;
    const SettledBed bed = make_bed(rheometer.setup, c.bed, 0, region);
    const BedReport& r = bed.report;
    reports.push_back(r);
    RecordProperty("solid_fraction_of_seed_" + std::to_string(seed), std::to_string(r.solid_fraction));
    RecordProperty("coordination_of_seed_" + std::to_string(seed), std::to_string(r.coordination));
    // Between the random loose packing of frictional spheres and the random dense one, less what the wall takes.
    EXPECT_GT(r.solid_fraction, 0.54);
    EXPECT_LT(r.solid_fraction, 0.62);
    // 33 to 38 thousand are expected from solid fractions of 0.56 to 0.64; the cut leaves the top layer half empty.
    EXPECT_GT(r.grains, 32000u);
    EXPECT_LT(r.grains, 38000u);
    EXPECT_GT(r.mechanical_coordination, 3.2);
    EXPECT_LT(r.mechanical_coordination, 5);
    // Under the weight of the bed: 2.4e-5 in the median, and forces of a packing fall off exponentially beyond the mean.
    EXPECT_LT(r.overlaps.largest, 1e-3);
    // An impact at the pouring's 1.1 m/s presses grains of its 13 MPa (E*) by 5 % of a radius, and a grain between the blade's tip and the
    // vessel stays where it was pressed to.
    EXPECT_LT(r.overlaps.largest_squeezed, 0.05);
    EXPECT_LT(r.overlaps.squeezed, 32u);  // along two tips of 10 mm
    RecordProperty("squeezed_of_seed_" + std::to_string(seed), std::to_string(r.overlaps.squeezed));
    RecordProperty("largest_squeezed_of_seed_" + std::to_string(seed), std::to_string(r.overlaps.largest_squeezed));
    RecordProperty("largest_overlap_of_seed_" + std::to_string(seed), std::to_string(r.overlaps.largest));
    EXPECT_NEAR(r.top, c.bed.depth, 0.5 * c.bed.mean_diameter);
    EXPECT_LT(kolmogorov_smirnov(c.bed, bed.state.particles), 1.95);
    // It stays, blade at rest, at the run's own step.
    dem::Setup still = rheometer.setup;
    for (Wall& w : still.walls) w.motion = resting_at(w.motion, 0);
    const RestProbe probe = probe_rest(still, bed.state);
    EXPECT_TRUE(probe.at_rest()) << probe.unsupported << " unsupported";
  }
  // 34,000 grains: the count scatters by its square root at most, 0.5 %; solid fractions of beds poured alike differ by less than
  // a hundredth, coordinations by some hundredths.
  EXPECT_NEAR(double(reports[0].grains) / double(reports[1].grains), 1, 0.01);
  EXPECT_NEAR(reports[0].solid_fraction / reports[1].solid_fraction, 1, 0.01);
  EXPECT_NEAR(reports[0].coordination, reports[1].coordination, 0.06);
  EXPECT_NE(reports[0].kinetic_energy, reports[1].kinetic_energy);
}

}  // namespace
}  // namespace dem
