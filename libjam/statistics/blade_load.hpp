// What an instrument that holds the blade would feel: the vertical force on it and its torque about the vertical, at every step and as slower
// instruments average them. Jams last micro- to milliseconds: an instrument that exports 25 samples a second shows a share of their peaks.
#pragma once
#include <limits>
#include <span>
#include <vector>

#include "libjam/snapshot/snapshot.hpp"

namespace jam {

// Magnitudes, N or N m. NaN where the source does not have it.
struct LoadPeaks {
  double every_step = 0;           // largest of all steps
  double windows = 0;              // largest mean of a window of the series
  double frames = 0;               // largest at a frame
  double filtered = 0;             // largest mean over BladeLoad::filter
  double median = 0;               // of the windows' means
  double trend = 0;                // Kendall's tau of the means over BladeLoad::filter against time: 1 where they only grow
  std::vector<double> medians;     // of the windows' means in each whole BladeLoad::block of the record, peaks left out; none in shorter ones
};

struct BladeLoad {
  static constexpr double filter = 0.04;      // s, between two samples of an instrument at 25 Hz
  static constexpr double block = 0.1;        // s, whatever the record: runs of different lengths can be compared
  LoadPeaks force, torque;                    // along z; about z through the blade's axis
};

// A blade's load at a frame.
struct FrameLoad {
  double time = 0, force = 0, torque = 0;  // s, N, N m
};

// Of the first wall that is a blade. The series' windows are taken as equally long. Everything is NaN where no wall is a blade, the series is empty or the
// source does not record the loads of walls. `peaks_above`, N: windows in which a grain carries more are left out of `medians` (NaN where none is left);
// taken as infinite where the series does not say what grains carry.
BladeLoad blade_load(const Series& series, const std::vector<Wall>& walls, std::span<const FrameLoad> frames,
                     double peaks_above = std::numeric_limits<double>::infinity());

// Kendall's tau-a of a sequence against its order: (pairs that grow - pairs that fall) / pairs; NaN for fewer than two. Takes n^2/2 comparisons.
double kendall_tau(std::span<const double> values);

// E = c t^p, least squares of log E against log t at `points` times that stand evenly on the logarithmic axis over the last 95 % of the record; E between
// the given points by straight lines. NaN where E is not positive there.
struct PowerLaw {
  double exponent = 0, determination = 0;  // p, R^2
};
PowerLaw power_law(std::span<const double> time, std::span<const double> energy, std::size_t points = 100);

}  // namespace jam
