#include "libdem/contact/forces.hpp"

#include <algorithm>
#include <array>

#include "libdem/contact/rows.hpp"
#include "libdem/errors.hpp"

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

// Constants that depend on the materials alone.
template <class Get>
PairConstants<Pack> each_material(Get get) {
  const auto each = [&](auto member) { return get(member); };
  using C = PairConstants<double>;
  PairConstants<Pack> c;
  c.effective_modulus = each(&C::effective_modulus);
  c.effective_shear = each(&C::effective_shear);
  c.normal_damping = each(&C::normal_damping);
  c.tangential_damping = each(&C::tangential_damping);
  c.friction = each(&C::friction);
  c.rolling_friction = each(&C::rolling_friction);
  c.rolling_damping = each(&C::rolling_damping);
  c.work_of_adhesion = each(&C::work_of_adhesion);
  return c;
}
PairConstants<Pack> all_lanes(const PairConstants<double>& materials) {
  return each_material([&](auto member) { return Pack(materials.*member); });
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

// m, the smallest gap that the lanes of a block still have to close before a contact forms; < 0 where one forms now.
template <class Law>
JAMSCOPE_FLATTEN double smallest_gap(const Law& law, const ForceInput& in, const PairContacts& pairs, std::size_t number) {
  const Block& block = pairs.block[number];
  PairConstants<Pack> c = all_lanes(in.materials.pair[pairs.head[number].material_pair]);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t lane = 0; lane < PairContacts::width; lane += pack_width) {
    const auto i = load_quads([&](std::size_t k) { return in.grains[block.first[lane + k]].place.data(); });
    const auto j = load_quads([&](std::size_t k) { return in.grains[block.second[lane + k]].place.data(); });
    const Triple<Pack> branch{j[0] - i[0], j[1] - i[1], j[2] - i[2]};
    c.effective_radius = load(block.effective_radius, lane);
    c.adhesion_length = load(block.adhesion_length, lane);
    const Pack form = with_part<NormalLaws>(law.normal, [&](auto part) -> Pack { return part.form_overlap(c); });
    least = std::min(least, double(std::experimental::hmin(square_root(dot(branch, branch)) - i[3] - j[3] + form)));
  }
  return least;
}

