// Particle contacts whose tangential force is at its friction limit, as the source recorded it, and the network that they make.
//
//   sliding_share                    share of the particle contacts; NaN without contacts
//   sliding_per_particle             n_m, sliding contacts per particle; NaN without particles
//   largest_sliding_cluster_share    share of all particles in the largest cluster that sliding contacts join; NaN without particles, 0
//                                    where nothing slides
//
// NaN where the source does not know.
#pragma once
#include <limits>

#include "libjam/graph/components.hpp"

namespace jam {

inline bool sliding_known(const ContactGraph& graph) { return present(graph.snapshot().pp.flags, graph.edge_count()); }

inline std::vector<std::uint8_t> sliding_contacts(const ContactGraph& graph) {
  std::vector<std::uint8_t> sliding(graph.edge_count(), 0);
  if (sliding_known(graph))
    for (std::size_t c = 0; c < sliding.size(); ++c) sliding[c] = (graph.snapshot().pp.flags[c] & contact_sliding) != 0;
  return sliding;
}

inline double count_of_sliding(const ContactGraph& graph) {
  double count = 0;
  for (const std::uint8_t slides : sliding_contacts(graph)) count += slides;
  return count;
}
inline double sliding_share(const ContactGraph& graph) {
  if (graph.edge_count() == 0 || !sliding_known(graph)) return std::numeric_limits<double>::quiet_NaN();
  return count_of_sliding(graph) / double(graph.edge_count());
}
inline double sliding_per_particle(const ContactGraph& graph) {
  if (graph.vertex_count() == 0 || !sliding_known(graph)) return std::numeric_limits<double>::quiet_NaN();
  return count_of_sliding(graph) / double(graph.vertex_count());
}
inline double largest_sliding_cluster_share(const ContactGraph& graph) {
  if (graph.vertex_count() == 0 || !sliding_known(graph)) return std::numeric_limits<double>::quiet_NaN();
  const std::uint32_t largest = connected_components(graph, sliding_contacts(graph)).size[0];
  return largest > 1 ? double(largest) / double(graph.vertex_count()) : 0;
}

}  // namespace jam
