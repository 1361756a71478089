// Shortest paths: betweenness by any length, its estimate from samples, and lengths of all paths.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <omp.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "libjam/graph/betweenness.hpp"
#include "libjam/graph/contact_length.hpp"
#include "libjam/graph/path_lengths.hpp"
#include "tests/jam/graph/hand_made_network.hpp"

namespace jam {
namespace {

using hand_made::for_random_networks;
using hand_made::hand_made_run;
using hand_made::Network;
using hand_made::random_network;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::Pointwise;

constexpr double infinite = std::numeric_limits<double>::infinity();

Snapshot row_of(unsigned grains) {
  Network network;
  for (unsigned i = 0; i < grains; ++i) network.grain(i, Vec3f(0.001f * float(i), 0, 0));
  for (unsigned i = 0; i + 1 < grains; ++i) network.touch(i, i + 1, 1);
  return network.snapshot();
}

// Raw counts, each pair once: of four in a row, networkx's default would divide by 3 and by 6.
TEST(BetweennessOfContacts, OfARow) {
  const Snapshot s = row_of(4);
  const Betweenness found = betweenness(ContactGraph(s, hand_made_run().walls));
  EXPECT_THAT(found.particle, ElementsAre(0, 2, 2, 0));
  EXPECT_THAT(found.contact, ElementsAre(3, 4, 3));
}

// Two ways from 0 to 3, over 1 with 10 N contacts and over 2 with 1 N contacts: force as a length would take the weak one.
TEST(BetweennessOfContacts, SeeksWhatIsShortNotWhatIsHeavy) {
  const Snapshot s = Network().touch(0, 1, 10).touch(1, 3, 10).touch(0, 2, 1).touch(2, 3, 1).touch(0, 3, -5).snapshot();
  const ContactGraph graph(s, hand_made_run().walls);
  const std::vector<ContactGraph::Vertex> from{0}, to{3};
  // Contacts by rows: 0-1, 0-2, 0-3, 1-3, 2-3. The pulling contact 0-3 is not walked.
  EXPECT_THAT(betweenness(graph, from, to, inverse_forces(graph)).contact, ElementsAre(1, 0, 0, 1, 0));
  EXPECT_THAT(betweenness(graph, from, to).contact, ElementsAre(0, 0, 1, 0, 0));
}

// 0.1 + 0.2 and 0.15 + 0.15 differ by a rounding; a difference of 1e-6 is one.
TEST(BetweennessOfContacts, SharesAmongLengthsThatDifferByRounding) {
  const Snapshot s = Network().touch(0, 1, 1).touch(1, 3, 1).touch(0, 2, 1).touch(2, 3, 1).snapshot();
  const ContactGraph graph(s, hand_made_run().walls);
  const std::vector<ContactGraph::Vertex> from{0}, to{3};
  const std::vector<double> equal{0.1, 0.15, 0.2, 0.15}, unequal{0.1, 0.15, 0.2, 0.15 - 1e-6};
  EXPECT_THAT(betweenness(graph, from, to, equal).particle, ElementsAre(0, 0.5, 0.5, 0));
  EXPECT_THAT(betweenness(graph, from, to, unequal).particle, ElementsAre(0, 0, 1, 0));
}

// Distances by Floyd and Warshall, numbers of paths by their recursion, both with exact lengths: whole numbers.
TEST(BetweennessOfContacts, IsTheShareOfShortestPathsByLength) {
  for_random_networks(20, [](const ContactGraph& graph) {
    const std::size_t n = graph.vertex_count();
    const auto& rows = graph.snapshot().pp.row;
    std::vector<double> length;
    for (std::size_t c = 0; c < rows.size(); ++c) length.push_back(double(1 + (7 * rows[c][0] + 3 * rows[c][1]) % 4));
    std::vector<std::vector<double>> distance(n, std::vector<double>(n, infinite)), paths(n, std::vector<double>(n, 0.0));
    for (std::size_t v = 0; v < n; ++v) distance[v][v] = 0;
    for (std::size_t c = 0; c < rows.size(); ++c) distance[rows[c][0]][rows[c][1]] = distance[rows[c][1]][rows[c][0]] = length[c];
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < n; ++b) distance[a][b] = std::min(distance[a][b], distance[a][k] + distance[k][b]);
    for (std::size_t s = 0; s < n; ++s) {
      std::vector<ContactGraph::Vertex> order(n);
      std::iota(order.begin(), order.end(), 0u);
      std::sort(order.begin(), order.end(), [&](auto a, auto b) { return distance[s][a] < distance[s][b]; });
      paths[s][s] = 1;
      for (const ContactGraph::Vertex v : order)
        if (v != s && distance[s][v] < infinite)
          for (const ContactGraph::Neighbor& u : graph.neighbors(v))
            if (distance[s][u.vertex] + length[u.contact] == distance[s][v]) paths[s][v] += paths[s][u.vertex];
    }
    const Betweenness found = betweenness(graph, length);
    for (std::size_t v = 0; v < n; ++v) {
      double expected = 0;
      for (std::size_t s = 0; s < n; ++s)
        for (std::size_t t = s + 1; t < n; ++t)
          if (s != v && t != v && distance[s][t] < infinite && distance[s][v] + distance[v][t] == distance[s][t])
            expected += paths[s][v] * paths[v][t] / paths[s][t];
      EXPECT_NEAR(found.particle[v], expected, 1e-12 * std::max(1.0, expected));
    }
    // Where no path leads through, none does: no rounding of a sum that cancels.
    for (const Betweenness& by : {found, betweenness(graph)})
      for (ContactGraph::Vertex v = 0; v < n; ++v) {
        EXPECT_GE(by.particle[v], 0);
        if (graph.degree(v) < 2) {
          EXPECT_EQ(by.particle[v], 0);
        }
      }
    for (std::size_t c = 0; c < rows.size(); ++c) {
      double expected = 0;
      for (std::size_t s = 0; s < n; ++s)
        for (std::size_t t = s + 1; t < n; ++t) {
          if (distance[s][t] == infinite) continue;
          const auto [a, b] = rows[c];
          if (distance[s][a] + length[c] + distance[b][t] == distance[s][t]) expected += paths[s][a] * paths[b][t] / paths[s][t];
          if (distance[s][b] + length[c] + distance[a][t] == distance[s][t]) expected += paths[s][b] * paths[a][t] / paths[s][t];
        }
      EXPECT_NEAR(found.contact[c], expected, 1e-12 * std::max(1.0, expected));
    }
  });
}

TEST(Betweenness, IsTheSameToTheBitForAnyNumberOfThreads) {
  const Snapshot s = random_network(3, 400, 900);
  const ContactGraph graph(s, hand_made_run().walls);
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  const Betweenness one = betweenness(graph);
  for (const int threads : {2, 3}) {
    omp_set_num_threads(threads);
    const Betweenness more = betweenness(graph);
    EXPECT_EQ(one.particle, more.particle);
    EXPECT_EQ(one.contact, more.contact);
    const Betweenness particles = betweenness(graph, {}, BetweennessOf::particles);
    EXPECT_EQ(one.particle, particles.particle);
    EXPECT_TRUE(particles.contact.empty());
  }
  omp_set_num_threads(before);
}

// 200 estimates at 90 %: with all particles within their bound in at least 180 or so. The bound is wide, so it is never missed here; and
// it shrinks with the samples as it should, between their root and their number.
TEST(SampledBetweenness, IsWithinItsErrorAsOftenAsItSays) {
  const Snapshot s = random_network(5, 100, 250);
  const ContactGraph graph(s, hand_made_run().walls);
  const Betweenness exact = betweenness(graph);
  int within = 0;
  double bias = 0, sum = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const SampledBetweenness found = sampled_betweenness(graph, 400, seed, 0.9);
    bool all = true;
    for (std::size_t v = 0; v < exact.particle.size(); ++v) {
      all = all && std::abs(found.particle[v] - exact.particle[v]) <= found.error[v];
      bias += found.particle[v] - exact.particle[v];
      sum += exact.particle[v];
    }
    within += all;
  }
  EXPECT_GE(within, 180);
  EXPECT_LT(std::abs(bias), 0.01 * sum);  // of 80,000 samples
  const auto mean_error = [&](std::size_t samples) {
    const std::vector<double> error = sampled_betweenness(graph, samples, 1).error;
    return std::accumulate(error.begin(), error.end(), 0.0);
  };
  EXPECT_GT(mean_error(1000) / mean_error(100000), 10.0);
  EXPECT_LT(mean_error(1000) / mean_error(100000), 100.0);
  EXPECT_EQ(sampled_betweenness(graph, 50, 7).particle, sampled_betweenness(graph, 50, 7).particle);
}

