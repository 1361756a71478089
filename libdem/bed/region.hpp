// Where the grains of a bed are placed: an upright prism that stands on z = 0 and is open above. It bounds the grains only
// while they are placed; from then on the walls of the setup do, or nothing, and grains spread to a heap.
#pragma once
#include <variant>

#include "libdem/case/case.hpp"

namespace dem {

// A circle about the z axis.
struct CylinderRegion {
  double radius = 0;  // m
};

// A rectangle.
struct BoxRegion {
  double x_low = 0, x_high = 0, y_low = 0, y_high = 0;  // m
};

using BedRegion = std::variant<CylinderRegion, BoxRegion>;

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
