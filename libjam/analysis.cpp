#include "libjam/analysis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "libjam/errors.hpp"
#include "libjam/events/events_csv.hpp"
#include "libjam/events/streams.hpp"
#include "libjam/graph/contact_graph.hpp"
#include "libjam/jamming/check_criteria.hpp"
#include "libjam/jamming/compressive_force.hpp"
#include "libjam/jamming/gap.hpp"
#include "libjam/jamming/jam_criteria.hpp"
#include "libjam/jamming/jam_clusters.hpp"
#include "libjam/metrics/metrics.hpp"
#include "libjam/metrics/coordination.hpp"
#include "libjam/metrics/coordination_with_walls.hpp"
#include "libjam/snapshot/validate.hpp"
#include "libjam/statistics/jam_counts.hpp"

namespace jam {
namespace {

void check_time(double time, const std::vector<FrameSummary>& before) {
  if (before.empty() || time > before.back().time) return;
  std::ostringstream problem;
  problem << "frame " << before.size() << ": time " << time << " s follows " << before.back().time << " s, expected increasing times";
  throw DataError(problem.str());
}

FrameSummary summarize(const ContactGraph& graph, const std::vector<double>& compressive_force,
                       const std::vector<JammedParticle>& jammed, const std::vector<Cluster>& clusters) {
  const Snapshot& snapshot = graph.snapshot();
  FrameSummary row;
  row.time = snapshot.time;
  row.step = snapshot.step;
  row.particles = static_cast<std::uint32_t>(graph.vertex_count());
  row.particle_contacts = static_cast<std::uint32_t>(graph.edge_count());
  row.wall_contacts = static_cast<std::uint32_t>(graph.wall_contact_count());
  if (!compressive_force.empty()) {
    row.coordination = coordination(graph);
    row.coordination_with_walls = coordination_with_walls(graph);
    const auto largest = std::max_element(compressive_force.begin(), compressive_force.end());
    row.largest_compressive_force = *largest;
    row.largest_particle = snapshot.particles.id[static_cast<std::size_t>(largest - compressive_force.begin())];
    double sum = 0;
    for (const double force : compressive_force) sum += force;
    row.mean_compressive_force = sum / static_cast<double>(compressive_force.size());
  }
  row.jammed = static_cast<std::uint32_t>(jammed.size());
  for (const JammedParticle& p : jammed) row.jammed_in_gap += p.in_gap;
  for (const Cluster& cluster : clusters) {
    if (!cluster.bridges) continue;
    ++row.bridges;
    row.largest_bridge = std::max(row.largest_bridge, static_cast<std::uint32_t>(cluster.members.size()));
  }
  return row;
}

template <class... Parts>
void note(Analysis& a, const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  a.notes.push_back(text.str());
}

bool any_blade_moves(const Snapshot& snapshot, const std::vector<Wall>& walls) {
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const WallState& state = snapshot.walls[w];
    if (walls[w].role == WallRole::blade && (!state.velocity.isZero(0) || !state.angular_velocity.isZero(0)))
      return true;
  }
  return false;
}

std::size_t recovered(const WallContacts& contacts) {
  if (!present(contacts.flags, contacts.size())) return 0;
  return static_cast<std::size_t>(std::count_if(contacts.flags.begin(), contacts.flags.end(),
                                                [](std::uint8_t f) { return (f & contact_recovered) != 0; }));
}

void add_blade_load(FrameSummary& row, const Snapshot& snapshot, const RunInfo& info) {
  row.blade_force = row.blade_torque = std::numeric_limits<double>::quiet_NaN();
  const auto blade = std::find_if(info.walls.begin(), info.walls.end(), [](const Wall& w) { return w.role == WallRole::blade; });
  if (!info.wall_loads_known || blade == info.walls.end()) return;
  const WallState& state = snapshot.walls[std::size_t(blade - info.walls.begin())];
  row.blade_force = state.force.z();
  row.blade_torque = state.torque.z();
}

const char* why_no_flow_pattern(const std::vector<BladePose>& blade, const Gap& gap) {
  if (!flow_bins_known(gap)) return "the radii of its tip and of the vessel and its height are not all known";
  if (blade.empty()) return "there are no frames";
  const bool turns = std::any_of(blade.begin(), blade.end(), [](const BladePose& pose) { return pose.angular_velocity.z() != 0; });
  return turns ? "the source has no velocities of particles" : "it does not turn about the vertical in any frame";
}

// The site of each cluster: of its member that carries the most.
std::vector<std::uint32_t> cluster_sites(const std::vector<Cluster>& clusters, const std::vector<JamFrame>& frames, const std::vector<BladePose>& blade,
                                         const Sites& sites) {
  std::vector<std::uint32_t> site;
  for (const Cluster& cluster : clusters) {
    const JammedSample* largest = nullptr;
    for (const JammedSample& sample : frames[cluster.frame].jammed)
      if (std::binary_search(cluster.members.begin(), cluster.members.end(), sample.particle) &&
          (largest == nullptr || sample.compressive_force > largest->compressive_force))
        largest = &sample;
    site.push_back(largest == nullptr ? 0 : sites.of(in_blade_frame(blade, frames[cluster.frame].time, largest->position.cast<double>())));
  }
  return site;
}

}  // namespace

