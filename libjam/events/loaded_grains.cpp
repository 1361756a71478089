#include "libjam/events/loaded_grains.hpp"

#include <algorithm>
#include <functional>
#include <limits>

#include "libjam/jamming/gap.hpp"

namespace jam {

Extent::Extent() : low(Vec3::Constant(std::numeric_limits<double>::infinity())), high(-low) {}

void Extent::include(const Extent& other) {
  low = low.cwiseMin(other.low);
  high = high.cwiseMax(other.high);
}

void LoadedGrains::add(const std::vector<LoadedGrain>& frame) {
  const std::size_t before = grains.size();
  std::copy_if(frame.begin(), frame.end(), std::back_inserter(grains), [&](const LoadedGrain& g) { return g.force > floor; });
  count.push_back(std::uint32_t(grains.size() - before));
  if (grains.size() > 4 * most) keep(2 * most);
}

void LoadedGrains::keep(std::size_t limit) {
  if (grains.size() <= limit) return;
  std::vector<double> force;
  for (const LoadedGrain& g : grains) force.push_back(g.force);
  std::nth_element(force.begin(), force.begin() + std::ptrdiff_t(limit), force.end(), std::greater<>());
  floor = force[limit];
  std::size_t to = 0, from = 0;
  for (std::uint32_t& rows : count) {
    const std::size_t begin = to;
    for (const std::size_t end = from + rows; from < end; ++from)
      if (grains[from].force > floor) grains[to++] = grains[from];
    rows = std::uint32_t(to - begin);
  }
  grains.resize(to);
}

std::vector<LoadedGrain> loaded_grains(const ContactGraph& graph, const std::vector<double>& compressive_force, const RunInfo& info, const Criteria& criteria) {
  const Snapshot& s = graph.snapshot();
  const Particles& p = s.particles;
  const bool has_velocity = present(p.velocity, p.size());
  const double floor = LoadedGrains::floor_share * criteria.jam_force;
  std::vector<LoadedGrain> loaded;
  for (ContactGraph::Vertex v = 0; v < compressive_force.size(); ++v)
    if (compressive_force[v] > floor)
      loaded.push_back({p.id[v], compressive_force[v], p.position[v], has_velocity ? p.velocity[v].norm() : std::numeric_limits<float>::quiet_NaN(),
                        in_gap(s, v, info, criteria)});
  return loaded;
}

Extent extent_of(const Particles& particles) {
  Extent extent;
  double radius = 0;
  for (std::size_t k = 0; k < particles.size(); ++k) {
    const Vec3 at = particles.position[k].cast<double>();
    extent.low = extent.low.cwiseMin(at);
    extent.high = extent.high.cwiseMax(at);
    radius = std::max(radius, double{particles.radius[k]});
  }
  extent.low -= Vec3::Constant(radius);
  extent.high += Vec3::Constant(radius);
  return extent;
}

}  // namespace jam
