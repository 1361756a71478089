#include "libjam/graph/max_flow.hpp"

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <cmath>

#include "libjam/graph/contact_force.hpp"

namespace jam {
namespace {

using Traits = boost::adjacency_list_traits<boost::vecS, boost::vecS, boost::directedS>;
struct Arc {
  double capacity = 0, residual = 0;
  Traits::edge_descriptor reverse;
};
struct Node {
  boost::default_color_type color{};
  double distance = 0;
  Traits::edge_descriptor predecessor;
};
using Network = boost::adjacency_list<boost::vecS, boost::vecS, boost::directedS, Node, Arc>;

void link(Network& network, std::size_t a, std::size_t b, double forth, double back) {
  const auto there = add_edge(a, b, Arc{forth, 0, {}}, network).first;
  const auto home = add_edge(b, a, Arc{back, 0, there}, network).first;
  network[there].reverse = home;
}

double solve(Network& network, std::size_t source, std::size_t sink) {
  return boost::boykov_kolmogorov_max_flow(network, get(&Arc::capacity, network), get(&Arc::residual, network),
                                           get(&Arc::reverse, network), get(&Node::predecessor, network),
                                           get(&Node::color, network), get(&Node::distance, network),
                                           get(boost::vertex_index, network), source, sink);
}

// What the blade presses each particle with, and each particle the vessel, [N].
std::vector<double> sum_of_walls(const ContactGraph& graph, WallRole role, std::span<const double> capacity) {
  std::vector<double> sum(graph.vertex_count(), 0);
  for (ContactGraph::Vertex v = 0; v < graph.vertex_count(); ++v)
    for (const std::uint32_t c : graph.wall_contacts(v, role)) sum[v] += capacity[c];
  return sum;
}

// Where flow can still go from the source. What rounding leaves of an arc is nothing.
std::vector<std::uint8_t> reached(const Network& network, std::size_t source) {
  std::vector<std::uint8_t> seen(num_vertices(network), 0);
  std::vector<std::size_t> front{source};
  seen[source] = 1;
  while (!front.empty()) {
    const std::size_t v = front.back();
    front.pop_back();
    for (auto [e, end] = out_edges(v, network); e != end; ++e) {
      const Arc& arc = network[*e];
      const double whole = arc.capacity + network[arc.reverse].capacity;
      const std::size_t to = target(*e, network);
      if (seen[to] || !(arc.residual > 1e-12 * whole)) continue;
      seen[to] = 1;
      front.push_back(to);
    }
  }
  return seen;
}

std::vector<double> loads(const ContactGraph& graph, bool ones, bool walls) {
  const std::size_t count = walls ? graph.wall_contact_count() : graph.edge_count();
  std::vector<double> capacity(count);
  for (std::size_t c = 0; c < count; ++c) {
    const double force = walls ? repulsive_force(graph.snapshot().pw, c) : repulsive_force(graph.snapshot().pp, c);
    capacity[c] = ones ? double(force > 0) : force;
  }
  return capacity;
}

}  // namespace

MaxFlow max_flow(const ContactGraph& graph, std::span<const double> pp_capacity, std::span<const double> pw_capacity) {
  const std::size_t n = graph.vertex_count(), blade = n, vessel = n + 1;
  Network network(n + 2);
  const ParticleContacts& pp = graph.snapshot().pp;
  for (std::size_t c = 0; c < pp.size(); ++c)
    if (pp_capacity[c] > 0) link(network, pp.row[c][0], pp.row[c][1], pp_capacity[c], pp_capacity[c]);
  const std::vector<double> from_blade = sum_of_walls(graph, WallRole::blade, pw_capacity);
  const std::vector<double> to_vessel = sum_of_walls(graph, WallRole::vessel, pw_capacity);
  for (std::size_t v = 0; v < n; ++v) {
    if (from_blade[v] > 0) link(network, blade, v, from_blade[v], 0);
    if (to_vessel[v] > 0) link(network, v, vessel, to_vessel[v], 0);
  }
  MaxFlow flow;
  flow.value = solve(network, blade, vessel);
  flow.blade_side = reached(network, blade);
  flow.blade_side.resize(n);
  for (std::uint32_t c = 0; c < pp.size(); ++c)
    if (pp_capacity[c] > 0 && flow.blade_side[pp.row[c][0]] != flow.blade_side[pp.row[c][1]]) flow.cut_pp.push_back(c);
  for (ContactGraph::Vertex v = 0; v < n; ++v)
    for (const std::uint32_t c : graph.wall_contacts(v, flow.blade_side[v] ? WallRole::vessel : WallRole::blade))
      if (pw_capacity[c] > 0) flow.cut_pw.push_back(c);
  std::sort(flow.cut_pw.begin(), flow.cut_pw.end());
  return flow;
}

MaxFlow max_force_flow(const ContactGraph& graph) {
  return max_flow(graph, loads(graph, false, false), loads(graph, false, true));
}

std::size_t contact_disjoint_load_paths(const ContactGraph& graph) {
  return std::size_t(std::lround(max_flow(graph, loads(graph, true, false), loads(graph, true, true)).value));
}

// Each particle as two nodes, one that the paths enter and one that they leave, with room for one path between them.
std::size_t particle_disjoint_load_paths(const ContactGraph& graph) {
  const std::size_t n = graph.vertex_count(), blade = 2 * n, vessel = 2 * n + 1;
  Network network(2 * n + 2);
  const std::vector<double> from_blade = sum_of_walls(graph, WallRole::blade, loads(graph, true, true));
  const std::vector<double> to_vessel = sum_of_walls(graph, WallRole::vessel, loads(graph, true, true));
  for (std::size_t v = 0; v < n; ++v) {
    link(network, 2 * v, 2 * v + 1, 1, 0);
    if (from_blade[v] > 0) link(network, blade, 2 * v, 1, 0);
    if (to_vessel[v] > 0) link(network, 2 * v + 1, vessel, 1, 0);
  }
  const ParticleContacts& pp = graph.snapshot().pp;
  for (std::size_t c = 0; c < pp.size(); ++c) {
    if (!(repulsive_force(pp, c) > 0)) continue;
    const std::size_t a = pp.row[c][0], b = pp.row[c][1];
    link(network, 2 * a + 1, 2 * b, 1, 0);
    link(network, 2 * b + 1, 2 * a, 1, 0);
  }
  return std::size_t(std::lround(solve(network, blade, vessel)));
}

}  // namespace jam
