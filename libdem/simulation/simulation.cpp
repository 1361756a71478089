#include "libdem/simulation/simulation.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "libdem/contact/forces.hpp"
#include "libdem/contact/pair_blocks.hpp"
#include "libdem/errors.hpp"
#include "libdem/neighbors/spatial_order.hpp"
#include "libdem/simulation/guards.hpp"

namespace dem {
namespace {

// Below this many chunks waking other threads costs more than they save.
constexpr std::size_t few_chunks = 3;

// The same contact seen from the other grain.
State::Pair swapped(State::Pair c) {
  std::swap(c.i, c.j);
  c.spring = -c.spring;
  c.rolling = -c.rolling;
  return c;
}
LastForces swapped(LastForces last) {
  last.normal = -last.normal;
  std::swap(last.arm_i, last.arm_j);
  last.tangential_elastic = -last.tangential_elastic;
  last.tangential_viscous = -last.tangential_viscous;
  std::swap(last.rolling_i, last.rolling_j);
  return last;
}

// All memory of the contacts, by the grains' rows in State: pairs ascending in (i, j), wall pairs in (i, wall, feature).
struct Memory {
  std::vector<State::Pair> pairs;
  std::vector<LastForces> last;  // of a run that keeps a ledger
  std::vector<State::WallPair> wall_pairs;
  std::vector<LastForces> wall_last;
};

// Where the pairs of each row begin; [N+1].
template <class Pairs>
std::vector<std::uint32_t> first_of_rows(const Pairs& pairs, std::size_t n) {
  std::vector<std::uint32_t> begin(n + 1, 0);
  for (const auto& c : pairs) ++begin[c.i + 1];
  for (std::size_t i = 0; i < n; ++i) begin[i + 1] += begin[i];
  return begin;
}

}  // namespace

struct Simulation::Engine {
  Setup setup;
  MaterialTable materials;
  std::uint64_t step = 0;
  mutable Particles p;                 // in the caller's order; follows the rows where somebody looks
  std::vector<double> all_mass, all_inertia;  // likewise

  // In the order of rows.
  std::vector<std::uint32_t> order;    // row in `p`
  std::vector<std::uint32_t> row_of;   // the inverse: row here of a row in `p`
  std::vector<GrainRow> grains;        // and phantoms
  std::vector<ForceRow> forces;        // and phantoms
  std::vector<double> mass, inertia;
  std::vector<double> kick, turn;      // s/kg, s/(kg m^2): the step over them
  std::vector<std::uint8_t> material;
  std::vector<std::uint32_t> id;
  std::vector<Vec4> listed;            // m, where the grains were when the lists were built; then 0

  std::vector<WallPose> poses;
  double mean_radius = 1, skin = 0;  // m
  std::uint64_t listed_step = 0;
  double wall_speed = 0;   // m/s, upper bound
  double odometer = 0;     // m, upper bound of how far any two bodies have come nearer since the run began
  double next_look = 0;    // m, on the odometer: when to look how much of the skin is left
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
    for (std::size_t i = 0; i < n; ++i) {
      all_mass.push_back(setup.materials[p.material[i]].density * sphere_volume(p.radius[i]));
      all_inertia.push_back(sphere_inertia(all_mass[i], p.radius[i]));
    }
    rolling_spring = with_part<RollingLaws>(setup.law.rolling, [](auto part) { return part.has_spring; });
    wall_work.assign(setup.walls.size(), 0.0);
    last_power.assign(setup.walls.size(), 0.0);
    mean_radius = n ? std::accumulate(p.radius.begin(), p.radius.end(), 0.0) / double(n) : 1.0;
    skin = 0.1 * mean_radius;
    for (const Wall& w : setup.walls) wall_speed = std::max(wall_speed, largest_speed(w));
    move_walls();

