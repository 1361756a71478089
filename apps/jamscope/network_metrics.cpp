#include "apps/jamscope/network_metrics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "apps/jamscope/errors.hpp"
#include "apps/jamscope/toml_reader.hpp"
#include "libjam/metrics/metrics.hpp"

namespace jamscope {
namespace {

// The rows of a table with these names; all for none.
template <class Row>
std::vector<Row> chosen_metrics(std::span<const Row> table, const std::vector<std::string>& names) {
  if (names.empty()) return {table.begin(), table.end()};
  std::vector<Row> chosen;
  for (const std::string& name : names) {
    const auto row = std::find_if(table.begin(), table.end(), [&](const Row& r) { return r.name == name; });
    if (row == table.end()) {
      std::vector<std::string> known;
      for (const Row& r : table) known.emplace_back(r.name);
      throw UsageError(fmt::format("unknown metric '{}'{}", name, suggestion(name, known)));
    }
    chosen.push_back(*row);
  }
  return chosen;
}

// Prints rows of named columns as CSV at once, or as JSON at the end.
class Table {
 public:
  // `columns` as (name in JSON, heading in CSV); but for the time, the first `whole` of them hold whole numbers.
  Table(TableFormat format, std::size_t whole, std::vector<std::pair<std::string, std::string>> columns)
      : format_(format), whole_(whole), columns_(std::move(columns)) {
    if (format_ == TableFormat::json) return;
    for (std::size_t k = 0; k < columns_.size(); ++k) fmt::print("{}{}", k == 0 ? "" : ",", columns_[k].second);
    fmt::print("\n");
  }
  void row(std::span<const double> values) {
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

 private:
  TableFormat format_;
  std::size_t whole_;
  std::vector<std::pair<std::string, std::string>> columns_;
  nlohmann::ordered_json rows_ = nlohmann::ordered_json::array();
};

template <class Row>
std::vector<std::pair<std::string, std::string>> columns(const std::vector<std::string>& ids, const std::vector<Row>& metrics) {
  std::vector<std::pair<std::string, std::string>> all{{"frame", "frame"}, {"time_s", "time [s]"}};
  for (const std::string& id : ids) all.emplace_back(id, id);
  for (const Row& metric : metrics) all.emplace_back(metric.name, fmt::format("{} [{}]", metric.name, metric.unit));
  return all;
}

// For each frame asked for: f(frame, its network).
template <class F>
void for_each_frame(const MetricsOptions& options, const jam::SnapshotSource& source, F f) {
  const std::size_t first = options.frame.value_or(0), last = options.frame ? first + 1 : source.frames;
  for (std::size_t frame = first; frame < last; ++frame) {
    const jam::Snapshot snapshot = source.read(frame);
    const jam::ContactGraph graph(snapshot, source.info.walls);
    jam::FrameNetwork network(graph);
    f(frame, network);
  }
}

void print_frames(const MetricsOptions& options, const jam::SnapshotSource& source, const std::vector<jam::Metric>& metrics) {
  Table table(options.format, 2, columns({}, metrics));
  for_each_frame(options, source, [&](std::size_t frame, jam::FrameNetwork& network) {
    std::vector<double> row{double(frame), network.graph.snapshot().time};
    for (const jam::Metric& metric : metrics) row.push_back(metric.value(network));
    table.row(row);
  });
  table.finish();
}

// One row for each of `rows(snapshot)`, with `ids(snapshot, row)` before its metrics.
template <class Row, class Rows, class Ids>
void print_parts(const MetricsOptions& options, const jam::SnapshotSource& source, const std::vector<Row>& metrics,
                 const std::vector<std::string>& id_names, Rows rows, Ids ids) {
  Table table(options.format, 2 + id_names.size(), columns(id_names, metrics));
  for_each_frame(options, source, [&](std::size_t frame, jam::FrameNetwork& network) {
    const jam::Snapshot& snapshot = network.graph.snapshot();
    std::vector<std::vector<double>> values;
    for (const Row& metric : metrics) values.push_back(metric.value(network));
    for (std::size_t k = 0; k < rows(snapshot); ++k) {
      std::vector<double> row{double(frame), snapshot.time};
      for (const double id : ids(snapshot, k)) row.push_back(id);
      for (const std::vector<double>& value : values) row.push_back(value[k]);
      table.row(row);
    }
  });
  table.finish();
}

template <class Row>
std::string list(const char* title, std::span<const Row> table) {
  std::string text = fmt::format("{}:\n", title);
  for (const Row& metric : table) text += fmt::format("  {:<29}[{}] {}\n", metric.name, metric.unit, metric.doc);
  return text;
}

}  // namespace

std::string metric_list() {
  return list("Metrics of frames", jam::metrics()) + list("Metrics of particles (--of particles)", jam::particle_metrics()) +
         list("Metrics of contacts between particles (--of contacts)", jam::contact_metrics());
}

int network_metrics(const MetricsOptions& options) {
  // Names are checked before a file is opened.
  const bool frames = options.of == MetricsOf::frames, particles = options.of == MetricsOf::particles;
  const auto of_frames = chosen_metrics(jam::metrics(), frames ? options.names : std::vector<std::string>{});
  const auto of_particles = chosen_metrics(jam::particle_metrics(), particles ? options.names : std::vector<std::string>{});
  const auto of_contacts = chosen_metrics(jam::contact_metrics(), frames || particles ? std::vector<std::string>{} : options.names);
  const jam::SnapshotSource source = open_stored_run(options.input);
  if (options.frame && *options.frame >= source.frames)
    throw UsageError(fmt::format("there is no frame {}: the data have frames 0 to {}", *options.frame,
                                 source.frames == 0 ? "none" : std::to_string(source.frames - 1)));
  if (frames) {
    print_frames(options, source, of_frames);
  } else if (particles) {
    print_parts(
        options, source, of_particles, {"id"}, [](const jam::Snapshot& s) { return s.particles.size(); },
        [](const jam::Snapshot& s, std::size_t k) { return std::array{double(s.particles.id[k])}; });
  } else {
    print_parts(
        options, source, of_contacts, {"id_1", "id_2"}, [](const jam::Snapshot& s) { return s.pp.size(); },
        [](const jam::Snapshot& s, std::size_t k) {
          return std::array{double(s.particles.id[s.pp.row[k][0]]), double(s.particles.id[s.pp.row[k][1]])};
        });
  }
  return 0;
}

}  // namespace jamscope
