#include "libjam/results_file.hpp"

#include <algorithm>
#include <array>

#include "libjam/errors.hpp"
#include "libjam/metrics/metrics.hpp"
#include "libjam/results_tables.hpp"

namespace jam {

namespace {

constexpr const char* format_name = "jamscope-analysis";
using Version = std::array<std::uint32_t, 2>;
constexpr Version schema_version{2, 1};  // a larger second number only adds items

std::vector<ContactLife> life_of(const std::vector<ContactLifeRow>& rows) {
  std::vector<ContactLife> life;
  for (const ContactLifeRow& r : rows)
    life.push_back({r.from, r.to, {r.ended_pp, r.alive_pp, r.together_pp}, {r.ended_pw, r.alive_pw, r.together_pw}});
  return life;
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
  write_table(file, "/tracks/points", points);
}

std::vector<Track> read_tracks(const h5::File& file) {
  const std::vector<JamEvent> events = read_table<JamEvent>(file, "/tracks");
  const auto particle = file.read<ParticleId>("/tracks/particle");
  if (particle.size() != events.size())
    file.fail("/tracks/particle", "expected " + std::to_string(events.size()) + " rows");
  auto points = read_parts(file, "/tracks", "point", read_table<Track::Point>(file, "/tracks/points"), events.size());
  std::vector<Track> tracks(events.size());
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    tracks[k] = {particle[k], events[k], std::move(points[k])};
    tracks[k].event.members = {particle[k]};
  }
  return tracks;
}

LoadedGrains read_loaded(const h5::File& file) {
  LoadedGrains loaded;
  loaded.grains = read_table<LoadedGrain>(file, "/loaded");
  loaded.count = file.read<std::uint32_t>("/loaded/of_frame/count");
  std::uint64_t rows = 0;
  for (const std::uint32_t count : loaded.count) rows += count;
  if (rows != loaded.grains.size())
    file.fail("/loaded/of_frame/count", "adds up to " + std::to_string(rows) + ", expected the " + std::to_string(loaded.grains.size()) + " rows of /loaded");
  loaded.floor = read_one<double>(file, "/loaded/of_frame/floor");
  const auto extent = file.read<Vec3>("/loaded/of_frame/extent");
  if (extent.size() != 2) file.fail("/loaded/of_frame/extent", "has " + std::to_string(extent.size()) + " rows, expected 2");
  loaded.extent.low = extent[0];
  loaded.extent.high = extent[1];
  return loaded;
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
  for (const auto& [group, rows] : {std::pair{"/loaded/of_frame/count", analysis.loaded.count.size()}, {"/blade", analysis.blade.size()}})
    if (rows != frames) file.fail(group, "has " + std::to_string(rows) + " rows, expected " + std::to_string(frames) + ", one for each frame");
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
    write_table(file, "/loaded", analysis.loaded.grains);
    file.write("/loaded/of_frame/count", analysis.loaded.count, "1", "rows of /loaded, frame after frame");
    file.write("/loaded/of_frame/floor", std::vector<double>{analysis.loaded.floor}, "N", "every particle above it is here");
    file.write("/loaded/of_frame/extent", std::vector<Vec3>{analysis.loaded.extent.low, analysis.loaded.extent.high}, "m", "box around the particles of all frames");
    std::vector<BladeRow> blade;
    for (const BladePose& pose : analysis.blade) blade.push_back(row_of(pose));
    write_table(file, "/blade", blade);
    write_table(file, "/survival_classes", analysis.survival_classes);
    file.write("/jammed_histogram/frames", analysis.jammed_histogram, "1", "row n: frames with n jammed particles");
    write_flow_energy(file, analysis.flow_energy);
    for (std::size_t s = 0; s < analysis.every_step.size(); ++s)
      write_with_members(file, "/every_step/" + std::string(jam_stream_names[s]), analysis.every_step[s].jams);
    if (!analysis.contact_life.empty()) write_table(file, "/contact_life", rows_of(analysis.contact_life));
    if (!analysis.flow_pattern.empty()) write_table(file, "/flow_pattern", analysis.flow_pattern);
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
  analysis.loaded = read_loaded(file);
  for (const BladeRow& row : read_table<BladeRow>(file, "/blade")) analysis.blade.push_back(pose_of(row));
  analysis.survival_classes = read_table<SurvivalClass>(file, "/survival_classes");
  analysis.jammed_histogram = file.read<std::uint32_t>("/jammed_histogram/frames");
  analysis.flow_energy = read_flow_energy(file);
  for (const std::string_view stream : jam_stream_names) {
    const std::string group = "/every_step/" + std::string(stream);
    if (file.exists(group)) analysis.every_step.push_back({read_with_members<StepJam>(file, group), {}});
  }
  if (file.exists("/contact_life")) analysis.contact_life = life_of(read_table<ContactLifeRow>(file, "/contact_life"));
  if (file.exists("/flow_pattern")) analysis.flow_pattern = read_table<FlowBin>(file, "/flow_pattern");
  analysis.notes = file.read_texts("/notes");
  analysis.corrected = corrected_for_sampling(analysis.events, analysis.sampling_interval, analysis.observed_time);
  check_frame_rows(file, analysis);
  return analysis;
}

}  // namespace jam
