// jamscope metrics: network metrics per frame, as a table.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "apps/jamscope/stored_run.hpp"

namespace jamscope {

enum class TableFormat { csv, json };

struct MetricsOptions {
  InputOptions input;
  std::optional<std::size_t> frame;  // this one only
  std::vector<std::string> names;    // of libjam/metrics/metrics.hpp; empty: all
  TableFormat format = TableFormat::csv;
};

// Prints to standard output: one row per frame, columns frame, time and the metrics with their units.
// Throws UsageError for an unknown metric or frame, and like the libraries.
int network_metrics(const MetricsOptions& options);

// One line per metric: name, unit, what it is. For the help text.
std::string metric_list();

}  // namespace jamscope
