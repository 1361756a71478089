// Is a mesh the surface of a solid body? The gate through which every blade passes.
#pragma once
#include <cstddef>
#include <string>

#include "libdem/geometry/mesh.hpp"

namespace dem {

// Checks, in this order: 4 to 10 million triangles, one label each (or no labels); vertex numbers in range; coordinates
// finite and within 1 km of the origin; no degenerate triangle (repeated vertex, or height below 1e-9 of its longest
// side); every edge in exactly two triangles that run through it in opposite directions (closed, manifold, consistently
// oriented); one fan of triangles around each vertex; positive volume of each component (normals point outward); no two
// triangles that cross or overlap. Throws GeometryError naming `name`, the triangles and their coordinates, and what
// was expected.
void validate_mesh(const TriangleMesh& mesh, const std::string& name);

struct MeshRepair {
  TriangleMesh mesh;
  std::size_t merged_vertices = 0;       // equal to another one within the tolerance
  std::size_t degenerate_triangles = 0;  // dropped
  std::size_t repeated_triangles = 0;    // dropped, on the same three vertices as an earlier one
  std::size_t turned_triangles = 0;      // orientation reversed
  std::size_t unused_vertices = 0;       // dropped
};

// Vertices in a cluster no wider than merge_distance (m; 0: equal ones only) are made one; triangles without area (see
// above), repeated triangles and unused vertices are dropped. Throws GeometryError for vertex numbers out of range or
// coordinates that are not finite.
MeshRepair weld_mesh(const TriangleMesh& mesh, double merge_distance = 0);

// Mends what has one obvious mending: weld_mesh, then triangles are turned round until neighbours agree and each
// component encloses a positive volume. Holes and crossings are left for validate_mesh to report.
MeshRepair repair_mesh(const TriangleMesh& mesh, double merge_distance = 0);

}  // namespace dem
