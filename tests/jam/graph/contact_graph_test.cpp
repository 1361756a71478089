#include "libjam/graph/contact_graph.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/graph/breadth_first_search.hpp>
#include <boost/graph/connected_components.hpp>
#include <boost/graph/graph_concepts.hpp>
#include <set>

#include "libjam/graph/boost_adaptor.hpp"
#include "tests/jam/graph/hand_made_network.hpp"

namespace jam {
namespace {

using hand_made::blade_wall;
using hand_made::floor_wall;
using hand_made::hand_made_run;
using hand_made::Network;
using hand_made::random_network;
using hand_made::vessel_wall;
using ::testing::ElementsAre;

//   blade |o 2 -- o 5 -- o 9| vessel        (5 also stands on the floor)
Snapshot chain_of_three() {
  return Network()
      .touch(2, 5, 30)
      .touch(5, 9, 31)
      .press(2, blade_wall, 32)
      .press(9, vessel_wall, 33)
      .press(5, floor_wall, 34)
      .press(9, blade_wall, 35)
      .snapshot();
}

TEST(ContactGraphTest, RowsAreVerticesAndContactsAreEdgesThatKnowTheirRecord) {
  const Snapshot snapshot = chain_of_three();
  const ContactGraph graph(snapshot, hand_made_run().walls);
  ASSERT_EQ(graph.vertex_count(), 3u);
  ASSERT_EQ(graph.edge_count(), 2u);
  const auto neighbors = graph.neighbors(1);
  ASSERT_EQ(neighbors.size(), 2u);
  EXPECT_EQ(neighbors[0].vertex, 0u);
  EXPECT_EQ(snapshot.pp.normal_force[neighbors[0].contact], 30);
  EXPECT_EQ(neighbors[1].vertex, 2u);
  EXPECT_EQ(snapshot.pp.normal_force[neighbors[1].contact], 31);
}

TEST(ContactGraphTest, WallsAreEndsOfParticlesGroupedByRoleAndNeverVertices) {
  const Snapshot snapshot = chain_of_three();
  const ContactGraph graph(snapshot, hand_made_run().walls);
  EXPECT_EQ(graph.wall_contact_count(), 4u);
  EXPECT_THAT(graph.wall_contacts(0, WallRole::blade), ElementsAre(0));
  EXPECT_THAT(graph.wall_contacts(0, WallRole::vessel), ElementsAre());
  EXPECT_THAT(graph.wall_contacts(1, WallRole::other), ElementsAre(1));
  ASSERT_EQ(graph.wall_contacts(2).size(), 2u);
  ASSERT_EQ(graph.wall_contacts(2, WallRole::blade).size(), 1u);
  ASSERT_EQ(graph.wall_contacts(2, WallRole::vessel).size(), 1u);
  EXPECT_EQ(snapshot.pw.normal_force[graph.wall_contacts(2, WallRole::blade)[0]], 35);
  EXPECT_EQ(snapshot.pw.normal_force[graph.wall_contacts(2, WallRole::vessel)[0]], 33);
}

TEST(ContactGraphTest, HasTheSameNeighboursAsASearchThroughAllContacts) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Snapshot snapshot = random_network(seed, 40, 90);
    const ContactGraph graph(snapshot, hand_made_run().walls);
    for (std::uint32_t v = 0; v < graph.vertex_count(); ++v) {
      std::set<std::pair<std::uint32_t, std::uint32_t>> expected, found;
      for (std::uint32_t c = 0; c < snapshot.pp.size(); ++c) {
        if (snapshot.pp.row[c][0] == v) expected.emplace(snapshot.pp.row[c][1], c);
        if (snapshot.pp.row[c][1] == v) expected.emplace(snapshot.pp.row[c][0], c);
      }
      for (const auto& n : graph.neighbors(v)) found.emplace(n.vertex, n.contact);
      EXPECT_EQ(found, expected);
      EXPECT_TRUE(std::is_sorted(graph.neighbors(v).begin(), graph.neighbors(v).end(),
                                 [](const auto& a, const auto& b) { return a.vertex < b.vertex; }));
    }
  }
}

TEST(ContactGraphTest, IsEmptyForAnEmptyFrame) {
  const Snapshot snapshot;
  const ContactGraph graph(snapshot, hand_made_run().walls);
  EXPECT_EQ(graph.vertex_count(), 0u);
  EXPECT_EQ(graph.edge_count(), 0u);
}

BOOST_CONCEPT_ASSERT((boost::VertexListGraphConcept<ContactGraph>));
BOOST_CONCEPT_ASSERT((boost::BidirectionalGraphConcept<ContactGraph>));
BOOST_CONCEPT_ASSERT((boost::AdjacencyGraphConcept<ContactGraph>));
BOOST_CONCEPT_ASSERT((boost::EdgeListGraphConcept<ContactGraph>));
BOOST_CONCEPT_ASSERT((boost::ReadablePropertyGraphConcept<ContactGraph, ContactGraph::Vertex, boost::vertex_index_t>));
BOOST_CONCEPT_ASSERT((boost::ReadablePropertyGraphConcept<ContactGraph, ContactEdge, boost::edge_index_t>));

TEST(BoostAdaptorTest, AlgorithmsOfBoostGraphRunOnAContactGraph) {
  //   0 -- 3 -- 6     9 -- 12
  const Snapshot snapshot = Network().touch(0, 3, 1).touch(3, 6, 1).touch(9, 12, 1).snapshot();
  const ContactGraph graph(snapshot, hand_made_run().walls);
  std::vector<int> component(num_vertices(graph));
  EXPECT_EQ(boost::connected_components(graph, component.data()), 2);
  EXPECT_THAT(component, ElementsAre(0, 0, 0, 1, 1));

  std::vector<int> distance(num_vertices(graph), 0);
  boost::breadth_first_search(
      graph, 0u,
      boost::visitor(boost::make_bfs_visitor(boost::record_distances(distance.data(), boost::on_tree_edge()))));
  EXPECT_THAT(distance, ElementsAre(0, 1, 2, 0, 0));
}

TEST(BoostAdaptorTest, EveryContactIsOneEdgeSeenFromBothEnds) {
  const Snapshot snapshot = random_network(7, 30, 80);
  const ContactGraph graph(snapshot, hand_made_run().walls);
  std::vector<int> seen(graph.edge_count(), 0);
  for (auto [v, last] = vertices(graph); v != last; ++v) {
    for (auto [e, end] = out_edges(*v, graph); e != end; ++e) {
      EXPECT_EQ(source(*e, graph), *v);
      EXPECT_NE(target(*e, graph), *v);
      ++seen[get(boost::edge_index, graph, *e)];
    }
  }
  EXPECT_THAT(seen, ::testing::Each(2));
  std::uint32_t contact = 0;
  for (auto [e, end] = edges(graph); e != end; ++e, ++contact) {
    EXPECT_EQ(source(*e, graph), snapshot.pp.row[contact][0]);
    EXPECT_EQ(target(*e, graph), snapshot.pp.row[contact][1]);
  }
  EXPECT_EQ(contact, num_edges(graph));
}

}  // namespace
}  // namespace jam
