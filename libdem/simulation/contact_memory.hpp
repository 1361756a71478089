// The contacts of a run between two lists: gathered from the stores of the old list, put into those of the new one.
#pragma once
#include <vector>

#include "libdem/contact/contact_store.hpp"
#include "libdem/simulation/grain_store.hpp"
#include "libdem/simulation/simulation.hpp"

namespace dem {

// All memory of the contacts, by the caller's rows: pairs ascending in (i, j), wall pairs in (i, wall, feature).
struct Memory {
  std::vector<State::Pair> pairs;
  std::vector<LastForces> last;  // of a run that keeps a ledger
  std::vector<State::WallPair> wall_pairs;
  std::vector<LastForces> wall_last;
};

// Throws CaseError where rows or walls are not there, or not in order.
void check(const Memory& memory, std::size_t grains, std::size_t walls);

Memory gather(const GrainStore& grains, const PairContacts& pairs, const WallContacts& walls);

// What the lists are made for.
struct ListInput {
  const Setup& setup;
  const MaterialTable& materials;
  const std::vector<WallPose>& poses;  // [walls]
  double skin;                         // m
};

// The pairs in lanes for the rows as they are laid out now, those that touch first.
Lanes list_pairs(const ListInput& in, const GrainStore& grains, const Memory& memory);

// Stores with that memory in them, the pairs' in the room of `used`. Throw CaseError where a contact of the memory has no place in them.
PairContacts make_pair_contacts(const ListInput& in, const Lanes& lanes, const GrainStore& grains, const Memory& memory,
                                PairContacts used);
WallContacts make_wall_contacts(const ListInput& in, const GrainStore& grains, const Memory& memory);

// Rows of walls.candidate in the caller's order of grains, then by wall.
std::vector<std::uint32_t> by_grain(const GrainStore& grains, const WallContacts& walls);

}  // namespace dem
