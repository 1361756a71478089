// Mean number of contacts of a particle, walls included, (2 N_pp + N_pw) / N. NaN without particles.
#pragma once
#include <limits>

#include "libjam/graph/contact_graph.hpp"

namespace jam {

inline double coordination_with_walls(const ContactGraph& graph) {
  if (graph.vertex_count() == 0) return std::numeric_limits<double>::quiet_NaN();
  return (2.0 * static_cast<double>(graph.edge_count()) + static_cast<double>(graph.wall_contact_count())) /
         static_cast<double>(graph.vertex_count());
}

}  // namespace jam
