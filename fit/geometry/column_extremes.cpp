#include "fit/geometry/column_extremes.h"

#include <algorithm>
#include <cmath>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace rondure::fit {
namespace {

#if defined(__SSE2__)
/// Extremes of two lanes, in two independent chains each, so that latencies of min and max overlap.
class PairExtremes {
 public:
  void take(int chain, __m128d pair) {
    low_[chain] = _mm_min_pd(low_[chain], pair);
    high_[chain] = _mm_max_pd(high_[chain], pair);
  }
  [[nodiscard]] Extremes both() const {
    const __m128d low = _mm_min_pd(low_[0], low_[1]);
    const __m128d high = _mm_max_pd(high_[0], high_[1]);
    return {std::min(_mm_cvtsd_f64(low), _mm_cvtsd_f64(_mm_unpackhi_pd(low, low))),
            std::max(_mm_cvtsd_f64(high), _mm_cvtsd_f64(_mm_unpackhi_pd(high, high)))};
  }

 private:
  __m128d low_[2] = {_mm_set1_pd(std::numeric_limits<double>::infinity()),
                     _mm_set1_pd(std::numeric_limits<double>::infinity())};
  __m128d high_[2] = {_mm_set1_pd(-std::numeric_limits<double>::infinity()),
                      _mm_set1_pd(-std::numeric_limits<double>::infinity())};
};
#endif

}  // namespace

Extremes column_extremes(std::span<const double> values) {
  const std::size_t count = values.size();
  const double* v = values.data();
  std::size_t i = 0;
  Extremes out;
#if defined(__SSE2__)
  PairExtremes pairs;
  for (; i + 4 <= count; i += 4) {
    pairs.take(0, _mm_loadu_pd(v + i));
    pairs.take(1, _mm_loadu_pd(v + i + 2));
  }
  out = pairs.both();
#endif
  for (; i < count; ++i) out.take(v[i]);
  return out;
}

double largest_magnitude(std::span<const double> values) {
  const std::size_t count = values.size();
  const double* v = values.data();
  double largest = 0.0;
  double sum = 0.0;  // keeps a NaN, which a maximum may lose
  std::size_t i = 0;
#if defined(__SSE2__)
  const __m128d sign = _mm_set1_pd(-0.0);
  __m128d high[2] = {_mm_setzero_pd(), _mm_setzero_pd()};
  __m128d sums[2] = {_mm_setzero_pd(), _mm_setzero_pd()};
  for (; i + 4 <= count; i += 4) {
    for (std::size_t k = 0; k < 2; ++k) {
      const __m128d pair = _mm_andnot_pd(sign, _mm_loadu_pd(v + i + 2 * k));
      high[k] = _mm_max_pd(high[k], pair);
      sums[k] = _mm_add_pd(sums[k], pair);
    }
  }
  const __m128d highest = _mm_max_pd(high[0], high[1]);
  const __m128d total = _mm_add_pd(sums[0], sums[1]);
  largest = std::max(_mm_cvtsd_f64(highest), _mm_cvtsd_f64(_mm_unpackhi_pd(highest, highest)));
  sum = _mm_cvtsd_f64(total) + _mm_cvtsd_f64(_mm_unpackhi_pd(total, total));
#endif
  for (; i < count; ++i) {
    largest = std::max(largest, std::abs(v[i]));
    sum += std::abs(v[i]);
  }
  return std::isfinite(sum) ? largest : sum;
}

template <int K>
Extremes move_column(std::span<const double> values, const double* const* gradients,
                     const double* move, double* moved) {
  const std::size_t count = values.size();
  const double* v = values.data();
  std::size_t i = 0;
  Extremes out;
#if defined(__SSE2__)
  PairExtremes pairs;
  __m128d by[K];
  for (int k = 0; k < K; ++k) by[k] = _mm_set1_pd(move[k]);
  for (; i + 4 <= count; i += 4) {
    __m128d a = _mm_loadu_pd(v + i);
    __m128d b = _mm_loadu_pd(v + i + 2);
    for (int k = 0; k < K; ++k) {
      a = _mm_add_pd(a, _mm_mul_pd(_mm_loadu_pd(gradients[k] + i), by[k]));
      b = _mm_add_pd(b, _mm_mul_pd(_mm_loadu_pd(gradients[k] + i + 2), by[k]));
    }
    _mm_storeu_pd(moved + i, a);
    _mm_storeu_pd(moved + i + 2, b);
    pairs.take(0, a);
    pairs.take(1, b);
  }
  out = pairs.both();
#endif
  for (; i < count; ++i) {
    double sum = v[i];
    for (int k = 0; k < K; ++k) sum += gradients[k][i] * move[k];
    moved[i] = sum;
    out.take(sum);
  }
  return out;
}

template <int D>
Extremes square_column(std::size_t count, const double* const* columns, const double* center,
                       double* squares) {
  std::size_t i = 0;
  Extremes out;
#if defined(__SSE2__)
  PairExtremes pairs;
  __m128d at[D];
  for (int k = 0; k < D; ++k) at[k] = _mm_set1_pd(center[k]);
  for (; i + 4 <= count; i += 4) {
    __m128d a, b;
    for (int k = 0; k < D; ++k) {
      const __m128d p = _mm_sub_pd(_mm_loadu_pd(columns[k] + i), at[k]);
      const __m128d q = _mm_sub_pd(_mm_loadu_pd(columns[k] + i + 2), at[k]);
      a = k == 0 ? _mm_mul_pd(p, p) : _mm_add_pd(a, _mm_mul_pd(p, p));
      b = k == 0 ? _mm_mul_pd(q, q) : _mm_add_pd(b, _mm_mul_pd(q, q));
    }
    _mm_storeu_pd(squares + i, a);
    _mm_storeu_pd(squares + i + 2, b);
    pairs.take(0, a);
    pairs.take(1, b);
  }
  out = pairs.both();
#endif
  for (; i < count; ++i) {
    double sum = 0.0;
    for (int k = 0; k < D; ++k) sum += (columns[k][i] - center[k]) * (columns[k][i] - center[k]);
    squares[i] = sum;
    out.take(sum);
  }
  return out;
}

std::size_t first_row_of(std::span<const double> values, double value) {
  const std::size_t count = values.size();
  std::size_t i = 0;
#if defined(__SSE2__)
  const __m128d wanted = _mm_set1_pd(value);
  for (; i + 4 <= count; i += 4) {
    const double* v = values.data() + i;
    const __m128d a = _mm_cmpeq_pd(_mm_loadu_pd(v), wanted);
    const __m128d b = _mm_cmpeq_pd(_mm_loadu_pd(v + 2), wanted);
    if (_mm_movemask_pd(_mm_or_pd(a, b)) != 0) break;
  }
#endif
  while (i + 1 < count && values[i] != value) ++i;
  return i;
}

template Extremes move_column<1>(std::span<const double>, const double* const*, const double*,
                                 double*);
template Extremes move_column<2>(std::span<const double>, const double* const*, const double*,
                                 double*);
template Extremes move_column<3>(std::span<const double>, const double* const*, const double*,
                                 double*);
template Extremes move_column<4>(std::span<const double>, const double* const*, const double*,
                                 double*);
template Extremes square_column<2>(std::size_t, const double* const*, const double*, double*);
template Extremes square_column<3>(std::size_t, const double* const*, const double*, double*);

}  // namespace rondure::fit
