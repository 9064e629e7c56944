// Compiled with -mavx512f. This file uses only internal/kernel.h and intrinsics: an inline function
// of any other header could be linked into code for processors without AVX-512.

#include <immintrin.h>

#include "fit/least_squares/internal/kernel.h"

namespace rondure::fit::ls_kernel {
namespace {

/// Eight points at a time.
struct Avx512 : Singles<Avx512> {
  using Vector = __m512d;
  using Singles<Avx512>::store;
  using Singles<Avx512>::load2;
  using Singles<Avx512>::load3;

  template <class V>
  static V load(const double* p) {
    if constexpr (sizeof(V) == sizeof(double)) {
      return *p;
    } else {
      return _mm512_loadu_pd(p);
    }
  }
  static void store(double* p, Vector v) { _mm512_storeu_pd(p, v); }
  static double root(double v) { return _mm_cvtsd_f64(_mm_sqrt_pd(_mm_set1_pd(v))); }
  static Vector root(Vector v) { return _mm512_maskz_sqrt_pd(0xff, v); }
  /// Every third of 24 numbers: `from_ab` picks from a and b (index + 8), `from_c` then from c.
  static Vector thirds(Vector a, Vector b, Vector c, __m512i from_ab, __m512i from_c) {
    return _mm512_permutex2var_pd(_mm512_permutex2var_pd(a, from_ab, b), from_c, c);
  }
  static void load3(const double* p, Vector& x, Vector& y, Vector& z) {
    const Vector a = _mm512_loadu_pd(p);
    const Vector b = _mm512_loadu_pd(p + 8);
    const Vector c = _mm512_loadu_pd(p + 16);
    x = thirds(a, b, c, _mm512_setr_epi64(0, 3, 6, 9, 12, 15, 0, 0),
               _mm512_setr_epi64(0, 1, 2, 3, 4, 5, 10, 13));
    y = thirds(a, b, c, _mm512_setr_epi64(1, 4, 7, 10, 13, 0, 0, 0),
               _mm512_setr_epi64(0, 1, 2, 3, 4, 8, 11, 14));
    z = thirds(a, b, c, _mm512_setr_epi64(2, 5, 8, 11, 14, 0, 0, 0),
               _mm512_setr_epi64(0, 1, 2, 3, 4, 9, 12, 15));
  }
  static void load2(const double* p, Vector& x, Vector& y) {
    const Vector a = _mm512_loadu_pd(p);
    const Vector b = _mm512_loadu_pd(p + 8);
    x = _mm512_permutex2var_pd(a, _mm512_setr_epi64(0, 2, 4, 6, 8, 10, 12, 14), b);
    y = _mm512_permutex2var_pd(a, _mm512_setr_epi64(1, 3, 5, 7, 9, 11, 13, 15), b);
  }
};

}  // namespace

const Kernel kAvx512 = kernel_of<Avx512>();

}  // namespace rondure::fit::ls_kernel
