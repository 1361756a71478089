#include "apps/jamscope/report.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "apps/jamscope/version.hpp"

namespace jamscope {

// The page with a marker in place of its data; generated at build time from report/dist/report.html.
extern const unsigned char report_page[];
extern const std::size_t report_page_size;

namespace {

using nlohmann::json;

constexpr std::string_view data_marker = "@JAMSCOPE_REPORT_DATA@";
constexpr std::size_t longest_text = 100'000;  // bytes, of a case file
constexpr std::size_t longest_list = 200;      // entries, of notes and arguments
constexpr std::size_t most_data = 5'000'000;   // bytes, of the island: what a browser parses at once
constexpr std::size_t metric_rows = 2000;      // of the hundred curves of network metrics
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Shorter numbers make a smaller page; a curve needs no more than 6 digits, an instant 10.
double rounded(double value, int digits) {
  if (!std::isfinite(value) || value == 0) return value;
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::scientific, digits - 1).ptr;
  double result = value;
  std::from_chars(text, end, result);
  return result;
}

json number(double value, int digits = 6) {
  return std::isfinite(value) ? json(rounded(value, digits)) : json(nullptr);
}
json instant(double time) {
  return number(time, 10);
}

std::string shortened(const std::string& text, std::size_t longest = longest_text) {
  if (text.size() <= longest) return text;
  return text.substr(0, longest) + "\n... (" + std::to_string(text.size() - longest) + " more bytes)";
}

json texts(const std::vector<std::string>& all) {
  json list = json::array();
  for (std::size_t k = 0; k < std::min(all.size(), longest_list); ++k) list.push_back(shortened(all[k], 2000));
  if (all.size() > longest_list) list.push_back("... (" + std::to_string(all.size() - longest_list) + " more)");
  return list;
}

// Rows of a curve gathered in bins of `every` consecutive ones; the last bin may be shorter.
struct Bins {
  std::size_t rows, every;
  Bins(std::size_t n, std::size_t limit) : rows(n), every(n == 0 ? 1 : (n + limit - 1) / limit) {}
  std::size_t size() const { return (rows + every - 1) / every; }
  std::size_t begin(std::size_t bin) const { return bin * every; }
  std::size_t end(std::size_t bin) const { return std::min(rows, (bin + 1) * every); }
};

enum class Keep { last, low, mean, high };

// One number per bin; values that are not finite are left out, a bin without any gives null.
template <class Value>
json curve(const Bins& bins, Keep keep, Value value, int digits = 6) {
  json column = json::array();
  for (std::size_t b = 0; b < bins.size(); ++b) {
    double result = nan, sum = 0;
    std::size_t count = 0;
    for (std::size_t r = bins.begin(b); r < bins.end(b); ++r) {
      const double v = static_cast<double>(value(r));
      if (!std::isfinite(v)) continue;
      if (keep == Keep::last || count == 0) result = v;
      if (keep == Keep::low) result = std::min(result, v);
      if (keep == Keep::high) result = std::max(result, v);
      sum += v;
      ++count;
    }
    if (keep == Keep::mean && count > 0) result = sum / static_cast<double>(count);
    column.push_back(number(result, digits));
  }
  return column;
}

template <class T>
json column(const Bins& bins, Keep keep, const std::vector<T>& values) {
  if (!jam::present(values, bins.rows)) return json::array();
  return curve(bins, keep, [&](std::size_t r) { return values[r]; });
}

json axial(const Bins& bins, Keep keep, const std::vector<jam::Vec3>& values) {
  if (!jam::present(values, bins.rows)) return json::array();
  return curve(bins, keep, [&](std::size_t r) { return values[r].z(); });
}

json frames_json(const std::vector<jam::FrameSummary>& frames, std::size_t limit) {
  const Bins bins(frames.size(), limit);
  const auto take = [&](Keep keep, auto member) {
    return curve(bins, keep, [&](std::size_t r) { return frames[r].*member; });
  };
  using F = jam::FrameSummary;
  return {{"rows", bins.rows},
          {"every", bins.every},
          {"time", curve(
                       bins, Keep::last, [&](std::size_t r) { return frames[r].time; }, 10)},
          {"largest_force", take(Keep::high, &F::largest_compressive_force)},
          {"mean_force", take(Keep::mean, &F::mean_compressive_force)},
          {"jammed", take(Keep::high, &F::jammed)},
          {"jammed_in_gap", take(Keep::high, &F::jammed_in_gap)},
          {"bridges", take(Keep::high, &F::bridges)},
          {"coordination", take(Keep::mean, &F::coordination)},
          {"coordination_with_walls", take(Keep::mean, &F::coordination_with_walls)}};
}

json series_json(const jam::RunInfo& info, const jam::Series& series, std::size_t limit) {
  if (series.size() == 0) return nullptr;
  const Bins bins(series.size(), limit);
  json blades = json::array();
  for (std::size_t w = 0; w < std::min(info.walls.size(), series.walls.size()); ++w) {
    if (info.walls[w].role != jam::WallRole::blade) continue;
    const auto& wall = series.walls[w];
    blades.push_back({{"name", info.walls[w].name},
                      {"force_mean", axial(bins, Keep::mean, wall.force)},
                      {"force_low", axial(bins, Keep::low, wall.force_min)},
                      {"force_high", axial(bins, Keep::high, wall.force_max)},
                      {"torque_mean", axial(bins, Keep::mean, wall.torque)},
                      {"torque_low", axial(bins, Keep::low, wall.torque_min)},
                      {"torque_high", axial(bins, Keep::high, wall.torque_max)}});
  }
  const double span = series.time.back() - series.time.front();
  return {{"rows", bins.rows},
          {"every", bins.every},
          {"window", number(series.size() > 1 ? span / static_cast<double>(series.size() - 1) : nan)},
          {"time", curve(
                       bins, Keep::last, [&](std::size_t r) { return series.time[r]; }, 10)},
          {"largest_force", column(bins, Keep::high, series.largest_compressive_force)},
          {"jammed", column(bins, Keep::high, series.jammed_count)},
          {"watch_force", number(info.watch_force > 0 && info.watch_radius == 0 ? info.watch_force : nan)},
          {"kinetic_energy", column(bins, Keep::high, series.kinetic_energy)},
          {"largest_overlap", column(bins, Keep::high, series.largest_overlap)},
          {"blades", blades}};
}

json flow_energy_json(const jam::FlowEnergy& flow, std::size_t limit) {
  const Bins bins(jam::present(flow.energy, flow.time.size()) ? flow.time.size() : 0, limit);
  return {{"source", flow.source},
          {"total", number(flow.source.empty() || flow.source == "none" ? nan : flow.total)},
          {"rows", bins.rows},
          {"every", bins.every},
          {"time", curve(
                       bins, Keep::last, [&](std::size_t r) { return flow.time[r]; }, 10)},
          {"energy", curve(bins, Keep::last, [&](std::size_t r) { return flow.energy[r]; })}};
}

json event_json(const jam::JamEvent& event) {
  constexpr std::size_t named = 20;
  json members = json::array();
  for (std::size_t k = 0; k < std::min(named, event.members.size()); ++k) members.push_back(event.members[k]);
  return {{"start", instant(event.start)},
          {"end", instant(event.end)},
          {"first_frame", event.first_frame},
          {"last_frame", event.last_frame},
          {"samples", event.samples},
          {"survival_time", number(event.survival_time)},
          {"shortest", number(event.shortest)},
          {"longest", number(event.longest)},
          {"open_at_start", event.open_at_start},
          {"open_at_end", event.open_at_end},
          {"peak_force", number(event.peak_force)},
          {"peak_time", instant(event.peak_time)},
          {"peak_particle", event.peak_particle},
          {"peak_in_gap", event.peak_in_gap},
          {"bridged", event.bridged},
          {"members", members},
          {"member_count", event.members.size()}};
}

// The vessel whose axis the radial positions are measured from: the first cylinder.
const jam::Wall* round_vessel(const jam::RunInfo& info) {
  for (const auto& wall : info.walls)
    if (wall.role == jam::WallRole::vessel && wall.kind == "cylinder" && wall.axis.norm() > 0) return &wall;
  return nullptr;
}

json track_json(const jam::Track& track, const jam::Wall* vessel) {
  const jam::Track::Point* peak = nullptr;
  double path = 0, speed = 0;
  std::size_t speeds = 0;
  for (std::size_t k = 0; k < track.points.size(); ++k) {
    const auto& point = track.points[k];
    if (peak == nullptr || point.compressive_force > peak->compressive_force) peak = &point;
    if (k > 0) path += (point.position - track.points[k - 1].position).cast<double>().norm();
    const double s = point.velocity.cast<double>().norm();
    if (std::isfinite(s)) speed += s, ++speeds;
  }
  double radius = nan, height = nan;
  if (peak != nullptr) {
    const jam::Vec3 at = peak->position.cast<double>();
    height = at.z();
    if (vessel != nullptr) {
      const jam::Vec3 axis = vessel->axis.normalized(), arm = at - vessel->point;
      radius = (arm - arm.dot(axis) * axis).norm();
    }
  }
  const auto& event = track.event;
  return {{"particle", track.particle},
          {"start", instant(event.start)},
          {"end", instant(event.end)},
          {"samples", event.samples},
          {"survival_time", number(event.survival_time)},
          {"shortest", number(event.shortest)},
          {"longest", number(event.longest)},
          {"open_at_start", event.open_at_start},
          {"open_at_end", event.open_at_end},
          {"peak_force", number(event.peak_force)},
          {"peak_time", instant(event.peak_time)},
          {"peak_in_gap", event.peak_in_gap},
          {"radius", number(radius)},
          {"height", number(height)},
          {"path", number(track.points.empty() ? nan : path)},
          {"mean_speed", number(speeds > 0 ? speed / static_cast<double>(speeds) : nan)}};
}

// Rows to show of more than `limit`: those with the largest peak force (ties: the earlier row), in their own order.
template <class Row, class Peak>
std::vector<std::size_t> strongest(const std::vector<Row>& all, std::size_t limit, Peak peak) {
  std::vector<std::size_t> rows(all.size());
  for (std::size_t k = 0; k < rows.size(); ++k) rows[k] = k;
  if (rows.size() <= limit) return rows;
  const auto force = [&](std::size_t r) { return std::isfinite(peak(all[r])) ? peak(all[r]) : 0.0; };
  std::stable_sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) { return force(a) > force(b); });
  rows.resize(limit);
  std::sort(rows.begin(), rows.end());
  return rows;
}

