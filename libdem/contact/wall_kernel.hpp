// Contacts of grains with walls: where they touch, which contact goes on, and as many as a pack holds through the law at a time.
#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "libdem/contact/due_list.hpp"
#include "libdem/contact/kernel.hpp"
#include "libdem/particles/ask_memory.hpp"

namespace dem::kernel {

// A contact that its wall no longer has: it broke, or its feature gave way to another while it was loaded and what it stored
// is lost. `advance`, s, is the time since its last evaluation.
template <class Law>
static void book_end(const Law& law, const WallContact& contact, const LastForces& last, const PairConstants<double>& c,
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
static void inherit(WallContacts& walls, WallCandidate& candidate, const std::vector<WallTouch>& touches, Ended ended) {
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

inline PairConstants<double> constants_of(const ForceInput& in, const WallCandidate& candidate, const WallContact& contact) {
  PairConstants<double> c = in.materials.pair[candidate.material_pair];
  for (std::size_t m = 0; m < constants_per_contact; ++m) c.*contact_constants<double>[m] = candidate.constant[m];
  set_effective_radius(c, in.grains[candidate.particle].radius(), c.cube_root, 1 / c.cube_root);
  return in.wall_curvature ? on_curved_wall(c, contact.touch.curvature) : c;
}

// What the grain may touch now, of its candidate parts within `reach`: chosen anew when it may have come nearer by a margin, as few of the
// many triangles around a grain of a finely meshed wall can be the next that it touches.
inline std::span<const std::uint32_t> parts_near(const ForceInput& in, WallContacts& walls, WallCandidate& candidate, const GrainRow& grain,
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
JAMSCOPE_FLATTEN static void evaluate_wall_block(const Law& law, const ForceInput& in, const std::array<WallSlot, pack_width>& slot,
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
  const Pack advance = gather([&](std::size_t k) { return slot[k].advance; });
  const ContactForce<Pack> f = evaluate(law, touch, c, springs, Interval<Pack>(advance, Pack(1.0 / advance), Pack(1 / advance_of(in, 0))));
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
inline double normal_speed(const GrainRow& grain, const WallPose& pose, const WallTouch& touch, double steps) {
  const Vec3 lever = grain.position() + grain.radius() * touch.normal - pose.position;
  const double behind = std::clamp(steps * grain.arrival[3] - 1, 0.0, 1.0);
  const Vec3 velocity = (1 + behind) * grain.velocity() - behind * grain.arrival.head<3>();
  return std::abs((velocity - pose.velocity - pose.angular_velocity.cross(lever)).dot(touch.normal));
}

inline void ask(const WallCandidate& candidate, std::uint8_t level, const ChunkOutput& out) {
  std::uint8_t& asked = out.asked[candidate.particle];
  asked = std::min(asked, level);
}

inline void choose_level(const ForceInput& in, const WallCandidate& candidate, Activity& activity, const Demand& demand, const ChunkOutput& out) {
  const std::uint8_t cap = std::uint8_t(std::min<int>(in.highest, in.level[candidate.particle] + levels_above));
  activity.level = next_level(activity.level, in.due, cap, candidate.scale, demand);
  ask(candidate, activity.level, out);
}

inline Demand demand_of(const WallContacts& walls, const WallCandidate& candidate, const GrainRow& grain, const WallPose& pose, double steps) {
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
static void evaluate_wall_chunk(const Law& law, const ForceInput& in, WallContacts& walls, WallContacts::Chunk& chunk,
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

}  // namespace dem::kernel
