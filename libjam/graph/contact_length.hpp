// How long a contact is for paths through the network, [C]. Not a weight: paths seek what is short.
//
//   branch_lengths     m, distance of the two centres
//   inverse_forces     1/N, 1/f of the repulsive normal force: paths seek the strong contacts; infinite, not to be walked, where f <= 0
//   branch_per_force   m/N, distance over force: the compliance of a chain of springs that are the stiffer the more they carry
#pragma once
#include <limits>
#include <vector>

#include "libjam/graph/contact_force.hpp"
#include "libjam/graph/contact_graph.hpp"

namespace jam {

inline std::vector<double> branch_lengths(const ContactGraph& graph) {
  const Snapshot& s = graph.snapshot();
  std::vector<double> length;
  length.reserve(s.pp.size());
  for (const auto& [a, b] : s.pp.row)
    length.push_back((s.particles.position[b].cast<double>() - s.particles.position[a].cast<double>()).norm());
  return length;
}

inline std::vector<double> inverse_forces(const ContactGraph& graph) {
  std::vector<double> length(graph.edge_count(), std::numeric_limits<double>::infinity());
  for (std::size_t c = 0; c < length.size(); ++c)
    if (const double force = repulsive_force(graph.snapshot().pp, c); force > 0) length[c] = 1 / force;
  return length;
}

inline std::vector<double> branch_per_force(const ContactGraph& graph) {
  std::vector<double> length = branch_lengths(graph);
  const std::vector<double> inverse = inverse_forces(graph);
  for (std::size_t c = 0; c < length.size(); ++c) length[c] *= inverse[c];
  return length;
}

}  // namespace jam
