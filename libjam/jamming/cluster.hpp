// A jam in one frame.
#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "libjam/snapshot/snapshot.hpp"

namespace jam {

// A connected component of the jammed sub-network in one frame. Walls are labelled ends, never nodes.
struct Cluster {
  std::uint32_t frame = 0;
  std::vector<ParticleId> members;           // ascending
  bool bridges = false;                      // loaded by a blade and by a vessel
  double blade_force = 0, vessel_force = 0;  // N, sum of the repulsive normal forces with walls of that role
  double largest_compressive_force = 0;      // N
  std::uint32_t in_gap = 0;                  // members in the gap
  // m, where it bridges: the smallest distance between a point at which a blade and one at which a vessel carries it. NaN where it does not
  // bridge, or the source does not know the points.
  double least_gap = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace jam
