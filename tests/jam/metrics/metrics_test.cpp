#include "libjam/metrics/metrics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>

#include "libjam/metrics/chain_shape.hpp"
#include "libjam/metrics/clustering_metrics.hpp"
#include "libjam/metrics/contact_turnover.hpp"
#include "tests/jam/graph/hand_made_network.hpp"

namespace jam {
namespace {

using hand_made::blade_wall;
using hand_made::hand_made_run;
using hand_made::Network;
using hand_made::vessel_wall;

template <class Row>
auto value(const Row& metric, const Snapshot& snapshot) {
  const RunInfo run = hand_made_run();
  const ContactGraph graph(snapshot, run.walls);
  FrameNetwork network(graph, run);
  return metric.value(network);
}
double value(const char* name, const Snapshot& snapshot) {
  const Metric* metric = find_metric(name);
  if (metric == nullptr) return std::numeric_limits<double>::signaling_NaN();
  return value(*metric, snapshot);
}

//   1 -- 2
//   |  /        4 ~~ 5       6        ~~ held by adhesion only
//   3 -----blade
Snapshot triangle_pair_and_rattler() {
  return Network()
      .touch(1, 2, 4)
      .touch(1, 3, 2)
      .touch(2, 3, 3)
      .touch(4, 5, -1)
      .grain(6)
      .press(3, blade_wall, 5)
      .snapshot();
}

TEST(MetricsTest, HaveTheirDefinitionsOnAHandMadeNetwork) {
  const Snapshot s = triangle_pair_and_rattler();
  EXPECT_DOUBLE_EQ(value("coordination", s), 8.0 / 6.0);
  EXPECT_DOUBLE_EQ(value("coordination_with_walls", s), 9.0 / 6.0);
  // Six particles: one without contact, two with one; three remain and share 8 - 2 contact ends.
  EXPECT_DOUBLE_EQ(value("mechanical_coordination", s), 2.0);
  EXPECT_DOUBLE_EQ(value("mean_repulsive_force", s), 3.0);
  EXPECT_DOUBLE_EQ(value("strong_contact_share", s), 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(value("component_count", s), 3.0);
  EXPECT_DOUBLE_EQ(value("largest_component_share", s), 0.5);
}

TEST(MetricsTest, OfLoopsAndBridgesHaveTheirDefinitions) {
  const Snapshot s = triangle_pair_and_rattler();
  EXPECT_DOUBLE_EQ(value("triangle_count", s), 1.0);
  EXPECT_DOUBLE_EQ(value("transitivity", s), 1.0);
  EXPECT_DOUBLE_EQ(value("mean_clustering", s), 1.0);  // grains 4, 5 and 6 have none
  EXPECT_DOUBLE_EQ(value("independent_cycles", s), 1.0);
  EXPECT_DOUBLE_EQ(value("largest_core_number", s), 2.0);
  EXPECT_DOUBLE_EQ(value("rattler_share", s), 0.5);
  EXPECT_DOUBLE_EQ(value("bridge_strength", s), 0.0);
  EXPECT_TRUE(std::isnan(value("sliding_share", s)));

  //  blade 9 -- 1 -7- 2 -3- 3 -- 8 vessel        and, weaker at its end,  blade 5 -- 4 -6- 3
  const Snapshot bridge = Network()
                              .press(1, blade_wall, 9)
                              .touch(1, 2, 7)
                              .touch(2, 3, 3)
                              .press(4, blade_wall, 5)
                              .touch(3, 4, 6)
                              .press(3, vessel_wall, 8)
                              .snapshot();
  EXPECT_DOUBLE_EQ(value("bridge_strength", bridge), 5.0);
  EXPECT_DOUBLE_EQ(value("bridge_flow", bridge), 8.0);
  EXPECT_DOUBLE_EQ(value("contact_disjoint_load_paths", bridge), 1.0);
  EXPECT_DOUBLE_EQ(value("particle_disjoint_load_paths", bridge), 1.0);
}

// Directions along one axis: Phi = diag(0, 0, 1), D = diag(-2.5, -2.5, 5). In a plane at right angles: Phi = diag(1/2, 1/2, 0),
// D = diag(1.25, 1.25, -2.5). Along three axes equally often: 0.
TEST(MetricsTest, OfTheFabricHaveTheirDefinitions) {
  const auto place = [](float x, float y, float z) { return Vec3f(x * 1e-3f, y * 1e-3f, z * 1e-3f); };
  const Snapshot line = Network().grain(1, place(0, 0, 0)).grain(2, place(0, 0, 1)).touch(1, 2, 1).snapshot();
  EXPECT_NEAR(value("fabric_anisotropy", line), 7.5, 1e-6);
  const Snapshot corner = Network()
                              .grain(1, place(0, 0, 0))
                              .grain(2, place(1, 0, 0))
                              .grain(3, place(0, 1, 0))
                              .touch(1, 2, 1)
                              .touch(1, 3, 3)
                              .snapshot();
  EXPECT_NEAR(value("fabric_anisotropy", corner), 3.75, 1e-6);
  // diag(1/4, 3/4, 0): D = diag(-0.625, 3.125, -2.5).
  EXPECT_NEAR(value("force_fabric_anisotropy", corner), std::sqrt(1.5 * (0.625 * 0.625 + 3.125 * 3.125 + 2.5 * 2.5)), 1e-6);
  EXPECT_NEAR(value("strong_fabric_anisotropy", corner), 7.5, 1e-6);
  EXPECT_NEAR(value("weak_fabric_anisotropy", corner), 7.5, 1e-6);
  const Snapshot cross = Network()
                             .grain(1, place(0, 0, 0))
                             .grain(2, place(1, 0, 0))
                             .grain(3, place(0, 1, 0))
                             .grain(4, place(0, 0, -1))
                             .touch(1, 2, 1)
                             .touch(1, 3, -3)
                             .touch(1, 4, 0)
                             .snapshot();
  EXPECT_NEAR(value("fabric_anisotropy", cross), 0, 1e-6);
}

TEST(MetricsTest, AWallJoinsNothing) {
  //   1 |blade| 2        a wall as a vertex would make one component of it
  const Snapshot s = Network().press(1, blade_wall, 5).press(2, blade_wall, 5).snapshot();
  EXPECT_EQ(value("component_count", s), 2.0);
}

TEST(MetricsTest, HaveDifferentNamesThatAreFoundAndUnknownOnesAreNot) {
  std::set<std::string> names;
  for (const Metric& metric : metrics()) {
    EXPECT_TRUE(names.emplace(metric.name).second) << metric.name;
    EXPECT_EQ(find_metric(metric.name), &metric);
  }
  EXPECT_EQ(find_metric("no_such_metric"), nullptr);
}

// Registered means tested: these run for every row of the table.
class EveryMetricTest : public ::testing::TestWithParam<Metric> {};

void expect_same(double a, double b) {
  if (std::isnan(a)) {
    EXPECT_TRUE(std::isnan(b));
  } else {
    // Rounding of sums in another order.
    EXPECT_NEAR(a, b, 1e-12 * std::max(1.0, std::abs(a)));
  }
}

TEST_P(EveryMetricTest, DoesNotChangeWhenTheParticlesGetOtherIdsAndAnotherOrder) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Snapshot snapshot = hand_made::random_network(seed, 40, 15 * seed);
    const Snapshot other = hand_made::relabelled(snapshot, hand_made::shuffled_ids(seed, 40));
    expect_same(value(GetParam(), snapshot), value(GetParam(), other));
  }
}

// Positions are floats: turning and shifting them rounds each by 1e-7 of its size, directions of contacts by 1e-5.
TEST_P(EveryMetricTest, DoesNotChangeWhenTheSceneIsTurnedAndShifted) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Snapshot snapshot = hand_made::random_network(seed, 40, 100);
    Snapshot turned = snapshot;
    const Eigen::Quaternionf turn = Eigen::Quaternionf(0.3f, 0.5f * float(seed), -0.7f, 0.2f).normalized();
    for (Vec3f& x : turned.particles.position) x = turn * x + Vec3f(0.003f, -0.001f, 0.002f);
    for (WallState& wall : turned.walls) wall.orientation = turn.cast<double>(), wall.position = Vec3(0.003, -0.001, 0.002);
    const double a = value(GetParam(), snapshot), b = value(GetParam(), turned);
    if (std::isnan(a)) {
      EXPECT_TRUE(std::isnan(b));
    } else {
      EXPECT_NEAR(a, b, 1e-4 * std::max(1.0, std::abs(a)));
    }
  }
}

