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
  using Neighbor = ContactGraph::Neighbor;
  std::vector<const Neighbor*> later(graph.vertex_count());  // the first partner of larger row
  for (ContactGraph::Vertex v = 0; v < later.size(); ++v) {
    const auto all = graph.neighbors(v);
    later[v] = std::partition_point(all.data(), all.data() + all.size(), [v](const Neighbor& n) { return n.vertex < v; });
  }
  for (ContactGraph::Vertex u = 0; u < later.size(); ++u) {
    const Neighbor* const end_of_u = graph.neighbors(u).data() + graph.degree(u);
    for (const Neighbor* second = later[u]; second != end_of_u; ++second) {
      const ContactGraph::Vertex v = second->vertex;
      const Neighbor *a = second + 1, *b = later[v], *const end_of_v = graph.neighbors(v).data() + graph.degree(v);
      while (a != end_of_u && b != end_of_v) {
        if (a->vertex == b->vertex) f(ContactTriangle{{u, v, a->vertex}, {second->contact, a->contact, b->contact}});
        const bool a_next = a->vertex <= b->vertex, b_next = b->vertex <= a->vertex;
        a += a_next;
        b += b_next;
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
