// The contacts of a run: which pairs may touch, what each remembers, and the forces of the last evaluation.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "libdem/contact/ended_contacts.hpp"
#include "libdem/contact/ledger.hpp"
#include "libdem/contact/levels.hpp"
#include "libdem/contact/pair_constants.hpp"
#include "libdem/contact/wall_load.hpp"
#include "libdem/geometry/walls.hpp"
#include "libdem/particles/grain_rows.hpp"

namespace dem {

// What a contact remembers between steps.
struct ContactMemory {
  Vec3 spring = Vec3::Zero();  // m, tangential
  double contact_radius = 0;   // m, of the last evaluation; > 0 exactly where there is a contact
  std::uint64_t birth_step = 0;
};

struct PairForce {
  std::uint32_t lane;
  bool sliding;
  Vec3 tangential;          // N on the first grain
  double elastic, damping;  // N along the normal, > 0 pushes apart
};

// What decides whether a block of pairs, or a grain near a wall, has to be looked at: few bytes, as most need not. One that does
// not act and is asleep has no level: it is looked at when all levels are due and the odometer (ForceInput) may come to `wake`, m,
// before they are again.
struct Activity {
  bool acts = false;  // there is a contact
  bool asleep = true;
  std::uint8_t level = 0;
  // Of one that does not act and is awake: steps after all levels were due last before which no contact forms, as was seen; until they are again.
  std::uint32_t quiet_until = 0;
  double wake = -std::numeric_limits<double>::infinity();

  // The lowest due level at which it has to be looked at.
  std::uint8_t due_from() const { return acts || !asleep ? level : when_all_are_due; }
  static constexpr std::uint8_t when_all_are_due = 255;
};

// Pairs of grains that touch or may touch before the list is built again, in blocks of eight lanes. A pair keeps its lane until
// then; the sums of forces go in the order of the lanes. Lanes that are left over hold a phantom as their second grain.
struct PairContacts {
  static constexpr std::size_t width = 8;
  using Column = std::array<double, width>;
  struct alignas(64) Block {
    std::array<std::uint32_t, width> first, second;                             // rows of grains
    std::array<Column, 3> spring{};                                             // m, tangential
    Column contact_radius{};                                                    // m, as in ContactMemory
    Column cube_root{};                                                         // m^(1/3), PairConstants::cube_root; all else follows
                                                                                // from the rows of grains, with less to read
  };
  struct alignas(64) RollingSprings {
    std::array<Column, 3> torque{};  // N m, elastic part of the one on the first grain
  };
  struct Kind {
    LevelScale scale;                 // the smallest of the lanes
    std::uint32_t material_pair = 0;  // index into MaterialTable::pair, of all lanes
    std::uint32_t crossing = 0;       // first row of PairContacts::crossing, of a block whose pairs cross chunks
  };
  LargeArray<Block> block;
  std::vector<Activity> activity;             // [blocks]
  // [blocks] Activity::due_from() or lower: found faster among bytes (due_list.hpp). Where all levels are due all are looked at.
  std::vector<std::uint8_t> due_from;
  std::vector<Kind> kind;                     // [blocks]
  std::vector<std::uint64_t> birth_step;      // [lanes]
  std::vector<RollingSprings> rolling;        // [blocks] empty where the law has none
  std::vector<LastForces> last;               // [lanes] empty where no ledger is kept
  // Of pairs whose second grain belongs to another chunk: what acts on it. And for each chunk which those are.
  LargeArray<ForceRow> crossing;
  struct Incoming {
    std::uint32_t row, crossing, block;
  };
  std::vector<Incoming> incoming;

  // Pairs belong to the chunk of their first grain: [begin, inner_end) have the second there too, [inner_end, end) cross.
  struct Chunk {
    std::uint32_t begin = 0, inner_end = 0, end = 0;
    std::uint32_t incoming_begin = 0, incoming_end = 0;
    std::vector<std::uint32_t> senders;  // chunks, all before this one, whose pairs cross to it
    std::uint8_t pending = 0;            // its pairs are still to be evaluated; one thread writes what others read
    // Of the last evaluation.
    double largest_overlap = 0;  // over the smaller radius
    LedgerSums ledger;
    Evaluations evaluations;
    EndedContacts ended;
    std::vector<PairForce> recorded;  // by lane, of the last evaluation that recorded
    std::vector<std::uint32_t> places;  // working space
  };
  std::vector<Chunk> chunk;

