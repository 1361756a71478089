#include "libjam/graph/betweenness.hpp"

#include <cstdint>
#include <limits>

namespace jam {
namespace {

std::vector<ContactGraph::Vertex> particles_at(const ContactGraph& graph, WallRole role) {
  std::vector<ContactGraph::Vertex> touching;
  for (ContactGraph::Vertex v = 0; v < graph.vertex_count(); ++v)
    if (!graph.wall_contacts(v, role).empty()) touching.push_back(v);
  return touching;
}

}  // namespace

std::vector<double> betweenness(const ContactGraph& graph, std::span<const ContactGraph::Vertex> sources,
                                std::span<const ContactGraph::Vertex> targets) {
  constexpr std::uint32_t far = std::numeric_limits<std::uint32_t>::max();
  const std::size_t n = graph.vertex_count();
  std::vector<double> through(n, 0.0), paths(n, 0.0), dependency(n, 0.0), wanted(n, 0.0);
  for (const ContactGraph::Vertex t : targets) wanted[t] = 1;
  std::vector<std::uint32_t> distance(n, far);
  std::vector<ContactGraph::Vertex> order;
  order.reserve(n);
  for (const ContactGraph::Vertex s : sources) {
    order.assign(1, s);
    distance[s] = 0;
    paths[s] = 1;
    for (std::size_t k = 0; k < order.size(); ++k) {
      const ContactGraph::Vertex v = order[k];
      for (const ContactGraph::Neighbor& neighbor : graph.neighbors(v)) {
        const ContactGraph::Vertex u = neighbor.vertex;
        if (distance[u] == far) {
          distance[u] = distance[v] + 1;
          order.push_back(u);
        }
        if (distance[u] == distance[v] + 1) paths[u] += paths[v];
      }
    }
    // From the farthest back: a particle hands to each of those one nearer its part of the paths that end at it or behind it.
    for (std::size_t k = order.size(); k-- > 0;) {
      const ContactGraph::Vertex u = order[k];
      const double each = (wanted[u] + dependency[u]) / paths[u];
      for (const ContactGraph::Neighbor& neighbor : graph.neighbors(u))
        if (distance[neighbor.vertex] + 1 == distance[u]) dependency[neighbor.vertex] += paths[neighbor.vertex] * each;
      if (u != s) through[u] += dependency[u];
    }
    for (const ContactGraph::Vertex v : order) {
      distance[v] = far;
      paths[v] = dependency[v] = 0;
    }
  }
  return through;
}

std::vector<double> bridge_betweenness(const ContactGraph& graph) {
  return betweenness(graph, particles_at(graph, WallRole::blade), particles_at(graph, WallRole::vessel));
}

}  // namespace jam