json events_json(const jam::Analysis& analysis, std::size_t limit) {
  json list = json::array();
  for (const auto k : strongest(analysis.events, limit, [](const jam::JamEvent& e) { return e.peak_force; })) {
    list.push_back(event_json(analysis.events[k]));
    list.back()["number"] = k + 1;
  }
  return list;
}

json tracks_json(const jam::RunInfo& info, const jam::Analysis& analysis, std::size_t limit) {
  const jam::Wall* vessel = round_vessel(info);
  json list = json::array();
  for (const auto k : strongest(analysis.tracks, limit, [](const jam::Track& t) { return t.event.peak_force; }))
    list.push_back(track_json(analysis.tracks[k], vessel));
  return list;
}

json cluster_events_json(const jam::Analysis& analysis, std::size_t limit) {
  json list = json::array();
  for (const auto k : strongest(analysis.cluster_events, limit, [](const jam::JamEvent& e) { return e.peak_force; })) {
    list.push_back(event_json(analysis.cluster_events[k]));
    list.back()["number"] = k + 1;
  }
  return list;
}

json step_jam_json(const jam::StepJam& jam) {
  constexpr std::size_t named = 20;
  json members = json::array();
  for (std::size_t k = 0; k < std::min(named, jam.members.size()); ++k) members.push_back(jam.members[k]);
  return {{"start", instant(jam.start)},
          {"end", instant(jam.end)},
          {"duration", number(jam.duration)},
          {"open_at_start", jam.open_at_start},
          {"open_at_end", jam.open_at_end},
          {"peak_force", number(jam.peak_force)},
          {"peak_time", instant(jam.peak_time)},
          {"peak_particle", jam.peak_particle},
          {"site", jam.site},
          {"impulse", number(jam.impulse)},
          {"work", number(jam.work)},
          {"members", members},
          {"member_count", jam.members.size()}};
}

