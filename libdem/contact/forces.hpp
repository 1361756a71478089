// The one hot loop: every contact of the run that is due through its law.
#pragma once
#include "libdem/contact/contact_store.hpp"
#include "libdem/contact/laws.hpp"

namespace dem {

struct ForceInput {
  const std::vector<GrainRow>& grains;  // and the phantoms behind them
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
  const std::vector<std::uint32_t>& due_chunks;  // that have such a grain
};

struct ForceOutput {
  std::vector<ForceRow>& forces;     // and the phantoms'
  std::vector<std::uint8_t>& asked;  // [N], the finest level that an evaluated contact asks of the grain
};

// Evaluates all contacts that are due with the law; memory and, where one is kept, the ledger sums of the stores' chunks change.
// The rows of grains that are due receive the sums over these contacts, but for those that cross from other chunks, which
// add_crossing() adds. Returns the largest overlap over the smaller radius. Results do not depend on the number of threads.
// Throws PhysicsError where a sphere touches one wall in more places than WallCandidate::capacity.
double evaluate_contacts(const LawChoice& law, bool keep_ledger, const ForceInput& in, PairContacts& pairs, WallContacts& walls,
                         const ForceOutput& out);

// Of one chunk of grains.
inline void add_crossing(const PairContacts& pairs, std::size_t chunk, std::uint8_t due, const ForceOutput& out) {
  for (std::uint32_t k = pairs.chunk[chunk].incoming_begin; k < pairs.chunk[chunk].incoming_end; ++k) {
    const PairContacts::Incoming& in = pairs.incoming[k];
    const PairContacts::Head& head = pairs.head[in.block];
    if (head.asleep || head.level > due) continue;
    out.asked[in.row] = std::min(out.asked[in.row], head.level);
    if (!head.acts) continue;
    out.forces[in.row].force += pairs.crossing[in.crossing].force;
    out.forces[in.row].torque += pairs.crossing[in.crossing].torque;
  }
}

// After the grains that were due have taken their impulses: the other half of the work (ledger.hpp) of what was evaluated last,
// added to the ledger sums of the pairs' chunks.
void book_second_half(const ForceInput& in, PairContacts& pairs, const WallContacts& walls);

}  // namespace dem
