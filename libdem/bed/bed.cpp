#include "libdem/bed/bed.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>

#include "libdem/bed/packing.hpp"
#include "libdem/bed/rest.hpp"
#include "libdem/bed/settling_step.hpp"
#include "libdem/bed/suspension.hpp"
#include "libdem/case/derived.hpp"
#include "libdem/case/size_distribution.hpp"
#include "libdem/contact/pair_constants.hpp"
#include "libdem/errors.hpp"
#include "libdem/simulation/selection.hpp"

namespace dem {
namespace {

// Young's modulus while pouring, over the weight of the bed per area.
constexpr double softness = 2e4;
// The strongest contact of a packing carries some ten times the mean (forces fall off exponentially beyond it; Mueth, Jaeger,
// Nagel, Phys. Rev. E 57 (1998) 3164).
constexpr double strongest = 10;
// Grains are poured from so many diameters above.
constexpr double pouring_height = 25;
// By how much the modulus grows from stage to stage, about, and how many periods of the slowest vibration a stage lasts at least.
// A bed swells as its overlaps shrink, and grains that lose a support by it take tens of milliseconds to roll on to the next one.
// The first stages shrink the most and have large steps, so a stage lasts that long where so many steps are enough: what rolls
// in time does not have to be waited for at the small steps of the true stiffness.
constexpr double stiffening = 5, periods = 2, rolling_steps = 12000;
// Of the local stable limit of the step. At twice that the forming and breaking of adhesive contacts feeds a bed as much energy
// as damping takes.
constexpr double stable_share = 0.2;
// Takes most of the energy of every vibration in one period.
constexpr double calming = 0.3;
// Restitution of impacts after pouring: the bed shall come to rest.
constexpr double inelastic = 0.3;
// Rounds of rest and probe, each longer than the one before: most beds need few, a grain that hops on the surface many.
constexpr int most_rounds = 20;
constexpr double first_rest = 4000;  // steps
constexpr double patience = 1.25;

constexpr double unchanged = std::numeric_limits<double>::infinity();   // Pa
constexpr double everywhere = std::numeric_limits<double>::infinity();  // m

Setup at_rest(const Setup& run) {
  Setup still = run;
  still.keep_ledger = false;
  still.levels = 0;  // it ends stages after any number of steps
  for (Wall& w : still.walls) w.motion = resting_at(w.motion, 0);
  return still;
}

// The run's setup with all bodies softened to at most `modulus`, adhesion scaled with E^(2/5), which keeps the speed below
// which grains stick (Haervig et al., Powder Technol. 319 (2017) 377), walls at rest, and impacts that lose most energy.
Setup softened(const Setup& run, double modulus, double restitution) {
  Setup soft = at_rest(run);
  for (Material& m : soft.materials) m.young = std::min(m.young, modulus);
  for (std::size_t a = 0; a < run.materials.size(); ++a)
    for (std::size_t b = 0; b < run.materials.size(); ++b) {
      const double ratio = effective_modulus(soft.materials[a], soft.materials[b]) /
                           effective_modulus(run.materials[a], run.materials[b]);
      soft.interactions[a][b].work_of_adhesion *= std::pow(ratio, 0.4);
      soft.interactions[a][b].restitution = std::min(soft.interactions[a][b].restitution, restitution);
    }
  return soft;
}

// What the recipe needs to know of the grains.
struct Grains {
  std::size_t material;
  double small, large, mean;  // m, radii; `mean` over the grains
  double density, gravity, depth;
  double mass(double radius) const { return density * sphere_volume(radius); }
  // N, mean force of a contact at the bottom of the bed, from its weight per area and one force chain per diameter squared.
  double load() const { return 0.6 * density * gravity * depth * 4 * mean * mean; }
};

// Largest stable step, s, for the smallest grain against grains and all walls, under a contact force and at a speed of impact.
double stable_step(const Setup& setup, const Grains& g, double force, double speed) {
  double step = std::numeric_limits<double>::infinity();
  const Material& grain = setup.materials[g.material];
  const auto consider = [&](std::size_t other, double effective_radius) {
    const Material& body = setup.materials[other];
    const double modulus = effective_modulus(grain, body), mass = g.mass(g.small);
    const double most = std::max(force, impact_force(speed, mass, effective_radius, modulus));
    const double stiffness =
        stiffness_under(most, setup.interactions[g.material][other].work_of_adhesion, effective_radius, modulus);
    step = std::min(step, settling_step(mass, stiffness, 4 * effective_shear_modulus(grain, body) / modulus));
  };
  consider(g.material, harmonic(g.small, g.large));
  for (const Wall& w : setup.walls) consider(w.material, g.small);
  return step;
}

// Period of the slowest vibration of the bed, s: four times what sound takes through it, one diameter in sqrt(m/k).
double slowest_period(const Setup& setup, const Grains& g) {
  const Material& grain = setup.materials[g.material];
  const double stiffness = stiffness_under(g.load(), setup.interactions[g.material][g.material].work_of_adhesion,
                                           0.5 * g.mean, effective_modulus(grain, grain));
  return 4 * (g.depth / (2 * g.mean) + 1) * std::sqrt(g.mass(g.mean) / stiffness);
}

// s, a share of the local stable limit of the step under the contacts as they are: grains that are squeezed under a blade are
// stiffer than the recipe's bed. Infinity where nothing touches. Forces of `state` are not used.
double bearable_step(Setup setup, State state) {
  setup.step = 1e-9;  // is not used: contacts are only looked at
  setup.local_damping = 0;
  state.force.clear();
  state.torque.clear();
  return stable_share * Simulation(std::move(setup), std::move(state)).stable_step();
}

struct Stage {
  std::string name;
  double step;               // s, at most; less where grains are squeezed
  double damping;            // 1, local
  double shortest, longest;  // s; grains that begin to fall look as if they were at rest, so a stage must last a while
  double rest;               // J per grain; the stage ends when the mean kinetic energy stays below
  double height = everywhere;  // m, of the grains that count for that
};

// J, mean kinetic energy of the grains whose centre is not above `height`; 0 where there are none.
double energy_below(const Simulation& sim, double height) {
  const Particles& p = sim.particles();
  double energy = 0, count = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p.position[i].z() > height) continue;
    const double mass = sim.setup().materials[p.material[i]].density * sphere_volume(p.radius[i]);
    energy += 0.5 * mass * p.velocity[i].squaredNorm() +
              0.5 * sphere_inertia(mass, p.radius[i]) * p.angular_velocity[i].squaredNorm();
    ++count;
  }
  return count > 0 ? energy / count : 0;
}

