#include "apps/jamscope/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/jamscope/errors.hpp"
#include "libjam/errors.hpp"
#include "libjam/results_file.hpp"
#include "libjam/statistics/run_groups.hpp"
#include "libjam/statistics/sampled_durations.hpp"

namespace jamscope {
namespace {

using Json = nlohmann::ordered_json;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Run {
  std::string name;
  double record = 0;  // s
  std::uint64_t began = 0;  // jams that began in the record
  std::vector<jam::Lifetime> lifetimes;  // of jams that began in the record
  std::vector<double> peaks;  // N
  std::vector<double> blade_force, blade_torque;  // [frames] N, N m
  double energy = 0;  // J, put in by the blade
  jam::Rate rate;
  jam::Quantile median{nan, nan, nan};  // s
  double jammed_share = nan, longest = nan, work = nan, fano = nan, independent = nan;
};

Run of_steps(const jam::Analysis& a, const CompareOptions& options) {
  const auto* const name = std::find(std::begin(jam::jam_stream_names), std::end(jam::jam_stream_names), options.stream);
  const auto stream = std::size_t(name - std::begin(jam::jam_stream_names));
  const std::vector<jam::StepJam>& jams = a.every_step.at(stream).jams;
  const double begin = a.frames.front().time, end = a.frames.back().time;
  const jam::JamStatistics s = jam::jam_statistics(jams, begin, end);
  Run run;
  run.record = end - begin;
  run.lifetimes = jam::lifetimes_of(jams);
  run.began = run.lifetimes.size();
  run.work = 0;
  for (const jam::StepJam& j : jams) {
    run.peaks.push_back(j.peak_force);
    run.work += j.work;
  }
  run.rate = s.rate;
  run.median = s.median;
  run.jammed_share = s.jammed_time / run.record;
  run.longest = s.longest;
  run.fano = s.fano;
  run.independent = s.independence.p;
  return run;
}

// Rates corrected for the jams that no frame saw, if durations are exponential.
Run of_frames(const jam::Analysis& a) {
  Run run;
  run.record = a.observed_time;
  run.longest = 0;
  std::vector<double> starts;
  for (const jam::JamEvent& e : a.events) {
    if (!e.open_at_start) {
      run.lifetimes.push_back({e.survival_time, !e.open_at_end});
      starts.push_back(e.start);
    }
    run.peaks.push_back(e.peak_force);
    run.longest = std::max(run.longest, e.survival_time);
  }
  run.began = run.lifetimes.size();
  run.rate = a.corrected.rate;
  run.median = jam::when_left(jam::kaplan_meier(run.lifetimes));
  run.jammed_share = a.jammed_time / a.observed_time;
  if (!a.frames.empty()) run.fano = jam::fano_factor(starts, a.frames.front().time, a.frames.back().time, 20);
  run.independent = jam::exponential_distances(starts).p;
  return run;
}

Run read_run(const std::string& path, const CompareOptions& options) {
  const std::filesystem::path file = std::filesystem::is_directory(path) ? std::filesystem::path(path) / "jam.h5" : std::filesystem::path(path);
  const jam::Analysis a = jam::read_results(file);
  if (a.frames.size() < 2) throw jam::DataError(file.string() + ": fewer than two frames, expected a record of some time");
  if (options.by == CompareBy::step && a.every_step.empty())
    throw jam::DataError(file.string() + ": holds no jams of every step, expected them; --by frame compares those of frames");
  Run run = options.by == CompareBy::step ? of_steps(a, options) : of_frames(a);
  for (const jam::FrameSummary& frame : a.frames) {
    if (!std::isnan(frame.blade_force)) run.blade_force.push_back(frame.blade_force);
    if (!std::isnan(frame.blade_torque)) run.blade_torque.push_back(frame.blade_torque);
  }
  run.energy = a.flow_energy.total;
  run.name = path;
  while (run.name.size() > 1 && run.name.back() == '/') run.name.pop_back();
  return run;
}

double median_of(std::vector<double> values) {
  if (values.empty()) return nan;
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2;
}

// The rows of the table.
struct Quantity {
  const char *name, *unit;
  double scale;
  jam::Rate (*of)(const Run&);  // value and, where there is one, its 95 % interval
};
jam::Rate alone(double value) { return {value, nan, nan}; }
constexpr Quantity quantities[] = {
    {"record", "s", 1, [](const Run& r) { return alone(r.record); }},
    {"jams", "1", 1, [](const Run& r) { return alone(double(r.peaks.size())); }},
    {"rate", "1/s", 1, [](const Run& r) { return r.rate; }},
    {"half end within", "ms", 1e3, [](const Run& r) { return jam::Rate{r.median.value, r.median.low, r.median.high}; }},
    {"longest", "ms", 1e3, [](const Run& r) { return alone(r.longest); }},
    {"jammed time over record", "%", 1e2, [](const Run& r) { return alone(r.jammed_share); }},
    {"largest force", "N", 1, [](const Run& r) { return alone(r.peaks.empty() ? nan : *std::max_element(r.peaks.begin(), r.peaks.end())); }},
    {"median of peak forces", "N", 1, [](const Run& r) { return alone(median_of(r.peaks)); }},
    {"work of walls on jammed grains", "mJ", 1e3, [](const Run& r) { return alone(r.work); }},
    {"Fano factor of counts", "1", 1, [](const Run& r) { return alone(r.fano); }},
    {"independent starts, p", "1", 1, [](const Run& r) { return alone(r.independent); }},
};

std::string cell(const jam::Rate& value, double scale) {
  const auto number = [&](double x) { return std::isnan(x) ? std::string("-") : std::isinf(x) ? std::string("not reached") : fmt::format("{:.4g}", scale * x); };
  if ((std::isnan(value.low) && std::isnan(value.high)) || std::isinf(value.low)) return number(value.value);
  return fmt::format("{} ({} to {})", number(value.value), number(value.low), number(value.high));
}

struct Pair {
  double rate = 1;
  jam::TestResult durations;
};
Pair between(const Run& a, const Run& b) {
  const std::vector<std::vector<jam::Lifetime>> groups{a.lifetimes, b.lifetimes};
  return {jam::same_rate_probability(a.began, a.record, b.began, b.record), jam::log_rank(groups)};
}

std::string text(const std::vector<Run>& runs) {
  std::vector<std::vector<std::string>> columns(runs.size() + 1);
  columns[0].emplace_back();
  for (const Quantity& q : quantities) columns[0].push_back(std::string(q.unit) == "1" ? q.name : fmt::format("{}, {}", q.name, q.unit));
  for (std::size_t r = 0; r < runs.size(); ++r) {
    columns[r + 1].push_back(runs[r].name);
    for (const Quantity& q : quantities) columns[r + 1].push_back(cell(q.of(runs[r]), q.scale));
  }
  std::string out;
  for (std::size_t row = 0; row < columns[0].size(); ++row) {
    std::string line;
    for (const std::vector<std::string>& column : columns) {
      std::size_t width = 0;
      for (const std::string& c : column) width = std::max(width, c.size());
      line += fmt::format("{:<{}}  ", column[row], width);
    }
    out += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  out += "\nValues in brackets hold the truth in 95 of 100 records.\n";
  for (std::size_t r = 1; r < runs.size(); ++r) {
    const Pair pair = between(runs[0], runs[r]);
    out += fmt::format("{} and {}: were the rates equal, such counts would come with p = {:.3g}; such durations (log-rank) with p = {:.3g}\n", runs[0].name,
                       runs[r].name, pair.rate, pair.durations.p);
  }
  return out;
}

Json or_null(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

std::string json_text(const std::vector<Run>& runs, const jam::BlockMean& mean) {
  Json json;
  for (const Run& run : runs) {
    Json row{{"run", run.name}};
    for (const Quantity& q : quantities) {
      const jam::Rate v = q.of(run);
      row["quantities"][q.name] = {{"unit", q.unit}, {"value", or_null(q.scale * v.value)}, {"low", or_null(q.scale * v.low)}, {"high", or_null(q.scale * v.high)}};
    }
    json["runs"].push_back(row);
  }
  json["tests"] = Json::array();
  for (std::size_t r = 1; r < runs.size(); ++r) {
    const Pair pair = between(runs[0], runs[r]);
    json["tests"].push_back({{"runs", {runs[0].name, runs[r].name}}, {"same_rate_p", pair.rate}, {"log_rank_p", pair.durations.p}, {"log_rank_chi2", pair.durations.statistic}});
  }
  json["mean_rate"] = {{"unit", "1/s"}, {"value", or_null(mean.value)}, {"low", or_null(mean.low)}, {"high", or_null(mean.high)}};
  return json.dump(2) + "\n";
}

// What groups of runs are compared by: shares of the records, and distributions of values.
struct SharedQuantity {
  const char *name, *unit;
  double scale;
  jam::RunShare (*of)(const Run&);
};
constexpr SharedQuantity shared_quantities[] = {
    {"rate of jams", "1/s", 1, [](const Run& r) { return jam::RunShare{double(r.began), r.record}; }},
    {"jammed time over record", "%", 1e2, [](const Run& r) { return jam::RunShare{r.jammed_share * r.record, r.record}; }},
    {"largest force, mean of the runs", "N", 1, [](const Run& r) { return jam::RunShare{r.peaks.empty() ? 0 : *std::max_element(r.peaks.begin(), r.peaks.end()), 1}; }},
    {"power of the blade", "mW", 1e3, [](const Run& r) { return jam::RunShare{r.energy, r.record}; }},
};
struct DistributedQuantity {
  const char *name, *unit;
  double scale;
  std::vector<double> (*of)(const Run&);
};
// s, those that the record cuts off as far as it goes.
std::vector<double> durations(const Run& run) {
  std::vector<double> all;
  for (const jam::Lifetime& life : run.lifetimes) all.push_back(life.time);
  return all;
}
constexpr DistributedQuantity distributed_quantities[] = {
    {"durations of jams, median", "ms", 1e3, durations},
    {"peak forces of jams, median", "N", 1, [](const Run& r) { return r.peaks; }},
    {"torque of the blade at frames, median", "mN m", 1e3, [](const Run& r) { return r.blade_torque; }},
    {"force of the blade at frames, median", "N", 1, [](const Run& r) { return r.blade_force; }},
};

struct GroupRow {
  std::string name, unit;
  double first, second, distance, p, seen;  // distance of the distributions, NaN where it is a share
};
std::vector<GroupRow> compare_groups(const std::vector<Run>& first, const std::vector<Run>& second, jam::Dealt dealt) {
  std::vector<GroupRow> rows;
  for (const SharedQuantity& q : shared_quantities) {
    const auto shares = [&](const std::vector<Run>& runs) {
      std::vector<jam::RunShare> all;
      for (const Run& run : runs) all.push_back(q.of(run));
      return all;
    };
    const auto value = [&](const std::vector<jam::RunShare>& all) {
      double amount = 0, over = 0;
      for (const jam::RunShare& run : all) amount += run.amount, over += run.over;
      return q.scale * amount / over;
    };
    const std::vector<jam::RunShare> a = shares(first), b = shares(second);
    rows.push_back({q.name, q.unit, value(a), value(b), nan, jam::same_share(a, b, dealt).p, jam::seen_factor(a, b, dealt)});
  }
  for (const DistributedQuantity& q : distributed_quantities) {
    const auto values = [&](const std::vector<Run>& runs) {
      std::vector<std::vector<double>> all;
      for (const Run& run : runs) all.push_back(q.of(run));
      return all;
    };
    const auto median = [&](const std::vector<std::vector<double>>& all) {
      std::vector<double> pooled;
      for (const std::vector<double>& run : all) pooled.insert(pooled.end(), run.begin(), run.end());
      return q.scale * median_of(pooled);
    };
    const std::vector<std::vector<double>> a = values(first), b = values(second);
    const jam::GroupTest test = jam::same_distribution(a, b, dealt);
    rows.push_back({q.name, q.unit, median(a), median(b), test.difference, test.p, jam::seen_factor(a, b, dealt)});
  }
  return rows;
}

std::string group_text(const std::vector<Run>& first, const std::vector<Run>& second, jam::Dealt dealt) {
  std::string out;
  for (const auto* group : {&first, &second}) {
    std::size_t jams = 0;
    double record = 0;
    std::vector<std::string> names;
    for (const Run& run : *group) jams += run.began, record += run.record, names.push_back(run.name);
    out += fmt::format("{}: {} runs, {:.4g} s, {} jams: {}\n", group == &first ? "first" : "second", names.size(), record, jams, fmt::join(names, " "));
  }
  const auto number = [](double x) { return std::isnan(x) ? std::string("-") : fmt::format("{:.4g}", x); };
  out += fmt::format("\n{:<45}  {:>9}  {:>9}  {:>8}  {:>7}  {:>11}\n", "", "first", "second", "distance", "p", "seen from x");
  for (const GroupRow& row : compare_groups(first, second, dealt))
    out += fmt::format("{:<45}  {:>9}  {:>9}  {:>8}  {:>7.3g}  {:>11}\n", row.name + ", " + row.unit, number(row.first), number(row.second), number(row.distance),
                       row.p, number(row.seen));
  const bool paired = dealt == jam::Dealt::within_pairs;
  out += fmt::format("\np: so often {} differ by as much, in the value or by the distance of the distributions (Kolmogorov, Smirnov).\n"
                     "seen from x: were all values of one group larger by this factor, 80 of 100 such comparisons would give p < 0.05.\n",
                     paired ? "groups in which the runs of pairs, the first with the first and so on, are swapped at random" : "runs dealt out to the groups at random");
  if (paired && first.size() < 6)
    out += fmt::format("{} pairs are few: with six p can be as low as 0.031.\n", first.size());
  else if (!paired && (first.size() < 4 || second.size() < 4))
    out += fmt::format("{} runs against {} are few: with four against four p can be as low as 0.029.\n", first.size(), second.size());
  return out;
}

std::string group_json(const std::vector<Run>& first, const std::vector<Run>& second, jam::Dealt dealt) {
  Json json{{"paired", dealt == jam::Dealt::within_pairs}};
  for (const auto* group : {&first, &second}) {
    Json runs = Json::array();
    for (const Run& run : *group) runs.push_back({{"run", run.name}, {"record_s", run.record}, {"jams", run.began}});
    json["groups"].push_back(runs);
  }
  for (const GroupRow& row : compare_groups(first, second, dealt))
    json["quantities"][row.name] = {{"unit", row.unit},          {"first", or_null(row.first)}, {"second", or_null(row.second)}, {"distance", or_null(row.distance)},
                                    {"p", or_null(row.p)}, {"seen_factor", or_null(row.seen)}};
  return json.dump(2) + "\n";
}

std::vector<Run> read_runs(const std::vector<std::string>& paths, const CompareOptions& options) {
  std::vector<Run> runs;
  for (const std::string& path : paths) runs.push_back(read_run(path, options));
  return runs;
}

}  // namespace

int compare(const CompareOptions& options) {
  if (std::find(std::begin(jam::jam_stream_names), std::end(jam::jam_stream_names), options.stream) == std::end(jam::jam_stream_names))
    throw UsageError(fmt::format("--stream {}: expected global, particle or site", options.stream));
  if (options.paired && options.runs.size() != options.against.size())
    throw UsageError(fmt::format("--paired: {} runs against {}, expected as many, each at the place of the run with the same bed", options.runs.size(),
                                 options.against.size()));
  const std::vector<Run> runs = read_runs(options.runs, options);
  if (!options.against.empty()) {
    const std::vector<Run> against = read_runs(options.against, options);
    const jam::Dealt dealt = options.paired ? jam::Dealt::within_pairs : jam::Dealt::among_all;
    fmt::print("{}", options.json ? group_json(runs, against, dealt) : group_text(runs, against, dealt));
    return 0;
  }
  std::vector<double> rates;
  std::vector<std::vector<jam::Lifetime>> groups;
  for (const Run& run : runs) {
    rates.push_back(double(run.began) / run.record);
    groups.push_back(run.lifetimes);
  }
  const jam::BlockMean mean = jam::bootstrap_mean(rates);
  if (options.json) {
    fmt::print("{}", json_text(runs, mean));
    return 0;
  }
  fmt::print("{}", text(runs));
  if (runs.size() > 2) {
    const jam::TestResult all = jam::log_rank(groups);
    fmt::print("all {} runs: mean of the rates {:.4g} 1/s (95 %, runs drawn anew: {:.4g} to {:.4g}); equal durations (log-rank) p = {:.3g}\n", runs.size(),
               mean.value, mean.low, mean.high, all.p);
  }
  return 0;
}

}  // namespace jamscope
