// The one hot loop: every contact of the run through its law.
#pragma once
#include "libdem/contact/contact_store.hpp"
#include "libdem/contact/laws.hpp"

namespace dem {

struct ForceInput {
  const std::vector<GrainRow>& grains;  // and the phantoms behind them
  const MaterialTable& materials;
  const std::vector<Wall>& walls;
  const std::vector<WallPose>& poses;  // [walls]
  double dt;                           // s, by how much tangential springs advance; 0 to look without stepping
  std::uint64_t step;
  double odometer;  // m, upper bound of how far any two bodies have come nearer since the run began
  bool wall_curvature = false;  // walls' curvature enters the effective radius; else they are flat where they are touched
  bool record = false;          // fill PairContacts::result
};

// Evaluates all contacts with the law; memory and, where one is kept, the ledger sums of the stores' chunks change. `forces`
// [rows of `grains`] receives the sums over all contacts but those that cross from other chunks, which add_crossing() adds.
// Returns the largest overlap over the smaller radius. Results do not depend on the number of threads. Throws PhysicsError
// where a sphere touches one wall in more places than WallCandidate::capacity.
double evaluate_contacts(const LawChoice& law, bool keep_ledger, const ForceInput& in, PairContacts& pairs, WallContacts& walls,
                         std::vector<ForceRow>& forces);

// Of one chunk of grains.
inline void add_crossing(const PairContacts& pairs, std::size_t chunk, std::vector<ForceRow>& forces) {
  for (std::uint32_t k = pairs.chunk[chunk].incoming_begin; k < pairs.chunk[chunk].incoming_end; ++k) {
    const PairContacts::Incoming& in = pairs.incoming[k];
    if (!pairs.head[in.block].acts) continue;
    forces[in.row].force += pairs.crossing[in.crossing].force;
    forces[in.row].torque += pairs.crossing[in.crossing].torque;
  }
}

}  // namespace dem
