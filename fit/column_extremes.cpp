#include "fit/column_extremes.h"

#include <algorithm>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace rondure::fit {
namespace {

void take(ColumnExtremes& out, double value) {
  out.low = std::min(out.low, value);
  out.high = std::max(out.high, value);
}

#if defined(__SSE2__)
/// Extremes of two lanes in two chains each, so that the latencies of min and max overlap.
class PairExtremes {
 public:
  void take(int chain, __m128d pair) {
    low_[chain] = _mm_min_pd(low_[chain], pair);
    high_[chain] = _mm_max_pd(high_[chain], pair);
  }
  [[nodiscard]] ColumnExtremes both() const {
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

ColumnExtremes column_extremes(std::span<const double> values) {
  const std::size_t count = values.size();
  const double* v = values.data();
  std::size_t i = 0;
  ColumnExtremes out;
#if defined(__SSE2__)
  PairExtremes pairs;
  for (; i + 4 <= count; i += 4) {
    pairs.take(0, _mm_loadu_pd(v + i));
    pairs.take(1, _mm_loadu_pd(v + i + 2));
  }
  out = pairs.both();
#endif
  for (; i < count; ++i) take(out, v[i]);
  return out;
}

template <int K>
ColumnExtremes move_column(std::span<const double> values, const double* const* gradients,
                           const double* move, double* moved) {
  const std::size_t count = values.size();
  const double* v = values.data();
  std::size_t i = 0;
  ColumnExtremes out;
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
    take(out, sum);
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

template ColumnExtremes move_column<1>(std::span<const double>, const double* const*, const double*,
                                       double*);
template ColumnExtremes move_column<2>(std::span<const double>, const double* const*, const double*,
                                       double*);
template ColumnExtremes move_column<3>(std::span<const double>, const double* const*, const double*,
                                       double*);
template ColumnExtremes move_column<4>(std::span<const double>, const double* const*, const double*,
                                       double*);

}  // namespace rondure::fit
