#include "libdem/bed/bed.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "libdem/case/derived.hpp"
#include "libdem/contact/pair_constants.hpp"
#include "libdem/errors.hpp"

namespace dem {
namespace {

// [0, 1) from a 64-bit generator, the same on every platform (the standard's distributions are not).
double uniform(std::mt19937_64& random) { return double(random() >> 11) * 0x1.0p-53; }

// A loose column on a jittered cubic lattice, free of the walls.
Particles loose_column(const Setup& setup, const Bed& bed, std::uint8_t material, double vessel_radius,
                       std::size_t count) {
  std::mt19937_64 random(bed.seed);
  Particles grains;
  const double largest = 0.5 * bed.size_high * bed.mean_diameter, cell = 2 * largest * 1.03;
  const int across = int(vessel_radius / cell) + 1;
  std::vector<WallTouch> touches;
  std::vector<MeshTouch> scratch;
  std::vector<std::uint32_t> triangles;
  std::vector<WallPose> poses;
  for (const Wall& w : setup.walls) poses.push_back(pose_at(w.motion, 0));
  for (int layer = 0; grains.size() < count; ++layer) {
    if (layer > 100000) throw CaseError("the bed does not fit into its vessel");
    for (int a = -across; a <= across; ++a)
      for (int b = -across; b <= across; ++b) {
        // Every cell draws the same numbers whether it is used or not, so that one grain more or less changes no other.
        const double size = bed.size_low + (bed.size_high - bed.size_low) * uniform(random);
        const double radius = 0.5 * bed.mean_diameter * size, play = largest * 1.03 - radius;
        const Vec3 jitter(2 * uniform(random) - 1, 2 * uniform(random) - 1, 2 * uniform(random) - 1);
        const double shift = layer % 2 ? 0.25 : -0.25;
        const Vec3 x = Vec3((a + shift) * cell, (b + shift) * cell, (layer + 0.5) * cell) + play * jitter;
        if (std::hypot(x.x(), x.y()) + radius > vessel_radius) continue;
        bool free = true;
        for (std::size_t w = 0; w < setup.walls.size() && free; ++w) {
          triangles.clear();
          candidate_parts(setup.walls[w], poses[w], x, radius, triangles);
          nearest(setup.walls[w], poses[w], x, radius, triangles, touches, scratch);
          free = touches.empty() && !inside_material(setup.walls[w], poses[w], x);
        }
        if (!free || grains.size() >= count) continue;
        grains.add(std::uint32_t(grains.size() + 1), material, radius, x);
      }
  }
  return grains;
}

// The run's setup with all bodies softened to at most `modulus`, adhesion scaled with E^(2/5), which keeps the speed below
// which grains stick (Haervig et al., Powder Technol. 319 (2017) 377), walls at rest, and impacts that lose most energy.
Setup softened(const Setup& run, double modulus) {
  Setup soft = run;
  for (Material& m : soft.materials) m.young = std::min(m.young, modulus);
  for (std::size_t a = 0; a < run.materials.size(); ++a)
    for (std::size_t b = 0; b < run.materials.size(); ++b) {
      const double ratio = effective_modulus(soft.materials[a], soft.materials[b]) /
                           effective_modulus(run.materials[a], run.materials[b]);
      soft.interactions[a][b].work_of_adhesion *= std::pow(ratio, 0.4);
      soft.interactions[a][b].restitution = std::min(soft.interactions[a][b].restitution, 0.3);
    }
  for (Wall& w : soft.walls) w.motion = resting_at(w.motion, 0);
  return soft;
}

struct Stage {
  std::string name;
  double step, drag;         // s, 1/s
  double shortest, longest;  // s; grains that begin to fall look as if they were at rest, so a stage must last a while
  double rest;               // J, the stage ends when the kinetic energy stays below
};

struct Recipe {
  const std::function<void(const BedProgress&)>& progress;
  const std::function<bool()>& interrupted;

