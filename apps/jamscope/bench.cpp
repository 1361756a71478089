#include "apps/jamscope/bench.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/jamscope/case_file.hpp"
#include "apps/jamscope/errors.hpp"
#include "apps/jamscope/outputs.hpp"
#include "apps/jamscope/settled_bed.hpp"
#include "libdem/case/derived.hpp"
#include "libdem/simulation/simulation.hpp"

namespace jamscope {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

// Bytes of memory that the process holds; 0 where the system does not tell.
double resident_bytes() {
  std::ifstream status("/proc/self/statm");
  double pages = 0, resident = 0;
  if (!(status >> pages >> resident)) return 0;
  return resident * 4096;
}

struct Measured {
  double wall = 0;  // s
  dem::Effort effort;
  std::size_t grains = 0, contacts = 0;
  double bytes = 0;

  double particle_steps() const { return double(effort.steps) * double(grains) / wall; }
  double evaluations() const { return 8 * double(effort.evaluations.blocks) + double(effort.evaluations.touches); }
  double evaluations_at_every_step() const {
    return 8 * double(effort.evaluations.blocks_at_every_step) + double(effort.evaluations.touches_at_every_step);
  }
};

dem::Effort operator-(const dem::Effort& a, const dem::Effort& b) {
  dem::Effort d = a;
  d.steps -= b.steps;
  d.evaluations.blocks -= b.evaluations.blocks;
  d.evaluations.blocks_at_every_step -= b.evaluations.blocks_at_every_step;
  d.evaluations.touches -= b.evaluations.touches;
  d.evaluations.touches_at_every_step -= b.evaluations.touches_at_every_step;
  d.lists -= b.lists;
  d.contacts -= b.contacts;
  d.motion -= b.motion;
  d.listing -= b.listing;
  d.rest -= b.rest;
  return d;
}

// Steps in rounds that are long against reading the clock and short against `seconds`.
double run_for(dem::Simulation& simulation, double seconds, std::uint64_t& round) {
  const auto begin = Clock::now();
  while (true) {
    const double before = seconds_since(begin);
    if (before >= seconds) return before;
    simulation.advance(round);
    if (seconds_since(begin) - before < 0.05 * seconds) round *= 2;
  }
}

Measured measure(dem::Simulation& simulation, const BenchOptions& options, double bytes_before) {
  std::uint64_t round = std::uint64_t{1} << simulation.setup().levels;
  run_for(simulation, options.warm_up, round);
  const dem::Effort before = simulation.effort();
  Measured m;
  m.wall = run_for(simulation, options.seconds, round);
  m.effort = simulation.effort() - before;
  m.grains = simulation.particles().size();
  m.contacts = simulation.contacts();
  m.bytes = resident_bytes() - bytes_before;
  return m;
}

nlohmann::json as_json(const Measured& m, const CaseFile& file, const BenchOptions& o) {
  const dem::Effort& e = m.effort;
  return {{"case", file.physics.name},
          {"machine", facts_of_this_process({}).machine},
          {"threads", o.threads},
          {"step_s", file.physics.step},
          {"levels", o.uniform ? 0 : file.physics.levels},
          {"grains", m.grains},
          {"contacts", m.contacts},
          {"steps", e.steps},
          {"wall_s", m.wall},
          {"particle_steps_per_second", m.particle_steps()},
          {"evaluations_per_second", m.evaluations() / m.wall},
          {"evaluations_over_uniform", m.evaluations() / m.evaluations_at_every_step()},
          {"share_contacts", e.contacts / e.total()},
          {"share_motion", e.motion / e.total()},
          {"share_lists", e.listing / e.total()},
          {"share_rest", e.rest / e.total()},
          {"steps_per_list", e.lists == 0 ? nlohmann::json(nullptr) : nlohmann::json(double(e.steps) / double(e.lists))},
          {"bytes_per_grain", m.bytes / double(m.grains)}};
}

std::string as_text(const Measured& m, const CaseFile& file, const BenchOptions& o) {
  const dem::Effort& e = m.effort;
  const auto share = [&](double seconds) { return fmt::format("{:.1f} %", 100 * seconds / e.total()); };
  std::string text;
  const auto line = [&](const std::string& name, const std::string& value) { text += fmt::format("{:<28}{}\n", name, value); };
  line("case", fmt::format("{}, {} grains, {} contacts", file.physics.name, m.grains, m.contacts));
  line("step", o.uniform || file.physics.levels == 0
                   ? fmt::format("{:.3g} s, every contact at every step", file.physics.step)
                   : fmt::format("{:.3g} s, contacts at every 1 to {} steps", file.physics.step, 1U << file.physics.levels));
  line("measured", fmt::format("{} steps in {:.1f} s on {} thread{}", e.steps, m.wall, o.threads, o.threads == 1 ? "" : "s"));
  line("grain steps per second", fmt::format("{:.3g}", m.particle_steps()));
  line("contacts per second", fmt::format("{:.3g} through the law", m.evaluations() / m.wall));
  line("contacts over uniform", fmt::format("{:.3f} of what every step would evaluate", m.evaluations() / m.evaluations_at_every_step()));
  line("time in contacts", share(e.contacts));
  line("time in motion", share(e.motion));
  line("time in lists", fmt::format("{}, {} built", share(e.listing), e.lists));
  line("time in walls and the rest", share(e.rest));
  line("memory per grain", fmt::format("{:.0f} bytes", m.bytes / double(m.grains)));
  return text;
}

}  // namespace

int bench(const BenchOptions& options) {
  Console console(stderr, options.log_format, options.quiet);
  CaseFile file = read_case_file(options.case_path, options.overrides);
  if (options.beads) {
    const double grains = dem::derive(file.physics).grains;
    std::vector<std::string> overrides = options.overrides;
    const double depth = file.physics.bed.depth * *options.beads / grains;
    overrides.push_back(fmt::format("bed.depth={} m", depth));
    file = read_case_file(options.case_path, overrides);
  }
  for (const std::string& warning : file.warnings) console.warning(warning);
  omp_set_num_threads(std::max(options.threads, 1));
  catch_stop_signals();
  try {
    dem::Scene scene = dem::make_scene(file.physics, file.walls);
    scene.setup.watch_force = file.criteria.jam_force;
    if (options.uniform) scene.setup.levels = 0;
    dem::SettledBed bed = settled_bed(file, scene, options.bed_cache, console);
    const double bytes_before = resident_bytes();
    dem::Simulation simulation(scene.setup, std::move(bed.state));
    const Measured m = measure(simulation, options, bytes_before);
    fmt::print("{}", options.json ? as_json(m, file, options).dump(2) + "\n" : as_text(m, file, options));
  } catch (const Interrupted&) {
    return 0;
  }
  return 0;
}

}  // namespace jamscope
