// How far partners of a particle touch each other. Every recorded contact counts once, whatever its force.
//
//   triangle_count    T, triangles of the network
//   transitivity      3 T over the number of pairs of contacts that share a particle: the global clustering coefficient
//   mean_clustering   mean of C_i = 2 T_i/(z_i (z_i - 1)) over the particles with z_i >= 2 (Watts and Strogatz, Nature 393, 440, 1998);
//                     particles with fewer have no C and are left out (igraph's "nan"; networkx counts them as 0)
//
// NaN where nothing is divided by.
#pragma once
#include <limits>

#include "libjam/graph/triangles.hpp"

namespace jam {

inline double triangle_count(const ContactGraph& graph) {
  double corners = 0;
  for (const std::uint32_t count : triangles(graph)) corners += count;
  return corners / 3;
}

inline double transitivity(const ContactGraph& graph) {
  double corners = 0, pairs = 0;
  const std::vector<std::uint32_t> count = triangles(graph);
  for (ContactGraph::Vertex v = 0; v < graph.vertex_count(); ++v) {
    const double z = double(graph.degree(v));
    corners += count[v];
    pairs += z * (z - 1) / 2;
  }
  return pairs > 0 ? corners / pairs : std::numeric_limits<double>::quiet_NaN();
}

inline double mean_clustering(const ContactGraph& graph) {
  double sum = 0, counted = 0;
  const std::vector<std::uint32_t> count = triangles(graph);
  for (ContactGraph::Vertex v = 0; v < graph.vertex_count(); ++v) {
    const double z = double(graph.degree(v));
    if (z < 2) continue;
    sum += 2 * count[v] / (z * (z - 1));
    counted += 1;
  }
  return counted > 0 ? sum / counted : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace jam
