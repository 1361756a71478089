#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "libdem/errors.hpp"
#include "libdem/neighbors/reach.hpp"
#include "libdem/neighbors/spatial_order.hpp"
#include "libdem/simulation/engine.hpp"

namespace dem {

void Simulation::Engine::lay_out_rows(std::vector<std::uint32_t> order) {
  lay_out(grains, std::move(order));
  const std::size_t chunks = grains.chunks().count();
  chunk_level.assign(chunks, 0);  // all are due where lists are built
  foresight.lay_out(chunks);
  watch.lay_out(chunks);
  find_due();
}

// m, how far the grain of a row has gone since the lists were built; by the caller's rows of all.
double Simulation::Engine::travel(std::size_t r) const { return (grains.rows[r].place - grains.listed[r]).head<3>().norm(); }

std::vector<double> Simulation::Engine::travelled() const {
  std::vector<double> far(size());
#pragma omp parallel for schedule(static)
  for (std::size_t r = 0; r < size(); ++r) far[grains.order[r]] = travel(r);
  return far;
}

// Lists of what may touch around the present positions, the grains laid out anew. `far`: travelled(), or empty.
void Simulation::Engine::build_lists(const Memory& memory, const std::vector<double>& far) {
  const double little = too_little_left();
  lay_out_rows(spatial_order(grains.caller.position, grains.chunks().rows()));
  std::vector<double> far_of_rows(far.size());
  for (std::size_t r = 0; r < far.size(); ++r) far_of_rows[r] = far[grains.order[r]];
  const std::vector<double> reach = reaches(far_of_rows, size(), skin, std::max(thinnest_skin(), 2 * little));
  for (std::size_t r = 0; r < size(); ++r) grains.listed[r] = quad(grains.rows[r].position(), reach[r]);
  listed_step = step;
  next_look = foresight.odometer + skin_left();
  fill_lists(list_pairs(list_input(), grains, memory), memory);
}

void Simulation::Engine::fill_lists(const Lanes& lanes, const Memory& memory) {
  pairs = make_pair_contacts(list_input(), lanes, grains, memory, std::move(pairs));
  walls = make_wall_contacts(list_input(), grains, memory);
}

// Thin lists hold little more than the contacts, thick ones are built less often. The aim is a list that lasts a few hundred
// steps; forces do not depend on it.
void Simulation::Engine::adapt_skin() {
  const std::uint64_t lasted = (step - listed_step) / stride_of_all();
  if (lasted < 200) skin = std::min(1.5 * skin, thickest_skin());
  if (lasted > 2000) skin = std::max(0.8 * skin, thinnest_skin());
}

// m, what the odometer may still gain until the lists must be built again: of each grain's reach, twice as two may near each
// other so, and of the skin between grains and walls.
double Simulation::Engine::skin_left() const {
  double least = 0.5 * skin, furthest = 0;
#pragma omp parallel for schedule(static) reduction(min : least) reduction(max : furthest) if (pairs.chunk.size() >= RowChunks::few)
  for (std::size_t i = 0; i < size(); ++i) {
    const double way = travel(i);
    least = std::min(least, grains.listed[i][3] - way);
    furthest = std::max(furthest, way);
  }
  return std::min(2 * least, skin - furthest - foresight.wall_speed() * setup.step * double(step - listed_step));
}

// m, on the odometer. Lists with less than this left are used up: they must last until all are due again, and to look costs a pass over
// the grains, which takes as long as a few chunks take for a step.
double Simulation::Engine::too_little_left() const {
  const double steps = std::max(2 * double(stride_of_all()), 8.0);  // twice as many as needed, as speeds may double
  return 0.01 * skin + steps * setup.step * foresight.closing_speed();
}

void Simulation::Engine::renew_lists() {
  const double left = skin_left();
  next_look = foresight.odometer + 0.999 * left;
  if (left > too_little_left()) return;
  guard();
  adapt_skin();
  show(grains);
  build_lists(gather(grains, pairs, walls), travelled());
  ++effort.lists;
}

// How often blocks are filled anew while lists last: 1 to 2 % of the time of so many steps goes into it. Twice and half as often are as good.
bool Simulation::Engine::regrouping_is_due() const {
  const std::uint64_t every = std::max<std::uint64_t>(256, stride_of_all());
  return step > listed_step && (step - listed_step) % every == 0;
}

// The lists that a state was taken with.
void Simulation::Engine::restore_lists(const State::Layout& layout, const Memory& memory) {
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
  foresight.odometer = layout.odometer;
  next_look = layout.next_look;
  fill_lists(pairs_of_lanes, memory);
  if (setup.levels > 0 && !layout.grain_level.empty()) restore_levels(layout);
}

// What an uninterrupted run would know of the levels.
void Simulation::Engine::restore_levels(const State::Layout& layout) {
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
  foresight.until_all_due = layout.foresight;
  foresight.closing_jolt = layout.closing_jolt;
}

State::Layout Simulation::Engine::layout() const {
  State::Layout layout;
  for (std::size_t r = 0; r < size(); ++r) {
    layout.listed.push_back(grains.listed[r].head<3>());
    layout.reach.push_back(grains.listed[r][3]);
  }
  layout.chunk_rows = grains.chunks().rows();
  layout.order = grains.order;
  for (std::size_t lane = 0; lane < pairs.lanes(); ++lane) {
    layout.first.push_back(pairs.first(lane));
    layout.second.push_back(pairs.second(lane));
  }
  layout.listed_step = listed_step;
  layout.skin = skin;
  layout.odometer = foresight.odometer;
  layout.next_look = next_look;
  if (setup.levels == 0) return layout;
  constexpr std::uint8_t asleep = State::Layout::asleep_level;
  layout.grain_level = grains.level;
  const auto level_of = [](const Activity& a) { return !a.acts && a.asleep ? asleep : a.level; };
  for (const Activity& activity : pairs.activity) {
    layout.block_level.push_back(level_of(activity));
    layout.block_wake.push_back(activity.wake);
    layout.block_quiet.push_back(activity.quiet_until);
  }
  for (std::size_t q = 0; q < walls.candidate.size(); ++q) {
    layout.wall_grain.push_back(walls.candidate[q].particle);
    layout.wall.push_back(walls.candidate[q].wall);
    layout.wall_level.push_back(level_of(walls.activity[q]));
    layout.wall_wake.push_back(walls.activity[q].wake);
    layout.wall_quiet.push_back(walls.activity[q].quiet_until);
  }
  layout.foresight = foresight.until_all_due;
  layout.closing_jolt = foresight.closing_jolt;
  return layout;
}

}  // namespace dem
