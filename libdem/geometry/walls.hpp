// The walls: shapes, how they move, and where a sphere touches them.
#pragma once
#include <Eigen/Geometry>
#include <string>
#include <variant>
#include <vector>

#include "libdem/geometry/mesh_contact.hpp"

namespace dem {

// One place where a sphere is near a wall, laboratory frame.
struct WallTouch {
  std::uint64_t feature;  // names the part of the wall, for contact history; 0 for analytic walls
  std::uint32_t facet;    // triangle of a mesh, else 0
  MeshFeature kind;
  Vec3 point;             // m, nearest point of the wall
  Vec3 normal;            // unit, from the sphere's centre to the wall
  double distance;        // m, from the sphere's centre to the wall; < 0 when the centre is beyond it
};

// A half space is free where (x - point) . normal > 0.
struct Plane {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  // unit, into the free side
};

// The inside of a cylinder about an axis. Contacts count as flat (EDEM's meshes are; physics reference 1.5).
struct CylinderInside {
  Vec3 point = Vec3::Zero();
  Vec3 axis = Vec3::UnitZ();  // unit
  double radius = 0;          // m
};

struct MeshWall {
  std::shared_ptr<const MeshContactFinder> finder;  // body frame
  double reach = 0;  // m, largest distance of a vertex from the body frame's origin
};
MeshWall make_mesh_wall(TriangleMesh mesh);

// TABLE of the shapes. To add one: a struct in this header (or its own), a row here, and overloads of nearest() and
// near() in walls.cpp; walls_test.cpp runs over the rows.
using WallShape = std::variant<Plane, CylinderInside, MeshWall>;

// Constant velocity and angular velocity from step 0 on, about a pose.
struct WallMotion {
  Vec3 start = Vec3::Zero();             // m, of the body frame's origin at t = 0
  Vec3 velocity = Vec3::Zero();          // m/s
  Vec3 angular_velocity = Vec3::Zero();  // rad/s
};

struct Wall {
  std::string name;
  std::size_t material = 0;
  WallShape shape;
  WallMotion motion;
};

struct WallPose {
  Vec3 position = Vec3::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  // of `orientation`
};
WallPose pose_at(const WallMotion& motion, double time);

// m/s, upper bound of the speed of any point of the wall.
double largest_speed(const Wall& wall);

// Triangles of a mesh within `reach` of the point, ascending; empty for analytic walls. Appends.
void candidate_triangles(const Wall& wall, const WallPose& pose, const Vec3& centre, double reach,
                         std::vector<std::uint32_t>& out);

// Is the wall within `reach` of the point? May say yes too often for meshes (their candidate triangles decide).
bool near(const Wall& wall, const WallPose& pose, const Vec3& centre, double reach);

// Is the point inside the wall's material? For meshes by the winding number, the sum of solid angles of all triangles (van
// Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30 (1983) 125): exact for closed surfaces, costs a pass over the mesh.
bool inside_material(const Wall& wall, const WallPose& pose, const Vec3& x);

// Touches within `reach`, replacing `out`. `scratch` is working space of the caller.
void nearest(const Wall& wall, const WallPose& pose, const Vec3& centre, double reach,
             std::span<const std::uint32_t> triangles, std::vector<WallTouch>& out, std::vector<MeshTouch>& scratch);

}  // namespace dem
