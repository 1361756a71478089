#include "libjam/graph/rattlers.hpp"

namespace jam {

std::vector<std::uint8_t> rattlers(const ContactGraph& graph, std::uint32_t least) {
  const std::size_t n = graph.vertex_count();
  std::vector<std::uint8_t> loose(n, 0);
  std::vector<std::uint32_t> left(n);
  std::vector<ContactGraph::Vertex> falling;
  for (ContactGraph::Vertex v = 0; v < n; ++v) {
    left[v] = std::uint32_t(graph.degree(v) + graph.wall_contacts(v).size());
    if (left[v] < least) {
      loose[v] = 1;
      falling.push_back(v);
    }
  }
  while (!falling.empty()) {
    const ContactGraph::Vertex v = falling.back();
    falling.pop_back();
    for (const ContactGraph::Neighbor& neighbor : graph.neighbors(v)) {
      const ContactGraph::Vertex u = neighbor.vertex;
      if (loose[u] || --left[u] >= least) continue;
      loose[u] = 1;
      falling.push_back(u);
    }
  }
  return loose;
}

}  // namespace jam
