#include "libdem/simulation/simulation.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <numeric>
#include <tuple>

#include "libdem/contact/due_list.hpp"
#include "libdem/contact/forces.hpp"
#include "libdem/contact/regroup.hpp"
#include "libdem/errors.hpp"
#include "libdem/neighbors/reach.hpp"
#include "libdem/neighbors/spatial_order.hpp"
#include "libdem/simulation/contact_memory.hpp"
#include "libdem/simulation/grain_store.hpp"
#include "libdem/simulation/guards.hpp"

namespace dem {
namespace {

// Below this many chunks waking other threads costs more than they save.
constexpr std::size_t few_chunks = 3;

// Of values >= 0.
double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values) most = std::max(most, value);
  return most;
}

template <class... Array>
std::size_t bytes_of(const Array&... arrays) {
  return ((arrays.capacity() * sizeof(typename Array::value_type)) + ...);
}

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

}  // namespace

struct Simulation::Engine {
  Setup setup;
  MaterialTable materials;
  std::uint64_t step = 0;
  GrainStore grains;
  std::vector<WallPose> poses;
  double mean_radius = 1, skin = 0;  // m
  std::uint64_t listed_step = 0;
  double wall_speed = 0;   // m/s, upper bound
  double odometer = 0;     // m, upper bound of how far any two bodies have come nearer since the run began
  double next_look = 0;    // m, on the odometer: when to look how much of the skin is left
  PairContacts pairs;
  WallContacts walls;
  ForceSheets sheets;
  std::vector<WallLoad> loads;   // [walls] of the last evaluation of all contacts
  std::vector<WallLoad> shares;  // [walls] of this step, in the mean over the steps (WallContacts::Chunk)

  std::uint8_t due = 0;                        // the highest level that is, at this step
  std::vector<std::uint8_t> chunk_level;       // the finest of the grains' in each chunk
  std::vector<std::uint32_t> due_chunks;
  // Of each chunk since all were due: largest component of a velocity, m/s, and of its change until all are due again if it
  // goes on like this.
  std::vector<double> chunk_speed, chunk_jolt;
  double foresight = 0;  // m, upper bound of what the odometer gains until all are due again
  // Of each chunk's grains when it was due last: their largest compressive force, N, and those above the watched one.
  struct Pressed {
    double largest = 0;
    std::vector<WatchedGrain> above;
  };
  std::vector<Pressed> pressed;
  double least_watched = 0;  // N, the lowest of the grains' limits
  std::vector<WatchedGrain> above;  // of all chunks
  ExcursionTracker excursions;
  std::vector<double> closing_jolt;  // [chunks] m/s, by how much two bodies' speeds may change until then, when all were due last
  Effort effort;

  LedgerSums spent;
  double initial_energy = 0;                  // J
  std::vector<double> wall_work, last_power;  // [walls] J, W

  Window window;
  std::vector<Window::Load> load_sum;

  Engine(Setup s, State state) : setup(std::move(s)), step(state.step) {
    check_input(state.particles);
    materials = make_material_table(setup.materials, setup.interactions, setup.law);
    grains = make_grain_store(std::move(state.particles), setup.materials);
    const std::size_t n = size();
    const std::vector<double>& radius = grains.caller.radius;
    wall_work.assign(setup.walls.size(), 0.0);
    last_power.assign(setup.walls.size(), 0.0);
    mean_radius = n ? std::accumulate(radius.begin(), radius.end(), 0.0) / double(n) : 1.0;
    skin = 0.1 * mean_radius;
    least_watched = watched_force(n ? *std::min_element(radius.begin(), radius.end()) : 0.0);
    for (const Wall& w : setup.walls) wall_speed = std::max(wall_speed, largest_speed(w));
    move_walls();

    const bool goes_on = !state.force.empty();
    if (goes_on) {
      for (std::size_t k = 1; k < state.excursions.size(); ++k)
        if (state.excursions[k].id <= state.excursions[k - 1].id) throw CaseError("the stored excursions are not in order of their grains");
      excursions = ExcursionTracker(std::move(state.excursions));
    }
    const bool ledger_goes_on = setup.keep_ledger && goes_on;
    if (ledger_goes_on && (state.ledger.pairs.size() != state.pairs.size() ||
                           state.ledger.wall_pairs.size() != state.wall_pairs.size() ||
                           state.ledger.wall_work.size() != setup.walls.size() ||
                           state.ledger.last_power.size() != setup.walls.size()))
      throw CaseError("the stored state has no energy ledger to go on with");
    Memory memory{std::move(state.pairs), {}, std::move(state.wall_pairs), {}};
    check(memory, n, setup.walls.size());
    for (State::Pair& c : memory.pairs) c.level = goes_on ? std::min(c.level, setup.levels) : 0;
    for (State::WallPair& c : memory.wall_pairs) c.level = goes_on ? std::min(c.level, setup.levels) : 0;
    if (ledger_goes_on) {
      memory.last = std::move(state.ledger.pairs);
      memory.wall_last = std::move(state.ledger.wall_pairs);
    } else if (setup.keep_ledger) {
      memory.last.resize(memory.pairs.size());
      memory.wall_last.resize(memory.wall_pairs.size());
    }
    if (goes_on && state.layout.chunk_rows == grains.chunks().rows())
      restore_lists(state.layout, memory);
    else
      build_lists(memory, {});
    begin_window();
    if (!goes_on) {
      find_due();
      for (std::size_t r = 0; r < n; ++r) {
        double& speed = chunk_speed[grains.chunks().of(r)];
        speed = std::max(speed, grains.rows[r].velocity().cwiseAbs().maxCoeff());
      }
      foresee();
      evaluate(true, true, false);
      sum_wall_loads();
      begin_window();  // windows cover the steps after the start
      for (std::size_t w = 0; w < loads.size(); ++w) last_power[w] = power_into_grains(w);
      if (setup.keep_ledger) initial_energy = ledger().total();
      return;
    }
    if (state.force.size() != n || state.torque.size() != n)
      throw CaseError("the stored state has forces on " + std::to_string(state.force.size()) + " grains, expected " + std::to_string(n));
    for (std::size_t r = 0; r < n; ++r) {
      const std::uint32_t i = grains.order[r];
      grains.forces[r] = {quad(state.force[i], 0), quad(state.torque[i], 0)};
    }
    sum_wall_loads();
    if (setup.keep_ledger) {
      spent = state.ledger.spent;
      initial_energy = state.ledger.initial;
      wall_work = state.ledger.wall_work;
      last_power = state.ledger.last_power;
    }
  }

