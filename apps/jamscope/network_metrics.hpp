// jamscope metrics: network metrics of frames, changes between frames, particles or contacts, as a table.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "apps/jamscope/stored_run.hpp"

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

// One line per metric of each table: name, unit, what it is. For the help text.
std::string metric_list();

}  // namespace jamscope
