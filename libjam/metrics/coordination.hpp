// Mean number of contacts with other particles, Z = 2 N_pp / N. Walls are not counted (EDEM's convention); an adhesive
// contact counts until it separates. Geometric: a contact counts whatever its force. NaN without particles.
#pragma once
#include <limits>

#include "libjam/graph/contact_graph.hpp"

namespace jam {

inline double coordination(const ContactGraph& graph) {
  if (graph.vertex_count() == 0) return std::numeric_limits<double>::quiet_NaN();
  return 2.0 * static_cast<double>(graph.edge_count()) / static_cast<double>(graph.vertex_count());
}

}  // namespace jam
