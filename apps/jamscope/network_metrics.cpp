#include "apps/jamscope/network_metrics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "apps/jamscope/console.hpp"
#include "apps/jamscope/errors.hpp"
#include "apps/jamscope/frames_in_flight.hpp"
#include "libjam/metrics/metrics.hpp"

namespace jamscope {
namespace {

// The rows of a table with the names asked for; of none those of low cost, or all.
template <class Row>
std::vector<Row> chosen_metrics(std::span<const Row> table, const MetricsOptions& options) {
  std::vector<Row> chosen;
  if (options.names.empty())
    std::copy_if(table.begin(), table.end(), std::back_inserter(chosen),
                 [&](const Row& r) { return options.all || r.cost == jam::Cost::low; });
  for (const std::string& name : options.names) chosen.push_back(metric_named(table, name));
  return chosen;
}

// Prints rows of named columns as CSV at once, or as JSON at the end.
class Table {
 public:
  // `columns` as (name in JSON, heading in CSV); but for the time, the first `whole` of them hold whole numbers.
  Table(TableFormat format, std::size_t whole, std::vector<std::pair<std::string, std::string>> columns)
      : format_(format), whole_(whole), columns_(std::move(columns)), undefined_(columns_.size(), 0) {
    if (format_ == TableFormat::json) return;
    for (std::size_t k = 0; k < columns_.size(); ++k) fmt::print("{}{}", k == 0 ? "" : ",", columns_[k].second);
    fmt::print("\n");
  }
  void row(std::span<const double> values) {
    ++count_;
    for (std::size_t k = 0; k < values.size(); ++k) undefined_[k] += std::isnan(values[k]);
    if (format_ == TableFormat::csv) {
      for (std::size_t k = 0; k < values.size(); ++k) fmt::print("{}{}", k == 0 ? "" : ",", values[k]);
      fmt::print("\n");
      return;
    }
    nlohmann::ordered_json row;
    for (std::size_t k = 0; k < values.size(); ++k) {
      nlohmann::ordered_json& cell = row[columns_[k].first];
      if (!std::isfinite(values[k])) {
        cell = nullptr;
      } else if (k < whole_ && columns_[k].first != "time_s") {
        cell = std::int64_t(values[k]);
      } else {
        cell = values[k];
      }
    }
    rows_.push_back(std::move(row));
  }
  void finish() const {
    if (format_ == TableFormat::json) fmt::print("{}\n", rows_.dump(2));
  }
  // For each column in how many rows it is not a number, and how many rows there are.
  const std::vector<std::size_t>& undefined() const { return undefined_; }
  std::size_t rows() const { return count_; }

