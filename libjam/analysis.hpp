// The story of libjam in one screen: snapshots go in one at a time, in order of time; what jammed, when and how comes out.
//
//   Pipeline pipeline(info, criteria);
//   for (each snapshot) pipeline.add(snapshot);      // a running simulation and a stored file call the same function
//   Analysis a = pipeline.finish(series);
//
// The result is a plain value. The same snapshots give the same bytes, in place and again from the file.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "libjam/jamming/criteria.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jam {

// One row per snapshot (paper, Figs 5, 11 and 12).
struct FrameSummary {
  double time = 0;  // s
  std::uint64_t step = 0;
  std::uint32_t particles = 0, particle_contacts = 0, wall_contacts = 0;
  double coordination = 0;             // 2 N_pp / N, geometric, without walls
  double coordination_with_walls = 0;  // (2 N_pp + N_pw) / N
  double largest_compressive_force = 0, mean_compressive_force = 0;  // N
  ParticleId largest_particle = 0;     // which particle carries it; ties: smallest id
  std::uint32_t jammed = 0;            // particles above the jam force
  std::uint32_t jammed_in_gap = 0;     // of those, how many sit in the gap between blade tip and vessel
  std::uint32_t bridges = 0;           // clusters that carry force from a blade to a vessel
  std::uint32_t largest_bridge = 0;    // particles in the largest of them
};

// A connected component of the jammed sub-network in one frame. Walls are labelled ends, never nodes.
struct Cluster {
  std::uint32_t frame = 0;
  std::vector<ParticleId> members;   // ascending
  bool bridges = false;              // loaded by a blade and by a vessel
  double blade_force = 0, vessel_force = 0;  // N, sum of the normal forces with walls of that role
  double largest_compressive_force = 0;      // N
  std::uint32_t in_gap = 0;          // members in the gap
};

// An uninterrupted stay above the threshold, seen in snapshots that are `sampling_interval` apart.
// n samples above the threshold bracket the true duration in ((n-1) D, (n+1) D); `survival_time` is n D, whose mean over
// all events is exact (reference: libjam guide "sampling kernel").
struct JamEvent {
  std::uint32_t first_frame = 0, last_frame = 0;  // inclusive
  std::uint32_t samples = 0;                      // n
  double start = 0, end = 0;                      // s, times of the first and last sample above the threshold
  double survival_time = 0;                       // s, n D
  double shortest = 0, longest = 0;               // s, the bracket
  bool open_at_start = false, open_at_end = false;  // censored: the record begins or ends inside the event
  double peak_force = 0, peak_time = 0;           // N, s
  ParticleId peak_particle = 0;
  bool peak_in_gap = false;
  bool bridged = false;                           // a bridging cluster existed in at least one of its frames
  std::vector<ParticleId> members;                // every particle jammed at some time during the event, ascending
};

// One particle's uninterrupted stay above the threshold: the per-particle stream, with its path.
struct Track {
  ParticleId particle = 0;
  JamEvent event;  // members = {particle}
  struct Point {
    std::uint32_t frame;
    Vec3f position, velocity;  // m, m/s (velocity NaN where the source has none)
    float compressive_force;   // N
  };
  std::vector<Point> points;  // its frames above the threshold
};

// Paper, Fig. 9 and Table 4.
struct SurvivalClass {
  double low = 0, high = 0;  // s, [low, high); high = infinity for the last
  std::uint32_t events = 0;
  double frequency = 0;          // 1/s, events / observed time
  double share_of_jam_time = 0;  // of the summed survival times
};

// Paper, Eq. 7: work done by the blade, integral of (torque / (R tan alpha) + force) dh, written for any wall motion as
// the integral of -(F . v + T . omega) dt with F and T on the wall.
struct FlowEnergy {
  std::string source;  // "series" (step-averaged), "frames" (sampled), or "none"
  std::vector<double> time, power, energy;  // s, W, J
  double total = 0;                         // J
};

struct Analysis {
  Criteria criteria;
  double observed_time = 0;      // s, frames * sampling interval
  double sampling_interval = 0;  // s, D; median distance of frames
  std::vector<FrameSummary> frames;
  std::vector<Cluster> clusters;   // by frame, then largest first, ties by smallest id
  std::vector<JamEvent> events;    // the global stream
  std::vector<Track> tracks;       // by start, then particle id
  std::vector<SurvivalClass> survival_classes;
  std::vector<std::uint32_t> jammed_histogram;  // [n] = number of frames with n jammed particles (Fig. 12)
  double jammed_time = 0;          // s, summed survival times of the global stream
  double jam_frequency = 0;        // 1/s
  double jammed_in_gap_share = 0;  // of all jammed particle samples; NaN where there are none
  FlowEnergy flow_energy;
  std::vector<std::string> notes;  // what could not be computed from this data, and why
};

class Pipeline {
 public:
  // Throws CriteriaError where info has no wall of role blade or none of role vessel but the criteria need them.
  Pipeline(const RunInfo& info, const Criteria& criteria);
  // Frames must come in strictly increasing time; throws DataError otherwise. Returns the new frame's summary.
  const FrameSummary& add(const Snapshot& snapshot);
  std::size_t frames() const { return analysis_.frames.size(); }
  std::size_t events_so_far() const;
  Analysis finish(const Series& series) const;

 private:
  RunInfo info_;
  Analysis analysis_;
  std::vector<std::vector<ParticleId>> jammed_;  // per frame, ascending
  std::vector<double> frame_power_;              // W, per frame, from wall loads where known
};

}  // namespace jam