struct Recipe {
  const std::function<void(const BedProgress&)>& progress;
  const std::function<bool()>& interrupted;
  double grain_steps = 0;

  void say(const BedProgress& where) const {
    if (progress) progress(where);
    if (interrupted && interrupted()) throw BedInterrupted("interrupted while the bed was settling");
  }

  // Runs one stage from the given grains and contacts; returns where it ended.
  State run(Setup setup, State state, const Stage& stage) {
    setup.local_damping = stage.damping;
    state.step = 0;
    state.force.clear();
    state.torque.clear();
    const std::size_t grains = state.particles.size();
    setup.step = std::min(stage.step, bearable_step(setup, state));
    Simulation sim(setup, std::move(state));
    const std::uint64_t total = std::uint64_t(std::ceil(stage.longest / setup.step));
    const std::uint64_t least = std::uint64_t(stage.shortest / setup.step);
    const std::uint64_t block = std::max<std::uint64_t>(total / 200, 50);
    int calm = 0;
    while (sim.step() < total && calm < 3) {
      sim.advance(std::min(block, total - sim.step()));
      const double energy = energy_below(sim, stage.height);
      calm = sim.step() >= least && energy < stage.rest ? calm + 1 : 0;
      say({stage.name, sim.time(), stage.longest, grains, energy, sim.step()});
    }
    grain_steps += double(grains) * double(sim.step());
    return sim.state();
  }

  RestProbe probe(const Setup& setup, const State& state) {
    RestProbe result = probe_rest(setup, state);
    const std::size_t grains = state.particles.size();
    const std::uint64_t steps = result.state.step;
    grain_steps += double(grains) * double(steps);
    say({"probing: " + std::to_string(result.unsupported) + " grains unsupported", result.interval, result.interval, grains,
         result.kinetic_energy / std::max(double(grains), 1.0), steps});
    return result;
  }
};