// Of a row of four: distances 1 three times, 2 twice, 3 once.
TEST(PathLengths, OfARowAndOfTwoParts) {
  const Snapshot row = row_of(4);
  const PathLengths found = path_lengths(ContactGraph(row, hand_made_run().walls));
  EXPECT_DOUBLE_EQ(found.efficiency, (3 + 2.0 / 2 + 1.0 / 3) / 6);
  EXPECT_DOUBLE_EQ(found.mean, (3 * 1 + 2 * 2 + 1 * 3) / 6.0);
  EXPECT_EQ(found.longest, 3);
  // Two pairs: pairs of grains from both count for the efficiency, with nothing, and not for the mean.
  const Snapshot parts = Network().touch(1, 2, 1).touch(3, 4, 1).snapshot();
  const PathLengths apart = path_lengths(ContactGraph(parts, hand_made_run().walls));
  EXPECT_DOUBLE_EQ(apart.efficiency, 2.0 / 6);
  EXPECT_EQ(apart.mean, 1);
}

// More than 512 particles: several batches. Lengths of 1 by the other way.
TEST(PathLengths, AreTheSameByBothWays) {
  const Snapshot s = random_network(11, 700, 1100);
  const ContactGraph graph(s, hand_made_run().walls);
  const PathLengths bits = path_lengths(graph), walked = path_lengths(graph, std::vector<double>(graph.edge_count(), 1.0));
  EXPECT_NEAR(bits.efficiency, walked.efficiency, 1e-13);
  EXPECT_NEAR(bits.mean, walked.mean, 1e-12);
  EXPECT_EQ(bits.longest, walked.longest);
}

TEST(ContactLengths, AreDistanceInverseForceAndBoth) {
  const Snapshot s = Network().grain(1, Vec3f(0, 0, 0)).grain(2, Vec3f(0, 0.003f, 0)).grain(3, Vec3f(0.004f, 0, 0)).touch(1, 2, 2).touch(2, 3, -1).snapshot();
  const ContactGraph graph(s, hand_made_run().walls);
  EXPECT_THAT(branch_lengths(graph), Pointwise(DoubleNear(1e-9), {0.003, 0.005}));
  EXPECT_THAT(inverse_forces(graph), ElementsAre(0.5, infinite));
  EXPECT_NEAR(branch_per_force(graph)[0], 0.0015, 1e-9);
  EXPECT_EQ(branch_per_force(graph)[1], infinite);
}

}  // namespace
}  // namespace jam