std::string events_csv(const Analysis& analysis) {
  return events_csv(analysis.events, analysis.cluster_events, analysis.tracks);
}

std::string step_jams_csv(const Analysis& analysis) {
  if (analysis.every_step.empty()) return "";
  std::string csv(step_jams_header());
  for (std::size_t s = 0; s < analysis.every_step.size(); ++s) csv += step_jams_rows(JamStream(s), analysis.every_step[s].jams);
  return csv;
}

Pipeline::Pipeline(const RunInfo& info, const Criteria& criteria) : info_(info) {
  check_criteria(criteria, info);
  analysis_.criteria = criteria;
  analysis_.loaded.floor = LoadedGrains::floor_share * criteria.jam_force;
  const auto& wanted = criteria.metrics;
  if (wanted)
    for (const std::string& name : *wanted)
      if (find_metric(name) == nullptr) throw CriteriaError("criteria: metrics: \"" + name + "\" is none that is known");
  // In the order of the table and each once, however they were asked for.
  analysis_.criteria.metrics.emplace();
  for (const Metric& metric : metrics()) {
    if (wanted ? std::find(wanted->begin(), wanted->end(), metric.name) == wanted->end() : metric.cost != Cost::low) continue;
    analysis_.criteria.metrics->emplace_back(metric.name);
    analysis_.metrics.push_back({std::string(metric.name), std::string(metric.unit), std::string(metric.doc), {}});
  }
}

ExaminedFrame Pipeline::examine(const Snapshot& snapshot, std::size_t frame) const {
  validate(snapshot, info_, "frame " + std::to_string(frame));
  const ContactGraph graph(snapshot, info_.walls);
  FrameNetwork network(graph, info_, analysis_.criteria);
  ExaminedFrame found;
  found.summary = summarize(graph, network.compressive(), network.jammed(), network.clusters());
  found.clusters = network.clusters();
  for (Cluster& cluster : found.clusters) cluster.frame = static_cast<std::uint32_t>(frame);
  found.blade = blade_of(snapshot, info_.walls);
  add_blade_load(found.summary, snapshot, info_);
  found.loaded = loaded_grains(graph, network.compressive(), info_, analysis_.criteria);
  found.flow = flow_sums(snapshot, info_, analysis_.criteria);
  found.extent = extent_of(snapshot.particles);
  found.jams = jam_frame(graph, network.compressive(), network.jammed(), network.clusters(), info_, found.blade, analysis_.criteria);
  for (const RecordedMetric& recorded : analysis_.metrics) found.metrics.push_back(find_metric(recorded.name)->value(network));
  found.power = info_.wall_loads_known ? power_from_wall_loads(snapshot, info_.walls) : power_from_wall_contacts(snapshot, info_.walls);
  found.blade_moves = any_blade_moves(snapshot, info_.walls);
  found.recovered_contacts = recovered(snapshot.pw);
  found.ages_pp = ages(snapshot.pp.birth_step, snapshot.step);
  found.ages_pw = ages(snapshot.pw.birth_step, snapshot.step);
  found.tangential_forces_missing = !present(snapshot.pw.tangential_force, snapshot.pw.size());
  return found;
}

