// Connected components of the contact network, walls joining nothing, and the independent cycles that go with them.
//
//   component_count          C, single particles included: the zeroth Betti number
//   largest_component_share  share of all particles that belong to the largest; NaN without particles
//   independent_cycles       E - V + C, the cyclomatic number: how many contacts can be taken away without parting anything; the first
//                            Betti number of the graph (not of its flag complex, in which triangles are filled)
#pragma once
#include <limits>

#include "libjam/graph/components.hpp"

namespace jam {

inline double component_count(const Components& components) { return double(components.size.size()); }
inline double largest_component_share(const ContactGraph& graph, const Components& components) {
  if (components.size.empty()) return std::numeric_limits<double>::quiet_NaN();
  return double(components.size.front()) / double(graph.vertex_count());
}
inline double independent_cycles(const ContactGraph& graph, const Components& components) {
  return double(graph.edge_count()) - double(graph.vertex_count()) + component_count(components);
}

}  // namespace jam
