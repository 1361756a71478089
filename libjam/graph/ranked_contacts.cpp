#include "libjam/graph/ranked_contacts.hpp"

#include <array>
#include <bit>
#include <utility>

#include "libjam/graph/contact_force.hpp"

namespace jam {
namespace {

// Sorts by the upper half of the keys, ascending, by their digits of 11 bits from the last; equal ones stay in order.
void sort_by_upper_half(std::vector<std::uint64_t>& keys) {
  constexpr unsigned bits = 11, digits = 3;
  constexpr std::uint64_t mask = (1u << bits) - 1;
  std::vector<std::uint64_t> other(keys.size());
  for (unsigned digit = 0; digit < digits; ++digit) {
    const unsigned shift = 32 + digit * bits;
    std::array<std::uint32_t, mask + 1> place{};
    for (const std::uint64_t key : keys) ++place[key >> shift & mask];
    std::uint32_t sum = 0;
    for (std::uint32_t& p : place) sum += std::exchange(p, sum);
    for (const std::uint64_t key : keys) other[place[key >> shift & mask]++] = key;
    keys.swap(other);
  }
}

}  // namespace

RankedContacts contacts_by_force(const ContactGraph& graph) {
  const ParticleContacts& pp = graph.snapshot().pp;
  // Positive floating-point numbers stand in the order of their bits; turned over, the largest come first.
  std::vector<std::uint64_t> keys;
  keys.reserve(pp.size());
  for (std::uint32_t c = 0; c < pp.size(); ++c)
    if (const double force = repulsive_force(pp, c); force > 0)
      keys.push_back(std::uint64_t{~std::bit_cast<std::uint32_t>(float(force))} << 32 | c);
  sort_by_upper_half(keys);
  RankedContacts ranked;
  ranked.reserve(keys.size());
  for (const std::uint64_t key : keys) {
    const std::uint32_t c = std::uint32_t(key);
    const RankedContact contact{repulsive_force(pp, c), pp.row[c][0], pp.row[c][1], c};
    // Forces that single precision does not tell apart.
    auto at = ranked.end();
    while (at != ranked.begin() && (at - 1)->force < contact.force) --at;
    ranked.insert(at, contact);
  }
  return ranked;
}

}  // namespace jam
