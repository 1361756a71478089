// How grains flow around the blade: their mean velocity by distance from its axis and height beside it, averaged around the axis and over time, over the
// speed of the blade's tip. The gap between tip and vessel, where jams are, is left out.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "libjam/jamming/criteria.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jam {

// A ring about the vertical axis through the origin of the blade's body, which goes with the blade: r in [radius_low, radius_high), height above that origin
// in [height_low, height_high).
struct FlowBin {
  // Rings of equal width from the axis to the vessel, layers of equal height from one height of the blade below its lower edge to one above its upper edge:
  // about two grain diameters each in the rheometer of the study (2.1 mm, grains of 0.925 mm), so that each is well filled. Farther from the blade grains
  // hardly move, and would only dilute the difference of two patterns. The number of bins is fixed and their edges follow from Gap alone, so that
  // the patterns of runs in one geometry compare bin by bin, whatever their grains are.
  static constexpr std::size_t rings = 6, layers = 9, count = rings * layers;  // a bin's row is its layer times `rings` plus its ring
  static constexpr std::uint64_t least_samples = 100;  // so many independent ones know the mean to a tenth of the grains' scatter

  double radius_low = 0, radius_high = 0, height_low = 0, height_high = 0;  // m
  std::uint64_t samples = 0;                                                // grains with their centres in it and not in the gap, summed over frames
  // Over samples i of radius R_i and velocity v_i in the laboratory frame: sum R_i^3 v_i / sum R_i^3 u_i, the mean over solid volume divided by that of the
  // tip's speed u_i in the frame of the sample (tip_speed() of blade_pose.hpp), so that frames in which the blade hardly moves do not outweigh the others.
  // Frames count alike, whatever their distances in time. Azimuthal: > 0 along the blade's own sense of rotation, so that clockwise and counter-clockwise
  // runs compare; radial: > 0 outward; vertical: > 0 upward. What turns with a blade that only turns has azimuthal r/tip_radius. NaN below least_samples.
  double azimuthal = 0, radial = 0, vertical = 0;
};

// A sum that does not depend on the order of its terms: a whole number of 2^-80, in two's complement, the low word first.
using ExactSum = std::array<std::uint64_t, 2>;

// What the means are made of, of one frame or of many. Sums are exact, so that frames may be cut into parts and put together in any way, and take the same
// memory for any number of frames: doubles, added in order of frames, would have to be kept frame by frame until all parts are there. In a frame the terms
// are added in order of its rows, as doubles, and then cut to 2^-80, which is 1e-11 of the term of one grain of the study at a hundred millionth of the tip's speed.
struct FlowSums {
  struct Bin {
    std::uint64_t samples = 0;
    ExactSum tip{}, azimuthal{}, radial{}, vertical{};  // m/s, times (R_i / tip_radius)^3
  };
  std::vector<Bin> bins;  // [FlowBin::count], or none where no frame could be counted
};

// The run says where bins are: tip_radius and vessel_radius are above 0, z_high is above z_low.
bool flow_bins_known(const Gap& gap);

// Of one frame, around the first wall that is a blade. Without bins where these are not known, no wall is a blade, the blade does not turn about the vertical
// (so that there is no sense of rotation) or the source has no velocities. In the gap: in_gap() of jamming/gap.hpp, of any blade. One pass over the particles.
FlowSums flow_sums(const Snapshot& snapshot, const RunInfo& info, const Criteria& criteria);
// Each sum of a frame counts as at most 2^20, which no flow reaches; they hold for 2^27 frames.
void add(FlowSums& sums, const FlowSums& more);

// Row by row of FlowBin; empty where the sums have no bins.
std::vector<FlowBin> flow_pattern(const FlowSums& sums, const Gap& gap);

}  // namespace jam
