// Peaks of a series and their prominences: all jams of all thresholds in one pass, without choosing one.
//
// Lower a level from the top: a peak is born where the level first meets it, and dies where the level reaches the pass that joins it to a higher
// one (the elder rule; the highest never dies, its death is the lowest value). The number of separate stretches of the series above a threshold
// is the number of peaks with birth > threshold >= death (persistent homology of superlevel sets in dimension 0; Edelsbrunner, Letscher and
// Zomorodian, Discrete Comput. Geom. 28, 511, 2002).
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace jam {

struct Peak {
  std::size_t at = 0;           // index of the peak; ties: the first
  double birth = 0, death = 0;  // height of the peak, and of the pass that parts it from a higher one
  double prominence() const { return birth - death; }
};

// By birth, descending, then by index. Equal values next to each other are one. Takes the time of sorting; no peak without values.
std::vector<Peak> peaks(std::span<const double> series);

// Stretches of the series above each of these thresholds, in their order.
std::vector<std::size_t> counts_above(std::span<const Peak> peaks, std::span<const double> thresholds);

}  // namespace jam
