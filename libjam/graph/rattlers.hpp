// Rattlers: particles that cannot be held in balance by their contacts. Whoever has fewer than `least` contacts, walls included, is
// taken away together with them, until all that remain have as many. 2 contacts can hold a frictional particle, 4 a smooth
// one in three dimensions. An adhesive contact holds, so every recorded contact counts; weight is not counted as a hold.
#pragma once
#include <cstdint>
#include <vector>

#include "libjam/graph/contact_graph.hpp"

namespace jam {

inline constexpr std::uint32_t contacts_that_hold_with_friction = 2;

// [N] 1 for a rattler.
std::vector<std::uint8_t> rattlers(const ContactGraph& graph, std::uint32_t least = contacts_that_hold_with_friction);

}  // namespace jam
