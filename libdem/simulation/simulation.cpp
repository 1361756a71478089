#include "libdem/simulation/simulation.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "libdem/contact/forces.hpp"
#include "libdem/errors.hpp"
#include "libdem/neighbors/pair_list.hpp"
#include "libdem/simulation/guards.hpp"

namespace dem {
namespace {

// Below this many grains waking other threads costs more than they save.
constexpr std::size_t few_grains = 500;

}  // namespace

struct Simulation::Engine {
  Setup setup;
  MaterialTable materials;
  std::uint64_t step = 0;
  Particles p;
  std::vector<double> mass, inertia;
  std::vector<Vec3> force, torque;
  std::vector<double> compressive;
  std::vector<Vec3> listed_position;  // where the grains were when the lists were built
  std::vector<WallPose> poses;
  double mean_radius = 1, skin = 0;  // m
  std::uint64_t listed_step = 0;
  double wall_travel = 0;  // m, upper bound of the walls' movement since the lists were built
  double wall_speed = 0;   // m/s, upper bound
  PairContacts pairs;
  WallContacts walls;
  std::vector<WallLoad> loads;  // [walls] of the last evaluation
  bool rolling_spring = false;

  LedgerSums spent;
  double initial_energy = 0;                  // J
  std::vector<double> wall_work, last_power;  // [walls] J, W

  Window window;
  std::vector<Window::Load> load_sum;

  Engine(Setup s, State state) : setup(std::move(s)), step(state.step), p(std::move(state.particles)) {
    check_input();
    materials = make_material_table(setup.materials, setup.interactions, setup.law);
    const std::size_t n = p.size();
    mass.resize(n);
    inertia.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      mass[i] = setup.materials[p.material[i]].density * sphere_volume(p.radius[i]);
      inertia[i] = sphere_inertia(mass[i], p.radius[i]);
    }
    compressive.assign(n, 0.0);
    rolling_spring = with_part<RollingLaws>(setup.law.rolling, [](auto part) { return part.has_spring; });
    wall_work.assign(setup.walls.size(), 0.0);
    last_power.assign(setup.walls.size(), 0.0);
    mean_radius = n ? std::accumulate(p.radius.begin(), p.radius.end(), 0.0) / double(n) : 1.0;
    skin = 0.1 * mean_radius;
    for (const Wall& w : setup.walls) wall_speed = std::max(wall_speed, largest_speed(w));
    move_walls();
    build_lists();
    remember(state);
    begin_window();
    if (state.force.empty()) {
      force.assign(n, Vec3::Zero());
      torque.assign(n, Vec3::Zero());
      evaluate(0.0);
      sum_and_move(false);
      sum_wall_loads();
      begin_window();  // windows cover the steps after the start
      for (std::size_t w = 0; w < loads.size(); ++w) last_power[w] = power_into_grains(w);
      if (setup.keep_ledger) initial_energy = ledger().total();
    } else {
      force = std::move(state.force);
      torque = std::move(state.torque);
      sum_wall_loads();
      if (setup.keep_ledger) {
        spent = state.ledger.spent;
        initial_energy = state.ledger.initial;
        wall_work = state.ledger.wall_work;
        last_power = state.ledger.last_power;
      }
    }
  }

