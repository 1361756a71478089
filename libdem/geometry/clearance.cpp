#include "libdem/geometry/clearance.hpp"

#include <cmath>
#include <limits>
#include <sstream>

#include "libdem/errors.hpp"

namespace dem {

Clearance blade_clearance(const TriangleMesh& mesh, double vessel_radius, const AxialPath& path) {
  if (mesh.triangles.empty()) throw GeometryError("blade: the mesh has no triangles");
  if (!(vessel_radius > 0) || !std::isfinite(vessel_radius) || !std::isfinite(path.start) ||
      !std::isfinite(path.velocity) || !(path.duration >= 0) || !std::isfinite(path.duration)) {
    std::ostringstream s;
    s << "blade: vessel radius " << vessel_radius << " m, start height " << path.start << " m, velocity "
      << path.velocity << " m/s, duration " << path.duration
      << " s; expected finite numbers, the first positive, the last not negative";
    throw GeometryError(s.str());
  }
  std::uint32_t widest = mesh.triangles[0][0], lowest = widest;
  const auto radius = [&](std::uint32_t v) { return std::hypot(mesh.vertices[v].x(), mesh.vertices[v].y()); };
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) {
      if (!mesh.vertices[v].allFinite())
        throw GeometryError("blade: vertex " + std::to_string(v) + " has a coordinate that is not finite");
      if (radius(v) > radius(widest) || (radius(v) == radius(widest) && v < widest)) widest = v;
      const double z = mesh.vertices[v].z(), z_low = mesh.vertices[lowest].z();
      if (z < z_low || (z == z_low && v < lowest)) lowest = v;
    }
  const double time = path.velocity < 0 ? path.duration : 0;
  return {vessel_radius - radius(widest), mesh.vertices[widest],
          path.start + path.velocity * time + mesh.vertices[lowest].z(), mesh.vertices[lowest], time};
}

void require_clearance(const Clearance& c, double vessel_radius) {
  std::ostringstream s;
  const auto point = [&](const Vec3& p) {
    s << "its point (" << p.x() << ", " << p.y() << ", " << p.z() << ") m (body frame)";
  };
  if (!(c.radial > 0)) {
    s << "blade: from t = 0 s on ";
    point(c.radial_point);
    s << " is " << vessel_radius - c.radial << " m from the axis, " << -c.radial
      << " m into the wall of the vessel of radius " << vessel_radius << " m; expected a smaller tip radius";
    throw GeometryError(s.str());
  }
  if (!(c.floor > 0)) {
    s << "blade: at t = " << c.floor_time << " s ";
    point(c.floor_point);
    s << " is " << -c.floor
      << " m below the floor of the vessel; expected a higher start, a slower descent or a shorter run";
    throw GeometryError(s.str());
  }
}

}  // namespace dem
