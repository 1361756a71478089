// Keeps blocks full: pairs that touch move into blocks of their own again, as order_lanes() put them when the lists were built. Where grains
// rattle, contacts end and form while lists last, and soon half of the lanes of each block that is evaluated would be empty.
#pragma once
#include "libdem/contact/pair_blocks.hpp"

namespace dem {

// Moves pairs to other lanes of their chunk, where that leaves at least a ninth fewer blocks to evaluate: those that touch, level by level, then
// those that may soon, by their gap, then those that were asleep. Blocks stay as many, and what a pair remembers goes with it; so does a
// block's level, that of its contacts. Blocks without contacts are asleep afterwards, and wake no later than their pairs would have.
//
// `grains`: how many there are. Condition: all levels are due at the next evaluation. Depends on the present state alone.
void regroup(PairContacts& pairs, const GrainTable& grains, const MaterialTable& materials, const Resolution& resolution);

}  // namespace dem