  void check_input() const {
    const std::size_t n = p.size(), m = setup.materials.size();
    if (!(setup.step > 0)) throw CaseError("the time step is " + number(setup.step) + " s, expected > 0");
    if (const auto why = incompatible(setup.law)) throw CaseError(*why);
    if (!(setup.local_damping >= 0 && setup.local_damping < 1))
      throw CaseError("the local damping is " + number(setup.local_damping) + ", expected 0 <= damping < 1");
    if (setup.keep_ledger && setup.local_damping != 0)
      throw CaseError("an energy ledger knows no local damping, got " + number(setup.local_damping));
    if (setup.interactions.size() != m) throw CaseError("expected one row of interactions per material");
    for (const auto& row : setup.interactions)
      if (row.size() != m) throw CaseError("expected one interaction per pair of materials");
    if (p.material.size() != n || p.radius.size() != n || p.position.size() != n || p.velocity.size() != n ||
        p.angular_velocity.size() != n)
      throw CaseError("the grains' arrays differ in length");
    for (std::size_t i = 0; i < n; ++i)
      if (p.material[i] >= m || !(p.radius[i] > 0) || !p.position[i].allFinite())
        throw CaseError("grain " + std::to_string(p.id[i]) + " has no material, radius or position");
    for (const Wall& w : setup.walls) {
      if (w.material >= m) throw CaseError("wall '" + w.name + "' has no material");
      validate_wall(w);
    }
  }

  double time() const { return double(step) * setup.step; }

  void move_walls() {
    poses.resize(setup.walls.size());
    for (std::size_t w = 0; w < poses.size(); ++w) poses[w] = pose_at(setup.walls[w].motion, time());
  }

  void evaluate(double dt) {
    const double overlap =
        evaluate_contacts(setup.law, setup.keep_ledger, {p, materials, setup.walls, poses, dt, step, setup.wall_curvature}, pairs, walls);
    window.largest_overlap = std::max(window.largest_overlap, overlap);
    if (setup.keep_ledger && dt > 0) {
      for (const PairContacts::Chunk& chunk : pairs.chunk) spent += chunk.ledger;
      for (const WallContacts::Chunk& chunk : walls.chunk) spent += chunk.ledger;
    }
  }

  // Candidates around the present positions; memory of formed contacts is kept.
  void build_lists() {
    const std::size_t n = p.size();
    PairContacts fresh;
    fresh.list = build_pair_list(p.position, p.radius, skin);
    const std::size_t count = fresh.list.size();
    fresh.memory.resize(count);
    fresh.result.resize(count);
    fresh.acts.assign(count, 0);
    fresh.bodies.resize(count);
    fresh.material_pair.resize(count);
    if (rolling_spring) fresh.rolling.assign(count, Vec3::Zero());
    if (setup.keep_ledger) fresh.last.resize(count);
    fresh.chunk.resize((n + PairContacts::chunk_rows - 1) / PairContacts::chunk_rows);
    double reach = 0;
#pragma omp parallel for schedule(static) reduction(max : reach)
    for (std::size_t i = 0; i < n; ++i) {
      std::size_t old = pairs.list.begin.empty() ? 0 : pairs.list.begin[i];
      const std::size_t old_end = pairs.list.begin.empty() ? 0 : pairs.list.begin[i + 1];
      for (std::size_t s = fresh.list.begin[i]; s < fresh.list.begin[i + 1]; ++s) {
        const std::uint32_t j = fresh.list.second[s];
        const std::size_t pair = p.material[i] * materials.size + p.material[j];
        const PairConstants<double> c =
            pair_constants(materials.pair[pair], {p.radius[i], mass[i], inertia[i]}, {p.radius[j], mass[j], inertia[j]});
        fresh.bodies[s] = {c.effective_radius, c.effective_mass, c.effective_inertia, c.adhesion_length};
        fresh.material_pair[s] = std::uint32_t(pair);
        reach = std::max(reach, -with_part<NormalLaws>(setup.law.normal, [&](auto part) { return part.form_overlap(c); }));
        while (old < old_end && pairs.list.second[old] < j) ++old;
        if (old < old_end && pairs.list.second[old] == j) {
          fresh.memory[s] = pairs.memory[old];
          if (rolling_spring) fresh.rolling[s] = pairs.rolling[old];
          if (setup.keep_ledger) fresh.last[s] = pairs.last[old];
        }
      }
    }
    fresh.reach_beyond_touch = reach;
    pairs = std::move(fresh);
    build_wall_lists();
    listed_position = p.position;
    listed_step = step;
    wall_travel = 0;
  }