void stop(Particles& p) {
  for (Vec3& v : p.velocity) v.setZero();
  for (Vec3& w : p.angular_velocity) w.setZero();
}

// Removes grains whose centre is above `height`; ids count on from 1.
State cut(const State& state, double height) {
  std::vector<bool> below;
  for (const Vec3& x : state.particles.position) below.push_back(x.z() <= height);
  State kept = selection(state, below);
  std::iota(kept.particles.id.begin(), kept.particles.id.end(), 1u);
  return kept;
}

std::string pressure(double value) {
  std::array<char, 32> text{};
  if (value >= 1e9)
    std::snprintf(text.data(), text.size(), "%.3g GPa", value * 1e-9);
  else
    std::snprintf(text.data(), text.size(), "%.3g MPa", value * 1e-6);
  return text.data();
}

[[noreturn]] void refuse(const RestProbe& probe) {
  const View& v = probe.view;
  const Vec3& x = v.position[probe.worst];
  const std::vector<std::uint32_t> contacts = contact_counts(v);
  std::array<char, 400> text{};
  std::snprintf(text.data(), text.size(),
                "the bed is not at rest: %zu of %zu grains are not supported, the worst, grain %u at (%.4g, %.4g, %.4g) mm with "
                "%u contacts, moved by %.3g um in %.3g ms, in which it would fall freely by %.3g um; kinetic energy %.3g J, "
                "expected below %.3g J",
                probe.unsupported, v.id.size(), v.id[probe.worst], 1e3 * x.x(), 1e3 * x.y(), 1e3 * x.z(),
                contacts[probe.worst], 1e6 * probe.largest_displacement, 1e3 * probe.interval, 1e6 * probe.free_fall,
                probe.kinetic_energy, probe.rest_scale);
  throw PhysicsError(text.data());
}

BedReport report_on(const RestProbe& probe, const BedRegion& region, const Bed& bed) {
  const View& view = probe.view;
  const double d = bed.mean_diameter;
  BedReport r;
  r.grains = view.id.size();
  r.solid_fraction = solid_fraction(probe.state.particles, region, d, bed.depth - d);
  r.coordination = 2.0 * double(view.pairs.size()) / double(view.id.size());
  const std::vector<std::uint32_t> contacts = contact_counts(view);
  r.mechanical_coordination = mechanical_coordination(contacts);
  r.rattlers = std::size_t(std::count_if(contacts.begin(), contacts.end(), [](std::uint32_t c) { return c < 2; }));
  r.overlaps = overlaps_of(probe.state);
  for (const Vec3& x : view.position) r.top = std::max(r.top, x.z());
  r.unsupported = probe.unsupported;
  r.probe_interval = probe.interval;
  r.largest_displacement = probe.largest_displacement;
  r.free_fall = probe.free_fall;
  r.kinetic_energy = probe.kinetic_energy;
  r.rest_scale = probe.rest_scale;
  return r;
}

}  // namespace

