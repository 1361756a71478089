// What is due at a step, found by a byte each: at most steps little is, and to look at the rest would take as long as to evaluate it.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#if defined(__AVX512BW__)
#include <immintrin.h>

#include <bit>
#endif

namespace dem {

// Writes the places of the bytes that are at most `due`, ascending, counted from `first` on, and returns those that it wrote. `places` has
// room for all.
inline std::span<const std::uint32_t> list_due(std::span<const std::uint8_t> from, std::uint8_t due, std::uint32_t first,
                                               std::span<std::uint32_t> places) {
  std::uint32_t* to = places.data();
#if defined(__AVX512BW__)
  const __m512i limit = _mm512_set1_epi8(char(due));
  for (std::size_t at = 0; at < from.size(); at += 64) {
    const std::size_t left = from.size() - at;
    const std::uint64_t inside = left < 64 ? (std::uint64_t{1} << left) - 1 : ~std::uint64_t{0};
    std::uint64_t found = _mm512_mask_cmple_epu8_mask(inside, _mm512_maskz_loadu_epi8(inside, from.data() + at), limit);
    for (; found != 0; found &= found - 1) *to++ = first + std::uint32_t(at) + std::uint32_t(std::countr_zero(found));
  }
#else
  for (std::size_t at = 0; at < from.size(); ++at) {  // without a branch that nobody could foresee
    *to = first + std::uint32_t(at);
    to += from[at] <= due;
  }
#endif
  return places.first(std::size_t(to - places.data()));
}
// Likewise, with room made for them.
inline std::span<const std::uint32_t> list_due(std::span<const std::uint8_t> from, std::uint8_t due, std::uint32_t first,
                                               std::vector<std::uint32_t>& places) {
  places.resize(from.size());
  return list_due(from, due, first, std::span(places));
}

}  // namespace dem
