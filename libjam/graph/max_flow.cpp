#include "libjam/graph/max_flow.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "libjam/graph/contact_force.hpp"
#include "libjam/graph/minimum_cut.hpp"

namespace jam {
namespace {

// What the blade presses each particle with, and each particle the vessel, [N].
std::vector<double> sum_of_walls(const ContactGraph& graph, WallRole role, std::span<const double> capacity) {
  std::vector<double> sum(graph.vertex_count(), 0);
  for (ContactGraph::Vertex v = 0; v < graph.vertex_count(); ++v)
    for (const std::uint32_t c : graph.wall_contacts(v, role)) sum[v] += capacity[c];
  return sum;
}

// Capacities as whole numbers of the finest step, a power of two, with which no sum exceeds 2^60. The flow is at most `bound`, so that
// twice that is as good as no limit at all. What can carry anything keeps carrying something.
class WholeNumbers {
 public:
  WholeNumbers(double bound, double largest_sum)
      : limit_(bound > 0 ? 2 * bound : 1), steps_(bound > 0 ? std::exp2(60 - std::ceil(std::log2(std::max(limit_, largest_sum)))) : 1) {}
  std::int64_t operator()(double capacity) const { return std::max(std::int64_t{1}, std::int64_t(std::llrint(std::min(capacity, limit_) * steps_))); }

 private:
  double limit_, steps_;
};

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
  const std::uint32_t n = std::uint32_t(graph.vertex_count()), blade = n, vessel = n + 1;
  const ParticleContacts& pp = graph.snapshot().pp;
  const std::vector<double> from_blade = sum_of_walls(graph, WallRole::blade, pw_capacity);
  const std::vector<double> to_vessel = sum_of_walls(graph, WallRole::vessel, pw_capacity);
  const double pressed_in = std::reduce(from_blade.begin(), from_blade.end());
  const double pressed_out = std::reduce(to_vessel.begin(), to_vessel.end());
  const WholeNumbers whole(std::min(pressed_in, pressed_out), std::max(pressed_in, pressed_out));
  std::vector<FlowLink> links;
  links.reserve(pp.size() + graph.wall_contact_count());
  for (std::size_t c = 0; c < pp.size(); ++c)
    if (pp_capacity[c] > 0) {
      const std::int64_t capacity = whole(pp_capacity[c]);
      links.push_back({pp.row[c][0], pp.row[c][1], capacity, capacity});
    }
  for (std::uint32_t v = 0; v < n; ++v) {
    if (from_blade[v] > 0) links.push_back({blade, v, whole(from_blade[v]), 0});
    if (to_vessel[v] > 0) links.push_back({v, vessel, whole(to_vessel[v]), 0});
  }
  MaxFlow flow;
  flow.blade_side = minimum_cut(n + 2, links, blade, vessel).source_side;
  flow.blade_side.resize(n);
  for (std::uint32_t c = 0; c < pp.size(); ++c)
    if (pp_capacity[c] > 0 && flow.blade_side[pp.row[c][0]] != flow.blade_side[pp.row[c][1]]) {
      flow.cut_pp.push_back(c);
      flow.value += pp_capacity[c];
    }
  for (ContactGraph::Vertex v = 0; v < n; ++v)
    for (const std::uint32_t c : graph.wall_contacts(v, flow.blade_side[v] ? WallRole::vessel : WallRole::blade))
      if (pw_capacity[c] > 0) {
        flow.cut_pw.push_back(c);
        flow.value += pw_capacity[c];
      }
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
  const std::uint32_t n = std::uint32_t(graph.vertex_count()), blade = 2 * n, vessel = 2 * n + 1;
  const std::vector<double> from_blade = sum_of_walls(graph, WallRole::blade, loads(graph, true, true));
  const std::vector<double> to_vessel = sum_of_walls(graph, WallRole::vessel, loads(graph, true, true));
  std::vector<FlowLink> links;
  for (std::uint32_t v = 0; v < n; ++v) {
    links.push_back({2 * v, 2 * v + 1, 1, 0});
    if (from_blade[v] > 0) links.push_back({blade, 2 * v, 1, 0});
    if (to_vessel[v] > 0) links.push_back({2 * v + 1, vessel, 1, 0});
  }
  const ParticleContacts& pp = graph.snapshot().pp;
  for (std::size_t c = 0; c < pp.size(); ++c) {
    if (!(repulsive_force(pp, c) > 0)) continue;
    const std::uint32_t a = pp.row[c][0], b = pp.row[c][1];
    links.push_back({2 * a + 1, 2 * b, 1, 0});
    links.push_back({2 * b + 1, 2 * a, 1, 0});
  }
  return std::size_t(minimum_cut(2 * n + 2, links, blade, vessel).value);
}

}  // namespace jam
