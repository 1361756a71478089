#include "libdem/contact/forces.hpp"

#include <omp.h>

#include <array>

#include "libdem/contact/laws.hpp"
#include "libdem/errors.hpp"

namespace dem {
namespace {

// Below this many pairs waking other threads costs more than they save.
constexpr std::size_t few_pairs = 1000;

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

// Constants that depend on the materials alone, for the contacts of one block.
template <class Get>
PairConstants<Pack> gather_materials(Get get) {
  PairConstants<Pack> c;
  c.effective_modulus = gather([&](std::size_t k) { return get(k).effective_modulus; });
  c.effective_shear = gather([&](std::size_t k) { return get(k).effective_shear; });
  c.damping_ratio = gather([&](std::size_t k) { return get(k).damping_ratio; });
  c.friction = gather([&](std::size_t k) { return get(k).friction; });
  c.rolling_friction = gather([&](std::size_t k) { return get(k).rolling_friction; });
  c.work_of_adhesion = gather([&](std::size_t k) { return get(k).work_of_adhesion; });
  return c;
}

// One block of pairs: gather, law, scatter. Lanes from `count` on repeat lane 0 and are not written back.
template <class Law>
void evaluate_pair_block(const ForceInput& in, PairContacts& pairs, const std::array<std::uint32_t, pack_width>& slot,
                         std::size_t count, double& largest_overlap) {
  const Particles& p = in.particles;
  const auto i = [&](std::size_t k) { return pairs.list.first[slot[k]]; };
  const auto j = [&](std::size_t k) { return pairs.list.second[slot[k]]; };

  const Triple<Pack> branch = gather_triple([&](std::size_t k) -> const Vec3& { return p.position[j(k)]; }) -
                              gather_triple([&](std::size_t k) -> const Vec3& { return p.position[i(k)]; });
  const Pack radius_i = gather([&](std::size_t k) { return p.radius[i(k)]; });
  const Pack radius_j = gather([&](std::size_t k) { return p.radius[j(k)]; });
  const Pack distance = square_root(dot(branch, branch));
  const Pack inverse = 1.0 / distance;

  PairConstants<Pack> c =
      gather_materials([&](std::size_t k) -> const auto& { return in.materials.pair[pairs.material_pair[slot[k]]]; });
  c.effective_radius = gather([&](std::size_t k) { return pairs.bodies[slot[k]].effective_radius; });
  c.effective_mass = gather([&](std::size_t k) { return pairs.bodies[slot[k]].effective_mass; });
  c.effective_inertia = gather([&](std::size_t k) { return pairs.bodies[slot[k]].effective_inertia; });
  c.adhesion_length = gather([&](std::size_t k) { return pairs.bodies[slot[k]].adhesion_length; });

  const Triple<Pack> spin_i = gather_triple([&](std::size_t k) -> const Vec3& { return p.angular_velocity[i(k)]; });
  const Triple<Pack> spin_j = gather_triple([&](std::size_t k) -> const Vec3& { return p.angular_velocity[j(k)]; });
  // The contact point divides the branch in the ratio of the radii.
  const Pack share = distance / (radius_i + radius_j);
  const Pack arm_i = radius_i * share, arm_j = radius_j * share;

  Touch<Pack> touch;
  touch.overlap = radius_i + radius_j - distance;
  touch.normal = branch * inverse;
  touch.velocity = gather_triple([&](std::size_t k) -> const Vec3& { return p.velocity[i(k)]; }) -
                   gather_triple([&](std::size_t k) -> const Vec3& { return p.velocity[j(k)]; }) +
                   cross(spin_i * arm_i + spin_j * arm_j, touch.normal);
  touch.spin = spin_i - spin_j;

  const Pack touched = gather([&](std::size_t k) { return pairs.memory[slot[k]].touched ? 1.0 : 0.0; });
  const Mask<Pack> holds = Law::holds(touch.overlap, touched > Pack(0.5), c);
  Triple<Pack> spring = gather_triple([&](std::size_t k) -> const Vec3& { return pairs.memory[slot[k]].spring; });
  const ContactForce<Pack> f = Law::evaluate(touch, c, spring, Pack(in.dt));

  const Triple<Pack> force = f.tangential - touch.normal * (f.elastic + f.damping);
  const Triple<Pack> twist = cross(touch.normal, f.tangential);
  const Triple<Pack> torque_i = twist * arm_i + f.rolling_torque;
  const Triple<Pack> torque_j = twist * arm_j - f.rolling_torque;
  const Pack relative_overlap = touch.overlap / smaller(radius_i, radius_j);
  for (std::size_t k = 0; k < count; ++k) {
    ContactMemory& memory = pairs.memory[slot[k]];
    PairForce& result = pairs.result[slot[k]];
    pairs.acts[slot[k]] = holds[k];
    if (holds[k]) {
      if (!memory.touched) memory.birth_step = in.step;
      memory.touched = true;
      memory.spring = lane_of(spring, k);
      result.force = lane_of(force, k);
      result.torque_i = lane_of(torque_i, k);
      result.torque_j = lane_of(torque_j, k);
      result.elastic = f.elastic[k];
      result.damping = f.damping[k];
      result.sliding = f.sliding[k];
      largest_overlap = std::max(largest_overlap, double(relative_overlap[k]));
    } else {
      memory = ContactMemory{};
    }
  }
}

template <class Law>
double evaluate_pairs(const ForceInput& in, PairContacts& pairs, std::size_t begin, std::size_t end) {
  const Particles& p = in.particles;
  std::array<std::uint32_t, pack_width> slot{};
  std::size_t count = 0;
  double largest_overlap = 0;
  for (std::size_t s = begin; s < end; ++s) {
    const std::uint32_t i = pairs.list.first[s], j = pairs.list.second[s];
    const double reach = p.radius[i] + p.radius[j];
    const bool candidate =
        pairs.memory[s].touched || (p.position[i] - p.position[j]).squaredNorm() < reach * reach;
    if (!candidate) {
      pairs.acts[s] = 0;
      continue;
    }
    slot[count++] = std::uint32_t(s);
    if (count == pack_width) {
      evaluate_pair_block<Law>(in, pairs, slot, count, largest_overlap);
      count = 0;
    }
  }
  if (count > 0) {
    for (std::size_t k = count; k < pack_width; ++k) slot[k] = slot[0];
    evaluate_pair_block<Law>(in, pairs, slot, count, largest_overlap);
  }
  return largest_overlap;
}

// Carries memory from the places a grain touched in the last step to those it touches now: first the same feature, then,
// where the grain rolled from one feature to its neighbour, the remaining place with the most similar normal.
void inherit(WallCandidate& candidate, const std::vector<WallTouch>& touches) {
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
        candidate.contact[k].memory = old[o].memory;
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
      contact.memory = old[best].memory;
      taken[best] = true;
    }
  }
}

