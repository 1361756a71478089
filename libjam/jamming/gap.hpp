// Whether a particle sits in the clearance between the blade tip and the vessel (Gap, Criteria::gap_margin).
#pragma once
#include "libjam/jamming/criteria.hpp"
#include "libjam/snapshot/snapshot.hpp"

namespace jam {

// RunInfo says where the gap is.
bool gap_known(const RunInfo& info);

// True where, for some wall of role blade, with d the particle's diameter, r its centre's distance from the vertical
// axis through the blade's body origin and z its height above that origin:
//
//   r > tip_radius - gap_margin d   and   z_low - d <= z <= z_high + d
//
// False where the gap is not known. Needs one WallState per wall.
bool in_gap(const Snapshot& snapshot, std::size_t row, const RunInfo& info, const Criteria& criteria);

}  // namespace jam