  std::size_t size() const { return grains.size(); }

  void check_input(const Particles& p) const {
    const std::size_t n = p.size(), m = setup.materials.size();
    if (!(setup.step > 0)) throw CaseError("the time step is " + number(setup.step) + " s, expected > 0");
    if (setup.levels > most_levels)
      throw CaseError(std::to_string(setup.levels) + " levels of time steps, expected at most " + std::to_string(most_levels));
    if (setup.levels > 0 && !(setup.accuracy > 0 && setup.accuracy <= most_accuracy))
      throw CaseError("the accuracy of the time steps is " + number(setup.accuracy) + ", expected 0 < accuracy <= " +
                      number(most_accuracy));
    if (step % stride_of_all() != 0)
      throw CaseError("the stored state is of step " + std::to_string(step) +
                      ", at which not all contacts are due, expected a multiple of " + std::to_string(stride_of_all()));
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

  std::uint64_t stride_of_all() const { return std::uint64_t{1} << setup.levels; }
  bool all_due() const { return due == setup.levels; }

  void find_due() {
    due = due_at(step, setup.levels);
    due_chunks.clear();
    for (std::uint32_t c = 0; c < chunk_level.size(); ++c)
      if (chunk_level[c] <= due) due_chunks.push_back(c);
  }

  ForceInput force_input(bool look, bool record) const {
    return {.grains = grains.rows, .materials = materials, .walls = setup.walls, .poses = poses, .step_length = setup.step,
            .step = step, .odometer = odometer, .wall_curvature = setup.wall_curvature, .record = record, .look = look,
            .due = due, .highest = setup.levels, .foresight = foresight, .jolt = closing_jolt, .level = grains.level,
            .spun = grains.spun, .chunks = grains.chunks(), .due_chunks = due_chunks};
  }
  ForceOutput force_output() { return {sheets, grains.asked}; }

  // Forces on every grain that is due; gives it its level and, if asked to, moves it.
  void evaluate(bool look, bool record, bool move) {
    if (move) grains.shown = false;
    const auto finish = [&](std::size_t d, ForceSheet& sheet) {
      setup.levels == 0 ? finish_chunk<false>(d, sheet, move) : finish_chunk<true>(d, sheet, move);
    };
    window.largest_overlap = std::max(window.largest_overlap, evaluate_with(look, record, finish));
    for (const std::uint32_t c : due_chunks) {
      window.largest_compressive_force = std::max(window.largest_compressive_force, pressed[c].largest);
      window.ended_pairs += pairs.chunk[c].ended;
    }
    for_each_due_wall_chunk([&](const WallContacts::Chunk& chunk) { window.ended_wall_pairs += chunk.ended; });
    if (all_due()) follow_watched();
  }

  // N, the limit of a grain (Setup::watch_force).
  double watched_force(double radius) const {
    const double scale = setup.watch_radius > 0 ? radius / setup.watch_radius : 1.0;
    return setup.watch_force * scale * scale;
  }

  void follow_watched() {
    above.clear();
    for (const std::uint32_t c : due_chunks)
      for (WatchedGrain& grain : pressed[c].above) {
        grain.power = power_of_walls(c, grain.row);
        above.push_back(grain);
      }
    std::sort(above.begin(), above.end(), [](const WatchedGrain& a, const WatchedGrain& b) { return a.id < b.id; });
    window.most_watched = std::max(window.most_watched, std::uint32_t(above.size()));
    excursions.look(step, setup.step * double(stride_of_all()), above);
  }

  // W, that walls put into a grain of a chunk at their contacts.
  double power_of_walls(std::uint32_t c, std::uint32_t row) const {
    double power = 0;
    for (std::uint32_t k = walls.chunk_begin[c]; k < walls.chunk_begin[c + 1]; ++k) {
      const WallContacts::Chunk& chunk = walls.chunk[k];
      const WallPose& pose = poses[chunk.wall];
      const auto begin = walls.candidate.begin() + chunk.begin, end = walls.candidate.begin() + chunk.end;
      const auto candidate = std::lower_bound(begin, end, row, [](const WallCandidate& a, std::uint32_t b) { return a.particle < b; });
      if (candidate == end || candidate->particle != row) continue;
      for (const WallContact& contact : walls.contacts(*candidate)) {
        if (!contact.acts()) continue;
        const Vec3 force = contact.tangential - (contact.elastic + contact.damping) * contact.touch.normal;
        power += force.dot(pose.velocity + pose.angular_velocity.cross(contact.touch.point - pose.position));
      }
    }
    return power;
  }
  template <class Finish>
  double evaluate_with(bool look, bool record, Finish finish) {
    return evaluate_contacts(setup.law, setup.keep_ledger, force_input(look, record), pairs, walls, force_output(), finish);
  }

  template <class F>
  void for_each_due_wall_chunk(F f) const {
    for (const std::uint32_t c : due_chunks)
      for (std::uint32_t k = walls.chunk_begin[c]; k < walls.chunk_begin[c + 1]; ++k) f(walls.chunk[k]);
  }

  void book_first_half() {
    for (const std::uint32_t c : due_chunks) spent += pairs.chunk[c].ledger;
    for_each_due_wall_chunk([&](const WallContacts::Chunk& chunk) { spent += chunk.ledger; });
  }
  void book_second_half() {
    dem::book_second_half(force_input(false, false), pairs, walls);
    for (const std::uint32_t c : due_chunks) spent += pairs.chunk[c].ledger;
  }

  ListInput list_input() const { return {setup, materials, poses, skin}; }

  void lay_out_rows(std::vector<std::uint32_t> order) {
    lay_out(grains, std::move(order));
    chunk_level.assign(grains.chunks().count(), 0);  // all are due where lists are built
    chunk_speed.assign(grains.chunks().count(), 0.0);
    chunk_jolt.assign(grains.chunks().count(), 0.0);
    pressed.assign(grains.chunks().count(), {});
    closing_jolt.assign(grains.chunks().count(), largest(closing_jolt));  // whose grains are in other chunks now
    find_due();
  }

  // m, how far the grain of a row has gone since the lists were built; by the caller's rows of all.
  double travel(std::size_t r) const { return (grains.rows[r].place - grains.listed[r]).head<3>().norm(); }
  std::vector<double> travelled() const {
    std::vector<double> far(size());
#pragma omp parallel for schedule(static)
    for (std::size_t r = 0; r < size(); ++r) far[grains.order[r]] = travel(r);
    return far;
  }

  // Lists of what may touch around the present positions, the grains laid out anew. `far`: travelled(), or empty.
  void build_lists(const Memory& memory, const std::vector<double>& far) {
    const double little = too_little_left();
    lay_out_rows(spatial_order(grains.caller.position, grains.chunks().rows()));
    std::vector<double> far_of_rows(far.size());
    for (std::size_t r = 0; r < far.size(); ++r) far_of_rows[r] = far[grains.order[r]];
    const std::vector<double> reach = reaches(far_of_rows, size(), skin, std::max(thinnest_skin(), 2 * little));
    for (std::size_t r = 0; r < size(); ++r) grains.listed[r] = quad(grains.rows[r].position(), reach[r]);
    listed_step = step;
    next_look = odometer + skin_left();
    fill_lists(list_pairs(list_input(), grains, memory), memory);
  }

  // The lists that a state was taken with.
  void restore_lists(const State::Layout& layout, const Memory& memory) {
    const std::size_t n = size(), lanes = layout.first.size();
    std::vector<bool> seen(n, false);
    bool sound = layout.order.size() == n && layout.listed.size() == n && layout.reach.size() == n && layout.second.size() == lanes &&
                 lanes % PairContacts::width == 0 && layout.skin > 0 && std::isfinite(layout.skin) &&
                 std::isfinite(layout.odometer) && std::isfinite(layout.next_look);
    for (std::size_t r = 0; sound && r < n; ++r) {
      sound = layout.order[r] < n && !seen[layout.order[r]] && layout.listed[r].allFinite() && layout.reach[r] > 0 &&
              layout.reach[r] <= layout.skin;
      if (sound) seen[layout.order[r]] = true;
    }
    Lanes pairs_of_lanes(sound ? lanes : 0);
    for (std::size_t k = 0; sound && k < lanes; ++k) pairs_of_lanes[k] = {layout.first[k], layout.second[k]};
    if (sound) {
      lay_out_rows(layout.order);
      sound = fit(pairs_of_lanes, grains.table());
    }
    if (!sound) throw CaseError("the stored state has a layout that does not fit its grains");
    for (std::size_t r = 0; r < n; ++r) grains.listed[r] = quad(layout.listed[r], layout.reach[r]);
    skin = layout.skin;
    listed_step = layout.listed_step;
    odometer = layout.odometer;
    next_look = layout.next_look;
    fill_lists(pairs_of_lanes, memory);
    if (setup.levels > 0 && !layout.grain_level.empty()) restore_levels(layout);
  }

  // What an uninterrupted run would know of the levels.
  void restore_levels(const State::Layout& layout) {
    const auto known = [&](std::uint8_t level) { return level == State::Layout::asleep_level || level <= most_levels; };
    const std::size_t blocks = pairs.block.size(), candidates = layout.wall_grain.size();
    if (layout.grain_level.size() != size() || layout.block_level.size() != blocks || layout.block_wake.size() != blocks ||
        layout.block_quiet.size() != blocks || layout.wall.size() != candidates || layout.wall_level.size() != candidates || layout.wall_wake.size() != candidates ||
        layout.wall_quiet.size() != candidates || layout.closing_jolt.size() != grains.chunks().count() ||
        !std::all_of(layout.block_level.begin(), layout.block_level.end(), known) ||
        !std::all_of(layout.wall_level.begin(), layout.wall_level.end(), known) ||
        !std::all_of(layout.grain_level.begin(), layout.grain_level.end(), known))
      throw CaseError("the stored state has levels that do not fit its contacts");
    const auto restore = [&](Activity& activity, std::uint8_t level, double wake, std::uint32_t quiet_until) {
      activity.asleep = level == State::Layout::asleep_level;
      activity.level = activity.asleep ? 0 : std::min(level, setup.levels);
      activity.wake = wake;
      activity.quiet_until = quiet_until;
    };
    for (std::size_t r = 0; r < size(); ++r) grains.level[r] = std::min(layout.grain_level[r], setup.levels);
    for (std::size_t b = 0; b < blocks; ++b) restore(pairs.activity[b], layout.block_level[b], layout.block_wake[b], layout.block_quiet[b]);
    std::map<std::pair<std::uint32_t, std::uint32_t>, Activity*> candidate;
    for (std::size_t q = 0; q < walls.candidate.size(); ++q)
      candidate[{walls.candidate[q].particle, walls.candidate[q].wall}] = &walls.activity[q];
    for (std::size_t k = 0; k < candidates; ++k) {
      const auto found = candidate.find({layout.wall_grain[k], layout.wall[k]});
      if (found != candidate.end()) restore(*found->second, layout.wall_level[k], layout.wall_wake[k], layout.wall_quiet[k]);
    }
    foresight = layout.foresight;
    closing_jolt = layout.closing_jolt;
  }

  void fill_lists(const Lanes& lanes, const Memory& memory) {
    pairs = make_pair_contacts(list_input(), lanes, grains, memory, std::move(pairs));
    walls = make_wall_contacts(list_input(), grains, memory);
  }

  double thinnest_skin() const { return 0.05 * mean_radius; }  // m
  double thickest_skin() const { return 0.8 * mean_radius; }   // m, with which test C in flow takes 1.2 kB a grain

  // Thin lists hold little more than the contacts, thick ones are built less often. The aim is a list that lasts a few hundred
  // steps; forces do not depend on it.
  void adapt_skin() {
    const std::uint64_t lasted = (step - listed_step) / stride_of_all();
    if (lasted < 200) skin = std::min(1.5 * skin, thickest_skin());
    if (lasted > 2000) skin = std::max(0.8 * skin, thinnest_skin());
  }

  // How often blocks are filled anew while lists last: 1 to 2 % of the time of so many steps goes into it. Twice and half as often are as good.
  std::uint64_t regrouping_steps() const { return std::max<std::uint64_t>(256, stride_of_all()); }

  // What a pass over the grains needs of a run. By value, as the compiler would read members anew after whatever it writes.
  struct Columns {
    GrainRow* rows;
    Vec4* spun;
    std::uint8_t *level, *asked;
    double step, local_damping;
    std::uint8_t highest;
  };
  Columns columns() {
    return {grains.rows.data(), grains.spun.data(), grains.level.data(), grains.asked.data(), setup.step, setup.local_damping, setup.levels};
  }

  // What evaluate() does to the grains of a chunk that are due, when the contacts' forces on them are there.
  template <bool Levels>
  void finish_chunk(std::size_t d, ForceSheet& forces, bool move) {
    const std::uint32_t c = due_chunks[d];
    const Columns on = columns();
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

    double largest = 0;
    for (const std::uint32_t i : rows) largest = std::max(largest, forces[i - begin].force[3]);
    pressed[c].largest = largest;
    pressed[c].above.clear();
    if (largest > least_watched)
      for (const std::uint32_t i : rows) watch(c, i, forces[i - begin].force[3]);

    Motion motion;
    for (const std::uint32_t i : rows) {
      ForceRow& acting = forces[i - begin];
      acting.force += (Levels ? stride(on.level[i]) * on.rows[i].mass() : on.rows[i].mass()) * gravity;
      if (move) kick_and_drift<Levels>(on, i, acting, motion);
    }
    // A grain that changes its level falls for another time than its weight acts.
    pairs.chunk[c].ledger.time_stepping -= setup.step * gravity_shift;
    if (move)
      remember(motion, c);
    else
      keep_forces(c, forces);
  }

  // Remembers a grain that is pressed with more than its limit, N.
  void watch(std::uint32_t chunk, std::uint32_t row, double force) {
    const GrainRow& grain = grains.rows[row];
    if (force > watched_force(grain.radius()))
      pressed[chunk].above.push_back(
          {row, grains.id[row], force, 0, grain.velocity().norm(), grain.angular_velocity().norm(), grain.position()});
  }

  // Where a state and the next advance() find them.
  void keep_forces(std::uint32_t chunk, ForceSheet& forces) {
    const std::size_t begin = grains.chunks().begin(chunk);
    std::copy_n(forces.begin(), grains.chunks().end(chunk) - begin, &grains.forces[begin]);
    forces.fill({});
  }

  // Largest components of velocities and of what changes them until all are due again.
  struct Motion {
    Vec4 speed = Vec4::Zero(), jolt = Vec4::Zero();
  };
  void remember(const Motion& motion, std::size_t chunk) {
    const double speed = motion.speed.maxCoeff(), jolt = motion.jolt.maxCoeff();
    chunk_speed[chunk] = all_due() ? speed : std::max(chunk_speed[chunk], speed);
    chunk_jolt[chunk] = all_due() ? jolt : std::max(chunk_jolt[chunk], jolt);
  }

  // The change of a velocity in one step under local damping; the velocity in the middle of the step says which way it goes.
  static Vec4 damped(double local_damping, const Vec4& velocity, const Vec4& change) {
    const double speeding_up = change.head<3>().dot((velocity + 0.5 * change).head<3>());
    const double share = speeding_up > 0 ? 1 - local_damping : 1 + local_damping;
    return share * change;
  }

  template <bool Levels>
  [[gnu::always_inline]] static inline void kick_and_drift(const Columns& on, std::size_t i, ForceRow& acting, Motion& motion) {
    const Vec4 three(1, 1, 1, 0);
    GrainRow& grain = on.rows[i];
    const double kick = on.step / grain.mass(), turn = inverse_sphere_inertia(kick, grain.motion[3]);
    Vec4 faster = kick * three.cwiseProduct(acting.force), spun = turn * acting.torque;
    if (on.local_damping != 0) {
      faster = damped(on.local_damping, grain.motion, faster);
      spun = damped(on.local_damping, grain.spin, spun);
    }
    grain.motion += faster;
    grain.spin += spun;
    const Vec4 velocity = three.cwiseProduct(grain.motion);
    motion.speed = motion.speed.cwiseMax(velocity.cwiseAbs());
    grain.arrival = velocity + 0.5 * three.cwiseProduct(faster);
    if constexpr (Levels) {
      const std::uint8_t level = on.level[i];
      grain.place += on.step * stride(level) * velocity;
      grain.arrival[3] = per_stride(level);
      on.spun[i] = 0.5 * spun;
      motion.jolt = motion.jolt.cwiseMax(stride(std::uint8_t(on.highest - level)) * faster.cwiseAbs());
    } else {
      grain.place += on.step * velocity;
    }
    acting = ForceRow{};
    on.asked[i] = ForceOutput::nothing_asked;
  }

  // Condition: all are due.
  void move_all() {
    grains.shown = false;
#pragma omp parallel for schedule(static) if (due_chunks.size() >= few_chunks)
    for (std::size_t c = 0; c < due_chunks.size(); ++c) {
      const Columns on = columns();
      Motion motion;
      for (std::size_t i = grains.chunks().begin(c); i < grains.chunks().end(c); ++i)
        setup.levels == 0 ? kick_and_drift<false>(on, i, grains.forces[i], motion) : kick_and_drift<true>(on, i, grains.forces[i], motion);
      remember(motion, c);
    }
  }

  // m/s, upper bound of the speed at which two bodies near each other if every grain is at most `excess` faster than the fastest
  // component of a velocity.
  double closing_speed(double excess) const {
    const double root_three = 1.7320508075688774;
    const double speed = root_three * (largest(chunk_speed) + excess);
    return speed + std::max(speed, wall_speed);
  }

  // Looks ahead to when all are due again, which they are now.
  void foresee() {
    if (setup.levels == 0) return;
    const double root_three = 1.7320508075688774;
    for (std::size_t c = 0; c < closing_jolt.size(); ++c) closing_jolt[c] = 2 * root_three * chunk_jolt[c];
    foresight = setup.step * double(stride_of_all()) * closing_speed(largest(chunk_jolt));
  }

  // m, by which the odometer will not quite grow until then unless speeds double.
  double travel_until_all_due() const {
    return setup.levels == 0 ? 0 : 2 * setup.step * double(stride_of_all()) * closing_speed(0);
  }

  // m, what the odometer may still gain until the lists must be built again: of each grain's reach, twice as two may near each
  // other so, and of the skin between grains and walls.
  double skin_left() const {
    double least = 0.5 * skin, furthest = 0;
#pragma omp parallel for schedule(static) reduction(min : least) reduction(max : furthest) if (pairs.chunk.size() >= few_chunks)
    for (std::size_t i = 0; i < size(); ++i) {
      const double way = travel(i);
      least = std::min(least, grains.listed[i][3] - way);
      furthest = std::max(furthest, way);
    }
    return std::min(2 * least, skin - furthest - wall_speed * setup.step * double(step - listed_step));
  }

  // m, on the odometer. Lists with less than this left are used up: they must last until all are due again, and to look costs a pass over
  // the grains, which takes as long as a few chunks take for a step.
  double too_little_left() const {
    const double steps = std::max(2 * double(stride_of_all()), 8.0);  // twice as many as needed, as speeds may double
    return 0.01 * skin + steps * setup.step * closing_speed(0);
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
    shares.assign(setup.walls.size(), WallLoad{});
    for_each_due_wall_chunk([&](const WallContacts::Chunk& chunk) { shares[chunk.wall] += chunk.share; });
    if (!all_due()) return;
    loads.assign(setup.walls.size(), WallLoad{});
    for (const WallContacts::Chunk& chunk : walls.chunk) loads[chunk.wall] += chunk.load;
  }

  // W, that the wall puts into the grains at this instant.
  double power_into_grains(std::size_t w) const {
    return -(shares[w].force.dot(poses[w].velocity) + shares[w].torque.dot(poses[w].angular_velocity));
  }

  void record_walls() {
    sum_wall_loads();
    for_each_due_wall_chunk([&](const WallContacts::Chunk& chunk) {
      for (std::size_t l = 0; l < facet_labels; ++l) load_sum[chunk.wall].of_label[l] += chunk.share_of_label[l];
    });
    for (std::size_t w = 0; w < setup.walls.size(); ++w) {
      Window::Load& sum = load_sum[w];
      sum.force += shares[w].force;
      sum.torque += shares[w].torque;
      if (all_due()) {
        sum.force_min = sum.force_min.cwiseMin(loads[w].force);
        sum.force_max = sum.force_max.cwiseMax(loads[w].force);
        sum.torque_min = sum.torque_min.cwiseMin(loads[w].torque);
        sum.torque_max = sum.torque_max.cwiseMax(loads[w].torque);
      }
      const double power = power_into_grains(w);
      sum.power += power;
      wall_work[w] += 0.5 * setup.step * (last_power[w] + power);
      last_power[w] = power;
    }
  }

  void count_evaluations() {
    for (const std::uint32_t c : due_chunks) effort.evaluations += pairs.chunk[c].evaluations;
    for_each_due_wall_chunk([&](const WallContacts::Chunk& chunk) { effort.evaluations += chunk.evaluations; });
  }

  void advance(std::uint64_t steps) {
    if (steps == 0) return;
    if (steps % stride_of_all() != 0)
      throw CaseError("asked to go on for " + std::to_string(steps) + " steps, expected a multiple of " +
                      std::to_string(stride_of_all()));
    Stopwatch watch;
    find_due();
    move_all();
    if (setup.keep_ledger) book_second_half();
    for (std::uint64_t k = 1; k <= steps; ++k) {
      ++step;
      ++effort.steps;
      move_walls();
      odometer += closing_speed(0) * setup.step;
      find_due();
      if (all_due()) {
        foresee();
        if (!(odometer + travel_until_all_due() < next_look)) {
          watch.add_to(effort.rest);
          renew_lists();
          watch.add_to(effort.listing);
        }
        if ((step - listed_step) % regrouping_steps() == 0 && step > listed_step) {
          watch.add_to(effort.rest);
          regroup(pairs, grains.table(), materials, setup.resolution());
          watch.add_to(effort.listing);
        }
      }
      watch.add_to(effort.rest);
      evaluate(false, k == steps, k < steps);
      watch.add_to(effort.stepping);
      if (!(window.largest_overlap < runaway_overlap)) stop();
      count_evaluations();
      if (setup.keep_ledger) {
        book_first_half();
        if (k < steps) book_second_half();
      }
      record_walls();
    }
    show(grains);
    guard();
    watch.add_to(effort.rest);
  }

  void renew_lists() {
    const double left = skin_left();
    next_look = odometer + 0.999 * left;
    if (left > too_little_left()) return;
    guard();
    adapt_skin();
    show(grains);
    build_lists(gather(grains, pairs, walls), travelled());
    ++effort.lists;
  }

  [[noreturn]] void stop() {
    due = setup.levels;
    due_chunks.resize(chunk_level.size());
    std::iota(due_chunks.begin(), due_chunks.end(), 0U);
    evaluate_with(true, true, [&](std::size_t d, ForceSheet& sheet) { keep_forces(due_chunks[d], sheet); });  // so that the last frame shows the forces
    stop_for_overlap(guarded());
  }

  GuardInput guarded() const { return {setup, grains.id, grains.rows, grains.mass, grains.inertia, materials, pairs, walls, time()}; }
  void guard() const {
    check_motion(guarded());
    check_stable_step(guarded());
  }

  double kinetic_energy() const {
    double energy = 0;
    for (std::size_t i = 0; i < size(); ++i)
      energy += 0.5 * grains.mass[i] * grains.rows[i].velocity().squaredNorm() + 0.5 * grains.inertia[i] * grains.rows[i].angular_velocity().squaredNorm();
    return energy;
  }

  Ledger ledger() const {
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
const Particles& Simulation::particles() const { return engine_->grains.caller; }
const std::vector<Excursion>& Simulation::ended_excursions() const { return engine_->excursions.ended(); }
const std::vector<Excursion>& Simulation::excursions() const { return engine_->excursions.open(); }
double Simulation::kinetic_energy() const { return engine_->kinetic_energy(); }
Ledger Simulation::ledger() const { return engine_->ledger(); }
const Effort& Simulation::effort() const { return engine_->effort; }
std::size_t Simulation::bytes() const {
  const Engine& e = *engine_;
  std::size_t recorded = 0;
  for (const PairContacts::Chunk& chunk : e.pairs.chunk) recorded += bytes_of(chunk.recorded);
  const GrainStore& g = e.grains;
  const Particles& p = g.caller;
  return recorded + bytes_of(p.id, p.material, p.radius, p.position, p.velocity, p.angular_velocity, g.caller_mass, g.caller_inertia) +
         bytes_of(g.order, g.row_of, g.rows, g.forces, g.spun, g.mass, g.inertia, g.material, g.id, g.listed, g.level, g.asked) +
         bytes_of(e.pairs.block, e.pairs.activity, e.pairs.due_from, e.pairs.kind, e.pairs.birth_step, e.pairs.rolling, e.pairs.last, e.pairs.crossing,
                  e.pairs.incoming, e.pairs.chunk) + e.sheets.bytes() +
         bytes_of(e.walls.candidate, e.walls.activity, e.walls.due_from, e.walls.parts, e.walls.near_parts, e.walls.contact, e.walls.last, e.walls.chunk, e.walls.chunk_begin);
}
double Simulation::stable_step() const { return dem::stable_step(engine_->guarded()); }

std::size_t Simulation::contacts() const {
  std::size_t count = 0;
  for (const PairContacts::Block& block : engine_->pairs.block)
    for (const double radius : block.contact_radius) count += radius > 0;
  for (const WallCandidate& c : engine_->walls.candidate)
    for (const WallContact& w : engine_->walls.contacts(c)) count += w.acts();
  return count;
}

State Simulation::state() const {
  Engine& e = *engine_;
  const GrainStore& grains = e.grains;
  State state;
  state.step = e.step;
  show(e.grains);
  state.particles = grains.caller;
  state.force.resize(e.size());
  state.torque.resize(e.size());
  for (std::size_t r = 0; r < e.size(); ++r) {
    state.force[grains.order[r]] = grains.forces[r].force.head<3>();
    state.torque[grains.order[r]] = grains.forces[r].torque.head<3>();
    state.layout.listed.push_back(grains.listed[r].head<3>());
    state.layout.reach.push_back(grains.listed[r][3]);
  }
  state.layout.chunk_rows = grains.chunks().rows();
  state.layout.order = grains.order;
  for (std::size_t lane = 0; lane < e.pairs.lanes(); ++lane) {
    state.layout.first.push_back(e.pairs.first(lane));
    state.layout.second.push_back(e.pairs.second(lane));
  }
  state.layout.listed_step = e.listed_step;
  state.layout.skin = e.skin;
  state.layout.odometer = e.odometer;
  state.layout.next_look = e.next_look;
  if (e.setup.levels > 0) {
    constexpr std::uint8_t asleep = State::Layout::asleep_level;
    state.layout.grain_level = grains.level;
    const auto level_of = [](const Activity& a) { return !a.acts && a.asleep ? asleep : a.level; };
    for (const Activity& activity : e.pairs.activity) {
      state.layout.block_level.push_back(level_of(activity));
      state.layout.block_wake.push_back(activity.wake);
      state.layout.block_quiet.push_back(activity.quiet_until);
    }
    for (std::size_t q = 0; q < e.walls.candidate.size(); ++q) {
      state.layout.wall_grain.push_back(e.walls.candidate[q].particle);
      state.layout.wall.push_back(e.walls.candidate[q].wall);
      state.layout.wall_level.push_back(level_of(e.walls.activity[q]));
      state.layout.wall_wake.push_back(e.walls.activity[q].wake);
      state.layout.wall_quiet.push_back(e.walls.activity[q].quiet_until);
    }
    state.layout.foresight = e.foresight;
    state.layout.closing_jolt = e.closing_jolt;
  }
  Memory memory = gather(grains, e.pairs, e.walls);
  state.pairs = std::move(memory.pairs);
  state.wall_pairs = std::move(memory.wall_pairs);
  state.excursions = e.excursions.open();
  if (e.setup.keep_ledger) {
    state.ledger = {e.spent, e.initial_energy, e.wall_work, e.last_power, std::move(memory.last), std::move(memory.wall_last)};
  }
  return state;
}

View Simulation::view() const {
  Engine& e = *engine_;
  const GrainStore& grains = e.grains;
  const Particles& p = grains.caller;
  const std::size_t n = e.size();
  const double half = 0.5 * e.setup.step;
  show(e.grains);
  View view;
  view.step = e.step;
  view.time = e.time();
  view.id = p.id;
  view.material = p.material;
  view.radius = p.radius;
  view.position = p.position;
  view.compressive_force.resize(n);
  view.velocity.resize(n);
  view.angular_velocity.resize(n);
  for (std::size_t r = 0; r < n; ++r) {
    const std::uint32_t i = grains.order[r];
    view.compressive_force[i] = grains.forces[r].force[3];
    view.velocity[i] = p.velocity[i] + half / grains.mass[r] * grains.forces[r].force.head<3>();
    view.angular_velocity[i] = p.angular_velocity[i] + half / grains.inertia[r] * grains.forces[r].torque.head<3>();
  }
  for (const PairContacts::Chunk& chunk : e.pairs.chunk)
    for (const PairForce& r : chunk.recorded) {
      const std::uint32_t first = grains.order[e.pairs.first(r.lane)], second = grains.order[e.pairs.second(r.lane)];
      const double distance = (p.position[second] - p.position[first]).norm();
      const auto [i, j] = std::minmax(first, second);
      view.pairs.push_back({i, j, p.radius[i] + p.radius[j] - distance, r.elastic, r.damping,
                            first < second ? r.tangential : Vec3(-r.tangential), e.pairs.birth_step[r.lane], r.sliding});
    }
  std::sort(view.pairs.begin(), view.pairs.end(),
            [](const PairRecord& a, const PairRecord& b) { return std::tie(a.i, a.j) < std::tie(b.i, b.j); });
  for (const std::uint32_t q : by_grain(grains, e.walls)) {
    const WallCandidate& c = e.walls.candidate[q];
    const std::uint32_t i = grains.order[c.particle];
    for (const WallContact& r : e.walls.contacts(c)) {
      if (!r.acts()) continue;
      view.wall_pairs.push_back({i, c.wall, r.touch.facet, r.touch.kind, r.touch.point, r.touch.normal,
                                 p.radius[i] - r.touch.distance, r.elastic, r.damping, r.tangential, r.memory.birth_step,
                                 r.sliding});
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
  w.excursions = e.excursions.take_ended();
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