  std::size_t lanes() const { return width * block.size(); }
  std::uint32_t first(std::size_t lane) const { return block[lane / width].first[lane % width]; }
  std::uint32_t second(std::size_t lane) const { return block[lane / width].second[lane % width]; }
  double contact_radius(std::size_t lane) const { return block[lane / width].contact_radius[lane % width]; }
  bool acts(std::size_t lane) const { return contact_radius(lane) > 0; }
};

struct WallContact {
  ContactMemory memory;
  Vec3 rolling = Vec3::Zero();  // N m, elastic rolling torque on the particle
  WallTouch touch{};
  Vec3 tangential;          // N on the particle
  double elastic, damping;  // N
  bool sliding = false;
  bool acts() const { return memory.contact_radius > 0; }
};

// A grain that may touch a wall before the list is built again.
struct WallCandidate {
  static constexpr std::size_t capacity = 8;  // touches of one sphere with one wall; more stop the run
  std::uint32_t particle, wall;
  std::uint32_t part_begin, part_end;  // rows of WallContacts::parts: triangles, glued grains
  // Those that the grain may touch until the odometer (ForceInput) comes to near_until, m: rows of WallContacts::near_parts from part_begin on.
  std::uint32_t near_count = 0;
  double near_until = -std::numeric_limits<double>::infinity();
  // Rows of WallContacts::contact: `size` of them are in use, sorted by feature, and there is room for so many. A wall without
  // parts touches in one place, others in no more places than they have parts here.
  std::uint32_t contact_begin = 0;
  std::uint16_t size = 0, room = 0;
  LevelScale scale;
  double last_overlap = 0;          // m (<= 0), below which no contact holds, however the wall is curved
  std::uint32_t material_pair = 0;  // index into MaterialTable::pair
  std::array<double, constants_per_contact> constant{};  // of the table contact_constants, of a flat wall
};

struct WallContacts {
  std::vector<WallCandidate> candidate;  // sorted by chunk of the grain, wall, grain
  std::vector<Activity> activity;        // [candidates]
  std::vector<std::uint8_t> due_from;    // [candidates] likewise
  std::vector<std::uint32_t> parts, near_parts;  // of one size
  std::vector<WallContact> contact;
  std::vector<LastForces> last;  // of each contact; empty where no ledger is kept
  // Candidates are handled in chunks of one wall and one chunk of grains, whose loads are added in order.
  struct Chunk {
    std::uint32_t wall = 0, begin = 0, end = 0;
    // Of the last evaluation.
    WallLoad load;
    // In the mean over the steps until those contacts are evaluated again: times their strides.
    WallLoad share;
    std::array<WallLoad, facet_labels> share_of_label;  // the part of `share` on the triangles of each label; meshes only
    std::array<WallLoad, facet_labels> load_of_label;  // the same of `load`
    double largest_overlap = 0;
    LedgerSums ledger;
    Evaluations evaluations;
    EndedContacts ended;
    bool overflow = false;
    std::vector<std::uint32_t> places;  // working space
    std::vector<WallTouch> touches;
    std::vector<MeshTouch> scratch;
  };
  std::vector<Chunk> chunk;
  std::vector<std::uint32_t> chunk_begin;  // [chunks of grains + 1] rows of `chunk`
  double skin = 0;                         // m, how far beyond a grain's surface the candidate parts reach

  std::span<const WallContact> contacts(const WallCandidate& c) const { return {&contact[c.contact_begin], c.size}; }
  // Of a chunk of grains.
  std::span<Chunk> chunks_of(std::size_t grains) { return std::span(chunk).subspan(chunk_begin[grains], chunk_begin[grains + 1] - chunk_begin[grains]); }
  std::span<const Chunk> chunks_of(std::size_t grains) const {
    return std::span(chunk).subspan(chunk_begin[grains], chunk_begin[grains + 1] - chunk_begin[grains]);
  }
};

}  // namespace dem
