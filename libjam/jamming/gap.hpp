// Whether a particle sits in the clearance between the blade tip and the vessel (Gap, Criteria::gap_margin).
#pragma once
#include "libjam/jamming/criteria.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jam {

// RunInfo says where the gap is.
bool gap_known(const RunInfo& info);

// Beside one blade: with d the particle's diameter, r its centre's distance from the vertical axis through the blade's body origin and z its height
// above that origin, all in m,
//
//   r > tip_radius - gap_margin d   and   z_low - d <= z <= z_high + d
inline bool beside_tip(double r, double z, double d, const Gap& gap, const Criteria& criteria) {
  return r > gap.tip_radius - criteria.gap_margin * d && z >= gap.z_low - d && z <= gap.z_high + d;
}

// True where a particle is beside_tip() of some wall of role blade. False where the gap is not known. Needs one WallState per wall.
bool in_gap(const Snapshot& snapshot, std::size_t row, const RunInfo& info, const Criteria& criteria);

}  // namespace jam
