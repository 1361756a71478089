#include "libjam/graph/ranked_contacts.hpp"

#include <algorithm>
#include <bit>
#include <boost/sort/spreadsort/integer_sort.hpp>
#include <utility>

#include "libjam/graph/contact_force.hpp"

namespace jam {

RankedContacts contacts_by_force(const ContactGraph& graph) {
  const ParticleContacts& pp = graph.snapshot().pp;
  // Positive floating-point numbers stand in the order of their bits; turned over, the largest come first.
  using Key = std::pair<std::uint64_t, std::uint32_t>;
  std::vector<Key> keys;
  keys.reserve(pp.size());
  for (std::uint32_t c = 0; c < pp.size(); ++c)
    if (const double force = repulsive_force(pp, c); force > 0) keys.emplace_back(~std::bit_cast<std::uint64_t>(force), c);
  boost::sort::spreadsort::integer_sort(keys.begin(), keys.end(), [](const Key& key, unsigned shift) { return key.first >> shift; });
  // It leaves equal ones as they fall.
  for (auto first = keys.begin(); first != keys.end();) {
    const auto last = std::find_if(first, keys.end(), [&](const Key& key) { return key.first != first->first; });
    if (last - first > 1) std::sort(first, last);
    first = last;
  }
  RankedContacts ranked;
  ranked.reserve(keys.size());
  for (const auto& [bits, c] : keys) ranked.push_back({std::bit_cast<double>(~bits), pp.row[c][0], pp.row[c][1], c});
  return ranked;
}

}  // namespace jam
