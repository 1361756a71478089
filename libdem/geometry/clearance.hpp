// Does the blade stay clear of the vessel during its motion?
#pragma once
#include "libdem/geometry/mesh.hpp"

namespace dem {

// Where the body goes: it turns about the z axis, which is its own and the vessel's, and its origin moves along it.
struct AxialPath {
  double start = 0;     // m, z of the body's origin at t = 0; the vessel's floor is z = 0
  double velocity = 0;  // m/s, along z
  double duration = 0;  // s
};

struct Clearance {
  double radial =
      0;  // m, vessel radius - largest distance of the body from the axis; constant, as the body turns about it
  Vec3 radial_point;  // the vertex there, body frame
  double floor = 0;   // m, smallest height of the body above the floor
  Vec3 floor_point;   // the vertex there, body frame
  double floor_time;  // s, when
};

// Both extremes are reached in vertices, so this is exact for the mesh. The vessel is open above. Where vertices tie,
// the one with the smallest number is given. Throws GeometryError for a mesh without triangles and numbers that are not
// finite.
Clearance blade_clearance(const TriangleMesh& mesh, double vessel_radius, const AxialPath& path);

// Throws GeometryError, with the point, the time and by how much, if the body touches the wall or the floor.
void require_clearance(const Clearance& clearance, double vessel_radius);

}  // namespace dem