  // Runs one stage from the given grains and contacts; returns where it ended.
  State run(Setup setup, State state, const Stage& stage) const {
    setup.step = stage.step;
    setup.drag = stage.drag;
    state.step = 0;
    state.force.clear();
    state.torque.clear();
    Simulation sim(std::move(setup), std::move(state));
    const std::uint64_t total = std::uint64_t(std::ceil(stage.longest / stage.step));
    const std::uint64_t least = std::uint64_t(stage.shortest / stage.step);
    const std::uint64_t block = std::max<std::uint64_t>(total / 200, 50);
    int calm = 0;
    while (sim.step() < total && calm < 3) {
      sim.advance(std::min(block, total - sim.step()));
      const double energy = sim.kinetic_energy();
      calm = sim.step() >= least && energy < stage.rest ? calm + 1 : 0;
      if (progress) progress({stage.name, sim.time(), stage.longest, sim.particles().size(), energy});
      if (interrupted && interrupted()) throw BedInterrupted("interrupted while the bed was settling");
    }
    return sim.state();
  }
};

// Removes grains whose centre is above `height`; contacts of the others stay.
State cut(const State& state, double height) {
  State kept;
  std::vector<std::uint32_t> row(state.particles.size(), UINT32_MAX);
  const Particles& p = state.particles;
  for (std::size_t i = 0; i < p.size(); ++i)
    if (p.position[i].z() <= height) {
      row[i] = std::uint32_t(kept.particles.size());
      kept.particles.add(row[i] + 1, p.material[i], p.radius[i], p.position[i], p.velocity[i], p.angular_velocity[i]);
    }
  for (State::Pair c : state.pairs)
    if (row[c.i] != UINT32_MAX && row[c.j] != UINT32_MAX) {
      c.i = row[c.i];
      c.j = row[c.j];
      kept.pairs.push_back(c);
    }
  for (State::WallPair c : state.wall_pairs)
    if (row[c.i] != UINT32_MAX) {
      c.i = row[c.i];
      kept.wall_pairs.push_back(c);
    }
  return kept;
}

// Share of the slice [low, high] of the vessel that spheres fill; exact for each sphere by its two caps.
double solid_fraction(const Particles& p, double vessel_radius, double low, double high) {
  if (!(high > low)) return 0;
  double volume = 0;
  // Volume of the part of a sphere below z: pi h^2 (3R - h)/3 with h its depth.
  const auto below = [](double radius, double centre, double z) {
    const double h = std::clamp(z - (centre - radius), 0.0, 2 * radius);
    return std::numbers::pi * h * h * (3 * radius - h) / 3;
  };
  for (std::size_t i = 0; i < p.size(); ++i)
    volume += below(p.radius[i], p.position[i].z(), high) - below(p.radius[i], p.position[i].z(), low);
  return volume / (std::numbers::pi * vessel_radius * vessel_radius * (high - low));
}

std::string pressure(double value) {
  std::array<char, 32> text{};
  if (value >= 1e9)
    std::snprintf(text.data(), text.size(), "%.3g GPa", value * 1e-9);
  else
    std::snprintf(text.data(), text.size(), "%.3g MPa", value * 1e-6);
  return text.data();
}

}  // namespace

SettledBed make_bed(const Setup& setup, const Bed& bed, std::uint8_t material, double vessel_radius,
                    const std::function<void(const BedProgress&)>& progress,
                    const std::function<bool()>& interrupted) {
  const Material& glass = setup.materials[material];
  const double d = bed.mean_diameter, smallest = 0.5 * bed.size_low * d, gravity = setup.gravity.norm();
  if (!(gravity > 0)) throw CaseError("a bed settles under gravity; it is zero here");
  // E[(d_i/d)^3] of a uniform distribution.
  const double moment = (std::pow(bed.size_high, 4) - std::pow(bed.size_low, 4)) / 4 /
                        std::max(bed.size_high - bed.size_low, 1e-12);
  const double mean_volume = sphere_volume(0.5 * d) * (bed.size_high > bed.size_low ? moment : std::pow(bed.size_low, 3));
  const double bed_volume = std::numbers::pi * vessel_radius * vessel_radius * (bed.depth + 1.5 * d);
  const double wanted = 0.66 * bed_volume / mean_volume;
  if (!(wanted >= 1)) throw CaseError("the bed is empty: a depth of " + std::to_string(bed.depth * 1e3) + " mm holds no grain");
  const std::size_t count = std::size_t(wanted);

  const Recipe recipe{progress, interrupted};
  const double grain_mass = glass.density * mean_volume;
  const double rest = 1e-3 * double(count) * grain_mass * gravity * d;
  // Soft enough for a large step, stiff enough that the weight of the bed presses grains by a few thousandths of a diameter.
  const double soft = std::min(glass.young, std::max(2e4 * glass.density * gravity * bed.depth, 1e6));
  const auto step_at = [&](double modulus) {
    Material m = glass;
    m.young = std::min(modulus, glass.young);
    return 0.15 * rayleigh_time(m, smallest);
  };

  State state;
  state.particles = loose_column(setup, bed, material, vessel_radius, count);
  double top = 0;
  for (const Vec3& x : state.particles.position) top = std::max(top, x.z());
  const double fall = std::sqrt(2 * top / gravity);
  state = recipe.run(softened(setup, soft), std::move(state), {"pouring", step_at(soft), 2 / fall, fall, 6 * fall, rest});
  state = cut(state, bed.depth);
  const double layers = bed.depth / d + 1;
  state = recipe.run(softened(setup, soft), std::move(state),
                     {"cutting", step_at(soft), 2 / fall, 0.3 * fall, 2 * fall, 0.1 * rest});

  // Each time the modulus grows tenfold the old overlaps push the grains apart; they then sink by what the overlaps shrink.
  double overlap = d * std::pow(glass.density * gravity * bed.depth / soft, 2.0 / 3.0);
  for (double modulus = soft; modulus < glass.young;) {
    modulus = std::min(10 * modulus, glass.young);
    const double sink = 4 * std::sqrt(2 * overlap * layers / gravity);
    const double step = modulus < glass.young ? step_at(modulus) : std::min(step_at(modulus), setup.step);
    // Grains that lose a support roll on to the next one, which takes them about 20 ms; while steps are cheap they get it.
    const double shortest = std::max(0.5 * sink, std::min(20e-3, 20000 * step));
    state = recipe.run(softened(setup, modulus), std::move(state),
                       {"stiffening to " + pressure(modulus), step, 4 / sink, shortest, std::max(sink, 1.5 * shortest), 0.01 * rest});
    overlap *= std::pow(10, -2.0 / 3.0);
  }
  // At the true stiffness, adhesion and restitution: long enough for a grain without support to fall by micrometres, much
  // more than the overlaps that are left.
  Setup still = setup;
  for (Wall& w : still.walls) w.motion = resting_at(w.motion, 0);
  state = recipe.run(still, std::move(state), {"resting", setup.step, 2e3, 1e-3, 2e-3, 0.01 * rest});

  SettledBed result;
  still.step = setup.step;
  still.drag = 0;
  State probe = state;
  probe.step = 0;
  probe.force.clear();
  probe.torque.clear();
  Simulation check(still, std::move(probe));
  const View view = check.view();
  result.report.grains = view.id.size();
  if (result.report.grains == 0) throw CaseError("the bed is empty: no grain lies below its depth");
  result.report.coordination = 2.0 * double(view.pairs.size()) / double(view.id.size());
  result.report.kinetic_energy = check.kinetic_energy();
  result.report.rest_scale = 1e-3 * double(view.id.size()) * grain_mass * gravity * d;
  for (const PairRecord& c : view.pairs)
    result.report.largest_overlap = std::max(result.report.largest_overlap, c.overlap / std::min(view.radius[c.i], view.radius[c.j]));
  result.report.solid_fraction = solid_fraction(state.particles, vessel_radius, d, bed.depth - d);
  for (const Vec3& x : view.position) result.report.top = std::max(result.report.top, x.z());
  if (!(result.report.kinetic_energy < result.report.rest_scale)) {
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(),
                  "the bed is not at rest: %zu grains hold %.3g J of kinetic energy, expected below %.3g J",
                  result.report.grains, result.report.kinetic_energy, result.report.rest_scale);
    throw PhysicsError(text.data());
  }
  for (Vec3& v : state.particles.velocity) v.setZero();
  for (Vec3& w : state.particles.angular_velocity) w.setZero();
  for (State::Pair& c : state.pairs) c.birth_step = 0;
  for (State::WallPair& c : state.wall_pairs) c.birth_step = 0;
  state.step = 0;
  state.force.clear();
  state.torque.clear();
  result.state = std::move(state);
  return result;
}

}  // namespace dem