  // Thin lists hold little more than the contacts, thick ones are built less often. The aim is a list that lasts a few hundred
  // steps; forces do not depend on it.
  void adapt_skin() {
    const std::uint64_t lasted = step - listed_step;
    if (lasted < 100) skin = std::min(1.5 * skin, mean_radius);
    if (lasted > 1000) skin = std::max(0.8 * skin, 0.05 * mean_radius);
  }

  void build_wall_lists() {
    const std::size_t n = p.size();
    std::map<std::pair<std::uint32_t, std::uint32_t>, const WallCandidate*> old;
    for (const WallCandidate& c : walls.candidate)
      if (c.size > 0) old[{c.wall, c.particle}] = &c;
    WallContacts fresh;
    for (std::uint32_t w = 0; w < setup.walls.size(); ++w) {
      const std::uint32_t first = std::uint32_t(fresh.candidate.size());
      for (std::uint32_t i = 0; i < n; ++i) {
        const double reach = p.radius[i] + skin;
        if (!near(setup.walls[w], poses[w], p.position[i], reach)) continue;
        WallCandidate c{};
        c.particle = i;
        c.wall = w;
        c.part_begin = std::uint32_t(fresh.parts.size());
        candidate_parts(setup.walls[w], poses[w], p.position[i], reach, fresh.parts);
        c.part_end = std::uint32_t(fresh.parts.size());
        if (std::holds_alternative<MeshWall>(setup.walls[w].shape) && c.part_begin == c.part_end) continue;
        c.constants = wall_constants(materials(p.material[i], setup.walls[w].material),
                                     {p.radius[i], mass[i], inertia[i]});
        if (const auto known = old.find({w, i}); known != old.end()) {
          c.size = known->second->size;
          c.contact = known->second->contact;
        }
        fresh.candidate.push_back(c);
      }
      const std::uint32_t last = std::uint32_t(fresh.candidate.size());
      const auto block = [&](std::uint32_t q) { return fresh.candidate[q].particle / WallContacts::chunk_rows; };
      for (std::uint32_t q = first; q < last; ++q) {
        if (q == first || block(q) != block(q - 1)) {
          fresh.chunk.emplace_back();
          fresh.chunk.back().wall = w;
          fresh.chunk.back().begin = q;
        }
        fresh.chunk.back().end = q + 1;
      }
    }
    fresh.acts.assign(fresh.candidate.size(), 0);
    fresh.of_particle_begin.assign(n + 1, 0);
    for (const WallCandidate& c : fresh.candidate) ++fresh.of_particle_begin[c.particle + 1];
    for (std::size_t i = 0; i < n; ++i) fresh.of_particle_begin[i + 1] += fresh.of_particle_begin[i];
    fresh.of_particle.resize(fresh.candidate.size());
    std::vector<std::uint32_t> next(fresh.of_particle_begin.begin(), fresh.of_particle_begin.end() - 1);
    for (std::uint32_t c = 0; c < fresh.candidate.size(); ++c) fresh.of_particle[next[fresh.candidate[c].particle]++] = c;
    walls = std::move(fresh);
  }