    const bool goes_on = !state.force.empty();
    const bool ledger_goes_on = setup.keep_ledger && goes_on;
    if (ledger_goes_on && (state.ledger.pairs.size() != state.pairs.size() ||
                           state.ledger.wall_pairs.size() != state.wall_pairs.size() ||
                           state.ledger.wall_work.size() != setup.walls.size() ||
                           state.ledger.last_power.size() != setup.walls.size()))
      throw CaseError("the stored state has no energy ledger to go on with");
    Memory memory{std::move(state.pairs), {}, std::move(state.wall_pairs), {}};
    check(memory);
    if (ledger_goes_on) {
      memory.last = std::move(state.ledger.pairs);
      memory.wall_last = std::move(state.ledger.wall_pairs);
    } else if (setup.keep_ledger) {
      memory.last.resize(memory.pairs.size());
      memory.wall_last.resize(memory.wall_pairs.size());
    }
    if (goes_on && !state.layout.order.empty())
      restore_lists(state.layout, memory);
    else
      build_lists(memory);
    begin_window();
    if (!goes_on) {
      evaluate(0.0, true);
      finish_forces(false);
      sum_wall_loads();
      begin_window();  // windows cover the steps after the start
      for (std::size_t w = 0; w < loads.size(); ++w) last_power[w] = power_into_grains(w);
      if (setup.keep_ledger) initial_energy = ledger().total();
      return;
    }
    if (state.force.size() != n || state.torque.size() != n)
      throw CaseError("the stored state has forces on " + std::to_string(state.force.size()) + " grains, expected " + std::to_string(n));
    for (std::size_t r = 0; r < n; ++r) forces[r] = {quad(state.force[order[r]], 0), quad(state.torque[order[r]], 0)};
    sum_wall_loads();
    if (setup.keep_ledger) {
      spent = state.ledger.spent;
      initial_energy = state.ledger.initial;
      wall_work = state.ledger.wall_work;
      last_power = state.ledger.last_power;
    }
  }

  std::size_t size() const { return all_mass.size(); }

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

  // What indexes must be in range and in order before anything follows them.
  void check(const Memory& memory) const {
    const auto refuse = [](const std::string& what) { throw CaseError("the stored state has " + what); };
    const std::size_t n = size();
    for (std::size_t k = 0; k < memory.pairs.size(); ++k) {
      const State::Pair& c = memory.pairs[k];
      if (c.j >= n || c.i >= c.j) refuse("a contact between grains that it does not have");
      if (k > 0 && std::tuple(memory.pairs[k - 1].i, memory.pairs[k - 1].j) >= std::tuple(c.i, c.j))
        refuse("contacts that are not in ascending order of their grains");
      if (!(c.contact_radius > 0)) refuse("a contact without a contact radius");
    }
    for (std::size_t k = 0; k < memory.wall_pairs.size(); ++k) {
      const State::WallPair& c = memory.wall_pairs[k];
      if (c.i >= n || c.wall >= setup.walls.size()) refuse("a contact with a wall that is not there");
      if (k > 0 && memory.wall_pairs[k - 1].i > c.i) refuse("wall contacts that are not in ascending order of their grains");
      if (!(c.contact_radius > 0)) refuse("a wall contact without a contact radius");
    }
  }

  void move_walls() {
    poses.resize(setup.walls.size());
    for (std::size_t w = 0; w < poses.size(); ++w) poses[w] = pose_at(setup.walls[w].motion, time());
  }

  void evaluate(double dt, bool record) {
    const double overlap = evaluate_contacts(setup.law, setup.keep_ledger,
                                             {grains, materials, setup.walls, poses, dt, step, odometer, setup.wall_curvature, record},
                                             pairs, walls, forces);
    window.largest_overlap = std::max(window.largest_overlap, overlap);
    if (setup.keep_ledger && dt > 0) {
      for (const PairContacts::Chunk& chunk : pairs.chunk) spent += chunk.ledger;
      for (const WallContacts::Chunk& chunk : walls.chunk) spent += chunk.ledger;
    }
  }

  // The caller's particles, as they are now.
  void show_particles() const {
    for (std::size_t r = 0; r < size(); ++r) {
      p.position[order[r]] = grains[r].position();
      p.velocity[order[r]] = grains[r].velocity();
      p.angular_velocity[order[r]] = grains[r].angular_velocity();
    }
  }