json interval_json(double value, double low, double high) {
  return {{"value", number(value)}, {"low", number(low)}, {"high", number(high)}};
}

json numbers(const std::vector<double>& values) {
  json list = json::array();
  for (const double v : values) list.push_back(number(v));
  return list;
}

// Jams of every step, by stream; none where the run did not watch.
json steps_json(const jam::Analysis& analysis, std::size_t limit) {
  json streams = json::object();
  for (std::size_t s = 0; s < analysis.every_step.size(); ++s) {
    const auto& stream = analysis.every_step[s];
    const jam::JamStatistics& t = stream.statistics;
    json jams = json::array();
    for (const auto k : strongest(stream.jams, limit, [](const jam::StepJam& j) { return j.peak_force; })) jams.push_back(step_jam_json(stream.jams[k]));
    streams[std::string(jam::jam_stream_names[s])] = {
        {"events", stream.jams.size()},
        {"jams", jams},
        {"rate", interval_json(t.rate.value, t.rate.low, t.rate.high)},
        {"median", interval_json(t.median.value, t.median.low, t.median.high)},
        {"jammed_time", number(t.jammed_time)},
        {"longest", number(t.longest)},
        {"fano", number(t.fano)},
        {"survival", {{"time", numbers(t.survival.time)}, {"share", numbers(t.survival.share)}, {"low", numbers(t.survival.low)}, {"high", numbers(t.survival.high)}}}};
  }
  return streams;
}

