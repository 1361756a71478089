// What CGAL's polygon mesh processing does for us; no CGAL type gets out.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "libdem/geometry/mesh.hpp"

namespace dem {

// The surface of the union of two solids, each a closed, outward-oriented mesh without self-intersections. Triangles
// keep the label of the surface they are part of. Vertices are sorted by (x, y, z), triangles by their vertices, so
// that the result does not depend on the order of CGAL's containers. Throws GeometryError if the union is no manifold.
TriangleMesh mesh_union(const TriangleMesh& a, const TriangleMesh& b);

// Pairs of triangles that cross or overlap other than in a shared edge or vertex, ascending. Exact predicates. The mesh
// must be closed and manifold.
std::vector<std::array<std::uint32_t, 2>> self_intersections(const TriangleMesh& mesh);

// Turns triangles round until neighbours agree; returns the turned triangles, ascending. Which side of a component is
// outside is left as the majority of its triangles had it. Where more than two triangles meet in an edge, the vertices
// are split, so that the result is manifold but perhaps open.
std::vector<std::uint32_t> orient_consistently(TriangleMesh& mesh);

}  // namespace dem
