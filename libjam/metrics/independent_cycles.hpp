// Cyclomatic number of the contact network, E - V + C: how many contacts can be taken away without parting anything; the first Betti
// number of the graph (not of its flag complex, in which triangles are filled).
#pragma once
#include "libjam/graph/components.hpp"

namespace jam {

inline double independent_cycles(const ContactGraph& graph) {
  return double(graph.edge_count()) - double(graph.vertex_count()) + double(connected_components(graph).size.size());
}

}  // namespace jam