json metrics_json(const jam::Analysis& analysis, std::size_t limit) {
  const Bins bins(analysis.frames.size(), std::min(limit, metric_rows));
  json curves = json::array();
  for (const jam::RecordedMetric& m : analysis.metrics)
    if (std::any_of(m.values.begin(), m.values.end(), [](double v) { return std::isfinite(v); }))
      curves.push_back({{"name", m.name}, {"unit", m.unit}, {"doc", m.doc}, {"values", column(bins, Keep::mean, m.values)}});
  return {{"every", bins.every},
          {"time", curve(
                       bins, Keep::last, [&](std::size_t r) { return analysis.frames[r].time; }, 10)},
          {"curves", curves}};
}

// The energy ledger: one curve for each place where energy is or went, and the work of each wall.
json energy_json(const jam::RunInfo& info, const jam::Series& series, std::size_t limit) {
  if (series.energy.residual.empty()) return nullptr;
  const Bins bins(series.size(), limit);
  json curves = json::array();
  double put_in = 0;
  const auto add = [&](const std::string& name, const std::vector<double>& values) {
    if (jam::present(values, bins.rows)) curves.push_back({{"name", name}, {"values", column(bins, Keep::last, values)}});
  };
  for (std::size_t w = 0; w < std::min(info.walls.size(), series.walls.size()); ++w) {
    add("work of " + info.walls[w].name, series.walls[w].work);
    if (!series.walls[w].work.empty()) put_in += std::max(series.walls[w].work.back(), 0.0);
  }
  const jam::Series::Energy& e = series.energy;
  const std::pair<const char*, const std::vector<double>*> places[] = {
      {"kinetic", &e.kinetic}, {"rotational", &e.rotational}, {"gravitational", &e.gravitational}, {"elastic", &e.elastic}, {"adhesive", &e.adhesive},
      {"tangential springs", &e.tangential}, {"rolling springs", &e.rolling}, {"normal damping", &e.normal_damping}, {"tangential damping", &e.tangential_damping},
      {"sliding", &e.sliding}, {"rolling resistance", &e.rolling_resistance}, {"detachment", &e.detachment}, {"change of stiffness", &e.stiffness_change},
      {"lost by the finite step", &e.time_stepping}, {"unexplained", &e.residual}};
  for (const auto& [name, values] : places) add(name, *values);
  return {{"every", bins.every},
          {"time", curve(
                       bins, Keep::last, [&](std::size_t r) { return series.time[r]; }, 10)},
          {"put_in", number(put_in)},
          {"unexplained", number(e.residual.back())},
          {"curves", curves}};
}

