#include "libdem/bed/packing.hpp"

#include <algorithm>
#include <numbers>

namespace dem {

double solid_fraction(const Particles& p, const BedRegion& region, double low, double high) {
  if (!(high > low)) return 0;
  double volume = 0;
  // Volume of the part of a sphere below z: pi h^2 (3R - h)/3 with h its depth.
  const auto below = [](double radius, double centre, double z) {
    const double h = std::clamp(z - (centre - radius), 0.0, 2 * radius);
    return std::numbers::pi * h * h * (3 * radius - h) / 3;
  };
  for (std::size_t i = 0; i < p.size(); ++i)
    if (held_inside(region, p.position[i], 0) == p.position[i])
      volume += below(p.radius[i], p.position[i].z(), high) - below(p.radius[i], p.position[i].z(), low);
  return volume / (cross_section(region) * (high - low));
}

std::vector<std::uint32_t> contact_counts(const View& view) {
  std::vector<std::uint32_t> count(view.id.size(), 0);
  for (const PairRecord& c : view.pairs) {
    ++count[c.i];
    ++count[c.j];
  }
  for (const WallRecord& c : view.wall_pairs) ++count[c.i];
  return count;
}

double mechanical_coordination(const std::vector<std::uint32_t>& contacts) {
  double sum = 0, carriers = 0;
  for (const std::uint32_t count : contacts)
    if (count > 1) {
      sum += count;
      ++carriers;
    }
  return carriers > 0 ? sum / carriers : 0;
}

Overlaps overlaps_of(const State& state) {
  const Particles& p = state.particles;
  std::vector<State::WallPair> walls;
  for (const State::WallPair& c : state.wall_pairs)
    if (c.contact_radius > 0) walls.push_back(c);
  std::stable_sort(walls.begin(), walls.end(), [](const State::WallPair& a, const State::WallPair& b) { return a.i < b.i; });
  std::vector<bool> squeezed(p.size(), false);
  for (std::size_t k = 0; k < walls.size(); ++k)
    for (std::size_t q = k + 1; q < walls.size() && walls[q].i == walls[k].i; ++q)
      if (walls[k].normal.dot(walls[q].normal) < 0) squeezed[walls[k].i] = true;

  Overlaps result;
  result.squeezed = std::size_t(std::count(squeezed.begin(), squeezed.end(), true));
  const auto add = [&](bool of_squeezed, double overlap) {
    double& largest = of_squeezed ? result.largest_squeezed : result.largest;
    largest = std::max(largest, overlap);
  };
  for (const State::Pair& c : state.pairs)
    if (c.contact_radius > 0)
      add(squeezed[c.i] || squeezed[c.j],
          (p.radius[c.i] + p.radius[c.j] - (p.position[c.i] - p.position[c.j]).norm()) / std::min(p.radius[c.i], p.radius[c.j]));
  for (const State::WallPair& c : walls) add(squeezed[c.i], (p.radius[c.i] - c.distance) / p.radius[c.i]);
  return result;
}

}  // namespace dem
