#include "libjam/statistics/lifetimes.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>

namespace jam {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

// Times at which something ends, ascending, each once.
std::vector<double> end_times(std::span<const Lifetime> lifetimes) {
  std::vector<double> times;
  for (const Lifetime& l : lifetimes)
    if (l.ended) times.push_back(l.time);
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

struct Counts {
  std::vector<std::size_t> at_risk, ended;  // at each of some times
};

Counts counts_at(std::span<const Lifetime> lifetimes, const std::vector<double>& times) {
  std::vector<double> entries, leaves, ends;
  for (const Lifetime& l : lifetimes) {
    if (!(l.entry < l.time)) continue;  // never seen
    entries.push_back(l.entry);
    leaves.push_back(l.time);
    if (l.ended) ends.push_back(l.time);
  }
  for (std::vector<double>* sorted : {&entries, &leaves, &ends}) std::sort(sorted->begin(), sorted->end());
  Counts counts;
  for (const double t : times) {
    const auto in = std::lower_bound(entries.begin(), entries.end(), t) - entries.begin();
    const auto out = std::lower_bound(leaves.begin(), leaves.end(), t) - leaves.begin();
    const auto here = std::equal_range(ends.begin(), ends.end(), t);
    counts.at_risk.push_back(std::size_t(in - out));
    counts.ended.push_back(std::size_t(here.second - here.first));
  }
  return counts;
}

double first_at_most(const std::vector<double>& time, const std::vector<double>& values, double share) {
  for (std::size_t k = 0; k < time.size(); ++k)
    if (values[k] <= share) return time[k];
  return infinity;
}

}  // namespace

SurvivalCurve kaplan_meier(std::span<const Lifetime> lifetimes, double confidence) {
  const double z = boost::math::quantile(boost::math::normal(), 0.5 + confidence / 2);
  SurvivalCurve curve;
  curve.time = end_times(lifetimes);
  Counts counts = counts_at(lifetimes, curve.time);
  double share = 1, variance = 0;  // variance: of log S
  for (std::size_t k = 0; k < curve.time.size(); ++k) {
    const double n = double(counts.at_risk[k]), d = double(counts.ended[k]);
    if (n > 0) share *= 1 - d / n;
    variance += d / (n * (n - d));
    curve.share.push_back(share);
    const double spread = z * std::sqrt(variance) / std::log(share);
    const bool known = share > 0 && share < 1;
    curve.low.push_back(known ? std::pow(share, std::exp(-spread)) : nan);
    curve.high.push_back(known ? std::pow(share, std::exp(spread)) : nan);
  }
  curve.at_risk = std::move(counts.at_risk);
  curve.ended = std::move(counts.ended);
  return curve;
}

Quantile when_left(const SurvivalCurve& curve, double share) {
  return {first_at_most(curve.time, curve.share, share), first_at_most(curve.time, curve.low, share),
          first_at_most(curve.time, curve.high, share)};
}

TestResult log_rank(std::span<const std::vector<Lifetime>> groups) {
  std::vector<Lifetime> all;
  for (const std::vector<Lifetime>& group : groups) all.insert(all.end(), group.begin(), group.end());
  const std::vector<double> times = end_times(all);
  const Counts total = counts_at(all, times);
  const auto size = Eigen::Index(groups.size());
  Eigen::VectorXd excess = Eigen::VectorXd::Zero(size);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
  std::vector<Counts> of_group;
  for (const std::vector<Lifetime>& group : groups) of_group.push_back(counts_at(group, times));
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double n = double(total.at_risk[k]), d = double(total.ended[k]);
    if (n == 0) continue;
    Eigen::VectorXd share(size);
    for (Eigen::Index g = 0; g < size; ++g) {
      share[g] = double(of_group[std::size_t(g)].at_risk[k]) / n;
      excess[g] += double(of_group[std::size_t(g)].ended[k]) - d * share[g];
    }
    if (n > 1) covariance += d * (n - d) / (n - 1) * (Eigen::MatrixXd(share.asDiagonal()) - share * share.transpose());
  }
  // The rows of the covariance add up to nothing; groups that were never at risk have none.
  std::vector<Eigen::Index> kept;
  for (Eigen::Index g = 0; g < size; ++g)
    if (covariance(g, g) > 0) kept.push_back(g);
  TestResult result;
  if (kept.size() < 2) return result;
  kept.pop_back();
  const Eigen::VectorXd o = excess(kept);
  result.degrees = kept.size();
  result.statistic = o.dot(covariance(kept, kept).ldlt().solve(o));
  result.p = boost::math::cdf(complement(boost::math::chi_squared(double(result.degrees)), result.statistic));
  return result;
}

double TurnbullEstimate::share_after(double time) const {
  double share = 1;
  for (std::size_t k = 0; k < mass.size() && high[k] <= time; ++k) share -= mass[k];
  return std::max(share, 0.0);
}

TurnbullEstimate turnbull(std::span<const LifetimeBracket> brackets) {
  // Bounds in order; at equal values: an upper bound of an exact lifetime closes its own interval [t, t], a lower bound t of (t, ...] comes after
  // all upper bounds t.
  struct Bound {
    double value;
    int rank;  // 0: lower of an exact one, 1: upper, 2: lower
  };
  std::vector<Bound> bounds;
  for (const LifetimeBracket& b : brackets) {
    bounds.push_back({b.low, b.low == b.high ? 0 : 2});
    bounds.push_back({b.high, 1});
  }
  std::sort(bounds.begin(), bounds.end(), [](const Bound& a, const Bound& b) { return a.value < b.value || (a.value == b.value && a.rank < b.rank); });
  TurnbullEstimate estimate;
  for (std::size_t k = 0; k + 1 < bounds.size(); ++k)
    if (bounds[k].rank != 1 && bounds[k + 1].rank == 1) {
      estimate.low.push_back(bounds[k].value);
      estimate.high.push_back(bounds[k + 1].value);
    }
  const std::size_t cells = estimate.low.size();
  estimate.mass.assign(cells, 1.0 / double(std::max<std::size_t>(cells, 1)));
  // Cells within a bracket are consecutive.
  std::vector<std::pair<std::size_t, std::size_t>> within;
  for (const LifetimeBracket& b : brackets) {
    std::size_t first = 0;
    while (first < cells && (estimate.low[first] < b.low || (estimate.low[first] == b.low && b.low != b.high && estimate.high[first] == b.low))) ++first;
    std::size_t last = first;
    while (last < cells && estimate.high[last] <= b.high) ++last;
    within.emplace_back(first, last);
  }
  std::vector<double> next(cells);
  for (int round = 0; round < 100000; ++round) {
    std::fill(next.begin(), next.end(), 0.0);
    for (const auto& [first, last] : within) {
      double sum = 0;
      for (std::size_t k = first; k < last; ++k) sum += estimate.mass[k];
      if (sum > 0)
        for (std::size_t k = first; k < last; ++k) next[k] += estimate.mass[k] / sum / double(brackets.size());
    }
    double moved = 0;
    for (std::size_t k = 0; k < cells; ++k) moved = std::max(moved, std::abs(next[k] - estimate.mass[k]));
    std::swap(estimate.mass, next);
    if (moved < 1e-10) break;
  }
  TurnbullEstimate kept;
  for (std::size_t k = 0; k < cells; ++k)
    if (estimate.mass[k] > 1e-9) {
      kept.low.push_back(estimate.low[k]);
      kept.high.push_back(estimate.high[k]);
      kept.mass.push_back(estimate.mass[k]);
    }
  return kept;
}

}  // namespace jam
