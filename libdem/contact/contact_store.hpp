// The contacts of a run: which pairs may touch, what each remembers, and the forces of the last evaluation.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "libdem/contact/pair_constants.hpp"
#include "libdem/geometry/walls.hpp"
#include "libdem/neighbors/pair_list.hpp"
#include "libdem/particles/particles.hpp"

namespace dem {

// What both kinds of contact remember between steps.
struct ContactMemory {
  Vec3 spring = Vec3::Zero();  // m, tangential
  std::uint64_t birth_step = 0;
  bool touched = false;
};

struct PairForce {
  Vec3 force;               // N on i
  Vec3 torque_i, torque_j;  // N m
  double elastic, damping;  // N along the normal, > 0 pushes apart
  bool sliding;
};

struct PairContacts {
  PairList list;
  std::vector<ContactMemory> memory;  // [P]
  std::vector<PairForce> result;      // [P] of the pairs that act
  std::vector<std::uint8_t> acts;     // [P] 1 for a formed contact
  struct Bodies {
    double effective_radius, effective_mass, effective_inertia, adhesion_length;
  };
  std::vector<Bodies> bodies;               // [P]
  std::vector<std::uint32_t> material_pair;  // [P] index into MaterialTable::pair
};

struct WallContact {
  ContactMemory memory;
  WallTouch touch{};
  Vec3 force, torque;       // N, N m on the particle
  Vec3 tangential;          // N on the particle
  Vec3 rolling_torque;      // N m on the particle
  double elastic, damping;  // N
  bool acts = false, sliding = false;
};

// A grain that may touch a wall before the list is built again.
struct WallCandidate {
  static constexpr std::size_t capacity = 8;  // touches of one sphere with one wall; more stop the run
  std::uint32_t particle, wall;
  std::uint32_t triangle_begin, triangle_end;  // rows of WallContacts::triangles
  PairConstants<double> constants;
  std::uint32_t size = 0;
  std::array<WallContact, capacity> contact;  // the first `size`, sorted by feature
};

struct WallLoad {
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  // N, N m on the wall, torque about the pose position
};

struct WallContacts {
  std::vector<WallCandidate> candidate;  // sorted by wall, then particle
  std::vector<std::uint8_t> acts;        // per candidate: number of formed contacts
  std::vector<std::uint32_t> triangles;
  std::vector<std::uint32_t> of_particle_begin, of_particle;  // compressed rows: candidates of each particle, ascending
  // Candidates are handled in fixed chunks of one wall each, whose loads are added in order: the sum does not depend on the
  // number of threads.
  struct Chunk {
    std::uint32_t wall, begin, end;
    WallLoad load;
    double largest_overlap = 0;
    bool overflow = false;
    std::vector<WallTouch> touches;  // working space
    std::vector<MeshTouch> scratch;
  };
  std::vector<Chunk> chunk;
};

}  // namespace dem
