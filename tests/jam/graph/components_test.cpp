#include "libjam/graph/components.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tests/jam/graph/hand_made_network.hpp"

namespace jam {
namespace {

using hand_made::hand_made_run;
using hand_made::Network;
using hand_made::random_network;
using ::testing::ElementsAre;

constexpr std::uint32_t none = Components::none;

TEST(ComponentsTest, LargestIsFirstAndTiesGoToTheSmallestId) {
  //   1 -- 4      2      3 -- 6      5 -- 7 -- 8
  const Snapshot snapshot = Network().touch(1, 4, 1).grain(2).touch(3, 6, 1).touch(5, 7, 1).touch(7, 8, 1).snapshot();
  const ContactGraph graph(snapshot, hand_made_run().walls);
  const Components components = connected_components(graph);
  EXPECT_THAT(components.size, ElementsAre(3, 2, 2, 1));
  //                                            1  2  3  4  5  6  7  8
  EXPECT_THAT(components.label, ElementsAre(1, 3, 2, 1, 0, 2, 0, 0));
}

TEST(ComponentsTest, AreThoseOfTheKeptPart) {
  //   1 -- 2 -x- 3 -- (4) -- 5        x: contact left out, (4): vertex left out
  const Snapshot snapshot = Network().touch(1, 2, 1).touch(2, 3, 1).touch(3, 4, 1).touch(4, 5, 1).snapshot();
  const ContactGraph graph(snapshot, hand_made_run().walls);
  const std::vector<std::uint8_t> keep_vertex{1, 1, 1, 0, 1}, keep_contact{1, 0, 1, 1};
  const Components components = connected_components(graph, keep_vertex, keep_contact);
  EXPECT_THAT(components.size, ElementsAre(2, 1, 1));
  EXPECT_THAT(components.label, ElementsAre(0, 0, 1, none, 2));
}

// Brute force: two kept vertices belong together when the transitive closure of "joined by a kept contact" says so.
std::vector<std::vector<bool>> closure(const Snapshot& s, const std::vector<std::uint8_t>& keep_vertex,
                                       const std::vector<std::uint8_t>& keep_contact) {
  const std::size_t n = s.particles.size();
  std::vector<std::vector<bool>> reach(n, std::vector<bool>(n, false));
  for (std::size_t i = 0; i < n; ++i) reach[i][i] = keep_vertex[i] != 0;
  for (std::size_t c = 0; c < s.pp.size(); ++c) {
    const auto [a, b] = s.pp.row[c];
    if (keep_contact[c] && keep_vertex[a] && keep_vertex[b]) reach[a][b] = reach[b][a] = true;
  }
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        if (reach[i][k] && reach[k][j]) reach[i][j] = true;
      }
    }
  }
  return reach;
}

TEST(ComponentsTest, AgreeWithTheTransitiveClosureOnRandomNetworks) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    // From almost no contact to one that percolates.
    const Snapshot snapshot = random_network(seed, 30, 2 + seed);
    const ContactGraph graph(snapshot, hand_made_run().walls);
    std::vector<std::uint8_t> keep_vertex(graph.vertex_count()), keep_contact(graph.edge_count());
    for (std::size_t v = 0; v < keep_vertex.size(); ++v) keep_vertex[v] = (v * 7 + seed) % 5 != 0;
    for (std::size_t c = 0; c < keep_contact.size(); ++c) keep_contact[c] = snapshot.pp.normal_force[c] > 0;
    const auto reach = closure(snapshot, keep_vertex, keep_contact);
    const Components components = connected_components(graph, keep_vertex, keep_contact);

    std::vector<std::uint32_t> size(components.size.size(), 0), smallest(components.size.size(), none);
    for (std::uint32_t i = 0; i < graph.vertex_count(); ++i) {
      ASSERT_EQ(components.label[i] == none, keep_vertex[i] == 0);
      if (components.label[i] == none) continue;
      ASSERT_LT(components.label[i], components.size.size());
      ++size[components.label[i]];
      smallest[components.label[i]] = std::min(smallest[components.label[i]], i);
      for (std::uint32_t j = 0; j < graph.vertex_count(); ++j) {
        if (components.label[j] != none) {
          EXPECT_EQ(components.label[i] == components.label[j], reach[i][j]);
        }
      }
    }
    EXPECT_EQ(size, components.size);
    for (std::size_t k = 1; k < size.size(); ++k) {
      EXPECT_TRUE(size[k - 1] > size[k] || (size[k - 1] == size[k] && smallest[k - 1] < smallest[k]));
    }
  }
}

TEST(ComponentsTest, DoNotDependOnTheIdsOfTheParticles) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Snapshot snapshot = random_network(seed, 50, 45);
    const auto new_id = hand_made::shuffled_ids(seed, 50);
    const Snapshot other = hand_made::relabelled(snapshot, new_id);
    const auto as_sets = [](const Snapshot& s, const std::map<ParticleId, ParticleId>& name) {
      const ContactGraph graph(s, hand_made_run().walls);
      const Components components = connected_components(graph);
      std::vector<std::set<ParticleId>> sets(components.size.size());
      for (std::size_t v = 0; v < s.particles.size(); ++v) sets[components.label[v]].insert(name.at(s.particles.id[v]));
      return std::set<std::set<ParticleId>>(sets.begin(), sets.end());
    };
    std::map<ParticleId, ParticleId> same, renamed;
    for (std::size_t v = 0; v < 50; ++v) {
      same[other.particles.id[v]] = other.particles.id[v];
      renamed[snapshot.particles.id[v]] = new_id[v];
    }
    EXPECT_EQ(as_sets(snapshot, renamed), as_sets(other, same));
  }
}

}  // namespace
}  // namespace jam
