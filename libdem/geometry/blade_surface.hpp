// The blade of a case as a surface that may be simulated, whether generated or read from a file.
#pragma once
#include "libdem/case/case.hpp"
#include "libdem/geometry/clearance.hpp"
#include "libdem/geometry/mesh.hpp"
#include "libdem/geometry/twisted_blade.hpp"

namespace dem {

struct BladeSurface {
  TriangleMesh mesh;    // validated, body frame
  BladeExtent extent;   // measured
  Clearance clearance;  // positive, over the whole motion
};

// Generates the mesh, or reads it and labels its tips; validates it; requires it to stay clear of wall and floor from t
// = 0 to the duration. The body's origin starts at start_height - extent.z_low. Throws GeometryError.
BladeSurface blade_surface(const Case& c);

}  // namespace dem
