// Sums of sets of contacts in which what is in both falls out: chains and cycles over the field of two elements.
#pragma once
#include <algorithm>
#include <cstdint>
#include <functional>
#include <iterator>
#include <span>
#include <vector>

namespace jam {

// sum += other, both descending; `scratch` is memory to work in.
inline void add_modulo_two(std::vector<std::uint32_t>& sum, std::span<const std::uint32_t> other, std::vector<std::uint32_t>& scratch) {
  scratch.clear();
  std::set_symmetric_difference(sum.begin(), sum.end(), other.begin(), other.end(), std::back_inserter(scratch), std::greater<>());
  sum.swap(scratch);
}

}  // namespace jam
