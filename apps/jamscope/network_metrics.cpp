#include "apps/jamscope/network_metrics.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/jamscope/errors.hpp"
#include "apps/jamscope/toml_reader.hpp"
#include "libjam/graph/contact_graph.hpp"
#include "libjam/metrics/metrics.hpp"

namespace jamscope {
namespace {

std::vector<const jam::Metric*> chosen_metrics(const std::vector<std::string>& names) {
  std::vector<const jam::Metric*> chosen;
  if (names.empty())
    for (const jam::Metric& metric : jam::metrics()) chosen.push_back(&metric);
  for (const std::string& name : names) {
    const jam::Metric* const metric = jam::find_metric(name);
    if (!metric) {
      std::vector<std::string> known;
      for (const jam::Metric& row : jam::metrics()) known.emplace_back(row.name);
      throw UsageError(fmt::format("unknown metric '{}'{}", name, suggestion(name, known)));
    }
    chosen.push_back(metric);
  }
  return chosen;
}

}  // namespace

std::string metric_list() {
  std::string text;
  for (const jam::Metric& metric : jam::metrics())
    text += fmt::format("  {:<26}[{}] {}\n", metric.name, metric.unit, metric.doc);
  return text;
}

int network_metrics(const MetricsOptions& options) {
  const std::vector<const jam::Metric*> metrics = chosen_metrics(options.names);
  const jam::SnapshotSource source = open_stored_run(options.input);
  if (options.frame && *options.frame >= source.frames)
    throw UsageError(fmt::format("there is no frame {}: the data have frames 0 to {}", *options.frame,
                                 source.frames == 0 ? "none" : std::to_string(source.frames - 1)));
  const std::size_t first = options.frame.value_or(0), last = options.frame ? first + 1 : source.frames;

  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  if (options.format == TableFormat::csv) {
    fmt::print("frame,time [s]");
    for (const jam::Metric* metric : metrics) fmt::print(",{} [{}]", metric->name, metric->unit);
    fmt::print("\n");
  }
  for (std::size_t frame = first; frame < last; ++frame) {
    const jam::Snapshot snapshot = source.read(frame);
    const jam::ContactGraph graph(snapshot, source.info.walls);
    nlohmann::ordered_json row{{"frame", frame}, {"time_s", snapshot.time}};
    if (options.format == TableFormat::csv) fmt::print("{},{}", frame, snapshot.time);
    for (const jam::Metric* metric : metrics) {
      const double value = metric->value(graph);
      if (options.format == TableFormat::csv)
        fmt::print(",{}", value);
      else if (std::isfinite(value))
        row[std::string(metric->name)] = value;
      else
        row[std::string(metric->name)] = nullptr;
    }
    if (options.format == TableFormat::csv)
      fmt::print("\n");
    else
      rows.push_back(row);
  }
  if (options.format == TableFormat::json) fmt::print("{}\n", rows.dump(2));
  return 0;
}

}  // namespace jamscope
