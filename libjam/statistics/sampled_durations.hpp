// What samples D apart say of how often something happens and how long it lasts, short events that no sample saw included.
//
// An event of duration d that begins at any phase of the sampling with equal probability gives n samples with probability
// K(n | d) = max(0, 1 - |d/D - n|): none with max(0, 1 - d/D). Without a law for the durations their number cannot be known, since events much
// shorter than D are seen by chance only; their total time can: the expectation of n D is d, unseen events included.
#pragma once
#include <cstdint>
#include <span>

#include "libjam/events/event.hpp"
#include "libjam/statistics/rates.hpp"

namespace jam {

double seen_with_samples(std::uint64_t n, double duration, double interval);  // K(n | d)

// If durations are exponential with mean tau, n >= 1 samples are geometric: P(n) = p (1 - p)^(n - 1), p = 1 - exp(-D/tau), and the share
// 1 - (tau/D) p is never seen.
struct ExponentialDurations {
  double mean = 0, low = 0, high = 0;  // s, tau and its interval (exact, from the negative binomial law of the sum of n)
  double unseen = 0;                   // share of the events that no sample saw
  Rate rate;                           // 1/s, of all events; its interval holds those of the seen ones' rate and of tau at once (Bonferroni)
};
// `samples`: n of each event that was seen whole. `observed_time`, s; `cut_off`: further events that began in it. NaN without events; where every
// event has one sample, tau may be anything from 0 on and the rate has no upper bound.
ExponentialDurations exponential_durations(std::span<const std::uint32_t> samples, double interval, double observed_time,
                                           double confidence = 0.95, std::uint64_t cut_off = 0);

// Of the events of a stream that frames have seen; those that the record cuts off give no duration but count for the rate.
ExponentialDurations corrected_for_sampling(std::span<const JamEvent> events, double interval, double observed_time, double confidence = 0.95);

}  // namespace jam
