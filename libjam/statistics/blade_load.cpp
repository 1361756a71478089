#include "libjam/statistics/blade_load.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace jam {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double largest(std::span<const double> values) { return values.empty() ? nan : *std::max_element(values.begin(), values.end()); }

double median(std::span<const double> values) {
  if (values.empty()) return nan;
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const std::size_t half = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
}

// Magnitudes of the means of whole groups of `rows` values next to each other.
std::vector<double> averaged(std::span<const double> values, std::size_t rows) {
  std::vector<double> means;
  for (std::size_t k = 0; k + rows <= values.size(); k += rows) {
    double sum = 0;
    for (const double value : values.subspan(k, rows)) sum += value;
    means.push_back(std::abs(sum / double(rows)));
  }
  return means;
}

// `mean`: of each window, with its sign; `least`, `most`: over its steps, or empty; `at_frames`: magnitudes; `peak`: windows left out of the medians.
LoadPeaks peaks_of(std::span<const double> mean, std::span<const double> least, std::span<const double> most, std::span<const double> at_frames,
                   const std::vector<bool>& peak, std::size_t rows_of_filter, std::size_t rows_of_block) {
  LoadPeaks peaks;
  std::vector<double> magnitude;
  for (const double value : mean) magnitude.push_back(std::abs(value));
  peaks.windows = largest(magnitude);
  peaks.median = median(magnitude);
  peaks.every_step = nan;
  if (!least.empty()) {
    peaks.every_step = 0;
    for (std::size_t k = 0; k < mean.size(); ++k) peaks.every_step = std::max({peaks.every_step, std::abs(least[k]), std::abs(most[k])});
  }
  peaks.frames = largest(at_frames);
  const std::vector<double> slow = averaged(mean, rows_of_filter);
  peaks.filtered = largest(slow);
  peaks.trend = kendall_tau(slow);
  for (std::size_t begin = 0; begin + rows_of_block <= magnitude.size(); begin += rows_of_block) {
    std::vector<double> rest;
    for (std::size_t k = begin; k < begin + rows_of_block; ++k)
      if (!peak[k]) rest.push_back(magnitude[k]);
    peaks.medians.push_back(median(rest));
  }
  return peaks;
}

std::vector<double> vertical(const std::vector<Vec3>& column) {
  std::vector<double> values;
  for (const Vec3& v : column) values.push_back(v.z());
  return values;
}

}  // namespace

BladeLoad blade_load(const Series& series, const std::vector<Wall>& walls, std::span<const FrameLoad> frames, double peaks_above) {
  const auto blade = std::find_if(walls.begin(), walls.end(), [](const Wall& w) { return w.role == WallRole::blade; });
  const std::size_t w = std::size_t(blade - walls.begin());
  BladeLoad load;
  const LoadPeaks unknown{nan, nan, nan, nan, nan, nan, {}};
  if (blade == walls.end() || series.size() == 0 || w >= series.walls.size() || series.walls[w].force.size() != series.size()) return {unknown, unknown};
  const Series::WallSeries& s = series.walls[w];
  const double window = series.size() > 1 ? (series.time.back() - series.time.front()) / double(series.size() - 1) : series.time.back();
  const auto rows = [&](double time) { return std::size_t(std::max(1.0, std::round(time / window))); };
  const std::size_t of_filter = rows(BladeLoad::filter), of_block = rows(BladeLoad::block);
  std::vector<double> force_at, torque_at;
  for (const FrameLoad& frame : frames) {
    force_at.push_back(std::abs(frame.force));
    torque_at.push_back(std::abs(frame.torque));
  }
  std::vector<bool> peak(series.size(), false);
  if (present(series.largest_compressive_force, series.size()))
    for (std::size_t k = 0; k < series.size(); ++k) peak[k] = double{series.largest_compressive_force[k]} > peaks_above;
  load.force = peaks_of(vertical(s.force), vertical(s.force_min), vertical(s.force_max), force_at, peak, of_filter, of_block);
  load.torque = peaks_of(vertical(s.torque), vertical(s.torque_min), vertical(s.torque_max), torque_at, peak, of_filter, of_block);
  return load;
}

double kendall_tau(std::span<const double> values) {
  if (values.size() < 2) return nan;
  double sum = 0;
  for (std::size_t a = 0; a < values.size(); ++a)
    for (std::size_t b = a + 1; b < values.size(); ++b) sum += double(values[b] > values[a]) - double(values[b] < values[a]);
  return sum / (0.5 * double(values.size()) * double(values.size() - 1));
}

PowerLaw power_law(std::span<const double> time, std::span<const double> energy, std::size_t points) {
  if (time.size() < 2 || points < 2) return {nan, nan};
  const double end = time.back(), begin = std::max(0.05 * end, time.front());
  double x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  for (std::size_t k = 0; k < points; ++k) {
    const double t = begin * std::pow(end / begin, double(k) / double(points - 1));
    const auto after = std::clamp(std::lower_bound(time.begin(), time.end(), t), time.begin() + 1, time.end() - 1);
    const auto i = std::size_t(after - time.begin());
    const double e = energy[i - 1] + (energy[i] - energy[i - 1]) * (t - time[i - 1]) / (time[i] - time[i - 1]);
    if (!(e > 0)) return {nan, nan};
    const double a = std::log(t), b = std::log(e);
    x += a, y += b, xx += a * a, xy += a * b, yy += b * b;
  }
  const double n = double(points), sxx = xx - x * x / n, sxy = xy - x * y / n, syy = yy - y * y / n;
  return {sxy / sxx, sxy * sxy / (sxx * syy)};
}

}  // namespace jam
