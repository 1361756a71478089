// Jams in time.
#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "libjam/events/jam_frame.hpp"

namespace jam {

// An uninterrupted stay above the threshold, seen in snapshots that are `sampling_interval` D apart.
//
// A jam of true duration d that starts at a random phase of the sampling gives n samples with probability
// max(0, 1 - |d/D - n|). So n samples bracket d in ((n-1) D, (n+1) D), and E[n D] = d exactly when jams that fall
// between two samples are counted with n = 0: `survival_time` is n D. A jam shorter than D is missed with probability 1
// - d/D. The bracket of an event that the record cuts off has no upper end.
struct JamEvent {
  std::uint32_t first_frame = 0, last_frame = 0;  // inclusive
  std::uint32_t samples = 0;                      // n, from first to last; with pauses that Criteria::hold_off allows
  double start = 0, end = 0;                      // s, times of the first and last sample above the threshold
  double survival_time = 0;                       // s, n D
  double shortest = 0, longest = 0;               // s, the bracket; longest = infinity where open
  bool open_at_start = false,
       open_at_end = false;              // censored: the record, or a gap in it, begins or ends inside the event
  double peak_force = 0, peak_time = 0;  // N, s; ties: earliest, then smallest id
  ParticleId peak_particle = 0;
  bool peak_in_gap = false;
  bool bridged = false;             // a bridging cluster existed in at least one of its frames
  double least_gap = std::numeric_limits<double>::quiet_NaN();  // m, the smallest Cluster::least_gap of its frames; NaN where never bridged
  std::vector<ParticleId> members;  // every particle jammed at some time during the event, ascending
};

// One particle's uninterrupted stay above the threshold: the per-particle stream, with its path. It is bridged when the
// particle belonged to a bridging cluster in at least one of its frames.
struct Track {
  ParticleId particle = 0;
  JamEvent event;  // members = {particle}
  struct Point : JammedSample {
    std::uint32_t frame = 0;
  };
  std::vector<Point> points;  // its frames above the threshold, and those above Criteria::end_force around them
};

}  // namespace jam
