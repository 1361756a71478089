// Force chains after Peters, Muthuswamy, Wibowo and Tordesillas, Phys. Rev. E 72, 041307 (2005): lines of particles that carry more
// than the average along the line.
//
//   (a) each particle of a chain carries a most compressive principal stress above `level` times the mean of all particles under
//       compression;
//   (b) where two of them touch, the line between their centres is within `angle` of the direction of both loads;
//   (c) a chain has at least `least` particles.
//
// Peters' walk from particle to particle depends on where it begins. Here nothing does: contacts that fulfil (b) are links; a branching
// chain is a connected component of them. In a linear chain each particle keeps, on either side of the plane at right angles to its
// load, the link that deviates least from its load (ties: the partner of smaller row), and a link stays when both ends keep it.
// Walls are ends, not members.
#pragma once
#include <vector>

#include "libjam/graph/particle_stress.hpp"

namespace jam {

struct ChainRules {
  double level = 1;            // 1
  double angle = 0.785398163397448;  // rad, 45 degrees
  std::size_t least = 3;       // particles
  bool branching = false;
};

struct ForceChain {
  std::vector<ContactGraph::Vertex> particles;  // a linear chain from the end of smaller row to the other, a ring from its smallest row
                                                // towards its smaller neighbour; a branching chain ascending
  std::size_t links = 0;
  double contour = 0;     // m, sum of the links' lengths
  double end_to_end = 0;  // m, distance of the first and the last particle; of a branching chain the largest between two particles
  bool at_blade = false, at_vessel = false;  // a particle of it is pressed by that wall
};

// Longest first, ties by their smallest row. `load` is [N].
std::vector<ForceChain> force_chains(const ContactGraph& graph, const std::vector<Load>& load, const ChainRules& rules = {});

}  // namespace jam
