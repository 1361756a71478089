// Which law do durations follow? Fits by largest likelihood of everything that lasted `shortest` or more, cut-off durations included, and which of
// two laws explains them better.
#pragma once
#include <array>
#include <limits>
#include <span>
#include <string_view>

#include "libjam/statistics/lifetimes.hpp"

namespace jam {

// A law of durations t >= t0 by its density and the share that outlasts t, each relative to the share that outlasts t0.
//
// LAWS. Add one: a row here with how to find its parameters, and tests/jam/statistics/duration_laws_test.cpp tries it on its own draws.
struct DurationFit {
  std::array<double, 2> parameter{};  // in the order of the law's doc
  double log_likelihood = -std::numeric_limits<double>::infinity();
};
struct DurationLaw {
  std::string_view name, doc;
  int parameters;
  double (*log_density)(double t, double t0, const std::array<double, 2>& p);
  double (*log_share)(double t, double t0, const std::array<double, 2>& p);
  DurationFit (*fit)(std::span<const Lifetime> durations, double t0);
};
std::span<const DurationLaw> duration_laws();
const DurationLaw* find_duration_law(std::string_view name);

// Vuong's test (Econometrica 57, 307, 1989), as Clauset, Shalizi and Newman use it (SIAM Rev. 51, 661, 2009): the difference of the log-likelihoods
// over its standard deviation, > 0 where the first explains more; p: probability of such a difference either way if neither is better. Ended
// durations only.
struct LikelihoodRatio {
  double statistic = 0, p = 1;
};
LikelihoodRatio compare_laws(const DurationLaw& one, const DurationFit& fit_one, const DurationLaw& other, const DurationFit& fit_other,
                             std::span<const Lifetime> durations, double t0);

}  // namespace jam
