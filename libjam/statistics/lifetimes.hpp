// Survival of jams: what share outlasts a time, from lifetimes that may be cut off at either end.
#pragma once
#include <span>
#include <vector>

namespace jam {

// One observed lifetime, s. It is known from the age `entry` on (0: from its birth; later where the record begins inside it: left-truncated)
// up to the age `time`, where it ended, or where the record did (right-censored).
struct Lifetime {
  double time = 0;
  bool ended = true;
  double entry = 0;
};

struct SurvivalCurve {
  // One row per time at which a lifetime ends, ascending; the share is that just after it. Before the first it is 1.
  std::vector<double> time, share, low, high;  // s, 1; NaN for the band where the share is 0
  std::vector<std::size_t> at_risk, ended;
};

// Kaplan and Meier's product-limit estimate (J. Am. Stat. Assoc. 53, 457, 1958) with Greenwood's variance and the pointwise confidence band
// on the scale of log(-log S), which stays within 0 and 1 (Kalbfleisch and Prentice). At equal times ends come before cut-offs.
SurvivalCurve kaplan_meier(std::span<const Lifetime> lifetimes, double confidence = 0.95);

// s, the first time at which the share is `share` or less, and the same of the band; infinity where it never gets there.
struct Quantile {
  double value, low, high;
};
Quantile when_left(const SurvivalCurve& curve, double share = 0.5);

struct TestResult {
  double statistic = 0;  // chi^2
  std::size_t degrees = 0;
  double p = 1;  // probability of a statistic at least as large if nothing differs
};

// Do groups of lifetimes follow one law? Mantel's log-rank test (Peto and Peto, J. R. Stat. Soc. A 135, 185, 1972). Groups in which nothing
// was at risk when something ended tell nothing and do not count as a degree of freedom.
TestResult log_rank(std::span<const std::vector<Lifetime>> groups);

// Lifetimes known only to lie in (low, high], high = infinity where censored; low = high: exact.
struct LifetimeBracket {
  double low = 0, high = 0;
};

// Turnbull's estimate (J. R. Stat. Soc. B 38, 290, 1976): the distribution of largest likelihood puts its mass on intervals that begin with a
// lower and end with the next upper bound; where within one does not matter.
struct TurnbullEstimate {
  std::vector<double> low, high, mass;  // s, s, 1; ascending, only where mass > 0
  // Share that outlasts `time`; within an interval of mass, between the two values: the one before it.
  double share_after(double time) const;
};
// By expectation and maximisation until no mass moves by more than 1e-10.
TurnbullEstimate turnbull(std::span<const LifetimeBracket> brackets);

}  // namespace jam
