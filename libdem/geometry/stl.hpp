// STL files: triangles without topology or units, as every CAD program writes them.
#pragma once
#include <cstddef>
#include <string>

#include "libdem/geometry/mesh.hpp"

namespace dem {

struct StlMesh {
  TriangleMesh mesh;                     // labels: face
  bool binary = false;                   // the file was binary
  std::size_t facets = 0;                // in the file
  std::size_t degenerate_triangles = 0;  // dropped: no area once equal vertices are merged
  std::size_t repeated_triangles = 0;    // dropped: on the same three vertices as an earlier one
};

// Reads an ASCII or binary STL file; `scale` in m per file unit. A file is binary if its size is what the facet count
// at byte 80 says (many binary files begin with "solid"), else ASCII if it begins with "solid". Several solids in an
// ASCII file become one mesh. The normals in the file are ignored: the order of a facet's vertices tells its outside.
// Vertices that differ by no more than the resolution of the 32-bit numbers of a binary file (1.2e-7 of the largest
// coordinate) are made one. The mesh is not checked further: see validate_mesh.
//
// Throws GeometryError naming the file and the line (ASCII) or facet (binary), the value found and what was expected: a
// file that cannot be read, is cut short, has bytes or words that do not belong there, no facets, more than 10 million
// of them, or coordinates that are not finite or beyond 1 km. Memory use is bounded by the size of the file, at most 4
// GB.
StlMesh read_stl(const std::string& path, double scale = 1);

// Writes a binary STL file in m (labels are lost, coordinates rounded to 32 bits). Throws GeometryError naming the file
// if it cannot be written.
void write_stl(const TriangleMesh& mesh, const std::string& path);

}  // namespace dem