  // Puts the memory of a stored state into the fresh lists.
  void remember(const State& state) {
    const std::size_t n = p.size();
    const bool goes_on = setup.keep_ledger && !state.force.empty();
    if (goes_on && (state.ledger.pairs.size() != state.pairs.size() ||
                    state.ledger.wall_pairs.size() != state.wall_pairs.size() ||
                    state.ledger.wall_work.size() != setup.walls.size() || state.ledger.last_power.size() != setup.walls.size()))
      throw CaseError("the stored state has no energy ledger to go on with");
    for (std::size_t k = 0; k < state.pairs.size(); ++k) {
      const State::Pair& stored = state.pairs[k];
      if (stored.i >= n || stored.j >= n || stored.i >= stored.j)
        throw CaseError("the stored state has a contact between grains that it does not have");
      const auto begin = pairs.list.second.begin() + pairs.list.begin[stored.i];
      const auto end = pairs.list.second.begin() + pairs.list.begin[stored.i + 1];
      const auto found = std::lower_bound(begin, end, stored.j);
      if (found == end || *found != stored.j)
        throw CaseError("the stored state has a contact between grains that are apart");
      const std::size_t slot = std::size_t(found - pairs.list.second.begin());
      pairs.memory[slot] = {stored.spring, stored.contact_radius, stored.birth_step, true};
      if (rolling_spring) pairs.rolling[slot] = stored.rolling;
      if (goes_on) pairs.last[slot] = state.ledger.pairs[k];
    }
    for (std::size_t k = 0; k < state.wall_pairs.size(); ++k) {
      const State::WallPair& stored = state.wall_pairs[k];
      WallCandidate* candidate = nullptr;
      if (stored.i < n)
        for (std::uint32_t q = walls.of_particle_begin[stored.i]; q < walls.of_particle_begin[stored.i + 1]; ++q)
          if (walls.candidate[walls.of_particle[q]].wall == stored.wall) candidate = &walls.candidate[walls.of_particle[q]];
      if (!candidate || candidate->size == WallCandidate::capacity)
        throw CaseError("the stored state has a contact with a wall that is not there");
      WallContact& contact = candidate->contact[candidate->size++];
      contact = WallContact{};
      contact.touch.feature = stored.feature;
      contact.touch.normal = stored.normal;
      contact.touch.distance = stored.distance;
      contact.touch.curvature = stored.curvature;
      contact.memory = {stored.spring, stored.contact_radius, stored.birth_step, true};
      contact.rolling = stored.rolling;
      if (goes_on) contact.last = state.ledger.wall_pairs[k];
    }
  }

  // Sums the forces on every grain in a fixed order (own pairs, incoming pairs, walls) and, if asked to, moves it.
  // Returns the square of the largest movement since the lists were built.
  double sum_and_move(bool move) {
    const std::size_t n = p.size();
    double travel2 = 0, largest_compressive = 0;
    std::uint32_t watched = 0;
#pragma omp parallel for schedule(static) reduction(max : travel2, largest_compressive) reduction(+ : watched) if (n > few_grains)
    for (std::size_t i = 0; i < n; ++i) {
      Vec3 f = mass[i] * setup.gravity, t = Vec3::Zero();
      double pressed = 0;
      for (std::uint32_t s = pairs.list.begin[i]; s < pairs.list.begin[i + 1]; ++s) {
        if (!pairs.acts[s]) continue;
        const PairForce& r = pairs.result[s];
        f += r.force;
        t += r.torque_i;
        pressed += std::max(r.elastic + r.damping, 0.0);
      }
      for (std::uint32_t k = pairs.list.incoming_begin[i]; k < pairs.list.incoming_begin[i + 1]; ++k) {
        if (!pairs.acts[pairs.list.incoming[k]]) continue;
        const PairForce& r = pairs.result[pairs.list.incoming[k]];
        f -= r.force;
        t += r.torque_j;
        pressed += std::max(r.elastic + r.damping, 0.0);
      }
      for (std::uint32_t k = walls.of_particle_begin[i]; k < walls.of_particle_begin[i + 1]; ++k) {
        if (!walls.acts[walls.of_particle[k]]) continue;
        const WallCandidate& candidate = walls.candidate[walls.of_particle[k]];
        for (std::size_t c = 0; c < candidate.size; ++c) {
          const WallContact& r = candidate.contact[c];
          if (!r.acts) continue;
          f += r.force;
          t += r.torque;
          pressed += std::max(r.elastic + r.damping, 0.0);
        }
      }
      force[i] = f;
      torque[i] = t;
      compressive[i] = pressed;
      largest_compressive = std::max(largest_compressive, pressed);
      watched += pressed > setup.watch_force ? 1 : 0;
      if (move) travel2 = std::max(travel2, kick_and_drift(i));
    }
    window.largest_compressive_force = std::max(window.largest_compressive_force, largest_compressive);
    window.most_watched = std::max(window.most_watched, watched);
    return travel2;
  }

