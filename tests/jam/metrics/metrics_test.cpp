#include "libjam/metrics/metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "tests/jam/graph/hand_made_network.hpp"

namespace jam {
namespace {

using hand_made::blade_wall;
using hand_made::hand_made_run;
using hand_made::Network;
using hand_made::vessel_wall;

double value(const char* name, const Snapshot& snapshot) {
  const Metric* metric = find_metric(name);
  if (metric == nullptr) return std::numeric_limits<double>::signaling_NaN();
  const ContactGraph graph(snapshot, hand_made_run().walls);
  return metric->value(graph);
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
    const ContactGraph graph(snapshot, hand_made_run().walls), other_graph(other, hand_made_run().walls);
    expect_same(GetParam().value(graph), GetParam().value(other_graph));
  }
}

TEST_P(EveryMetricTest, GivesNoInfinityForFramesWithoutParticlesOrContacts) {
  for (const Snapshot& snapshot : {Snapshot{}, Network().grain(1).snapshot(), Network().grain(1).grain(2).snapshot()}) {
    const ContactGraph graph(snapshot, hand_made_run().walls);
    EXPECT_FALSE(std::isinf(GetParam().value(graph)));
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

}  // namespace
}  // namespace jam
