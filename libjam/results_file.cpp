#include "libjam/results_file.hpp"

#include <algorithm>
#include <array>

#include "libjam/errors.hpp"
#include "libjam/metrics/metrics.hpp"
#include "libjam/results_tables.hpp"

namespace jam {

template <class Visit>
void columns_of(JamEvent*, Visit&& column) {
  column("first_frame", &JamEvent::first_frame, "1", "row of /frames");
  column("last_frame", &JamEvent::last_frame, "1", "row of /frames, inclusive");
  column("samples", &JamEvent::samples, "1", "frames above the threshold, n");
  column("start", &JamEvent::start, "s", "time of the first sample above the threshold");
  column("end", &JamEvent::end, "s", "time of the last sample above the threshold");
  column("survival_time", &JamEvent::survival_time, "s", "n times the sampling interval");
  column("shortest", &JamEvent::shortest, "s", "lower bound of the duration, (n-1) sampling intervals");
  column("longest", &JamEvent::longest, "s", "upper bound, (n+1) sampling intervals; infinite where cut off");
  column("open_at_start", &JamEvent::open_at_start, "1", "the record begins inside the event");
  column("open_at_end", &JamEvent::open_at_end, "1", "the record ends inside the event");
  column("peak_force", &JamEvent::peak_force, "N", "largest compressive force of a particle");
  column("peak_time", &JamEvent::peak_time, "s", "when");
  column("peak_particle", &JamEvent::peak_particle, "1", "id of the particle that carried it");
  column("peak_in_gap", &JamEvent::peak_in_gap, "1", "that particle sat in the gap then");
  column("bridged", &JamEvent::bridged, "1", "force went from a blade to a vessel in one of its frames or more");
  column("least_gap", &JamEvent::least_gap, "m", "the smallest of the clusters that bridged; NaN where none did");
}

template <class Visit>
void columns_of(ClusterLink*, Visit&& column) {
  column("from", &ClusterLink::from, "1", "row of /clusters");
  column("to", &ClusterLink::to, "1", "row of /clusters, in the next frame");
  column("shared", &ClusterLink::shared, "1", "particles that both have; 0: a hand-over at the same site");
}

template <class Visit>
void columns_of(SurvivalClass*, Visit&& column) {
  column("low", &SurvivalClass::low, "s", "survival times from here");
  column("high", &SurvivalClass::high, "s", "to below here");
  column("events", &SurvivalClass::events, "1", "global events in the class");
  column("frequency", &SurvivalClass::frequency, "1/s", "events over observed time");
  column("share_of_jam_time", &SurvivalClass::share_of_jam_time, "1", "of the summed survival times");
}

// One octave of life, flat.
struct ContactLifeRow {
  double from = 0, to = 0;
  std::uint32_t ended_pp = 0, alive_pp = 0, ended_pw = 0, alive_pw = 0;
  double together_pp = 0, together_pw = 0;
};

template <class Visit>
void columns_of(ContactLifeRow*, Visit&& column) {
  column("from", &ContactLifeRow::from, "s", "life of a contact from here");
  column("to", &ContactLifeRow::to, "s", "to below here");
  column("ended_pp", &ContactLifeRow::ended_pp, "1", "contacts of particles that lasted so long");
  column("alive_pp", &ContactLifeRow::alive_pp, "1", "contacts of particles that are so old in the last frame");
  column("together_pp", &ContactLifeRow::together_pp, "1", "share of contacts of particles that is still there at `from`");
  column("ended_pw", &ContactLifeRow::ended_pw, "1", "contacts with walls that lasted so long");
  column("alive_pw", &ContactLifeRow::alive_pw, "1", "contacts with walls that are so old in the last frame");
  column("together_pw", &ContactLifeRow::together_pw, "1", "share of contacts with walls that is still there at `from`");
}

template <class Visit>
void columns_of(FlowEnergy*, Visit&& column) {
  column("time", &FlowEnergy::time, "s", "end of the window, or time of the frame");
  column("power", &FlowEnergy::power, "W", "power that the blades put into the grains");
  column("energy", &FlowEnergy::energy, "J", "work done up to this time");
}

template <class Visit>
void columns_of(StepJam*, Visit&& column) {
  column("start", &StepJam::start, "s", "first step above");
  column("end", &StepJam::end, "s", "last step above");
  column("duration", &StepJam::duration, "s", "steps above and pauses between them");
  column("open_at_start", &StepJam::open_at_start, "1", "it was there when the record began");
  column("open_at_end", &StepJam::open_at_end, "1", "it is there where the record ends");
  column("peak_force", &StepJam::peak_force, "N", "largest compressive force of a particle");
  column("peak_time", &StepJam::peak_time, "s", "when");
  column("peak_particle", &StepJam::peak_particle, "1", "id of the particle that carried it");
  column("site", &StepJam::site, "1", "sector + 2 layer of the blade, where that was");
  column("impulse", &StepJam::impulse, "N s", "integral of the members' compressive forces");
  column("work", &StepJam::work, "J", "that walls did on the members at their contacts");
  column("share_of_flow_energy", &StepJam::share_of_flow_energy, "1", "that work over the blades' in the whole record");
  column("path", &StepJam::path, "m", "integral of the speed of the particle with the peak, in its stay");
  column("turned", &StepJam::turned, "rad", "integral of its angular speed");
  column("stays", &StepJam::stays, "1", "stays of particles above the force");
}

namespace {

constexpr const char* format_name = "jamscope-analysis";
using Version = std::array<std::uint32_t, 2>;
constexpr Version schema_version{2, 0};  // a larger second number only adds items

std::vector<ContactLifeRow> rows_of(const std::vector<ContactLife>& life) {
  std::vector<ContactLifeRow> rows;
  for (const ContactLife& l : life)
    rows.push_back({l.from, l.to, l.particles.ended, l.particles.alive, l.walls.ended, l.walls.alive, l.particles.together, l.walls.together});
  return rows;
}

std::vector<ContactLife> life_of(const std::vector<ContactLifeRow>& rows) {
  std::vector<ContactLife> life;
  for (const ContactLifeRow& r : rows)
    life.push_back({r.from, r.to, {r.ended_pp, r.alive_pp, r.together_pp}, {r.ended_pw, r.alive_pw, r.together_pw}});
  return life;
}

template <class Visit>
void scalars_of(Analysis*, Visit&& scalar) {
  scalar("observed_time", &Analysis::observed_time, "s", "frames times sampling interval");
  scalar("sampling_interval", &Analysis::sampling_interval, "s", "median distance of frames");
  scalar("jammed_time", &Analysis::jammed_time, "s", "summed survival times of the global events");
  scalar("jam_frequency", &Analysis::jam_frequency, "1/s", "global events over observed time");
  scalar("jammed_in_gap_share", &Analysis::jammed_in_gap_share, "1", "of all jammed particle samples");
}

template <class Visit>
void scalars_of(Criteria*, Visit&& scalar) {
  scalar("jam_force", &Criteria::jam_force, "N", "a particle is jammed above this compressive force");
  scalar("bridge_contact_share", &Criteria::bridge_contact_share, "1",
         "of jam_force: contacts above it carry the load");
  scalar("gap_margin", &Criteria::gap_margin, "1", "particle diameters inside the tip circle that count as gap");
}

struct MeasureName {
  CompressiveMeasure measure;
  const char* name;
};
constexpr MeasureName measure_names[] = {
    {CompressiveMeasure::sum, "sum"}, {CompressiveMeasure::max, "max"}, {CompressiveMeasure::signed_, "signed"}};

template <class Struct>
void write_scalars(h5::File& file, const std::string& group, const Struct& values) {
  scalars_of(static_cast<Struct*>(nullptr),
             [&](const char* name, double Struct::*member, const char* unit, const char* doc) {
               file.write(group + "/" + name, std::vector<double>{values.*member}, unit, doc);
             });
}

template <class Struct>
void read_scalars(const h5::File& file, const std::string& group, Struct& values) {
  scalars_of(static_cast<Struct*>(nullptr), [&](const char* name, double Struct::*member, const char*, const char*) {
    values.*member = read_one<double>(file, group + "/" + name);
  });
}

}  // namespace

void write_criteria(h5::File& file, const Criteria& criteria) {
  for (const auto& [measure, name] : measure_names) {
    if (measure == criteria.measure) {
      file.write_text("/criteria/measure", name, "how contacts add up to a compressive force: sum, max or signed");
    }
  }
  write_scalars(file, "/criteria", criteria);
  file.write_text("/criteria/criterion", criteria.criterion, "what jammed means");
  file.write("/criteria/hold_off", std::vector<double>{criteria.hold_off}, "s", "pauses up to it do not end a jam");
  file.write("/criteria/shortest_jam", std::vector<double>{criteria.shortest_jam}, "s", "shorter ones do not count");
  if (criteria.threshold) file.write("/criteria/threshold", std::vector<double>{*criteria.threshold}, "1", "of the criterion, in its unit");
  if (criteria.end_force) file.write("/criteria/end_force", std::vector<double>{*criteria.end_force}, "N", "a particle above it belongs to a jam that goes on");
  file.write("/criteria/survival_classes", criteria.survival_classes, "s", "upper bounds of the survival-time classes");
}

Criteria read_criteria(const h5::File& file) {
  Criteria criteria;
  const std::string measure = file.read_text("/criteria/measure");
  const auto* row = std::find_if(std::begin(measure_names), std::end(measure_names),
                                 [&](const MeasureName& m) { return m.name == measure; });
  if (row == std::end(measure_names)) {
    file.fail("/criteria/measure", "is \"" + measure + "\", expected sum, max or signed");
  }
  criteria.measure = row->measure;
  read_scalars(file, "/criteria", criteria);
  criteria.hold_off = read_one<double>(file, "/criteria/hold_off");
  criteria.shortest_jam = read_one<double>(file, "/criteria/shortest_jam");
  criteria.criterion = file.read_text("/criteria/criterion");
  if (file.exists("/criteria/threshold")) criteria.threshold = read_one<double>(file, "/criteria/threshold");
  if (file.exists("/criteria/end_force")) criteria.end_force = read_one<double>(file, "/criteria/end_force");
  criteria.survival_classes = file.read<double>("/criteria/survival_classes");
  return criteria;
}

namespace {

void write_tracks(h5::File& file, const std::vector<Track>& tracks) {
  write_table<JamEvent>(file, "/tracks", tracks, [](const Track& track) -> const JamEvent& { return track.event; });
  std::vector<ParticleId> particle;
  for (const Track& track : tracks) particle.push_back(track.particle);
  file.write("/tracks/particle", particle, "1", "id of the particle");
  const auto points = write_parts(file, "/tracks", "point", "/tracks/points", tracks,
                                  [](const Track& t) -> const std::vector<Track::Point>& { return t.points; });
  write_table<JammedSample>(file, "/tracks/points", points, [](const Track::Point& p) -> const JammedSample& { return p; });
  std::vector<std::uint32_t> frame;
  for (const Track::Point& point : points) frame.push_back(point.frame);
  file.write("/tracks/points/frame", frame, "1", "row of /frames");
}

std::vector<Track::Point> read_points(const h5::File& file) {
  const auto samples = read_table<JammedSample>(file, "/tracks/points");
  const auto frame = file.read<std::uint32_t>("/tracks/points/frame");
  if (frame.size() != samples.size()) file.fail("/tracks/points/frame", "expected " + std::to_string(samples.size()) + " rows");
  std::vector<Track::Point> points;
  points.reserve(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) points.push_back({samples[k], frame[k]});
  return points;
}

std::vector<Track> read_tracks(const h5::File& file) {
  const std::vector<JamEvent> events = read_table<JamEvent>(file, "/tracks");
  const auto particle = file.read<ParticleId>("/tracks/particle");
  if (particle.size() != events.size())
    file.fail("/tracks/particle", "expected " + std::to_string(events.size()) + " rows");
  auto points = read_parts(file, "/tracks", "point", read_points(file), events.size());
  std::vector<Track> tracks(events.size());
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    tracks[k] = {particle[k], events[k], std::move(points[k])};
    tracks[k].event.members = {particle[k]};
  }
  return tracks;
}

// Those that this version knows, in its order.
std::vector<RecordedMetric> read_metrics(const h5::File& file, std::size_t frames) {
  std::vector<RecordedMetric> recorded;
  for (const Metric& metric : metrics()) {
    const std::string path = "/metrics/" + std::string(metric.name);
    if (!file.exists(path)) continue;
    recorded.push_back({std::string(metric.name), std::string(metric.unit), std::string(metric.doc), file.read<double>(path)});
    if (recorded.back().values.size() != frames) file.fail(path, "expected " + std::to_string(frames) + " rows");
  }
  return recorded;
}

void write_flow_energy(h5::File& file, const FlowEnergy& flow) {
  columns_of(static_cast<FlowEnergy*>(nullptr),
             [&](const char* name, std::vector<double> FlowEnergy::*member, const char* unit, const char* doc) {
               file.write(std::string("/flow_energy/") + name, flow.*member, unit, doc);
             });
  file.write_text("/flow_energy/source", flow.source, "series (step-averaged), frames or contacts (sampled), none");
  file.write("/flow_energy/total", std::vector<double>{flow.total}, "J", "work done by the blades in the whole record");
}

FlowEnergy read_flow_energy(const h5::File& file) {
  FlowEnergy flow;
  columns_of(static_cast<FlowEnergy*>(nullptr), [&](const char* name, std::vector<double> FlowEnergy::*member,
                                                    const char*, const char*) {
    flow.*member = file.read<double>(std::string("/flow_energy/") + name);
    if ((flow.*member).size() != flow.time.size()) {
      file.fail(std::string("/flow_energy/") + name, "expected " + std::to_string(flow.time.size()) + " rows");
    }
  });
  flow.source = file.read_text("/flow_energy/source");
  flow.total = read_one<double>(file, "/flow_energy/total");
  return flow;
}

void expect_frame(const h5::File& file, const std::string& group, std::uint32_t frame, std::size_t frames) {
  if (frame >= frames) {
    file.fail(group, "names frame " + std::to_string(frame) + ", expected one below " + std::to_string(frames));
  }
}

void expect_frames(const h5::File& file, const std::string& group, const JamEvent& event, std::size_t frames) {
  expect_frame(file, group, event.last_frame, frames);
  expect_frame(file, group, event.first_frame, std::size_t{event.last_frame} + 1);
}

// Rows of /frames that other tables name must be there.
void check_frame_rows(const h5::File& file, const Analysis& analysis) {
  const std::size_t frames = analysis.frames.size();
  for (const Cluster& cluster : analysis.clusters) expect_frame(file, "/clusters", cluster.frame, frames);
  for (const JamEvent& event : analysis.cluster_events) expect_frames(file, "/cluster_events", event, frames);
  const std::size_t clusters = analysis.clusters.size();
  if (!analysis.lineage.identity.empty() && analysis.lineage.identity.size() != clusters)
    file.fail("/clusters/identity", "has " + std::to_string(analysis.lineage.identity.size()) + " rows, expected " + std::to_string(clusters));
  for (const std::uint32_t identity : analysis.lineage.identity)
    if (identity >= analysis.cluster_events.size()) file.fail("/clusters/identity", "names row " + std::to_string(identity) + ", expected one below " + std::to_string(analysis.cluster_events.size()));
  for (const ClusterLink& link : analysis.lineage.links)
    if (link.from >= clusters || link.to >= clusters) file.fail("/cluster_links", "names a row of /clusters that is not there, expected rows below " + std::to_string(clusters));
  for (const JamEvent& event : analysis.events) expect_frames(file, "/events", event, frames);
  for (const Track& track : analysis.tracks) {
    expect_frames(file, "/tracks", track.event, frames);
    for (const Track::Point& point : track.points) expect_frame(file, "/tracks/points", point.frame, frames);
  }
}

}  // namespace

