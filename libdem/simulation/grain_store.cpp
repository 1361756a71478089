#include "libdem/simulation/grain_store.hpp"

#include <utility>

#include "libdem/contact/forces.hpp"

namespace dem {

GrainStore make_grain_store(Particles particles, const std::vector<Material>& materials) {
  GrainStore grains;
  grains.caller = std::move(particles);
  const Particles& p = grains.caller;
  for (std::size_t i = 0; i < p.size(); ++i) {
    grains.caller_mass.push_back(materials[p.material[i]].density * sphere_volume(p.radius[i]));
    grains.caller_inertia.push_back(sphere_inertia(grains.caller_mass[i], p.radius[i]));
  }
  return grains;
}

void lay_out(GrainStore& grains, std::vector<std::uint32_t> order) {
  const std::size_t n = grains.size();
  const Particles& p = grains.caller;
  grains.order = std::move(order);
  const LargeArray<GrainRow> rows_before = std::exchange(grains.rows, LargeArray<GrainRow>(n + grains.chunks().count(), phantom()));
  const LargeArray<Vec4> spun_before = std::exchange(grains.spun, LargeArray<Vec4>(n + grains.chunks().count(), Vec4::Zero()));
  grains.forces.assign(n, ForceRow{});
  grains.mass.resize(n);
  grains.inertia.resize(n);
  grains.material.resize(n);
  grains.id.resize(n);
  grains.listed.resize(n);
  const std::vector<std::uint8_t> level_before = std::move(grains.level);
  const std::vector<std::uint32_t> row_before = std::move(grains.row_of);
  grains.row_of.resize(n);
  grains.level.assign(n, 0);
  grains.asked.assign(n + grains.chunks().count(), ForceOutput::nothing_asked);
#pragma omp parallel for schedule(static)
  for (std::size_t r = 0; r < n; ++r) {
    const std::uint32_t i = grains.order[r];
    grains.row_of[i] = std::uint32_t(r);
    grains.rows[r] = {quad(p.position[i], p.radius[i]), quad(p.velocity[i], 1 / p.radius[i]),
                      quad(p.angular_velocity[i], grains.caller_mass[i]),
                      rows_before.empty() ? quad(p.velocity[i], 0) : rows_before[row_before[i]].arrival};
    grains.mass[r] = grains.caller_mass[i];
    grains.inertia[r] = grains.caller_inertia[i];
    grains.material[r] = p.material[i];
    grains.id[r] = p.id[i];
    if (!spun_before.empty()) grains.spun[r] = spun_before[row_before[i]];
    if (!level_before.empty()) grains.level[r] = level_before[row_before[i]];
  }
}

void show(GrainStore& grains) {
  if (std::exchange(grains.shown, true)) return;
  Particles& p = grains.caller;
#pragma omp parallel for schedule(static)
  for (std::size_t r = 0; r < grains.size(); ++r) {
    const std::uint32_t i = grains.order[r];
    p.position[i] = grains.rows[r].position();
    p.velocity[i] = grains.rows[r].velocity();
    p.angular_velocity[i] = grains.rows[r].angular_velocity();
  }
}

}  // namespace dem