TEST_P(EveryMetricTest, GivesNoInfinityForFramesWithoutParticlesOrContacts) {
  for (const Snapshot& snapshot : {Snapshot{}, Network().grain(1).snapshot(), Network().grain(1).grain(2).snapshot()}) {
    const double found = value(GetParam(), snapshot);
    EXPECT_FALSE(std::isinf(found));
    EXPECT_TRUE(!std::isnan(found) || !GetParam().undefined.empty()) << "does not say when it is not defined";
  }
}

TEST_P(EveryMetricTest, HasAUnitADocAndANameInSnakeCase) {
  EXPECT_FALSE(GetParam().unit.empty());
  EXPECT_FALSE(GetParam().doc.empty());
  ASSERT_FALSE(GetParam().name.empty());
  EXPECT_EQ(GetParam().name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_"), std::string_view::npos);
}

INSTANTIATE_TEST_SUITE_P(Table, EveryMetricTest, ::testing::ValuesIn(metrics().begin(), metrics().end()),
                         [](const auto& test) { return std::string(test.param.name); });

// The same of metrics of particles and of contacts: they follow their particle, whatever its row.
TEST(EveryParticleMetric, FollowsItsParticleThroughOtherIdsOrdersAndMotions) {
  for (const ParticleMetric& metric : particle_metrics()) {
    SCOPED_TRACE(metric.name);
    EXPECT_FALSE(metric.unit.empty() || metric.doc.empty());
    EXPECT_TRUE(value(metric, Snapshot{}).empty());
    for (unsigned seed = 0; seed < 10; ++seed) {
      const Snapshot s = hand_made::random_network(seed, 40, 15 * seed);
      const std::vector<ParticleId> ids = hand_made::shuffled_ids(seed, 40);
      const Snapshot other = hand_made::relabelled(s, ids);
      const std::vector<double> values = value(metric, s), others = value(metric, other);
      ASSERT_EQ(values.size(), s.particles.size());
      for (std::size_t r = 0; r < ids.size(); ++r) {
        const auto there = std::find(other.particles.id.begin(), other.particles.id.end(), ids[r]) - other.particles.id.begin();
        // Which of two equally strong bridges is told, and which of two communities of one size comes first, follows the rows.
        if (metric.name != "on_strongest_bridge" && metric.name != "community") expect_same(values[r], others[std::size_t(there)]);
        EXPECT_FALSE(std::isinf(values[r]));
        EXPECT_TRUE(!std::isnan(values[r]) || !metric.undefined.empty());
      }
    }
  }
}

TEST(EveryContactMetric, FollowsItsContactThroughOtherIdsAndOrders) {
  for (const ContactMetric& metric : contact_metrics()) {
    SCOPED_TRACE(metric.name);
    EXPECT_FALSE(metric.unit.empty() || metric.doc.empty());
    EXPECT_TRUE(value(metric, Snapshot{}).empty());
    for (unsigned seed = 0; seed < 10; ++seed) {
      const Snapshot s = hand_made::random_network(seed, 40, 15 * seed);
      const std::vector<ParticleId> ids = hand_made::shuffled_ids(seed, 40);
      const Snapshot other = hand_made::relabelled(s, ids);
      std::map<std::set<ParticleId>, double> found;
      const std::vector<double> values = value(metric, s), others = value(metric, other);
      ASSERT_EQ(values.size(), s.pp.size());
      for (std::size_t c = 0; c < other.pp.size(); ++c)
        found[{other.particles.id[other.pp.row[c][0]], other.particles.id[other.pp.row[c][1]]}] = others[c];
      for (std::size_t c = 0; c < s.pp.size(); ++c) {
        expect_same(values[c], found.at({ids[s.pp.row[c][0]], ids[s.pp.row[c][1]]}));
        EXPECT_TRUE(!std::isnan(values[c]) || !metric.undefined.empty());
      }
    }
  }
}

TEST(ParticleMetrics, HaveTheirDefinitionsOnAHandMadeNetwork) {
  const auto of = [](const char* name) {
    for (const ParticleMetric& metric : particle_metrics())
      if (metric.name == name) return value(metric, triangle_pair_and_rattler());
    return std::vector<double>{};
  };
  using ::testing::ElementsAre;
  EXPECT_THAT(of("contacts"), ElementsAre(2, 2, 2, 1, 1, 0));
  EXPECT_THAT(of("wall_contacts"), ElementsAre(0, 0, 1, 0, 0, 0));
  EXPECT_THAT(of("component_size"), ElementsAre(3, 3, 3, 2, 2, 1));
  EXPECT_THAT(of("rattler"), ElementsAre(0, 0, 0, 1, 1, 1));
  EXPECT_THAT(of("core_number"), ElementsAre(2, 2, 2, 1, 1, 0));
  EXPECT_THAT(of("triangles"), ElementsAre(1, 1, 1, 0, 0, 0));
  EXPECT_TRUE(std::isnan(of("clustering_coefficient")[3]));
  EXPECT_EQ(of("clustering_coefficient")[0], 1);
}

TEST(EveryChangeMetric, IsTheSameForOtherIdsAndOrdersAndMotionsAndNoInfinity) {
  const auto change = [](const ChangeMetric& metric, const Snapshot& before, const Snapshot& now) {
    const RunInfo run = hand_made_run();
    const ContactGraph first(before, run.walls), second(now, run.walls);
    FrameNetwork a(first, run), b(second, run);
    return metric.value(a, b);
  };
  for (const ChangeMetric& metric : change_metrics()) {
    SCOPED_TRACE(metric.name);
    EXPECT_FALSE(metric.unit.empty() || metric.doc.empty());
    EXPECT_FALSE(std::isinf(change(metric, Snapshot{}, Snapshot{})));
    for (unsigned seed = 0; seed < 10; ++seed) {
      const Snapshot before = hand_made::random_network(seed, 40, 15 * seed), now = hand_made::random_network(seed + 1, 40, 15 * seed);
      const std::vector<ParticleId> ids = hand_made::shuffled_ids(seed, 40);
      const double value = change(metric, before, now);
      EXPECT_FALSE(std::isinf(value));
      expect_same(value, change(metric, hand_made::relabelled(before, ids), hand_made::relabelled(now, ids)));
      if (metric.unit == "N") {  // a distance
        EXPECT_NEAR(change(metric, before, before), 0, 1e-12);
      }
    }
  }
}

// Contacts 1-2, 2-3, 3-4 become 1-2, 2-3 (opened and closed again), 1-4: one of three survives, or two where births are not known.
TEST(ChangeMetrics, OfContactsHaveTheirDefinitions) {
  Snapshot before = Network().touch(1, 2, 1).touch(2, 3, 1).touch(3, 4, 1).snapshot();
  Snapshot now = Network().touch(1, 2, 1).touch(2, 3, 1).touch(1, 4, 1).snapshot();
  EXPECT_DOUBLE_EQ(contact_survival(before, now), 2.0 / 3);
  before.pp.birth_step = {5, 6, 7};
  now.pp.birth_step = {5, 12, 11};  // by rows: 1-2, 1-4, 2-3
  EXPECT_DOUBLE_EQ(contact_survival(before, now), 1.0 / 3);
  EXPECT_DOUBLE_EQ(contact_renewal(before, now), 2.0 / 3);
  EXPECT_TRUE(std::isnan(contact_survival(Snapshot{}, now)));
  EXPECT_TRUE(std::isnan(contact_renewal(now, Snapshot{})));
  now.step = 21;
  EXPECT_THAT(contact_ages(now, 0.5), ::testing::ElementsAre(8, 4.5, 5));
  EXPECT_TRUE(contact_ages(now, 0).empty());
  // Lost are 2-3 (born in step 6) and 3-4 (in step 7), which join three grains of four.
  before.step = 10;
  EXPECT_DOUBLE_EQ(lost_contact_age(before, now, 0.5), (4 + 3) * 0.5 / 2);
  EXPECT_TRUE(std::isnan(lost_contact_age(before, before, 0.5)));
  const RunInfo run = hand_made_run();
  EXPECT_DOUBLE_EQ(broken_cluster_share(ContactGraph(before, run.walls), now), 0.75);
  EXPECT_EQ(broken_cluster_share(ContactGraph(before, run.walls), before), 0);
}

// 3 N across a contact of 10 N with friction 0.5 uses 3/5 of it. One that pulls without adhesion has no limit.
TEST(Mobilisation, IsTheShareOfTheFrictionLimit) {
  Snapshot s = Network().touch(1, 2, 10).touch(2, 3, -1).snapshot();
  RunInfo run = hand_made_run();
  const ContactGraph graph(s, run.walls);
  EXPECT_TRUE(std::isnan(mobilisation(graph, run)[0]));  // no forces, no friction known
  run.interactions = {{Interaction{.friction = 0.5}}};
  s.pp.tangential_force = {Vec3f(0, 3, 0), Vec3f(1, 0, 0)};
  EXPECT_DOUBLE_EQ(mobilisation(graph, run)[0], 0.6);
  EXPECT_TRUE(std::isnan(mobilisation(graph, run)[1]));
  EXPECT_DOUBLE_EQ(mean_mobilisation(mobilisation(graph, run)), 0.6);
  // Of two materials, the friction of the pair.
  run.interactions = {{{.friction = 0.1}, {.friction = 0.25}}, {{.friction = 0.25}, {.friction = 0.3}}};
  EXPECT_TRUE(std::isnan(mobilisation(graph, run)[0]));
  s.particles.material = {0, 1, 1};
  EXPECT_DOUBLE_EQ(mobilisation(graph, run)[0], 1.2);
  // With adhesion at pull-off, F = -F_c, the repulsive part is F_c; at F = 8 F_c it is 16 F_c.
  EXPECT_DOUBLE_EQ(repulsive_part(-2, 2), 2);
  EXPECT_DOUBLE_EQ(repulsive_part(16, 2), 32);
  // JKR, Johnson's closed form: with 4 E* a^3/(3 R*) = P, F = P - 2 sqrt(F_c P).
  for (const double part : {0.3, 1.0, 7.0, 1e4}) EXPECT_NEAR(repulsive_part(part - 2 * std::sqrt(0.3 * part), 0.3), part, 1e-12 * part);
  run.interactions = {{Interaction{.friction = 0.5, .work_of_adhesion = 2 / (1.5 * 3.14159265358979 * 0.25e-3)}}};  // F_c = 2 N
  s.pp.normal_force[1] = -2;
  EXPECT_NEAR(mobilisation(graph, run)[1], 1 / (0.5 * 2), 1e-3);  // a root of the rounding of the radii
}

TEST(SlidingNetwork, IsWhatSlidingContactsJoin) {
  Snapshot s = Network().touch(1, 2, 1).touch(2, 3, 1).touch(3, 4, 1).touch(4, 5, 1).snapshot();
  s.pp.flags = {contact_sliding, contact_sliding, 0, contact_neck};
  EXPECT_DOUBLE_EQ(value("sliding_share", s), 0.5);
  EXPECT_DOUBLE_EQ(value("largest_sliding_cluster_share", s), 0.6);
  EXPECT_DOUBLE_EQ(value("isostatic_coordination", s), 4 + 2.0 / 3 * 0.4);
  s.pp.flags.assign(4, 0);
  EXPECT_EQ(value("largest_sliding_cluster_share", s), 0);
  EXPECT_EQ(value("isostatic_coordination", s), 4);
}

// Four grains at the corners of a square, chained around three of its sides, 1 mm beside the axis of the blade.
TEST(ChainShape, OfARightAngledChain) {
  const Snapshot s = Network()
                         .grain(1, Vec3f(0.001f, 0, 0))
                         .grain(2, Vec3f(0.002f, 0, 0))
                         .grain(3, Vec3f(0.002f, 0, 0.001f))
                         .grain(4, Vec3f(0.003f, 0, 0.001f))
                         .snapshot();
  const ContactGraph graph(s, hand_made_run().walls);
  ForceChain chain;
  chain.particles = {0, 1, 2, 3};
  chain.links = 3;
  chain.contour = 0.003;
  chain.end_to_end = std::sqrt(5.0) * 1e-3;
  EXPECT_NEAR(chain_straightness(graph, {chain}), std::sqrt(5.0) / 3, 1e-12);
  EXPECT_NEAR(chain_bend(graph, {chain}), std::acos(0.0), 1e-6);
  EXPECT_NEAR(chain_alignment(graph, hand_made_run().walls, {chain}, GapDirection::across), 2 / std::sqrt(5.0), 1e-6);
  EXPECT_NEAR(chain_alignment(graph, hand_made_run().walls, {chain}, GapDirection::along), 0, 1e-6);
  chain.links = 4;  // a ring
  EXPECT_TRUE(std::isnan(chain_straightness(graph, {chain})));
}

// Two contacts of a grain, 3 and 1 N, closed to a triangle: (3 + 1)/(1 * 4) = 1; with a third partner outside, 2 N: 4/(2 * 6).
TEST(ForceClustering, IsBarrats) {
  const Snapshot s = Network().touch(1, 2, 3).touch(1, 3, 1).touch(2, 3, 7).touch(1, 4, 2).snapshot();
  const ContactGraph graph(s, hand_made_run().walls);
  const std::vector<double> found = force_clustering(graph);
  EXPECT_DOUBLE_EQ(found[0], 4.0 / 12);
  EXPECT_DOUBLE_EQ(found[1], 1);
  EXPECT_TRUE(std::isnan(found[3]));
}

}  // namespace
}  // namespace jam
