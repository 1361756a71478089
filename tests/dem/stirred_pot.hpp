// A pot of grains that a paddle stirs: collisions, sliding, rolling, necks, a mesh, walls at rest and in motion.
#pragma once
#include "libdem/geometry/twisted_blade.hpp"
#include "tests/dem/grains.hpp"

namespace support {

// A pot of grains over a floor in which a paddle turns and sinks.
inline dem::Setup stirred_pot(const dem::ContactModel& model = {}) {
  dem::Setup setup = glass_setup(5e-8);
  setup.law = dem::choose_law(model);
  setup.keep_ledger = true;
  dem::TwistedBlade paddle;
  paddle.diameter = 6.2e-3;
  paddle.height = 2e-3;
  paddle.thickness = 1e-3;
  paddle.shaft_diameter = 1.5e-3;
  paddle.shaft_length = 4e-3;
  setup.walls = {dem::Wall{"floor", 0, dem::Plane{dem::Vec3(0, 0, -2.775e-3), dem::Vec3::UnitZ()}, {}},
                 dem::Wall{"paddle", 0, dem::make_mesh_wall(dem::make_twisted_blade(paddle)),
                      {dem::Vec3(0, 0, 2e-3), dem::Vec3(0, 0, -0.3), dem::Vec3(0, 0, 80)}}};
  for (int axis = 0; axis < 2; ++axis)
    for (double side : {-1.0, 1.0}) {
      dem::Vec3 normal = dem::Vec3::Zero();
      normal[axis] = -side;
      setup.walls.push_back(dem::Wall{"side", 0, dem::Plane{-3.6e-3 * normal, normal}, {}});
    }
  return setup;
}

inline dem::Particles grains_below_the_paddle() {
  dem::Particles all = packed_cube(6, 5e-7, 0.05, 21), kept;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all.position[i].z() < 1.2e-3)
      kept.add(std::uint32_t(kept.size() + 1), 0, all.radius[i], all.position[i], all.velocity[i], all.angular_velocity[i]);
  return kept;
}

}  // namespace support
