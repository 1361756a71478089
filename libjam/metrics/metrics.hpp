// The tables of network metrics: one number per frame, per change from one frame to a later one, per particle and per contact of two
// particles.
#pragma once
#include <span>
#include <string_view>
#include <vector>

#include "libjam/metrics/frame_network.hpp"

namespace jam {

// What a metric takes on a frame of 35,000 particles, together with what it shares with others.
enum class Cost {
  low,  // up to a tenth of a second: taken unless others are asked for
  high  // more, some of them minutes: asked for by name, or with all
};

template <class Value, class... Of>
struct MetricRow {
  std::string_view name;  // as typed after --metric, snake_case
  std::string_view unit;  // "1" for pure numbers
  std::string_view doc;   // one line
  Value (*value)(Of...);  // NaN where it is not defined
  Cost cost = Cost::low;
  std::string_view undefined = {};  // when that is; empty: never
};
using Metric = MetricRow<double, FrameNetwork&>;
using ChangeMetric = MetricRow<double, FrameNetwork&, FrameNetwork&>;     // from the first to the second
using ParticleMetric = MetricRow<std::vector<double>, FrameNetwork&>;     // [N] by the rows of the snapshot
struct ContactMetric : MetricRow<std::vector<double>, FrameNetwork&> {};  // [C] by the rows of Snapshot::pp

// All metrics, in the order in which they are printed.
std::span<const Metric> metrics();
std::span<const ChangeMetric> change_metrics();
std::span<const ParticleMetric> particle_metrics();
std::span<const ContactMetric> contact_metrics();

// The row with this name, or nullptr.
const Metric* find_metric(std::string_view name);

}  // namespace jam
