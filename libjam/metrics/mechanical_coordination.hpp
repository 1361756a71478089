// Mean coordination of the particles that take part in the force network (Thornton, Geotechnique 50, 43, 2000):
//
//   Z_m = (2 N_pp - N_1) / (N - N_0 - N_1)
//
// with N_0 and N_1 the particles without and with exactly one particle contact. Walls are not counted. NaN where no
// particle has two contacts.
#pragma once
#include <limits>

#include "libjam/graph/contact_graph.hpp"

namespace jam {

inline double mechanical_coordination(const ContactGraph& graph) {
  std::size_t with_one = 0, with_more = 0;
  for (ContactGraph::Vertex v = 0; v < graph.vertex_count(); ++v) {
    with_one += graph.degree(v) == 1;
    with_more += graph.degree(v) > 1;
  }
  if (with_more == 0) return std::numeric_limits<double>::quiet_NaN();
  return (2.0 * static_cast<double>(graph.edge_count()) - static_cast<double>(with_one)) /
         static_cast<double>(with_more);
}

}  // namespace jam
