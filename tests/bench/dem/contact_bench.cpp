// Time of the contact law alone, of whole steps, and of building the lists.
#include <benchmark/benchmark.h>
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "libdem/contact/laws.hpp"
#include "libdem/contact/pair_constants.hpp"
#include "libdem/neighbors/pair_list.hpp"
#include "libdem/neighbors/spatial_order.hpp"
#include "libdem/particles/grain_rows.hpp"
#include "libdem/simulation/simulation.hpp"
#include "tests/dem/grains.hpp"
#include "tests/dem/pair_constants.hpp"

// A double that counts what is done to it: how many operations the law takes.
namespace counting {

struct Counts {
  int sums = 0, products = 0, quotients = 0, roots = 0, choices = 0;  // a choice: comparison, selection, extremum, absolute value
  int fused = 0;  // a product and a sum in one
  int guesses = 0;  // of an inverse root
} counts, single_counts;

struct Truth {
  bool value = false;
  friend Truth operator&&(Truth a, Truth b) { return {a.value && b.value}; }
  friend Truth operator||(Truth a, Truth b) { return {a.value || b.value}; }
  friend bool all(Truth a) { return a.value; }
};

template <class Value, Counts& counts>
struct Counting {
  Value value = 0;
  Counting() = default;
  Counting(Value v) : value(v) {}
  explicit operator double() const { return value; }
  friend Counting operator+(Counting a, Counting b) { return ++counts.sums, a.value + b.value; }
  friend Counting operator-(Counting a, Counting b) { return ++counts.sums, a.value - b.value; }
  friend Counting operator-(Counting a) { return ++counts.sums, -a.value; }
  friend Counting operator*(Counting a, Counting b) { return ++counts.products, a.value * b.value; }
  friend Counting operator/(Counting a, Counting b) { return ++counts.quotients, a.value / b.value; }
  friend Counting multiply_add(Counting a, Counting b, Counting c) { return ++counts.fused, a.value * b.value + c.value; }
  friend Counting subtract_product(Counting c, Counting a, Counting b) { return ++counts.fused, c.value - a.value * b.value; }
  friend Truth operator<(Counting a, Counting b) { return ++counts.choices, Truth{a.value < b.value}; }
  friend Truth operator>(Counting a, Counting b) { return ++counts.choices, Truth{a.value > b.value}; }
  friend Truth operator>=(Counting a, Counting b) { return ++counts.choices, Truth{a.value >= b.value}; }
  friend Counting select(Truth mask, Counting a, Counting b) { return ++counts.choices, mask.value ? a : b; }
  friend Counting square_root(Counting a) { return ++counts.roots, std::sqrt(a.value); }
#if defined(__AVX512F__)
  friend Counting inverse_root(Counting a) { return ++counts.guesses, dem::inverse_root_from(Counting(1 / std::sqrt(a.value)), a); }
#else
  friend Counting inverse_root(Counting a) { return 1.0 / square_root(a); }
#endif
  friend Counting absolute(Counting a) { return ++counts.choices, std::abs(a.value); }
  friend Counting larger(Counting a, Counting b) { return ++counts.choices, a.value > b.value ? a : b; }
  friend Counting smaller(Counting a, Counting b) { return ++counts.choices, a.value < b.value ? a : b; }
};
using Number = Counting<double, counts>;
using Single = Counting<float, single_counts>;
inline Single to_single(Number a) { return float(a.value); }
inline Number to_double(Single a) { return double(a.value); }

}  // namespace counting

