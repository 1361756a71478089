#include "libjam/jamming/jam_criteria.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "libjam/errors.hpp"
#include "libjam/jamming/check_criteria.hpp"
#include "libjam/jamming/compressive_force.hpp"
#include "libjam/jamming/jam_clusters.hpp"
#include "tests/jam/graph/hand_made_network.hpp"

namespace jam {
namespace {

using hand_made::blade_wall;
using hand_made::hand_made_run;
using hand_made::Network;
using hand_made::random_network;
using hand_made::vessel_wall;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

RunInfo run_of(double young) {
  RunInfo run = hand_made_run();
  run.materials = {{"glass", 2500, young, 0.2}};
  return run;
}

std::vector<ParticleId> jammed(const Snapshot& s, const RunInfo& run, const std::string& criterion, std::optional<double> threshold = {}) {
  Criteria criteria;
  criteria.criterion = criterion;
  criteria.threshold = threshold;
  check_criteria(criteria, run);
  const ContactGraph graph(s, run.walls);
  std::vector<ParticleId> ids;
  for (const JammedParticle& p : jammed_particles(graph, compressive_forces(graph, criteria.measure), run, criteria)) ids.push_back(s.particles.id[p.row]);
  return ids;
}

// E* R^2 of glass of 63 GPa, nu 0.2, R = 0.5 mm: 63e9 / 1.92 * 0.25e-6 = 8203.125 N.
TEST(JamCriteria, ScaleIsThatOfHertz) { EXPECT_DOUBLE_EQ(hertz_scale({"glass", 2500, 63e9, 0.2}, 0.5e-3), 8203.125); }

// The same indentations in grains a thousand times softer: forces a thousand times smaller. 20 N sees only the stiff ones, the others both.
TEST(JamCriteria, WithoutStiffnessSeeTheSameJamInSoftGrains) {
  for (const double softer : {1.0, 1e3}) {
    const float f = float(15 / softer);
    const Snapshot s = Network().press(1, blade_wall, f).press(1, vessel_wall, f).touch(1, 2, f / 100).snapshot();
    const RunInfo run = run_of(63e9 / softer);
    if (softer == 1) {
      EXPECT_THAT(jammed(s, run, "compressive_force"), ElementsAre(1));
    } else {
      EXPECT_THAT(jammed(s, run, "compressive_force"), IsEmpty());
    }
    EXPECT_THAT(jammed(s, run, "scaled_force"), ElementsAre(1));
    EXPECT_THAT(jammed(s, run, "wedged"), ElementsAre(1));
    EXPECT_THAT(jammed(s, run, "bridge"), ElementsAre(1));
    EXPECT_THAT(jammed(s, run, "scaled_force", 4e-3), IsEmpty());  // 30 N over 8203 N is 3.66e-3
    EXPECT_THAT(jammed(s, run, "scaled_force", 3.6e-3), ElementsAre(1));
  }
}

TEST(JamCriteria, WedgedGrainsAreInTheGapBetweenBladeAndVessel) {
  const RunInfo run = run_of(63e9);
  EXPECT_THAT(jammed(Network().press(1, blade_wall, 15).snapshot(), run, "wedged"), IsEmpty());
  EXPECT_THAT(jammed(Network().grain(1, Vec3f(0.005f, 0, 0)).press(1, blade_wall, 15).press(1, vessel_wall, 15).snapshot(), run, "wedged"), IsEmpty());
  // An adhesive neck does not press.
  EXPECT_THAT(jammed(Network().press(1, blade_wall, -15).press(1, vessel_wall, 15).snapshot(), run, "wedged"), IsEmpty());
}

TEST(JamCriteria, BridgesAreTheStrongestPathIfItIsStrong) {
  const RunInfo run = run_of(63e9);
  const Network two = Network().press(1, blade_wall, 14).touch(1, 2, 13).press(2, vessel_wall, 15).touch(2, 3, 40);
  EXPECT_THAT(jammed(two.snapshot(), run, "bridge"), ElementsAre(1, 2));  // 13 N over 8203 N is 1.58e-3
  EXPECT_THAT(jammed(two.snapshot(), run, "bridge", 1.6e-3), IsEmpty());
}

TEST(JamCriteria, AreRefusedWhereTheDataCannotTell) {
  const auto problem = [](Criteria criteria, const RunInfo& run) -> std::string {
    try {
      check_criteria(criteria, run);
    } catch (const CriteriaError& e) {
      return e.what();
    }
    return "";
  };
  Criteria criteria;
  criteria.criterion = "wegded";
  EXPECT_THAT(problem(criteria, run_of(63e9)), HasSubstr("expected one of compressive_force, scaled_force, wedged, bridge"));
  criteria.criterion = "scaled_force";
  EXPECT_THAT(problem(criteria, hand_made_run()), HasSubstr("Young's modulus"));
  criteria.criterion = "wedged";
  RunInfo no_gap = run_of(63e9);
  no_gap.gap = {};
  EXPECT_THAT(problem(criteria, no_gap), HasSubstr("gap"));
}

class EveryJamCriterion : public testing::TestWithParam<const JamCriterion*> {};

// Every limit exceeded is a jam, none where there is nothing; all forces and the stiffness a thousand times smaller change nothing but for the
// criterion in newtons.
TEST_P(EveryJamCriterion, IsTheSameInSoftGrainsUnlessItIsAForce) {
  const std::string name(GetParam()->name);
  EXPECT_THAT(jammed(Network().grain(1).snapshot(), run_of(63e9), name), IsEmpty());
  std::size_t found = 0;
  for (unsigned scene = 0; scene < 30; ++scene) {
    Snapshot s = random_network(scene, 40, 12);
    const auto stiff = jammed(s, run_of(63e9), name);
    found += stiff.size();
    for (float& f : s.pp.normal_force) f /= 1024;
    for (float& f : s.pw.normal_force) f /= 1024;
    const auto soft = jammed(s, run_of(63e9 / 1024), name);
    if (GetParam()->of_stiffness) {
      EXPECT_EQ(soft, stiff);
    }
  }
  EXPECT_GT(found, 0u);
}

std::vector<const JamCriterion*> all_criteria() {
  std::vector<const JamCriterion*> all;
  for (const JamCriterion& row : jam_criteria()) all.push_back(&row);
  return all;
}
INSTANTIATE_TEST_SUITE_P(Table, EveryJamCriterion, testing::ValuesIn(all_criteria()), [](const auto& row) { return std::string(row.param->name); });

}  // namespace
}  // namespace jam