  // The change of a velocity in one step under local damping; the velocity in the middle of the step says which way it goes.
  Vec3 damped(const Vec3& velocity, const Vec3& change) const {
    const double speeding_up = change.dot(velocity + 0.5 * change);
    const double share = speeding_up > 0 ? 1 - setup.local_damping : 1 + setup.local_damping;
    return share * change;
  }

  double kick_and_drift(std::size_t i) {
    const double dt = setup.step;
    const Vec3 kick = (dt / mass[i]) * force[i], turn = (dt / inertia[i]) * torque[i];
    const bool plain = setup.local_damping == 0;
    p.velocity[i] += plain ? kick : damped(p.velocity[i], kick);
    p.angular_velocity[i] += plain ? turn : damped(p.angular_velocity[i], turn);
    p.position[i] += dt * p.velocity[i];
    return (p.position[i] - listed_position[i]).squaredNorm();
  }

  double move_all() {
    double travel2 = 0;
#pragma omp parallel for schedule(static) reduction(max : travel2) if (p.size() > few_grains)
    for (std::size_t i = 0; i < p.size(); ++i)
      travel2 = std::max(travel2, kick_and_drift(i));
    return travel2;
  }

  void begin_window() {
    window = Window{};
    window.first_step = window.last_step = step;
    const double inf = std::numeric_limits<double>::infinity();
    Window::Load empty;
    empty.force_min = empty.torque_min = Vec3::Constant(inf);
    empty.force_max = empty.torque_max = Vec3::Constant(-inf);
    load_sum.assign(setup.walls.size(), empty);
  }

  void sum_wall_loads() {
    loads.assign(setup.walls.size(), WallLoad{});
    for (const WallContacts::Chunk& chunk : walls.chunk) loads[chunk.wall] += chunk.load;
  }

  // W, that the wall puts into the grains at this instant.
  double power_into_grains(std::size_t w) const {
    return -(loads[w].force.dot(poses[w].velocity) + loads[w].torque.dot(poses[w].angular_velocity));
  }

  void record_walls() {
    sum_wall_loads();
    for (const WallContacts::Chunk& chunk : walls.chunk)
      for (std::size_t l = 0; l < facet_labels; ++l) load_sum[chunk.wall].of_label[l] += chunk.load_of_label[l];
    for (std::size_t w = 0; w < setup.walls.size(); ++w) {
      Window::Load& sum = load_sum[w];
      sum.force += loads[w].force;
      sum.torque += loads[w].torque;
      sum.force_min = sum.force_min.cwiseMin(loads[w].force);
      sum.force_max = sum.force_max.cwiseMax(loads[w].force);
      sum.torque_min = sum.torque_min.cwiseMin(loads[w].torque);
      sum.torque_max = sum.torque_max.cwiseMax(loads[w].torque);
      const double power = power_into_grains(w);
      sum.power += power;
      wall_work[w] += 0.5 * setup.step * (last_power[w] + power);
      last_power[w] = power;
    }
  }

  void advance(std::uint64_t steps) {
    if (steps == 0) return;
    double travel2 = move_all();
    for (std::uint64_t k = 1; k <= steps; ++k) {
      ++step;
      move_walls();
      wall_travel += wall_speed * setup.step;
      const double travel = std::sqrt(travel2);
      // Two grains may have come 2 * travel closer, a grain and a wall travel + wall_travel.
      if (!(2 * travel < skin && travel + wall_travel < skin)) {
        guard();
        adapt_skin();
        build_lists();
      }
      evaluate(setup.step);
      if (!(window.largest_overlap < runaway_overlap)) stop_for_overlap(guarded());
      travel2 = sum_and_move(k < steps);
      record_walls();
    }
    guard();
  }