// Lanes of a block, as many as a pack holds: load, law, add to the grains. Lanes without a contact, phantoms among them, add
// nothing. Says whether one has a contact.
template <class Law, bool Keep>
JAMSCOPE_FLATTEN bool evaluate_lanes(const Law& law, const ForceInput& in, PairContacts& pairs, std::size_t number, std::size_t lane, bool crosses,
                    std::vector<ForceRow>& forces, Pack& largest_overlap, LedgerSums& sums) {
  Block& block = pairs.block[number];
  const auto i = [&](std::size_t k) -> const GrainRow& { return in.grains[block.first[lane + k]]; };
  const auto j = [&](std::size_t k) -> const GrainRow& { return in.grains[block.second[lane + k]]; };
  const auto [x_i, y_i, z_i, radius_i] = load_quads([&](std::size_t k) { return i(k).place.data(); });
  const auto [x_j, y_j, z_j, radius_j] = load_quads([&](std::size_t k) { return j(k).place.data(); });
  const auto [vx_i, vy_i, vz_i, inverse_i] = load_quads([&](std::size_t k) { return i(k).motion.data(); });
  const auto [vx_j, vy_j, vz_j, inverse_j] = load_quads([&](std::size_t k) { return j(k).motion.data(); });
  const auto spin_i = load_quads([&](std::size_t k) { return i(k).spin.data(); });
  const auto spin_j = load_quads([&](std::size_t k) { return j(k).spin.data(); });

  PairConstants<Pack> c = all_lanes(in.materials.pair[pairs.head[number].material_pair]);
  c.effective_radius = load(block.effective_radius, lane);
  c.effective_mass = load(block.effective_mass, lane);
  c.effective_inertia = load(block.effective_inertia, lane);
  c.adhesion_length = load(block.adhesion_length, lane);

  const Triple<Pack> branch{x_j - x_i, y_j - y_i, z_j - z_i};
  const Pack distance = square_root(dot(branch, branch));
  Touch<Pack> touch;
  touch.spin_i = {spin_i[0], spin_i[1], spin_i[2]};
  touch.spin_j = {spin_j[0], spin_j[1], spin_j[2]};
  // The contact point divides the branch in the ratio of the radii: R_i/(R_i + R_j) = R*/R_j.
  const Pack share = distance * c.effective_radius;
  touch.arm_i = share * inverse_j;
  touch.arm_j = share * inverse_i;
  touch.overlap = radius_i + radius_j - distance;
  touch.normal = branch * Pack(1.0 / distance);
  const Triple<Pack> centres{vx_i - vx_j, vy_i - vy_j, vz_i - vz_j};
  touch.velocity = centres + cross(touch.spin_i * touch.arm_i + touch.spin_j * touch.arm_j, touch.normal);

  Springs<Pack> springs{load(block.spring, lane), nothing(), load(block.contact_radius, lane)};
  const bool rolling_spring = !pairs.rolling.empty();
  if (rolling_spring) springs.rolling = load(pairs.rolling[number].torque, lane);
  const Mask<Pack> touched = springs.contact_radius > Pack(0.0);
  const Mask<Pack> hold = holds(law, touch.overlap, touched, c);
  const ContactForce<Pack> f = evaluate(law, touch, c, springs, Pack(in.dt));

  store(only(hold, springs.tangential), block.spring, lane);
  store(only(hold, springs.contact_radius), block.contact_radius, lane);
  if (rolling_spring) store(only(hold, springs.rolling), pairs.rolling[number].torque, lane);
  const std::size_t first_lane = PairContacts::width * number + lane;
  const Mask<Pack> formed = hold && !touched;
  if (any_of(formed))
    for (std::size_t k = 0; k < pack_width; ++k)
      if (formed[k]) pairs.birth_step[first_lane + k] = in.step;

  const Triple<Pack> tangential = f.tangential.elastic + f.tangential.viscous;
  const Pack pushed = f.normal.elastic + f.damping;
  const Triple<Pack> force = only(hold, tangential - touch.normal * pushed);
  const Triple<Pack> twist = cross(touch.normal, tangential);
  const Triple<Pack> torque_i = only(hold, twist * touch.arm_i + f.rolling.on_i);
  const Triple<Pack> torque_j = only(hold, twist * touch.arm_j + f.rolling.on_j);
  const Pack pressed = only(hold, larger(pushed, Pack(0.0))), zero(0.0);
  largest_overlap = larger(largest_overlap, only(hold, touch.overlap * larger(inverse_i, inverse_j)));
  for_each_row({force.x, force.y, force.z, pressed, torque_i.x, torque_i.y, torque_i.z, zero},
               [&](std::size_t k, const auto& row) { add_row(forces[block.first[lane + k]], row); });
  const std::array<Pack, 8> opposite{-force.x, -force.y, -force.z, pressed, torque_j.x, torque_j.y, torque_j.z, zero};
  if (crosses) {
    ForceRow* const out = &pairs.crossing[pairs.head[number].crossing + lane];
    for_each_row(opposite, [&](std::size_t k, const auto& row) { store_row(out[k], row); });
  } else {
    for_each_row(opposite, [&](std::size_t k, const auto& row) { add_row(forces[block.second[lane + k]], row); });
  }

  if constexpr (Keep)
    book(law, touch, c, f, hold, touched, centres, false, nothing(), in.dt, pack_width,
         [&](std::size_t k) -> LastForces& { return pairs.last[first_lane + k]; }, sums);
  if (in.record)
    for (std::size_t k = 0; k < pack_width; ++k)
      if (hold[k])
        pairs.result[first_lane + k] = {lane_of(tangential, k), f.normal.elastic[k], f.damping[k], f.tangential.sliding[k]};
  return any_of(hold);
}

template <class Law, bool Keep>
void evaluate_pair_chunk(const Law& law, const ForceInput& in, PairContacts& pairs, std::size_t number,
                         std::vector<ForceRow>& forces) {
  PairContacts::Chunk& chunk = pairs.chunk[number];
  Pack largest_overlap = 0.0;
  LedgerSums sums;
  for (std::uint32_t b = chunk.begin; b < chunk.end; ++b) {
    PairContacts::Head& head = pairs.head[b];
    if (!head.acts) {
      if (in.odometer < head.wake) continue;
      const double gap = smallest_gap(law, in, pairs, b);
      if (gap >= 0) {
        head.wake = in.odometer + cautious * gap;
        continue;
      }
    }
    head.acts = false;
    for (std::size_t lane = 0; lane < PairContacts::width; lane += pack_width)
      head.acts |= evaluate_lanes<Law, Keep>(law, in, pairs, b, lane, b >= chunk.inner_end, forces, largest_overlap, sums);
    head.wake = in.odometer;
  }
  chunk.largest_overlap = std::experimental::hmax(largest_overlap);
  chunk.ledger = sums;
}

