// The particles under load in every frame, kept with an analysis so that its jams can be counted again at another threshold, and its report drawn, without
// a second look at the frames.
#pragma once
#include <cstdint>
#include <vector>

#include "libjam/graph/contact_graph.hpp"
#include "libjam/jamming/criteria.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jam {

struct LoadedGrain {
  ParticleId particle = 0;
  double force = 0;                 // N, compressive
  Vec3f position = Vec3f::Zero();   // m
  float speed = 0;                  // m/s, NaN where the source has no velocities
  bool in_gap = false;
};

// Where particles are: the smallest upright box around their spheres, m. Upside down where there are none.
struct Extent {
  Vec3 low, high;
  Extent();
  void include(const Extent& other);
};

struct LoadedGrains {
  static constexpr double floor_share = 0.01;       // of Criteria::jam_force: loads below are not kept
  static constexpr std::size_t most = 200'000;      // and the floor rises until so many are left

  double floor = 0;                                 // N; every particle above it is here
  std::vector<std::uint32_t> count;                 // [F] of each frame
  std::vector<LoadedGrain> grains;                  // by frame, then ascending by particle
  Extent extent;                                    // of all particles of all frames

  // Those of the next frame that are above the floor.
  void add(const std::vector<LoadedGrain>& frame);
  // Raises the floor to the force of the strongest that is left out, so that `most` stay at the most. Equal forces go together.
  void keep(std::size_t most);
};

// Those of one frame above floor_share of the jam force.
std::vector<LoadedGrain> loaded_grains(const ContactGraph& graph, const std::vector<double>& compressive_force, const RunInfo& info, const Criteria& criteria);
Extent extent_of(const Particles& particles);

}  // namespace jam