struct WallSlot {
  WallCandidate* candidate;
  WallContact* contact;
};

template <class Law>
void evaluate_wall_block(const ForceInput& in, WallContacts& walls,
                         const std::array<WallSlot, pack_width>& slot, std::size_t count, WallContacts::Chunk& chunk) {
  const Particles& p = in.particles;
  const WallPose& pose = in.poses[chunk.wall];
  const auto i = [&](std::size_t k) { return slot[k].candidate->particle; };

  PairConstants<Pack> c = gather_materials([&](std::size_t k) -> const auto& { return slot[k].candidate->constants; });
  c.effective_radius = gather([&](std::size_t k) { return slot[k].candidate->constants.effective_radius; });
  c.effective_mass = gather([&](std::size_t k) { return slot[k].candidate->constants.effective_mass; });
  c.effective_inertia = gather([&](std::size_t k) { return slot[k].candidate->constants.effective_inertia; });
  c.adhesion_length = gather([&](std::size_t k) { return slot[k].candidate->constants.adhesion_length; });

  const Pack radius = gather([&](std::size_t k) { return p.radius[i(k)]; });
  const Triple<Pack> spin = gather_triple([&](std::size_t k) -> const Vec3& { return p.angular_velocity[i(k)]; });
  Touch<Pack> touch;
  touch.overlap = radius - gather([&](std::size_t k) { return slot[k].contact->touch.distance; });
  touch.normal = gather_triple([&](std::size_t k) -> const Vec3& { return slot[k].contact->touch.normal; });
  const Triple<Pack> arm = touch.normal * radius;
  const Triple<Pack> position = gather_triple([&](std::size_t k) -> const Vec3& { return p.position[i(k)]; });
  const Triple<Pack> origin{Pack(pose.position.x()), Pack(pose.position.y()), Pack(pose.position.z())};
  const Triple<Pack> wall_spin{Pack(pose.angular_velocity.x()), Pack(pose.angular_velocity.y()),
                               Pack(pose.angular_velocity.z())};
  const Triple<Pack> wall_velocity{Pack(pose.velocity.x()), Pack(pose.velocity.y()), Pack(pose.velocity.z())};
  touch.velocity = gather_triple([&](std::size_t k) -> const Vec3& { return p.velocity[i(k)]; }) + cross(spin, arm) -
                   (wall_velocity + cross(wall_spin, position + arm - origin));
  touch.spin = spin - wall_spin;

  const Pack touched = gather([&](std::size_t k) { return slot[k].contact->memory.touched ? 1.0 : 0.0; });
  const Mask<Pack> holds = Law::holds(touch.overlap, touched > Pack(0.5), c);
  Triple<Pack> spring = gather_triple([&](std::size_t k) -> const Vec3& { return slot[k].contact->memory.spring; });
  const ContactForce<Pack> f = Law::evaluate(touch, c, spring, Pack(in.dt));
  const Triple<Pack> force = f.tangential - touch.normal * (f.elastic + f.damping);
  const Triple<Pack> torque = cross(arm, f.tangential) + f.rolling_torque;

  for (std::size_t k = 0; k < count; ++k) {
    WallContact& contact = *slot[k].contact;
    contact.acts = holds[k];
    if (!holds[k]) {
      contact.memory = ContactMemory{};
      continue;
    }
    ++walls.acts[slot[k].candidate - walls.candidate.data()];
    if (!contact.memory.touched) contact.memory.birth_step = in.step;
    contact.memory.touched = true;
    contact.memory.spring = lane_of(spring, k);
    contact.force = lane_of(force, k);
    contact.torque = lane_of(torque, k);
    contact.tangential = lane_of(f.tangential, k);
    contact.rolling_torque = lane_of(f.rolling_torque, k);
    contact.elastic = f.elastic[k];
    contact.damping = f.damping[k];
    contact.sliding = f.sliding[k];
    const Vec3 lever = p.position[i(k)] + p.radius[i(k)] * contact.touch.normal - pose.position;
    chunk.load.force -= contact.force;
    chunk.load.torque -= lever.cross(contact.force) + contact.rolling_torque;
    chunk.largest_overlap = std::max(chunk.largest_overlap, touch.overlap[k] / p.radius[i(k)]);
  }
}

