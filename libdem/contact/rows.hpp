// Between rows of four or eight doubles in memory (a grain's place, the force on it) and packs that hold one component
// of several rows each.
#pragma once
#include <array>
#include <cstdint>

#if defined(__AVX__)
#include <immintrin.h>
#endif

#include "libdem/contact/number.hpp"
#include "libdem/particles/grain_rows.hpp"

namespace dem {

#if defined(__AVX512F__)
inline constexpr bool eight_lanes = pack_width == 8;
#else
inline constexpr bool eight_lanes = false;
#endif

// Components of the rows at row(0), row(1), ...: each a pointer to four doubles, aligned to 32 bytes.
template <class Row>
std::array<Pack, 4> load_quads(Row row) {
#if defined(__AVX512F__)
  if constexpr (eight_lanes) {
    const auto both = [&](std::size_t k) {
      return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_load_pd(row(k))), _mm256_load_pd(row(k + 4)), 1);
    };
    const __m512d a = both(0), b = both(1), c = both(2), d = both(3);
    const __m512d u = _mm512_unpacklo_pd(a, b), v = _mm512_unpackhi_pd(a, b);
    const __m512d w = _mm512_unpacklo_pd(c, d), x = _mm512_unpackhi_pd(c, d);
    const __m512i even = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13),
                  odd = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
    return {Pack(_mm512_permutex2var_pd(u, even, w)), Pack(_mm512_permutex2var_pd(v, even, x)),
            Pack(_mm512_permutex2var_pd(u, odd, w)), Pack(_mm512_permutex2var_pd(v, odd, x))};
  }
#endif
  std::array<Pack, 4> columns;
  for (std::size_t c = 0; c < 4; ++c) columns[c] = Pack([&](auto lane) { return row(std::size_t(lane))[c]; });
  return columns;
}

// Calls use(lane, row) for each lane, in an order that is always the same, with the row that the eight columns make up.
template <class Use>
void for_each_row(const std::array<Pack, 8>& columns, Use use) {
#if defined(__AVX512F__)
  if constexpr (eight_lanes) {
    // Written out: GCC unrolls loops too late to keep arrays out of memory.
    const auto column = [&](std::size_t k) { return static_cast<__m512d>(columns[k]); };
    const auto even = [&](std::size_t k) { return _mm512_unpacklo_pd(column(k), column(k + 1)); };  // lanes 0 2 4 6
    const auto odd = [&](std::size_t k) { return _mm512_unpackhi_pd(column(k), column(k + 1)); };   // lanes 1 3 5 7
    const auto use_four = [&](std::size_t lane, __m512d ab, __m512d cd, __m512d ef, __m512d gh) {
      const __m512d low = _mm512_shuffle_f64x2(ab, cd, 0x88), low_next = _mm512_shuffle_f64x2(ab, cd, 0xDD);
      const __m512d high = _mm512_shuffle_f64x2(ef, gh, 0x88), high_next = _mm512_shuffle_f64x2(ef, gh, 0xDD);
      use(lane, _mm512_shuffle_f64x2(low, high, 0x88));
      use(lane + 2, _mm512_shuffle_f64x2(low_next, high_next, 0x88));
      use(lane + 4, _mm512_shuffle_f64x2(low, high, 0xDD));
      use(lane + 6, _mm512_shuffle_f64x2(low_next, high_next, 0xDD));
    };
    use_four(0, even(0), even(2), even(4), even(6));
    use_four(1, odd(0), odd(2), odd(4), odd(6));
    return;
  }
#endif
  for (std::size_t k = 0; k < pack_width; ++k) {
    Eigen::Matrix<double, 8, 1> row;
    for (std::size_t c = 0; c < 8; ++c) row[Eigen::Index(c)] = columns[c][k];
    use(k, row);
  }
}

#if defined(__AVX512F__)
inline void add_row(ForceRow& to, const __m512d& row) {
  double* p = to.force.data();
  _mm512_store_pd(p, _mm512_add_pd(_mm512_load_pd(p), row));
}
inline void store_row(ForceRow& to, const __m512d& row) {
  _mm512_store_pd(to.force.data(), row);
}
#endif
inline void add_row(ForceRow& to, const Eigen::Matrix<double, 8, 1>& row) {
  to.force += row.head<4>();
  to.torque += row.tail<4>();
}
inline void store_row(ForceRow& to, const Eigen::Matrix<double, 8, 1>& row) {
  to.force = row.head<4>();
  to.torque = row.tail<4>();
}

}  // namespace dem
