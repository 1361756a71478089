// Contacts of pairs of grains, a block at a time: which are due, their touch, law, impulses and next level.
#pragma once
#include <bit>
#include <limits>
#include <optional>

#include "libdem/contact/due_list.hpp"
#include "libdem/contact/kernel.hpp"
#include "libdem/particles/ask_memory.hpp"

namespace dem::kernel {

// `finest`: level of the finest of a block's grains.
inline void choose_level(const ForceInput& in, std::uint8_t finest, const LevelScale& scale, Activity& activity, const Demand& demand) {
  const std::uint8_t cap = std::uint8_t(std::min<int>(in.highest, finest + levels_above));
  activity.level = next_level(activity.level, in.due, cap, scale, demand);
}

// m/s, by how much the speed at which the bodies of a lane near each other may change until all levels are due again.
inline double jolt_of(const ForceInput& in, const Block& block, bool crosses) {
  double jolt = in.jolt[in.chunks.of(block.first[0])];
  if (!crosses) return jolt;
  for (std::size_t k = 0; k < PairContacts::width; ++k)
    if (block.second[k] < in.level.size()) jolt = std::max(jolt, in.jolt[in.chunks.of(block.second[k])]);
  return jolt;
}

// s, until all levels are due again if they are due now.
inline double longest_stride(const ForceInput& in) { return in.step_length * stride(in.highest); }

// What lanes demand; those that are apart and stay so until all levels are due again demand nothing.
inline void add_demand(const ForceInput& in, const LevelScale& scale, double jolt, const Pack& gap, const Pack& radius, const Pack& speed,
                Demand& demand) {
  const Pack soon = only(gap < (speed + Pack(jolt)) * Pack(longest_stride(in)), speed);
  demand.radius = std::max(demand.radius, double(std::experimental::hmax(radius)));
  demand.speed = std::max(demand.speed, double(std::experimental::hmax(soon)));
  demand.impact = std::max(demand.impact, double(std::experimental::hmax(only(drives_deeper(scale, radius, soon), soon))));
}

// The second grains of blocks that cross to other chunks hear of it in add_crossing().
inline void ask(const Block& block, std::uint8_t level, bool crosses, const ChunkOutput& out) {
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
JAMSCOPE_FLATTEN static Approach look_at(const Law& law, const ForceInput& in, const PairContacts& pairs, std::size_t number, bool crosses) {
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
[[gnu::noinline]] inline void record(PairContacts::Chunk& chunk, std::size_t first_lane, Mask<Pack> hold, Mask<Pack> sliding, Triple<Pack> tangential,
                              Pack elastic, Pack damping) {
  for (std::size_t k = 0; k < pack_width; ++k)
    if (hold[k])
      chunk.recorded.push_back({std::uint32_t(first_lane + k), sliding[k], lane_of(tangential, k), elastic[k], damping[k]});
}

// Lanes of a block that touch like this: law, impulses of so many steps added to the grains. Lanes without a contact, phantoms
// among them, add nothing. Says whether one has a contact.
template <class Law, bool Keep>
static bool evaluate_lanes(const Law& law, const ForceInput& in, PairContacts& pairs, std::size_t number, std::size_t lane,
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
  const ContactForce<Pack> f = evaluate(law, touch, c, springs, Interval<Pack>(advance, 1 / advance, 1 / advance_of(in, 0)));

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
inline constexpr std::uint32_t blocks_ahead = 6, grains_ahead = 2;

inline void ask_for_second_grains(const ForceInput& in, const Block& block) {
  for (std::size_t k = 0; k < PairContacts::width; ++k) ask_memory_for(in.grains[block.second[k]]);
}

// A block: level, law, impulses. Says by its activity whether one of its lanes is a contact. One that has just woken acts from now on,
// not since it was looked at last.
template <class Law, bool Keep>
JAMSCOPE_FLATTEN static void evaluate_block(const Law& law, const ForceInput& in, PairContacts& pairs, std::size_t number, bool woken,
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
static void evaluate_pair_chunk(const Law& law, const ForceInput& in, PairContacts& pairs, std::size_t number, std::optional<std::uint32_t> next,
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

// What pairs of other chunks do to the grains of this one.
inline void add_crossing(const PairContacts& pairs, const RowChunks& chunks, std::size_t chunk, std::uint8_t due, ForceSheet& sheet, std::vector<std::uint8_t>& asked) {
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

}  // namespace dem::kernel
