#include "libdem/rheometer/rheometer.hpp"

#include <cmath>

#include "libdem/geometry/blade_surface.hpp"

namespace dem {

Rheometer make_rheometer(const Case& c) {
  BladeSurface surface = blade_surface(c);
  const BladeExtent& extent = surface.extent;

  Rheometer rheometer;
  rheometer.tip_radius = extent.tip_radius;
  rheometer.blade_low = extent.z_low;
  rheometer.blade_high = extent.z_high;

  const double vessel_radius = 0.5 * c.vessel.diameter, largest = 0.5 * c.bed.size_high * c.bed.mean_diameter;
  const double turn = c.motion.clockwise ? -1 : 1;
  WallMotion motion;
  motion.start = Vec3(0, 0, c.blade.start_height - extent.z_low);
  motion.velocity = Vec3(0, 0, c.motion.tip_speed * std::sin(c.motion.helix_angle));
  motion.angular_velocity =
      Vec3(0, 0, turn * c.motion.tip_speed * std::cos(c.motion.helix_angle) / extent.tip_radius);

  Setup& setup = rheometer.setup;
  setup.materials = c.materials;
  setup.interactions = c.interactions;
  setup.law = choose_law(c.contact);
  setup.wall_curvature = c.contact.wall_curvature;
  setup.keep_ledger = c.output.energy_ledger;
  setup.gravity = c.gravity;
  setup.step = c.step;
  const std::size_t vessel = material_index(c, c.vessel.material), blade = material_index(c, c.blade.material);
  setup.walls = {
      Wall{"floor", vessel, Plane{Vec3::Zero(), Vec3::UnitZ()}, {}},
      Wall{"cylinder", vessel, Cylinder{Vec3::Zero(), Vec3::UnitZ(), vessel_radius}, {}},
      Wall{"blade", blade, make_mesh_wall(std::move(surface.mesh)), motion},
  };
  // Centres stay inside the vessel; above the bed there is room to be thrown.
  setup.low = Vec3(-vessel_radius, -vessel_radius, 0);
  setup.high = Vec3(vessel_radius, vessel_radius, 4 * c.bed.depth + 100 * largest);
  return rheometer;
}

}  // namespace dem
