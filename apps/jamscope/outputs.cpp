#include "apps/jamscope/outputs.hpp"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "apps/jamscope/case_file.hpp"
#include "apps/jamscope/derived_table.hpp"
#include "apps/jamscope/errors.hpp"
#include "apps/jamscope/version.hpp"
#include "libdem/errors.hpp"
#include "libjam/errors.hpp"
#include "libjam/events/peaks.hpp"
#include "libjam/jamming/jam_criteria.hpp"
#include "libjam/results_file.hpp"
#include "libjam/snapshot/schema.hpp"
#include "libjam/statistics/blade_load.hpp"
#include "libjam/statistics/jam_places.hpp"
#include "libjam/statistics/lifetimes.hpp"

namespace jamscope {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

// summary.json is for reading; all events are in events.csv.
constexpr std::size_t events_in_summary = 20;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

template <class T>
void set_if(Json& json, const char* key, const T& value, bool known) {
  if (known) json[key] = value;
}

Json run_json(const jam::RunInfo& info, const RunFacts& facts) {
  Json run;
  set_if(run, "name", facts.name, !facts.name.empty());
  set_if(run, "description", facts.description, !facts.description.empty());
  set_if(run, "creator", info.creator, !info.creator.empty());
  set_if(run, "creator_version", info.creator_version, !info.creator_version.empty());
  set_if(run, "commit", info.commit, !info.commit.empty());
  set_if(run, "created_utc", info.created_utc, !info.created_utc.empty());
  set_if(run, "case_sha256", info.case_sha256, !info.case_sha256.empty());
  set_if(run, "seed", info.seed, !info.case_toml.empty());
  set_if(run, "step_s", info.dt, info.dt > 0);
  set_if(run, "command_line", info.argv, !info.argv.empty());
  Json analysed{{"version", version}, {"commit", commit}};
  set_if(analysed, "created_utc", facts.created_utc, !facts.created_utc.empty());
  set_if(analysed, "command_line", facts.command_line, !facts.command_line.empty());
  set_if(analysed, "inputs", facts.inputs, !facts.inputs.empty());
  set_if(analysed, "machine", facts.machine, !facts.machine.empty());
  set_if(analysed, "threads", facts.threads, facts.threads > 0);
  set_if(analysed, "wall_seconds", facts.wall_seconds, std::isfinite(facts.wall_seconds));
  set_if(analysed, "particle_steps_per_second", facts.particle_steps_per_second,
         std::isfinite(facts.particle_steps_per_second));
  set_if(analysed, "warnings", facts.warnings, !facts.warnings.empty());
  run["results_by"] = analysed;
  return run;
}

// J, of all walls that put energy in.
double work_put_in(const jam::RunInfo& info, const jam::Series& series) {
  double sum = 0;
  for (std::size_t w = 0; w < info.walls.size() && w < series.walls.size(); ++w)
    if (!series.walls[w].work.empty()) sum += std::max(series.walls[w].work.back(), 0.0);
  return sum;
}

// The last row of the energy ledger, J.
Json energy_json(const jam::RunInfo& info, const jam::Series& series) {
  Json energy, work;
  for (std::size_t w = 0; w < info.walls.size() && w < series.walls.size(); ++w)
    if (!series.walls[w].work.empty()) work[info.walls[w].name] = series.walls[w].work.back();
  energy["time_s"] = series.time.back();
  energy["work_of_wall"] = work;
  const std::string folder = "/series/energy/";
  jam::schema::visit_series(series, [&](const jam::schema::Item& item, const auto& values) {
    if constexpr (std::is_same_v<std::decay_t<decltype(values)>, std::vector<double>>)
      if (item.path.starts_with(folder)) energy[std::string(item.path.substr(folder.size()))] = values.back();
  });
  energy["residual_over_work_put_in"] = series.energy.residual.back() / work_put_in(info, series);
  return energy;
}

// How many jams there are above any threshold: stretches of the series of largest forces, of windows of steps where the source has them, else of
// frames. Thresholds: ten to a decade, up to the largest force.
Json jams_above_json(const jam::Analysis& a, const jam::Series& series) {
  const bool windows = jam::present(series.largest_compressive_force, series.size()) && series.size() > 0;
  std::vector<double> force;
  if (windows) {
    force.assign(series.largest_compressive_force.begin(), series.largest_compressive_force.end());
  } else {
    for (const jam::FrameSummary& frame : a.frames) force.push_back(frame.largest_compressive_force);
  }
  const double most = force.empty() ? 0.0 : *std::max_element(force.begin(), force.end());
  if (!(most > 0)) return Json::object();
  constexpr int decades = 4, in_a_decade = 10;
  std::vector<double> thresholds;
  const double top = std::floor(in_a_decade * std::log10(most));
  for (double k = top - decades * in_a_decade; k <= top; ++k) thresholds.push_back(std::pow(10, k / in_a_decade));
  return {{"of", windows ? "windows of steps" : "frames"}, {"threshold_N", thresholds}, {"jams", jam::counts_above(jam::peaks(force), thresholds)}};
}

const char* word(jam::CompressiveMeasure measure) {
  switch (measure) {
    case jam::CompressiveMeasure::sum:
      return "sum";
    case jam::CompressiveMeasure::max:
      return "max";
    case jam::CompressiveMeasure::signed_:
      return "signed";
  }
  return "";
}

Json event_json(const jam::JamEvent& e) {
  return {{"start_s", e.start},
          {"end_s", e.end},
          {"survival_time_s", e.survival_time},
          {"shortest_s", e.shortest},
          {"longest_s", number(e.longest)},
          {"samples", e.samples},
          {"open_at_start", e.open_at_start},
          {"open_at_end", e.open_at_end},
          {"peak_force_N", e.peak_force},
          {"peak_time_s", e.peak_time},
          {"peak_particle", e.peak_particle},
          {"peak_in_gap", e.peak_in_gap},
          {"bridged", e.bridged},
          {"members", e.members}};
}

Json rate_json(const jam::Rate& rate) {
  return {{"value", number(rate.value)}, {"low", number(rate.low)}, {"high", number(rate.high)}};
}

Json numbers(const std::vector<double>& values) {
  Json all = Json::array();
  for (const double value : values) all.push_back(number(value));
  return all;
}

// Of one stream, as seen at every step. Intervals hold 95 %. flow_energy: J, of the whole record.
Json step_stream_json(const jam::Analysis::StepStream& stream, double flow_energy) {
  const jam::JamStatistics& s = stream.statistics;
  double peak = 0, work = 0;
  std::size_t cut_off = 0;
  for (const jam::StepJam& jam : stream.jams) {
    peak = std::max(peak, jam.peak_force);
    work += jam.work;
    cut_off += jam.open_at_start || jam.open_at_end;
  }
  Json json{{"events", stream.jams.size()},
            {"cut_off_by_the_record", cut_off},
            {"frequency_per_s", rate_json(s.rate)},
            {"jammed_time_s", number(s.jammed_time)},
            {"at_a_time", number(s.at_a_time)},
            {"median_duration_s", {{"value", number(s.median.value)}, {"low", number(s.median.low)}, {"high", number(s.median.high)}}},
            {"longest_s", number(s.longest)},
            {"largest_force_N", number(peak)},
            {"work_J", number(work)},
            {"share_of_flow_energy", number(work / flow_energy)},
            {"fano_factor", number(s.fano)},
            {"independent_starts_p", number(s.independence.p)}};
  json["survival"] = {{"time_s", numbers(s.survival.time)}, {"share", numbers(s.survival.share)}, {"low", numbers(s.survival.low)}, {"high", numbers(s.survival.high)}};
  for (const jam::LawFit& law : s.laws)
    json["laws"][law.name] = {{"parameters", law.fit.parameter}, {"log_likelihood", number(law.fit.log_likelihood)}, {"akaike", number(law.akaike)}};
  return json;
}

// Turnbull's estimate from what n samples say of each duration; events that no frame saw are not in it.
Json brackets_json(const jam::Analysis& a) {
  std::vector<jam::LifetimeBracket> brackets;
  for (const jam::JamEvent& e : a.events)
    if (!e.open_at_start) brackets.push_back({e.shortest, e.longest});
  const jam::TurnbullEstimate estimate = jam::turnbull(brackets);
  return {{"after_s", numbers(estimate.low)}, {"until_s", numbers(estimate.high)}, {"share_that_ends", numbers(estimate.mass)}};
}

Json load_json(const jam::LoadPeaks& p) {
  return {{"every_step", number(p.every_step)}, {"windows", number(p.windows)}, {"frames", number(p.frames)},  {"filtered", number(p.filtered)},
          {"median", number(p.median)}, {"windows_over_median", number(p.windows / p.median)}, {"windows_over_filtered", number(p.windows / p.filtered)},
          {"trend", number(p.trend)}, {"medians", numbers(p.medians)}};
}

// What an instrument that holds the blade would feel.
Json blade_json(const jam::RunInfo& info, const jam::Analysis& a, const jam::Series& series) {
  std::vector<jam::FrameLoad> frames;
  for (const jam::FrameSummary& frame : a.frames)
    if (std::isfinite(frame.blade_force)) frames.push_back({frame.time, frame.blade_force, frame.blade_torque});
  const bool newtons = jam::criterion_of(a.criteria).unit == "N";
  const jam::BladeLoad load =
      newtons ? jam::blade_load(series, info.walls, frames, a.criteria.jam_force) : jam::blade_load(series, info.walls, frames);
  return {{"filter_s", jam::BladeLoad::filter}, {"force_N", load_json(load.force)}, {"torque_Nm", load_json(load.torque)}};
}

// The flow energy at evenly spaced times, the power law that fits it best, and the share of it that was put in while something was jammed.
Json flow_energy_json(const jam::Analysis& a, const jam::Series& series) {
  const jam::FlowEnergy& flow = a.flow_energy;
  Json json{{"source", flow.source}, {"total_J", number(flow.total)}};
  if (flow.time.size() < 2) return json;
  constexpr std::size_t points = 100;
  std::vector<double> time, energy;
  for (std::size_t k = 1; k <= points; ++k) {
    const double t = flow.time.back() * double(k) / points;
    const auto at = std::size_t(std::lower_bound(flow.time.begin(), flow.time.end(), t * (1 - 1e-12)) - flow.time.begin());
    time.push_back(t);
    energy.push_back(flow.energy[std::min(at, flow.energy.size() - 1)]);
  }
  json["curve"] = {{"time_s", numbers(time)}, {"energy_J", numbers(energy)}};
  const jam::PowerLaw law = jam::power_law(flow.time, flow.energy);
  json["power_law"] = {{"exponent", number(law.exponent)}, {"determination", number(law.determination)}};
  if (flow.source == "series" && flow.time.size() == series.size() && jam::criterion_of(a.criteria).unit == "N" &&
      jam::present(series.largest_compressive_force, series.size())) {
    double jammed = 0;
    for (std::size_t k = 0; k < series.size(); ++k)
      if (double{series.largest_compressive_force[k]} > a.criteria.jam_force) jammed += flow.energy[k] - (k > 0 ? flow.energy[k - 1] : 0.0);
    json["share_in_jammed_windows"] = number(jammed / flow.total);
  }
  return json;
}

// How long clusters that bridge blade and vessel keep their identity, half of them at most.
double bridge_lifetime(const jam::Analysis& a) {
  std::vector<jam::Lifetime> lifetimes;
  for (const jam::JamEvent& e : a.cluster_events)
    if (e.bridged && !e.open_at_start) lifetimes.push_back({e.survival_time, !e.open_at_end});
  return lifetimes.empty() ? std::numeric_limits<double>::quiet_NaN() : jam::when_left(jam::kaplan_meier(lifetimes)).value;
}

Json places_json(const jam::JamPlaces& p) {
  return {{"heights", p.heights}, {"even_p", number(p.even_p)},
          {"speed_over_tip", {{"lower_quartile", number(p.lower_quartile)}, {"median", number(p.median)}, {"upper_quartile", number(p.upper_quartile)},
                              {"slow", number(p.slow)}, {"between", number(p.between)}, {"fast", number(p.fast)}}}};
}

// Bins layer by layer upward, in each from the axis outward; of each the azimuthal, radial and vertical speed in turn.
Json flow_pattern_json(const std::vector<jam::FlowBin>& pattern) {
  std::vector<double> radius, height, speed;
  std::vector<std::uint64_t> samples;
  for (const jam::FlowBin& bin : pattern) {
    if (radius.size() < jam::FlowBin::rings) radius.push_back(bin.radius_low);
    if (height.empty() || bin.height_low > height.back()) height.push_back(bin.height_low);
    samples.push_back(bin.samples);
    speed.insert(speed.end(), {bin.azimuthal, bin.radial, bin.vertical});
  }
  radius.push_back(pattern.back().radius_high);
  height.push_back(pattern.back().height_high);
  return {{"radius_m", radius}, {"height_m", height}, {"samples", samples}, {"least_samples", jam::FlowBin::least_samples}, {"speed_over_tip", numbers(speed)}};
}

Json life_json(const jam::ContactLife::Kind& kind) {
  return {{"together", number(kind.together)}, {"ended", kind.ended}, {"alive", kind.alive}};
}

Json analysis_json(const jam::RunInfo& info, const jam::Analysis& a, const jam::Series& series) {
  Json json;
  Json bounds = Json::array();
  for (const double bound : a.criteria.survival_classes) bounds.push_back(bound);
  json["criteria"] = {{"criterion", a.criteria.criterion},
                      {"threshold", number(jam::threshold_of(a.criteria))},
                      {"measure", word(a.criteria.measure)},
                      {"jam_force_N", a.criteria.jam_force},
                      {"end_force_N", a.criteria.end_force.value_or(a.criteria.jam_force)},
                      {"hold_off_s", a.criteria.hold_off},
                      {"shortest_jam_s", a.criteria.shortest_jam},
                      {"bridge_contact_share", a.criteria.bridge_contact_share},
                      {"gap_margin", a.criteria.gap_margin},
                      {"survival_classes_s", bounds}};
  json["frames"] = a.frames.size();
  json["observed_time_s"] = number(a.observed_time);
  json["sampling_interval_s"] = number(a.sampling_interval);
  if (!a.frames.empty()) {
    json["first_time_s"] = a.frames.front().time;
    json["last_time_s"] = a.frames.back().time;
    json["particles"] = a.frames.back().particles;
    // Ties: the earliest frame.
    const auto peak = std::max_element(a.frames.begin(), a.frames.end(), [](const auto& x, const auto& y) {
      return x.largest_compressive_force < y.largest_compressive_force;
    });
    double mean = 0;
    for (const jam::FrameSummary& frame : a.frames) mean += frame.mean_compressive_force / double(a.frames.size());
    json["largest_compressive_force"] = {{"force_N", number(peak->largest_compressive_force)},
                                         {"time_s", peak->time},
                                         {"particle", peak->largest_particle},
                                         {"over_mean", number(peak->largest_compressive_force / mean)}};
    json["mean_compressive_force_N"] = number(mean);
  }
  const auto bridged = std::count_if(a.events.begin(), a.events.end(), [](const auto& e) { return e.bridged; });
  const auto censored =
      std::count_if(a.events.begin(), a.events.end(), [](const auto& e) { return e.open_at_start || e.open_at_end; });
  json["jams"] = {{"events", a.events.size()},
                  {"bridged", bridged},
                  {"cut_off_by_the_record", censored},
                  {"frequency_per_s", number(a.jam_frequency)},
                  {"corrected_for_sampling",
                   {{"frequency_per_s", rate_json(a.corrected.rate)},
                    {"mean_duration_s", {{"value", number(a.corrected.mean)}, {"low", number(a.corrected.low)}, {"high", number(a.corrected.high)}}},
                    {"unseen_share", number(a.corrected.unseen)}}},
                  {"survival_within_brackets", brackets_json(a)},
                  {"jammed_time_s", number(a.jammed_time)},
                  {"jammed_time_share", number(a.jammed_time / a.observed_time)},
                  {"mean_survival_time_s", number(a.jammed_time / static_cast<double>(a.events.size()))},
                  {"jammed_in_gap_share", number(a.jammed_in_gap_share)},
                  {"particle_tracks", a.tracks.size()},
                  {"clusters", a.clusters.size()},
                  {"bridging_cluster_median_survival_s", number(bridge_lifetime(a))},
                  {"places", places_json(jam::jam_places(a.tracks, info.gap))}};
  json["survival_classes"] = Json::array();
  for (const jam::SurvivalClass& c : a.survival_classes)
    json["survival_classes"].push_back({{"low_s", c.low},
                                        {"high_s", number(c.high)},
                                        {"events", c.events},
                                        {"frequency_per_s", number(c.frequency)},
                                        {"share_of_jam_time", number(c.share_of_jam_time)}});
  json["frames_by_jammed_particles"] = a.jammed_histogram;
  json["blade"] = blade_json(info, a, series);
  json["flow_energy"] = flow_energy_json(a, series);
  if (!a.flow_pattern.empty()) json["flow_pattern"] = flow_pattern_json(a.flow_pattern);
  for (std::size_t s = 0; s < a.every_step.size(); ++s)
    json["jams_at_every_step"][std::string(jam::jam_stream_names[s])] = step_stream_json(a.every_step[s], a.flow_energy.total);
  if (constexpr auto particle = std::size_t(jam::JamStream::particle); a.every_step.size() > particle) {
    const jam::JamStatistics& grains = a.every_step[particle].statistics;
    const jam::Overlapping any = jam::overlapping(grains.rate.value, grains.at_a_time / grains.rate.value);
    json["jams_at_every_step"]["global"]["if_grains_jam_independently"] = {
        {"at_a_time", number(any.share)}, {"frequency_per_s", number(any.rate)}, {"mean_duration_s", number(any.mean_duration)}};
  }
  if (!a.contact_life.empty()) {
    Json& life = json["contact_life"];
    life["median_s"] = {{"particles", number(jam::median_life(a.contact_life, &jam::ContactLife::particles))},
                        {"walls", number(jam::median_life(a.contact_life, &jam::ContactLife::walls))}};
    life["octaves"] = Json::array();
    for (const jam::ContactLife& l : a.contact_life)
      life["octaves"].push_back({{"from_s", l.from}, {"particles", life_json(l.particles)}, {"walls", life_json(l.walls)}});
  }
  json["first_events"] = Json::array();
  for (std::size_t e = 0; e < std::min(events_in_summary, a.events.size()); ++e)
    json["first_events"].push_back(event_json(a.events[e]));
  json["notes"] = a.notes;
  return json;
}

std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("model name")) {
      const std::size_t colon = line.find(": ");
      if (colon != std::string::npos) return line.substr(colon + 2);
    }
  utsname name{};
  return uname(&name) == 0 ? name.machine : "unknown processor";
}

}  // namespace

