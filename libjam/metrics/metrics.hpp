// The table of network metrics: one number per frame.
#pragma once
#include <span>
#include <string_view>

#include "libjam/graph/contact_graph.hpp"

namespace jam {

struct Metric {
  std::string_view name;  // as typed after --metric, snake_case
  std::string_view unit;  // "1" for pure numbers
  std::string_view doc;   // one line
  double (*value)(const ContactGraph&);
};

// All metrics, in the order in which they are printed.
std::span<const Metric> metrics();

// The row with this name, or nullptr.
const Metric* find_metric(std::string_view name);

}  // namespace jam