const FrameSummary& Pipeline::add(ExaminedFrame frame) {
  check_time(frame.summary.time, analysis_.frames);
  if (!frame.jams.jammed.empty() && (jam_frames_.empty() || jam_frames_.back().jammed.empty())) ++events_so_far_;
  analysis_.frames.push_back(frame.summary);
  for (std::size_t k = 0; k < frame.metrics.size(); ++k) analysis_.metrics[k].values.push_back(frame.metrics[k]);
  jam_frames_.push_back(std::move(frame.jams));
  analysis_.clusters.insert(analysis_.clusters.end(), frame.clusters.begin(), frame.clusters.end());
  frame_power_.push_back(frame.power);
  analysis_.blade.push_back(frame.blade);
  analysis_.loaded.add(frame.loaded);
  analysis_.loaded.extent.include(frame.extent);
  jam::add(flow_, frame.flow);
  blade_moved_ = blade_moved_ || frame.blade_moves;
  recovered_contacts_ += frame.recovered_contacts;
  ages_pp_ = frame.ages_pp;
  ages_pw_ = frame.ages_pw;
  tangential_forces_missing_ = tangential_forces_missing_ || frame.tangential_forces_missing;
  return analysis_.frames.back();
}

// Jams as every step of the run saw them: of the particles that it watched, by the criteria as far as these particles tell.
void Pipeline::follow_every_step(Analysis& a, const Series& series) const {
  const Criteria& criteria = a.criteria;
  Detector detector{.start_force = 0, .end_force = 0, .hold_off = criteria.hold_off, .shortest = criteria.shortest_jam};
  if (criterion_of(criteria).unit == "N" && info_.watch_radius == 0) {
    const double end_force = criteria.end_force.value_or(criteria.jam_force);
    detector.start_force = criteria.jam_force;
    if (end_force < info_.watch_force) note(a, "the run watched particles above ", info_.watch_force, " N: jams of every step end there, not at ", end_force, " N");
    if (end_force > info_.watch_force) note(a, "jams of every step last until the force falls to ", info_.watch_force, " N, which the run watched");
  } else {
    const std::string watched = info_.watch_radius == 0 ? " N" : " N times the square of their radius over that of the mean";
    if (criteria.criterion != "scaled_force" || info_.watch_radius == 0)
      note(a, "jams of every step are those of particles above ", info_.watch_force, watched, ", which the run watched, not by the criterion ", criteria.criterion);
  }
  const Sites sites{.z_low = info_.gap.z_low, .z_high = info_.gap.z_high};
  const Excursions stays = last_word(series.excursions);
  const std::uint64_t first_step = a.frames.empty() ? 0 : a.frames.front().step;
  const double begin = double(first_step) * info_.dt, end = series.time.back();
  for (const JamStream stream : {JamStream::global, JamStream::particle, JamStream::site}) {
    Analysis::StepStream& found = a.every_step.emplace_back();
    found.jams = step_jams(stays, stream, detector, a.blade, sites, info_.dt, info_.watch_stride, first_step);
    found.statistics = jam_statistics(found.jams, begin, end);
  }
}

