#include "libdem/scene/scene.hpp"

#include <cmath>
#include <set>

#include "libdem/errors.hpp"
#include "libdem/geometry/blade_surface.hpp"

namespace dem {
namespace {

void add_rheometer(const Case& c, Scene& scene) {
  BladeSurface surface = blade_surface(c);
  const BladeExtent& extent = surface.extent;
  const double vessel_radius = 0.5 * c.vessel.diameter;
  scene.gap = RheometerGap{extent.tip_radius, vessel_radius, extent.z_low, extent.z_high};

  const double turn = c.motion.clockwise ? -1 : 1;
  WallMotion motion;
  motion.start = Vec3(0, 0, c.blade.start_height - extent.z_low);
  motion.velocity = Vec3(0, 0, c.motion.tip_speed * std::sin(c.motion.helix_angle));
  motion.angular_velocity =
      Vec3(0, 0, turn * c.motion.tip_speed * std::cos(c.motion.helix_angle) / extent.tip_radius);

  Setup& setup = scene.setup;
  const std::size_t vessel = material_index(c, c.vessel.material), blade = material_index(c, c.blade.material);
  setup.walls = {
      Wall{"floor", vessel, Plane{Vec3::Zero(), Vec3::UnitZ()}, {}},
      Wall{"cylinder", vessel, Cylinder{Vec3::Zero(), Vec3::UnitZ(), vessel_radius}, {}},
      Wall{"blade", blade, make_mesh_wall(std::move(surface.mesh)), motion},
  };
  scene.roles = {WallRole::vessel, WallRole::vessel, WallRole::blade};
  // Centres stay inside the vessel, which is open: a jam that lets go shoots grains upward, at 15 m/s in the study's test A with tips cut
  // flat. Where they are as high as a throw at a hundred would take them something else is wrong.
  constexpr double fastest_throw = 100;  // m/s
  setup.low = Vec3(-vessel_radius, -vessel_radius, 0);
  setup.high = Vec3(vessel_radius, vessel_radius, 4 * c.bed.depth + 0.5 * fastest_throw * fastest_throw / c.gravity.norm());
}

}  // namespace

Scene make_scene(const Case& c, std::vector<SceneWall> walls) {
  Scene scene;
  Setup& setup = scene.setup;
  setup.materials = c.materials;
  setup.interactions = c.interactions;
  setup.law = choose_law(c.contact);
  setup.wall_curvature = c.contact.wall_curvature;
  setup.keep_ledger = c.output.energy_ledger;
  setup.gravity = c.gravity;
  setup.step = c.step;
  setup.levels = c.levels;
  setup.accuracy = c.accuracy;
  setup.low = c.domain_low;
  setup.high = c.domain_high;
  if (c.rheometer) add_rheometer(c, scene);
  scene.region = bed_region(c);
  for (SceneWall& w : walls) {
    setup.walls.push_back(std::move(w.wall));
    scene.roles.push_back(w.role);
  }
  std::set<std::string> names;
  for (const Wall& w : setup.walls) {
    if (!names.insert(w.name).second) throw CaseError("two walls are called '" + w.name + "'");
    validate_wall(w);
  }
  if (setup.walls.empty()) throw CaseError("the case has no walls");
  return scene;
}

}  // namespace dem