  GuardInput guarded() const { return {setup, p, mass, inertia, materials, pairs, walls, time()}; }
  void guard() const {
    check_motion(guarded());
    check_stable_step(guarded());
  }

  double kinetic_energy() const {
    double energy = 0;
    for (std::size_t i = 0; i < p.size(); ++i)
      energy += 0.5 * mass[i] * p.velocity[i].squaredNorm() + 0.5 * inertia[i] * p.angular_velocity[i].squaredNorm();
    return energy;
  }

  Ledger ledger() const {
    Ledger sum;
    if (!setup.keep_ledger) return sum;
    for (std::size_t i = 0; i < p.size(); ++i) {
      sum.kinetic += 0.5 * p.velocity[i].dot(mass[i] * p.velocity[i] + setup.step * force[i]);
      sum.rotational += 0.5 * p.angular_velocity[i].dot(inertia[i] * p.angular_velocity[i] + setup.step * torque[i]);
      sum.gravitational -= mass[i] * setup.gravity.dot(p.position[i]);
    }
    for (const LastForces& last : pairs.last) sum.stored += last.energy();
    for (const WallCandidate& c : walls.candidate)
      for (std::size_t k = 0; k < c.size; ++k) sum.stored += c.contact[k].last.energy();
    sum.spent = spent;
    sum.wall_work = wall_work;
    sum.initial = initial_energy;
    return sum;
  }
};

Simulation::Simulation(Setup setup, State state) : engine_(std::make_unique<Engine>(std::move(setup), std::move(state))) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

void Simulation::advance(std::uint64_t steps) { engine_->advance(steps); }
std::uint64_t Simulation::step() const { return engine_->step; }
double Simulation::time() const { return engine_->time(); }
const Setup& Simulation::setup() const { return engine_->setup; }
const Particles& Simulation::particles() const { return engine_->p; }
double Simulation::kinetic_energy() const { return engine_->kinetic_energy(); }
Ledger Simulation::ledger() const { return engine_->ledger(); }
double Simulation::stable_step() const { return dem::stable_step(engine_->guarded()); }

std::size_t Simulation::contacts() const {
  std::size_t count = 0;
  for (std::uint8_t a : engine_->pairs.acts) count += a;
  for (std::uint8_t a : engine_->walls.acts) count += a;
  return count;
}

State Simulation::state() const {
  const Engine& e = *engine_;
  State state;
  state.step = e.step;
  state.particles = e.p;
  state.force = e.force;
  state.torque = e.torque;
  const bool ledger = e.setup.keep_ledger;
  for (std::size_t s = 0; s < e.pairs.list.size(); ++s) {
    const ContactMemory& m = e.pairs.memory[s];
    if (!m.touched) continue;
    state.pairs.push_back({e.pairs.list.first[s], e.pairs.list.second[s], m.spring, m.birth_step, m.contact_radius,
                           e.rolling_spring ? e.pairs.rolling[s] : Vec3(Vec3::Zero())});
    if (ledger) state.ledger.pairs.push_back(e.pairs.last[s]);
  }
  for (std::uint32_t i = 0; i < e.p.size(); ++i)
    for (std::uint32_t k = e.walls.of_particle_begin[i]; k < e.walls.of_particle_begin[i + 1]; ++k) {
      const WallCandidate& c = e.walls.candidate[e.walls.of_particle[k]];
      for (std::size_t q = 0; q < c.size; ++q) {
        const WallContact& w = c.contact[q];
        if (!w.memory.touched) continue;
        state.wall_pairs.push_back({i, c.wall, w.touch.feature, w.touch.normal, w.memory.spring, w.memory.birth_step,
                                    w.memory.contact_radius, w.rolling, w.touch.distance, w.touch.curvature});
        if (ledger) state.ledger.wall_pairs.push_back(w.last);
      }
    }
  if (ledger) {
    state.ledger.spent = e.spent;
    state.ledger.initial = e.initial_energy;
    state.ledger.wall_work = e.wall_work;
    state.ledger.last_power = e.last_power;
  }
  return state;
}

