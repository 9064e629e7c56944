// Compiled with -mavx2. This file uses only internal/kernel.h and intrinsics: an inline function of
// any other header could be linked into code for processors without AVX2.

#include <immintrin.h>

#include "fit/least_squares/internal/kernel.h"

namespace rondure::fit::ls_kernel {
namespace {

/// Four points at a time.
struct Avx2 : Singles<Avx2> {
  using Vector = __m256d;
  using Singles<Avx2>::store;
  using Singles<Avx2>::load2;
  using Singles<Avx2>::load3;

  template <class V>
  static V load(const double* p) {
    if constexpr (sizeof(V) == sizeof(double)) {
      return *p;
    } else {
      return _mm256_loadu_pd(p);
    }
  }
  static void store(double* p, Vector v) { _mm256_storeu_pd(p, v); }
  static double root(double v) { return _mm_cvtsd_f64(_mm_sqrt_pd(_mm_set1_pd(v))); }
  static Vector root(Vector v) { return _mm256_sqrt_pd(v); }
  /// Loads the two halves from p and q: [p0 p1 | q0 q1].
  static Vector halves(const double* p, const double* q) {
    return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(p)), _mm_loadu_pd(q), 1);
  }
  static void load3(const double* p, Vector& x, Vector& y, Vector& z) {
    const Vector m03 = halves(p, p + 6);       // x0 y0 | x2 y2
    const Vector m14 = halves(p + 2, p + 8);   // z0 x1 | z2 x3
    const Vector m25 = halves(p + 4, p + 10);  // y1 z1 | y3 z3
    x = _mm256_blend_pd(m03, m14, 0b1010);
    y = _mm256_shuffle_pd(m03, m25, 0b0101);
    z = _mm256_blend_pd(m14, m25, 0b1010);
  }
  static void load2(const double* p, Vector& x, Vector& y) {
    const Vector even = halves(p, p + 4);     // x0 y0 | x2 y2
    const Vector odd = halves(p + 2, p + 6);  // x1 y1 | x3 y3
    x = _mm256_unpacklo_pd(even, odd);
    y = _mm256_unpackhi_pd(even, odd);
  }
};

}  // namespace

const Kernel kAvx2 = kernel_of<Avx2>();

}  // namespace rondure::fit::ls_kernel
