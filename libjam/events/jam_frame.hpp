// What the events are made of: of every frame its time and its jammed particles, nothing else. So a run of any length
// is kept in memory as frames + jammed samples.
#pragma once
#include <span>
#include <vector>

#include "libjam/snapshot/snapshot.hpp"

namespace jam {

struct JammedSample {
  ParticleId particle = 0;
  Vec3f position = Vec3f::Zero(), velocity = Vec3f::Zero();  // m, m/s (NaN where the source has none)
  double compressive_force = 0;                              // N, above the threshold
  bool in_gap = false;
  bool bridged = false;  // belongs to a bridging cluster in this frame
};

struct JamFrame {
  double time = 0;                   // s
  std::vector<JammedSample> jammed;  // ascending by particle
};

// D: the median distance of consecutive frames, s (the mean of the middle two where their number is even); 0 for fewer
// than two frames.
double sampling_interval(std::span<const JamFrame> frames);

// True where frames are missing between k - 1 and k: they are more than 1.5 D apart. Events do not cross such a gap.
bool gap_before(std::span<const JamFrame> frames, std::size_t k, double sampling_interval);

}  // namespace jam