template <class Law>
void evaluate_wall_chunk(const ForceInput& in, WallContacts& walls, WallContacts::Chunk& chunk) {
  std::vector<WallTouch>& touches = chunk.touches;
  const Particles& p = in.particles;
  const Wall& wall = in.walls[chunk.wall];
  const WallPose& pose = in.poses[chunk.wall];
  std::array<WallSlot, pack_width> slot{};
  std::size_t count = 0;
  chunk.load = WallLoad{};
  chunk.largest_overlap = 0;
  for (std::uint32_t q = chunk.begin; q < chunk.end; ++q) {
    WallCandidate& candidate = walls.candidate[q];
    const double radius = p.radius[candidate.particle];
    const double reach = radius - Law::Normal::break_overlap(candidate.constants);
    nearest(wall, pose, p.position[candidate.particle], reach,
            std::span(walls.triangles).subspan(candidate.triangle_begin, candidate.triangle_end - candidate.triangle_begin),
            touches, chunk.scratch);
    if (touches.empty() && candidate.size == 0) continue;  // acts is 0 already
    if (touches.size() > WallCandidate::capacity) {
      chunk.overflow = true;
      touches.resize(WallCandidate::capacity);
    }
    inherit(candidate, touches);
    walls.acts[q] = 0;
    for (std::size_t t = 0; t < candidate.size; ++t) {
      WallContact& contact = candidate.contact[t];
      contact.acts = false;
      if (!contact.memory.touched && contact.touch.distance >= radius) continue;
      slot[count++] = {&candidate, &contact};
      if (count == pack_width) {
        evaluate_wall_block<Law>(in, walls, slot, count, chunk);
        count = 0;
      }
    }
  }
  if (count > 0) {
    for (std::size_t k = count; k < pack_width; ++k) slot[k] = slot[0];
    evaluate_wall_block<Law>(in, walls, slot, count, chunk);
  }
}

template <class Law>
double evaluate_all(const ForceInput& in, PairContacts& pairs, WallContacts& walls) {
  double largest_overlap = 0;
#pragma omp parallel reduction(max : largest_overlap) if (pairs.list.size() > few_pairs)
  {
    const std::size_t threads = std::size_t(omp_get_num_threads()), mine = std::size_t(omp_get_thread_num());
#pragma omp for schedule(dynamic, 1) nowait
    for (std::size_t k = 0; k < walls.chunk.size(); ++k) evaluate_wall_chunk<Law>(in, walls, walls.chunk[k]);
    const std::size_t n = pairs.list.size();
    largest_overlap = evaluate_pairs<Law>(in, pairs, n * mine / threads, n * (mine + 1) / threads);
  }
  for (const WallContacts::Chunk& chunk : walls.chunk) {
    largest_overlap = std::max(largest_overlap, chunk.largest_overlap);
    if (chunk.overflow)
      throw PhysicsError("a grain touches wall '" + in.walls[chunk.wall].name + "' in more than " +
                         std::to_string(WallCandidate::capacity) +
                         " places; its mesh has details much smaller than the grains");
  }
  return largest_overlap;
}

using Evaluate = double (*)(const ForceInput&, PairContacts&, WallContacts&);
template <std::size_t... Row>
constexpr auto evaluate_table(std::index_sequence<Row...>) {
  return std::array<Evaluate, sizeof...(Row)>{&evaluate_all<std::tuple_element_t<Row, ContactLaws>>...};
}

}  // namespace

double evaluate_contacts(std::size_t law, const ForceInput& in, PairContacts& pairs, WallContacts& walls) {
  constexpr auto table = evaluate_table(std::make_index_sequence<std::tuple_size_v<ContactLaws>>{});
  return table.at(law)(in, pairs, walls);
}

}  // namespace dem
