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
  // Whole numbers, as what to gather by.
  static void store_ints(int* p, double v) { *p = static_cast<int>(v); }
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
  // Rows of four numbers, one for each lane, as columns.
  static void store_rows(double* rows, double a, double b, double c, double d) {
    rows[0] = a;
    rows[1] = b;
    rows[2] = c;
    rows[3] = d;
  }
  static void load_rows(const double* rows, double& a, double& b, double& c, double& d) {
    a = rows[0];
    b = rows[1];
    c = rows[2];
    d = rows[3];
  }
};

// A whole batch of balls in memory, and the last few that do not fill one: the other lanes are read as zeros and left
// as they are. Rows that are taken leave zeros.
template <class Real>
struct Whole {
  using L = Lanes<Real>;
  Real load(const double* p) const { return L::load(p); }
  void store(double* p, const Real& v) const { L::store(p, v); }
  void take_rows(double* rows, Real& a, Real& b, Real& c, Real& d) const {
    L::load_rows(rows, a, b, c, d);
    L::store_rows(rows, Real(0), Real(0), Real(0), Real(0));
  }
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
  static void store_ints(int* p, const Batch& v) {
#ifdef __AVX512F__
    if constexpr (kSize == 8)
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), _mm512_cvttpd_epi32(v));
    else
#endif
      _mm_storeu_si128(reinterpret_cast<__m128i*>(p), _mm256_cvttpd_epi32(v));
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
  static void store_rows(double* rows, const Batch& a, const Batch& b, const Batch& c, const Batch& d) {
#ifdef __AVX512F__
    if constexpr (kSize == 8) {
      const __m512d ab_even = _mm512_unpacklo_pd(a, b), ab_odd = _mm512_unpackhi_pd(a, b);
      const __m512d cd_even = _mm512_unpacklo_pd(c, d), cd_odd = _mm512_unpackhi_pd(c, d);
      const __m512i low = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11),
                    high = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);
      const __m512d r02 = _mm512_permutex2var_pd(ab_even, low, cd_even),
                    r13 = _mm512_permutex2var_pd(ab_odd, low, cd_odd);
      const __m512d r46 = _mm512_permutex2var_pd(ab_even, high, cd_even),
                    r57 = _mm512_permutex2var_pd(ab_odd, high, cd_odd);
      _mm512_storeu_pd(rows, _mm512_shuffle_f64x2(r02, r13, 0x44));
      _mm512_storeu_pd(rows + 8, _mm512_shuffle_f64x2(r02, r13, 0xEE));
      _mm512_storeu_pd(rows + 16, _mm512_shuffle_f64x2(r46, r57, 0x44));
      _mm512_storeu_pd(rows + 24, _mm512_shuffle_f64x2(r46, r57, 0xEE));
    } else
#endif
    {
      const __m256d ab_even = _mm256_unpacklo_pd(a, b), ab_odd = _mm256_unpackhi_pd(a, b);
      const __m256d cd_even = _mm256_unpacklo_pd(c, d), cd_odd = _mm256_unpackhi_pd(c, d);
      _mm256_storeu_pd(rows, _mm256_permute2f128_pd(ab_even, cd_even, 0x20));
      _mm256_storeu_pd(rows + 4, _mm256_permute2f128_pd(ab_odd, cd_odd, 0x20));
      _mm256_storeu_pd(rows + 8, _mm256_permute2f128_pd(ab_even, cd_even, 0x31));
      _mm256_storeu_pd(rows + 12, _mm256_permute2f128_pd(ab_odd, cd_odd, 0x31));
    }
  }
  static void load_rows(const double* rows, Batch& a, Batch& b, Batch& c, Batch& d) {
#ifdef __AVX512F__
    if constexpr (kSize == 8) {
      const __m512d r01 = _mm512_loadu_pd(rows), r23 = _mm512_loadu_pd(rows + 8);
      const __m512d r45 = _mm512_loadu_pd(rows + 16), r67 = _mm512_loadu_pd(rows + 24);
      const __m512i first = _mm512_setr_epi64(0, 4, 8, 12, 1, 5, 9, 13),
                    second = _mm512_setr_epi64(2, 6, 10, 14, 3, 7, 11, 15);
      const __m512d ab_low = _mm512_permutex2var_pd(r01, first, r23), ab_high = _mm512_permutex2var_pd(r45, first, r67);
      const __m512d cd_low = _mm512_permutex2var_pd(r01, second, r23),
                    cd_high = _mm512_permutex2var_pd(r45, second, r67);
      a = _mm512_shuffle_f64x2(ab_low, ab_high, 0x44);
      b = _mm512_shuffle_f64x2(ab_low, ab_high, 0xEE);
      c = _mm512_shuffle_f64x2(cd_low, cd_high, 0x44);
      d = _mm512_shuffle_f64x2(cd_low, cd_high, 0xEE);
    } else
#endif
    {
      const __m256d r0 = _mm256_loadu_pd(rows), r1 = _mm256_loadu_pd(rows + 4);
      const __m256d r2 = _mm256_loadu_pd(rows + 8), r3 = _mm256_loadu_pd(rows + 12);
      const __m256d ac0 = _mm256_unpacklo_pd(r0, r1), bd0 = _mm256_unpackhi_pd(r0, r1);
      const __m256d ac1 = _mm256_unpacklo_pd(r2, r3), bd1 = _mm256_unpackhi_pd(r2, r3);
      a = _mm256_permute2f128_pd(ac0, ac1, 0x20);
      b = _mm256_permute2f128_pd(bd0, bd1, 0x20);
      c = _mm256_permute2f128_pd(ac0, ac1, 0x31);
      d = _mm256_permute2f128_pd(bd0, bd1, 0x31);
    }
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
  // What follows belongs to other balls, and maybe to another thread.
  void take_rows(double* rows, Batch& a, Batch& b, Batch& c, Batch& d) const {
    alignas(64) double mine[4 * L::kSize] = {};
    for (int k = 0; k < 4 * n; ++k) mine[k] = rows[k];
    for (int k = 0; k < 4 * n; ++k) rows[k] = 0;
    L::load_rows(mine, a, b, c, d);
  }
  Batch counted(const Batch& v) const { return select(mask, v, Batch(0)); }
};
#endif

}  // namespace tumble::sim
