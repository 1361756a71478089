// How long jams live: the survival-time classes of the paper's Fig. 9 (frequency) and Table 4 (share of jam time).
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "libjam/events/event.hpp"

namespace jam {

struct SurvivalClass {
  double low = 0, high = 0;  // s, [low, high); high = infinity for the last
  std::uint32_t events = 0;
  double frequency = 0;          // 1/s, events / observed time; 0 without observed time
  double share_of_jam_time = 0;  // of the summed survival times, not of the number of events; 0 without events
};

// One class more than there are upper bounds, s, ascending. Survival times are multiples of the sampling interval and
// bounds often are too, so a time within 1e-3 sampling intervals of a bound counts as on it and belongs to the class
// above: rounding in the frames' times must not decide. Censored events count with the time that was seen.
std::vector<SurvivalClass> survival_classes(std::span<const JamEvent> events, std::span<const double> upper_bounds,
                                            double sampling_interval, double observed_time);

// Summed survival times, s.
double jammed_time(std::span<const JamEvent> events);

}  // namespace jam
