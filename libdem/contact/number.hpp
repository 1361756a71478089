// The number types that the contact law is written for: double, and a pack of doubles that one instruction handles at once.
// The law's templates use only what is named here, so that one text serves both.
#pragma once
#include <algorithm>
#include <cmath>
#include <experimental/simd>

#if defined(__FMA__)
#include <immintrin.h>
#endif

#if defined(__clang__) && defined(__AVX512F__) && defined(_GLIBCXX_EXPERIMENTAL_SIMD)
#error "libstdc++'s std::simd blends AVX-512 packs wrongly under Clang (_S_blend_avx512): add -mno-avx512f"
#endif

namespace dem {

using Pack = std::experimental::native_simd<double>;
inline constexpr std::size_t pack_width = Pack::size();

// mask ? a : b, lane by lane. Both sides are evaluated; neither may trap.
inline double select(bool mask, double a, double b) { return mask ? a : b; }
inline Pack select(const Pack::mask_type& mask, const Pack& a, const Pack& b) {
  Pack r = b;
  std::experimental::where(mask, r) = a;
  return r;
}

inline bool all(bool mask) { return mask; }
inline bool all(const Pack::mask_type& mask) { return std::experimental::all_of(mask); }

inline double square_root(double a) { return std::sqrt(a); }
inline Pack square_root(const Pack& a) { return std::experimental::sqrt(a); }
inline double absolute(double a) { return std::abs(a); }
inline Pack absolute(const Pack& a) { return std::experimental::abs(a); }
inline double larger(double a, double b) { return a > b ? a : b; }
inline double smaller(double a, double b) { return a < b ? a : b; }
#if defined(__AVX512F__)
// The same in one operation: its second operand, too, where one is NaN or both are zero.
inline Pack larger(const Pack& a, const Pack& b) { return Pack(_mm512_max_pd(static_cast<__m512d>(a), static_cast<__m512d>(b))); }
inline Pack smaller(const Pack& a, const Pack& b) { return Pack(_mm512_min_pd(static_cast<__m512d>(a), static_cast<__m512d>(b))); }
#else
inline Pack larger(const Pack& a, const Pack& b) { return select(a > b, a, b); }
inline Pack smaller(const Pack& a, const Pack& b) { return select(a < b, a, b); }
#endif

inline double least_of(double a) { return a; }
inline double least_of(const Pack& a) { return std::experimental::hmin(a); }

template <class Real>
using Mask = decltype(Real() < Real());

// Numbers of half the digits, whose roots and quotients take a third of the time: for first guesses.
using SinglePack = std::experimental::rebind_simd_t<float, Pack>;
inline float to_single(double a) { return float(a); }
inline SinglePack to_single(const Pack& a) { return std::experimental::static_simd_cast<SinglePack>(a); }
inline double to_double(float a) { return a; }
inline Pack to_double(const SinglePack& a) { return std::experimental::static_simd_cast<Pack>(a); }
inline float square_root(float a) { return std::sqrt(a); }
inline SinglePack square_root(const SinglePack& a) { return std::experimental::sqrt(a); }

// a b + c and c - a b, rounded once where processors that we compile for can do that in one operation: chains of operations, of which the law
// consists, are shorter by a sum each. Elsewhere rounded twice, so that the last digits differ. Written out where it is wanted, as a compiler
// that contracts by itself may do so in one copy of a formula and not in another.
#if defined(__FP_FAST_FMA)
inline double multiply_add(double a, double b, double c) { return std::fma(a, b, c); }
inline float multiply_add(float a, float b, float c) { return std::fma(a, b, c); }
inline double subtract_product(double c, double a, double b) { return std::fma(-a, b, c); }
#else
inline double multiply_add(double a, double b, double c) { return a * b + c; }
inline float multiply_add(float a, float b, float c) { return a * b + c; }
inline double subtract_product(double c, double a, double b) { return c - a * b; }
#endif
#if defined(__FMA__)
#if defined(__AVX512F__)
using Register = __m512d;
using SingleRegister = __m256;
inline Register fused(Register a, Register b, Register c) { return _mm512_fmadd_pd(a, b, c); }
inline Register fused_negative(Register a, Register b, Register c) { return _mm512_fnmadd_pd(a, b, c); }
inline SingleRegister fused(SingleRegister a, SingleRegister b, SingleRegister c) { return _mm256_fmadd_ps(a, b, c); }
#else
using Register = __m256d;
using SingleRegister = __m128;
inline Register fused(Register a, Register b, Register c) { return _mm256_fmadd_pd(a, b, c); }
inline Register fused_negative(Register a, Register b, Register c) { return _mm256_fnmadd_pd(a, b, c); }
inline SingleRegister fused(SingleRegister a, SingleRegister b, SingleRegister c) { return _mm_fmadd_ps(a, b, c); }
#endif
inline Pack multiply_add(const Pack& a, const Pack& b, const Pack& c) {
  return Pack(fused(static_cast<Register>(a), static_cast<Register>(b), static_cast<Register>(c)));
}
inline Pack subtract_product(const Pack& c, const Pack& a, const Pack& b) {
  return Pack(fused_negative(static_cast<Register>(a), static_cast<Register>(b), static_cast<Register>(c)));
}
inline SinglePack multiply_add(const SinglePack& a, const SinglePack& b, const SinglePack& c) {
  return SinglePack(fused(static_cast<SingleRegister>(a), static_cast<SingleRegister>(b), static_cast<SingleRegister>(c)));
}
#else
inline Pack multiply_add(const Pack& a, const Pack& b, const Pack& c) { return a * b + c; }
inline Pack subtract_product(const Pack& c, const Pack& a, const Pack& b) { return c - a * b; }
inline SinglePack multiply_add(const SinglePack& a, const SinglePack& b, const SinglePack& c) { return a * b + c; }
#endif

// 1/sqrt(a), a > 0 and finite, to a unit in the last place. Where a processor has it, from a guess of 14 bits by two of Newton's steps: a
// root and a quotient of packs keep the one unit that does them busy for forty cycles, this the others for seven (SPEED.md). What a
// pack gets of it is what single numbers get.
#if defined(__AVX512F__)
template <class Real>
Real inverse_root_from(const Real& guess, const Real& a) {
  const auto step = [&](const Real& y) -> Real { return multiply_add(Real(0.5 * y), subtract_product(Real(1.0), Real(a * y), y), y); };
  return step(step(guess));
}
inline double inverse_root(double a) {
  const __m128d in = _mm_set_sd(a);
  return inverse_root_from(_mm_cvtsd_f64(_mm_rsqrt14_sd(in, in)), a);
}
inline Pack inverse_root_guess(const Pack& a) { return Pack(_mm512_rsqrt14_pd(static_cast<__m512d>(a))); }
inline Pack inverse_root(const Pack& a) { return inverse_root_from(inverse_root_guess(a), a); }
#else
inline double inverse_root(double a) { return 1.0 / square_root(a); }
inline Pack inverse_root(const Pack& a) { return 1.0 / square_root(a); }
#endif

// Three components of a number type. Eigen's matrices expect comparisons to give one bool, which a pack cannot.
template <class Real>
struct Triple {
  Real x, y, z;
};

template <class Real>
Triple<Real> operator+(const Triple<Real>& a, const Triple<Real>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Real>
Triple<Real> operator-(const Triple<Real>& a, const Triple<Real>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Real>
Triple<Real> operator*(const Triple<Real>& a, const Real& s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class Real>
Real dot(const Triple<Real>& a, const Triple<Real>& b) {
  return multiply_add(a.z, b.z, multiply_add(a.y, b.y, a.x * b.x));
}
template <class Real>
Triple<Real> cross(const Triple<Real>& a, const Triple<Real>& b) {
  return {subtract_product(a.y * b.z, a.z, b.y), subtract_product(a.z * b.x, a.x, b.z), subtract_product(a.x * b.y, a.y, b.x)};
}
// a s + b and b - a s.
template <class Real>
Triple<Real> multiply_add(const Triple<Real>& a, const Real& s, const Triple<Real>& b) {
  return {multiply_add(a.x, s, b.x), multiply_add(a.y, s, b.y), multiply_add(a.z, s, b.z)};
}
template <class Real>
Triple<Real> subtract_product(const Triple<Real>& b, const Triple<Real>& a, const Real& s) {
  return {subtract_product(b.x, a.x, s), subtract_product(b.y, a.y, s), subtract_product(b.z, a.z, s)};
}
template <class Real>
Triple<Real> select(const Mask<Real>& mask, const Triple<Real>& a, const Triple<Real>& b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

}  // namespace dem
