// The one hot loop: every contact of the run that is due through its law.
#pragma once
#include <functional>

#include "libdem/contact/contact_store.hpp"
#include "libdem/contact/force_sheets.hpp"
#include "libdem/contact/laws.hpp"

namespace dem {

struct ForceInput {
  const LargeArray<GrainRow>& grains;  // and the phantoms behind them
  const MaterialTable& materials;
  const std::vector<Wall>& walls;
  const std::vector<WallPose>& poses;  // [walls]
  double step_length;                  // s, of level 0
  std::uint64_t step;
  double odometer;  // m, upper bound of how far any two bodies have come nearer since the run began
  bool wall_curvature = false;  // walls' curvature enters the effective radius; else they are flat where they are touched
  bool record = false;          // fill PairContacts::Chunk::recorded
  bool look = false;            // springs do not advance: forces of an instant
  // Levels (levels.hpp). Grains whose level is due are all at this step; what is evaluated has no others.
  std::uint8_t due = 0, highest = 0;
  double foresight = 0;                          // m, by how much more the odometer may grow until all levels are due again
  const std::vector<double>& jolt;               // [chunks] m/s, by how much two grains' speeds may change until then
  const std::vector<std::uint8_t>& level;        // [N] of the grains until now
  const LargeArray<Vec4>& spun;                 // rad/s, half of the last change of each grain's spin, and the phantoms'
  RowChunks chunks;                              // of the grains
  const std::vector<std::uint32_t>& due_chunks;  // that have such a grain
};

struct ForceOutput {
  ForceSheets& sheets;
  std::vector<std::uint8_t>& asked;  // [N], the finest level that an evaluated contact asks of the grain; and the phantoms'
  static constexpr std::uint8_t nothing_asked = 255;
};

// d: row in ForceInput::due_chunks. sheet: what acts on the grains of that chunk, in their order; to be left zero.
using FinishChunk = std::function<void(std::size_t d, ForceSheet& sheet)>;

// Evaluates all contacts that are due with the law; memory and, where one is kept, the ledger sums of the stores' chunks change.
// What is asked of grains that are due must be nothing. Returns the largest overlap over the smaller radius.
//
// Calls finish once for each of the due chunks with the sums over these contacts, when all forces on its grains are there: as soon as that
// is, while they are still in a cache, from whichever thread. Sums are never anywhere else than in sheets. Pairs belong to the chunk of their
// first grain and the second comes later, so contacts that are still to be evaluated then do not look at that chunk's grains: finish may
// move them.
//
// Results do not depend on the number of threads. Throws PhysicsError where a sphere touches one wall in more places than
// WallCandidate::capacity.
double evaluate_contacts(const LawChoice& law, bool keep_ledger, const ForceInput& in, PairContacts& pairs, WallContacts& walls,
                         const ForceOutput& out, const FinishChunk& finish);

// After the grains that were due have taken their impulses: the other half of the work (ledger.hpp) of what was evaluated last,
// added to the ledger sums of the pairs' chunks.
void book_second_half(const ForceInput& in, PairContacts& pairs, const WallContacts& walls);

}  // namespace dem
