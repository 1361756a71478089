// Where the grains of a bed are placed: an upright prism that stands on z = 0 and is open above. It bounds the grains only
// while they are placed; from then on the walls of the setup do, or nothing, and grains spread to a heap.
#pragma once
#include "libdem/case/case.hpp"

namespace dem {

// Of a case: its box, or the vessel.
BedRegion bed_region(const Case& c);

// m^2, of the cross-section.
double cross_section(const BedRegion& region);

// m, radius of the largest sphere that stands in it; <= 0 for a region without inside.
double clear_radius(const BedRegion& region);

// The point of the region that is nearest to x among those at least `margin` away from its sides. `margin` must not be
// larger than clear_radius.
Vec3 held_inside(const BedRegion& region, const Vec3& x, double margin);

// The point of the region, `margin` away from its sides, that the unit square is mapped to; areas keep their ratios. z = 0.
Vec3 point_inside(const BedRegion& region, double u, double v, double margin);

}  // namespace dem
