// How often: rates of events with exact intervals, and whether events come independently of each other.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace jam {

struct Rate {
  double value = 0, low = 0, high = 0;  // 1/s; NaN without observed time
};

// Of `events` in `observed_time`, s, if they come independently: Garwood's exact interval (Biometrika 28, 437, 1936),
// chi^2_{a/2}(2n) / 2T to chi^2_{1-a/2}(2n + 2) / 2T.
Rate poisson_rate(std::uint64_t events, double observed_time, double confidence = 0.95);

// Probability of counts at least as unlikely if both rates are the same: given their sum, the first is binomial with the share of its time
// (Przyborowski and Wilenski, Biometrika 31, 313, 1940).
double same_rate_probability(std::uint64_t events_a, double time_a, std::uint64_t events_b, double time_b);

// Variance over mean of the counts of `start` times, s, in `windows` equal windows of [begin, end): 1 where events come independently at a
// constant rate, more where they come in bursts. NaN without events or with fewer than two windows.
double fano_factor(std::span<const double> start, double begin, double end, std::size_t windows);

// Are the distances of consecutive starts exponential, as they are if events come independently? Largest distance D of the empirical from the
// fitted distribution, and its probability by Lilliefors' test: the mean is fitted too (J. Am. Stat. Assoc. 64, 387, 1969), by
// simulation with a fixed seed. p is NaN for fewer than three starts.
struct IndependenceTest {
  double distance = 0, p = 0;
};
IndependenceTest exponential_distances(std::span<const double> start);

// "At least one is there", where events begin independently of each other at a constant rate, 1/s, and last `mean_duration`, s, in the mean, however it
// is distributed: the busy periods of a queue with as many servers as are wanted (Takacs, Introduction to the Theory of Queues, 1962). With the
// mean number at a time n = rate mean_duration, it is so for 1 - exp(-n) of the time, begins rate exp(-n) times a second and lasts
// (exp(n) - 1)/rate in the mean (NaN for a rate of 0).
struct Overlapping {
  double share = 0, rate = 0, mean_duration = 0;  // 1, 1/s, s
};
Overlapping overlapping(double rate, double mean_duration);

// A mean over runs or blocks, with the interval of its bootstrap: blocks are drawn anew with replacement (Efron). Percentiles of 10,000 draws
// with a fixed seed, so the same blocks give the same interval.
struct BlockMean {
  double value = 0, low = 0, high = 0;
};
BlockMean bootstrap_mean(std::span<const double> blocks, double confidence = 0.95);

}  // namespace jam
