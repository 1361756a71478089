// The planes by which the walls bound the space around a particle.
//
// Each wall gives the plane through its point nearest to the particle's centre, at right angles to the line between the two; then the
// same for further points of it that the planes so far leave in sight, nearest first: of a mesh the nearest point of each triangle, of
// the inside of a cylinder or cone a tangent plane every two degrees. Plane walls, and flat parts of meshes, are bounded exactly; the
// inside of a cylinder of radius R within R (2 degrees)^2 / 8 = 1.5e-4 R; beside the edge of a blade the plane leans on the edge.
#pragma once
#include <memory>
#include <vector>

#include "libjam/snapshot/snapshot.hpp"

namespace jam {

// Keeps the points x with normal . (x - centre of the particle) <= distance.
struct BoundingPlane {
  Vec3 normal;      // unit, to the wall
  double distance;  // m
};

class WallPlanes {
 public:
  // `state` has one entry per wall.
  WallPlanes(const std::vector<Wall>& walls, const std::vector<WallState>& state);
  ~WallPlanes();

  // Appends those nearer than `reach` m. May be called from several threads.
  void around(const Vec3& centre, double reach, std::vector<BoundingPlane>& planes) const;

 private:
  struct Mesh;
  std::vector<Wall> walls_;
  std::vector<WallState> state_;
  std::vector<std::unique_ptr<const Mesh>> mesh_;  // of each wall, null where it is none
};

}  // namespace jam
