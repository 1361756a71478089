// The story of libjam in one screen: snapshots go in one at a time, in order of time; what jammed, when and how comes
// out.
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

#include "libjam/events/event.hpp"
#include "libjam/events/every_step.hpp"
#include "libjam/events/jam_frame.hpp"
#include "libjam/events/lineage.hpp"
#include "libjam/events/loaded_grains.hpp"
#include "libjam/jamming/cluster.hpp"
#include "libjam/jamming/criteria.hpp"
#include "libjam/snapshot/snapshot.hpp"
#include "libjam/statistics/contact_life.hpp"
#include "libjam/statistics/flow_energy.hpp"
#include "libjam/statistics/flow_pattern.hpp"
#include "libjam/statistics/jam_statistics.hpp"
#include "libjam/statistics/sampled_durations.hpp"
#include "libjam/statistics/survival.hpp"

namespace jam {

// One row per snapshot (paper, Figs 5, 11 and 12). Zeros where a frame has no particles.
struct FrameSummary {
  double time = 0;  // s
  std::uint64_t step = 0;
  std::uint32_t particles = 0, particle_contacts = 0, wall_contacts = 0;
  double coordination = 0;                                           // 2 N_pp / N, geometric, without walls
  double coordination_with_walls = 0;                                // (2 N_pp + N_pw) / N
  double largest_compressive_force = 0, mean_compressive_force = 0;  // N
  ParticleId largest_particle = 0;                                   // which particle carries it; ties: smallest id
  std::uint32_t jammed = 0;                                          // particles above the jam force
  std::uint32_t jammed_in_gap = 0;   // of those, how many sit in the gap between blade tip and vessel
  std::uint32_t bridges = 0;         // clusters that carry force from a blade to a vessel
  std::uint32_t largest_bridge = 0;  // particles in the largest of them
  double blade_force = 0, blade_torque = 0;  // N along z, N m about z through the axis, on the first blade; NaN where loads of walls are not recorded
};

// A metric of libjam/metrics/metrics.hpp for each frame.
struct RecordedMetric {
  std::string name, unit, doc;
  std::vector<double> values;  // [F], NaN where it is not defined
};

struct Analysis {
  Criteria criteria;
  double observed_time = 0;      // s, frames * sampling interval
  double sampling_interval = 0;  // s, D; median distance of frames
  std::vector<FrameSummary> frames;
  std::vector<RecordedMetric> metrics;
  std::vector<Cluster> clusters;  // by frame, then largest first, ties by smallest id
  Lineage lineage;                // of the clusters
  std::vector<JamEvent> events;   // the global stream
  std::vector<JamEvent> cluster_events;  // the cluster stream: by identity
  std::vector<Track> tracks;      // by start, then particle id
  std::vector<SurvivalClass> survival_classes;
  std::vector<std::uint32_t> jammed_histogram;  // [n] = number of frames with n jammed particles (Fig. 12)
  double jammed_time = 0;                       // s, summed survival times of the global stream
  double jam_frequency = 0;                     // 1/s
  ExponentialDurations corrected;               // what the global events say of all jams, those between frames too
  double jammed_in_gap_share = 0;  // of all jammed particle samples; NaN where there are none or the gap is not known
  FlowEnergy flow_energy;
  // Jams as the simulation saw them at every step, by JamStream; empty where the source did not watch.
  struct StepStream {
    std::vector<StepJam> jams;
    JamStatistics statistics;
  };
  std::vector<StepStream> every_step;
  LoadedGrains loaded;             // for counts at other thresholds
  std::vector<BladePose> blade;    // [F] of the first wall that is a blade
  std::vector<ContactLife> contact_life;  // by octaves of life; empty where the source does not follow contacts from step to step
  std::vector<FlowBin> flow_pattern;      // [FlowBin::count], empty where it is not known
  std::vector<std::string> notes;  // what could not be computed from this data, and why
};

// The events of an analysis as a table; see libjam/events/events_csv.hpp.
std::string events_csv(const Analysis& analysis);
// Those seen at every step; empty where the source did not watch.
std::string step_jams_csv(const Analysis& analysis);

// All that the analysis keeps of one frame.
struct ExaminedFrame {
  FrameSummary summary;
  std::vector<Cluster> clusters;
  JamFrame jams;
  std::vector<double> metrics;  // in the order of Analysis::metrics
  double power = 0;             // W of the blades, from wall loads where known, else from contacts; NaN where neither
  bool blade_moves = false, tangential_forces_missing = false;
  BladePose blade;  // of the first wall that is one
  std::vector<LoadedGrain> loaded;
  FlowSums flow;  // sums are exact: those of later frames may come with this one, which then have none
  Extent extent;
  std::size_t recovered_contacts = 0;
  Series::EndedContacts ages_pp{}, ages_pw{};  // contacts by age
};

class Pipeline {
 public:
  // Throws CriteriaError where an option is out of range, a metric is not known, or info has no wall of role blade or none of role vessel.
  Pipeline(const RunInfo& info, const Criteria& criteria);
  // Frames must come in strictly increasing time and pass validate(); throws DataError otherwise, and
  // the pipeline is as before. Returns the new frame's summary.
  const FrameSummary& add(const Snapshot& snapshot) { return add(examine(snapshot, frames())); }
  // The two halves of it: frames may be examined in any order and by several threads at once, and are then added in order. `frame` counts
  // from 0; examine() throws DataError where the snapshot does not pass validate().
  ExaminedFrame examine(const Snapshot& snapshot, std::size_t frame) const;
  const FrameSummary& add(ExaminedFrame frame);
  std::size_t frames() const { return analysis_.frames.size(); }
  // As they are applied: the metrics in the order of their table and each once.
  const Criteria& criteria() const { return analysis_.criteria; }
  // Global events in the frames so far, the open one included. Frames that may be missing split events only in
  // finish().
  std::size_t events_so_far() const { return events_so_far_; }
  // May be called at any time, and again after more frames.
  Analysis finish(const Series& series) const;

 private:
  void follow_every_step(Analysis& a, const Series& series) const;

  RunInfo info_;
  Analysis analysis_;
  std::vector<JamFrame> jam_frames_;
  std::vector<double> frame_power_;  // ExaminedFrame::power of each
  FlowSums flow_;
  std::size_t events_so_far_ = 0;
  std::size_t recovered_contacts_ = 0;
  Series::EndedContacts ages_pp_{}, ages_pw_{};  // of the last frame
  bool blade_moved_ = false, tangential_forces_missing_ = false;
};

}  // namespace jam