View Simulation::view() const {
  const Engine& e = *engine_;
  const std::size_t n = e.p.size();
  const double half = 0.5 * e.setup.step;
  View view;
  view.step = e.step;
  view.time = e.time();
  view.id = e.p.id;
  view.material = e.p.material;
  view.radius = e.p.radius;
  view.position = e.p.position;
  view.compressive_force = e.compressive;
  view.velocity.resize(n);
  view.angular_velocity.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    view.velocity[i] = e.p.velocity[i] + half / e.mass[i] * e.force[i];
    view.angular_velocity[i] = e.p.angular_velocity[i] + half / e.inertia[i] * e.torque[i];
  }
  for (std::size_t s = 0; s < e.pairs.list.size(); ++s) {
    if (!e.pairs.acts[s]) continue;
    const PairForce& r = e.pairs.result[s];
    const std::uint32_t i = e.pairs.list.first[s], j = e.pairs.list.second[s];
    const Vec3 branch = e.p.position[j] - e.p.position[i];
    const double distance = branch.norm();
    view.pairs.push_back({i, j, e.p.radius[i] + e.p.radius[j] - distance, r.elastic, r.damping,
                          r.force + branch * ((r.elastic + r.damping) / distance), e.pairs.memory[s].birth_step, r.sliding});
  }
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t k = e.walls.of_particle_begin[i]; k < e.walls.of_particle_begin[i + 1]; ++k) {
      const WallCandidate& c = e.walls.candidate[e.walls.of_particle[k]];
      for (std::size_t q = 0; q < c.size; ++q) {
        const WallContact& r = c.contact[q];
        if (!r.acts) continue;
        view.wall_pairs.push_back({i, c.wall, r.touch.facet, r.touch.kind, r.touch.point, r.touch.normal,
                                   e.p.radius[i] - r.touch.distance, r.elastic, r.damping, r.tangential,
                                   r.memory.birth_step, r.sliding});
      }
    }
  for (std::size_t w = 0; w < e.poses.size(); ++w) view.walls.push_back({e.poses[w], e.loads[w].force, e.loads[w].torque, {}});
  for (const WallContacts::Chunk& chunk : e.walls.chunk)
    for (std::size_t l = 0; l < facet_labels; ++l) view.walls[chunk.wall].load_of_label[l] += chunk.load_of_label[l];
  return view;
}

double Ledger::work() const { return std::accumulate(wall_work.begin(), wall_work.end(), 0.0); }

double Ledger::work_put_in() const {
  double sum = 0;
  for (const double w : wall_work) sum += std::max(w, 0.0);
  return sum;
}

double Ledger::residual() const {
  return total() - initial - work() + spent.normal_damping + spent.tangential_damping + spent.sliding + spent.rolling +
         spent.detachment - spent.stiffness_change + spent.time_stepping;
}

Window Simulation::take_window() {
  Engine& e = *engine_;
  Window w = e.window;
  w.last_step = e.step;
  w.time = e.time();
  w.kinetic_energy = e.kinetic_energy();
  w.walls = e.load_sum;
  const double steps = double(e.step - w.first_step);
  for (Window::Load& load : w.walls) {
    if (steps == 0) {
      load = Window::Load{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), 0, {}};
      continue;
    }
    for (WallLoad& part : load.of_label) {
      part.force /= steps;
      part.torque /= steps;
    }
    load.force /= steps;
    load.torque /= steps;
    load.power /= steps;
  }
  for (const Wall& wall : e.setup.walls) w.is_mesh.push_back(std::holds_alternative<MeshWall>(wall.shape));
  if (e.setup.keep_ledger) w.ledger = e.ledger();
  e.begin_window();
  return w;
}

}  // namespace dem
