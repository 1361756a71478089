// Time of the contact law alone, of whole steps, and of building the lists.
#include <benchmark/benchmark.h>
#include <omp.h>

#include <random>
#include <vector>

#include "libdem/contact/laws.hpp"
#include "libdem/contact/pair_constants.hpp"
#include "libdem/neighbors/pair_list.hpp"
#include "libdem/neighbors/spatial_order.hpp"
#include "libdem/simulation/simulation.hpp"
#include "tests/dem/grains.hpp"

namespace {

using namespace dem;

// Touches of the paper's glass beads as they are in a flowing bed: overlaps of nanometres to micrometres, speeds of centimetres
// per second.
struct Touches {
  std::vector<Touch<Pack>> touch;
  std::vector<Springs<Pack>> springs;
  PairConstants<Pack> constants;
};

Touches make_touches(std::size_t packs) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto number = [&](double low, double high) {
    return Pack([&](auto) { return low + (high - low) * 0.5 * (unit(random) + 1); });
  };
  const auto vector = [&](double size) { return Triple<Pack>{number(-size, size), number(-size, size), number(-size, size)}; };
  const Setup glass = support::glass_setup();
  const double radius = 0.4625e-3, mass = 2500 * sphere_volume(radius);
  const BodyConstants body{radius, mass, sphere_inertia(mass, radius)};
  const PairConstants<double> c = pair_constants(make_material_table(glass.materials, glass.interactions)(0, 0), body, body);
  Touches t;
  for (std::size_t m = 0; m < material_constants<double>.size(); ++m)
    t.constants.*material_constants<Pack>[m] = c.*material_constants<double>[m];
  for (std::size_t m = 0; m < constants_per_contact; ++m) t.constants.*contact_constants<Pack>[m] = c.*contact_constants<double>[m];
  for (std::size_t k = 0; k < packs; ++k) {
    Touch<Pack> touch;
    touch.overlap = number(1e-9, 1e-6);
    touch.normal = vector(1);
    touch.normal = touch.normal * Pack(1.0 / square_root(dot(touch.normal, touch.normal)));
    touch.velocity = vector(0.05);
    touch.spin_i = vector(50);
    touch.spin_j = vector(50);
    touch.arm_i = touch.arm_j = radius;
    t.touch.push_back(touch);
    t.springs.push_back({vector(1e-8), {0.0, 0.0, 0.0}, number(1e-6, 1e-5)});
  }
  return t;
}

// The default composition, JKR with everything; all data in the first-level cache.
void law_alone(benchmark::State& state) {
  Touches t = make_touches(16);
  constexpr std::tuple_element_t<0, FixedLaws> law{};
  const Interval<Pack> dt(5e-8, 1 / 5e-8);
  for (auto _ : state) {
    for (std::size_t k = 0; k < t.touch.size(); ++k) {
      Springs<Pack> springs = t.springs[k];
      const ContactForce<Pack> f = evaluate(law, t.touch[k], t.constants, springs, dt);
      benchmark::DoNotOptimize(f);
      benchmark::DoNotOptimize(springs);
    }
  }
  state.counters["contacts/s"] =
      benchmark::Counter(double(t.touch.size() * pack_width), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(law_alone);

// A shaken cubic packing of side^3 grains in free space, six neighbours each.
void whole_step(benchmark::State& state) {
  omp_set_num_threads(int(state.range(1)));
  State start;
  start.particles = support::packed_cube(int(state.range(0)), 1e-6, 0.02, 1);
  const double grains = double(start.particles.size());
  Simulation sim(support::glass_setup(), std::move(start));
  sim.advance(20);
  constexpr std::uint64_t steps = 20;
  for (auto _ : state) sim.advance(steps);
  state.counters["grain steps/s"] = benchmark::Counter(grains * steps, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["contacts"] = double(sim.contacts());
}
BENCHMARK(whole_step)->ArgNames({"side", "threads"})->Args({17, 1})->Args({33, 1})->Args({33, 2})->Args({52, 1})->UseRealTime();

void order_and_list(benchmark::State& state) {
  omp_set_num_threads(1);
  const Particles grains = support::packed_cube(int(state.range(0)), 1e-6, 0, 1);
  for (auto _ : state) {
    benchmark::DoNotOptimize(spatial_order(grains.position, 2 * 0.4625e-3));
    benchmark::DoNotOptimize(build_pair_list(grains.position, grains.radius, 0.1 * 0.4625e-3));
  }
  state.counters["grains/s"] = benchmark::Counter(double(grains.size()), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(order_and_list)->ArgNames({"side"})->Arg(33);

}  // namespace
