// The walls: shapes, how they move, and where a sphere touches them.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "libdem/geometry/mesh_contact.hpp"
#include "libdem/geometry/sphere_set.hpp"
#include "libdem/geometry/wall_motion.hpp"

namespace dem {

// One place where a sphere is near a wall, laboratory frame.
struct WallTouch {
  std::uint64_t feature;  // names the touched part of the wall, for contact history; each shape says how
  std::uint32_t facet;    // triangle of a mesh, sphere of glued grains, else 0
  MeshFeature kind;       // face, edge (rim) or vertex (apex of a cone)
  Vec3 point;             // m, nearest point of the wall
  Vec3 normal;            // unit, from the sphere's centre to the wall
  double distance;        // m, from the sphere's centre to the wall; < 0 when the centre is inside a solid wall
  // 1/m, the wall's principal curvatures at `point`, > 0 where it is hollow towards the sphere. Edges, rims, vertices
  // and meshes count as flat.
  std::array<double, 2> curvature;
};

// Which side of a surface of revolution grains are meant to be on.
enum class FreeSide : std::uint8_t { inside, outside };

// A half space is free where (x - point) . normal > 0. Feature: 0.
struct Plane {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  // unit, into the free side
};

// A circular cylinder about an axis. Infinite at both ends (the default) it bounds a solid: distances from inside the
// material are negative. With an end it is a thin sheet that touches from either side and over its rim, see
// revolved_segment.hpp; `free` then only says which side inside_material() takes for filled. Features: 0 face, 1 rim at
// `low`, 2 rim at `high`. Where a rim coincides with that of another wall a sphere on it touches both; rims that jut
// out should belong to one wall.
struct Cylinder {
  Vec3 point = Vec3::Zero();
  Vec3 axis = Vec3::UnitZ();  // unit
  double radius = 0;          // m
  FreeSide free = FreeSide::inside;
  double low = -std::numeric_limits<double>::infinity();  // m along the axis from `point`
  double high = std::numeric_limits<double>::infinity();
};

// A frustum of a cone, open at both ends: a thin sheet like a finite cylinder. Features as there.
struct Cone {
  Vec3 point = Vec3::Zero();               // centre of the low end
  Vec3 axis = Vec3::UnitZ();               // unit, from the low to the high end
  double low_radius = 0, high_radius = 0;  // m; one may be 0
  double length = 0;                       // m, along the axis
  FreeSide free = FreeSide::inside;
};

// A flat circular sheet, with a round hole if hole_radius > 0; touches from either side. Features: 0 face, 1 rim of the
// hole, 2 outer rim.
struct Disc {
  Vec3 point = Vec3::Zero();           // centre
  Vec3 normal = Vec3::UnitZ();         // unit
  double radius = 0, hole_radius = 0;  // m
};

// A rigid body made of spheres, for rough plates. Feature: number of the sphere. Each sphere within reach is a touch.
struct GluedGrains {
  std::shared_ptr<const SphereSet> spheres;  // body frame
};
// Throws CaseError, see SphereSet.
GluedGrains make_glued_grains(std::vector<Vec3> centres, std::vector<double> radii);

// Feature: (kind << 32) | number of the triangle, edge or vertex.
struct MeshWall {
  std::shared_ptr<const MeshContactFinder> finder;  // body frame
  Eigen::AlignedBox3d box;                          // m, around its vertices, body frame
};
MeshWall make_mesh_wall(TriangleMesh mesh);

// TABLE of the shapes. To add one: a struct in this header (or its own), a row here, and its overloads in walls.cpp
// (the compiler names those that are missing); wall_shapes_test.cpp runs over the rows.
using WallShape = std::variant<Plane, Cylinder, Cone, Disc, GluedGrains, MeshWall>;

struct Wall {
  std::string name;
  std::size_t material = 0;
  WallShape shape;
  WallMotion motion;
};

// Throws CaseError, naming the wall: numbers that are not finite, axes that are not of unit length (to 1e-9), radii and
// lengths that are not > 0, ends and holes the wrong way round, missing parts; and see validate_motion, largest_speed.
void validate_wall(const Wall& wall);

// m/s, upper bound of the speed at which the surface moves, at any place and time. What maps a surface on itself does
// not move it: spin of a surface of revolution about its own axis, and for planes and infinite cylinders motion along
// themselves. Throws CaseError for planes and infinite cylinders that turn about any other direction (to 1e-9 rad), as
// their far parts then move at any speed. Meshes: goes through the vertices, once for each row of a table of poses.
double largest_speed(const Wall& wall);

// Parts (triangles of a mesh, glued grains) within `reach` of the point, ascending; none for shapes without parts.
// Appends.
void candidate_parts(const Wall& wall, const WallPose& pose, const Vec3& centre, double reach,
                     std::vector<std::uint32_t>& out);

// Those of `parts` that are within `reach` of the point (a superset is allowed), in their order: written to `out`, which has room for all.
// Returns how many.
std::size_t parts_within(const Wall& wall, const WallPose& pose, const Vec3& centre, double reach, std::span<const std::uint32_t> parts,
                         std::span<std::uint32_t> out);

// Is the wall within `reach` of the point? May say yes too often for meshes (their candidate parts decide).
bool near(const Wall& wall, const WallPose& pose, const Vec3& centre, double reach);

// Is the point inside the wall's material, where no grain may be put? Sheets of revolution count as filled on the side
// that is not free, between the planes of their ends; discs have no material. For meshes by the winding number, the sum
// of solid angles of all triangles (van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30 (1983) 125): exact for
// closed surfaces, costs a pass over the mesh.
bool inside_material(const Wall& wall, const WallPose& pose, const Vec3& x);

// Touches within `reach`, replacing `out`. `parts` are the candidate parts. `scratch` is working space of the caller.
void nearest(const Wall& wall, const WallPose& pose, const Vec3& centre, double reach,
             std::span<const std::uint32_t> parts, std::vector<WallTouch>& out, std::vector<MeshTouch>& scratch);

}  // namespace dem