SettledBed make_bed(const Setup& setup, const Bed& bed, std::uint8_t material, const BedRegion& region,
                    const std::function<void(const BedProgress&)>& progress,
                    const std::function<bool()>& interrupted) {
  const Material& glass = setup.materials[material];
  const double d = bed.mean_diameter, gravity = setup.gravity.norm();
  if (!(gravity > 0)) throw CaseError("a bed settles under gravity; it is zero here");
  const Grains g{material, 0.5 * bed.size_low * d, 0.5 * bed.size_high * d, 0.5 * mean_size(bed) * d, glass.density,
                 gravity, std::max(bed.depth, d)};
  // So many that the densest random packing would still reach the cut.
  const double mean_volume = sphere_volume(0.5 * d) * mean_cubed_size(bed);
  const double wanted = 0.64 * cross_section(region) * (bed.depth + d) / mean_volume;
  if (!(wanted >= 1)) throw CaseError("the bed is empty: a depth of " + std::to_string(bed.depth * 1e3) + " mm holds no grain");

  Recipe recipe{progress, interrupted};
  State state;
  state.particles = random_suspension(setup, bed, material, region, std::size_t(wanted), interrupted);
  recipe.say({"placing", 0, 0, state.particles.size(), 0, 0});

  // J, per grain: a grain that has it moves at sqrt(2 g d/1000), some millimetres per second.
  const double rest = 1e-3 * g.mass(g.mean) * gravity * d;
  // Soft enough for a large step, stiff enough that the weight of the bed presses grains by a thousandth of a diameter.
  const double soft = std::min(glass.young, std::max(softness * glass.density * gravity * bed.depth, 1e6));
  double top = 0;
  for (const Vec3& x : state.particles.position) top = std::max(top, x.z());
  // The suspension arrives as if it had been poured from somewhat higher up; the faster, the denser the bed.
  const double speed = std::sqrt(2 * gravity * pouring_height * d);
  const Vec3 down = setup.gravity / gravity;
  for (Vec3& v : state.particles.velocity) v = speed * down;
  const double drop = std::max(top - bed.depth, d), impact = std::sqrt(speed * speed + 2 * gravity * drop);
  const double fall = (impact - speed) / gravity;
  // Grains hit each other as they will in the run, so that the bed packs as it would when poured. What still jumps about
  // above the cut does not matter.
  const Setup falling = softened(setup, soft, 1);
  const double pouring_step = stable_step(falling, g, strongest * g.load(), impact);
  state = recipe.run(falling, std::move(state), {"pouring", pouring_step, 0, fall, 20 * fall + 1, 10 * rest, bed.depth});
  state = cut(state, bed.depth);
  if (state.particles.size() == 0) throw CaseError("the bed is empty: no grain lies below its depth");

  // Grains that lose a support roll on to the next one, which takes them some tens of milliseconds.
  const double roll = 5 * std::sqrt(d / gravity);
  const double calm_speed = 0.3 * std::sqrt(gravity * d);
  const Setup loose = softened(setup, soft, inelastic);
  const double cutting_step = stable_step(loose, g, strongest * g.load(), calm_speed);
  state = recipe.run(loose, std::move(state), {"cutting", cutting_step, calming, 0.5 * roll, 10 * roll, 0.1 * rest});

  // The bed swells as it grows stiffer, by its overlaps, and squeezes grains out of its surface (one by 0.3 mm in a vessel of
  // 13 mm, slowly, over all stages). What rises above the cut is cut again while what lay beside it still has time to roll.
  const int stages = int(std::ceil(std::log(glass.young / soft) / std::log(stiffening)));
  const double shrink = std::pow(glass.young / soft, -2.0 / 3.0 / stages);  // of overlaps under the same forces
  for (int k = 1; k <= stages; ++k) {
    const double modulus = soft * std::pow(glass.young / soft, double(k) / stages);
    state = cut(state, bed.depth);
    // Stiffer bodies than the grains get their true modulus in the last stage.
    const Setup harder = softened(setup, k < stages ? modulus : unchanged, inelastic);
    for (State::Pair& c : state.pairs) c.spring *= shrink;
    for (State::WallPair& c : state.wall_pairs) c.spring *= shrink;
    const double step = stable_step(harder, g, stiffening * strongest * g.load(), calm_speed);
    const double length = std::max(periods * slowest_period(harder, g), std::min(0.5 * roll, rolling_steps * step));
    state = recipe.run(harder, std::move(state),
                       {"stiffening to " + pressure(modulus), step, calming, length, 2 * length, rest});
  }

  // At the true stiffness, adhesion and restitution.
  Setup still = at_rest(setup);
  const double step = stable_step(still, g, strongest * g.load(), calm_speed);
  still.step = std::min(step, bearable_step(still, state));
  const Setup damped = softened(setup, unchanged, inelastic);
  RestProbe probe;
  double length = std::max(periods * slowest_period(still, g), std::min(0.5 * roll, first_rest * still.step));
  for (int round = 0; round < most_rounds; ++round, length *= patience) {
    state = recipe.run(damped, std::move(state), {"resting", step, calming, length, length, 0});
    probe = recipe.probe(still, state);
    if (probe.at_rest()) break;
  }
  state = probe.state;
  if (!probe.at_rest()) refuse(probe);

  SettledBed result;
  result.report = report_on(probe, region, bed);
  result.report.grain_steps = recipe.grain_steps;
  stop(state.particles);
  for (State::Pair& c : state.pairs) c.birth_step = 0;
  for (State::WallPair& c : state.wall_pairs) c.birth_step = 0;
  state.step = 0;
  state.force.clear();
  state.torque.clear();
  result.state = std::move(state);
  return result;
}

}  // namespace dem
