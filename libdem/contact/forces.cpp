#include "libdem/contact/forces.hpp"

#include <omp.h>

#include <array>

#include "libdem/errors.hpp"

namespace dem {
namespace {

// Below this many pairs waking other threads costs more than they save.
constexpr std::size_t few_pairs = 1000;

using Lanes = std::array<std::uint32_t, pack_width>;

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

// Constants that depend on the materials alone, for the contacts of one block; most blocks are of one pair of materials.
template <class Get>
PairConstants<Pack> gather_materials(bool one_pair, Get get) {
  const auto each = [&](auto member) {
    return one_pair ? Pack(get(0).*member) : gather([&](std::size_t k) { return get(k).*member; });
  };
  using C = PairConstants<double>;
  PairConstants<Pack> c;
  c.effective_modulus = each(&C::effective_modulus);
  c.effective_shear = each(&C::effective_shear);
  c.damping_ratio = each(&C::damping_ratio);
  c.friction = each(&C::friction);
  c.rolling_friction = each(&C::rolling_friction);
  c.rolling_damping = each(&C::rolling_damping);
  c.work_of_adhesion = each(&C::work_of_adhesion);
  return c;
}

// One block's parts of (1) in ledger.hpp. `get(k)` gives lane k's LastForces; lanes from `count` on book nothing. `v` are the velocities of i less those of j at the centres (of a wall: zero, its contact point's comes on top),
// `point_velocity` and `spin_j` those of a wall now.
template <class Law, class Get>
void book(const Law& law, const Touch<Pack>& touch, const PairConstants<Pack>& c, const ContactForce<Pack>& f,
          const Mask<Pack>& holds, const Mask<Pack>& touched, const Triple<Pack>& v, bool wall,
          const Triple<Pack>& wall_velocity, double dt, std::size_t count, Get get, LedgerSums& sums) {
  // The step before, with the velocities of now.
  const Triple<Pack> normal = gather_triple([&](std::size_t k) -> const Vec3& { return get(k).normal; });
  const Pack arm_i = gather([&](std::size_t k) { return get(k).arm_i; });
  const Pack arm_j = gather([&](std::size_t k) { return get(k).arm_j; });
  const Pack elastic = gather([&](std::size_t k) { return get(k).elastic; });
  const Pack damping = gather([&](std::size_t k) { return get(k).damping; });
  const Triple<Pack> spring = gather_triple([&](std::size_t k) -> const Vec3& { return get(k).tangential_elastic; });
  const Triple<Pack> viscous = gather_triple([&](std::size_t k) -> const Vec3& { return get(k).tangential_viscous; });
  const Triple<Pack> rolling_i = gather_triple([&](std::size_t k) -> const Vec3& { return get(k).rolling_i; });
  const Triple<Pack> rolling_j = gather_triple([&](std::size_t k) -> const Vec3& { return get(k).rolling_j; });
  const Pack normal_energy = gather([&](std::size_t k) { return get(k).normal_energy; });
  const Pack tangential_energy = gather([&](std::size_t k) { return get(k).tangential_energy; });
  const Pack rolling_energy = gather([&](std::size_t k) { return get(k).rolling_energy; });
  Triple<Pack> u = v + cross(touch.spin_i * arm_i + (wall ? nothing() : touch.spin_j * arm_j), normal);
  Triple<Pack> spin_j_before = touch.spin_j;
  if (wall) {
    u = u - gather_triple([&](std::size_t k) -> const Vec3& { return get(k).wall_velocity; });
    spin_j_before = gather_triple([&](std::size_t k) -> const Vec3& { return get(k).wall_spin; });
  }
  const Pack u_n = dot(u, normal), v_n = dot(touch.velocity, touch.normal), half = 0.5 * dt;

  // This step; nothing where the contact has ended.
  const Pack elastic_now = only(holds, f.normal.elastic), damping_now = only(holds, f.damping);
  const Triple<Pack> spring_now = only(holds, f.tangential.elastic), viscous_now = only(holds, f.tangential.viscous);
  const Triple<Pack> rolling_i_now = only(holds, f.rolling.on_i), rolling_j_now = only(holds, f.rolling.on_j);
  const Pack normal_now = only(holds, f.normal.energy), tangential_now = only(holds, f.tangential.energy),
             rolling_now = only(holds, f.rolling.energy);

  const Pack taken_normal = half * (elastic * u_n + elastic_now * v_n);
  const Pack taken_damping = half * (damping * u_n + damping_now * v_n);
  const Pack taken_spring = -half * (dot(spring, u) + dot(spring_now, touch.velocity));
  const Pack taken_viscous = -half * (dot(viscous, u) + dot(viscous_now, touch.velocity));
  const Pack taken_rolling = -half * (dot(rolling_i, touch.spin_i) + dot(rolling_j, spin_j_before) +
                                      dot(rolling_i_now, touch.spin_i) + dot(rolling_j_now, touch.spin_j));

  const auto [form, broken] = with_part<NormalLaws>(
      law.normal, [&](auto part) { return std::pair<Pack, Pack>(part.form_energy(c), part.break_energy(c)); });
  const Mask<Pack> formed = holds && !touched, ended = touched && !holds;
  const Pack springs_lost = only(ended, tangential_energy + rolling_energy);
  const Pack detachment = only(ended, broken) - only(formed, form) + springs_lost;
  const Pack stiffness = only(holds, f.tangential.stiffness_work), slip = only(holds, f.tangential.slip_work);
  const Pack rolled = taken_rolling - (rolling_now - rolling_energy) - only(ended, rolling_energy);
  const Pack stored = normal_now - normal_energy + tangential_now - tangential_energy + rolling_now - rolling_energy;
  const Pack time_stepping = taken_normal + taken_damping + taken_spring + taken_viscous + taken_rolling -
                             (stored + taken_damping + taken_viscous + slip + rolled + detachment - stiffness);
  // One contact after the other: how contacts fall into blocks depends on the list, their order does not.
  for (std::size_t k = 0; k < count; ++k)
    sums += {taken_damping[k], taken_viscous[k], slip[k],           rolled[k],
             detachment[k],    stiffness[k],     time_stepping[k]};

  const Pack surface_now = f.normal.surface_energy;
  for (std::size_t k = 0; k < count; ++k) {
    LastForces& last = get(k);
    if (!holds[k]) {
      last = LastForces{};
      continue;
    }
    last.normal = lane_of(touch.normal, k);
    last.arm_i = touch.arm_i[k];
    last.arm_j = touch.arm_j[k];
    last.elastic = elastic_now[k];
    last.damping = damping_now[k];
    last.tangential_elastic = lane_of(spring_now, k);
    last.tangential_viscous = lane_of(viscous_now, k);
    last.rolling_i = lane_of(rolling_i_now, k);
    last.rolling_j = lane_of(rolling_j_now, k);
    if (wall) {
      last.wall_velocity = lane_of(wall_velocity, k);
      last.wall_spin = lane_of(touch.spin_j, k);
    }
    last.normal_energy = normal_now[k];
    last.surface_energy = surface_now[k];
    last.tangential_energy = tangential_now[k];
    last.rolling_energy = rolling_now[k];
  }
}

// One block of pairs: gather, law, scatter. Lanes from `count` on repeat lane 0 and are not written back.
template <class Law, bool Keep>
void evaluate_pair_block(const Law& law, const ForceInput& in, PairContacts& pairs, const Lanes& slot, std::size_t count,
                         double& largest_overlap, LedgerSums& sums) {
  const Particles& p = in.particles;
  const auto i = [&](std::size_t k) { return pairs.list.first[slot[k]]; };
  const auto j = [&](std::size_t k) { return pairs.list.second[slot[k]]; };

  const Triple<Pack> branch = gather_triple([&](std::size_t k) -> const Vec3& { return p.position[j(k)]; }) -
                              gather_triple([&](std::size_t k) -> const Vec3& { return p.position[i(k)]; });
  const Pack radius_i = gather([&](std::size_t k) { return p.radius[i(k)]; });
  const Pack radius_j = gather([&](std::size_t k) { return p.radius[j(k)]; });
  const Pack distance = square_root(dot(branch, branch));
  const Pack inverse = 1.0 / distance;

  bool one_pair = true;
  for (std::size_t k = 1; k < pack_width; ++k) one_pair &= pairs.material_pair[slot[k]] == pairs.material_pair[slot[0]];
  PairConstants<Pack> c = gather_materials(
      one_pair, [&](std::size_t k) -> const auto& { return in.materials.pair[pairs.material_pair[slot[k]]]; });
  c.effective_radius = gather([&](std::size_t k) { return pairs.bodies[slot[k]].effective_radius; });
  c.effective_mass = gather([&](std::size_t k) { return pairs.bodies[slot[k]].effective_mass; });
  c.effective_inertia = gather([&](std::size_t k) { return pairs.bodies[slot[k]].effective_inertia; });
  c.adhesion_length = gather([&](std::size_t k) { return pairs.bodies[slot[k]].adhesion_length; });

  Touch<Pack> touch;
  touch.spin_i = gather_triple([&](std::size_t k) -> const Vec3& { return p.angular_velocity[i(k)]; });
  touch.spin_j = gather_triple([&](std::size_t k) -> const Vec3& { return p.angular_velocity[j(k)]; });
  // The contact point divides the branch in the ratio of the radii.
  const Pack share = distance / (radius_i + radius_j);
  touch.arm_i = radius_i * share;
  touch.arm_j = radius_j * share;
  touch.overlap = radius_i + radius_j - distance;
  touch.normal = branch * inverse;
  const Triple<Pack> centres = gather_triple([&](std::size_t k) -> const Vec3& { return p.velocity[i(k)]; }) -
                               gather_triple([&](std::size_t k) -> const Vec3& { return p.velocity[j(k)]; });
  touch.velocity = centres + cross(touch.spin_i * touch.arm_i + touch.spin_j * touch.arm_j, touch.normal);

  const Mask<Pack> touched = gather([&](std::size_t k) { return pairs.memory[slot[k]].touched ? 1.0 : 0.0; }) > Pack(0.5);
  const Mask<Pack> hold = holds(law, touch.overlap, touched, c);
  const bool rolling_spring = !pairs.rolling.empty();
  Springs<Pack> springs{
      gather_triple([&](std::size_t k) -> const Vec3& { return pairs.memory[slot[k]].spring; }),
      rolling_spring ? gather_triple([&](std::size_t k) -> const Vec3& { return pairs.rolling[slot[k]]; }) : nothing(),
      gather([&](std::size_t k) { return pairs.memory[slot[k]].contact_radius; })};
  const ContactForce<Pack> f = evaluate(law, touch, c, springs, Pack(in.dt));

  const Triple<Pack> tangential = f.tangential.elastic + f.tangential.viscous;
  const Triple<Pack> force = tangential - touch.normal * (f.normal.elastic + f.damping);
  const Triple<Pack> twist = cross(touch.normal, tangential);
  const Triple<Pack> torque_i = twist * touch.arm_i + f.rolling.on_i;
  const Triple<Pack> torque_j = twist * touch.arm_j + f.rolling.on_j;
  const Pack relative_overlap = touch.overlap / smaller(radius_i, radius_j);
  if constexpr (Keep)
    book(law, touch, c, f, hold, touched, centres, false, nothing(), in.dt, count,
         [&](std::size_t k) -> LastForces& { return pairs.last[slot[k]]; }, sums);
  for (std::size_t k = 0; k < count; ++k) {
    ContactMemory& memory = pairs.memory[slot[k]];
    PairForce& result = pairs.result[slot[k]];
    pairs.acts[slot[k]] = hold[k];
    if (hold[k]) {
      if (!memory.touched) memory.birth_step = in.step;
      memory.touched = true;
      memory.spring = lane_of(springs.tangential, k);
      memory.contact_radius = springs.contact_radius[k];
      if (rolling_spring) pairs.rolling[slot[k]] = lane_of(springs.rolling, k);
      result.force = lane_of(force, k);
      result.torque_i = lane_of(torque_i, k);
      result.torque_j = lane_of(torque_j, k);
      result.elastic = f.normal.elastic[k];
      result.damping = f.damping[k];
      result.sliding = f.tangential.sliding[k];
      largest_overlap = std::max(largest_overlap, double(relative_overlap[k]));
    } else {
      memory = ContactMemory{};
      if (rolling_spring) pairs.rolling[slot[k]].setZero();
    }
  }
}

template <class Law, bool Keep>
void evaluate_pair_chunk(const Law& law, const ForceInput& in, PairContacts& pairs, std::size_t number) {
  const Particles& p = in.particles;
  const std::size_t row = number * PairContacts::chunk_rows, last_row = std::min(row + PairContacts::chunk_rows, p.size());
  const std::size_t begin = pairs.list.begin[row], end = pairs.list.begin[last_row];
  Lanes slot{};
  std::size_t count = 0;
  double largest_overlap = 0;
  LedgerSums sums;
  const auto block = [&] { evaluate_pair_block<Law, Keep>(law, in, pairs, slot, count, largest_overlap, sums); };
  for (std::size_t s = begin; s < end; ++s) {
    const std::uint32_t i = pairs.list.first[s], j = pairs.list.second[s];
    const double reach = p.radius[i] + p.radius[j] + pairs.reach_beyond_touch;
    const bool candidate =
        pairs.memory[s].touched || (p.position[i] - p.position[j]).squaredNorm() < reach * reach;
    if (!candidate) {
      pairs.acts[s] = 0;
      continue;
    }
    slot[count++] = std::uint32_t(s);
    if (count == pack_width) {
      block();
      count = 0;
    }
  }
  if (count > 0) {
    for (std::size_t k = count; k < pack_width; ++k) slot[k] = slot[0];
    block();
  }
  pairs.chunk[number].largest_overlap = largest_overlap;
  if constexpr (Keep) pairs.chunk[number].ledger = sums;
}

// A contact that its wall no longer has: it broke, or its feature gave way to another while it was loaded and what it stored
// is lost.
template <class Law>
void book_end(const Law& law, const WallContact& contact, const PairConstants<double>& c, const Particles& p, std::uint32_t i,
              double dt, LedgerSums& sums) {
  const LastForces& last = contact.last;
  const Vec3 u = p.velocity[i] + (last.arm_i * p.angular_velocity[i]).cross(last.normal) - last.wall_velocity;
  const Vec3 force = last.tangential_elastic + last.tangential_viscous - (last.elastic + last.damping) * last.normal;
  const double taken =
      -0.5 * dt * (force.dot(u) + last.rolling_i.dot(p.angular_velocity[i]) + last.rolling_j.dot(last.wall_spin));
  const double expected_overlap = p.radius[i] - contact.touch.distance + dt * u.dot(last.normal);
  const auto [break_overlap, break_energy] = with_part<NormalLaws>(
      law.normal, [&](auto part) { return std::pair(part.break_overlap(c), part.break_energy(c)); });
  const bool broke = expected_overlap < break_overlap;
  const double detachment =
      (broke ? break_energy : last.normal_energy) + last.tangential_energy + last.rolling_energy;
  sums.detachment += detachment;
  sums.time_stepping += taken + last.energy().total() - detachment;
}

void take_over(WallContact& contact, const WallContact& from) {
  contact.memory = from.memory;
  contact.rolling = from.rolling;
  contact.last = from.last;
}

// Carries memory from the places a grain touched in the last step to those it touches now: first the same feature, then,
// where the grain rolled from one feature to its neighbour, the remaining place with the most similar normal. Calls
// ended(contact) for formed contacts that nothing inherits.
template <class Ended>
void inherit(WallCandidate& candidate, const std::vector<WallTouch>& touches, Ended ended) {
  const std::size_t old_size = candidate.size;
  if (old_size == 1 && touches.size() == 1 && candidate.contact[0].touch.feature == touches[0].feature) {
    candidate.contact[0].touch = touches[0];
    return;
  }
  std::array<WallContact, WallCandidate::capacity> old;
  std::copy_n(candidate.contact.begin(), old_size, old.begin());
  std::array<bool, WallCandidate::capacity> taken{};
  candidate.size = std::uint32_t(touches.size());
  for (std::size_t k = 0; k < touches.size(); ++k) {
    candidate.contact[k] = WallContact{};
    candidate.contact[k].touch = touches[k];
    for (std::size_t o = 0; o < old_size; ++o)
      if (!taken[o] && old[o].touch.feature == touches[k].feature) {
        take_over(candidate.contact[k], old[o]);
        taken[o] = true;
      }
  }
  for (std::size_t k = 0; k < touches.size(); ++k) {
    WallContact& contact = candidate.contact[k];
    if (contact.memory.touched) continue;
    std::size_t best = old_size;
    double similarity = 0.9;
    for (std::size_t o = 0; o < old_size; ++o) {
      const double cosine = old[o].touch.normal.dot(touches[k].normal);
      if (!taken[o] && old[o].memory.touched && cosine > similarity) {
        similarity = cosine;
        best = o;
      }
    }
    if (best < old_size) {
      take_over(contact, old[best]);
      taken[best] = true;
    }
  }
  for (std::size_t o = 0; o < old_size; ++o)
    if (!taken[o] && old[o].memory.touched) ended(old[o]);
}

PairConstants<double> constants_of(const ForceInput& in, const WallCandidate& candidate, const WallContact& contact) {
  return in.wall_curvature ? on_curved_wall(candidate.constants, contact.touch.curvature) : candidate.constants;
}

// m, the overlap below which no contact of the candidate can hold, however its wall is curved.
template <class Law>
double last_overlap(const Law& law, const ForceInput& in, const WallCandidate& candidate) {
  if (!in.wall_curvature) return last_overlap(law, candidate.constants);
  PairConstants<double> most = candidate.constants;
  most.effective_radius *= conforming;
  most.adhesion_length *= std::cbrt(conforming);
  return last_overlap(law, most);
}

struct WallSlot {
  WallCandidate* candidate;
  WallContact* contact;
};

template <class Law, bool Keep>
void evaluate_wall_block(const Law& law, const ForceInput& in, WallContacts& walls,
                         const std::array<WallSlot, pack_width>& slot, std::size_t count, WallContacts::Chunk& chunk,
                         LedgerSums& sums) {
  const Particles& p = in.particles;
  const WallPose& pose = in.poses[chunk.wall];
  const auto i = [&](std::size_t k) { return slot[k].candidate->particle; };

  PairConstants<Pack> c =
      gather_materials(false, [&](std::size_t k) -> const auto& { return slot[k].candidate->constants; });
  c.effective_radius = gather([&](std::size_t k) { return slot[k].candidate->constants.effective_radius; });
  c.effective_mass = gather([&](std::size_t k) { return slot[k].candidate->constants.effective_mass; });
  c.effective_inertia = gather([&](std::size_t k) { return slot[k].candidate->constants.effective_inertia; });
  c.adhesion_length = gather([&](std::size_t k) { return slot[k].candidate->constants.adhesion_length; });
  if (in.wall_curvature)
    for (std::size_t k = 0; k < pack_width; ++k) {
      const PairConstants<double> curved = constants_of(in, *slot[k].candidate, *slot[k].contact);
      c.effective_radius[k] = curved.effective_radius;
      c.adhesion_length[k] = curved.adhesion_length;
    }

  const Pack radius = gather([&](std::size_t k) { return p.radius[i(k)]; });
  Touch<Pack> touch;
  touch.spin_i = gather_triple([&](std::size_t k) -> const Vec3& { return p.angular_velocity[i(k)]; });
  touch.spin_j = all_lanes(pose.angular_velocity);
  touch.arm_i = radius;
  touch.arm_j = 0.0;
  touch.overlap = radius - gather([&](std::size_t k) { return slot[k].contact->touch.distance; });
  touch.normal = gather_triple([&](std::size_t k) -> const Vec3& { return slot[k].contact->touch.normal; });
  const Triple<Pack> arm = touch.normal * radius;
  const Triple<Pack> position = gather_triple([&](std::size_t k) -> const Vec3& { return p.position[i(k)]; });
  const Triple<Pack> velocity = gather_triple([&](std::size_t k) -> const Vec3& { return p.velocity[i(k)]; });
  const Triple<Pack> wall_velocity =
      all_lanes(pose.velocity) + cross(touch.spin_j, position + arm - all_lanes(pose.position));
  touch.velocity = velocity + cross(touch.spin_i, arm) - wall_velocity;

  const Mask<Pack> touched = gather([&](std::size_t k) { return slot[k].contact->memory.touched ? 1.0 : 0.0; }) > Pack(0.5);
  const Mask<Pack> hold = holds(law, touch.overlap, touched, c);
  Springs<Pack> springs{gather_triple([&](std::size_t k) -> const Vec3& { return slot[k].contact->memory.spring; }),
                        gather_triple([&](std::size_t k) -> const Vec3& { return slot[k].contact->rolling; }),
                        gather([&](std::size_t k) { return slot[k].contact->memory.contact_radius; })};
  const ContactForce<Pack> f = evaluate(law, touch, c, springs, Pack(in.dt));
  const Triple<Pack> tangential = f.tangential.elastic + f.tangential.viscous;
  const Triple<Pack> force = tangential - touch.normal * (f.normal.elastic + f.damping);
  const Triple<Pack> torque = cross(arm, tangential) + f.rolling.on_i;
  if constexpr (Keep)
    book(law, touch, c, f, hold, touched, velocity, true, wall_velocity, in.dt, count,
         [&](std::size_t k) -> LastForces& { return slot[k].contact->last; }, sums);

  for (std::size_t k = 0; k < count; ++k) {
    WallContact& contact = *slot[k].contact;
    contact.acts = hold[k];
    if (!hold[k]) {
      contact.memory = ContactMemory{};
      contact.rolling.setZero();
      continue;
    }
    ++walls.acts[slot[k].candidate - walls.candidate.data()];
    if (!contact.memory.touched) contact.memory.birth_step = in.step;
    contact.memory.touched = true;
    contact.memory.spring = lane_of(springs.tangential, k);
    contact.memory.contact_radius = springs.contact_radius[k];
    contact.rolling = lane_of(springs.rolling, k);
    contact.force = lane_of(force, k);
    contact.torque = lane_of(torque, k);
    contact.tangential = lane_of(tangential, k);
    contact.elastic = f.normal.elastic[k];
    contact.damping = f.damping[k];
    contact.sliding = f.tangential.sliding[k];
    const Vec3 lever = p.position[i(k)] + p.radius[i(k)] * contact.touch.normal - pose.position;
    const WallLoad load{-contact.force, lane_of(f.rolling.on_j, k) - lever.cross(contact.force)};
    chunk.load += load;
    if (const auto* mesh = std::get_if<MeshWall>(&in.walls[chunk.wall].shape))
      chunk.load_of_label[std::size_t(mesh->finder->mesh().labels[contact.touch.facet])] += load;
    chunk.largest_overlap = std::max(chunk.largest_overlap, touch.overlap[k] / p.radius[i(k)]);
  }
}

template <class Law, bool Keep>
void evaluate_wall_chunk(const Law& law, const ForceInput& in, WallContacts& walls, WallContacts::Chunk& chunk) {
  std::vector<WallTouch>& touches = chunk.touches;
  const Particles& p = in.particles;
  const Wall& wall = in.walls[chunk.wall];
  const WallPose& pose = in.poses[chunk.wall];
  std::array<WallSlot, pack_width> slot{};
  std::size_t count = 0;
  LedgerSums sums;
  chunk.load = WallLoad{};
  chunk.load_of_label.fill(WallLoad{});
  chunk.largest_overlap = 0;
  chunk.ledger = LedgerSums{};
  const auto block = [&] { evaluate_wall_block<Law, Keep>(law, in, walls, slot, count, chunk, sums); };
  for (std::uint32_t q = chunk.begin; q < chunk.end; ++q) {
    WallCandidate& candidate = walls.candidate[q];
    const double radius = p.radius[candidate.particle];
    nearest(wall, pose, p.position[candidate.particle], radius - last_overlap(law, in, candidate),
            std::span(walls.parts).subspan(candidate.part_begin, candidate.part_end - candidate.part_begin),
            touches, chunk.scratch);
    if (touches.empty() && candidate.size == 0) continue;  // acts is 0 already
    if (touches.size() > WallCandidate::capacity) {
      chunk.overflow = true;
      touches.resize(WallCandidate::capacity);
    }
    inherit(candidate, touches, [&](const WallContact& ended) {
      if constexpr (Keep)
        book_end(law, ended, constants_of(in, candidate, ended), p, candidate.particle, in.dt, chunk.ledger);
    });
    walls.acts[q] = 0;
    for (std::size_t t = 0; t < candidate.size; ++t) {
      slot[count++] = {&candidate, &candidate.contact[t]};
      candidate.contact[t].acts = false;
      if (count == pack_width) {
        block();
        count = 0;
      }
    }
  }
  if (count > 0) {
    for (std::size_t k = count; k < pack_width; ++k) slot[k] = slot[0];
    block();
  }
  if constexpr (Keep) chunk.ledger += sums;
}

template <class Law, bool Keep>
double evaluate_all(const Law& law, const ForceInput& in, PairContacts& pairs, WallContacts& walls) {
#pragma omp parallel if (pairs.list.size() > few_pairs)
  {
#pragma omp for schedule(dynamic, 1) nowait
    for (std::size_t k = 0; k < walls.chunk.size(); ++k) evaluate_wall_chunk<Law, Keep>(law, in, walls, walls.chunk[k]);
#pragma omp for schedule(static)
    for (std::size_t k = 0; k < pairs.chunk.size(); ++k) evaluate_pair_chunk<Law, Keep>(law, in, pairs, k);
  }
  double largest_overlap = 0;
  for (const PairContacts::Chunk& chunk : pairs.chunk) largest_overlap = std::max(largest_overlap, chunk.largest_overlap);
  for (const WallContacts::Chunk& chunk : walls.chunk) {
    largest_overlap = std::max(largest_overlap, chunk.largest_overlap);
    if (chunk.overflow)
      throw PhysicsError("a grain touches wall '" + in.walls[chunk.wall].name + "' in more than " +
                         std::to_string(WallCandidate::capacity) +
                         " places; its mesh has details much smaller than the grains");
  }
  return largest_overlap;
}

template <class Law>
double evaluate_all(const Law& law, bool keep_ledger, const ForceInput& in, PairContacts& pairs, WallContacts& walls) {
  return keep_ledger ? evaluate_all<Law, true>(law, in, pairs, walls) : evaluate_all<Law, false>(law, in, pairs, walls);
}

}  // namespace

double evaluate_contacts(const LawChoice& law, bool keep_ledger, const ForceInput& in, PairContacts& pairs, WallContacts& walls) {
  double overlap = 0;
  const bool compiled = [&]<class... Fixed>(std::type_identity<std::tuple<Fixed...>>) {
    return ((law == choice_of<Fixed>() && (overlap = evaluate_all(Fixed{}, keep_ledger, in, pairs, walls), true)) || ...);
  }(std::type_identity<FixedLaws>{});
  return compiled ? overlap : evaluate_all(law, keep_ledger, in, pairs, walls);
}

}  // namespace dem