namespace {

using namespace dem;

// Touches of the paper's glass beads as they are in a flowing bed: overlaps of nanometres to micrometres, speeds of centimetres
// per second.
struct Touches {
  std::vector<Touch<Pack>> touch;
  std::vector<Springs<Pack>> springs;
  PairConstants<Pack> constants;
  PairConstants<double> single;  // the same
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
  Touches t{.touch = {}, .springs = {}, .constants = support::constants_as<Pack>(c), .single = c};
  for (std::size_t k = 0; k < packs; ++k) {
    Touch<Pack> touch;
    touch.overlap = number(1e-9, 1e-6);
    touch.normal = vector(1);
    touch.normal = touch.normal * Pack(1.0 / square_root(dot(touch.normal, touch.normal)));
    touch.velocity = vector(0.05);
    touch.spin_i = vector(50);
    touch.spin_j = vector(50);
    touch.arm_i = touch.arm_j = radius;
    touch.closing = dot(touch.velocity, touch.normal);
    t.touch.push_back(touch);
    t.springs.push_back({vector(1e-8), {0.0, 0.0, 0.0}, number(1e-6, 1e-5)});
  }
  return t;
}

constexpr std::tuple_element_t<0, FixedLaws> law{};  // the default composition, JKR with everything

// What a contact with memory, sliding or not, takes of the law; energies, which only a ledger asks for, included.
counting::Counts operations_of_the_law() {
  using counting::Number;
  const Touches t = make_touches(1);
  const PairConstants<Number> c = support::constants_as<Number>(t.single);
  const auto first = [](const Triple<Pack>& v) { return Triple<Number>{double(v.x[0]), double(v.y[0]), double(v.z[0])}; };
  const Touch<Pack>& from = t.touch[0];
  const Touch<Number> touch{double(from.overlap[0]), first(from.normal), first(from.velocity), first(from.spin_i),
                            first(from.spin_j), double(from.arm_i[0]), double(from.arm_j[0]), double(from.closing[0])};
  Springs<Number> springs{first(t.springs[0].tangential), {0.0, 0.0, 0.0}, double(t.springs[0].contact_radius[0])};
  const Interval<Number> dt(5e-8, 1 / 5e-8);
  counting::counts = counting::single_counts = {};
  benchmark::DoNotOptimize(evaluate(law, touch, c, springs, dt));
  return counting::counts;
}

// All data in the first-level cache.
[[gnu::flatten]] void law_alone(benchmark::State& state) {
  Touches t = make_touches(16);
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
  const counting::Counts of = operations_of_the_law();
  state.counters["sums"] = of.sums;
  state.counters["products"] = of.products;
  state.counters["fused"] = of.fused;
  state.counters["quotients"] = of.quotients;
  state.counters["roots"] = of.roots;
  state.counters["guesses"] = of.guesses;
  state.counters["choices"] = of.choices;
  const counting::Counts& single = counting::single_counts;  // of half the digits
  state.counters["single: sums"] = single.sums;
  state.counters["single: products"] = single.products;
  state.counters["single: fused"] = single.fused;
  state.counters["single: quotients"] = single.quotients;
  state.counters["single: roots"] = single.roots;
}
BENCHMARK(law_alone);

// One kind of operation on eight independent packs in registers: what the processor can do at most.
template <class Operation>
void operation(benchmark::State& state, Operation operate) {
  Pack a = 1.0, b = 1.1, c = 1.2, d = 1.3, e = 1.4, f = 1.5, g = 1.6, h = 1.7;
  Pack by = 1.0000001;
  const auto step = [&](Pack& x) {
    x = operate(x, by);
    asm volatile("" : "+v"(x), "+v"(by));
  };
  constexpr int rounds = 64;
  for (auto _ : state)
    for (int round = 0; round < rounds; ++round) step(a), step(b), step(c), step(d), step(e), step(f), step(g), step(h);
  state.counters["operations/s"] = benchmark::Counter(8.0 * rounds, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK_CAPTURE(operation, sum, [](const Pack& a, const Pack& b) { return Pack(a + b); });
BENCHMARK_CAPTURE(operation, product, [](const Pack& a, const Pack& b) { return Pack(a * b); });
BENCHMARK_CAPTURE(operation, quotient, [](const Pack& a, const Pack& b) { return Pack(a / b); });
// Always of the same number: roots of roots end at 1, which is faster than others.
BENCHMARK_CAPTURE(operation, root, [](const Pack&, const Pack& b) { return square_root(b); });
BENCHMARK_CAPTURE(operation, inverse_root, [](const Pack&, const Pack& b) { return inverse_root(b); });

// A cubic packing of side^3 grains in free space, each held by its six neighbours at the overlap at which adhesion and elasticity balance
// (a^2/(3 R*) where a^3 = 9 pi w R*^2/(2 E*): 5 nm), so that all contacts last: with one on every lane of the list.
void whole_step(benchmark::State& state) {
  omp_set_num_threads(int(state.range(1)));
  State start;
  start.particles = support::packed_cube(int(state.range(0)), 5e-9, 1e-6, 1);
  const double grains = double(start.particles.size());
  Simulation sim(support::glass_setup(), std::move(start));
  sim.advance(20);
  constexpr std::uint64_t steps = 400;  // a run takes 2000 between two rows of its series; what each row costs is a few steps' time
  for (auto _ : state) sim.advance(steps);
  state.counters["grain steps/s"] = benchmark::Counter(grains * steps, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["contacts"] = double(sim.contacts());
}
BENCHMARK(whole_step)
    ->ArgNames({"side", "threads"})
    ->Iterations(2)
    ->Args({17, 1})
    ->Args({33, 1})
    ->Args({33, 2})
    ->UseRealTime();

// What a step of a grain costs in large packings: 5,000, 36,000, 141,000 and a million grains are stepped in turn, the smallest before and
// after each other one, as the speed of a shared processor changes within minutes. Medians over the rounds: ns, and ratios to the smallest.
void cost_by_size(benchmark::State& state) {
  omp_set_num_threads(1);
  const auto packing = [](int side) {
    State start;
    start.particles = support::packed_cube(side, 5e-9, 1e-6, 1);
    auto sim = std::make_unique<Simulation>(support::glass_setup(), std::move(start));
    sim->advance(20);
    return sim;
  };
  const auto cost = [](Simulation& sim, int spells) {  // ns
    const auto begin = std::chrono::steady_clock::now();
    for (int spell = 0; spell < spells; ++spell) sim.advance(400);
    return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - begin).count() / (400.0 * spells * double(sim.particles().size()));
  };
  struct Large {
    int side, spells;
    std::unique_ptr<Simulation> sim;
    std::vector<double> cost, ratio;
  };
  const auto small = packing(17);
  std::vector<Large> large;
  for (const auto& [side, spells] : {std::pair{33, 2}, std::pair{52, 1}, std::pair{100, 1}}) large.push_back({side, spells, packing(side), {}, {}});
  std::vector<double> smallest{cost(*small, 10)};
  for (auto _ : state)
    for (Large& l : large) {
      l.cost.push_back(cost(*l.sim, l.spells));
      smallest.push_back(cost(*small, 10));
      l.ratio.push_back(2 * l.cost.back() / (smallest.end()[-1] + smallest.end()[-2]));
    }
  const auto median = [](std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
    return values[values.size() / 2];
  };
  state.counters["ns 17^3"] = median(smallest);
  for (const Large& l : large) {
    state.counters["ns " + std::to_string(l.side) + "^3"] = median(l.cost);
    state.counters["ratio " + std::to_string(l.side) + "^3"] = median(l.ratio);
  }
}
BENCHMARK(cost_by_size)->Iterations(5)->UseRealTime();

void order_and_list(benchmark::State& state) {
  omp_set_num_threads(1);
  const Particles grains = support::packed_cube(int(state.range(0)), 1e-6, 0, 1);
  for (auto _ : state) {
    benchmark::DoNotOptimize(spatial_order(grains.position, RowChunks(grains.size()).rows()));
    benchmark::DoNotOptimize(build_pair_list(grains.position, grains.radius, 0.1 * 0.4625e-3));
  }
  state.counters["grains/s"] = benchmark::Counter(double(grains.size()), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(order_and_list)->ArgNames({"side"})->Arg(33);

}  // namespace
