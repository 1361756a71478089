// Time of the network metrics on one frame of about 35,000 particles: a recorded one, or a proxy network.
//
//   network_bench                                      the proxy: a diluted face-centred cubic lattice
//   JAMSCOPE_BENCH_RUN=out/run.h5 network_bench        the last frame of that run
//   network_bench --edges FILE                         writes the network as `a b normal_force`, and `a -1 force` for the blade, `a -2 force`
//                                                      for the vessel, for other programs (tests/bench/networks/compare.py); then ends
#include <benchmark/benchmark.h>
#include <malloc.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <memory>
#include <random>

#include "libjam/analysis.hpp"
#include "libjam/graph/algebraic_connectivity.hpp"
#include "libjam/graph/bridge_conductance.hpp"
#include "libjam/graph/contact_force.hpp"
#include "libjam/graph/diagram_distance.hpp"
#include "libjam/metrics/fabric.hpp"
#include "libjam/metrics/frame_network.hpp"
#include "libjam/metrics/metrics.hpp"
#include "libjam/snapshot/open_source.hpp"

namespace {

using namespace jam;

struct Input {
  RunInfo run;
  Snapshot snapshot;
  std::function<Snapshot()> read;  // it again, from the file; none of the proxy
};

// Face-centred cubic, 21 cells wide: 37,044 particles, of whose contacts 100,220 are kept at random, exponential forces of mean 1 N. The
// outermost layers along x touch the blade and the vessel.
Input proxy() {
  constexpr int cells = 21;
  constexpr std::size_t kept = 100220;
  constexpr float edge = 1.4142136e-3f;
  Input input;
  input.run.walls.resize(2);
  input.run.walls[0].name = "blade", input.run.walls[0].role = WallRole::blade;
  input.run.walls[1].name = "vessel", input.run.walls[1].role = WallRole::vessel;
  Snapshot& s = input.snapshot;
  s.walls.resize(2);
  const int base[4][3] = {{0, 0, 0}, {0, 1, 1}, {1, 0, 1}, {1, 1, 0}};  // half edges
  std::vector<std::int64_t> at(std::size_t(8 * (cells + 1) * (cells + 1) * (cells + 1)), -1);
  const auto key = [](int x, int y, int z) { return std::size_t((x * 2 * (cells + 1) + y) * 2 * (cells + 1) + z); };
  std::vector<std::array<int, 3>> sites;
  for (int x = 0; x < cells; ++x)
    for (int y = 0; y < cells; ++y)
      for (int z = 0; z < cells; ++z)
        for (const auto& b : base) sites.push_back({2 * x + b[0], 2 * y + b[1], 2 * z + b[2]});
  std::sort(sites.begin(), sites.end());
  for (std::size_t k = 0; k < sites.size(); ++k) {
    at[key(sites[k][0], sites[k][1], sites[k][2])] = std::int64_t(k);
    s.particles.id.push_back(ParticleId(k));
    s.particles.position.emplace_back(Vec3f(float(sites[k][0]), float(sites[k][1]), float(sites[k][2])) * (edge / 2));
    s.particles.radius.push_back(0.5e-3f);
  }
  std::vector<std::array<std::uint32_t, 2>> pairs;
  for (std::size_t k = 0; k < sites.size(); ++k)
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz) {
          if (std::abs(dx) + std::abs(dy) + std::abs(dz) != 2 || dx == 2 || dy == 2 || dz == 2) continue;
          const int x = sites[k][0] + dx, y = sites[k][1] + dy, z = sites[k][2] + dz;
          if (x < 0 || y < 0 || z < 0) continue;
          const std::int64_t other = at[key(x, y, z)];
          if (other > std::int64_t(k)) pairs.push_back({std::uint32_t(k), std::uint32_t(other)});
        }
  std::mt19937_64 random(1);
  for (std::size_t k = 0; k < kept; ++k) std::swap(pairs[k], pairs[k + random() % (pairs.size() - k)]);
  pairs.resize(kept);
  std::sort(pairs.begin(), pairs.end());
  const auto exponential = [&] { return float(-std::log((double(random() >> 11) + 0.5) * 0x1p-53)); };
  s.pp.row = pairs;
  for (std::size_t c = 0; c < kept; ++c) s.pp.normal_force.push_back(exponential());
  for (std::uint32_t k = 0; k < sites.size(); ++k) {
    const int x = sites[k][0];
    if (x != 0 && x != 2 * cells - 1) continue;
    s.pw.row.push_back(k);
    s.pw.wall.push_back(x == 0 ? 0 : 1);
    s.pw.normal.push_back(x == 0 ? Vec3f(-1, 0, 0) : Vec3f(1, 0, 0));
    s.pw.normal_force.push_back(exponential());
  }
  return input;
}

const Input& input() {
  static const Input kept = [] {
    const char* path = std::getenv("JAMSCOPE_BENCH_RUN");
    if (path == nullptr) return proxy();
    SnapshotSource source = open_source({path});
    const auto read = [source] { return source.read(source.frames - 1); };
    return Input{source.info, read(), read};
  }();
  return kept;
}

const ContactGraph& graph() {
  static const ContactGraph kept(input().snapshot, input().run.walls);
  return kept;
}

