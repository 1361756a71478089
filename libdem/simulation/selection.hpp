// A part of a state: some of its grains, with the contacts among them.
#pragma once
#include <vector>

#include "libdem/simulation/simulation.hpp"

namespace dem {

// The grains i for which keep[i] holds, in their order and with their ids, their contacts with each other and with walls; at the
// same step, ready for a fresh start: sums of forces and an energy ledger do not carry over. Condition: keep has one entry per grain.
State selection(const State& state, const std::vector<bool>& keep);

}  // namespace dem
