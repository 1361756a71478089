#include "libdem/simulation/simulation.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "libdem/contact/forces.hpp"
#include "libdem/errors.hpp"
#include "libdem/neighbors/spatial_order.hpp"
#include "libdem/simulation/contact_memory.hpp"
#include "libdem/simulation/grain_store.hpp"
#include "libdem/simulation/guards.hpp"

namespace dem {
namespace {

// Below this many chunks waking other threads costs more than they save.
constexpr std::size_t few_chunks = 3;

}  // namespace

struct Simulation::Engine {
  Setup setup;
  MaterialTable materials;
  std::uint64_t step = 0;
  GrainStore grains;
  std::vector<double> kick, turn;  // [N] s/kg, s/(kg m^2): the step over mass and inertia, by row
  std::vector<WallPose> poses;
  double mean_radius = 1, skin = 0;  // m
  std::uint64_t listed_step = 0;
  double wall_speed = 0;   // m/s, upper bound
  double odometer = 0;     // m, upper bound of how far any two bodies have come nearer since the run began
  double next_look = 0;    // m, on the odometer: when to look how much of the skin is left
  PairContacts pairs;
  WallContacts walls;
  std::vector<WallLoad> loads;  // [walls] of the last evaluation

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
    check(memory, n, setup.walls.size());
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

  void evaluate(double dt, bool record) {
    const double overlap = evaluate_contacts(setup.law, setup.keep_ledger,
                                             {grains.rows, materials, setup.walls, poses, dt, step, odometer, setup.wall_curvature, record},
                                             pairs, walls, grains.forces);
    window.largest_overlap = std::max(window.largest_overlap, overlap);
    if (setup.keep_ledger && dt > 0) {
      for (const PairContacts::Chunk& chunk : pairs.chunk) spent += chunk.ledger;
      for (const WallContacts::Chunk& chunk : walls.chunk) spent += chunk.ledger;
    }
  }

  ListInput list_input() const { return {setup, materials, poses, skin}; }

  void lay_out_rows(std::vector<std::uint32_t> order) {
    lay_out(grains, std::move(order));
    kick.resize(size());
    turn.resize(size());
    for (std::size_t r = 0; r < size(); ++r) {
      kick[r] = setup.step / grains.mass[r];
      turn[r] = setup.step / grains.inertia[r];
    }
  }

  // Lists of what may touch around the present positions, the grains laid out anew.
  void build_lists(const Memory& memory) {
    lay_out_rows(spatial_order(grains.caller.position, 2 * mean_radius));
    for (std::size_t r = 0; r < size(); ++r) grains.listed[r] = quad(grains.rows[r].position(), 0);
    listed_step = step;
    next_look = odometer + 0.5 * skin;
    fill_lists(list_pairs(list_input(), grains, memory), memory);
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
      lay_out_rows(layout.order);
      sound = fit(pairs_of_lanes, grains.table());
    }
    if (!sound) throw CaseError("the stored state has a layout that does not fit its grains");
    for (std::size_t r = 0; r < n; ++r) grains.listed[r] = quad(layout.listed[r], 0);
    skin = layout.skin;
    listed_step = layout.listed_step;
    odometer = layout.odometer;
    next_look = layout.next_look;
    fill_lists(pairs_of_lanes, memory);
  }

  void fill_lists(const Lanes& lanes, const Memory& memory) {
    pairs = make_pair_contacts(list_input(), lanes, grains, memory);
    walls = make_wall_contacts(list_input(), grains, memory);
  }

  // Thin lists hold little more than the contacts, thick ones are built less often. The aim is a list that lasts a few hundred
  // steps; forces do not depend on it.
  void adapt_skin() {
    const std::uint64_t lasted = step - listed_step;
    if (lasted < 200) skin = std::min(1.5 * skin, mean_radius);
    if (lasted > 2000) skin = std::max(0.8 * skin, 0.05 * mean_radius);
  }

  // Completes the sums of forces on every grain and, if asked to, moves it. Returns the largest component of any velocity.
  double finish_forces(bool move) {
    double speed = 0, largest_compressive = 0;
    std::uint32_t watched = 0;
    const std::size_t chunks = pairs.chunk.size(), n = size();
    const Vec4 gravity = quad(setup.gravity, 0);
#pragma omp parallel for schedule(static) reduction(max : speed, largest_compressive) reduction(+ : watched) if (chunks >= few_chunks)
    for (std::size_t c = 0; c < chunks; ++c) {
      add_crossing(pairs, c, grains.forces);
      Vec4 fastest = Vec4::Zero();
      for (std::size_t i = c * chunk_rows; i < std::min((c + 1) * chunk_rows, n); ++i) {
        grains.forces[i].force += grains.mass[i] * gravity;
        const double pressed = grains.forces[i].force[3];
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
    Vec4 faster = (kick[i] * three).cwiseProduct(grains.forces[i].force), spun = turn[i] * grains.forces[i].torque;
    GrainRow& grain = grains.rows[i];
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
    for (std::size_t i = 0; i < size(); ++i) travel2 = std::max(travel2, (grains.rows[i].place - grains.listed[i]).head<3>().squaredNorm());
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
          show(grains);
          build_lists(gather(grains, pairs, walls));
        }
      }
      evaluate(setup.step, k == steps);
      if (!(window.largest_overlap < runaway_overlap)) stop();
      speed = finish_forces(k < steps);
      record_walls();
    }
    show(grains);
    guard();
  }

  [[noreturn]] void stop() {
    evaluate(0.0, true);  // so that the last frame shows the forces
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
const Particles& Simulation::particles() const { return engine_->grains.caller; }
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
  }
  state.layout.order = grains.order;
  for (std::size_t lane = 0; lane < e.pairs.lanes(); ++lane) {
    state.layout.first.push_back(e.pairs.first(lane));
    state.layout.second.push_back(e.pairs.second(lane));
  }
  state.layout.listed_step = e.listed_step;
  state.layout.skin = e.skin;
  state.layout.odometer = e.odometer;
  state.layout.next_look = e.next_look;
  Memory memory = gather(grains, e.pairs, e.walls);
  state.pairs = std::move(memory.pairs);
  state.wall_pairs = std::move(memory.wall_pairs);
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
  for (std::size_t lane = 0; lane < e.pairs.lanes(); ++lane) {
    if (!e.pairs.acts(lane)) continue;
    const PairForce& r = e.pairs.result[lane];
    const std::uint32_t first = grains.order[e.pairs.first(lane)], second = grains.order[e.pairs.second(lane)];
    const double distance = (p.position[second] - p.position[first]).norm();
    const auto [i, j] = std::minmax(first, second);
    view.pairs.push_back({i, j, p.radius[i] + p.radius[j] - distance, r.elastic, r.damping,
                          first < second ? r.tangential : Vec3(-r.tangential), e.pairs.birth_step[lane], r.sliding});
  }
  std::sort(view.pairs.begin(), view.pairs.end(),
            [](const PairRecord& a, const PairRecord& b) { return std::tie(a.i, a.j) < std::tie(b.i, b.j); });
  for (const std::uint32_t q : by_grain(grains, e.walls)) {
    const WallCandidate& c = e.walls.candidate[q];
    const std::uint32_t i = grains.order[c.particle];
    for (std::size_t k = 0; k < c.size; ++k) {
      const WallContact& r = c.contact[k];
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
