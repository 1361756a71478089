#include "libjam/statistics/duration_laws.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/quadrature/exp_sinh.hpp>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <numbers>
#include <vector>

namespace jam {
namespace {

using Parameters = std::array<double, 2>;

// exponential: p[0] = mean excess tau, s. S(t) = exp(-(t - t0)/tau).
double exponential_log_share(double t, double t0, const Parameters& p) { return -(t - t0) / p[0]; }
double exponential_log_density(double t, double t0, const Parameters& p) { return -std::log(p[0]) + exponential_log_share(t, t0, p); }

// stretched exponential (Weibull): p[0] = scale, s; p[1] = exponent. S(t) = exp((t0/p0)^p1 - (t/p0)^p1).
double stretched_log_share(double t, double t0, const Parameters& p) { return std::pow(t0 / p[0], p[1]) - std::pow(t / p[0], p[1]); }
double stretched_log_density(double t, double t0, const Parameters& p) {
  return std::log(p[1] / p[0]) + (p[1] - 1) * std::log(t / p[0]) + stretched_log_share(t, t0, p);
}

// log-normal: p[0] = mean, p[1] = standard deviation of log(t/s).
double log_upper_tail(double x) {
  // Mills' ratio by continued fraction where the tail is tiny.
  if (x < 30) return std::log(0.5 * std::erfc(x / std::numbers::sqrt2));
  return -0.5 * x * x - std::log(x * std::sqrt(2 * std::numbers::pi)) + std::log1p(-1 / (x * x));
}
double tail_argument(double t, const Parameters& p) { return t > 0 ? (std::log(t) - p[0]) / p[1] : -std::numeric_limits<double>::infinity(); }
double log_normal_log_share(double t, double t0, const Parameters& p) { return log_upper_tail(tail_argument(t, p)) - log_upper_tail(tail_argument(t0, p)); }
double log_normal_log_density(double t, double t0, const Parameters& p) {
  const double x = tail_argument(t, p);
  return -std::log(t * p[1] * std::sqrt(2 * std::numbers::pi)) - 0.5 * x * x - log_upper_tail(tail_argument(t0, p));
}

// power law: p[0] = exponent alpha of the density. S(t) = (t/t0)^(1 - alpha).
double power_log_share(double t, double t0, const Parameters& p) { return (1 - p[0]) * std::log(t / t0); }
double power_log_density(double t, double t0, const Parameters& p) { return std::log((p[0] - 1) / t0) - p[0] * std::log(t / t0); }

// power law with an exponential cut-off: p[0] = exponent, p[1] = cut-off time, s. Density ~ t^-p0 exp(-t/p1).
// log of the integral of (u/t)^-a exp(-(u - t)/tau) over u from t on, per t.
double log_cut_off_tail(double t, const Parameters& p) {
  thread_local boost::math::quadrature::exp_sinh<double> integrator(9);
  const auto f = [&](double x) { return std::pow(1 + x, -p[0]) * std::exp(-x * t / p[1]); };
  return std::log(integrator.integrate(f, 0.0, std::numeric_limits<double>::infinity(), 1e-9));
}
double cut_off_log_share(double t, double t0, const Parameters& p) {
  return (1 - p[0]) * std::log(t / t0) - (t - t0) / p[1] + log_cut_off_tail(t, p) - log_cut_off_tail(t0, p);
}
double cut_off_log_density(double t, double t0, const Parameters& p) {
  return -std::log(t0) - p[0] * std::log(t / t0) - (t - t0) / p[1] - log_cut_off_tail(t0, p);
}

using LogOf = double (*)(double, double, const Parameters&);
double log_likelihood(LogOf log_density, LogOf log_share, std::span<const Lifetime> durations, double t0, const Parameters& p) {
  double sum = 0;
  for (const Lifetime& d : durations)
    if (d.time >= t0) sum += d.ended ? log_density(d.time, t0, p) : log_share(d.time, t0, p);
  return std::isfinite(sum) ? sum : -std::numeric_limits<double>::max();
}

constexpr int bits = 40;
// The argument in [low, high] at which f is largest.
template <class F>
double largest_at(double low, double high, F f) {
  return boost::math::tools::brent_find_minima([&](double x) { return -f(x); }, low, high, bits / 2).first;
}

// Both parameters by one search within the other; `inner` gives the range of the second.
template <class Range, class Of, class Likelihood>
DurationFit nested(Range outer, Range inner, Of parameters, Likelihood likelihood) {
  const auto at = [&](double x, double y) { return likelihood(parameters(x, y)); };
  const auto best_inner = [&](double x) { return largest_at(inner.first, inner.second, [&](double y) { return at(x, y); }); };
  const double x = largest_at(outer.first, outer.second, [&](double candidate) { return at(candidate, best_inner(candidate)); });
  const double y = best_inner(x);
  return {parameters(x, y), at(x, y)};
}

struct Extent {
  double ended = 0, excess = 0, log_excess = 0, largest = 0;
};
Extent extent(std::span<const Lifetime> durations, double t0) {
  Extent e;
  for (const Lifetime& d : durations) {
    if (d.time < t0) continue;
    e.ended += d.ended;
    e.excess += d.time - t0;
    e.log_excess += t0 > 0 ? std::log(d.time / t0) : 0.0;
    e.largest = std::max(e.largest, d.time);
  }
  return e;
}

DurationFit fit_exponential(std::span<const Lifetime> durations, double t0) {
  const Extent e = extent(durations, t0);
  if (e.ended == 0 || e.excess == 0) return {};
  const Parameters p{e.excess / e.ended, 0};
  return {p, log_likelihood(exponential_log_density, exponential_log_share, durations, t0, p)};
}

DurationFit fit_stretched(std::span<const Lifetime> durations, double t0) {
  const Extent e = extent(durations, t0);
  if (e.ended == 0 || e.excess == 0) return {};
  // Given the exponent k the scale is known: scale^k = sum (t^k - t0^k) / ended. Times over the largest, so that powers stay finite.
  const auto parameters = [&](double k) {
    double sum = 0;
    for (const Lifetime& d : durations)
      if (d.time >= t0) sum += std::pow(d.time / e.largest, k) - std::pow(t0 / e.largest, k);
    return Parameters{e.largest * std::pow(sum / e.ended, 1 / k), k};
  };
  const auto value = [&](double log_k) {
    return log_likelihood(stretched_log_density, stretched_log_share, durations, t0, parameters(std::exp(log_k)));
  };
  const Parameters p = parameters(std::exp(largest_at(std::log(0.02), std::log(50.0), value)));
  return {p, log_likelihood(stretched_log_density, stretched_log_share, durations, t0, p)};
}

DurationFit fit_log_normal(std::span<const Lifetime> durations, double t0) {
  const Extent e = extent(durations, t0);
  if (e.ended == 0 || e.excess == 0) return {};
  // log(t) relative to the largest, in units that make both searches short.
  const double top = std::log(e.largest);
  return nested(std::pair(std::log(0.01), std::log(20.0)), std::pair(-60.0, 6.0),
                [&](double log_sigma, double mu) { return Parameters{top + mu, std::exp(log_sigma)}; },
                [&](const Parameters& p) { return log_likelihood(log_normal_log_density, log_normal_log_share, durations, t0, p); });
}

DurationFit fit_power(std::span<const Lifetime> durations, double t0) {
  const Extent e = extent(durations, t0);
  if (!(t0 > 0) || e.ended == 0 || e.log_excess == 0) return {};
  const Parameters p{1 + e.ended / e.log_excess, 0};
  return {p, log_likelihood(power_log_density, power_log_share, durations, t0, p)};
}

DurationFit fit_cut_off(std::span<const Lifetime> durations, double t0) {
  const Extent e = extent(durations, t0);
  if (!(t0 > 0) || e.ended == 0 || e.log_excess == 0) return {};
  // The same sum as log_likelihood() takes, with the integral at t0 once instead of for each duration.
  double ended_excess = 0, ended_log_excess = 0;
  std::vector<double> cut_off;
  for (const Lifetime& d : durations) {
    if (d.time < t0) continue;
    if (d.ended) {
      ended_excess += d.time - t0;
      ended_log_excess += std::log(d.time / t0);
    } else {
      cut_off.push_back(d.time);
    }
  }
  const auto likelihood = [&](const Parameters& p) {
    double sum = -e.ended * (std::log(t0) + log_cut_off_tail(t0, p)) - p[0] * ended_log_excess - ended_excess / p[1];
    for (const double t : cut_off) sum += cut_off_log_share(t, t0, p);
    return std::isfinite(sum) ? sum : -std::numeric_limits<double>::max();
  };
  const DurationFit found = nested(std::pair(-2.0, 6.0), std::pair(std::log(1e-3), std::log(1e3)),
                                   [&](double alpha, double log_tau) { return Parameters{alpha, e.largest * std::exp(log_tau)}; }, likelihood);
  // The power law itself is one of these laws, with the cut-off at infinity.
  const DurationFit pure = fit_power(durations, t0);
  if (found.log_likelihood >= pure.log_likelihood) return found;
  return {{pure.parameter[0], std::numeric_limits<double>::infinity()}, pure.log_likelihood};
}

constexpr DurationLaw table[] = {
    {"exponential", "mean excess (s)", 1, exponential_log_density, exponential_log_share, fit_exponential},
    {"stretched", "scale (s), exponent", 2, stretched_log_density, stretched_log_share, fit_stretched},
    {"log_normal", "mean and standard deviation of log(t/s)", 2, log_normal_log_density, log_normal_log_share, fit_log_normal},
    {"power", "exponent of the density", 1, power_log_density, power_log_share, fit_power},
    {"power_cut_off", "exponent of the density, cut-off time (s)", 2, cut_off_log_density, cut_off_log_share, fit_cut_off},
};

}  // namespace

std::span<const DurationLaw> duration_laws() { return table; }

const DurationLaw* find_duration_law(std::string_view name) {
  for (const DurationLaw& law : table)
    if (law.name == name) return &law;
  return nullptr;
}

LikelihoodRatio compare_laws(const DurationLaw& one, const DurationFit& fit_one, const DurationLaw& other, const DurationFit& fit_other,
                             std::span<const Lifetime> durations, double t0) {
  std::vector<double> ratio;
  double sum = 0;
  for (const Lifetime& d : durations)
    if (d.ended && d.time >= t0) {
      ratio.push_back(one.log_density(d.time, t0, fit_one.parameter) - other.log_density(d.time, t0, fit_other.parameter));
      sum += ratio.back();
    }
  if (ratio.size() < 2) return {};
  const double n = double(ratio.size()), mean = sum / n;
  double variance = 0;
  for (const double r : ratio) variance += (r - mean) * (r - mean) / (n - 1);
  if (!(variance > 0)) return {};
  const double statistic = std::sqrt(n) * mean / std::sqrt(variance);
  return {statistic, 2 * cdf(complement(boost::math::normal(), std::abs(statistic)))};
}

}  // namespace jam
