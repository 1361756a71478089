// jamscope metrics: network metrics of frames, changes between frames, particles or contacts, as a table.
#pragma once
#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/jamscope/errors.hpp"
#include "apps/jamscope/stored_run.hpp"
#include "apps/jamscope/toml_reader.hpp"

namespace jamscope {

enum class TableFormat { csv, json };
enum class MetricsOf { frames, changes, particles, contacts };

struct MetricsOptions {
  InputOptions input;
  std::optional<std::size_t> frame;  // this one only; of changes the one from the frame before it
  MetricsOf of = MetricsOf::frames;
  std::vector<std::string> names;    // of that table in libjam/metrics/metrics.hpp; empty: those of low cost
  bool all = false;                  // without names: those of high cost too
  TableFormat format = TableFormat::csv;
  int threads = 1;                   // frames at a time; of a single frame, parts of it
  bool quiet = false;
};

// Prints to standard output: one row per frame, change, particle or contact, columns frame, time, ids and the metrics with their units.
// Throws UsageError for an unknown metric or frame, and like the libraries.
int network_metrics(const MetricsOptions& options);

// The row of a table of libjam/metrics/metrics.hpp with this name. Throws UsageError, with the nearest name.
template <class Row>
const Row& metric_named(std::span<const Row> table, const std::string& name) {
  const auto row = std::find_if(table.begin(), table.end(), [&](const Row& r) { return r.name == name; });
  if (row != table.end()) return *row;
  std::vector<std::string> known;
  for (const Row& r : table) known.emplace_back(r.name);
  throw UsageError("unknown metric '" + name + "'" + suggestion(name, known));
}

// One line per metric of each table: name, unit, what it is. For the help text.
std::string metric_list();

}  // namespace jamscope
