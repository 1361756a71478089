#include "libdem/geometry/walls.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "libdem/errors.hpp"
#include "libdem/geometry/revolved_segment.hpp"

namespace dem {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double parallel = 1e-9;     // rad, directions that differ by less are the same
constexpr double unit_length = 1e-9;  // 1, tolerance of the length of unit vectors

// Everything below is in the body frame.

// --- surfaces of revolution: one segment and its axis ---

struct Revolved {
  const Vec3& point;
  const Vec3& axis;
  RevolvedSegment segment;
  double front;  // 1 or -1, see nearest_on
};

double front_of(FreeSide free) {
  return free == FreeSide::inside ? 1 : -1;
}

Revolved revolved(const Cylinder& c) {
  return {c.point, c.axis, {c.radius, 0, 1, c.low, c.high}, front_of(c.free)};
}
Revolved revolved(const Cone& c) {
  const double widening = c.high_radius - c.low_radius, slant = std::sqrt(widening * widening + c.length * c.length);
  return {c.point, c.axis, {c.low_radius, widening / slant, c.length / slant, 0, slant}, front_of(c.free)};
}
Revolved revolved(const Disc& d) {
  return {d.point, d.normal, {0, 1, 0, d.hole_radius, d.radius}, 1};
}

template <class Shape>
concept Revolves = requires(const Shape& shape) {
  revolved(shape);
};

struct AxialPlace {
  double r, z;
  Vec3 radial;
};
AxialPlace place_of(const Revolved& surface, const Vec3& x) {
  const Vec3 from_point = x - surface.point;
  const double z = from_point.dot(surface.axis);
  const Vec3 radial = from_point - z * surface.axis;
  return {radial.norm(), z, radial};
}

RevolvedTouch nearest_on(const Revolved& surface, const AxialPlace& place) {
  return nearest_on(surface.segment, surface.front, place.r, place.z);
}

// Largest distance of the surface from x: on one of the rims, as the distance is convex along the segment and around
// it.
double farthest(const Revolved& surface, const Vec3& x) {
  if (std::isinf(surface.segment.low) || std::isinf(surface.segment.high)) return infinity;
  const AxialPlace place = place_of(surface, x);
  const auto to_rim = [&](double s) {
    return std::hypot(place.z - s * surface.segment.direction_z, place.r + surface.segment.radius_at(s));
  };
  return std::max(to_rim(surface.segment.low), to_rim(surface.segment.high));
}

// --- touches: f(touch) for each, `point` left to the caller ---

template <class F>
void visit_touches(const Plane& plane, const Vec3& centre, double reach, std::span<const std::uint32_t>,
                   std::vector<MeshTouch>&, F&& f) {
  const double distance = (centre - plane.point).dot(plane.normal);
  if (distance <= reach) f({0, 0, MeshFeature::face, {}, -plane.normal, distance, {0, 0}});
}

template <Revolves Shape, class F>
void visit_touches(const Shape& shape, const Vec3& centre, double reach, std::span<const std::uint32_t>,
                   std::vector<MeshTouch>&, F&& f) {
  const Revolved surface = revolved(shape);
  const AxialPlace place = place_of(surface, centre);
  const RevolvedTouch touch = nearest_on(surface, place);
  if (!(touch.distance <= reach)) return;
  // On the axis every direction away from it is as near as any other.
  const Vec3 outward = place.r > 0 ? Vec3(place.radial / place.r) : surface.axis.unitOrthogonal();
  const MeshFeature kind = touch.part == RevolvedPart::face ? MeshFeature::face
                           : touch.touch_radius > 0         ? MeshFeature::edge
                                                            : MeshFeature::vertex;
  f({std::uint64_t(touch.part),
     0,
     kind,
     {},
     touch.normal_r * outward + touch.normal_z * surface.axis,
     touch.distance,
     {curvature_at(touch), 0}});
}

template <class F>
void visit_touches(const GluedGrains& glued, const Vec3& centre, double reach, std::span<const std::uint32_t> parts,
                   std::vector<MeshTouch>&, F&& f) {
  for (const std::uint32_t k : parts) {
    const double radius = glued.spheres->radii()[k], far = reach + radius;
    const Vec3 to_sphere = glued.spheres->centres()[k] - centre;
    const double squared = to_sphere.squaredNorm();
    if (!(squared <= far * far)) continue;
    const double length = std::sqrt(squared);
    const Vec3 normal = length > 0 ? Vec3(to_sphere / length) : Vec3(-Vec3::UnitZ());
    f({k, k, MeshFeature::face, {}, normal, length - radius, {-1 / radius, -1 / radius}});
  }
}

template <class F>
void visit_touches(const MeshWall& mesh, const Vec3& centre, double reach, std::span<const std::uint32_t> parts,
                   std::vector<MeshTouch>& scratch, F&& f) {
  mesh.finder->touches(centre, reach, parts, scratch);
  for (const MeshTouch& t : scratch)
    f({(std::uint64_t(t.feature) << 32) | t.feature_id, t.facet, t.feature, {}, t.normal, t.distance, {0, 0}});
}

// --- candidates ---

template <class Shape>
void find_parts(const Shape&, const Vec3&, double, std::vector<std::uint32_t>&) {}
void find_parts(const GluedGrains& glued, const Vec3& centre, double reach, std::vector<std::uint32_t>& out) {
  glued.spheres->within(centre, reach, out);
}
void find_parts(const MeshWall& mesh, const Vec3& centre, double reach, std::vector<std::uint32_t>& out) {
  mesh.finder->candidate_triangles(centre, reach, out);
}

template <class Shape>
std::size_t keep_parts(const Shape&, const Vec3&, double, std::span<const std::uint32_t>, std::span<std::uint32_t>) {
  return 0;
}
std::size_t keep_parts(const GluedGrains& glued, const Vec3& centre, double reach, std::span<const std::uint32_t> parts,
                       std::span<std::uint32_t> out) {
  std::size_t count = 0;
  for (const std::uint32_t k : parts) {
    const double far = reach + glued.spheres->radii()[k];
    if (!((glued.spheres->centres()[k] - centre).squaredNorm() > far * far)) out[count++] = k;
  }
  return count;
}
std::size_t keep_parts(const MeshWall& mesh, const Vec3& centre, double reach, std::span<const std::uint32_t> parts,
                       std::span<std::uint32_t> out) {
  return mesh.finder->triangles_within(centre, reach, parts, out);
}

bool is_near(const Plane& plane, const Vec3& centre, double reach) {
  return (centre - plane.point).dot(plane.normal) <= reach;
}
template <Revolves Shape>
bool is_near(const Shape& shape, const Vec3& centre, double reach) {
  const Revolved surface = revolved(shape);
  return nearest_on(surface, place_of(surface, centre)).distance <= reach;
}
bool is_near(const GluedGrains& glued, const Vec3& centre, double reach) {
  return glued.spheres->any_within(centre, reach);
}
bool is_near(const MeshWall& mesh, const Vec3& centre, double reach) {
  return mesh.box.squaredExteriorDistance(centre) <= reach * reach;
}

// --- material ---

// Solid angle of the surface seen from x over 4 pi: 1 inside a closed outward surface, 0 outside.
double winding_number(const TriangleMesh& mesh, const Vec3& x) {
  double angle = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - x, b = mesh.vertices[t[1]] - x, c = mesh.vertices[t[2]] - x;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (4 * std::numbers::pi);
}

bool fills(const Plane& plane, const Vec3& x) {
  return (x - plane.point).dot(plane.normal) < 0;
}
template <Revolves Shape>
bool fills(const Shape& shape, const Vec3& x) {
  const Revolved surface = revolved(shape);
  const RevolvedSegment& s = surface.segment;
  const AxialPlace place = place_of(surface, x);
  const double along = place.z / s.direction_z;
  if (along < s.low || along > s.high) return false;
  return surface.front * (place.r - s.radius_at(along)) > 0;
}
bool fills(const Disc&, const Vec3&) {
  return false;
}
bool fills(const GluedGrains& glued, const Vec3& x) {
  return glued.spheres->any_within(x, 0);
}
bool fills(const MeshWall& mesh, const Vec3& x) {
  return mesh.box.contains(x) && winding_number(mesh.finder->mesh(), x) > 0.5;
}

// --- speed ---

// Of a rigid body, in its own frame: velocity of its point `pivot` and angular velocity.
struct Twist {
  Vec3 velocity, angular_velocity, pivot;
};

// m/s, infinity where there is no bound.
double surface_speed(const Plane& plane, const Twist& twist) {
  const double spin = twist.angular_velocity.norm();
  if (twist.angular_velocity.cross(plane.normal).norm() > parallel * spin) return infinity;
  return std::abs(twist.velocity.dot(plane.normal));
}
// The spin about the surface's own direction moves it as the rotation about its own axis, which changes nothing, and a
// translation of the axis; the rest of the rotation moves the farthest point fastest.
template <Revolves Shape>
double surface_speed(const Shape& shape, const Twist& twist) {
  const Revolved surface = revolved(shape);
  const double spin = twist.angular_velocity.dot(surface.axis);
  const double tumbling = (twist.angular_velocity - spin * surface.axis).norm();
  const double orbiting = std::abs(spin) * surface.axis.cross(surface.point - twist.pivot).norm();
  const bool endless = surface.segment.bounds_solid();
  const Vec3 along = twist.velocity.dot(surface.axis) * surface.axis;
  const double moving = endless ? (twist.velocity - along).norm() : twist.velocity.norm();
  const double far = farthest(surface, twist.pivot);
  if (std::isfinite(far)) return moving + orbiting + tumbling * far;
  return tumbling <= parallel * twist.angular_velocity.norm() ? moving + orbiting : infinity;
}
double surface_speed(const GluedGrains& glued, const Twist& twist) {
  return twist.velocity.norm() + twist.angular_velocity.norm() * (glued.spheres->reach() + twist.pivot.norm());
}
double surface_speed(const MeshWall& mesh, const Twist& twist) {
  double squared = 0;
  if (!twist.angular_velocity.isZero(0))
    for (const Vec3& v : mesh.finder->mesh().vertices)
      squared = std::max(squared, twist.angular_velocity.cross(v - twist.pivot).squaredNorm());
  return twist.velocity.norm() + std::sqrt(squared);
}

// --- numbers that make no shape ---

[[noreturn]] void fail(const std::string& problem) {
  throw CaseError(problem);
}
void require_unit(const Vec3& direction, const char* name) {
  if (!(std::abs(direction.norm() - 1) <= unit_length))
    fail(std::string(name) + " of length " + std::to_string(direction.norm()) + ", expected 1");
}
void require_positive(double value, const char* name) {
  if (!(value > 0) || !std::isfinite(value))
    fail(std::string(name) + " = " + std::to_string(value) + " m, expected > 0");
}
void require_not_negative(double value, const char* name) {
  if (!(value >= 0) || !std::isfinite(value))
    fail(std::string(name) + " = " + std::to_string(value) + " m, expected >= 0");
}
void require_finite(const Vec3& point) {
  if (!point.allFinite()) fail("a point that is not finite");
}

void check(const Plane& plane) {
  require_finite(plane.point);
  require_unit(plane.normal, "normal");
}
void check(const Cylinder& cylinder) {
  require_finite(cylinder.point);
  require_unit(cylinder.axis, "axis");
  require_positive(cylinder.radius, "radius");
  if (!(cylinder.low < cylinder.high))
    fail("ends at " + std::to_string(cylinder.low) + " m and " + std::to_string(cylinder.high) +
         " m, expected the lower first");
}
void check(const Cone& cone) {
  require_finite(cone.point);
  require_unit(cone.axis, "axis");
  require_not_negative(cone.low_radius, "low radius");
  require_not_negative(cone.high_radius, "high radius");
  require_positive(std::max(cone.low_radius, cone.high_radius), "larger radius");
  require_positive(cone.length, "length");
}
void check(const Disc& disc) {
  require_finite(disc.point);
  require_unit(disc.normal, "normal");
  require_positive(disc.radius, "radius");
  require_not_negative(disc.hole_radius, "radius of the hole");
  if (!(disc.hole_radius < disc.radius))
    fail("a hole of radius " + std::to_string(disc.hole_radius) + " m, expected less than the radius, " +
         std::to_string(disc.radius) + " m");
}
void check(const GluedGrains& glued) {
  if (!glued.spheres) fail("no spheres");
}
void check(const MeshWall& mesh) {
  if (!mesh.finder) fail("no mesh");
}

}  // namespace

