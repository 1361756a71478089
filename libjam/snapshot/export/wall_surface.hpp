// Walls of any kind as triangles, for drawing.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "libjam/snapshot/snapshot.hpp"

namespace jam {

struct WallSurface {
  std::vector<Vec3> vertices;                           // m, body frame
  std::vector<std::array<std::uint32_t, 3>> triangles;  // rows of `vertices`
  std::vector<std::uint32_t> facet;                     // per triangle: what a contact calls `facet`
};

// A mesh as it is; an analytic wall in facets: cylinders and cones as tubes of 96 strips, discs as rings of as many, glued
// spheres as icosahedra. What has no end is cut a little outside of `shown` (m, body frame). Empty for a mesh without triangles.
WallSurface surface_of(const Wall& wall, const Eigen::AlignedBox3d& shown);

}  // namespace jam
