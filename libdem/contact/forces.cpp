#include "libdem/contact/forces.hpp"

#include <omp.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <optional>
#include <thread>
#include <utility>

#include "libdem/contact/chunk_shares.hpp"
#include "libdem/contact/due_list.hpp"
#include "libdem/contact/rows.hpp"
#include "libdem/errors.hpp"
#include "libdem/particles/ask_memory.hpp"

// Inlines a whole law into the kernel that calls it. Not under the address sanitizer, which the compiler did not get through in a
// quarter of an hour.
#ifdef __has_feature  // Clang; GCC says it by a macro
#define JAMSCOPE_ASAN __has_feature(address_sanitizer)
#elif defined(__SANITIZE_ADDRESS__)
#define JAMSCOPE_ASAN 1
#else
#define JAMSCOPE_ASAN 0
#endif
#if JAMSCOPE_ASAN
#define JAMSCOPE_FLATTEN
#else
#define JAMSCOPE_FLATTEN [[gnu::flatten]]
#endif

namespace dem {
namespace {

using Block = PairContacts::Block;

// Below this many chunks waking other threads costs more than they save.
constexpr std::size_t few_chunks = 3;
// What rounding may add to a sum of movements: blocks are looked at a little before they must be.
constexpr double cautious = 0.999;

template <class Get>
Pack gather(Get get) {
  return Pack([&](auto lane) { return get(std::size_t(lane)); });
}
template <class Get>
Triple<Pack> gather_triple(Get get) {
  return {gather([&](std::size_t k) { return get(k).x(); }), gather([&](std::size_t k) { return get(k).y(); }),
          gather([&](std::size_t k) { return get(k).z(); })};
}
inline Vec3 lane_of(const Triple<Pack>& t, std::size_t k) { return {t.x[k], t.y[k], t.z[k]}; }
inline Triple<Pack> all_lanes(const Vec3& v) { return {Pack(v.x()), Pack(v.y()), Pack(v.z())}; }
inline Triple<Pack> nothing() { return {Pack(0.0), Pack(0.0), Pack(0.0)}; }
inline Pack only(const Mask<Pack>& mask, const Pack& a) { return select(mask, a, Pack(0.0)); }
inline Triple<Pack> only(const Mask<Pack>& mask, const Triple<Pack>& a) { return select(mask, a, nothing()); }

inline Pack load(const PairContacts::Column& column, std::size_t lane) {
  return Pack(&column[lane], std::experimental::vector_aligned);
}
inline Triple<Pack> load(const std::array<PairContacts::Column, 3>& columns, std::size_t lane) {
  return {load(columns[0], lane), load(columns[1], lane), load(columns[2], lane)};
}
inline void store(const Pack& values, PairContacts::Column& column, std::size_t lane) {
  values.copy_to(&column[lane], std::experimental::vector_aligned);
}
inline void store(const Triple<Pack>& values, std::array<PairContacts::Column, 3>& columns, std::size_t lane) {
  store(values.x, columns[0], lane);
  store(values.y, columns[1], lane);
  store(values.z, columns[2], lane);
}

// What the contacts of one chunk of grains do to them.
struct ChunkOutput {
  ForceSheet& sheet;
  std::vector<std::uint8_t>& asked;
  RowChunks chunks;

