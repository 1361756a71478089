// Time of the mesh contact search around the paper's blade.
#include <benchmark/benchmark.h>

#include <random>

#include "libdem/geometry/mesh_contact.hpp"
#include "libdem/geometry/twisted_blade.hpp"

namespace {

using dem::Vec3;

constexpr double largest_grain = 0.555e-3, skin = 0.1e-3;  // m

struct Grains {
  dem::MeshContactFinder finder;
  std::vector<Vec3> centres;
  std::vector<std::vector<std::uint32_t>> candidates;
};

// Grains whose neighbour list holds triangles of the blade, as they stand in the bed around it.
Grains make_grains() {
  dem::TwistedBlade shape;
  shape.diameter = 23.5e-3;
  Grains g{dem::MeshContactFinder(dem::make_twisted_blade(shape)), {}, {}};
  std::mt19937_64 rng(1);
  std::uniform_real_distribution<double> xy(-12.5e-3, 12.5e-3), z(-4e-3, 20e-3);
  std::vector<std::uint32_t> near;
  std::vector<dem::MeshTouch> touches;
  while (g.centres.size() < 2000) {
    const Vec3 c(xy(rng), xy(rng), z(rng));
    near.clear();
    g.finder.candidate_triangles(c, largest_grain + skin, near);
    g.finder.touches(c, largest_grain + skin, near, touches);
    if (touches.empty() || touches.front().distance < 0.7 * largest_grain) continue;  // far away, inside or too deep
    g.centres.push_back(c);
    g.candidates.push_back(near);
  }
  return g;
}

void mesh_touches(benchmark::State& state) {
  const Grains g = make_grains();
  std::vector<dem::MeshTouch> touches;
  std::size_t i = 0, candidates = 0;
  for (const auto& c : g.candidates) candidates += c.size();
  for (auto _ : state) {
    g.finder.touches(g.centres[i], largest_grain, g.candidates[i], touches);
    benchmark::DoNotOptimize(touches.data());
    i = (i + 1) % g.centres.size();
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["candidates"] = static_cast<double>(candidates) / static_cast<double>(g.centres.size());
}
BENCHMARK(mesh_touches);

void mesh_candidates(benchmark::State& state) {
  const Grains g = make_grains();
  std::vector<std::uint32_t> near;
  std::size_t i = 0;
  for (auto _ : state) {
    near.clear();
    g.finder.candidate_triangles(g.centres[i], largest_grain + skin, near);
    benchmark::DoNotOptimize(near.data());
    i = (i + 1) % g.centres.size();
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(mesh_candidates);

}  // namespace