  // Lays the caller's particles out in the given order.
  void lay_out(std::vector<std::uint32_t> new_order) {
    const std::size_t n = size();
    order = std::move(new_order);
    row_of.resize(n);
    grains.assign(n + chunks_of(n), phantom());
    forces.assign(n + chunks_of(n), ForceRow{});
    mass.resize(n);
    inertia.resize(n);
    kick.resize(n);
    turn.resize(n);
    material.resize(n);
    id.resize(n);
    listed.resize(n);
#pragma omp parallel for schedule(static)
    for (std::size_t r = 0; r < n; ++r) {
      const std::uint32_t i = order[r];
      row_of[i] = std::uint32_t(r);
      grains[r] = {quad(p.position[i], p.radius[i]), quad(p.velocity[i], 1 / p.radius[i]), quad(p.angular_velocity[i], 0)};
      mass[r] = all_mass[i];
      inertia[r] = all_inertia[i];
      kick[r] = setup.step / mass[r];
      turn[r] = setup.step / inertia[r];
      material[r] = p.material[i];
      id[r] = p.id[i];
    }
  }

  // Lists of what may touch around the present positions, the grains laid out anew.
  void build_lists(const Memory& memory) {
    lay_out(spatial_order(p.position, 2 * mean_radius));
    std::vector<Vec3> position(size());
    std::vector<double> radius(size());
    for (std::size_t r = 0; r < size(); ++r) {
      position[r] = grains[r].position();
      radius[r] = grains[r].radius();
      listed[r] = quad(position[r], 0);
    }
    const std::vector<std::uint32_t> begin = first_of_rows(memory.pairs, size());
    const auto touches = [&](std::uint32_t i, std::uint32_t j) { return find(memory, begin, order[i], order[j]) >= 0; };
    listed_step = step;
    next_look = odometer + 0.5 * skin;
    fill_lists(order_lanes(build_pair_list(position, radius, skin), grain_table(), materials.size, touches), memory, begin);
  }

  // The lists that a state was taken with.
  void restore_lists(const State::Layout& layout, const Memory& memory) {
    const std::size_t n = size(), lanes = layout.first.size();
    std::vector<bool> seen(n, false);
    bool sound = layout.order.size() == n && layout.listed.size() == n && layout.second.size() == lanes &&
                 lanes % PairContacts::width == 0 && layout.skin > 0 && std::isfinite(layout.skin) &&
                 std::isfinite(layout.odometer) && std::isfinite(layout.next_look);
    for (std::size_t r = 0; sound && r < n; ++r) {
      sound = layout.order[r] < n && !seen[layout.order[r]] && layout.listed[r].allFinite();
      if (sound) seen[layout.order[r]] = true;
    }
    Lanes pairs_of_lanes(sound ? lanes : 0);
    for (std::size_t k = 0; sound && k < lanes; ++k) pairs_of_lanes[k] = {layout.first[k], layout.second[k]};
    if (sound) {
      lay_out(layout.order);
      sound = fit(pairs_of_lanes, grain_table());
    }
    if (!sound) throw CaseError("the stored state has a layout that does not fit its grains");
    for (std::size_t r = 0; r < n; ++r) listed[r] = quad(layout.listed[r], 0);
    skin = layout.skin;
    listed_step = layout.listed_step;
    odometer = layout.odometer;
    next_look = layout.next_look;
    fill_lists(pairs_of_lanes, memory, first_of_rows(memory.pairs, n));
  }

  GrainTable grain_table() const { return {grains, material, mass, inertia}; }

  // The row in memory.pairs of a pair of the caller's rows, or -1.
  static std::int64_t find(const Memory& memory, const std::vector<std::uint32_t>& begin, std::uint32_t i, std::uint32_t j) {
    const auto [a, b] = std::minmax(i, j);
    for (std::uint32_t k = begin[a]; k < begin[a + 1]; ++k)
      if (memory.pairs[k].j == b) return k;
    return -1;
  }