GluedGrains make_glued_grains(std::vector<Vec3> centres, std::vector<double> radii) {
  return {std::make_shared<const SphereSet>(std::move(centres), std::move(radii))};
}

MeshWall make_mesh_wall(TriangleMesh mesh) {
  Eigen::AlignedBox3d box;
  for (const Vec3& v : mesh.vertices) box.extend(v);
  return {std::make_shared<const MeshContactFinder>(std::move(mesh)), box};
}

void validate_wall(const Wall& wall) {
  try {
    std::visit([](const auto& shape) { check(shape); }, wall.shape);
    validate_motion(wall.motion);
  } catch (const CaseError& error) {
    throw CaseError("wall '" + wall.name + "': " + error.what());
  }
  largest_speed(wall);
}

double largest_speed(const Wall& wall) {
  const auto speed = [&](const Vec3& velocity, const Vec3& spin, const Eigen::Quaterniond& orientation,
                         const Vec3& pivot) {
    const Twist twist{orientation.conjugate() * velocity, orientation.conjugate() * spin, pivot};
    return std::visit([&](const auto& shape) { return surface_speed(shape, twist); }, wall.shape);
  };
  double largest = 0;
  const WallMotion& motion = wall.motion;
  if (motion.table) {
    for (std::size_t k = 0; k < motion.table->legs().size(); ++k) {
      const PoseTable::Leg& leg = motion.table->legs()[k];
      largest = std::max(largest,
                         speed(leg.velocity, leg.angular_velocity, motion.table->rows()[k].orientation, Vec3::Zero()));
    }
  } else {
    largest = speed(motion.velocity, motion.angular_velocity, motion.orientation, motion.pivot);
  }
  if (!std::isfinite(largest))
    throw CaseError("wall '" + wall.name +
                    "' is endless and turns about a direction that is not its own, so its far parts move at any speed; "
                    "give it a finite extent");
  return largest;
}

