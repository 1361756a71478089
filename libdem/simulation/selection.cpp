#include "libdem/simulation/selection.hpp"

namespace dem {

State selection(const State& state, const std::vector<bool>& keep) {
  State kept;
  kept.step = state.step;
  const Particles& p = state.particles;
  std::vector<std::uint32_t> row(p.size(), UINT32_MAX);
  for (std::size_t i = 0; i < p.size(); ++i)
    if (keep[i]) {
      row[i] = std::uint32_t(kept.particles.size());
      kept.particles.add(p.id[i], p.material[i], p.radius[i], p.position[i], p.velocity[i], p.angular_velocity[i]);
    }
  for (State::Pair c : state.pairs)
    if (keep[c.i] && keep[c.j]) {
      c.i = row[c.i];
      c.j = row[c.j];
      kept.pairs.push_back(c);
    }
  for (State::WallPair c : state.wall_pairs)
    if (keep[c.i]) {
      c.i = row[c.i];
      kept.wall_pairs.push_back(c);
    }
  return kept;
}

}  // namespace dem