  void fill_lists(const Lanes& lanes, const Memory& memory, const std::vector<std::uint32_t>& begin) {
    pairs = make_pair_contacts(lanes, grain_table(), materials, rolling_spring, setup.keep_ledger);
    std::size_t remembered = 0;
#pragma omp parallel for schedule(static) reduction(+ : remembered)
    for (std::size_t b = 0; b < pairs.block.size(); ++b)
      for (std::size_t k = 0; k < PairContacts::width; ++k) {
        PairContacts::Block& block = pairs.block[b];
        if (block.second[k] >= size()) continue;
        const std::int64_t known = find(memory, begin, order[block.first[k]], order[block.second[k]]);
        if (known < 0) continue;
        const State::Pair& kept = memory.pairs[std::size_t(known)];
        const bool turned = order[block.first[k]] != kept.i;
        const State::Pair c = turned ? swapped(kept) : kept;
        const std::size_t lane = PairContacts::width * b + k;
        for (std::size_t x = 0; x < 3; ++x) block.spring[x][k] = c.spring[Eigen::Index(x)];
        block.contact_radius[k] = c.contact_radius;
        pairs.birth_step[lane] = c.birth_step;
        if (rolling_spring)
          for (std::size_t x = 0; x < 3; ++x) pairs.rolling[b].torque[x][k] = c.rolling[Eigen::Index(x)];
        if (setup.keep_ledger) {
          const LastForces& last = memory.last[std::size_t(known)];
          pairs.last[lane] = turned ? swapped(last) : last;
        }
        pairs.head[b].acts = true;
        ++remembered;
      }
    if (remembered != memory.pairs.size())
      throw CaseError("the stored state has a contact between grains that are apart");
    build_wall_lists(memory);
  }

  // Thin lists hold little more than the contacts, thick ones are built less often. The aim is a list that lasts a few hundred
  // steps; forces do not depend on it.
  void adapt_skin() {
    const std::uint64_t lasted = step - listed_step;
    if (lasted < 200) skin = std::min(1.5 * skin, mean_radius);
    if (lasted > 2000) skin = std::max(0.8 * skin, 0.05 * mean_radius);
  }

  void build_wall_lists(const Memory& memory) {
    const std::size_t n = size(), chunks = chunks_of(n);
    WallContacts fresh;
    fresh.skin = skin;
    fresh.chunk_begin.assign(1, 0);
    const std::vector<std::uint32_t> begin = first_of_rows(memory.wall_pairs, n);
    std::size_t remembered = 0;
    for (std::size_t number = 0; number < chunks; ++number) {
      for (std::uint32_t w = 0; w < setup.walls.size(); ++w) {
        const std::uint32_t first = std::uint32_t(fresh.candidate.size());
        for (std::size_t r = number * chunk_rows; r < std::min((number + 1) * chunk_rows, n); ++r) {
          const std::uint32_t i = order[r];
          WallCandidate c{};
          for (std::uint32_t k = begin[i]; k < begin[i + 1]; ++k) {
            const State::WallPair& kept = memory.wall_pairs[k];
            if (kept.wall != w) continue;
            if (c.size == WallCandidate::capacity) throw CaseError("the stored state has a contact with a wall that is not there");
            WallContact& contact = c.contact[c.size++];
            contact = WallContact{};
            contact.touch.feature = kept.feature;
            contact.touch.normal = kept.normal;
            contact.touch.distance = kept.distance;
            contact.touch.curvature = kept.curvature;
            contact.memory = {kept.spring, kept.contact_radius, kept.birth_step};
            contact.rolling = kept.rolling;
            if (setup.keep_ledger) contact.last = memory.wall_last[k];
            ++remembered;
          }
          const double reach = grains[r].radius() + skin;
          if (c.size == 0 && !near(setup.walls[w], poses[w], grains[r].position(), reach)) continue;
          c.particle = std::uint32_t(r);
          c.wall = w;
          c.part_begin = std::uint32_t(fresh.parts.size());
          candidate_parts(setup.walls[w], poses[w], grains[r].position(), reach, fresh.parts);
          c.part_end = std::uint32_t(fresh.parts.size());
          if (c.size == 0 && std::holds_alternative<MeshWall>(setup.walls[w].shape) && c.part_begin == c.part_end) continue;
          c.constants = wall_constants(materials(material[r], setup.walls[w].material), {grains[r].radius(), mass[r], inertia[r]});
          fresh.candidate.push_back(c);
        }
        if (first == fresh.candidate.size()) continue;
        fresh.chunk.emplace_back();
        fresh.chunk.back().wall = w;
        fresh.chunk.back().begin = first;
        fresh.chunk.back().end = std::uint32_t(fresh.candidate.size());
      }
      fresh.chunk_begin.push_back(std::uint32_t(fresh.chunk.size()));
    }
    if (remembered != memory.wall_pairs.size())
      throw CaseError("the stored state has a contact with a wall that is not there");
    walls = std::move(fresh);
  }