std::string utc_now() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

RunFacts facts_of_this_process(std::vector<std::string> command_line) {
  RunFacts facts;
  facts.command_line = std::move(command_line);
  facts.machine = fmt::format("{}, {} processors", processor(), std::max(1u, std::thread::hardware_concurrency()));
  facts.created_utc = utc_now();
  return facts;
}

RunFacts facts_of_summary(const std::string& text, const std::string& path) {
  try {
    const Json run = Json::parse(text).at("run");
    const Json& by = run.at("results_by");
    RunFacts facts;
    facts.name = run.value("name", "");
    facts.description = run.value("description", "");
    facts.inputs = by.value("inputs", std::vector<std::string>{});
    facts.command_line = by.value("command_line", std::vector<std::string>{});
    facts.machine = by.value("machine", "");
    facts.created_utc = by.value("created_utc", "");
    facts.threads = by.value("threads", 0);
    facts.wall_seconds = by.value("wall_seconds", facts.wall_seconds);
    facts.particle_steps_per_second = by.value("particle_steps_per_second", facts.particle_steps_per_second);
    facts.warnings = by.value("warnings", std::vector<std::string>{});
    return facts;
  } catch (const Json::exception& error) {
    throw jam::DataError(fmt::format("{}: is no summary of results: {}", path, error.what()));
  }
}

