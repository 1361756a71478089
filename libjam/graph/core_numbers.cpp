#include "libjam/graph/core_numbers.hpp"

#include <algorithm>

namespace jam {

// Particles are kept sorted by how many of their partners are left; the first is taken away, and its partners move one place
// down: to the beginning of the particles with as many, which then are those with one fewer.
std::vector<std::uint32_t> core_numbers(const ContactGraph& graph) {
  const std::size_t n = graph.vertex_count();
  std::vector<std::uint32_t> left(n), begin;  // begin[d]: where the particles with d partners left begin
  for (ContactGraph::Vertex v = 0; v < n; ++v) {
    left[v] = std::uint32_t(graph.degree(v));
    if (begin.size() < left[v] + 2) begin.resize(left[v] + 2, 0);
    ++begin[left[v] + 1];
  }
  for (std::size_t d = 1; d < begin.size(); ++d) begin[d] += begin[d - 1];
  std::vector<std::uint32_t> place(n), sorted(n), next = begin;
  for (ContactGraph::Vertex v = 0; v < n; ++v) {
    place[v] = next[left[v]]++;
    sorted[place[v]] = v;
  }
  for (std::size_t k = 0; k < n; ++k) {
    const ContactGraph::Vertex v = sorted[k];
    for (const ContactGraph::Neighbor& neighbor : graph.neighbors(v)) {
      const ContactGraph::Vertex u = neighbor.vertex;
      if (left[u] <= left[v]) continue;
      const std::uint32_t to = begin[left[u]]++;
      const ContactGraph::Vertex other = sorted[to];
      std::swap(sorted[place[u]], sorted[to]);
      place[other] = place[u];
      place[u] = to;
      --left[u];
    }
  }
  return left;
}

}  // namespace jam
