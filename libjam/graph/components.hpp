// Connected components of the contact graph, or of a part of it.
//
// Labels follow a rule, not the order of traversal: the largest component is 0, ties go to the one that holds the
// smallest id. So the same network gives the same labels however its particles are ordered.
#pragma once
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "libjam/graph/contact_graph.hpp"

namespace jam {

struct Components {
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> label;  // [N] component of each vertex; `none` for vertices left out
  std::vector<std::uint32_t> size;   // [K] vertices of each component, descending
};

// All vertices, all contacts.
Components connected_components(const ContactGraph& graph);

// All vertices, joined only by contacts with keep_contact[c] != 0, [C].
Components connected_components(const ContactGraph& graph, std::span<const std::uint8_t> keep_contact);

// Only vertices with keep_vertex[v] != 0, joined only by contacts with keep_contact[c] != 0. Lengths are N and C.
Components connected_components(const ContactGraph& graph, std::span<const std::uint8_t> keep_vertex,
                                std::span<const std::uint8_t> keep_contact);

}  // namespace jam
