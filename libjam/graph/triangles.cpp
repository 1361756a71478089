#include "libjam/graph/triangles.hpp"

#include <algorithm>

namespace jam {

// Each is found once, from its contact of the two smallest rows: the third is a later partner of both.
std::vector<std::uint32_t> triangles(const ContactGraph& graph) {
  std::vector<std::uint32_t> count(graph.vertex_count(), 0);
  const auto later = [](std::span<const ContactGraph::Neighbor> neighbors, ContactGraph::Vertex v) {
    return std::upper_bound(neighbors.begin(), neighbors.end(), v,
                            [](ContactGraph::Vertex a, const ContactGraph::Neighbor& b) { return a < b.vertex; });
  };
  for (const auto& [u, v] : graph.snapshot().pp.row) {
    const auto of_u = graph.neighbors(u), of_v = graph.neighbors(v);
    auto a = later(of_u, v), b = later(of_v, v);
    while (a != of_u.end() && b != of_v.end()) {
      if (a->vertex == b->vertex) {
        ++count[u], ++count[v], ++count[a->vertex];
        ++a, ++b;
      } else if (a->vertex < b->vertex) {
        ++a;
      } else {
        ++b;
      }
    }
  }
  return count;
}

}  // namespace jam
