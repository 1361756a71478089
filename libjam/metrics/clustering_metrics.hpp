// How far partners of a particle touch each other. Every recorded contact counts once, whatever its force. With T_i triangles at
// particle i (libjam/graph/triangles.hpp) and z_i contacts of it with particles:
//
//   triangle_count          T, triangles of the network
//   transitivity            3 T over the number of pairs of contacts that share a particle: the global clustering coefficient
//   clustering_coefficient  C_i = 2 T_i/(z_i (z_i - 1)) of each particle (Watts and Strogatz, Nature 393, 440, 1998); NaN for z_i < 2
//   force_clustering        the same with the contacts' repulsive forces f as weights (Barrat et al., PNAS 101, 3747, 2004): the sum over the
//                           triangles of particle i of f_ij + f_ih, over (z_i - 1) sum_j f_ij; NaN for z_i < 2 and where nothing pushes i
//   mean_clustering         mean of C_i over the particles that have one (igraph's "nan"; networkx counts the others as 0)
//
// NaN where nothing is divided by.
#pragma once
#include <cmath>
#include <limits>
#include <vector>

#include "libjam/graph/contact_force.hpp"
#include "libjam/graph/contact_graph.hpp"
#include "libjam/graph/triangles.hpp"

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

inline std::vector<double> force_clustering(const ContactGraph& graph) {
  const ParticleContacts& pp = graph.snapshot().pp;
  std::vector<double> closed(graph.vertex_count(), 0.0);
  for_each_triangle(graph, [&](const ContactTriangle& t) {
    const double first = repulsive_force(pp, t.contact[0]), second = repulsive_force(pp, t.contact[1]), third = repulsive_force(pp, t.contact[2]);
    closed[t.particle[0]] += first + second;
    closed[t.particle[1]] += first + third;
    closed[t.particle[2]] += second + third;
  });
  std::vector<double> clustering(graph.vertex_count(), std::numeric_limits<double>::quiet_NaN());
  for (ContactGraph::Vertex v = 0; v < graph.vertex_count(); ++v) {
    double strength = 0;
    for (const ContactGraph::Neighbor& n : graph.neighbors(v)) strength += repulsive_force(pp, n.contact);
    if (graph.degree(v) >= 2 && strength > 0) clustering[v] = closed[v] / (double(graph.degree(v) - 1) * strength);
  }
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
