// Communities against all partitions of small networks, and their shape.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "libjam/graph/communities.hpp"
#include "libjam/graph/components.hpp"
#include "libjam/metrics/community_metrics.hpp"
#include "tests/jam/graph/hand_made_network.hpp"

namespace jam {
namespace {

using hand_made::for_random_networks;
using hand_made::hand_made_run;
using hand_made::Network;
using hand_made::random_network;
using ::testing::ElementsAre;

// Two triangles of 5 N contacts joined by one of 1 N: <f> = 31/7. Each triangle keeps 3 (5 - 31/7).
TEST(Communities, OfTwoTriangles) {
  const Snapshot s =
      Network().touch(1, 2, 5).touch(2, 3, 5).touch(1, 3, 5).touch(4, 5, 5).touch(5, 6, 5).touch(4, 6, 5).touch(3, 4, 1).snapshot();
  const ContactGraph graph(s, hand_made_run().walls);
  const Communities found = communities(graph);
  EXPECT_THAT(found.label, ElementsAre(0, 0, 0, 1, 1, 1));
  EXPECT_THAT(found.size, ElementsAre(3, 3));
  EXPECT_NEAR(found.quality, 6 * (5 - 31.0 / 7), 1e-14);
  EXPECT_NEAR(found.modularity, 6 * (5 - 31.0 / 7) / 31, 1e-14);
  // Without a null model whatever hangs together belongs together; with a strong one nothing does.
  EXPECT_THAT(communities(graph, 0).size, ElementsAre(6));
  EXPECT_EQ(communities(graph, 0).modularity, 1);
  EXPECT_THAT(communities(graph, 2).size, ElementsAre(1, 1, 1, 1, 1, 1));
}

double best_of_all_partitions(const ContactGraph& graph) {
  const std::size_t n = graph.vertex_count();
  std::vector<std::uint32_t> label(n, 0);
  double best = -std::numeric_limits<double>::infinity();
  const auto place = [&](auto self, std::size_t v, std::uint32_t used) -> void {
    if (v == n) {
      best = std::max(best, community_quality(graph, label));
      return;
    }
    for (std::uint32_t l = 0; l <= used; ++l) {
      label[v] = l;
      self(self, v + 1, std::max(used, l + 1));
    }
  };
  place(place, 0, 0);
  return best;
}

// The search is greedy, and so is allowed to miss; on these it reaches the best of all partitions nearly always and never says more.
TEST(Communities, AreTheBestOfAllPartitionsOfSmallNetworks) {
  int reached = 0;
  double lost = 0, whole = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const Snapshot s = random_network(seed, 8, 10 + seed % 12);
    const ContactGraph graph(s, hand_made_run().walls);
    const double best = best_of_all_partitions(graph);
    const Communities found = communities(graph);
    EXPECT_LE(found.quality, best + 1e-10);
    EXPECT_NEAR(found.quality, community_quality(graph, found.label), 1e-12);
    reached += found.quality > best - 1e-9;
    lost += best - found.quality;
    whole += best;
  }
  EXPECT_GE(reached, 54);
  EXPECT_LT(lost, 0.01 * whole);
}

TEST(Communities, AreConnectedAndNumberedBySize) {
  for_random_networks(60, [](const ContactGraph& graph) {
    const Communities found = communities(graph);
    std::vector<std::uint8_t> inside(graph.edge_count());
    for (std::size_t c = 0; c < inside.size(); ++c) {
      const auto [a, b] = graph.snapshot().pp.row[c];
      inside[c] = found.label[a] == found.label[b];
    }
    const Components parts = connected_components(graph, inside);
    EXPECT_EQ(parts.label, found.label);
    EXPECT_EQ(parts.size, found.size);
  });
}

Communities all_one(const Snapshot& s) {
  return {std::vector<std::uint32_t>(s.particles.size(), 0), {std::uint32_t(s.particles.size())}, 0, 0};
}

// A straight row: distances in contacts and in space are proportional, r = 1, and its only community is the largest: g = 0. A row bent to
// a square's four sides whose ends do not touch: r < 1.
TEST(CommunityMetrics, GapFactorOfARowIsZero) {
  Network row;
  for (unsigned i = 0; i < 6; ++i) row.grain(i, Vec3f(0.001f * float(i), 0, 0));
  for (unsigned i = 0; i < 5; ++i) row.touch(i, i + 1, 1);
  const Snapshot straight = row.snapshot();
  EXPECT_NEAR(gap_factor(ContactGraph(straight, hand_made_run().walls), all_one(straight)), 0, 1e-6);
  // Four corners of a unit square in a row: distances in contacts 1, 1, 1, 2, 2, 3, in space 1, 1, 1, sqrt 2, sqrt 2, 1.
  Network bent;
  const Vec3f corner[] = {{0, 0, 0}, {0.001f, 0, 0}, {0.001f, 0.001f, 0}, {0, 0.001f, 0}};
  for (unsigned i = 0; i < 4; ++i) bent.grain(i, corner[i]);
  const Snapshot square = bent.touch(0, 1, 1).touch(1, 2, 1).touch(2, 3, 1).snapshot();
  const double x[] = {1, 1, 1, 2, 2, 3}, y[] = {1, 1, 1, std::sqrt(2.0), std::sqrt(2.0), 1};
  double sx = 0, sy = 0, sxx = 0, syy = 0, sxy = 0;
  for (int k = 0; k < 6; ++k) sx += x[k], sy += y[k], sxx += x[k] * x[k], syy += y[k] * y[k], sxy += x[k] * y[k];
  const double r = (sxy - sx * sy / 6) / std::sqrt((sxx - sx * sx / 6) * (syy - sy * sy / 6));
  EXPECT_NEAR(gap_factor(ContactGraph(square, hand_made_run().walls), all_one(square)), 1 - r, 1e-6);
  // In a triangle no distance in contacts differs from another.
  const Snapshot triangle = Network().touch(1, 2, 1).touch(2, 3, 1).touch(1, 3, 1).snapshot();
  EXPECT_TRUE(std::isnan(gap_factor(ContactGraph(triangle, hand_made_run().walls), all_one(triangle))));
}

// A tetrahedron of three edges of 2 mm at right angles: 8/6 mm^3; four spheres of 1/2 mm: 4 pi/6 mm^3.
TEST(CommunityMetrics, HullRatioOfATetrahedron) {
  const Snapshot s = Network()
                         .grain(1, Vec3f(0, 0, 0))
                         .grain(2, Vec3f(0.002f, 0, 0))
                         .grain(3, Vec3f(0, 0.002f, 0))
                         .grain(4, Vec3f(0, 0, 0.002f))
                         .snapshot();
  EXPECT_NEAR(hull_ratio(ContactGraph(s, hand_made_run().walls), all_one(s)), 8.0 / (4 * 3.14159265358979), 1e-6);
}

}  // namespace
}  // namespace jam