json headline_json(const jam::Analysis& analysis, const jam::Series& series) {
  double force = nan, at = nan;
  std::string source = "frames";
  std::uint32_t particles = 0;
  std::size_t bridged = 0, censored = 0;
  for (const auto& frame : analysis.frames) {
    particles = std::max(particles, frame.particles);
    const double f = frame.largest_compressive_force;
    if (std::isfinite(f) && !(f <= force)) force = f, at = frame.time;
  }
  // Every step was looked at for the series, so it can only know of more.
  if (series.size() > 0 && jam::present(series.largest_compressive_force, series.size())) {
    source = "series";  // also where the largest came at a frame, which has it with more digits
    for (std::size_t r = 0; r < series.size(); ++r) {
      const double f = series.largest_compressive_force[r];
      if (std::isfinite(f) && !(f <= force)) force = f, at = series.time[r];
    }
  }
  for (const auto& event : analysis.events) {
    bridged += event.bridged;
    censored += event.open_at_start || event.open_at_end;
  }
  const bool timed = analysis.observed_time > 0;
  json every_step;
  if (!analysis.every_step.empty()) {
    const jam::JamStatistics& s = analysis.every_step[0].statistics;
    every_step = {{"events", analysis.every_step[0].jams.size()}, {"grains", analysis.every_step[1].jams.size()},
                  {"median", number(s.median.value)}, {"longest", number(s.longest)}};
  }
  return {{"every_step", every_step},
          {"events", analysis.events.size()},
          {"bridged", bridged},
          {"censored", censored},
          {"tracks", analysis.tracks.size()},
          {"frames", analysis.frames.size()},
          {"particles", particles},
          {"observed_time", instant(timed ? analysis.observed_time : nan)},
          {"sampling_interval", instant(analysis.sampling_interval > 0 ? analysis.sampling_interval : nan)},
          {"jammed_time", number(analysis.jammed_time)},
          {"jammed_share", number(timed ? analysis.jammed_time / analysis.observed_time : nan)},
          {"jam_frequency", number(timed ? analysis.jam_frequency : nan)},
          {"largest_force", number(force)},
          {"largest_force_time", instant(at)},
          {"largest_force_source", source},
          {"jammed_in_gap_share", number(analysis.jammed_in_gap_share)}};
}

std::string measure_name(jam::CompressiveMeasure measure) {
  switch (measure) {
    case jam::CompressiveMeasure::sum:
      return "sum of the repulsive normal forces";
    case jam::CompressiveMeasure::max:
      return "largest repulsive normal force";
    case jam::CompressiveMeasure::signed_:
      return "sum of the signed normal forces";
  }
  return "unknown";
}

json criteria_json(const jam::Criteria& criteria) {
  json bounds = json::array();
  for (const double bound : criteria.survival_classes) bounds.push_back(number(bound));
  return {{"measure", measure_name(criteria.measure)},
          {"jam_force", number(criteria.jam_force, 10)},
          {"bridge_contact_share", number(criteria.bridge_contact_share)},
          {"gap_margin", number(criteria.gap_margin)},
          {"survival_classes", bounds}};
}

std::string role_name(jam::WallRole role) {
  switch (role) {
    case jam::WallRole::blade:
      return "blade";
    case jam::WallRole::vessel:
      return "vessel";
    case jam::WallRole::other:
      return "other";
  }
  return "other";
}

json run_json(const jam::RunInfo& info) {
  json materials = json::array(), interactions = json::array(), walls = json::array();
  for (const auto& m : info.materials)
    materials.push_back(
        {{"name", m.name}, {"density", number(m.density)}, {"young", number(m.young)}, {"poisson", number(m.poisson)}});
  for (std::size_t a = 0; a < std::min(info.interactions.size(), info.materials.size()); ++a)
    for (std::size_t b = a; b < std::min(info.interactions[a].size(), info.materials.size()); ++b) {
      const auto& i = info.interactions[a][b];
      interactions.push_back({{"a", info.materials[a].name},
                              {"b", info.materials[b].name},
                              {"restitution", number(i.restitution)},
                              {"friction", number(i.friction)},
                              {"rolling", number(i.rolling)},
                              {"work_of_adhesion", number(i.work_of_adhesion)}});
    }
  for (const auto& w : info.walls)
    walls.push_back({{"name", w.name},
                     {"kind", w.kind},
                     {"role", role_name(w.role)},
                     {"material", w.material},
                     {"triangles", w.triangles.size()}});
  return {{"creator", info.creator},
          {"creator_version", info.creator_version},
          {"commit", info.commit},
          {"created_utc", info.created_utc},
          {"case_toml", shortened(info.case_toml)},
          {"case_sha256", info.case_sha256},
          {"argv", texts(info.argv)},
          {"seed", std::to_string(info.seed)},  // text: JavaScript would round large ones
          {"gravity", {number(info.gravity.x()), number(info.gravity.y()), number(info.gravity.z())}},
          {"dt", number(info.dt > 0 ? info.dt : nan)},
          {"wall_loads_known", info.wall_loads_known},
          {"materials", materials},
          {"interactions", interactions},
          {"walls", walls},
          {"gap",
           {{"tip_radius", number(info.gap.tip_radius > 0 ? info.gap.tip_radius : nan)},
            {"vessel_radius", number(info.gap.vessel_radius > 0 ? info.gap.vessel_radius : nan)}}}};
}

