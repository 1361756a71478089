// Small scenes of grains for the tests of libdem.
#pragma once
#include <random>

#include "libdem/simulation/simulation.hpp"

namespace support {

// Glass and interaction of the paper's case A.
inline dem::Setup glass_setup(double step = 5e-8) {
  dem::Setup setup;
  setup.materials = {{"glass", 2500, 63e9, 0.2}};
  setup.interactions = {{{0.9, 0.5, 0.01, 0.274}}};
  setup.step = step;
  return setup;
}

// A cloud of grains that hit each other: n grains in a cube, random velocities and spins.
inline dem::Particles cloud(std::size_t n, double edge, double speed, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto draw = [&](double low, double high) { return low + (high - low) * double(random() >> 11) * 0x1.0p-53; };
  const auto vector = [&](double size) { return dem::Vec3(draw(-size, size), draw(-size, size), draw(-size, size)); };
  dem::Particles grains;
  while (grains.size() < n) {
    const double radius = draw(0.37e-3, 0.555e-3);
    const dem::Vec3 x = vector(0.5 * edge);
    bool free = true;
    for (std::size_t k = 0; k < grains.size() && free; ++k)
      free = (grains.position[k] - x).norm() > grains.radius[k] + radius;
    if (free)
      grains.add(std::uint32_t(grains.size() + 1), 0, radius, x, vector(speed) - speed / (0.5 * edge) * x,
                 vector(speed / radius));
  }
  return grains;
}

// side^3 equal grains on a cubic lattice around the origin, pressed together by `overlap`, with random velocities: as busy
// as a packing.
inline dem::Particles packed_cube(int side, double overlap, double speed, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto draw = [&] { return 2 * double(random() >> 11) * 0x1.0p-53 - 1; };
  const double radius = 0.4625e-3, spacing = 2 * radius - overlap;
  dem::Particles grains;
  for (int x = 0; x < side; ++x)
    for (int y = 0; y < side; ++y)
      for (int z = 0; z < side; ++z) {
        const dem::Vec3 place = spacing * (dem::Vec3(x, y, z) - dem::Vec3::Constant(0.5 * (side - 1)));
        grains.add(std::uint32_t(grains.size() + 1), 0, radius, place, speed * dem::Vec3(draw(), draw(), draw()),
                   speed / radius * dem::Vec3(draw(), draw(), draw()));
      }
  return grains;
}

}  // namespace support
