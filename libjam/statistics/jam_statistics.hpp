// What the jams of one stream say in all.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "libjam/events/every_step.hpp"
#include "libjam/statistics/duration_laws.hpp"
#include "libjam/statistics/lifetimes.hpp"
#include "libjam/statistics/rates.hpp"

namespace jam {

struct LawFit {
  std::string name;
  DurationFit fit;
  double akaike = 0;  // 2 parameters - 2 log-likelihood: smaller explains more
};

struct JamStatistics {
  Rate rate;                // of jams that began in the record, 1/s, if they come independently
  double jammed_time = 0;   // s, summed durations
  double at_a_time = 0;     // jams at a time in the mean: jammed_time over the length of the record
  double longest = 0;       // s
  SurvivalCurve survival;   // of those that began in the record; those still there at its end are cut off
  Quantile median;          // s
  double fano = 0;          // of the counts in 20 equal windows: 1 where jams come independently, more in bursts
  IndependenceTest independence;  // of the distances of starts
  std::vector<LawFit> laws;       // of durations; in the order of duration_laws(); empty for fewer than ten jams
};

// `begin` to `end`, s, of the record.
JamStatistics jam_statistics(std::span<const StepJam> jams, double begin, double end);

// The durations as lifetimes. Jams that were there when the record began have no known age and are left out.
std::vector<Lifetime> lifetimes_of(std::span<const StepJam> jams);

}  // namespace jam