// A contact that its wall no longer has: it broke, or its feature gave way to another while it was loaded and what it stored
// is lost.
template <class Law>
void book_end(const Law& law, const WallContact& contact, const PairConstants<double>& c, const GrainRow& grain, double dt,
              LedgerSums& sums) {
  const LastForces& last = contact.last;
  const Vec3 spin = grain.angular_velocity();
  const Vec3 u = grain.velocity() + (last.arm_i * spin).cross(last.normal) - last.wall_velocity;
  const Vec3 force = last.tangential_elastic + last.tangential_viscous - (last.elastic + last.damping) * last.normal;
  const double taken =
      -0.5 * dt * (force.dot(u) + last.rolling_i.dot(spin) + last.rolling_j.dot(last.wall_spin));
  const double expected_overlap = grain.radius() - contact.touch.distance + dt * u.dot(last.normal);
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
    if (contact.acts()) continue;
    std::size_t best = old_size;
    double similarity = 0.9;
    for (std::size_t o = 0; o < old_size; ++o) {
      const double cosine = old[o].touch.normal.dot(touches[k].normal);
      if (!taken[o] && old[o].acts() && cosine > similarity) {
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
    if (!taken[o] && old[o].acts()) ended(old[o]);
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
JAMSCOPE_FLATTEN void evaluate_wall_block(const Law& law, const ForceInput& in, const std::array<WallSlot, pack_width>& slot, std::size_t count,
                         WallContacts::Chunk& chunk, std::vector<ForceRow>& forces, LedgerSums& sums) {
  const WallPose& pose = in.poses[chunk.wall];
  const auto grain = [&](std::size_t k) -> const GrainRow& { return in.grains[slot[k].candidate->particle]; };

  PairConstants<Pack> c =
      each_material([&](auto member) { return gather([&](std::size_t k) { return slot[k].candidate->constants.*member; }); });
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

  const auto [x, y, z, radius] = load_quads([&](std::size_t k) { return grain(k).place.data(); });
  const auto [v_x, v_y, v_z, inverse_radius] = load_quads([&](std::size_t k) { return grain(k).motion.data(); });
  const auto spin = load_quads([&](std::size_t k) { return grain(k).spin.data(); });
  Touch<Pack> touch;
  touch.spin_i = {spin[0], spin[1], spin[2]};
  touch.spin_j = all_lanes(pose.angular_velocity);
  touch.arm_i = radius;
  touch.arm_j = 0.0;
  touch.overlap = radius - gather([&](std::size_t k) { return slot[k].contact->touch.distance; });
  touch.normal = gather_triple([&](std::size_t k) -> const Vec3& { return slot[k].contact->touch.normal; });
  const Triple<Pack> arm = touch.normal * radius;
  const Triple<Pack> lever = Triple<Pack>{x, y, z} + arm - all_lanes(pose.position);
  const Triple<Pack> velocity{v_x, v_y, v_z};
  const Triple<Pack> wall_velocity = all_lanes(pose.velocity) + cross(touch.spin_j, lever);
  touch.velocity = velocity + cross(touch.spin_i, arm) - wall_velocity;

  Springs<Pack> springs{gather_triple([&](std::size_t k) -> const Vec3& { return slot[k].contact->memory.spring; }),
                        gather_triple([&](std::size_t k) -> const Vec3& { return slot[k].contact->rolling; }),
                        gather([&](std::size_t k) { return slot[k].contact->memory.contact_radius; })};
  const Mask<Pack> touched = springs.contact_radius > Pack(0.0);
  const Mask<Pack> hold = holds(law, touch.overlap, touched, c);
  const ContactForce<Pack> f = evaluate(law, touch, c, springs, Pack(in.dt));
  const Triple<Pack> tangential = f.tangential.elastic + f.tangential.viscous;
  const Pack pushed = f.normal.elastic + f.damping;
  const Triple<Pack> force = tangential - touch.normal * pushed;
  const Triple<Pack> torque = cross(arm, tangential) + f.rolling.on_i;
  const Triple<Pack> torque_on_wall = f.rolling.on_j - cross(lever, force);
  if constexpr (Keep)
    book(law, touch, c, f, hold, touched, velocity, true, wall_velocity, in.dt, count,
         [&](std::size_t k) -> LastForces& { return slot[k].contact->last; }, sums);

  for (std::size_t k = 0; k < count; ++k) {
    WallContact& contact = *slot[k].contact;
    if (!hold[k]) {
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
    const Vec3 on_grain = lane_of(force, k);
    ForceRow& row = forces[slot[k].candidate->particle];
    row.force += quad(on_grain, std::max(double(pushed[k]), 0.0));
    row.torque += quad(lane_of(torque, k), 0);
    const WallLoad load{-on_grain, lane_of(torque_on_wall, k)};
    chunk.load += load;
    if (const auto* mesh = std::get_if<MeshWall>(&in.walls[chunk.wall].shape))
      chunk.load_of_label[std::size_t(mesh->finder->mesh().labels[contact.touch.facet])] += load;
    chunk.largest_overlap = std::max(chunk.largest_overlap, touch.overlap[k] * inverse_radius[k]);
  }
}

template <class Law, bool Keep>
void evaluate_wall_chunk(const Law& law, const ForceInput& in, WallContacts& walls, WallContacts::Chunk& chunk,
                         std::vector<ForceRow>& forces) {
  std::vector<WallTouch>& touches = chunk.touches;
  const Wall& wall = in.walls[chunk.wall];
  const WallPose& pose = in.poses[chunk.wall];
  std::array<WallSlot, pack_width> slot{};
  std::size_t count = 0;
  LedgerSums sums;
  chunk.load = WallLoad{};
  chunk.load_of_label.fill(WallLoad{});
  chunk.largest_overlap = 0;
  chunk.ledger = LedgerSums{};
  const auto block = [&] { evaluate_wall_block<Law, Keep>(law, in, slot, count, chunk, forces, sums); };
  for (std::uint32_t q = chunk.begin; q < chunk.end; ++q) {
    WallCandidate& candidate = walls.candidate[q];
    const bool away = candidate.size == 0;
    if (away && in.odometer < candidate.wake) continue;
    const GrainRow& grain = in.grains[candidate.particle];
    // Where nothing is near, look as far as the list does, to know for how long.
    const double reach = grain.radius() - last_overlap(law, in, candidate);
    const double sight = away ? std::max(grain.radius() + walls.skin, reach) : reach;
    nearest(wall, pose, grain.position(), sight,
            std::span(walls.parts).subspan(candidate.part_begin, candidate.part_end - candidate.part_begin),
            touches, chunk.scratch);
    if (away) {
      double gap = sight - reach;
      for (const WallTouch& touch : touches) gap = std::min(gap, touch.distance - reach);
      if (gap > 0) {
        candidate.wake = in.odometer + cautious * gap;
        continue;
      }
      std::erase_if(touches, [&](const WallTouch& touch) { return touch.distance > reach; });
    }
    if (touches.size() > WallCandidate::capacity) {
      chunk.overflow = true;
      touches.resize(WallCandidate::capacity);
    }
    inherit(candidate, touches, [&](const WallContact& ended) {
      if constexpr (Keep) book_end(law, ended, constants_of(in, candidate, ended), grain, in.dt, chunk.ledger);
    });
    if (candidate.size == 0) candidate.wake = in.odometer;
    for (std::size_t t = 0; t < candidate.size; ++t) {
      slot[count++] = {&candidate, &candidate.contact[t]};
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

// All contacts of one chunk of grains, which nobody else adds forces to meanwhile.
template <class Law, bool Keep>
void evaluate_chunk(const Law& law, const ForceInput& in, PairContacts& pairs, WallContacts& walls, std::size_t number,
                    std::vector<ForceRow>& forces) {
  const std::size_t chunks = pairs.chunk.size(), grains = in.grains.size() - chunks;
  const std::size_t begin = number * chunk_rows, end = std::min(begin + chunk_rows, grains);
  std::fill(forces.begin() + std::ptrdiff_t(begin), forces.begin() + std::ptrdiff_t(end), ForceRow{});
  forces[grains + number] = ForceRow{};
  evaluate_pair_chunk<Law, Keep>(law, in, pairs, number, forces);
  for (std::uint32_t w = walls.chunk_begin[number]; w < walls.chunk_begin[number + 1]; ++w)
    evaluate_wall_chunk<Law, Keep>(law, in, walls, walls.chunk[w], forces);
}

template <class Law, bool Keep>
double evaluate_all(const Law& law, const ForceInput& in, PairContacts& pairs, WallContacts& walls, std::vector<ForceRow>& forces) {
#pragma omp parallel for schedule(dynamic, 1) if (pairs.chunk.size() >= few_chunks)
  for (std::size_t k = 0; k < pairs.chunk.size(); ++k) evaluate_chunk<Law, Keep>(law, in, pairs, walls, k, forces);
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
double evaluate_all(const Law& law, bool keep_ledger, const ForceInput& in, PairContacts& pairs, WallContacts& walls,
                    std::vector<ForceRow>& forces) {
  return keep_ledger ? evaluate_all<Law, true>(law, in, pairs, walls, forces)
                     : evaluate_all<Law, false>(law, in, pairs, walls, forces);
}

}  // namespace

double evaluate_contacts(const LawChoice& law, bool keep_ledger, const ForceInput& in, PairContacts& pairs, WallContacts& walls,
                         std::vector<ForceRow>& forces) {
  double overlap = 0;
  const bool compiled = [&]<class... Fixed>(std::type_identity<std::tuple<Fixed...>>) {
    return ((law == choice_of<Fixed>() && (overlap = evaluate_all(Fixed{}, keep_ledger, in, pairs, walls, forces), true)) || ...);
  }(std::type_identity<FixedLaws>{});
  return compiled ? overlap : evaluate_all(law, keep_ledger, in, pairs, walls, forces);
}

}  // namespace dem