  // Of a phantom that of some grain of the chunk: nothing is added to it.
  ForceRow& of(std::uint32_t row) const { return sheet[chunks.place(row)]; }
};

// Each constant of a table is get(the member, its number in the table). Members are constants of the compiler, and written out:
// it sees through a table and unrolls a loop too late to keep packs out of memory.
template <class Get>
inline void fill_materials(PairConstants<Pack>& c, Get get) {
  const auto fill = [&]<std::size_t M>(std::integral_constant<std::size_t, M>) {
    constexpr auto to = material_constants<Pack>[M];
    constexpr auto from = material_constants<double>[M];
    c.*to = get(std::integral_constant<decltype(from), from>{}, M);
  };
  [&]<std::size_t... M>(std::index_sequence<M...>) {
    (fill(std::integral_constant<std::size_t, M>{}), ...);
  }(std::make_index_sequence<material_constants<Pack>.size()>{});
}
template <class Get>
inline void fill_contacts(PairConstants<Pack>& c, Get get) {
  const auto fill = [&]<std::size_t M>(std::integral_constant<std::size_t, M>) {
    constexpr auto to = contact_constants<Pack>[M];
    constexpr auto from = contact_constants<double>[M];
    c.*to = get(std::integral_constant<decltype(from), from>{}, M);
  };
  [&]<std::size_t... M>(std::index_sequence<M...>) {
    (fill(std::integral_constant<std::size_t, M>{}), ...);
  }(std::make_index_sequence<constants_per_contact>{});
}
// All but those that follow from the rows of the grains.
inline void fill_constants(PairConstants<Pack>& c, const MaterialTable& materials, const PairContacts& pairs, std::size_t number,
                           std::size_t lane) {
  const PairConstants<double>& kind = materials.pair[pairs.kind[number].material_pair];
  fill_materials(c, [&](auto member, std::size_t) { return Pack(kind.*member()); });
  c.cube_root = load(pairs.block[number].cube_root, lane);
}

// How two bodies moved last.
struct LaneMotion {
  Triple<Pack> centres;         // m/s, velocities at the centres, of i less j; of a wall that of i
  Triple<Pack> spin_i, spin_j;  // rad/s
};

// One block's parts in ledger.hpp but for the second half of (1). `get(k)` gives lane k's LastForces; lanes from `count` on book
// nothing. `duration`: how long the lanes' impulses are.
template <class Law, class Get>
void book(const Law& law, const Touch<Pack>& touch, const PairConstants<Pack>& c, const ContactForce<Pack>& f,
          const Mask<Pack>& holds, const Mask<Pack>& touched, const LaneMotion& motion, bool wall,
          const Triple<Pack>& wall_velocity, const Pack& duration, std::size_t count, Get get, LedgerSums& sums) {
  const Pack normal_before = gather([&](std::size_t k) { return get(k).normal_energy; });
  const Pack tangential_before = gather([&](std::size_t k) { return get(k).tangential_energy; });
  const Pack rolling_before = gather([&](std::size_t k) { return get(k).rolling_energy; });
  // Nothing where the contact has ended.
  const Pack normal_now = only(holds, f.normal.energy), tangential_now = only(holds, f.tangential.energy),
             rolling_now = only(holds, f.rolling.energy);
  const auto [form, broken] = with_part<NormalLaws>(
      law.normal, [&](auto part) { return std::pair<Pack, Pack>(part.form_energy(c), part.break_energy(c)); });
  const Mask<Pack> formed = holds && !touched, ended = touched && !holds;
  const Pack springs_lost = only(ended, tangential_before + rolling_before);
  const Pack detachment = only(ended, broken) - only(formed, form) + springs_lost;
  const Pack stiffness = only(holds, f.tangential.stiffness_work), slip = only(holds, f.tangential.slip_work);
  const Pack rolled = rolling_before - rolling_now - only(ended, rolling_before);
  const Pack stored = normal_now - normal_before + tangential_now - tangential_before + rolling_now - rolling_before;
  const Pack time_stepping = stiffness - stored - slip - rolled - detachment;

  // One contact after the other: how contacts fall into blocks depends on the list, their order does not.
  for (std::size_t k = 0; k < count; ++k) {
    sums += {0, 0, slip[k], rolled[k], detachment[k], stiffness[k], time_stepping[k]};
    LastForces& last = get(k);
    last = LastForces{};
    if (!holds[k]) continue;
    last.duration = duration[k];
    last.normal = lane_of(touch.normal, k);
    last.arm_i = touch.arm_i[k];
    last.arm_j = touch.arm_j[k];
    last.elastic = f.normal.elastic[k];
    last.damping = f.damping[k];
    last.tangential_elastic = lane_of(f.tangential.elastic, k);
    last.tangential_viscous = lane_of(f.tangential.viscous, k);
    last.rolling_i = lane_of(f.rolling.on_i, k);
    last.rolling_j = lane_of(f.rolling.on_j, k);
    if (wall) {
      last.wall_velocity = lane_of(wall_velocity, k);
      last.wall_spin = lane_of(touch.spin_j, k);
    }
    last.normal_energy = normal_now[k];
    last.surface_energy = f.normal.surface_energy[k];
    last.tangential_energy = tangential_now[k];
    last.rolling_energy = rolling_now[k];
    sums += half_of_work(last, lane_of(motion.centres, k), lane_of(motion.spin_i, k), lane_of(motion.spin_j, k));
  }
}

bool levels_in_use(const ForceInput& in) { return in.highest > 0; }
bool all_due(const ForceInput& in) { return in.due == in.highest; }

// What is looked at is due from this level on, or a lower one.
std::uint8_t due_from_at(const ForceInput& in) { return all_due(in) ? Activity::when_all_are_due : in.due; }

std::uint32_t steps_since_all_due(const ForceInput& in) { return std::uint32_t(in.step & ((std::uint64_t{1} << in.highest) - 1)); }

// For what is apart and awake: whether no contact forms before this step, and Activity::quiet_until if none does for so many seconds.
bool quiet(const ForceInput& in, const Activity& activity) { return !all_due(in) && steps_since_all_due(in) < activity.quiet_until; }
std::uint32_t quiet_until(const ForceInput& in, double earliest) {
  return std::uint32_t(std::min(steps_since_all_due(in) + cautious * earliest / in.step_length, stride(in.highest)));
}

// s, by how much springs advance in a contact of this level.
double advance_of(const ForceInput& in, std::uint8_t level) { return in.look ? 0 : in.step_length * stride(level); }

// In steps, from the middle of the time since the last evaluation to the middle of the time until the next: what a force's
// impulse is long.
double impulse_steps(std::uint8_t before, std::uint8_t now) { return 0.5 * (stride(before) + stride(now)); }

// A contact is evaluated at least at every second movement of its grains (late() could not tell how they moved in longer). So is a pair that
// is apart, which has only the motion of the two to foresee its impact by.
constexpr std::uint8_t levels_above = 1;

// A grain that moves while one of its contacts waits goes to and fro: the contacts that are evaluated more often push it, and the one that
// waits pushes it back at once when it is due, always at the end of the same way. With the velocity that it has then, a tangential spring
// would be stretched by something that has not happened, steps after steps in the same direction: grains in a jam would creep and
// drive the blade. What has happened since is the mean velocity: of a grain that has moved twice, that of the second movement less half
// of what changed it. `late` of a contact that has waited for so many steps: 0 where the grain has moved once since, 1 where twice or more.
inline Pack late(const Pack& steps, const Pack& per_stride) {
  return smaller(larger(steps * per_stride - Pack(1.0), Pack(0.0)), Pack(1.0));
}

// `finest`: level of the finest of a block's grains.
void choose_level(const ForceInput& in, std::uint8_t finest, const LevelScale& scale, Activity& activity, const Demand& demand) {
  const std::uint8_t cap = std::uint8_t(std::min<int>(in.highest, finest + levels_above));
  activity.level = next_level(activity.level, in.due, cap, scale, demand);
}

// m/s, by how much the speed at which the bodies of a lane near each other may change until all levels are due again.
double jolt_of(const ForceInput& in, const Block& block, bool crosses) {
  double jolt = in.jolt[in.chunks.of(block.first[0])];
  if (!crosses) return jolt;
  for (std::size_t k = 0; k < PairContacts::width; ++k)
    if (block.second[k] < in.level.size()) jolt = std::max(jolt, in.jolt[in.chunks.of(block.second[k])]);
  return jolt;
}

// s, until all levels are due again if they are due now.
double longest_stride(const ForceInput& in) { return in.step_length * stride(in.highest); }

// What lanes demand; those that are apart and stay so until all levels are due again demand nothing.
void add_demand(const ForceInput& in, const LevelScale& scale, double jolt, const Pack& gap, const Pack& radius, const Pack& speed,
                Demand& demand) {
  const Pack soon = only(gap < (speed + Pack(jolt)) * Pack(longest_stride(in)), speed);
  demand.radius = std::max(demand.radius, double(std::experimental::hmax(radius)));
  demand.speed = std::max(demand.speed, double(std::experimental::hmax(soon)));
  demand.impact = std::max(demand.impact, double(std::experimental::hmax(only(drives_deeper(scale, radius, soon), soon))));
}

// The second grains of blocks that cross to other chunks hear of it in add_crossing().
void ask(const Block& block, std::uint8_t level, bool crosses, const ChunkOutput& out) {
  std::uint8_t* const asked = out.asked.data();  // else read anew after every byte, which may be any
  const auto ask_one = [&](std::uint32_t i) { asked[i] = std::min(asked[i], level); };
  for (std::size_t k = 0; k < PairContacts::width; ++k) ask_one(block.first[k]);
  if (crosses) return;
  for (std::size_t k = 0; k < PairContacts::width; ++k) ask_one(block.second[k]);
}

// Level of the finest of grains with these 2^-level; none of phantoms.
inline std::uint8_t finest_of(const ForceInput& in, const Pack& per_stride) {
  const double most = std::experimental::hmax(per_stride);
  constexpr int bias = 1023, fraction_bits = 52;  // of IEEE 754's double; the fraction of a power of two is 0
  return most > 0 ? std::uint8_t(bias - int(std::bit_cast<std::uint64_t>(most) >> fraction_bits)) : in.highest;
}

struct Approach {
  double gap;     // m, the smallest that a lane still has to close before a contact forms; < 0 where one forms now
  bool soon;      // may a lane form a contact until all levels are due again?
  double earliest;  // s, from now, at which one may form at the earliest; of use if `soon`
  Demand demand;  // nothing unless levels are in use; likewise:
  std::uint8_t finest;  // level of the finest grain
};
template <class Law>
JAMSCOPE_FLATTEN Approach look_at(const Law& law, const ForceInput& in, const PairContacts& pairs, std::size_t number, bool crosses) {
  const Block& block = pairs.block[number];
  Approach approach{std::numeric_limits<double>::infinity(), false, std::numeric_limits<double>::infinity(), {}, in.highest};
  const double jolt = levels_in_use(in) ? jolt_of(in, block, crosses) : 0;
  for (std::size_t lane = 0; lane < PairContacts::width; lane += pack_width) {
    const auto i = [&](std::size_t k) -> const GrainRow& { return in.grains[block.first[lane + k]]; };
    const auto j = [&](std::size_t k) -> const GrainRow& { return in.grains[block.second[lane + k]]; };
    const auto place_i = load_quads([&](std::size_t k) { return i(k).place.data(); });
    const auto place_j = load_quads([&](std::size_t k) { return j(k).place.data(); });
    const Triple<Pack> branch{place_j[0] - place_i[0], place_j[1] - place_i[1], place_j[2] - place_i[2]};
    PairConstants<Pack> c;
    fill_constants(c, in.materials, pairs, number, lane);
    set_effective_radius(c, Pack(c.cube_root * c.cube_root * c.cube_root), c.cube_root, Pack(1.0 / c.cube_root));
    const Pack form = with_part<NormalLaws>(law.normal, [&](auto part) -> Pack { return part.form_overlap(c); });
    const Pack distance = square_root(dot(branch, branch)), gap = distance - place_i[3] - place_j[3] + form;
    approach.gap = std::min(approach.gap, double(std::experimental::hmin(gap)));
    if (!levels_in_use(in)) continue;
    const auto motion_i = load_quads([&](std::size_t k) { return i(k).motion.data(); });
    const auto motion_j = load_quads([&](std::size_t k) { return j(k).motion.data(); });
    const auto arrival_i = load_quads([&](std::size_t k) { return i(k).arrival.data(); });
    const auto arrival_j = load_quads([&](std::size_t k) { return j(k).arrival.data(); });
    approach.finest = std::min(approach.finest, finest_of(in, larger(arrival_i[3], arrival_j[3])));
    const Triple<Pack> apart{motion_j[0] - motion_i[0], motion_j[1] - motion_i[1], motion_j[2] - motion_i[2]};
    const Pack speed = absolute(dot(apart, branch) / distance);
    const Pack nearing = speed + Pack(jolt);
    approach.soon |= any_of(gap < nearing * Pack(longest_stride(in)));
    approach.earliest = std::min(approach.earliest, double(std::experimental::hmin(gap / nearing)));
    add_demand(in, pairs.kind[number].scale, jolt, gap, Pack(0.0), speed, approach.demand);
  }
  return approach;
}

// How lanes of a block, as many as a pack holds, touch now.
struct LaneTouch {
  PairConstants<Pack> constants;
  Touch<Pack> touch;
  LaneMotion motion;
  Pack inverse_smaller_radius;  // 1/m
  Pack per_stride;              // 2^-level of the finer of the two grains
};
// `steps` since the block was evaluated.
inline LaneTouch touch_of_lanes(const ForceInput& in, const PairContacts& pairs, std::size_t number, std::size_t lane, double steps) {
  const Block& block = pairs.block[number];
  const auto i = [&](std::size_t k) -> const GrainRow& { return in.grains[block.first[lane + k]]; };
  const auto j = [&](std::size_t k) -> const GrainRow& { return in.grains[block.second[lane + k]]; };
  const auto [x_i, y_i, z_i, radius_i] = load_quads([&](std::size_t k) { return i(k).place.data(); });
  const auto [x_j, y_j, z_j, radius_j] = load_quads([&](std::size_t k) { return j(k).place.data(); });
  const auto [vx_i, vy_i, vz_i, inverse_i] = load_quads([&](std::size_t k) { return i(k).motion.data(); });
  const auto [vx_j, vy_j, vz_j, inverse_j] = load_quads([&](std::size_t k) { return j(k).motion.data(); });
  const auto spin_i = load_quads([&](std::size_t k) { return i(k).spin.data(); });
  const auto spin_j = load_quads([&](std::size_t k) { return j(k).spin.data(); });
  const auto arrival_i = load_quads([&](std::size_t k) { return i(k).arrival.data(); });
  const auto arrival_j = load_quads([&](std::size_t k) { return j(k).arrival.data(); });

  PairConstants<Pack> c;
  fill_constants(c, in.materials, pairs, number, lane);

  const Triple<Pack> branch{x_j - x_i, y_j - y_i, z_j - z_i};
  const Pack distance2 = dot(branch, branch), per_distance = inverse_root(distance2);
  const Pack distance = only(distance2 > Pack(0.0), distance2 * per_distance), curvature = inverse_i + inverse_j;  // 1/R*
  const Pack square = c.cube_root * c.cube_root;
  set_effective_radius(c, Pack(square * c.cube_root), c.cube_root, Pack(square * curvature));
  const Pack &mass_i = spin_i[3], &mass_j = spin_j[3];
  set_effective_mass(c, mass_i, mass_j);
  set_effective_inertia(c, sphere_inertia(mass_i, radius_i), sphere_inertia(mass_j, radius_j));
  // The contact point divides the branch in the ratio of the radii: R_i/(R_i + R_j) = R*/R_j.
  const Pack share = distance * c.effective_radius, arm_i = share * inverse_j, arm_j = share * inverse_i;
  const Triple<Pack> normal = branch * per_distance;
  const LaneMotion motion{{vx_i - vx_j, vy_i - vy_j, vz_i - vz_j}, {spin_i[0], spin_i[1], spin_i[2]}, {spin_j[0], spin_j[1], spin_j[2]}};
  Triple<Pack> turning_i = motion.spin_i, turning_j = motion.spin_j, centres = motion.centres;
  Triple<Pack> arriving{arrival_i[0] - arrival_j[0], arrival_i[1] - arrival_j[1], arrival_i[2] - arrival_j[2]};
  if (steps > 1)  // else no grain can have moved more than once, and late() is 0
    if (const Pack late_i = late(steps, arrival_i[3]), late_j = late(steps, arrival_j[3]); any_of(late_i + late_j > Pack(0.0))) {
      const auto spun_i = load_quads([&](std::size_t k) { return in.spun[block.first[lane + k]].data(); });
      const auto spun_j = load_quads([&](std::size_t k) { return in.spun[block.second[lane + k]].data(); });
      turning_i = subtract_product(turning_i, Triple<Pack>{spun_i[0], spun_i[1], spun_i[2]}, late_i);
      turning_j = subtract_product(turning_j, Triple<Pack>{spun_j[0], spun_j[1], spun_j[2]}, late_j);
      const Triple<Pack> changed = Triple<Pack>{arrival_i[0] - vx_i, arrival_i[1] - vy_i, arrival_i[2] - vz_i} * late_i -
                                   Triple<Pack>{arrival_j[0] - vx_j, arrival_j[1] - vy_j, arrival_j[2] - vz_j} * late_j;
      centres = centres - changed;
      arriving = subtract_product(arriving, changed, Pack(2.0));
    }
  const Triple<Pack> velocity = centres + cross(multiply_add(turning_i, arm_i, turning_j * arm_j), normal);
  return {c, {radius_i + radius_j - distance, normal, velocity, turning_i, turning_j, arm_i, arm_j, dot(arriving, normal)}, motion,
          larger(inverse_i, inverse_j), larger(arrival_i[3], arrival_j[3])};
}

// By value and on its own: what one lane after the other is read of goes through memory, and with it all that a law gives, whether or not
// anything is recorded.
[[gnu::noinline]] void record(PairContacts::Chunk& chunk, std::size_t first_lane, Mask<Pack> hold, Mask<Pack> sliding, Triple<Pack> tangential,
                              Pack elastic, Pack damping) {
  for (std::size_t k = 0; k < pack_width; ++k)
    if (hold[k])
      chunk.recorded.push_back({std::uint32_t(first_lane + k), sliding[k], lane_of(tangential, k), elastic[k], damping[k]});
}

// Lanes of a block that touch like this: law, impulses of so many steps added to the grains. Lanes without a contact, phantoms
// among them, add nothing. Says whether one has a contact.
template <class Law, bool Keep>
inline bool evaluate_lanes(const Law& law, const ForceInput& in, PairContacts& pairs, std::size_t number, std::size_t lane,
                           const LaneTouch& lanes, double advance, double steps, bool crosses, const ChunkOutput& out,
                           Pack& largest_overlap, LedgerSums& sums, PairContacts::Chunk& chunk) {
  Block& block = pairs.block[number];
  const Touch<Pack>& touch = lanes.touch;
  const PairConstants<Pack>& c = lanes.constants;
  Springs<Pack> springs{load(block.spring, lane), nothing(), load(block.contact_radius, lane)};
  const bool rolling_spring = !pairs.rolling.empty();
  if (rolling_spring) springs.rolling = load(pairs.rolling[number].torque, lane);
  const Mask<Pack> touched = springs.contact_radius > Pack(0.0);
  const Mask<Pack> hold = holds(law, touch.overlap, touched, c);
  const ContactForce<Pack> f = evaluate(law, touch, c, springs, Interval<Pack>(advance, 1 / advance));

  store(only(hold, springs.tangential), block.spring, lane);
  store(only(hold, springs.contact_radius), block.contact_radius, lane);
  if (rolling_spring) store(only(hold, springs.rolling), pairs.rolling[number].torque, lane);
  const std::size_t first_lane = PairContacts::width * number + lane;
  if (any_of(hold != touched))
    for (std::size_t k = 0; k < pack_width; ++k) {
      std::uint64_t& birth_step = pairs.birth_step[first_lane + k];
      if (hold[k] && !touched[k]) birth_step = in.step;
      if (touched[k] && !hold[k]) chunk.ended.add(birth_step, in.step);
    }

  const Triple<Pack> tangential = f.tangential.elastic + f.tangential.viscous;
  const Pack pushed = f.normal.elastic + f.damping;
  const Pack weight = only(hold, Pack(steps)), pressed = only(hold, larger(pushed, Pack(0.0))), zero(0.0);
  const Triple<Pack> force = only(hold, subtract_product(tangential, touch.normal, pushed) * weight);
  const Triple<Pack> twist = cross(touch.normal, tangential);
  const Triple<Pack> torque_i = only(hold, multiply_add(twist, touch.arm_i, f.rolling.on_i) * weight);
  const Triple<Pack> torque_j = only(hold, multiply_add(twist, touch.arm_j, f.rolling.on_j) * weight);
  largest_overlap = larger(largest_overlap, only(hold, touch.overlap * lanes.inverse_smaller_radius));
  for_each_row({force.x, force.y, force.z, pressed, torque_i.x, torque_i.y, torque_i.z, zero},
               [&](std::size_t k, const auto& row) { add_row(out.of(block.first[lane + k]), row); });
  const std::array<Pack, 8> opposite{-force.x, -force.y, -force.z, pressed, torque_j.x, torque_j.y, torque_j.z, zero};
  if (crosses) {
    ForceRow* const to = &pairs.crossing[pairs.kind[number].crossing + lane];
    for_each_row(opposite, [&](std::size_t k, const auto& row) { store_row(to[k], row); });
  } else {
    for_each_row(opposite, [&](std::size_t k, const auto& row) { add_row(out.of(block.second[lane + k]), row); });
  }

  if constexpr (Keep)
    book(law, touch, c, f, hold, touched, lanes.motion, false, nothing(), Pack(steps * in.step_length), pack_width,
         [&](std::size_t k) -> LastForces& { return pairs.last[first_lane + k]; }, sums);
  if (in.record) record(chunk, first_lane, hold, f.tangential.sliding, tangential, f.normal.elastic, f.damping);
  return any_of(hold);
}

// So many blocks ahead a block that is due, and then the second grains of its pairs, are asked of memory. What lies next to a block may not
// be due, so a processor does not see by itself what is read next.
constexpr std::uint32_t blocks_ahead = 6, grains_ahead = 2;

inline void ask_for_second_grains(const ForceInput& in, const Block& block) {
  for (std::size_t k = 0; k < PairContacts::width; ++k) ask_memory_for(in.grains[block.second[k]]);
}

// A block: level, law, impulses. Says by its activity whether one of its lanes is a contact. One that has just woken acts from now on,
// not since it was looked at last.
template <class Law, bool Keep>
JAMSCOPE_FLATTEN void evaluate_block(const Law& law, const ForceInput& in, PairContacts& pairs, std::size_t number, bool woken,
                                     bool crosses, const ChunkOutput& out, Pack& largest_overlap, LedgerSums& sums,
                                     PairContacts::Chunk& chunk) {
  constexpr std::size_t packs = PairContacts::width / pack_width;
  const Block& block = pairs.block[number];
  Activity& activity = pairs.activity[number];
  const LevelScale& scale = pairs.kind[number].scale;
  const double waited = woken ? 1 : stride(activity.level);
  const auto lanes = [&]<std::size_t... P>(std::index_sequence<P...>) {
    return std::array<LaneTouch, packs>{touch_of_lanes(in, pairs, number, P * pack_width, waited)...};
  }(std::make_index_sequence<packs>{});
  double advance = advance_of(in, 0), steps = 1;
  if (levels_in_use(in)) {
    const std::uint8_t before = activity.level;
    const double jolt = jolt_of(in, block, crosses);
    Demand demand;
    std::uint8_t finest = in.highest;
    for (std::size_t p = 0; p < packs; ++p) {
      finest = std::min(finest, finest_of(in, lanes[p].per_stride));
      add_demand(in, scale, jolt, -lanes[p].touch.overlap, load(block.contact_radius, p * pack_width),
                 absolute(dot(lanes[p].touch.velocity, lanes[p].touch.normal)), demand);
    }
    choose_level(in, finest, scale, activity, demand);
    ask(block, activity.level, crosses, out);
    advance = advance_of(in, woken ? 0 : before);
    steps = impulse_steps(woken ? activity.level : before, activity.level);
  }
  activity.acts = false;
  for (std::size_t p = 0; p < packs; ++p)
    activity.acts |= evaluate_lanes<Law, Keep>(law, in, pairs, number, p * pack_width, lanes[p], advance, steps, crosses, out,
                                           largest_overlap, sums, chunk);
}

// What a thread will read and write of the chunk that it comes to next, asked of memory little by little while it evaluates the one before: in
// another chunk each array is read from a place that no processor expects.
class NextChunk {
 public:
  NextChunk(const ForceInput& in, const PairContacts& pairs, const std::vector<std::uint8_t>& asked, std::optional<std::uint32_t> next) {
    if (!next) return;
    const PairContacts::Chunk& chunk = pairs.chunk[*next];
    const std::size_t begin = in.chunks.begin(*next), end = in.chunks.end(*next);
    add(pairs.due_from, chunk.begin, chunk.end);
    add(pairs.activity, chunk.begin, chunk.end);
    add(in.level, begin, end);
    add(asked, begin, end);
    add(in.grains, begin, end);
    if (levels_in_use(in)) add(in.spun, begin, end);
    add(pairs.kind, chunk.begin, chunk.end);
    add(pairs.incoming, chunk.incoming_begin, chunk.incoming_end);
  }
  // A range at a time in a loop of its own: one that asked at each line which range it is in took what it gave.
  void ask_for_some() {
    if (at_ == size_) return;
    Range& range = ranges_[at_];
    constexpr std::ptrdiff_t some = 32 * 64;
    const char* const stop = range.end - range.begin > some ? range.begin + some : range.end;
    for (const char* line = range.begin; line < stop; line += 64) __builtin_prefetch(line, 1, 2);
    range.begin = stop;
    at_ += stop == range.end;
  }

