#include "libdem/geometry/walls.hpp"

#include <cmath>
#include <numbers>

namespace dem {
namespace {

struct Local {
  const WallPose& pose;
  Vec3 to_body(const Vec3& x) const { return pose.rotation.transpose() * (x - pose.position); }
};

void nearest_of(const Plane& plane, const WallPose& pose, const Vec3& centre, double reach,
                std::vector<WallTouch>& out) {
  const Vec3 normal = pose.rotation * plane.normal;
  const double distance = (centre - pose.position - pose.rotation * plane.point).dot(normal);
  if (distance <= reach) out.push_back({0, 0, MeshFeature::face, centre - distance * normal, -normal, distance});
}

void nearest_of(const CylinderInside& cylinder, const WallPose& pose, const Vec3& centre, double reach,
                std::vector<WallTouch>& out) {
  const Vec3 axis = pose.rotation * cylinder.axis;
  const Vec3 from_axis = centre - pose.position - pose.rotation * cylinder.point;
  const Vec3 radial = from_axis - from_axis.dot(axis) * axis;
  const double r2 = radial.squaredNorm(), inner = cylinder.radius - reach;
  if (inner > 0 && r2 < inner * inner) return;
  const double r = std::sqrt(r2);
  if (r == 0) return;  // on the axis every direction is as near: no contact can be there
  const Vec3 normal = radial / r;
  const double distance = cylinder.radius - r;
  out.push_back({0, 0, MeshFeature::face, centre + distance * normal, normal, distance});
}

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

}  // namespace

MeshWall make_mesh_wall(TriangleMesh mesh) {
  double reach = 0;
  for (const Vec3& v : mesh.vertices) reach = std::max(reach, v.norm());
  return {std::make_shared<const MeshContactFinder>(std::move(mesh)), reach};
}

WallPose pose_at(const WallMotion& motion, double time) {
  WallPose pose;
  pose.position = motion.start + motion.velocity * time;
  pose.velocity = motion.velocity;
  pose.angular_velocity = motion.angular_velocity;
  const double spin = motion.angular_velocity.norm();
  if (spin > 0) {
    pose.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(spin * time, motion.angular_velocity / spin));
    pose.rotation = pose.orientation.toRotationMatrix();
  }
  return pose;
}

double largest_speed(const Wall& wall) {
  const auto* mesh = std::get_if<MeshWall>(&wall.shape);
  return wall.motion.velocity.norm() + wall.motion.angular_velocity.norm() * (mesh ? mesh->reach : 0.0);
}

void candidate_triangles(const Wall& wall, const WallPose& pose, const Vec3& centre, double reach,
                         std::vector<std::uint32_t>& out) {
  if (const auto* mesh = std::get_if<MeshWall>(&wall.shape))
    mesh->finder->candidate_triangles(Local{pose}.to_body(centre), reach, out);
}

bool near(const Wall& wall, const WallPose& pose, const Vec3& centre, double reach) {
  if (const auto* mesh = std::get_if<MeshWall>(&wall.shape)) {
    const double far = mesh->reach + reach;
    return (centre - pose.position).squaredNorm() <= far * far;
  }
  std::vector<WallTouch> touches;
  std::vector<MeshTouch> scratch;
  nearest(wall, pose, centre, reach, {}, touches, scratch);
  return !touches.empty();
}

bool inside_material(const Wall& wall, const WallPose& pose, const Vec3& x) {
  const Vec3 body = Local{pose}.to_body(x);
  if (const auto* plane = std::get_if<Plane>(&wall.shape)) return (body - plane->point).dot(plane->normal) < 0;
  if (const auto* cylinder = std::get_if<CylinderInside>(&wall.shape)) {
    const Vec3 from_axis = body - cylinder->point;
    return (from_axis - from_axis.dot(cylinder->axis) * cylinder->axis).norm() > cylinder->radius;
  }
  const auto& mesh = std::get<MeshWall>(wall.shape);
  return body.norm() <= mesh.reach && winding_number(mesh.finder->mesh(), body) > 0.5;
}

void nearest(const Wall& wall, const WallPose& pose, const Vec3& centre, double reach,
             std::span<const std::uint32_t> triangles, std::vector<WallTouch>& out, std::vector<MeshTouch>& scratch) {
  out.clear();
  if (const auto* plane = std::get_if<Plane>(&wall.shape)) {
    nearest_of(*plane, pose, centre, reach, out);
  } else if (const auto* cylinder = std::get_if<CylinderInside>(&wall.shape)) {
    nearest_of(*cylinder, pose, centre, reach, out);
  } else {
    const auto& mesh = std::get<MeshWall>(wall.shape);
    mesh.finder->touches(Local{pose}.to_body(centre), reach, triangles, scratch);
    for (const MeshTouch& t : scratch) {
      const std::uint64_t feature = (std::uint64_t(t.feature) << 32) | t.feature_id;
      const Vec3 normal = pose.rotation * t.normal;
      out.push_back({feature, t.facet, t.feature, centre + t.distance * normal, normal, t.distance});
    }
  }
}

}  // namespace dem