void candidate_parts(const Wall& wall, const WallPose& pose, const Vec3& centre, double reach,
                     std::vector<std::uint32_t>& out) {
  const Vec3 body = pose.rotation.transpose() * (centre - pose.position);
  std::visit([&](const auto& shape) { find_parts(shape, body, reach, out); }, wall.shape);
}

std::size_t parts_within(const Wall& wall, const WallPose& pose, const Vec3& centre, double reach, std::span<const std::uint32_t> parts,
                         std::span<std::uint32_t> out) {
  const Vec3 body = pose.rotation.transpose() * (centre - pose.position);
  return std::visit([&](const auto& shape) { return keep_parts(shape, body, reach, parts, out); }, wall.shape);
}

bool near(const Wall& wall, const WallPose& pose, const Vec3& centre, double reach) {
  const Vec3 body = pose.rotation.transpose() * (centre - pose.position);
  return std::visit([&](const auto& shape) { return is_near(shape, body, reach); }, wall.shape);
}

bool inside_material(const Wall& wall, const WallPose& pose, const Vec3& x) {
  const Vec3 body = pose.rotation.transpose() * (x - pose.position);
  return std::visit([&](const auto& shape) { return fills(shape, body); }, wall.shape);
}

void nearest(const Wall& wall, const WallPose& pose, const Vec3& centre, double reach,
             std::span<const std::uint32_t> parts, std::vector<WallTouch>& out, std::vector<MeshTouch>& scratch) {
  out.clear();
  const Vec3 body = pose.rotation.transpose() * (centre - pose.position);
  std::visit(
      [&](const auto& shape) {
        visit_touches(shape, body, reach, parts, scratch, [&](WallTouch touch) {
          touch.normal = pose.rotation * touch.normal;
          touch.point = centre + touch.distance * touch.normal;
          out.push_back(touch);
        });
      },
      wall.shape);
}

}  // namespace dem