// f(network) on a network that knows nothing yet.
template <class F>
void measure(benchmark::State& state, F f) {
  graph();
  for (auto _ : state) {
    FrameNetwork network(graph(), input().run);
    f(network);
  }
  state.counters["particles"] = double(graph().vertex_count());
  state.counters["contacts"] = double(graph().edge_count());
}

#define NETWORK_BENCH(name, ...)                                          \
  void name(benchmark::State& state) {                                    \
    measure(state, [](FrameNetwork& n) { __VA_ARGS__; });                 \
  }                                                                       \
  BENCHMARK(name)->Unit(benchmark::kMillisecond)

template <class T>
void use(const T& value) {
  benchmark::DoNotOptimize(&value);
  benchmark::ClobberMemory();
}

NETWORK_BENCH(build_graph, use(ContactGraph(n.graph.snapshot(), n.run.walls)));
NETWORK_BENCH(components, use(n.components()));
NETWORK_BENCH(cut_edges, use(n.biconnected()));
NETWORK_BENCH(fabric, use(fabric_anisotropy(n.graph)));
NETWORK_BENCH(stress, use(n.stress()));
NETWORK_BENCH(principal_loads, n.stress(), use(n.loads()));
NETWORK_BENCH(chains, use(n.chains()));
NETWORK_BENCH(cores, use(n.cores()));
NETWORK_BENCH(triangle_counts, use(n.corners()));
NETWORK_BENCH(strongest_bridge, use(n.bridge()));
NETWORK_BENCH(persistence_0, use(n.parts()));
NETWORK_BENCH(persistence_1, use(n.loops()));
NETWORK_BENCH(flow, use(n.flow()));
NETWORK_BENCH(compressive, use(n.compressive()));
NETWORK_BENCH(low_cost_metrics, for (const Metric& m : metrics()) if (m.cost == Cost::low) use(m.value(n)));

// What a run needs of each frame: components, cut edges, chains, fabric, cores, triangles, strongest bridge, persistence of parts, and
// clusters and events by the pipeline.
void standard_set_of(const Snapshot& snapshot, Pipeline& pipeline) {
  const ContactGraph fresh(snapshot, input().run.walls);
  FrameNetwork n(fresh, input().run);
  use(n.components());
  use(n.biconnected());
  use(n.chains());
  use(fabric_anisotropy(n.graph));
  use(n.cores());
  use(n.corners());
  use(n.bridge());
  use(n.parts());
  use(pipeline.add(snapshot));
}

template <class Frame>
void standard_set_of_each(benchmark::State& state, Frame frame) {
  graph();
  for (auto _ : state) {
    state.PauseTiming();
    Pipeline pipeline(input().run, Criteria{.metrics = std::vector<std::string>{}});
    state.ResumeTiming();
    standard_set_of(frame(), pipeline);
  }
}

void standard_set(benchmark::State& state) {
  standard_set_of_each(state, []() -> const Snapshot& { return input().snapshot; });
}
BENCHMARK(standard_set)->Unit(benchmark::kMillisecond);

void standard_set_with_reading(benchmark::State& state) {
  if (!input().read) return state.SkipWithError("the proxy network is in no file: set JAMSCOPE_BENCH_RUN");
  standard_set_of_each(state, input().read);
}
BENCHMARK(standard_set_with_reading)->Unit(benchmark::kMillisecond);

NETWORK_BENCH(cycle_basis, use(n.basis_cycles()));
NETWORK_BENCH(conductance, use(bridge_conductance(n.graph)));
NETWORK_BENCH(contact_paths, use(contact_disjoint_load_paths(n.graph)));
NETWORK_BENCH(particle_paths, use(particle_disjoint_load_paths(n.graph)));
NETWORK_BENCH(community_search, use(n.groups()));
NETWORK_BENCH(fiedler, use(algebraic_connectivity(n.graph)));
NETWORK_BENCH(cells, use(n.cells()));
NETWORK_BENCH(paths, use(n.paths()));
NETWORK_BENCH(blade_to_vessel_betweenness, use(n.between()));
NETWORK_BENCH(betweenness_of_2000_samples, use(sampled_betweenness(n.graph, 2000, 1)));
NETWORK_BENCH(exact_betweenness, use(betweenness(n.graph, {}, BetweennessOf::particles)));
NETWORK_BENCH(exact_betweenness_with_contacts, use(betweenness(n.graph)));
NETWORK_BENCH(rank_of_rigidity, use(n.rigid()));

int write_edges(const char* path) {
  std::FILE* const file = std::fopen(path, "w");
  if (file == nullptr) return 1;
  const Snapshot& s = input().snapshot;
  for (std::size_t c = 0; c < s.pp.size(); ++c) std::fprintf(file, "%u %u %.9g\n", s.pp.row[c][0], s.pp.row[c][1], normal_force(s.pp, c));
  for (std::size_t c = 0; c < s.pw.size(); ++c)
    if (const WallRole role = input().run.walls[s.pw.wall[c]].role; role != WallRole::other)
      std::fprintf(file, "%u %d %.9g\n", s.pw.row[c], role == WallRole::blade ? -1 : -2, normal_force(s.pw, c));
  return std::fclose(file);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3 && std::strcmp(argv[1], "--edges") == 0) return write_edges(argv[2]);
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // as the program does: apps/jamscope/main.cpp
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
