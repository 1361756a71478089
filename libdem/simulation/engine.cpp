#include "libdem/simulation/engine.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <numeric>
#include <span>
#include <string>

#include "libdem/contact/due_list.hpp"
#include "libdem/contact/regroup.hpp"
#include "libdem/errors.hpp"
#include "libdem/simulation/check_input.hpp"

namespace dem {
namespace {

class Stopwatch {
 public:
  // s, the time since the last call.
  void add_to(double& sum) {
    const auto now = std::chrono::steady_clock::now();
    sum += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

Setup checked(Setup setup, const State& state) {
  check_input(setup, state.particles, state.step);
  return setup;
}

double largest_speed(const std::vector<Wall>& walls) {
  double largest = 0;
  for (const Wall& wall : walls) largest = std::max(largest, largest_speed(wall));
  return largest;
}

double smallest_radius(const Particles& p) { return p.size() ? *std::min_element(p.radius.begin(), p.radius.end()) : 0.0; }

bool goes_on(const State& state) { return !state.force.empty(); }

Memory memory_of(State& state, const Setup& setup, std::size_t grains) {
  const bool ledger_goes_on = setup.keep_ledger && goes_on(state);
  if (ledger_goes_on &&
      (state.ledger.pairs.size() != state.pairs.size() || state.ledger.wall_pairs.size() != state.wall_pairs.size() ||
       state.ledger.wall_work.size() != setup.walls.size() || state.ledger.last_power.size() != setup.walls.size()))
    throw CaseError("the stored state has no energy ledger to go on with");
  Memory memory{std::move(state.pairs), {}, std::move(state.wall_pairs), {}};
  check(memory, grains, setup.walls.size());
  for (State::Pair& c : memory.pairs) c.level = goes_on(state) ? std::min(c.level, setup.levels) : 0;
  for (State::WallPair& c : memory.wall_pairs) c.level = goes_on(state) ? std::min(c.level, setup.levels) : 0;
  if (ledger_goes_on) {
    memory.last = std::move(state.ledger.pairs);
    memory.wall_last = std::move(state.ledger.wall_pairs);
  } else if (setup.keep_ledger) {
    memory.last.resize(memory.pairs.size());
    memory.wall_last.resize(memory.wall_pairs.size());
  }
  return memory;
}

}  // namespace

Simulation::Engine::Engine(Setup s, State state)
    : setup(checked(std::move(s), state)),
      materials(make_material_table(setup.materials, setup.interactions, setup.law)),
      step(state.step),
      grains(make_grain_store(std::move(state.particles), setup.materials)),
      foresight(setup.step, setup.levels, largest_speed(setup.walls)),
      watch(setup.watch_force, setup.watch_radius, smallest_radius(grains.caller),
            goes_on(state) ? std::move(state.excursions) : std::vector<Excursion>{}),
      books(setup.walls.size()) {
  const std::vector<double>& radius = grains.caller.radius;
  mean_radius = size() ? std::accumulate(radius.begin(), radius.end(), 0.0) / double(size()) : 1.0;
  skin = 0.1 * mean_radius;
  move_walls();
  const Memory memory = memory_of(state, setup, size());
  if (goes_on(state) && state.layout.chunk_rows == grains.chunks().rows())
    restore_lists(state.layout, memory);
  else
    build_lists(memory, {});
  begin_window();
  goes_on(state) ? go_on(state) : begin();
}

// Windows cover the steps after this.
void Simulation::Engine::begin() {
  find_due();
  foresight.begin(grains.rows, grains.chunks());
  evaluate(true, true, false);
  books.sum(walls, due_chunks, all_due());
  begin_window();
  books.begin_work(poses);
  if (setup.keep_ledger) initial_energy = ledger().total();
}

void Simulation::Engine::go_on(const State& state) {
  const std::size_t n = size();
  if (state.force.size() != n || state.torque.size() != n)
    throw CaseError("the stored state has forces on " + std::to_string(state.force.size()) + " grains, expected " + std::to_string(n));
  for (std::size_t r = 0; r < n; ++r) {
    const std::uint32_t i = grains.order[r];
    grains.forces[r] = {quad(state.force[i], 0), quad(state.torque[i], 0)};
  }
  books.sum(walls, due_chunks, all_due());
  if (!setup.keep_ledger) return;
  spent = state.ledger.spent;
  initial_energy = state.ledger.initial;
  books.work = state.ledger.wall_work;
  books.last_power = state.ledger.last_power;
}

void Simulation::Engine::advance(std::uint64_t steps) {
  if (steps == 0) return;
  if (steps % stride_of_all() != 0)
    throw CaseError("asked to go on for " + std::to_string(steps) + " steps, expected a multiple of " + std::to_string(stride_of_all()));
  Stopwatch stopwatch;
  find_due();
  move_all();
  if (setup.keep_ledger) book_second_half();
  for (std::uint64_t k = 1; k <= steps; ++k) {
    ++step;
    ++effort.steps;
    move_walls();
    foresight.go_on();
    find_due();
    if (all_due()) {
      foresight.look_ahead();
      if (lists_may_be_used_up() || regrouping_is_due()) {
        stopwatch.add_to(effort.rest);
        if (lists_may_be_used_up()) renew_lists();
        if (regrouping_is_due()) regroup(pairs, grains.table(), materials, setup.resolution());
        stopwatch.add_to(effort.listing);
      }
    }
    stopwatch.add_to(effort.rest);
    evaluate(false, k == steps, k < steps);
    stopwatch.add_to(effort.stepping);
    if (!(window.largest_overlap < runaway_overlap)) stop();
    count_evaluations();
    if (setup.keep_ledger) {
      book_first_half();
      if (k < steps) book_second_half();
    }
    books.record(walls, due_chunks, all_due(), poses, setup.step);
  }
  show(grains);
  guard();
  stopwatch.add_to(effort.rest);
}

void Simulation::Engine::move_walls() {
  poses.resize(setup.walls.size());
  for (std::size_t w = 0; w < poses.size(); ++w) poses[w] = pose_at(setup.walls[w].motion, time());
}

void Simulation::Engine::find_due() {
  due = due_at(step, setup.levels);
  due_chunks.clear();
  for (std::uint32_t c = 0; c < chunk_level.size(); ++c)
    if (chunk_level[c] <= due) due_chunks.push_back(c);
}

ForceInput Simulation::Engine::force_input(bool look, bool record) const {
  return {.grains = grains.rows, .materials = materials, .walls = setup.walls, .poses = poses, .step_length = setup.step,
          .step = step, .odometer = foresight.odometer, .wall_curvature = setup.wall_curvature, .record = record, .look = look,
          .due = due, .highest = setup.levels, .foresight = foresight.until_all_due, .jolt = foresight.closing_jolt, .level = grains.level,
          .spun = grains.spun, .chunks = grains.chunks(), .due_chunks = due_chunks};
}

double Simulation::Engine::evaluate_with(bool look, bool record, const FinishChunk& finish) {
  return evaluate_contacts(setup.law, setup.keep_ledger, force_input(look, record), pairs, walls, {sheets, grains.asked}, finish);
}

// Forces on every grain that is due; gives it its level and, if asked to, moves it.
void Simulation::Engine::evaluate(bool look, bool record, bool move) {
  if (move) grains.shown = false;
  const auto finish = [&](std::size_t d, ForceSheet& sheet) {
    setup.levels == 0 ? finish_chunk<false>(d, sheet, move) : finish_chunk<true>(d, sheet, move);
  };
  window.largest_overlap = std::max(window.largest_overlap, evaluate_with(look, record, finish));
  for (const std::uint32_t c : due_chunks) {
    window.largest_compressive_force = std::max(window.largest_compressive_force, watch.largest(c));
    window.ended_pairs += pairs.chunk[c].ended;
  }
  for_each_due_wall_chunk([&](const WallContacts::Chunk& chunk) { window.ended_wall_pairs += chunk.ended; });
  if (!all_due()) return;
  const std::size_t above = watch.follow(step, setup.step * double(stride_of_all()), walls, poses);
  window.most_watched = std::max(window.most_watched, std::uint32_t(above));
}

MotionColumns Simulation::Engine::columns() {
  return {grains.rows.data(), grains.spun.data(), grains.level.data(), grains.asked.data(), setup.step, setup.local_damping, setup.levels};
}

// What evaluate() does to the grains of a chunk that are due, when the contacts' forces on them are there.
template <bool Levels>
void Simulation::Engine::finish_chunk(std::size_t d, ForceSheet& forces, bool move) {
  const std::uint32_t c = due_chunks[d];
  const MotionColumns on = columns();
  const Vec4 gravity = quad(setup.gravity, 0);
  const std::size_t begin = grains.chunks().begin(c), end = grains.chunks().end(c);
  std::array<std::uint32_t, RowChunks::most_rows> places;
  std::span<const std::uint32_t> rows(places.data(), end - begin);
  double gravity_shift = 0;
  if constexpr (Levels) {
    const std::span<const std::uint8_t> levels(on.level + begin, end - begin);
    rows = list_due(levels, due, std::uint32_t(begin), places);
    for (const std::uint32_t i : rows) {
      const std::uint8_t before = on.level[i], level = std::min(on.asked[i], due);
      on.level[i] = level;
      if (level != before) gravity_shift += 0.5 * (stride(level) - stride(before)) * on.rows[i].mass() * gravity.dot(on.rows[i].motion);
    }
    chunk_level[c] = std::ranges::min(levels);
  } else {
    std::iota(places.begin(), places.begin() + rows.size(), std::uint32_t(begin));
  }

  watch.look(c, grains, rows, forces);
  ChunkMotion motion;
  for (const std::uint32_t i : rows) {
    ForceRow& acting = forces[i - begin];
    acting.force += (Levels ? stride(on.level[i]) * on.rows[i].mass() : on.rows[i].mass()) * gravity;
    if (move) kick_and_drift<Levels>(on, i, acting, motion);
  }
  // A grain that changes its level falls for another time than its weight acts.
  pairs.chunk[c].ledger.time_stepping -= setup.step * gravity_shift;
  if (move)
    foresight.remember(motion, c, all_due());
  else
    keep_forces(c, forces);
}

// Where a state and the next advance() find them.
void Simulation::Engine::keep_forces(std::uint32_t chunk, ForceSheet& forces) {
  const std::size_t begin = grains.chunks().begin(chunk);
  std::copy_n(forces.begin(), grains.chunks().end(chunk) - begin, &grains.forces[begin]);
  forces.fill({});
}

// Condition: all are due.
void Simulation::Engine::move_all() {
  grains.shown = false;
#pragma omp parallel for schedule(static) if (due_chunks.size() >= RowChunks::few)
  for (std::size_t c = 0; c < due_chunks.size(); ++c) {
    const MotionColumns on = columns();
    ChunkMotion motion;
    for (std::size_t i = grains.chunks().begin(c); i < grains.chunks().end(c); ++i)
      setup.levels == 0 ? kick_and_drift<false>(on, i, grains.forces[i], motion) : kick_and_drift<true>(on, i, grains.forces[i], motion);
    foresight.remember(motion, c, all_due());
  }
}

void Simulation::Engine::book_first_half() {
  for (const std::uint32_t c : due_chunks) spent += pairs.chunk[c].ledger;
  for_each_due_wall_chunk([&](const WallContacts::Chunk& chunk) { spent += chunk.ledger; });
}

void Simulation::Engine::book_second_half() {
  dem::book_second_half(force_input(false, false), pairs, walls);
  for (const std::uint32_t c : due_chunks) spent += pairs.chunk[c].ledger;
}

void Simulation::Engine::count_evaluations() {
  for (const std::uint32_t c : due_chunks) effort.evaluations += pairs.chunk[c].evaluations;
  for_each_due_wall_chunk([&](const WallContacts::Chunk& chunk) { effort.evaluations += chunk.evaluations; });
}

void Simulation::Engine::begin_window() {
  window = Window{};
  window.first_step = step;
  books.begin_window();
}

void Simulation::Engine::stop() {
  due = setup.levels;
  due_chunks.resize(chunk_level.size());
  std::iota(due_chunks.begin(), due_chunks.end(), 0U);
  evaluate_with(true, true, [&](std::size_t d, ForceSheet& sheet) { keep_forces(due_chunks[d], sheet); });  // so that the last frame shows the forces
  stop_for_overlap(guarded());
}

void Simulation::Engine::guard() const {
  check_motion(guarded());
  check_stable_step(guarded());
}

double Simulation::Engine::kinetic_energy() const {
  double energy = 0;
  for (std::size_t i = 0; i < size(); ++i)
    energy += 0.5 * grains.mass[i] * grains.rows[i].velocity().squaredNorm() + 0.5 * grains.inertia[i] * grains.rows[i].angular_velocity().squaredNorm();
  return energy;
}

Ledger Simulation::Engine::ledger() const {
  Ledger sum;
  if (!setup.keep_ledger) return sum;
  for (std::size_t i = 0; i < size(); ++i) {
    const Vec3 v = grains.rows[i].velocity(), w = grains.rows[i].angular_velocity();
    sum.kinetic += 0.5 * v.dot(grains.mass[i] * v + setup.step * grains.forces[i].force.head<3>());
    sum.rotational += 0.5 * w.dot(grains.inertia[i] * w + setup.step * grains.forces[i].torque.head<3>());
    sum.gravitational -= grains.mass[i] * setup.gravity.dot(grains.rows[i].position());
  }
  for (const LastForces& last : pairs.last) sum.stored += last.energy();
  for (const WallCandidate& c : walls.candidate)
    for (std::size_t k = c.contact_begin; k < c.contact_begin + c.size; ++k) sum.stored += walls.last[k].energy();
  sum.spent = spent;
  sum.wall_work = books.work;
  sum.initial = initial_energy;
  return sum;
}

}  // namespace dem