Analysis Pipeline::finish(const Series& series) const {
  Analysis a = analysis_;
  a.loaded.keep(LoadedGrains::most);
  const auto note = [&a](const auto&... parts) { jam::note(a, parts...); };

  a.sampling_interval = sampling_interval(jam_frames_);
  a.observed_time = static_cast<double>(jam_frames_.size()) * a.sampling_interval;
  if (jam_frames_.size() < 2) note("fewer than two frames: no sampling interval, so no durations and no frequency");
  std::size_t missing = 0;
  for (std::size_t k = 1; k < jam_frames_.size(); ++k) missing += gap_before(jam_frames_, k, a.sampling_interval);
  if (missing > 0) {
    note("frames are missing in ", missing, " places (more than 1.5 sampling intervals apart): events are cut there");
  }

  const SampledDetector sampled{a.sampling_interval, a.criteria.hold_off, a.criteria.shortest_jam};
  a.events = global_events(jam_frames_, sampled);
  a.tracks = particle_tracks(jam_frames_, sampled);
  a.lineage = lineage(a.clusters, cluster_sites(a.clusters, jam_frames_, a.blade, {.z_low = info_.gap.z_low, .z_high = info_.gap.z_high}), jam_frames_,
                      a.sampling_interval);
  a.cluster_events = cluster_events(a.clusters, a.lineage, jam_frames_, a.sampling_interval);
  a.jammed_time = jammed_time(a.events);
  a.jam_frequency = a.observed_time > 0 ? static_cast<double>(a.events.size()) / a.observed_time : 0.0;
  a.corrected = corrected_for_sampling(a.events, a.sampling_interval, a.observed_time);
  a.survival_classes = survival_classes(a.events, a.criteria.survival_classes, a.sampling_interval, a.observed_time);
  a.jammed_histogram = jammed_histogram(jam_frames_);
  const auto open = std::count_if(a.events.begin(), a.events.end(),
                                  [](const JamEvent& e) { return e.open_at_start || e.open_at_end; });
  if (open > 0) note(open, " of ", a.events.size(), " events are cut off by the record and may have lasted longer");

  if (gap_known(info_)) {
    a.jammed_in_gap_share = jammed_in_gap_share(jam_frames_);
  } else {
    a.jammed_in_gap_share = std::numeric_limits<double>::quiet_NaN();
    note("the gap between blade tip and vessel is not known: no particle is counted in it");
  }
  a.flow_pattern = flow_pattern(flow_, info_.gap);
  if (a.flow_pattern.empty()) note("no flow pattern around the blade: ", why_no_flow_pattern(a.blade, info_.gap));
  if (recovered_contacts_ > 0) {
    note(recovered_contacts_, " contacts with walls are not in the source and were recovered from force balances");
  }

  if (info_.watch_force > 0 && info_.dt > 0 && !series.excursion_count.empty()) follow_every_step(a, series);
  a.contact_life = contact_life(series, ages_pp_, ages_pw_, info_.dt);
  if (series_has_power(series, info_.walls)) {
    const double begin = a.frames.empty() ? 0.0 : a.frames.front().time;
    a.flow_energy = flow_energy_from_series(series, info_.walls, begin);
    for (Analysis::StepStream& stream : a.every_step)
      for (StepJam& jam : stream.jams) jam.share_of_flow_energy = jam.work / a.flow_energy.total;
    return a;
  }
  const bool power_known =
      std::all_of(frame_power_.begin(), frame_power_.end(), [](double p) { return std::isfinite(p); });
  if (frame_power_.empty() || !power_known || !blade_moved_) {
    a.flow_energy.source = "none";
    note("no flow energy: ", frame_power_.empty() ? "there are no frames"
                             : !power_known       ? "contacts with the blade have neither point nor normal"
                                                  : "the velocity of the blade is zero in every frame");
    return a;
  }
  std::vector<double> time;
  for (const JamFrame& frame : jam_frames_) time.push_back(frame.time);
  a.flow_energy = flow_energy_from_frames(time, frame_power_, info_.wall_loads_known ? "frames" : "contacts");
  note(
      "flow energy is integrated over the power at the frames, not over all steps: it misses what happens between "
      "them");
  if (!info_.wall_loads_known && tangential_forces_missing_) {
    note("flow energy leaves out the tangential forces on the blade, which the source does not have");
  }
  return a;
}

}  // namespace jam
