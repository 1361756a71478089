// What a run refuses to begin with.
#pragma once
#include <cstdint>

#include "libdem/simulation/simulation.hpp"

namespace dem {

// Throws CaseError where a setup and the grains and step of a state do not fit together.
void check_input(const Setup& setup, const Particles& p, std::uint64_t step);

}  // namespace dem