void write_results(const std::filesystem::path& path, const Analysis& analysis, const RunInfo& info) {
  h5::write_aside(path, [&](h5::File& file) {
    file.set_attribute("/", "format", format_name);
    file.set_attribute("/", "schema_version", schema_version);
    file.set_attribute("/", "creator", info.creator);
    file.set_attribute("/", "creator_version", info.creator_version);
    file.set_attribute("/", "commit", info.commit);
    file.set_attribute("/", "created_utc", info.created_utc);
    file.set_attribute("/", "case_sha256", info.case_sha256);
    file.set_attribute("/", "seed", info.seed);
    write_criteria(file, analysis.criteria);
    write_scalars(file, "/summary", analysis);
    write_table(file, "/frames", analysis.frames);
    file.make_group("/metrics");
    for (const RecordedMetric& metric : analysis.metrics) file.write("/metrics/" + metric.name, metric.values, metric.unit, metric.doc);
    write_with_members(file, "/clusters", analysis.clusters);
    file.write("/clusters/identity", analysis.lineage.identity, "1", "row of /cluster_events: clusters of one identity are one through time");
    write_table(file, "/cluster_links", analysis.lineage.links);
    write_with_members(file, "/cluster_events", analysis.cluster_events);
    write_with_members(file, "/events", analysis.events);
    write_tracks(file, analysis.tracks);
    write_table(file, "/survival_classes", analysis.survival_classes);
    file.write("/jammed_histogram/frames", analysis.jammed_histogram, "1", "row n: frames with n jammed particles");
    write_flow_energy(file, analysis.flow_energy);
    for (std::size_t s = 0; s < analysis.every_step.size(); ++s)
      write_with_members(file, "/every_step/" + std::string(jam_stream_names[s]), analysis.every_step[s].jams);
    if (!analysis.contact_life.empty()) write_table(file, "/contact_life", rows_of(analysis.contact_life));
    file.write_texts("/notes", analysis.notes, "what could not be computed from this data, and why");
  });
}

