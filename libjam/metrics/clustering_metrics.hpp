// How far partners of a particle touch each other. Every recorded contact counts once, whatever its force. With T_i triangles at
// particle i (libjam/graph/triangles.hpp) and z_i contacts of it with particles:
//
//   triangle_count          T, triangles of the network
//   transitivity            3 T over the number of pairs of contacts that share a particle: the global clustering coefficient
//   clustering_coefficient  C_i = 2 T_i/(z_i (z_i - 1)) of each particle (Watts and Strogatz, Nature 393, 440, 1998); NaN for z_i < 2
//   mean_clustering         mean of C_i over the particles that have one (igraph's "nan"; networkx counts the others as 0)
//
// NaN where nothing is divided by.
#pragma once
#include <cmath>
#include <limits>
#include <vector>

#include "libjam/graph/contact_graph.hpp"

namespace jam {

inline double triangle_count(const std::vector<std::uint32_t>& triangles) {
  double corners = 0;
  for (const std::uint32_t count : triangles) corners += count;
  return corners / 3;
}

inline double transitivity(const ContactGraph& graph, const std::vector<std::uint32_t>& triangles) {
  double pairs = 0;
  for (ContactGraph::Vertex v = 0; v < graph.vertex_count(); ++v) {
    const double z = double(graph.degree(v));
    pairs += z * (z - 1) / 2;
  }
  return pairs > 0 ? 3 * triangle_count(triangles) / pairs : std::numeric_limits<double>::quiet_NaN();
}

inline std::vector<double> clustering_coefficient(const ContactGraph& graph, const std::vector<std::uint32_t>& triangles) {
  std::vector<double> clustering(graph.vertex_count(), std::numeric_limits<double>::quiet_NaN());
  for (ContactGraph::Vertex v = 0; v < graph.vertex_count(); ++v)
    if (const double z = double(graph.degree(v)); z >= 2) clustering[v] = 2 * triangles[v] / (z * (z - 1));
  return clustering;
}

inline double mean_clustering(const ContactGraph& graph, const std::vector<std::uint32_t>& triangles) {
  double sum = 0, counted = 0;
  for (const double c : clustering_coefficient(graph, triangles)) {
    if (std::isnan(c)) continue;
    sum += c;
    counted += 1;
  }
  return counted > 0 ? sum / counted : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace jam
