#include "libjam/events/jam_frame.hpp"

#include <algorithm>
#include <map>

#include "libjam/graph/contact_force.hpp"
#include "libjam/jamming/gap.hpp"
#include "libjam/jamming/jam_criteria.hpp"

namespace jam {
namespace {

// N, above which a particle may belong to a jam without being jammed; infinity where Criteria::criterion has no force of its own for it.
double end_force(const Criteria& criteria) {
  const bool applies = criterion_of(criteria).unit == "N" && criteria.end_force;
  return applies ? *criteria.end_force : std::numeric_limits<double>::infinity();
}

}  // namespace

JammedSample sample_of(const ContactGraph& graph, ContactGraph::Vertex row, double compressive_force, const RunInfo& info, const BladePose& blade,
                       const Criteria& criteria) {
  const Snapshot& snapshot = graph.snapshot();
  const Particles& particles = snapshot.particles;
  constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
  JammedSample sample;
  sample.particle = particles.id[row];
  sample.position = particles.position[row];
  sample.velocity = present(particles.velocity, particles.size()) ? particles.velocity[row] : Vec3f::Constant(unknown);
  if (present(particles.angular_velocity, particles.size())) sample.angular_velocity = particles.angular_velocity[row];
  sample.from_blade = in_blade_frame(std::span(&blade, 1), snapshot.time, particles.position[row].cast<double>()).cast<float>();
  if (const double tip = gap_known(info) ? tip_speed(blade, info.gap.tip_radius) : 0.0; tip > 0) sample.speed_over_tip = float(double{sample.velocity.norm()} / tip);
  sample.compressive_force = compressive_force;
  for (const ContactGraph::Neighbor& n : graph.neighbors(row)) sample.pushed_by += repulsive_force(snapshot.pp, n.contact) > 0;
  for (const std::uint32_t c : graph.wall_contacts(row)) sample.pushed_by += repulsive_force(snapshot.pw, c) > 0;
  sample.in_gap = in_gap(snapshot, row, info, criteria);
  return sample;
}

JamFrame jam_frame(const ContactGraph& graph, const std::vector<double>& compressive_force, const std::vector<JammedParticle>& jammed,
                   const std::vector<Cluster>& clusters, const RunInfo& info, const BladePose& blade, const Criteria& criteria) {
  std::map<ParticleId, double> gap_of;  // of particles in bridging clusters
  for (const Cluster& cluster : clusters)
    if (cluster.bridges)
      for (const ParticleId id : cluster.members) gap_of[id] = cluster.least_gap;
  JamFrame frame;
  frame.time = graph.snapshot().time;
  for (const JammedParticle& p : jammed) {
    JammedSample& sample = frame.jammed.emplace_back(sample_of(graph, p.row, p.compressive_force, info, blade, criteria));
    const auto bridged = gap_of.find(sample.particle);
    if (bridged == gap_of.end()) continue;
    sample.bridged = true;
    sample.least_gap = bridged->second;
  }
  const double least = end_force(criteria);
  auto next = jammed.begin();
  for (ContactGraph::Vertex v = 0; v < compressive_force.size(); ++v) {
    if (!(compressive_force[v] > least)) continue;
    while (next != jammed.end() && next->row < v) ++next;
    if (next == jammed.end() || next->row != v) frame.nearly.push_back(sample_of(graph, v, compressive_force[v], info, blade, criteria));
  }
  return frame;
}

double sampling_interval(std::span<const JamFrame> frames) {
  if (frames.size() < 2) return 0;
  std::vector<double> distance(frames.size() - 1);
  for (std::size_t k = 0; k < distance.size(); ++k) distance[k] = frames[k + 1].time - frames[k].time;
  const auto middle = distance.begin() + static_cast<std::ptrdiff_t>(distance.size() / 2);
  std::nth_element(distance.begin(), middle, distance.end());
  if (distance.size() % 2 == 1) return *middle;
  return (*std::max_element(distance.begin(), middle) + *middle) / 2;
}

bool gap_before(std::span<const JamFrame> frames, std::size_t k, double sampling_interval) {
  return frames[k].time - frames[k - 1].time > 1.5 * sampling_interval;
}

}  // namespace jam