  Memory memory() const {
    Memory all;
    const bool ledger = setup.keep_ledger;
    std::vector<std::uint32_t> begin(size() + 1, 0);
    const auto first = [&](std::size_t lane) { return std::min(order[pairs.first(lane)], order[pairs.second(lane)]); };
    for (std::size_t lane = 0; lane < pairs.lanes(); ++lane)
      if (pairs.acts(lane)) ++begin[first(lane) + 1];
    for (std::size_t i = 0; i < size(); ++i) begin[i + 1] += begin[i];
    std::vector<std::uint32_t> at(begin.begin(), begin.end() - 1), lane_of(begin.back());
    for (std::size_t lane = 0; lane < pairs.lanes(); ++lane)
      if (pairs.acts(lane)) lane_of[at[first(lane)]++] = std::uint32_t(lane);
    const auto other = [&](std::uint32_t lane) { return std::max(order[pairs.first(lane)], order[pairs.second(lane)]); };
    all.pairs.resize(lane_of.size());
    if (ledger) all.last.resize(lane_of.size());
#pragma omp parallel for schedule(static)
    for (std::size_t i = 0; i < size(); ++i) {
      std::sort(lane_of.begin() + begin[i], lane_of.begin() + begin[i + 1],
                [&](std::uint32_t a, std::uint32_t b) { return other(a) < other(b); });
      for (std::uint32_t k = begin[i]; k < begin[i + 1]; ++k) {
        const std::uint32_t lane = lane_of[k];
        const PairContacts::Block& block = pairs.block[lane / PairContacts::width];
        const std::size_t x = lane % PairContacts::width;
        State::Pair c{order[block.first[x]], order[block.second[x]], {block.spring[0][x], block.spring[1][x], block.spring[2][x]},
                      pairs.birth_step[lane], block.contact_radius[x]};
        if (rolling_spring) {
          const auto& rolling = pairs.rolling[lane / PairContacts::width].torque;
          c.rolling = {rolling[0][x], rolling[1][x], rolling[2][x]};
        }
        const bool turned = c.i > c.j;
        all.pairs[k] = turned ? swapped(c) : c;
        if (ledger) all.last[k] = turned ? swapped(pairs.last[lane]) : pairs.last[lane];
      }
    }
    for_each_wall_contact([&](const WallCandidate& c, const WallContact& w) {
      all.wall_pairs.push_back({order[c.particle], c.wall, w.touch.feature, w.touch.normal, w.memory.spring, w.memory.birth_step,
                                w.memory.contact_radius, w.rolling, w.touch.distance, w.touch.curvature});
      if (ledger) all.wall_last.push_back(w.last);
    });
    return all;
  }

  // Formed contacts by the caller's rows, then wall, then feature.
  template <class F>
  void for_each_wall_contact(F f) const {
    std::vector<std::uint32_t> sorted(walls.candidate.size());
    std::iota(sorted.begin(), sorted.end(), 0u);
    std::sort(sorted.begin(), sorted.end(), [&](std::uint32_t a, std::uint32_t b) {
      const WallCandidate &x = walls.candidate[a], &y = walls.candidate[b];
      return std::tuple(order[x.particle], x.wall) < std::tuple(order[y.particle], y.wall);
    });
    for (const std::uint32_t q : sorted)
      for (std::size_t k = 0; k < walls.candidate[q].size; ++k)
        if (walls.candidate[q].contact[k].acts()) f(walls.candidate[q], walls.candidate[q].contact[k]);
  }

