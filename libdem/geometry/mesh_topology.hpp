// Which triangles of a mesh share an edge.
#pragma once
#include <cstdint>
#include <vector>

#include "libdem/geometry/mesh.hpp"

namespace dem {

// One side of one triangle. `forward`: the triangle runs from `low` to `high`, its neighbour must run the other way.
struct HalfEdge {
  std::uint32_t low, high;  // vertices, low < high
  std::uint32_t facet;
  std::uint8_t side;  // the side from corner `side` to corner (side + 1) % 3
  bool forward;
};

// All 3 T half edges, sorted by (low, high, facet, side), so that the sides that meet in an edge stand next to each
// other.
std::vector<HalfEdge> sorted_half_edges(const TriangleMesh& mesh);

// An edge of a closed mesh, numbered by its place in the list of unique_edges.
struct MeshEdge {
  std::array<std::uint32_t, 2> vertices;  // ascending
  std::array<std::uint32_t, 2> facets;    // ascending
  std::array<std::uint8_t, 2> sides;      // the side of each of the two facets
};

// The edges, sorted by `vertices`. Throws GeometryError where an edge does not belong to exactly two triangles.
std::vector<MeshEdge> unique_edges(const TriangleMesh& mesh);

}  // namespace dem