 private:
  struct Range {
    const char *begin, *end;
  };
  template <class Array>
  void add(const Array& array, std::size_t begin, std::size_t end) {
    if (begin < end) ranges_[size_++] = {reinterpret_cast<const char*>(array.data() + begin), reinterpret_cast<const char*>(array.data() + end)};
  }
  std::array<Range, 8> ranges_;
  std::size_t at_ = 0, size_ = 0;
};

template <class Law, bool Keep>
void evaluate_pair_chunk(const Law& law, const ForceInput& in, PairContacts& pairs, std::size_t number, std::optional<std::uint32_t> next,
                         const ChunkOutput& out) {
  PairContacts::Chunk& chunk = pairs.chunk[number];
  Pack largest_overlap = 0.0;
  LedgerSums sums;
  Evaluations evaluations;
  chunk.ended = EndedContacts{};
  if (in.record) chunk.recorded.clear();
  const auto visit = [&](std::uint32_t b) {
    Activity& activity = pairs.activity[b];
    const bool crosses = b >= chunk.inner_end, woken = !activity.acts && activity.asleep;
    if (!activity.acts) {
      if (woken) {
        if (!all_due(in) || in.odometer + in.foresight < activity.wake) return;
        activity.level = in.highest;
      } else if (activity.level > in.due) {
        return;
      } else if (quiet(in, activity)) {
        ask(pairs.block[b], activity.level, crosses, out);
        return;
      }
      const Approach approach = look_at(law, in, pairs, b, crosses);
      activity.asleep = approach.gap > 0 && !approach.soon;
      if (approach.gap >= 0) {
        activity.wake = in.odometer + cautious * approach.gap;
        if (!activity.asleep && levels_in_use(in)) {
          choose_level(in, approach.finest, pairs.kind[b].scale, activity, approach.demand);
          activity.quiet_until = quiet_until(in, approach.earliest);
          ask(pairs.block[b], activity.level, crosses, out);
        }
        return;
      }
    } else if (activity.level > in.due) {
      return;
    }
    evaluate_block<Law, Keep>(law, in, pairs, b, woken, crosses, out, largest_overlap, sums, chunk);
    activity.wake = in.odometer;
    activity.quiet_until = 0;
    evaluations += {1, std::uint64_t{1} << activity.level, 0, 0};
  };
  const std::span<const std::uint32_t> due =
      list_due(std::span(pairs.due_from).subspan(chunk.begin, chunk.end - chunk.begin), due_from_at(in), chunk.begin, chunk.places);
  NextChunk ahead(in, pairs, out.asked, next);
  const auto acts = [&](std::size_t n) { return n < due.size() && pairs.activity[due[n]].acts; };
  for (std::size_t n = 0; n < due.size(); ++n) {
    if (acts(n + blocks_ahead)) ask_memory_for<Use::write>(pairs.block[due[n + blocks_ahead]]);
    if (acts(n + grains_ahead)) ask_for_second_grains(in, pairs.block[due[n + grains_ahead]]);
    ahead.ask_for_some();
    visit(due[n]);
    pairs.due_from[due[n]] = pairs.activity[due[n]].due_from();
  }
  chunk.largest_overlap = std::experimental::hmax(largest_overlap);
  chunk.ledger = sums;
  chunk.evaluations = evaluations;
}

// A contact that its wall no longer has: it broke, or its feature gave way to another while it was loaded and what it stored
// is lost. `advance`, s, is the time since its last evaluation.
template <class Law>
void book_end(const Law& law, const WallContact& contact, const LastForces& last, const PairConstants<double>& c,
              const GrainRow& grain, double advance, LedgerSums& sums) {
  const Vec3 u = grain.velocity() + (last.arm_i * grain.angular_velocity()).cross(last.normal) - last.wall_velocity;
  const double expected_overlap = grain.radius() - contact.touch.distance + advance * u.dot(last.normal);
  const auto [break_overlap, break_energy] = with_part<NormalLaws>(
      law.normal, [&](auto part) { return std::pair(part.break_overlap(c), part.break_energy(c)); });
  const bool broke = expected_overlap < break_overlap;
  const double detachment =
      (broke ? break_energy : last.normal_energy) + last.tangential_energy + last.rolling_energy;
  sums.detachment += detachment;
  sums.time_stepping += last.energy().total() - detachment;
}

// Carries memory from the places a grain touched in the last step to those it touches now: first the same feature, then,
// where the grain rolled from one feature to its neighbour, the remaining place with the most similar normal. Calls
// ended(contact, its last forces) for formed contacts that nothing inherits.
template <class Ended>
void inherit(WallContacts& walls, WallCandidate& candidate, const std::vector<WallTouch>& touches, Ended ended) {
  const std::size_t old_size = candidate.size;
  WallContact* const now = &walls.contact[candidate.contact_begin];
  LastForces* const last = walls.last.empty() ? nullptr : &walls.last[candidate.contact_begin];
  if (old_size == 1 && touches.size() == 1 && now[0].touch.feature == touches[0].feature) {
    now[0].touch = touches[0];
    return;
  }
  std::array<WallContact, WallCandidate::capacity> old;
  std::array<LastForces, WallCandidate::capacity> old_last;
  std::array<bool, WallCandidate::capacity> taken{};
  std::copy_n(now, old_size, old.begin());
  if (last) std::copy_n(last, old_size, old_last.begin());
  const auto take_over = [&](std::size_t k, std::size_t o) {
    now[k].memory = old[o].memory;
    now[k].rolling = old[o].rolling;
    if (last) last[k] = old_last[o];
    taken[o] = true;
  };
  candidate.size = std::uint16_t(touches.size());
  for (std::size_t k = 0; k < touches.size(); ++k) {
    now[k] = WallContact{};
    now[k].touch = touches[k];
    if (last) last[k] = LastForces{};
    for (std::size_t o = 0; o < old_size; ++o)
      if (!taken[o] && old[o].touch.feature == touches[k].feature) take_over(k, o);
  }
  for (std::size_t k = 0; k < touches.size(); ++k) {
    if (now[k].acts()) continue;
    std::size_t best = old_size;
    double similarity = 0.9;
    for (std::size_t o = 0; o < old_size; ++o) {
      const double cosine = old[o].touch.normal.dot(touches[k].normal);
      if (!taken[o] && old[o].acts() && cosine > similarity) {
        similarity = cosine;
        best = o;
      }
    }
    if (best < old_size) take_over(k, best);
  }
  for (std::size_t o = 0; o < old_size; ++o)
    if (!taken[o] && old[o].acts()) ended(old[o], old_last[o]);
}

PairConstants<double> constants_of(const ForceInput& in, const WallCandidate& candidate, const WallContact& contact) {
  PairConstants<double> c = in.materials.pair[candidate.material_pair];
  for (std::size_t m = 0; m < constants_per_contact; ++m) c.*contact_constants<double>[m] = candidate.constant[m];
  set_effective_radius(c, in.grains[candidate.particle].radius(), c.cube_root, 1 / c.cube_root);
  return in.wall_curvature ? on_curved_wall(c, contact.touch.curvature) : c;
}

// What the grain may touch now, of its candidate parts within `reach`: chosen anew when it may have come nearer by a margin, as few of the
// many triangles around a grain of a finely meshed wall can be the next that it touches.
std::span<const std::uint32_t> parts_near(const ForceInput& in, WallContacts& walls, WallCandidate& candidate, const GrainRow& grain,
                                          double reach) {
  const std::size_t begin = candidate.part_begin, size = candidate.part_end - begin;
  const std::span<const std::uint32_t> all = std::span(walls.parts).subspan(begin, size);
  const double margin = 0.25 * walls.skin;
  if (size < 3 || margin < 2 * in.foresight) return all;
  const std::span<std::uint32_t> chosen = std::span(walls.near_parts).subspan(begin, size);
  if (!(in.odometer + in.foresight < candidate.near_until)) {
    candidate.near_count = std::uint32_t(
        parts_within(in.walls[candidate.wall], in.poses[candidate.wall], grain.position(), reach + margin, all, chosen));
    candidate.near_until = in.odometer + cautious * margin;
  }
  return chosen.first(candidate.near_count);
}

struct WallSlot {
  WallCandidate* candidate;
  WallContact* contact;
  LastForces* last;  // where a ledger is kept
  double advance;  // s
  double waited;   // steps
  double steps;    // of the impulse
};

template <class Law, bool Keep>
JAMSCOPE_FLATTEN void evaluate_wall_block(const Law& law, const ForceInput& in, const std::array<WallSlot, pack_width>& slot,
                                          std::size_t count, WallContacts::Chunk& chunk, const ChunkOutput& out,
                                          LedgerSums& sums) {
  const WallPose& pose = in.poses[chunk.wall];
  const auto grain = [&](std::size_t k) -> const GrainRow& { return in.grains[slot[k].candidate->particle]; };

  PairConstants<Pack> c;
  const auto kind = [&](std::size_t k) { return slot[k].candidate->material_pair; };
  bool one_kind = true;
  for (std::size_t k = 1; k < pack_width; ++k) one_kind &= kind(k) == kind(0);
  if (one_kind)
    fill_materials(c, [&](auto member, std::size_t) { return Pack(in.materials.pair[kind(0)].*member()); });
  else
    fill_materials(c, [&](auto member, std::size_t) { return gather([&](std::size_t k) { return in.materials.pair[kind(k)].*member(); }); });
  fill_contacts(c, [&](auto, std::size_t m) { return gather([&](std::size_t k) { return slot[k].candidate->constant[m]; }); });

  const auto [x, y, z, radius] = load_quads([&](std::size_t k) { return grain(k).place.data(); });
  const auto [v_x, v_y, v_z, inverse_radius] = load_quads([&](std::size_t k) { return grain(k).motion.data(); });
  const auto spin = load_quads([&](std::size_t k) { return grain(k).spin.data(); });
  if (in.wall_curvature) {
    std::array<PairConstants<double>, pack_width> curved;
    for (std::size_t k = 0; k < pack_width; ++k) curved[k] = constants_of(in, *slot[k].candidate, *slot[k].contact);
    const Pack cube_root = gather([&](std::size_t k) { return curved[k].cube_root; });
    set_effective_radius(c, gather([&](std::size_t k) { return curved[k].effective_radius; }), cube_root, Pack(1.0 / cube_root));
  } else {
    set_effective_radius(c, radius, c.cube_root, Pack(c.cube_root * c.cube_root * inverse_radius));
  }
  Touch<Pack> touch;
  const auto arrival = load_quads([&](std::size_t k) { return grain(k).arrival.data(); });
  const LaneMotion motion{{v_x, v_y, v_z}, {spin[0], spin[1], spin[2]}, all_lanes(pose.angular_velocity)};
  Triple<Pack> centre = motion.centres, arriving{arrival[0], arrival[1], arrival[2]};
  touch.spin_i = motion.spin_i;
  if (const Pack behind = late(gather([&](std::size_t k) { return slot[k].waited; }), arrival[3]); any_of(behind > Pack(0.0))) {
    const auto spun = load_quads([&](std::size_t k) { return in.spun[slot[k].candidate->particle].data(); });
    const Triple<Pack> changed = Triple<Pack>{arrival[0] - v_x, arrival[1] - v_y, arrival[2] - v_z} * behind;
    touch.spin_i = subtract_product(touch.spin_i, Triple<Pack>{spun[0], spun[1], spun[2]}, behind);
    centre = centre - changed;
    arriving = subtract_product(arriving, changed, Pack(2.0));
  }
  touch.spin_j = all_lanes(pose.angular_velocity);
  touch.arm_i = radius;
  touch.arm_j = 0.0;
  touch.overlap = radius - gather([&](std::size_t k) { return slot[k].contact->touch.distance; });
  touch.normal = gather_triple([&](std::size_t k) -> const Vec3& { return slot[k].contact->touch.normal; });
  const Triple<Pack> arm = touch.normal * radius;
  const Triple<Pack> lever = Triple<Pack>{x, y, z} + arm - all_lanes(pose.position);
  const Triple<Pack> wall_velocity = all_lanes(pose.velocity) + cross(touch.spin_j, lever);
  touch.velocity = centre + cross(touch.spin_i, arm) - wall_velocity;
  touch.closing = dot(arriving - wall_velocity, touch.normal);

  Springs<Pack> springs{gather_triple([&](std::size_t k) -> const Vec3& { return slot[k].contact->memory.spring; }),
                        gather_triple([&](std::size_t k) -> const Vec3& { return slot[k].contact->rolling; }),
                        gather([&](std::size_t k) { return slot[k].contact->memory.contact_radius; })};
  const Mask<Pack> touched = springs.contact_radius > Pack(0.0);
  const Mask<Pack> hold = holds(law, touch.overlap, touched, c);
  const ContactForce<Pack> f = evaluate(law, touch, c, springs,
                                        Interval<Pack>(gather([&](std::size_t k) { return slot[k].advance; })));
  const Triple<Pack> tangential = f.tangential.elastic + f.tangential.viscous;
  const Pack pushed = f.normal.elastic + f.damping;
  const Triple<Pack> force = subtract_product(tangential, touch.normal, pushed);
  const Triple<Pack> torque = cross(arm, tangential) + f.rolling.on_i;
  const Triple<Pack> torque_on_wall = f.rolling.on_j - cross(lever, force);
  const Mask<Pack> acts = hold && gather([](std::size_t k) { return double(k); }) < Pack(double(count));
  const Pack steps = gather([&](std::size_t k) { return slot[k].steps; });
  const Triple<Pack> impulse = only(acts, force * steps), angular_impulse = only(acts, torque * steps);
  for_each_row({impulse.x, impulse.y, impulse.z, only(acts, larger(pushed, Pack(0.0))), angular_impulse.x, angular_impulse.y, angular_impulse.z,
                Pack(0.0)},
               [&](std::size_t k, const auto& row) { add_row(out.of(slot[k].candidate->particle), row); });
  if constexpr (Keep)
    book(law, touch, c, f, hold, touched, motion, true, wall_velocity,
         gather([&](std::size_t k) { return slot[k].steps * in.step_length; }), count,
         [&](std::size_t k) -> LastForces& { return *slot[k].last; }, sums);

  for (std::size_t k = 0; k < count; ++k) {
    WallContact& contact = *slot[k].contact;
    if (!hold[k]) {
      if (touched[k]) chunk.ended.add(contact.memory.birth_step, in.step);
      contact.memory = ContactMemory{};
      contact.rolling.setZero();
      continue;
    }
    if (!touched[k]) contact.memory.birth_step = in.step;
    contact.memory.spring = lane_of(springs.tangential, k);
    contact.memory.contact_radius = springs.contact_radius[k];
    contact.rolling = lane_of(springs.rolling, k);
    contact.tangential = lane_of(tangential, k);
    contact.elastic = f.normal.elastic[k];
    contact.damping = f.damping[k];
    contact.sliding = f.tangential.sliding[k];
    const WallLoad load{-lane_of(force, k), lane_of(torque_on_wall, k)};
    const WallLoad share{slot[k].steps * load.force, slot[k].steps * load.torque};
    chunk.load += load;
    chunk.share += share;
    if (const auto* mesh = std::get_if<MeshWall>(&in.walls[chunk.wall].shape)) {
      const auto label = std::size_t(mesh->finder->mesh().labels[contact.touch.facet]);
      chunk.load_of_label[label] += load;
      chunk.share_of_label[label] += share;
    }
    chunk.largest_overlap = std::max(chunk.largest_overlap, touch.overlap[k] * inverse_radius[k]);
  }
}

// m/s, at which the grain's centre nears the wall where they touch, or leaves it, on average over the last steps.
double normal_speed(const GrainRow& grain, const WallPose& pose, const WallTouch& touch, double steps) {
  const Vec3 lever = grain.position() + grain.radius() * touch.normal - pose.position;
  const double behind = std::clamp(steps * grain.arrival[3] - 1, 0.0, 1.0);
  const Vec3 velocity = (1 + behind) * grain.velocity() - behind * grain.arrival.head<3>();
  return std::abs((velocity - pose.velocity - pose.angular_velocity.cross(lever)).dot(touch.normal));
}

void ask(const WallCandidate& candidate, std::uint8_t level, const ChunkOutput& out) {
  std::uint8_t& asked = out.asked[candidate.particle];
  asked = std::min(asked, level);
}

void choose_level(const ForceInput& in, const WallCandidate& candidate, Activity& activity, const Demand& demand, const ChunkOutput& out) {
  const std::uint8_t cap = std::uint8_t(std::min<int>(in.highest, in.level[candidate.particle] + levels_above));
  activity.level = next_level(activity.level, in.due, cap, candidate.scale, demand);
  ask(candidate, activity.level, out);
}

Demand demand_of(const WallContacts& walls, const WallCandidate& candidate, const GrainRow& grain, const WallPose& pose, double steps) {
  Demand demand;
  for (const WallContact& contact : walls.contacts(candidate)) {
    const double radius = contact.memory.contact_radius, speed = normal_speed(grain, pose, contact.touch, steps);
    demand.radius = std::max(demand.radius, radius);
    demand.speed = std::max(demand.speed, speed);
    if (drives_deeper(candidate.scale, radius, speed)) demand.impact = std::max(demand.impact, speed);
  }
  return demand;
}

// What a grain near a wall will load: candidates stand in a row, but not what they refer to.
inline void ask_for_what_it_touches(const ForceInput& in, const WallContacts& walls, const WallCandidate& candidate) {
  ask_memory_for<Use::write>(walls.contact[candidate.contact_begin]);
  ask_memory_for(in.grains[candidate.particle]);
}

template <class Law, bool Keep>
void evaluate_wall_chunk(const Law& law, const ForceInput& in, WallContacts& walls, WallContacts::Chunk& chunk,
                         const ChunkOutput& out) {
  std::vector<WallTouch>& touches = chunk.touches;
  const Wall& wall = in.walls[chunk.wall];
  const WallPose& pose = in.poses[chunk.wall];
  std::array<WallSlot, pack_width> slot{};
  std::size_t count = 0;
  LedgerSums sums;
  chunk.load = chunk.share = WallLoad{};
  chunk.load_of_label.fill(WallLoad{});
  chunk.share_of_label.fill(WallLoad{});
  chunk.largest_overlap = 0;
  chunk.ledger = LedgerSums{};
  chunk.evaluations = Evaluations{};
  chunk.ended = EndedContacts{};
  const auto block = [&] { evaluate_wall_block<Law, Keep>(law, in, slot, count, chunk, out, sums); };
  const auto visit = [&](std::uint32_t q) {
    Activity& activity = walls.activity[q];
    const bool away = !activity.acts, woken = away && activity.asleep;
    if (woken) {
      if (!all_due(in) || in.odometer + in.foresight < activity.wake) return;
      activity.level = in.highest;
    } else if (activity.level > in.due) {
      return;
    } else if (away && quiet(in, activity)) {
      ask(walls.candidate[q], activity.level, out);
      return;
    }
    WallCandidate& candidate = walls.candidate[q];
    const GrainRow& grain = in.grains[candidate.particle];
    // Where nothing is near, look as far as the list does, to know for how long.
    const double reach = grain.radius() - candidate.last_overlap;
    const double sight = away ? std::max(grain.radius() + walls.skin, reach) : reach;
    const std::span<const std::uint32_t> parts =
        away ? std::span<const std::uint32_t>(walls.parts).subspan(candidate.part_begin, candidate.part_end - candidate.part_begin)
             : parts_near(in, walls, candidate, grain, reach);
    nearest(wall, pose, grain.position(), sight, parts, touches, chunk.scratch);
    if (away) {
      double gap = sight - reach, speed = 0;
      for (const WallTouch& touch : touches) {
        gap = std::min(gap, touch.distance - reach);
        if (levels_in_use(in)) speed = std::max(speed, normal_speed(grain, pose, touch, 1));
      }
      activity.asleep = gap > in.foresight;
      if (gap > 0) {
        activity.wake = in.odometer + cautious * gap;
        if (!activity.asleep && levels_in_use(in)) {
          choose_level(in, candidate, activity, {0, speed, speed}, out);
          // What is out of sight is too far to be touched before all levels are due again.
          const double earliest = sight - reach > in.foresight ? gap / (speed + in.jolt[in.chunks.of(candidate.particle)]) : 0;
          activity.quiet_until = quiet_until(in, earliest);
        }
        return;
      }
      std::erase_if(touches, [&](const WallTouch& touch) { return touch.distance > reach; });
    }
    if (touches.size() > candidate.room) {
      chunk.overflow = true;
      touches.resize(candidate.room);
    }
    const std::uint8_t before = activity.level;
    inherit(walls, candidate, touches, [&](const WallContact& ended, const LastForces& last) {
      chunk.ended.add(ended.memory.birth_step, in.step);
      if constexpr (Keep)
        book_end(law, ended, last, constants_of(in, candidate, ended), grain, advance_of(in, before), chunk.ledger);
    });
    activity.acts = candidate.size > 0;
    activity.quiet_until = 0;
    if (!activity.acts) activity.wake = in.odometer;
    const double waited = woken ? 1 : stride(before);
    double steps = 1;
    if (levels_in_use(in)) {
      choose_level(in, candidate, activity, demand_of(walls, candidate, grain, pose, waited), out);
      steps = impulse_steps(woken ? activity.level : before, activity.level);
    }
    chunk.evaluations += {0, 0, candidate.size, std::uint64_t{candidate.size} << activity.level};
    for (std::size_t t = 0; t < candidate.size; ++t) {
      const std::size_t row = candidate.contact_begin + t;
      slot[count++] = {&candidate, &walls.contact[row], Keep ? &walls.last[row] : nullptr, advance_of(in, woken ? 0 : before), waited, steps};
      if (count == pack_width) {
        block();
        count = 0;
      }
    }
  };
  const std::span<const std::uint32_t> due =
      list_due(std::span(walls.due_from).subspan(chunk.begin, chunk.end - chunk.begin), due_from_at(in), chunk.begin, chunk.places);
  for (std::size_t n = 0; n < due.size(); ++n) {
    if (n + 2 < due.size() && walls.activity[due[n + 2]].acts) ask_for_what_it_touches(in, walls, walls.candidate[due[n + 2]]);
    visit(due[n]);
    walls.due_from[due[n]] = walls.activity[due[n]].due_from();
  }
  if (count > 0) {
    for (std::size_t k = count; k < pack_width; ++k) slot[k] = slot[0];
    block();
  }
  if constexpr (Keep) chunk.ledger += sums;
}

// All contacts of one chunk of grains that are due; nobody else adds forces to these grains meanwhile.
template <class Law, bool Keep>
void evaluate_chunk(const Law& law, const ForceInput& in, PairContacts& pairs, WallContacts& walls, std::size_t number,
                    std::optional<std::uint32_t> next, const ChunkOutput& out) {
  evaluate_pair_chunk<Law, Keep>(law, in, pairs, number, next, out);
  for (std::uint32_t w = walls.chunk_begin[number]; w < walls.chunk_begin[number + 1]; ++w)
    evaluate_wall_chunk<Law, Keep>(law, in, walls, walls.chunk[w], out);
}

// What pairs of other chunks do to the grains of this one.
void add_crossing(const PairContacts& pairs, const RowChunks& chunks, std::size_t chunk, std::uint8_t due, ForceSheet& sheet, std::vector<std::uint8_t>& asked) {
  constexpr std::uint32_t incoming_ahead = 12;
  const std::uint32_t end = pairs.chunk[chunk].incoming_end;
  for (std::uint32_t k = pairs.chunk[chunk].incoming_begin; k < end; ++k) {
    if (k + incoming_ahead < end) ask_memory_for(pairs.crossing[pairs.incoming[k + incoming_ahead].crossing]);
    const PairContacts::Incoming& in = pairs.incoming[k];
    const Activity& activity = pairs.activity[in.block];
    if (activity.asleep || activity.level > due) continue;
    asked[in.row] = std::min(asked[in.row], activity.level);
    if (!activity.acts) continue;
    ForceRow& to = sheet[chunks.place(in.row)];
    to.force += pairs.crossing[in.crossing].force;
    to.torque += pairs.crossing[in.crossing].torque;
  }
}

// Stays awake, but gives the processor to whoever else wants it.
template <class Condition>
void wait_until(Condition condition) {
  for (int spins = 0; !condition(); ++spins)
    if (spins > 100) std::this_thread::yield();
}

bool pending(PairContacts::Chunk& chunk) { return std::atomic_ref(chunk.pending).load(std::memory_order_acquire) != 0; }

enum class Progress : std::uint8_t { to_evaluate, waiting, taken };  // of a chunk; taken by whoever finishes it

// Each thread takes the next chunk of its share, evaluates it and finishes it. If chunks that send forces to it are still to be evaluated, it
// keeps its sheet and looks again after each of the next. When none is left to take, all finish together what still waits, each first what it
// has evaluated, whose grains its caches hold.
template <class Law, bool Keep>
double evaluate_all(const Law& law, const ForceInput& in, PairContacts& pairs, WallContacts& walls, const ForceOutput& out,
                    const FinishChunk& finish) {
  const std::size_t count = in.due_chunks.size();
  for (const std::uint32_t number : in.due_chunks) pairs.chunk[number].pending = 1;
  const std::size_t threads = count >= few_chunks ? std::size_t(omp_get_max_threads()) : 1;
  std::vector<std::atomic<Progress>> progress(count);
  std::vector<std::unique_ptr<ForceSheet>> kept(count);  // of chunks that wait
  out.sheets.prepare(threads);
  std::atomic<std::size_t> finished = 0;
  ChunkShares shares(threads, [&](std::size_t thread) {
    const std::size_t chunk = pairs.chunk.size() * thread / threads;
    return std::ranges::lower_bound(in.due_chunks, chunk) - in.due_chunks.begin();
  });
#pragma omp parallel num_threads(int(threads))
  {
    const std::size_t me = std::size_t(omp_get_thread_num());
    const auto ready = [&](std::size_t k) {
      return std::ranges::none_of(pairs.chunk[in.due_chunks[k]].senders, [&](std::uint32_t sender) { return pending(pairs.chunk[sender]); });
    };
    const auto finish_with = [&](std::size_t k, ForceSheet& sheet) {
      add_crossing(pairs, in.chunks, in.due_chunks[k], in.due, sheet, out.asked);
      finish(k, sheet);
      ++finished;
    };
    std::unique_ptr<ForceSheet>& sheet = out.sheets.of_thread(me);
    std::vector<std::uint32_t> waiting;  // of those that I have evaluated
    // True where it is finished, or being finished by another.
    const auto finish_if_ready = [&](std::size_t k) {
      Progress as = progress[k].load(std::memory_order_relaxed);
      if (as != Progress::waiting) return as == Progress::taken;
      if (!ready(k)) return false;
      if (progress[k].compare_exchange_strong(as, Progress::taken, std::memory_order_acquire)) {
        finish_with(k, *kept[k]);
        out.sheets.give_back(std::move(kept[k]));
      }
      return true;
    };
    shares.take(me, [&](std::uint32_t k) {
      const std::uint32_t number = in.due_chunks[k];
      const std::optional<std::uint32_t> next = k + 1 < count ? std::optional(in.due_chunks[k + 1]) : std::nullopt;
      evaluate_chunk<Law, Keep>(law, in, pairs, walls, number, next, ChunkOutput{*sheet, out.asked, in.chunks});
      std::atomic_ref(pairs.chunk[number].pending).store(0, std::memory_order_release);
      if (ready(k)) {
        progress[k].store(Progress::taken, std::memory_order_relaxed);
        finish_with(k, *sheet);
      } else {
        waiting.push_back(k);
        kept[k] = std::exchange(sheet, out.sheets.take());
        progress[k].store(Progress::waiting, std::memory_order_release);
      }
      std::erase_if(waiting, finish_if_ready);
    });
    // Awake until all is done, as at the end of the region OpenMP would soon put the thread to sleep, and waking it takes longer than others
    // need.
    wait_until([&] {
      std::erase_if(waiting, finish_if_ready);
      for (std::size_t k = 0; k < count; ++k) finish_if_ready(k);
      return finished == count;
    });
  }
  double largest_overlap = 0;
  for (const std::uint32_t number : in.due_chunks) {
    largest_overlap = std::max(largest_overlap, pairs.chunk[number].largest_overlap);
    for (std::uint32_t w = walls.chunk_begin[number]; w < walls.chunk_begin[number + 1]; ++w) {
      const WallContacts::Chunk& chunk = walls.chunk[w];
      largest_overlap = std::max(largest_overlap, chunk.largest_overlap);
      if (chunk.overflow)
        throw PhysicsError("a grain touches wall '" + in.walls[chunk.wall].name + "' in more than " +
                           std::to_string(WallCandidate::capacity) +
                           " places; its mesh has details much smaller than the grains");
    }
  }
  return largest_overlap;
}

template <class Law>
double evaluate_all(const Law& law, bool keep_ledger, const ForceInput& in, PairContacts& pairs, WallContacts& walls,
                    const ForceOutput& out, const FinishChunk& finish) {
  return keep_ledger ? evaluate_all<Law, true>(law, in, pairs, walls, out, finish)
                     : evaluate_all<Law, false>(law, in, pairs, walls, out, finish);
}

}  // namespace

double evaluate_contacts(const LawChoice& law, bool keep_ledger, const ForceInput& in, PairContacts& pairs, WallContacts& walls,
                         const ForceOutput& out, const FinishChunk& finish) {
  double overlap = 0;
  const bool compiled = [&]<class... Fixed>(std::type_identity<std::tuple<Fixed...>>) {
    return ((law == choice_of<Fixed>() && (overlap = evaluate_all(Fixed{}, keep_ledger, in, pairs, walls, out, finish), true)) || ...);
  }(std::type_identity<FixedLaws>{});
  return compiled ? overlap : evaluate_all(law, keep_ledger, in, pairs, walls, out, finish);
}

void book_second_half(const ForceInput& in, PairContacts& pairs, const WallContacts& walls) {
#pragma omp parallel for schedule(dynamic, 1) if (in.due_chunks.size() >= few_chunks)
  for (std::size_t n = 0; n < in.due_chunks.size(); ++n) {
    const std::uint32_t number = in.due_chunks[n];
    PairContacts::Chunk& chunk = pairs.chunk[number];
    chunk.ledger = LedgerSums{};
    for (std::uint32_t b = chunk.begin; b < chunk.end; ++b) {
      if (!pairs.activity[b].acts || pairs.activity[b].level > in.due) continue;
      for (std::size_t lane = PairContacts::width * b; lane < PairContacts::width * (b + 1); ++lane) {
        if (!pairs.acts(lane)) continue;
        const GrainRow &i = in.grains[pairs.first(lane)], &j = in.grains[pairs.second(lane)];
        chunk.ledger += half_of_work(pairs.last[lane], i.velocity() - j.velocity(), i.angular_velocity(), j.angular_velocity());
      }
    }
    for (std::uint32_t w = walls.chunk_begin[number]; w < walls.chunk_begin[number + 1]; ++w)
      for (std::uint32_t q = walls.chunk[w].begin; q < walls.chunk[w].end; ++q) {
        const WallCandidate& c = walls.candidate[q];
        const GrainRow& grain = in.grains[c.particle];
        for (std::size_t k = c.contact_begin; k < c.contact_begin + c.size && walls.activity[q].level <= in.due; ++k) {
          const LastForces& last = walls.last[k];
          if (walls.contact[k].acts()) chunk.ledger += half_of_work(last, grain.velocity(), grain.angular_velocity(), last.wall_spin);
        }
      }
  }
}

}  // namespace dem