  // Completes the sums of forces on every grain and, if asked to, moves it. Returns the largest component of any velocity.
  double finish_forces(bool move) {
    double speed = 0, largest_compressive = 0;
    std::uint32_t watched = 0;
    const std::size_t chunks = pairs.chunk.size(), n = size();
    const Vec4 gravity = quad(setup.gravity, 0);
#pragma omp parallel for schedule(static) reduction(max : speed, largest_compressive) reduction(+ : watched) if (chunks >= few_chunks)
    for (std::size_t c = 0; c < chunks; ++c) {
      add_crossing(pairs, c, forces);
      Vec4 fastest = Vec4::Zero();
      for (std::size_t i = c * chunk_rows; i < std::min((c + 1) * chunk_rows, n); ++i) {
        forces[i].force += mass[i] * gravity;
        const double pressed = forces[i].force[3];
        largest_compressive = std::max(largest_compressive, pressed);
        watched += pressed > setup.watch_force ? 1 : 0;
        if (move) fastest = fastest.cwiseMax(kick_and_drift(i).cwiseAbs());
      }
      speed = std::max(speed, fastest.maxCoeff());
    }
    window.largest_compressive_force = std::max(window.largest_compressive_force, largest_compressive);
    window.most_watched = std::max(window.most_watched, watched);
    return speed;
  }

  // The change of a velocity in one step under local damping; the velocity in the middle of the step says which way it goes.
  Vec4 damped(const Vec4& velocity, const Vec4& change) const {
    const double speeding_up = change.head<3>().dot((velocity + 0.5 * change).head<3>());
    const double share = speeding_up > 0 ? 1 - setup.local_damping : 1 + setup.local_damping;
    return share * change;
  }

  // Returns the new velocity.
  Vec4 kick_and_drift(std::size_t i) {
    const Vec4 three(1, 1, 1, 0);
    Vec4 faster = (kick[i] * three).cwiseProduct(forces[i].force), spun = turn[i] * forces[i].torque;
    GrainRow& grain = grains[i];
    if (setup.local_damping != 0) {
      faster = damped(grain.motion, faster);
      spun = damped(grain.spin, spun);
    }
    grain.motion += faster;
    grain.spin += spun;
    const Vec4 velocity = three.cwiseProduct(grain.motion);
    grain.place += setup.step * velocity;
    return velocity;
  }

  // Likewise for all of them.
  double move_all() {
    double speed = 0;
#pragma omp parallel for schedule(static) reduction(max : speed) if (pairs.chunk.size() >= few_chunks)
    for (std::size_t i = 0; i < size(); ++i) speed = std::max(speed, kick_and_drift(i).cwiseAbs().maxCoeff());
    return speed;
  }

  // m, of the skin of the lists: what two bodies may still come nearer until the lists must be built again.
  double skin_left() const {
    double travel2 = 0;
#pragma omp parallel for schedule(static) reduction(max : travel2) if (pairs.chunk.size() >= few_chunks)
    for (std::size_t i = 0; i < size(); ++i) travel2 = std::max(travel2, (grains[i].place - listed[i]).head<3>().squaredNorm());
    const double travel = std::sqrt(travel2), wall_travel = wall_speed * setup.step * double(step - listed_step);
    return skin - travel - std::max(travel, wall_travel);
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
    double speed = move_all();
    for (std::uint64_t k = 1; k <= steps; ++k) {
      ++step;
      move_walls();
      const double root_three = 1.7320508075688774;
      speed *= root_three;
      odometer += (speed + std::max(speed, wall_speed)) * setup.step;
      if (!(odometer < next_look)) {
        const double left = skin_left();
        next_look = odometer + 0.999 * left;
        if (!(left > 0.01 * skin)) {
          guard();
          adapt_skin();
          show_particles();
          build_lists(memory());
        }
      }
      evaluate(setup.step, k == steps);
      if (!(window.largest_overlap < runaway_overlap)) stop();
      speed = finish_forces(k < steps);
      record_walls();
    }
    show_particles();
    guard();
  }

  [[noreturn]] void stop() {
    evaluate(0.0, true);  // so that the last frame shows the forces
    stop_for_overlap(guarded());
  }

  GuardInput guarded() const { return {setup, id, grains, mass, inertia, materials, pairs, walls, time()}; }
  void guard() const {
    check_motion(guarded());
    check_stable_step(guarded());
  }

  double kinetic_energy() const {
    double energy = 0;
    for (std::size_t i = 0; i < size(); ++i)
      energy += 0.5 * mass[i] * grains[i].velocity().squaredNorm() + 0.5 * inertia[i] * grains[i].angular_velocity().squaredNorm();
    return energy;
  }

