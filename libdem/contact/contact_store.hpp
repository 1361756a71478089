// The contacts of a run: which pairs may touch, what each remembers, and the forces of the last evaluation.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "libdem/contact/ledger.hpp"
#include "libdem/contact/pair_constants.hpp"
#include "libdem/contact/wall_load.hpp"
#include "libdem/geometry/walls.hpp"
#include "libdem/neighbors/pair_list.hpp"
#include "libdem/particles/particles.hpp"

namespace dem {

// What both kinds of contact remember between steps.
struct ContactMemory {
  Vec3 spring = Vec3::Zero();  // m, tangential
  double contact_radius = 0;   // m, of the last evaluation
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
  std::vector<Vec3> rolling;          // [P] N m, elastic rolling torque on i; empty where the law has none
  std::vector<LastForces> last;       // [P] empty where no ledger is kept
  std::vector<PairForce> result;      // [P] of the pairs that act
  std::vector<std::uint8_t> acts;     // [P] 1 for a formed contact
  struct Bodies {
    double effective_radius, effective_mass, effective_inertia, adhesion_length;
  };
  std::vector<Bodies> bodies;               // [P]
  std::vector<std::uint32_t> material_pair;  // [P] index into MaterialTable::pair
  double reach_beyond_touch = 0;             // m, gap across which contacts of the law may form
  // Pairs are handled in chunks of the first grains' rows, whose sums are added in order: they depend neither on the number of
  // threads nor on which pairs that do not touch are in the list.
  static constexpr std::size_t chunk_rows = 128;
  struct Chunk {
    double largest_overlap = 0;  // over the smaller radius
    LedgerSums ledger;
  };
  std::vector<Chunk> chunk;
};

struct WallContact {
  ContactMemory memory;
  Vec3 rolling = Vec3::Zero();  // N m, elastic rolling torque on the particle
  LastForces last;
  WallTouch touch{};
  Vec3 force, torque;       // N, N m on the particle
  Vec3 tangential;          // N on the particle
  double elastic, damping;  // N
  bool acts = false, sliding = false;
};

// A grain that may touch a wall before the list is built again.
struct WallCandidate {
  static constexpr std::size_t capacity = 8;  // touches of one sphere with one wall; more stop the run
  std::uint32_t particle, wall;
  std::uint32_t part_begin, part_end;  // rows of WallContacts::parts: triangles, glued grains
  PairConstants<double> constants;
  std::uint32_t size = 0;
  std::array<WallContact, capacity> contact;  // the first `size`, sorted by feature
};

struct WallContacts {
  std::vector<WallCandidate> candidate;  // sorted by wall, then particle
  std::vector<std::uint8_t> acts;        // per candidate: number of formed contacts
  std::vector<std::uint32_t> parts;
  std::vector<std::uint32_t> of_particle_begin, of_particle;  // compressed rows: candidates of each particle, ascending
  // Candidates are handled in chunks of one wall and so many rows of grains each, whose loads are added in order, likewise.
  static constexpr std::uint32_t chunk_rows = 256;
  struct Chunk {
    std::uint32_t wall, begin, end;
    WallLoad load;
    std::array<WallLoad, facet_labels> load_of_label;  // the part of `load` on the triangles of each label; meshes only
    double largest_overlap = 0;
    LedgerSums ledger;
    bool overflow = false;
    std::vector<WallTouch> touches;  // working space
    std::vector<MeshTouch> scratch;
  };
  std::vector<Chunk> chunk;
};

}  // namespace dem