json run_data(const ReportRun& run, std::size_t rows) {
  const auto& [info, analysis, series, context, scene] = run;
  json classes = json::array(), histogram = json::array(), derived = json::array();
  for (const auto& c : analysis.survival_classes)
    classes.push_back({{"low", number(c.low)},
                       {"high", number(c.high)},
                       {"events", c.events},
                       {"frequency", number(c.frequency)},
                       {"share_of_jam_time", number(c.share_of_jam_time)}});
  for (std::size_t n = 0; n < std::min<std::size_t>(analysis.jammed_histogram.size(), 1000); ++n)
    histogram.push_back(analysis.jammed_histogram[n]);
  for (std::size_t k = 0; k < std::min(context.derived.size(), longest_list); ++k)
    derived.push_back({{"name", shortened(context.derived[k].name, 2000)},
                       {"value", shortened(context.derived[k].value, 2000)},
                       {"unit", shortened(context.derived[k].unit, 200)}});
  const std::size_t listed = std::max<std::size_t>(rows / 5, 1);
  return {{"name", shortened(context.facts.name, 200)},
          {"description", shortened(context.facts.description, 5000)},
          {"headline", headline_json(analysis, series)},
          {"criteria", criteria_json(analysis.criteria)},
          {"frames", frames_json(analysis.frames, rows)},
          {"series", series_json(info, series, rows)},
          {"flow_energy", flow_energy_json(analysis.flow_energy, rows)},
          {"events", events_json(analysis, listed)},
          {"tracks", tracks_json(info, analysis, listed)},
          {"cluster_events", cluster_events_json(analysis, listed)},
          {"steps", steps_json(analysis, listed)},
          {"metrics", metrics_json(analysis, rows)},
          {"energy", energy_json(info, series, rows)},
          {"scene", scene.view},
          {"samples", scene.samples},
          {"stays", scene.stays},
          {"survival_classes", classes},
          {"jammed_histogram", histogram},
          {"derived", derived},
          {"run", run_json(info)},
          {"notes", texts(analysis.notes)},
          {"warnings", texts(context.facts.warnings)},
          {"report",
           {{"program", "jamscope"},
            {"version", version},
            {"commit", commit},
            {"created_utc", context.facts.created_utc},
            {"machine", context.facts.machine},
            {"command_line", texts(context.facts.command_line)},
            {"wall_seconds", number(context.facts.wall_seconds)},
            {"particle_steps_per_second", number(context.facts.particle_steps_per_second)}}}};
}

}  // namespace

std::string report_json(const std::vector<ReportRun>& runs, std::size_t rows) {
  json data{{"format", "jamscope-report"}, {"schema", 2}, {"runs", json::array()}};
  for (const ReportRun& run : runs) data["runs"].push_back(run_data(run, std::max<std::size_t>(rows, 1)));
  // Plain ASCII without '<': nothing in it can end the script element that holds it, whatever a name contains.
  const std::string text = data.dump(-1, ' ', true, json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  }
  return safe;
}

std::string report_html(const std::vector<ReportRun>& runs) {
  const std::string_view page(reinterpret_cast<const char*>(report_page), report_page_size);
  const auto at = page.find(data_marker);
  if (at == std::string_view::npos) throw std::logic_error("report page: the data marker is missing");
  std::string sections;
  for (std::size_t r = 0; r < runs.size(); ++r)
    for (std::size_t k = 0; k < runs[r].scene.sections.size(); ++k)
      sections += "</script>\n<script type=\"text/plain\" id=\"s" + std::to_string(r) + "-" + std::to_string(k) + "\">" + runs[r].scene.sections[k];
  const std::size_t most = std::min(most_data, largest_report - std::min(largest_report, page.size() + sections.size()));
  std::string data;
  for (std::size_t rows = 20'000;; rows /= 2) {
    data = report_json(runs, rows);
    if (data.size() <= most || rows < 100) break;
  }
  // The sections follow the island as elements of their own; the page closes the last one.
  std::string html;
  html.reserve(page.size() + data.size() + sections.size());
  html.append(page.substr(0, at)).append(data).append(sections).append(page.substr(at + data_marker.size()));
  return html;
}

}  // namespace jamscope
