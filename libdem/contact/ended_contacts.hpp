// How long contacts lasted that have ended.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace dem {

// Counts by the octave of the life in steps: count[k] lasted at least 2^k steps and less than 2^(k+1); a contact that was evaluated in
// contact n times at every step has lasted n. The last one counts contacts that were there when the run began (birth_step 0), whose
// age nobody knows.
struct EndedContacts {
  static constexpr std::size_t octaves = 31;
  std::array<std::uint32_t, octaves + 1> count{};

  void add(std::uint64_t birth_step, std::uint64_t end_step) {
    ++count[birth_step == 0 ? octaves : std::min<std::size_t>(std::size_t(std::bit_width(end_step - birth_step)) - 1, octaves - 1)];
  }
  EndedContacts& operator+=(const EndedContacts& o) {
    for (std::size_t k = 0; k < count.size(); ++k) count[k] += o.count[k];
    return *this;
  }
};

}  // namespace dem
