// A triangulated closed surface in its body frame.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace dem {

using Vec3 = Eigen::Vector3d;

// What part of a blade a triangle belongs to; recorded with its contacts.
enum class FacetLabel : std::uint8_t { face = 0, edge = 1, tip = 2, hub = 3 };
inline constexpr std::size_t facet_labels = 4;

struct TriangleMesh {
  std::vector<Vec3> vertices;                           // m
  std::vector<std::array<std::uint32_t, 3>> triangles;  // rows of vertices, counter-clockwise seen from outside
  std::vector<FacetLabel> labels;                       // per triangle
};

}  // namespace dem
