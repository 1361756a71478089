// What the events are made of: of every frame its time and its jammed particles, nothing else. So a run of any length
// is kept in memory as frames + jammed samples.
#pragma once
#include <limits>
#include <span>
#include <vector>

#include "libjam/events/blade_pose.hpp"
#include "libjam/graph/contact_graph.hpp"
#include "libjam/jamming/cluster.hpp"
#include "libjam/jamming/criteria.hpp"
#include "libjam/jamming/jam_clusters.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jam {

// A particle in one frame, as far as jams are concerned. NaN where the source does not know.
struct JammedSample {
  ParticleId particle = 0;
  Vec3f position = Vec3f::Zero(), velocity = Vec3f::Zero();  // m, m/s
  Vec3f angular_velocity = Vec3f::Constant(std::numeric_limits<float>::quiet_NaN());  // rad/s
  Vec3f from_blade = Vec3f::Zero();  // m, position in the blade's body frame: z along its axis
  float speed_over_tip = std::numeric_limits<float>::quiet_NaN();  // |velocity| over the speed of the blade's tip; NaN for a blade at rest
  double compressive_force = 0;      // N
  std::uint32_t pushed_by = 0;       // particles and walls that push it
  bool in_gap = false;
  bool bridged = false;              // belongs to a bridging cluster in this frame
  double least_gap = std::numeric_limits<double>::quiet_NaN();  // m, Cluster::least_gap of that cluster
};

struct JamFrame {
  double time = 0;                   // s
  std::vector<JammedSample> jammed;  // ascending by particle
  std::vector<JammedSample> nearly;  // not jammed, but above Criteria::end_force; ascending by particle
};

// Of one particle, whatever its force.
JammedSample sample_of(const ContactGraph& graph, ContactGraph::Vertex row, double compressive_force, const RunInfo& info, const BladePose& blade,
                       const Criteria& criteria);

// Of one frame. `jammed` and `clusters` are those of the frame (libjam/jamming/jam_clusters.hpp).
JamFrame jam_frame(const ContactGraph& graph, const std::vector<double>& compressive_force, const std::vector<JammedParticle>& jammed,
                   const std::vector<Cluster>& clusters, const RunInfo& info, const BladePose& blade, const Criteria& criteria);

// D: the median distance of consecutive frames, s (the mean of the middle two where their number is even); 0 for fewer
// than two frames.
double sampling_interval(std::span<const JamFrame> frames);

// True where frames are missing between k - 1 and k: they are more than 1.5 D apart. Events do not cross such a gap.
bool gap_before(std::span<const JamFrame> frames, std::size_t k, double sampling_interval);

}  // namespace jam
