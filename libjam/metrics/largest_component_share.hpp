// Share of all particles that belong to the largest connected component of the contact network. NaN without particles.
#pragma once
#include <limits>

#include "libjam/graph/components.hpp"

namespace jam {

inline double largest_component_share(const ContactGraph& graph) {
  const Components components = connected_components(graph);
  if (components.size.empty()) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(components.size.front()) / static_cast<double>(graph.vertex_count());
}

}  // namespace jam