  Ledger ledger() const {
    Ledger sum;
    if (!setup.keep_ledger) return sum;
    for (std::size_t i = 0; i < size(); ++i) {
      const Vec3 v = grains[i].velocity(), w = grains[i].angular_velocity();
      sum.kinetic += 0.5 * v.dot(mass[i] * v + setup.step * forces[i].force.head<3>());
      sum.rotational += 0.5 * w.dot(inertia[i] * w + setup.step * forces[i].torque.head<3>());
      sum.gravitational -= mass[i] * setup.gravity.dot(grains[i].position());
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
  for (const PairContacts::Block& block : engine_->pairs.block)
    for (const double radius : block.contact_radius) count += radius > 0;
  for (const WallCandidate& c : engine_->walls.candidate)
    for (std::size_t k = 0; k < c.size; ++k) count += c.contact[k].acts();
  return count;
}

State Simulation::state() const {
  const Engine& e = *engine_;
  State state;
  state.step = e.step;
  e.show_particles();
  state.particles = e.p;
  state.force.resize(e.size());
  state.torque.resize(e.size());
  for (std::size_t r = 0; r < e.size(); ++r) {
    state.force[e.order[r]] = e.forces[r].force.head<3>();
    state.torque[e.order[r]] = e.forces[r].torque.head<3>();
    state.layout.listed.push_back(e.listed[r].head<3>());
  }
  state.layout.order = e.order;
  for (std::size_t lane = 0; lane < e.pairs.lanes(); ++lane) {
    state.layout.first.push_back(e.pairs.first(lane));
    state.layout.second.push_back(e.pairs.second(lane));
  }
  state.layout.listed_step = e.listed_step;
  state.layout.skin = e.skin;
  state.layout.odometer = e.odometer;
  state.layout.next_look = e.next_look;
  Memory memory = e.memory();
  state.pairs = std::move(memory.pairs);
  state.wall_pairs = std::move(memory.wall_pairs);
  if (e.setup.keep_ledger) {
    state.ledger = {e.spent, e.initial_energy, e.wall_work, e.last_power, std::move(memory.last), std::move(memory.wall_last)};
  }
  return state;
}

View Simulation::view() const {
  const Engine& e = *engine_;
  const std::size_t n = e.size();
  const double half = 0.5 * e.setup.step;
  e.show_particles();
  View view;
  view.step = e.step;
  view.time = e.time();
  view.id = e.p.id;
  view.material = e.p.material;
  view.radius = e.p.radius;
  view.position = e.p.position;
  view.compressive_force.resize(n);
  view.velocity.resize(n);
  view.angular_velocity.resize(n);
  for (std::size_t r = 0; r < n; ++r) {
    const std::uint32_t i = e.order[r];
    view.compressive_force[i] = e.forces[r].force[3];
    view.velocity[i] = e.p.velocity[i] + half / e.mass[r] * e.forces[r].force.head<3>();
    view.angular_velocity[i] = e.p.angular_velocity[i] + half / e.inertia[r] * e.forces[r].torque.head<3>();
  }
  for (std::size_t lane = 0; lane < e.pairs.lanes(); ++lane) {
    if (!e.pairs.acts(lane)) continue;
    const PairForce& r = e.pairs.result[lane];
    const std::uint32_t first = e.order[e.pairs.first(lane)], second = e.order[e.pairs.second(lane)];
    const double distance = (e.p.position[second] - e.p.position[first]).norm();
    const auto [i, j] = std::minmax(first, second);
    view.pairs.push_back({i, j, e.p.radius[i] + e.p.radius[j] - distance, r.elastic, r.damping,
                          first < second ? r.tangential : Vec3(-r.tangential), e.pairs.birth_step[lane], r.sliding});
  }
  std::sort(view.pairs.begin(), view.pairs.end(),
            [](const PairRecord& a, const PairRecord& b) { return std::tie(a.i, a.j) < std::tie(b.i, b.j); });
  e.for_each_wall_contact([&](const WallCandidate& c, const WallContact& r) {
    const std::uint32_t i = e.order[c.particle];
    view.wall_pairs.push_back({i, c.wall, r.touch.facet, r.touch.kind, r.touch.point, r.touch.normal,
                               e.p.radius[i] - r.touch.distance, r.elastic, r.damping, r.tangential, r.memory.birth_step,
                               r.sliding});
  });
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
