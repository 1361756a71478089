#include "apps/jamscope/bench.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <nlohmann/json.hpp>

#include "apps/jamscope/case_file.hpp"
#include "apps/jamscope/errors.hpp"
#include "apps/jamscope/outputs.hpp"
#include "apps/jamscope/settled_bed.hpp"
#include "apps/jamscope/simulation_view.hpp"
#include "libdem/case/derived.hpp"
#include "libdem/simulation/simulation.hpp"

namespace jamscope {
namespace {

struct Measured {
  double wall = 0, step = 0;  // s
  std::uint8_t levels = 0;
  dem::Effort effort;
  std::size_t grains = 0, contacts = 0;
  double bytes = 0;

  double particle_steps() const { return double(effort.steps) * double(grains) / wall; }
  double evaluations() const { return 8 * double(effort.evaluations.blocks) + double(effort.evaluations.touches); }
  double evaluations_at_every_step() const {
    return 8 * double(effort.evaluations.blocks_at_every_step) + double(effort.evaluations.touches_at_every_step);
  }
};

// Steps in rounds that are long against reading the clock and short against `seconds`. Returns how long it was at it, s.
double run_for(dem::Simulation& simulation, double seconds, std::uint64_t& round) {
  const auto begin = Clock::now();
  while (true) {
    const double before = seconds_since(begin);
    if (before >= seconds) return before;
    if (stop_requested()) throw Interrupted{};
    simulation.advance(round);
    if (seconds_since(begin) - before < 0.05 * seconds) round *= 2;
  }
}

Measured measure(const dem::Setup& setup, dem::State state, const BenchOptions& options, Console& console) {
  Measured m;
  dem::Simulation simulation(setup, std::move(state));
  std::uint64_t round = std::uint64_t{1} << setup.levels;
  console.note(fmt::format("warming up for {:.3g} s, then measuring for {:.3g} s", options.warm_up, options.seconds));
  run_for(simulation, options.warm_up, round);
  simulation = dem::Simulation(setup, simulation.state());  // counts from here
  m.wall = run_for(simulation, options.seconds, round);
  m.effort = simulation.effort();
  m.step = setup.step;
  m.levels = setup.levels;
  m.grains = simulation.particles().size();
  m.contacts = simulation.contacts();
  m.bytes = double(simulation.bytes());
  return m;
}

nlohmann::json as_json(const Measured& m, const CaseFile& file, const BenchOptions& o) {
  const dem::Effort& e = m.effort;
  return {{"case", file.physics.name},
          {"machine", facts_of_this_process({}).machine},
          {"threads", o.threads},
          {"step_s", m.step},
          {"levels", m.levels},
          {"grains", m.grains},
          {"contacts", m.contacts},
          {"steps", e.steps},
          {"wall_s", m.wall},
          {"particle_steps_per_second", m.particle_steps()},
          {"evaluations_per_second", m.evaluations() / m.wall},
          {"evaluations_over_uniform", m.evaluations() / m.evaluations_at_every_step()},
          {"share_stepping", e.stepping / e.total()},
          {"share_lists", e.listing / e.total()},
          {"share_rest", e.rest / e.total()},
          {"steps_per_list", e.lists == 0 ? nlohmann::json(nullptr) : nlohmann::json(double(e.steps) / double(e.lists))},
          {"bytes_per_grain", m.bytes / double(m.grains)}};
}

std::string as_text(const Measured& m, const CaseFile& file, const BenchOptions& o) {
  const dem::Effort& e = m.effort;
  const auto share = [&](double seconds) { return fmt::format("{:.1f} %", 100 * seconds / e.total()); };
  std::string text;
  const auto line = [&](const std::string& name, const std::string& value) {
    text += fmt::format("{:<28}{}\n", name, value);
  };
  line("case", fmt::format("{}, {} grains, {} contacts", file.physics.name, m.grains, m.contacts));
  line("step", m.levels == 0 ? fmt::format("{:.3g} s, every contact at every step", m.step)
                             : fmt::format("{:.3g} s, contacts at every 1 to {} steps", m.step, 1U << m.levels));
  line("measured", fmt::format("{} steps in {:.1f} s on {} thread{}", e.steps, m.wall, o.threads, o.threads == 1 ? "" : "s"));
  line("grain steps per second", fmt::format("{:.3g}", m.particle_steps()));
  line("contacts per second", fmt::format("{:.3g} through the law", m.evaluations() / m.wall));
  line("contacts over uniform",
       fmt::format("{:.3f} of what every step would evaluate", m.evaluations() / m.evaluations_at_every_step()));
  line("time in contacts, motion", share(e.stepping));
  line("time in lists", fmt::format("{}, {} built", share(e.listing), e.lists));
  line("time in walls and the rest", share(e.rest));
  line("memory per grain", fmt::format("{:.0f} bytes", m.bytes / double(m.grains)));
  return text;
}

}  // namespace

int bench(const BenchOptions& options) {
  Console console(stderr, options.log_format, options.quiet);
  std::vector<std::string> overrides = options.overrides;
  if (options.at_own_rate) overrides.push_back("run.step=auto");
  CaseFile file = read_case_file(options.case_path, overrides);
  if (options.beads) {
    const double grains = dem::derive(file.physics).grains;
    const double depth = file.physics.bed.depth * *options.beads / grains;
    overrides.push_back(fmt::format("bed.depth={} m", depth));
    file = read_case_file(options.case_path, overrides);
  }
  for (const std::string& warning : file.warnings) console.warning(warning);
  omp_set_num_threads(std::max(options.threads, 1));
  catch_stop_signals();
  try {
    dem::Scene scene = dem::make_scene(file.physics, file.walls);
    scene.setup.watch_force = watched(file).force;
    scene.setup.watch_radius = watched(file).radius;
    if (options.uniform) scene.setup.levels = 0;
    dem::SettledBed bed = settled_bed(file, scene, options.bed_cache, console);
    const Measured m = measure(scene.setup, std::move(bed.state), options, console);
    fmt::print("{}", options.json ? as_json(m, file, options).dump(2) + "\n" : as_text(m, file, options));
  } catch (const Interrupted&) {
    console.note("stopped before the end, nothing was measured");
  }
  return 0;
}

}  // namespace jamscope
