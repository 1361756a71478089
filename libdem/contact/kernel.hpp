// What the kernels of pairs and of walls share: packs of lanes, constants, the ledger of a block, what is due. Templates of the kernels are
// static, as the compiler inlines what it sees to have one caller only (1.01 times the steps).
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "libdem/contact/forces.hpp"
#include "libdem/contact/rows.hpp"

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

namespace dem::kernel {

using Block = PairContacts::Block;

// What rounding may add to a sum of movements: blocks are looked at a little before they must be.
inline constexpr double cautious = 0.999;

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

// Each constant of a table, the members `to` of the lanes and `from` of one contact, is get(the latter, its number in the table). Members are
// constants of the compiler, and written out: it sees through a table and unrolls a loop too late to keep packs out of memory.
template <const auto& to, const auto& from, class Get>
inline void fill(PairConstants<Pack>& c, Get get) {
  const auto fill_one = [&]<std::size_t M>(std::integral_constant<std::size_t, M>) {
    constexpr auto lanes = to[M];
    constexpr auto one = from[M];
    c.*lanes = get(std::integral_constant<decltype(one), one>{}, M);
  };
  [&]<std::size_t... M>(std::index_sequence<M...>) {
    (fill_one(std::integral_constant<std::size_t, M>{}), ...);
  }(std::make_index_sequence<to.size()>{});
}
template <class Get>
inline void fill_materials(PairConstants<Pack>& c, Get get) {
  fill<material_constants<Pack>, material_constants<double>>(c, get);
}
template <class Get>
inline void fill_contacts(PairConstants<Pack>& c, Get get) {
  fill<contact_constants<Pack>, contact_constants<double>>(c, get);
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

inline bool levels_in_use(const ForceInput& in) { return in.highest > 0; }
inline bool all_due(const ForceInput& in) { return in.due == in.highest; }

// What is looked at is due from this level on, or a lower one.
inline std::uint8_t due_from_at(const ForceInput& in) { return all_due(in) ? Activity::when_all_are_due : in.due; }

inline std::uint32_t steps_since_all_due(const ForceInput& in) { return std::uint32_t(in.step & ((std::uint64_t{1} << in.highest) - 1)); }

// For what is apart and awake: whether no contact forms before this step, and Activity::quiet_until if none does for so many seconds.
inline bool quiet(const ForceInput& in, const Activity& activity) { return !all_due(in) && steps_since_all_due(in) < activity.quiet_until; }
inline std::uint32_t quiet_until(const ForceInput& in, double earliest) {
  return std::uint32_t(std::min(steps_since_all_due(in) + cautious * earliest / in.step_length, stride(in.highest)));
}

// s, by how much springs advance in a contact of this level.
inline double advance_of(const ForceInput& in, std::uint8_t level) { return in.look ? 0 : in.step_length * stride(level); }

// In steps, from the middle of the time since the last evaluation to the middle of the time until the next: what a force's
// impulse is long.
inline double impulse_steps(std::uint8_t before, std::uint8_t now) { return 0.5 * (stride(before) + stride(now)); }

// A contact is evaluated at least at every second movement of its grains (late() could not tell how they moved in longer). So is a pair that
// is apart, which has only the motion of the two to foresee its impact by.
inline constexpr std::uint8_t levels_above = 1;

// A grain that moves while one of its contacts waits goes to and fro: the contacts that are evaluated more often push it, and the one that
// waits pushes it back at once when it is due, always at the end of the same way. With the velocity that it has then, a tangential spring
// would be stretched by something that has not happened, steps after steps in the same direction: grains in a jam would creep and
// drive the blade. What has happened since is the mean velocity: of a grain that has moved twice, that of the second movement less half
// of what changed it. `late` of a contact that has waited for so many steps: 0 where the grain has moved once since, 1 where twice or more.
inline Pack late(const Pack& steps, const Pack& per_stride) {
  return smaller(larger(steps * per_stride - Pack(1.0), Pack(0.0)), Pack(1.0));
}

}  // namespace dem::kernel
