// The one hot loop: every contact of the run through its law.
#pragma once
#include "libdem/contact/contact_store.hpp"
#include "libdem/contact/laws.hpp"

namespace dem {

struct ForceInput {
  const Particles& particles;
  const MaterialTable& materials;
  const std::vector<Wall>& walls;
  const std::vector<WallPose>& poses;  // [walls]
  double dt;                           // s, by how much tangential springs advance; 0 to look without stepping
  std::uint64_t step;
  bool wall_curvature = false;  // walls' curvature enters the effective radius; else they are flat where they are touched
};

// Evaluates all contacts with the law; memory, results and, where one is kept, the ledger sums of the stores' chunks change.
// Returns the largest overlap over the smaller radius. Results do not depend on the number of threads. Throws PhysicsError
// where a sphere touches one wall in more places than WallCandidate::capacity.
double evaluate_contacts(const LawChoice& law, bool keep_ledger, const ForceInput& in, PairContacts& pairs, WallContacts& walls);

}  // namespace dem
