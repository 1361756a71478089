// Triangles: three particles that touch each other in pairs, the shortest loops of a contact network. Every contact counts,
// whatever its force. Takes time in proportion to the contacts times their particles' number of partners.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "libjam/graph/contact_graph.hpp"

namespace jam {

struct ContactTriangle {
  std::array<ContactGraph::Vertex, 3> particle;  // ascending
  std::array<std::uint32_t, 3> contact;          // of the first with the second, of the first with the third, of the second with the third
};

// f(triangle) for each, once: from its contact of the two smallest rows, of both of whom the third is a later partner.
template <class F>
void for_each_triangle(const ContactGraph& graph, F f) {
  const auto later = [](std::span<const ContactGraph::Neighbor> neighbors, ContactGraph::Vertex v) {
    return std::upper_bound(neighbors.begin(), neighbors.end(), v,
                            [](ContactGraph::Vertex a, const ContactGraph::Neighbor& b) { return a < b.vertex; });
  };
  for (std::uint32_t c = 0; c < graph.edge_count(); ++c) {
    const auto [u, v] = graph.snapshot().pp.row[c];
    const auto of_u = graph.neighbors(u), of_v = graph.neighbors(v);
    auto a = later(of_u, v), b = later(of_v, v);
    while (a != of_u.end() && b != of_v.end()) {
      if (a->vertex == b->vertex) {
        f(ContactTriangle{{u, v, a->vertex}, {c, a->contact, b->contact}});
        ++a, ++b;
      } else if (a->vertex < b->vertex) {
        ++a;
      } else {
        ++b;
      }
    }
  }
}

// [N] in how many triangles each particle is.
inline std::vector<std::uint32_t> triangles(const ContactGraph& graph) {
  std::vector<std::uint32_t> count(graph.vertex_count(), 0);
  for_each_triangle(graph, [&](const ContactTriangle& t) {
    for (const ContactGraph::Vertex v : t.particle) ++count[v];
  });
  return count;
}

}  // namespace jam
