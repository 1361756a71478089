#include "libdem/simulation/simulation.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "libdem/simulation/engine.hpp"

namespace dem {
namespace {

template <class... Array>
std::size_t bytes_of(const Array&... arrays) {
  return ((arrays.capacity() * sizeof(typename Array::value_type)) + ...);
}

}  // namespace

Simulation::Simulation(Setup setup, State state) : engine_(std::make_unique<Engine>(std::move(setup), std::move(state))) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

void Simulation::advance(std::uint64_t steps) { engine_->advance(steps); }
std::uint64_t Simulation::step() const { return engine_->step; }
double Simulation::time() const { return engine_->time(); }
const Setup& Simulation::setup() const { return engine_->setup; }
const Particles& Simulation::particles() const { return engine_->grains.caller; }
const std::vector<Excursion>& Simulation::ended_excursions() const { return engine_->watch.excursions().ended(); }
const std::vector<Excursion>& Simulation::excursions() const { return engine_->watch.excursions().open(); }
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
  }
  state.layout = e.layout();
  Memory memory = gather(grains, e.pairs, e.walls);
  state.pairs = std::move(memory.pairs);
  state.wall_pairs = std::move(memory.wall_pairs);
  state.excursions = e.watch.excursions().open();
  if (e.setup.keep_ledger) {
    state.ledger = {e.spent, e.initial_energy, e.books.work, e.books.last_power, std::move(memory.last), std::move(memory.wall_last)};
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
  for (std::size_t w = 0; w < e.poses.size(); ++w) view.walls.push_back({e.poses[w], e.books.loads()[w].force, e.books.loads()[w].torque, {}});
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
  w.excursions = e.watch.take_ended();
  w.walls = e.books.means(double(e.step - w.first_step));
  for (const Wall& wall : e.setup.walls) w.is_mesh.push_back(std::holds_alternative<MeshWall>(wall.shape));
  if (e.setup.keep_ledger) w.ledger = e.ledger();
  e.begin_window();
  return w;
}

}  // namespace dem