Analysis read_results(const std::filesystem::path& path) {
  const h5::File file = h5::File::open(path);
  if (!file.has_attribute("/", "format") || file.attribute<std::string>("/", "format") != format_name) {
    file.fail("/", std::string("not an analysis result, expected the attribute format = \"") + format_name + "\"");
  }
  const auto version = file.attribute<Version>("/", "schema_version");
  if (version[0] != schema_version[0]) {
    file.fail("/", "schema version " + std::to_string(version[0]) + "." + std::to_string(version[1]) + ", expected " +
                       std::to_string(schema_version[0]) + ".x");
  }
  Analysis analysis;
  analysis.criteria = read_criteria(file);
  read_scalars(file, "/summary", analysis);
  analysis.frames = read_table<FrameSummary>(file, "/frames");
  if (file.exists("/metrics")) analysis.metrics = read_metrics(file, analysis.frames.size());
  analysis.criteria.metrics.emplace();
  for (const RecordedMetric& metric : analysis.metrics) analysis.criteria.metrics->push_back(metric.name);
  analysis.clusters = read_with_members<Cluster>(file, "/clusters");
  if (file.exists("/cluster_links")) {
    analysis.lineage = {file.read<std::uint32_t>("/clusters/identity"), read_table<ClusterLink>(file, "/cluster_links")};
    analysis.cluster_events = read_with_members<JamEvent>(file, "/cluster_events");
  }
  analysis.events = read_with_members<JamEvent>(file, "/events");
  analysis.tracks = read_tracks(file);
  analysis.survival_classes = read_table<SurvivalClass>(file, "/survival_classes");
  analysis.jammed_histogram = file.read<std::uint32_t>("/jammed_histogram/frames");
  analysis.flow_energy = read_flow_energy(file);
  for (const std::string_view stream : jam_stream_names) {
    const std::string group = "/every_step/" + std::string(stream);
    if (file.exists(group)) analysis.every_step.push_back({read_with_members<StepJam>(file, group), {}});
  }
  if (file.exists("/contact_life")) analysis.contact_life = life_of(read_table<ContactLifeRow>(file, "/contact_life"));
  analysis.notes = file.read_texts("/notes");
  analysis.corrected = corrected_for_sampling(analysis.events, analysis.sampling_interval, analysis.observed_time);
  check_frame_rows(file, analysis);
  return analysis;
}

}  // namespace jam
