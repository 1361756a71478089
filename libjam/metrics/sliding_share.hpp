// Share of the particle contacts whose tangential force is at its friction limit, as the source recorded it. NaN without contacts
// and where the source does not know.
#pragma once
#include <limits>

#include "libjam/graph/contact_graph.hpp"

namespace jam {

inline double sliding_share(const ContactGraph& graph) {
  const ParticleContacts& contacts = graph.snapshot().pp;
  if (contacts.size() == 0 || !present(contacts.flags, contacts.size())) return std::numeric_limits<double>::quiet_NaN();
  double sliding = 0;
  for (const std::uint8_t flags : contacts.flags) sliding += (flags & contact_sliding) != 0;
  return sliding / double(contacts.size());
}

}  // namespace jam
