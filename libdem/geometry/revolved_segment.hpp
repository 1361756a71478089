// The surface that a straight segment sweeps when it is turned about an axis: cylinders, frustums of cones, flat rings.
//
// A sphere's centre and its nearest point of such a surface lie in one half plane through the axis, where the distance
// to a segment has exactly one local minimum. In it the touch is on the face where the foot of the perpendicular lies
// within the segment, else on the rim that one of its ends sweeps; it moves continuously from one to the other. (A
// sphere larger than a hollow touches it all round when its centre is on the axis: one of these touches is given.)
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "libdem/case/case.hpp"

namespace dem {

// The part of a revolved surface that was touched.
enum class RevolvedPart : std::uint8_t { face = 0, low_rim = 1, high_rim = 2 };

// The profile is (radius + s direction_r, s direction_z), low <= s <= high, with (direction_r, direction_z) a unit
// vector in the half plane (r, z) of the axis. Its front is on the left of the direction: (-direction_z, direction_r).
// An end at infinity has no rim. Without any rim the surface bounds the solid behind it, and distances from behind are
// negative. A surface with a rim is a thin sheet that may be touched from either side: if its back did not count, a
// grain that rolls over the rim would lose its touch on the way round.
struct RevolvedSegment {
  double radius, direction_r, direction_z, low, high;

  bool bounds_solid() const { return std::isinf(low) && std::isinf(high); }
  double radius_at(double s) const { return radius + s * direction_r; }
};

// In the half plane of the sphere's centre.
struct RevolvedTouch {
  double distance;            // m, centre to surface
  double normal_r, normal_z;  // unit, from the centre to the surface
  double touch_radius;        // m, distance of the touched point from the axis
  RevolvedPart part;
};

// For a centre at (r, z), r >= 0. `front` = 1 or -1 names the free side of a surface that bounds a solid: its front or
// its back. It also gives the normal of a touch at distance 0, which points away from the free side.
inline RevolvedTouch nearest_on(const RevolvedSegment& segment, double front, double r, double z) {
  const double from_r = r - segment.radius;
  const double along = from_r * segment.direction_r + z * segment.direction_z;
  const double s = std::clamp(along, segment.low, segment.high);
  const double touch_radius = segment.radius_at(s);
  const double front_r = -segment.direction_z, front_z = segment.direction_r;
  if (s == along) {
    const double height = front * (from_r * front_r + z * front_z);
    const double side = height >= 0 || segment.bounds_solid() ? front : -front;
    const double distance = segment.bounds_solid() ? height : std::abs(height);
    return {distance, -side * front_r, -side * front_z, touch_radius, RevolvedPart::face};
  }
  const RevolvedPart rim = along < s ? RevolvedPart::low_rim : RevolvedPart::high_rim;
  const double to_r = touch_radius - r, to_z = s * segment.direction_z - z;
  const double distance = std::sqrt(to_r * to_r + to_z * to_z);
  if (distance == 0) return {0, -front * front_r, -front * front_z, touch_radius, rim};
  return {distance, to_r / distance, to_z / distance, touch_radius, rim};
}

// 1/m, curvature of the surface around the axis, > 0 where it is hollow towards the sphere: the normal meets the axis
// at the radius of curvature (Meusnier). The curvature along the segment is 0; rims count as flat.
inline double curvature_at(const RevolvedTouch& touch) {
  return touch.part == RevolvedPart::face && touch.touch_radius > 0 ? touch.normal_r / touch.touch_radius : 0.0;
}

}  // namespace dem
