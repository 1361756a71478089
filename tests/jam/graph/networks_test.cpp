// Cores, triangles, rattlers, widest paths and flows against their definitions, tried out one by one on small random networks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <cmath>
#include <random>
#include <set>

#include "libjam/graph/betweenness.hpp"
#include "libjam/graph/biconnectivity.hpp"
#include "libjam/graph/bridge_conductance.hpp"
#include "libjam/graph/contact_force.hpp"
#include "libjam/graph/components.hpp"
#include "libjam/graph/core_numbers.hpp"
#include "libjam/graph/cycle_basis.hpp"
#include "libjam/graph/max_flow.hpp"
#include "libjam/graph/minimum_cut.hpp"
#include "libjam/graph/rattlers.hpp"
#include "libjam/graph/triangles.hpp"
#include "libjam/graph/widest_path.hpp"
#include "tests/jam/graph/hand_made_network.hpp"

namespace jam {
namespace {

using hand_made::blade_wall;
using hand_made::for_random_networks;
using hand_made::hand_made_run;
using hand_made::Network;
using hand_made::vessel_wall;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

// Takes away who has fewer than `least` holds in those left, until nothing changes.
std::set<ContactGraph::Vertex> left_over(const ContactGraph& graph, std::size_t least, bool walls_hold) {
  std::set<ContactGraph::Vertex> left;
  for (ContactGraph::Vertex v = 0; v < graph.vertex_count(); ++v) left.insert(v);
  for (bool changed = true; changed;) {
    changed = false;
    for (const ContactGraph::Vertex v : std::set(left)) {
      std::size_t holds = walls_hold ? graph.wall_contacts(v).size() : 0;
      for (const ContactGraph::Neighbor& n : graph.neighbors(v)) holds += left.count(n.vertex);
      if (holds < least) changed = left.erase(v) > 0;
    }
  }
  return left;
}

TEST(CoreNumbers, AreTheLargestCoreThatHoldsTheParticle) {
  for_random_networks(40, [](const ContactGraph& graph) {
    const std::vector<std::uint32_t> core = core_numbers(graph);
    for (std::uint32_t k = 0; k < 8; ++k) {
      const std::set<ContactGraph::Vertex> members = left_over(graph, k, false);
      for (ContactGraph::Vertex v = 0; v < graph.vertex_count(); ++v) EXPECT_EQ(core[v] >= k, members.count(v) > 0) << v;
    }
  });
}

TEST(Rattlers, FallUntilAllThatRemainAreHeld) {
  //  floor -- 1 -- 2 -- 3      3 hangs on 2 alone; without it 2 hangs on 1 alone, and 1 rests on the floor alone
  const Snapshot s = Network().press(1, hand_made::floor_wall, 1).touch(1, 2, 1).touch(2, 3, 1).snapshot();
  EXPECT_THAT(rattlers(ContactGraph(s, hand_made_run().walls)), ElementsAre(1, 1, 1));
  for_random_networks(40, [](const ContactGraph& graph) {
    for (std::uint32_t least : {2u, 4u}) {
      const std::vector<std::uint8_t> loose = rattlers(graph, least);
      const std::set<ContactGraph::Vertex> held = left_over(graph, least, true);
      for (ContactGraph::Vertex v = 0; v < graph.vertex_count(); ++v) EXPECT_EQ(loose[v] == 0, held.count(v) > 0) << v;
    }
  });
}

TEST(Triangles, AreAllTriplesThatTouch) {
  for_random_networks(25, [](const ContactGraph& graph) {
    const std::size_t n = graph.vertex_count();
    std::vector<std::vector<bool>> touch(n, std::vector<bool>(n, false));
    for (const auto& [a, b] : graph.snapshot().pp.row) touch[a][b] = touch[b][a] = true;
    std::vector<std::uint32_t> expected(n, 0);
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = a + 1; b < n; ++b)
        for (std::size_t c = b + 1; c < n; ++c)
          if (touch[a][b] && touch[b][c] && touch[a][c]) ++expected[a], ++expected[b], ++expected[c];
    EXPECT_EQ(triangles(graph), expected);
  });
}

// Capacity that leads from a set of particles and the blade to the others and the vessel.
double cut(const ContactGraph& graph, unsigned side, const std::vector<double>& pp, const std::vector<double>& pw) {
  double sum = 0;
  const Snapshot& s = graph.snapshot();
  for (std::size_t c = 0; c < pp.size(); ++c)
    if ((side >> s.pp.row[c][0] & 1) != (side >> s.pp.row[c][1] & 1)) sum += pp[c];
  for (std::size_t c = 0; c < pw.size(); ++c) {
    const bool with_blade = side >> s.pw.row[c] & 1;
    if (s.pw.wall[c] == (with_blade ? vessel_wall : blade_wall)) sum += pw[c];
  }
  return sum;
}

std::vector<double> forces(const ContactGraph& graph, bool walls) {
  std::vector<double> force;
  for (std::size_t c = 0; c < (walls ? graph.wall_contact_count() : graph.edge_count()); ++c)
    force.push_back(walls ? repulsive_force(graph.snapshot().pw, c) : repulsive_force(graph.snapshot().pp, c));
  return force;
}

TEST(MaxFlow, IsTheSmallestOfAllCutsAndNamesOne) {
  for_random_networks(10, [](const ContactGraph& graph) {
    const std::vector<double> pp = forces(graph, false), pw = forces(graph, true);
    double smallest = std::numeric_limits<double>::infinity();
    for (unsigned side = 0; side < 1u << 10; ++side) smallest = std::min(smallest, cut(graph, side, pp, pw));
    const MaxFlow flow = max_force_flow(graph);
    EXPECT_EQ(flow.value, smallest);  // integer newtons
    unsigned side = 0;
    for (unsigned v = 0; v < 10; ++v) side |= unsigned(flow.blade_side[v]) << v;
    EXPECT_EQ(cut(graph, side, pp, pw), smallest);
    // The smallest side of all smallest cuts: theirs hold it.
    for (unsigned other = 0; other < 1u << 10; ++other)
      EXPECT_TRUE(cut(graph, other, pp, pw) > smallest || (other & side) == side);
    double named = 0;
    for (const std::uint32_t c : flow.cut_pp) named += pp[c];
    for (const std::uint32_t c : flow.cut_pw) named += pw[c];
    EXPECT_EQ(named, smallest);
  });
}

// Where only one end is pressed, nothing flows and nothing is cut; the blade reaches what hangs on it.
TEST(MaxFlow, IsNothingWhereOneEndIsNotPressed) {
  for (const auto wall : {blade_wall, vessel_wall}) {
    const Snapshot s = Network().press(0, wall, 5).touch(0, 1, 3).snapshot();
    const MaxFlow flow = max_force_flow(ContactGraph(s, hand_made_run().walls));
    EXPECT_EQ(flow.value, 0);
    EXPECT_TRUE(flow.cut_pp.empty() && flow.cut_pw.empty());
    EXPECT_THAT(flow.blade_side, Each(wall == blade_wall));
  }
}

// Any directed network, with double links and links of one way, against Boost.Graph's Boykov-Kolmogorov.
TEST(MinimumCut, IsBoostsMaximumFlow) {
  using Traits = boost::adjacency_list_traits<boost::vecS, boost::vecS, boost::directedS>;
  struct Arc {
    std::int64_t capacity = 0, residual = 0;
    Traits::edge_descriptor reverse;
  };
  struct Node {
    boost::default_color_type color{};
    std::int64_t distance = 0;
    Traits::edge_descriptor predecessor;
  };
  std::mt19937_64 random(7);
  for (int scene = 0; scene < 300; ++scene) {
    const std::uint32_t nodes = 2 + std::uint32_t(random() % 60);
    std::vector<FlowLink> links;
    for (std::size_t k = random() % (4 * nodes); k-- > 0;) {
      FlowLink link{std::uint32_t(random() % nodes), std::uint32_t(random() % nodes), 0, 0};
      link.forth = std::int64_t(random() % 3 == 0 ? 0 : random() >> (3 + random() % 50));
      link.back = std::int64_t(random() % 3 == 0 ? 0 : random() >> (3 + random() % 50));
      if (link.from != link.to) links.push_back(link);
    }
    boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS, Node, Arc> network(nodes);
    std::int64_t into_sink = 0;
    for (FlowLink& link : links) {
      link.forth /= std::int64_t(links.size()), link.back /= std::int64_t(links.size());
      into_sink += link.to == 1 ? link.forth : link.from == 1 ? link.back : 0;
      const auto there = add_edge(link.from, link.to, Arc{link.forth, 0, {}}, network).first;
      const auto home = add_edge(link.to, link.from, Arc{link.back, 0, there}, network).first;
      network[there].reverse = home;
    }
    const std::int64_t expected = boost::boykov_kolmogorov_max_flow(
        network, get(&Arc::capacity, network), get(&Arc::residual, network), get(&Arc::reverse, network),
        get(&Node::predecessor, network), get(&Node::color, network), get(&Node::distance, network),
        get(boost::vertex_index, network), 0, 1);
    const MinimumCut cut = minimum_cut(nodes, links, 0, 1);
    EXPECT_EQ(cut.value, expected);
    EXPECT_TRUE(cut.source_side[0] == 1 && cut.source_side[1] == 0);
    std::int64_t across = 0;
    for (const FlowLink& link : links) {
      if (cut.source_side[link.from] && !cut.source_side[link.to]) across += link.forth;
      if (cut.source_side[link.to] && !cut.source_side[link.from]) across += link.back;
    }
    EXPECT_EQ(across, cut.value);
    EXPECT_LE(cut.value, into_sink);
    // The smallest such side: reached from the source where flow can still go, by Boost's residuals.
    std::vector<std::uint8_t> reached(nodes, 0);
    std::vector<std::uint32_t> front{0};
    reached[0] = 1;
    while (!front.empty()) {
      const std::uint32_t v = front.back();
      front.pop_back();
      for (auto [e, end] = out_edges(v, network); e != end; ++e) {
        const std::uint32_t to = std::uint32_t(target(*e, network));
        if (!reached[to] && network[*e].residual > 0) reached[to] = 1, front.push_back(to);
      }
    }
    EXPECT_EQ(cut.source_side, reached);
  }
}

TEST(DisjointLoadPaths, AreAsManyAsContactsOrParticlesPartBladeAndVessel) {
  for_random_networks(10, [](const ContactGraph& graph) {
    std::vector<double> pp = forces(graph, false), pw = forces(graph, true);
    for (double& force : pp) force = force > 0;
    for (double& force : pw) force = force > 0;
    double contacts = std::numeric_limits<double>::infinity();
    for (unsigned side = 0; side < 1u << 10; ++side) contacts = std::min(contacts, cut(graph, side, pp, pw));
    EXPECT_EQ(double(contact_disjoint_load_paths(graph)), contacts);

    // The fewest particles without which nothing that the blade presses leads to the vessel.
    const auto parts = [&](unsigned taken) {
      unsigned reached = 0, before = ~0u;
      for (std::size_t c = 0; c < pw.size(); ++c)
        if (pw[c] > 0 && graph.snapshot().pw.wall[c] == blade_wall) reached |= 1u << graph.snapshot().pw.row[c];
      for (reached &= ~taken; reached != before;) {
        before = reached;
        for (std::size_t c = 0; c < pp.size(); ++c) {
          const auto [a, b] = graph.snapshot().pp.row[c];
          if (pp[c] > 0 && ((reached >> a & 1) || (reached >> b & 1))) reached |= (1u << a | 1u << b) & ~taken;
        }
      }
      for (std::size_t c = 0; c < pw.size(); ++c)
        if (pw[c] > 0 && graph.snapshot().pw.wall[c] == vessel_wall && (reached >> graph.snapshot().pw.row[c] & 1)) return false;
      return true;
    };
    int fewest = 10;
    for (unsigned taken = 0; taken < 1u << 10; ++taken)
      if (parts(taken)) fewest = std::min(fewest, std::popcount(taken));
    EXPECT_EQ(int(particle_disjoint_load_paths(graph)), fewest);
  });
}

// Does a path of contacts of at least this force lead from the blade to the vessel?
bool bridged(const ContactGraph& graph, double force) {
  const std::vector<double> pp = forces(graph, false), pw = forces(graph, true);
  std::set<ContactGraph::Vertex> reached;
  const auto ends = [&](ContactGraph::Vertex v, std::uint8_t wall) {
    for (std::size_t c = 0; c < pw.size(); ++c)
      if (graph.snapshot().pw.row[c] == v && graph.snapshot().pw.wall[c] == wall && pw[c] >= force) return true;
    return false;
  };
  for (ContactGraph::Vertex v = 0; v < graph.vertex_count(); ++v)
    if (ends(v, blade_wall)) reached.insert(v);
  for (std::size_t before = graph.vertex_count() + 1; before != reached.size();) {
    before = reached.size();
    for (std::size_t c = 0; c < pp.size(); ++c) {
      const auto [a, b] = graph.snapshot().pp.row[c];
      if (pp[c] >= force && (reached.count(a) || reached.count(b))) reached.insert({a, b});
    }
  }
  for (const ContactGraph::Vertex v : reached)
    if (ends(v, vessel_wall)) return true;
  return false;
}

TEST(WidestPath, IsBridgedAtItsStrengthAndNotAbove) {
  const Snapshot apart = Network().touch(1, 2, 3).snapshot();
  const ContactGraph parted(apart, hand_made_run().walls);
  EXPECT_THAT(widest_path(parted, contacts_by_force(parted)).particles, IsEmpty());
  // One grain between blade and vessel.
  const Snapshot pinched = Network().press(7, blade_wall, 30).press(7, vessel_wall, 20).snapshot();
  const ContactGraph held(pinched, hand_made_run().walls);
  const WidestPath one = widest_path(held, contacts_by_force(held));
  EXPECT_EQ(one.strength, 20);
  EXPECT_THAT(one.particles, ElementsAre(0));
  int bridges = 0;
  for_random_networks(20, [&](const ContactGraph& graph) {
    const WidestPath path = widest_path(graph, contacts_by_force(graph));
    EXPECT_FALSE(bridged(graph, path.strength + 0.5));  // integer newtons
    if (path.strength == 0) {
      EXPECT_FALSE(bridged(graph, 0.5));
      return;
    }
    ++bridges;
    EXPECT_TRUE(bridged(graph, path.strength));
    // The path itself: its weakest contact is the strength.
    double weakest = std::numeric_limits<double>::infinity();
    const auto strongest = [&](ContactGraph::Vertex v, WallRole role) {
      double most = 0;
      for (const std::uint32_t c : graph.wall_contacts(v, role)) most = std::max(most, repulsive_force(graph.snapshot().pw, c));
      return most;
    };
    weakest = std::min(strongest(path.particles.front(), WallRole::blade), strongest(path.particles.back(), WallRole::vessel));
    for (std::size_t k = 1; k < path.particles.size(); ++k) {
      double link = 0;
      for (const ContactGraph::Neighbor& n : graph.neighbors(path.particles[k - 1]))
        if (n.vertex == path.particles[k]) link = repulsive_force(graph.snapshot().pp, n.contact);
      weakest = std::min(weakest, link);
    }
    EXPECT_EQ(weakest, path.strength);
  });
  EXPECT_GT(bridges, 20);
}

// In how many parts the network falls without one particle, one contact, or nothing (-1).
std::size_t parts(const ContactGraph& graph, long without_particle, long without_contact) {
  std::set<ContactGraph::Vertex> left;
  for (ContactGraph::Vertex v = 0; v < graph.vertex_count(); ++v)
    if (long(v) != without_particle) left.insert(v);
  std::size_t count = 0;
  for (; !left.empty(); ++count) {
    std::vector<ContactGraph::Vertex> next{*left.begin()};
    left.erase(left.begin());
    while (!next.empty()) {
      const ContactGraph::Vertex v = next.back();
      next.pop_back();
      for (const ContactGraph::Neighbor& n : graph.neighbors(v))
        if (long(n.contact) != without_contact && left.erase(n.vertex)) next.push_back(n.vertex);
    }
  }
  return count;
}

TEST(Biconnectivity, IsWhereTheNetworkFallsApart) {
  std::size_t seen = 0;
  for_random_networks(24, [&](const ContactGraph& graph) {
    const Biconnectivity found = biconnectivity(graph);
    const std::size_t whole = parts(graph, -1, -1);
    for (std::uint32_t c = 0; c < graph.edge_count(); ++c) {
      EXPECT_EQ(found.cut_edge[c] != 0, parts(graph, -1, c) > whole) << c;
      seen += found.cut_edge[c];
    }
    for (ContactGraph::Vertex v = 0; v < graph.vertex_count(); ++v)
      EXPECT_EQ(found.articulation_point[v] != 0, parts(graph, v, -1) > whole) << v;
  });
  EXPECT_GT(seen, 100u);
}

// The edges of a cube: five faces of its six make all cycles. A square with one diagonal: two triangles. A ring of seven is longer than asked.
TEST(CycleBasis, OfACubeASquareAndARing) {
  Network cube;
  for (unsigned a = 0; a < 8; ++a)
    for (const unsigned bit : {1u, 2u, 4u})
      if (!(a & bit)) cube.touch(a, a | bit, 1);
  const Snapshot corners = cube.snapshot();
  EXPECT_THAT(basis_cycle_counts(ContactGraph(corners, hand_made_run().walls), 6), ElementsAre(0, 0, 0, 0, 5, 0, 0));
  const Snapshot square = Network().touch(1, 2, 1).touch(2, 3, 1).touch(3, 4, 1).touch(1, 4, 1).touch(1, 3, -1).snapshot();
  EXPECT_THAT(basis_cycle_counts(ContactGraph(square, hand_made_run().walls), 6), ElementsAre(0, 0, 0, 2, 0, 0, 0));
  Network seven;
  for (unsigned a = 0; a < 7; ++a) seven.touch(a, (a + 1) % 7, 1);
  const Snapshot ring = seven.snapshot();
  EXPECT_THAT(basis_cycle_counts(ContactGraph(ring, hand_made_run().walls), 6), ElementsAre(0, 0, 0, 0, 0, 0, 0));
  EXPECT_THAT(basis_cycle_counts(ContactGraph(ring, hand_made_run().walls), 7), ElementsAre(0, 0, 0, 0, 0, 0, 0, 1));
}

// With all lengths allowed as many as there are independent cycles.
TEST(CycleBasis, IsABasis) {
  for_random_networks(20, [](const ContactGraph& graph) {
    std::size_t all = 0;
    for (const std::size_t count : basis_cycle_counts(graph, 20)) all += count;
    EXPECT_EQ(all, graph.edge_count() + connected_components(graph).size.size() - graph.vertex_count());
  });
}

// Three grains in a row: all paths between the outer two lead through the middle one. Of a square's two, each has half.
TEST(Betweenness, OfARowAndOfASquare) {
  const std::vector<ContactGraph::Vertex> three{0, 1, 2}, four{0, 1, 2, 3}, first{0}, last{2};
  Network row;
  for (unsigned i = 0; i < 3; ++i) row.grain(i + 1, Vec3f(0.001f * float(i), 0, 0));
  row.touch(1, 2, 1).touch(2, 3, 1);
  const Snapshot in_row = row.snapshot();
  const ContactGraph line(in_row, hand_made_run().walls);
  EXPECT_THAT(betweenness(line, three, three).particle, ElementsAre(0, 2, 0));
  EXPECT_THAT(betweenness(line, first, last).particle, ElementsAre(0, 1, 0));
  EXPECT_THAT(betweenness(line, first, first).particle, ElementsAre(0, 0, 0));
  Network square;
  for (unsigned i = 0; i < 4; ++i) square.grain(i + 1, Vec3f(0.001f * float(i), 0, 0));
  square.touch(1, 2, 1).touch(2, 3, 1).touch(3, 4, 1).touch(1, 4, 1);
  const Snapshot in_square = square.snapshot();
  const ContactGraph loop(in_square, hand_made_run().walls);
  EXPECT_THAT(betweenness(loop, four, four).particle, ElementsAre(1, 1, 1, 1));
  EXPECT_THAT(betweenness(loop, first, last).particle, ElementsAre(0, 0.5, 0, 0.5));
}

// By its definition: with distances d and numbers of shortest paths n of all pairs, n_st(v) = n_sv n_vt where d_sv + d_vt = d_st.
TEST(Betweenness, IsTheShareOfShortestPaths) {
  for_random_networks(24, [](const ContactGraph& graph) {
    const std::size_t n = graph.vertex_count();
    constexpr int far = 1000;
    std::vector<std::vector<int>> distance(n, std::vector<int>(n, far));
    std::vector<std::vector<double>> paths(n, std::vector<double>(n, 0.0));
    for (std::size_t s = 0; s < n; ++s) {
      distance[s][s] = 0;
      paths[s][s] = 1;
    }
    for (int length = 1; length < int(n); ++length)
      for (std::size_t s = 0; s < n; ++s)
        for (ContactGraph::Vertex v = 0; v < n; ++v) {
          if (distance[s][v] < length) continue;
          double ways = 0;
          for (const ContactGraph::Neighbor& u : graph.neighbors(v))
            if (distance[s][u.vertex] == length - 1) ways += paths[s][u.vertex];
          if (ways > 0) distance[s][v] = length, paths[s][v] = ways;
        }
    std::vector<ContactGraph::Vertex> sources, targets;
    for (ContactGraph::Vertex v = 0; v < n; ++v) {
      if (!graph.wall_contacts(v, WallRole::blade).empty()) sources.push_back(v);
      if (!graph.wall_contacts(v, WallRole::vessel).empty()) targets.push_back(v);
    }
    const std::vector<double> through = bridge_betweenness(graph).particle;
    for (ContactGraph::Vertex v = 0; v < n; ++v) {
      double expected = 0;
      for (const auto s : sources)
        for (const auto t : targets)
          if (s != v && t != v && s != t && distance[s][t] < far && distance[s][v] + distance[v][t] == distance[s][t])
            expected += paths[s][v] * paths[v][t] / paths[s][t];
      EXPECT_NEAR(through[v], expected, 1e-12 * std::max(1.0, expected)) << v;
    }
  });
}

// Blade 6 N, contact 3 N, vessel 2 N in a row: 1 / (1/6 + 1/3 + 1/2) = 1 N. A second grain that blade and vessel press with 4 N adds 2 N.
// Pulling contacts and loose ends conduct nothing.
TEST(BridgeConductance, AddsAsResistorsDo) {
  Network network;
  for (unsigned i = 0; i < 5; ++i) network.grain(i + 1, Vec3f(0.001f * float(i), 0, 0));
  network.press(1, blade_wall, 6).touch(1, 2, 3).press(2, vessel_wall, 2);
  network.touch(2, 4, 100).touch(1, 5, -50).press(5, vessel_wall, 7);
  const Snapshot one = network.snapshot();
  EXPECT_NEAR(bridge_conductance(ContactGraph(one, hand_made_run().walls)), 1, 1e-15);
  network.press(3, blade_wall, 4).press(3, vessel_wall, 4);
  const Snapshot two = network.snapshot();
  EXPECT_NEAR(bridge_conductance(ContactGraph(two, hand_made_run().walls)), 3, 1e-15);
}

TEST(BridgeConductance, IsAtMostTheFlowAndThereWhereTheFlowIs) {
  for_random_networks(40, [](const ContactGraph& graph) {
    const double conductance = bridge_conductance(graph), flow = max_force_flow(graph).value;
    EXPECT_EQ(conductance > 0, flow > 0);
    EXPECT_LE(conductance, flow * (1 + 1e-12));
  });
}

}  // namespace
}  // namespace jam
