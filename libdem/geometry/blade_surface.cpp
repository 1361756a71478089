#include "libdem/geometry/blade_surface.hpp"

#include <cmath>

#include "libdem/geometry/stl.hpp"
#include "libdem/geometry/validate_mesh.hpp"

namespace dem {

BladeSurface blade_surface(const Case& c) {
  BladeSurface blade;
  std::string name = "blade";
  if (const auto* const twisted = std::get_if<TwistedBlade>(&c.blade.shape)) {
    blade.mesh = make_twisted_blade(*twisted);
  } else {
    const MeshFile& file = std::get<MeshFile>(c.blade.shape);
    name = file.path;
    blade.mesh = read_stl(file.path, file.scale).mesh;
    label_tips(blade.mesh);
  }
  validate_mesh(blade.mesh, name);
  blade.extent = blade_extent(blade.mesh);
  AxialPath path;
  path.start = c.blade.start_height - blade.extent.z_low;
  path.velocity = c.motion.tip_speed * std::sin(c.motion.helix_angle);
  path.duration = c.duration;
  const double vessel_radius = c.vessel.diameter / 2;
  blade.clearance = blade_clearance(blade.mesh, vessel_radius, path);
  require_clearance(blade.clearance, vessel_radius);
  return blade;
}

}  // namespace dem
