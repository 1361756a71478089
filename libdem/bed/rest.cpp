#include "libdem/bed/rest.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libdem/bed/packing.hpp"

namespace dem {

RestProbe probe_rest(const Setup& setup, State state) {
  RestProbe probe;
  const std::size_t n = state.particles.size();
  probe.grains = n;
  if (n == 0) {
    probe.rest_scale = std::numeric_limits<double>::min();
    return probe;
  }
  const double gravity = setup.gravity.norm();
  double diameter = 0, weight_times_diameter = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double radius = state.particles.radius[i];
    diameter += 2 * radius / double(n);
    weight_times_diameter +=
        setup.materials[state.particles.material[i]].density * sphere_volume(radius) * gravity * 2 * radius;
  }
  probe.rest_scale = 1e-5 * weight_times_diameter;
  const std::uint64_t steps = std::uint64_t(std::ceil(std::sqrt(2e-3 * diameter / gravity) / setup.step));
  probe.interval = double(steps) * setup.step;
  probe.free_fall = 0.5 * gravity * probe.interval * probe.interval;

  for (Vec3& v : state.particles.velocity) v.setZero();
  for (Vec3& w : state.particles.angular_velocity) w.setZero();
  state.step = 0;
  state.force.clear();
  state.torque.clear();
  const std::vector<Vec3> start = state.particles.position;
  Simulation sim(setup, std::move(state));
  sim.advance(steps);
  probe.state = sim.state();
  probe.view = sim.view();
  probe.kinetic_energy = sim.kinetic_energy();
  const std::vector<std::uint32_t> contacts = contact_counts(probe.view);
  for (std::size_t i = 0; i < n; ++i) {
    const double moved = (probe.state.particles.position[i] - start[i]).norm();
    if (moved > unsupported_share * probe.free_fall || contacts[i] == 0) ++probe.unsupported;
    if (moved > probe.largest_displacement) {
      probe.largest_displacement = moved;
      probe.worst = i;
    }
  }
  return probe;
}

}  // namespace dem
