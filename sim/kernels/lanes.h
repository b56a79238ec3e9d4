#pragma once
#include <xsimd/xsimd.hpp>

#include "sim/laws/real.h"

// Several contacts or balls side by side: what the laws need of a batch of doubles that a double has by itself.
namespace tumble::sim {

template <class A>
struct PowerOfTwo<xsimd::batch<double, A>> {
  using Batch = xsimd::batch<double, A>;
  static Batch of(const Batch& n) {
    using Bits = xsimd::batch<std::int64_t, A>;
    return xsimd::bitwise_cast<Batch>(xsimd::bitwise_cast<Bits>(n + Batch(kWholeNumbers + 1023)) << 52);
  }
};

template <class Real>
struct Lanes;

template <>
struct Lanes<double> {
  static constexpr int kSize = 1;
  using Mask = bool;
  static double load(const double* p) { return *p; }
  static void store(double* p, double v) { *p = v; }
  static double gather(const double* p, const int* at) { return p[*at]; }
  static unsigned bits(bool mask) { return mask; }
  // Lanes k of those whose bit is set, as from + k, to `out`; how many. May write kSize of them.
  static int append(int* out, int from, unsigned bits) {
    *out = from;
    return static_cast<int>(bits & 1);
  }
  static void fill(int* out, int value) { *out = value; }
  static unsigned below(int n) { return n > 0; }
  static bool first(int n) { return n > 0; }
  static double sum(double v) { return v; }
  static double largest(double v) { return v; }
};

// A whole batch of balls in memory, and the last few that do not fill one: the other lanes are read as zeros and left
// as they are.
template <class Real>
struct Whole {
  Real load(const double* p) const { return Lanes<Real>::load(p); }
  void store(double* p, const Real& v) const { Lanes<Real>::store(p, v); }
  const Real& counted(const Real& v) const { return v; }
};
template <class Real>
struct Rest;

#ifdef __AVX2__
template <class A>
struct Lanes<xsimd::batch<double, A>> {
  using Batch = xsimd::batch<double, A>;
  using Mask = typename Batch::batch_bool_type;
  static constexpr int kSize = static_cast<int>(Batch::size);
  static Batch load(const double* p) { return Batch::load_unaligned(p); }
  static void store(double* p, const Batch& v) { v.store_unaligned(p); }
  static Batch gather(const double* p, const int* at) {
#ifdef __AVX512F__
    if constexpr (kSize == 8)
      return _mm512_i32gather_pd(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(at)), p, 8);
    else
#endif
      return _mm256_i32gather_pd(p, _mm_loadu_si128(reinterpret_cast<const __m128i*>(at)), 8);
  }
  static unsigned bits(const Mask& mask) {
#ifdef __AVX512F__
    if constexpr (kSize == 8)
      return static_cast<unsigned>(mask.data);
    else
#endif
      return static_cast<unsigned>(_mm256_movemask_pd(mask));
  }
  static int append(int* out, int from, unsigned bits) {
#ifdef __AVX512VL__
    if constexpr (kSize == 8) {
      const __m256i lane = _mm256_add_epi32(_mm256_set1_epi32(from), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
      _mm256_mask_compressstoreu_epi32(out, static_cast<__mmask8>(bits), lane);
      return __builtin_popcount(bits);
    }
#endif
    int n = 0;
    for (; bits != 0; bits &= bits - 1) out[n++] = from + __builtin_ctz(bits);
    return n;
  }
  static void fill(int* out, int value) {
    for (int k = 0; k < kSize; ++k) out[k] = value;
  }
  // Lanes before the n-th.
  static unsigned below(int n) { return n >= kSize ? (1u << kSize) - 1 : (1u << n) - 1; }
  static Mask first(int n) {
#ifdef __AVX512F__
    if constexpr (kSize == 8)
      return Mask(static_cast<__mmask8>(below(n)));
    else
#endif
      return Batch(_mm256_setr_pd(0, 1, 2, 3)) < Batch(static_cast<double>(n));
  }
  // Of numbers that add up exactly, so in any order.
  static double sum(const Batch& v) {
    alignas(64) double all[kSize];
    v.store_aligned(all);
    double s = 0;
    for (const double x : all) s += x;
    return s;
  }
  static double largest(const Batch& v) {
    alignas(64) double all[kSize];
    v.store_aligned(all);
    double s = all[0];
    for (const double x : all) s = x > s ? x : s;
    return s;
  }
};

template <class A>
struct Rest<xsimd::batch<double, A>> {
  using Batch = xsimd::batch<double, A>;
  using L = Lanes<Batch>;
  int n = 0;
  typename L::Mask mask = L::first(n);

#ifdef __AVX512F__
  Batch load(const double* p) const { return _mm512_maskz_loadu_pd(mask.data, p); }
  void store(double* p, const Batch& v) const { _mm512_mask_storeu_pd(p, mask.data, v); }
#else
  Batch load(const double* p) const { return _mm256_maskload_pd(p, _mm256_castpd_si256(mask)); }
  void store(double* p, const Batch& v) const { _mm256_maskstore_pd(p, _mm256_castpd_si256(mask), v); }
#endif
  Batch counted(const Batch& v) const { return select(mask, v, Batch(0)); }
};
#endif

}  // namespace tumble::sim