 private:
  TableFormat format_;
  std::size_t whole_;
  std::vector<std::pair<std::string, std::string>> columns_;
  std::vector<std::size_t> undefined_;
  std::size_t count_ = 0;
  nlohmann::ordered_json rows_ = nlohmann::ordered_json::array();
};

template <class Row>
std::vector<std::pair<std::string, std::string>> columns(const std::vector<std::string>& ids, const std::vector<Row>& metrics) {
  std::vector<std::pair<std::string, std::string>> all{{"frame", "frame"}, {"time_s", "time [s]"}};
  for (const std::string& id : ids) all.emplace_back(id, id);
  for (const Row& metric : metrics) all.emplace_back(metric.name, fmt::format("{} [{}]", metric.name, metric.unit));
  return all;
}

// Says of which rows a metric has no value, and why.
template <class Row>
void note_undefined(const MetricsOptions& options, const Table& table, std::size_t first_column, const std::vector<Row>& metrics) {
  Console console(stderr, LogFormat::text, options.quiet);
  for (std::size_t k = 0; k < metrics.size(); ++k)
    if (const std::size_t count = table.undefined()[first_column + k]; count > 0)
      console.note(fmt::format("{} has no value in {} of {} rows: {}", metrics[k].name, count, table.rows(), metrics[k].undefined));
}

// The network of a frame, which refers to it.
struct Frame {
  jam::ContactGraph graph;
  jam::FrameNetwork network;
  Frame(const jam::Snapshot& snapshot, const jam::RunInfo& run) : graph(snapshot, run.walls), network(graph, run) {}
  Frame(const Frame&) = delete;
};

using Rows = std::vector<std::vector<double>>;

// Prints rows_of(frame number, snapshot before it or null, snapshot) of each frame asked for, in order.
template <class RowsOf>
void print_frames(const MetricsOptions& options, const jam::SnapshotSource& source, bool with_before, Table& table, RowsOf rows_of) {
  const std::size_t first = options.frame.value_or(0), last = options.frame ? first + 1 : source.frames;
  Console console(stderr, LogFormat::text, options.quiet);
  Progress progress;
  progress.stage = "metrics";
  progress.unit = "frames";
  progress.total = double(last - first);
  for_frames_in_flight(source, first, last, options.threads, with_before, rows_of, [&](const Rows& rows) {
    for (const std::vector<double>& row : rows) table.row(row);
    progress.done += 1;
    console.progress(progress);
  });
  table.finish();
}

void print_metrics(const MetricsOptions& options, const jam::SnapshotSource& source, const std::vector<jam::Metric>& metrics) {
  Table table(options.format, 2, columns({}, metrics));
  print_frames(options, source, false, table, [&](std::size_t number, const jam::Snapshot*, const jam::Snapshot& snapshot) -> Rows {
    Frame frame(snapshot, source.info);
    std::vector<double> row{double(number), snapshot.time};
    for (const jam::Metric& metric : metrics) row.push_back(metric.value(frame.network));
    return {row};
  });
  note_undefined(options, table, 2, metrics);
}

void print_changes(const MetricsOptions& options, const jam::SnapshotSource& source, const std::vector<jam::ChangeMetric>& metrics) {
  Table table(options.format, 2, columns({}, metrics));
  print_frames(options, source, true, table, [&](std::size_t number, const jam::Snapshot* before, const jam::Snapshot& now) -> Rows {
    if (before == nullptr) return {};
    Frame first(*before, source.info), second(now, source.info);
    std::vector<double> row{double(number), now.time};
    for (const jam::ChangeMetric& metric : metrics) row.push_back(metric.value(first.network, second.network));
    return {row};
  });
  note_undefined(options, table, 2, metrics);
}

// One row for each of `count(snapshot)`, with `ids(snapshot, row)` before its metrics.
template <class Row, class Count, class Ids>
void print_parts(const MetricsOptions& options, const jam::SnapshotSource& source, const std::vector<Row>& metrics,
                 const std::vector<std::string>& id_names, Count count, Ids ids) {
  Table table(options.format, 2 + id_names.size(), columns(id_names, metrics));
  print_frames(options, source, false, table, [&](std::size_t number, const jam::Snapshot*, const jam::Snapshot& snapshot) {
    Frame frame(snapshot, source.info);
    std::vector<std::vector<double>> values;
    for (const Row& metric : metrics) values.push_back(metric.value(frame.network));
    Rows rows(count(snapshot));
    for (std::size_t k = 0; k < rows.size(); ++k) {
      rows[k] = {double(number), snapshot.time};
      for (const double id : ids(snapshot, k)) rows[k].push_back(id);
      for (const std::vector<double>& value : values) rows[k].push_back(value[k]);
    }
    return rows;
  });
  note_undefined(options, table, 2 + id_names.size(), metrics);
}

template <class Row>
std::string list(const char* title, std::span<const Row> table) {
  std::string text = fmt::format("{}:\n", title);
  for (const Row& metric : table)
    text += fmt::format("  {:<30}{}[{}] {}\n", metric.name, metric.cost == jam::Cost::high ? '*' : ' ', metric.unit, metric.doc);
  return text;
}

}  // namespace

std::string metric_list() {
  return "Those with * take long, some of them minutes for 35,000 particles; by name or with --all.\n" +
         list("Metrics of frames", jam::metrics()) +
         list("Metrics of the change from the frame before (--of changes)", jam::change_metrics()) +
         list("Metrics of particles (--of particles)", jam::particle_metrics()) +
         list("Metrics of contacts between particles (--of contacts)", jam::contact_metrics());
}

int network_metrics(const MetricsOptions& options) {
  // Names are checked before a file is opened.
  std::vector<jam::Metric> of_frames;
  std::vector<jam::ChangeMetric> of_changes;
  std::vector<jam::ParticleMetric> of_particles;
  std::vector<jam::ContactMetric> of_contacts;
  switch (options.of) {
    case MetricsOf::frames: of_frames = chosen_metrics(jam::metrics(), options); break;
    case MetricsOf::changes: of_changes = chosen_metrics(jam::change_metrics(), options); break;
    case MetricsOf::particles: of_particles = chosen_metrics(jam::particle_metrics(), options); break;
    case MetricsOf::contacts: of_contacts = chosen_metrics(jam::contact_metrics(), options); break;
  }
  const jam::SnapshotSource source = open_stored_run(options.input);
  if (options.frame && *options.frame >= source.frames)
    throw UsageError(fmt::format("there is no frame {}: the data have frames 0 to {}", *options.frame,
                                 source.frames == 0 ? "none" : std::to_string(source.frames - 1)));
  switch (options.of) {
    case MetricsOf::frames: print_metrics(options, source, of_frames); break;
    case MetricsOf::changes: print_changes(options, source, of_changes); break;
    case MetricsOf::particles:
      print_parts(
          options, source, of_particles, {"id"}, [](const jam::Snapshot& s) { return s.particles.size(); },
          [](const jam::Snapshot& s, std::size_t k) { return std::array{double(s.particles.id[k])}; });
      break;
    case MetricsOf::contacts:
      print_parts(
          options, source, of_contacts, {"id_1", "id_2"}, [](const jam::Snapshot& s) { return s.pp.size(); },
          [](const jam::Snapshot& s, std::size_t k) {
            return std::array{double(s.particles.id[s.pp.row[k][0]]), double(s.particles.id[s.pp.row[k][1]])};
          });
      break;
  }
  return 0;
}

}  // namespace jamscope
