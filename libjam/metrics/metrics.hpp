// The tables of network metrics: one number per frame, per particle and per contact of two particles.
#pragma once
#include <span>
#include <string_view>
#include <vector>

#include "libjam/metrics/frame_network.hpp"

namespace jam {

template <class Value>
struct MetricRow {
  std::string_view name;  // as typed after --metric, snake_case
  std::string_view unit;  // "1" for pure numbers
  std::string_view doc;   // one line
  Value (*value)(FrameNetwork&);
};
using Metric = MetricRow<double>;
using ParticleMetric = MetricRow<std::vector<double>>;  // [N] by the rows of the snapshot
struct ContactMetric : MetricRow<std::vector<double>> {};  // [C] by the rows of Snapshot::pp

// All metrics, in the order in which they are printed.
std::span<const Metric> metrics();
std::span<const ParticleMetric> particle_metrics();
std::span<const ContactMetric> contact_metrics();

// The row with this name, or nullptr.
const Metric* find_metric(std::string_view name);

}  // namespace jam
