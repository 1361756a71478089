// The parametric rheometer blade: two twisted arms and a shaft, as one closed surface.
#pragma once
#include "libdem/case/case.hpp"
#include "libdem/geometry/mesh.hpp"

namespace dem {

// Body frame: the axis is z, the origin lies on it at the plate's mid height, the arms point along +x and -x, and a
// half turn about z maps the blade onto itself.
//
// The section of the arm along +x at the fraction u of its length is a rectangle thickness x height turned about x by
// beta = tip_twist u^twist_exponent:   y = xi cos beta + zeta sin beta,   z = zeta cos beta - xi sin beta,
// |xi| <= thickness / 2, |zeta| <= height / 2,   x = u x_tip;
// x_tip = sqrt(R^2 - y_tip^2) for a cylindrical tip (every vertex of the tip surface at the tip radius R = diameter /
// 2; the facets stay within R / 4000 of it) or the same with the largest |y_tip| for a flat one (only its two corners
// reach R).
//
// Direction: with tip_twist > 0 the upper edge leans forward when the blade turns counter-clockwise seen from above, so
// the leading faces look forward and down. Moved downward (negative helix angle) it bulldozes the grains, moved upward
// it slices through them. The sign of tip_twist mirrors the blade; a blade that turns clockwise needs the opposite sign
// for the same.
//
// The shaft (none for shaft_diameter = 0) is a 36-sided prism with its vertices on shaft_diameter. It reaches from h /
// 20 above the plate's lower edge on the axis (h: height) to shaft_length above the mid plane; shaft_length = 0 stands
// for 60 mm, which is more than the 52 mm bed of a 25 mm vessel.
//
// Labels: face = the two large sides of the plate, edge = its upper and lower sides, tip = the tip surfaces, hub = the
// shaft.
//
// Throws GeometryError, naming value and bound, for: a diameter, height or thickness that is not positive and finite;
// |tip_twist| > 80 degrees; twist_exponent outside [0.1, 10]; a plate that does not fit the tip circle (section
// diagonal >= 0.9 diameter); thickness > height; a shaft thicker than half the diameter or whose top lies below the
// plate's upper edge.
TriangleMesh make_twisted_blade(const TwistedBlade& blade);

// Over the facets not labelled hub (over all if there is no other): tip_radius = the largest distance from the z axis,
// z_high = the highest point. z_low is the lowest point of all facets. In m, body frame.
struct BladeExtent {
  double tip_radius = 0, z_low = 0, z_high = 0;
};
BladeExtent blade_extent(const TriangleMesh& mesh);

// For meshes from files: labels as tip every triangle of which all corners lie beyond 0.98 of the largest distance from
// the z axis and whose normal is within 30 degrees of pointing away from it; the rest as face.
void label_tips(TriangleMesh& mesh);

}  // namespace dem