std::string energy_text(const jam::RunInfo& info, const jam::Series& series) {
  if (series.energy.residual.empty()) return "";
  const jam::Series::Energy& e = series.energy;
  const double spent = e.normal_damping.back() + e.tangential_damping.back() + e.sliding.back() +
                       e.rolling_resistance.back() + e.detachment.back();
  return fmt::format(
      "energy: {:.4g} J put in by walls, {:.4g} J dissipated (sliding {:.3g} %, normal damping {:.3g} %), {:.2g} J lost by the "
      "finite step, {:.1g} J unexplained\n",
      work_put_in(info, series), spent, 100 * e.sliding.back() / spent, 100 * e.normal_damping.back() / spent,
      e.time_stepping.back(), e.residual.back());
}

std::string summary_json(const jam::RunInfo& info, const jam::Analysis& analysis, const jam::Series& series,
                         const RunFacts& facts) {
  Json json{{"run", run_json(info, facts)}, {"analysis", analysis_json(info, analysis, series)}};
  json["analysis"]["jams_above"] = jams_above_json(analysis, series);
  if (!series.energy.residual.empty()) json["energy"] = energy_json(info, series);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void prepare_folder(const std::string& folder, bool overwrite) {
  std::error_code error;
  const auto status = fs::status(folder, error);
  if (fs::exists(status) && !fs::is_directory(status)) throw UsageError(folder + " is a file, expected a folder");
  if (fs::is_directory(status) && !overwrite && !fs::is_empty(folder, error))
    throw UsageError(folder + " is not empty: choose another folder, or --overwrite to replace the results in it");
  fs::create_directories(folder, error);
  if (error) throw UsageError(fmt::format("{} cannot be made: {}", folder, error.message()));
}

void write_text_file(const std::string& path, const std::string& text) {
  const std::string aside = path + ".part";
  std::ofstream out(aside, std::ios::binary | std::ios::trunc);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  std::error_code error;
  if (!out) {
    const std::string reason = std::strerror(errno);
    fs::remove(aside, error);
    throw jam::DataError(fmt::format("{}: cannot be written: {}", path, reason));
  }
  fs::rename(aside, path, error);
  if (error) throw jam::DataError(fmt::format("{}: cannot be written: {}", path, error.message()));
}

ReportContext report_context(const jam::RunInfo& info, const RunFacts& facts, const jam::Criteria& criteria) {
  ReportContext context{facts, {}};
  if (const jam::JamCriterion& criterion = jam::criterion_of(criteria); criterion.unit != "N")
    context.facts.warnings.push_back(fmt::format("where this page says above {:g} N, read: {} ({}, threshold {:g})", criteria.jam_force, criterion.doc, criterion.name,
                                           jam::threshold_of(criteria)));
  if (!info.case_toml.empty()) {
    try {
      const CaseFile file = read_case_text(info.case_toml, "stored case");
      for (const DerivedRow& row : derived_table(file.physics, dem::derive(file.physics)))
        context.derived.push_back({row.name, row.value, row.unit});
    } catch (const dem::CaseError&) {
      // A case of another version: the page does without its derived numbers.
    }
  }
  return context;
}

void write_outputs(const std::string& folder, const jam::RunInfo& info, const jam::Analysis& analysis,
                   const jam::Series& series, const RunFacts& facts, const jam::SnapshotSource* snapshots,
                   const std::string& snapshot_file) {
  const auto in_folder = [&](const char* name) { return (fs::path(folder) / name).string(); };
  write_text_file(in_folder("events.csv"), jam::events_csv(analysis));
  if (const std::string jams = jam::step_jams_csv(analysis); !jams.empty()) write_text_file(in_folder("jams.csv"), jams);
  write_text_file(in_folder("summary.json"), summary_json(info, analysis, series, facts));
  jam::write_results(in_folder("jam.h5"), analysis, info);
  const SceneData scene = snapshots != nullptr ? scene_data(*snapshots, analysis, series, room_for_scenes, snapshot_file)
                                               : no_scene("The snapshots of this analysis were not at hand when the page was written.");
  const ReportContext context = report_context(info, facts, analysis.criteria);
  write_text_file(in_folder("report.html"), report_html({{info, analysis, series, context, scene}}));
}

}  // namespace jamscope
