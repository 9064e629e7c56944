#include "fit/geometry/scan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace rondure::fit {
namespace {

/// An axis as the two unit vectors across it.
struct AxisView {
  explicit AxisView(const Axis& axis) : origin(axis.point_mm), frame(across(axis.direction)) {}
  Eigen::Vector3d origin;
  Eigen::Matrix<double, 3, 2> frame;
};

template <class View>
constexpr std::size_t kWidth = 3;  // coordinates per point
template <>
constexpr std::size_t kWidth<Eigen::Vector2d> = 2;

/// Running extremes; `sum` is not finite as soon as one coordinate is not.
struct Running {
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  double sum = 0.0;

  void add(double square) {
    low = square < low ? square : low;
    high = square > high ? square : high;
    sum += square;
  }
};

/// Squared distance of one point. All versions must follow this order of operations.
double square(const double* p, const AxisView& v) {
  const double x = p[0] - v.origin[0];
  const double y = p[1] - v.origin[1];
  const double z = p[2] - v.origin[2];
  const double a = x * v.frame(0, 0) + y * v.frame(1, 0) + z * v.frame(2, 0);
  const double b = x * v.frame(0, 1) + y * v.frame(1, 1) + z * v.frame(2, 1);
  return a * a + b * b;
}
double square(const double* p, const Eigen::Vector3d& center) {
  const double x = p[0] - center[0];
  const double y = p[1] - center[1];
  const double z = p[2] - center[2];
  return x * x + y * y + z * z;
}
double square(const double* p, const Eigen::Vector2d& center) {
  const double x = p[0] - center[0];
  const double y = p[1] - center[1];
  return x * x + y * y;
}

template <class View>
Running scan_plain(const double* p, std::size_t count, const View& view) {
  Running out;
  for (std::size_t i = 0; i < count; ++i) out.add(square(p + i * kWidth<View>, view));
  return out;
}

template <class View>
std::size_t find_plain(const double* p, std::size_t count, const View& view, double value) {
  for (std::size_t i = 0; i < count; ++i) {
    if (square(p + i * kWidth<View>, view) == value) return i;
  }
  return count;
}

#if defined(__x86_64__)
#define RONDURE_AVX2 __attribute__((target("avx2"))) inline

/// Coordinates of four points.
struct Four {
  __m256d x, y, z;
};

RONDURE_AVX2 __m256d pair(const double* low, const double* high) {
  return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(low)), _mm_loadu_pd(high), 1);
}

/// Loads of 128 bits place points 0 1 | 2 3 side by side, so that two blends and a shuffle suffice.
RONDURE_AVX2 Four load_four(const double* p, const Eigen::Vector3d& origin) {
  const __m256d first = pair(p, p + 6);       // x0 y0 | x2 y2
  const __m256d second = pair(p + 2, p + 8);  // z0 x1 | z2 x3
  const __m256d third = pair(p + 4, p + 10);  // y1 z1 | y3 z3
  return {_mm256_sub_pd(_mm256_blend_pd(first, second, 0b1010), _mm256_set1_pd(origin[0])),
          _mm256_sub_pd(_mm256_shuffle_pd(first, third, 0b0101), _mm256_set1_pd(origin[1])),
          _mm256_sub_pd(_mm256_blend_pd(second, third, 0b1010), _mm256_set1_pd(origin[2]))};
}

RONDURE_AVX2 __m256d dot(const Four& q, const AxisView& v, int column) {
  const __m256d x = _mm256_mul_pd(q.x, _mm256_set1_pd(v.frame(0, column)));
  const __m256d y = _mm256_mul_pd(q.y, _mm256_set1_pd(v.frame(1, column)));
  const __m256d z = _mm256_mul_pd(q.z, _mm256_set1_pd(v.frame(2, column)));
  return _mm256_add_pd(_mm256_add_pd(x, y), z);
}

RONDURE_AVX2 __m256d four_squares(const double* p, const AxisView& v) {
  const Four q = load_four(p, v.origin);
  const __m256d a = dot(q, v, 0);
  const __m256d b = dot(q, v, 1);
  return _mm256_add_pd(_mm256_mul_pd(a, a), _mm256_mul_pd(b, b));
}

RONDURE_AVX2 __m256d four_squares(const double* p, const Eigen::Vector3d& center) {
  const Four q = load_four(p, center);
  return _mm256_add_pd(_mm256_add_pd(_mm256_mul_pd(q.x, q.x), _mm256_mul_pd(q.y, q.y)),
                       _mm256_mul_pd(q.z, q.z));
}

RONDURE_AVX2 __m256d four_squares(const double* p, const Eigen::Vector2d& center) {
  const __m256d middle = _mm256_setr_pd(center[0], center[1], center[0], center[1]);
  const __m256d first = _mm256_sub_pd(_mm256_loadu_pd(p), middle);
  const __m256d second = _mm256_sub_pd(_mm256_loadu_pd(p + 4), middle);
  // The points are in the order 0 2 1 3, which does not matter here.
  return _mm256_hadd_pd(_mm256_mul_pd(first, first), _mm256_mul_pd(second, second));
}

/// Distance by which memory is prefetched ahead of the arithmetic: 2 KiB. The hardware prefetcher
/// stops at each page, which costs an eighth of a pass over points that are in no cache.
constexpr std::size_t kAhead = 256;

/// Two independent chains, so that the latencies of min, max and sum overlap.
template <class View>
RONDURE_AVX2 Running scan_wide(const double* p, std::size_t count, const View& view) {
  constexpr std::size_t kStep = 4 * kWidth<View>;
  const __m256d infinity = _mm256_set1_pd(std::numeric_limits<double>::infinity());
  __m256d low[2] = {infinity, infinity};
  __m256d high[2] = {_mm256_setzero_pd(), _mm256_setzero_pd()};
  __m256d sum[2] = {_mm256_setzero_pd(), _mm256_setzero_pd()};
  std::size_t i = 0;
  for (; i + 8 <= count; i += 8, p += 2 * kStep) {
    for (std::size_t line = 0; line < 2 * kStep; line += 8) __builtin_prefetch(p + kAhead + line);
    const __m256d s0 = four_squares(p, view);
    const __m256d s1 = four_squares(p + kStep, view);
    low[0] = _mm256_min_pd(s0, low[0]);
    low[1] = _mm256_min_pd(s1, low[1]);
    high[0] = _mm256_max_pd(s0, high[0]);
    high[1] = _mm256_max_pd(s1, high[1]);
    sum[0] = _mm256_add_pd(sum[0], s0);
    sum[1] = _mm256_add_pd(sum[1], s1);
  }
  alignas(32) double lows[4], highs[4], sums[4];
  _mm256_store_pd(lows, _mm256_min_pd(low[0], low[1]));
  _mm256_store_pd(highs, _mm256_max_pd(high[0], high[1]));
  _mm256_store_pd(sums, _mm256_add_pd(sum[0], sum[1]));
  Running out;
  for (int k = 0; k < 4; ++k) {
    out.low = std::min(out.low, lows[k]);
    out.high = std::max(out.high, highs[k]);
    out.sum += sums[k];
  }
  for (; i < count; ++i, p += kWidth<View>) out.add(square(p, view));
  return out;
}

template <class View>
RONDURE_AVX2 std::size_t find_wide(const double* p, std::size_t count, const View& view,
                                   double value) {
  const __m256d wanted = _mm256_set1_pd(value);
  std::size_t i = 0;
  for (; i + 4 <= count; i += 4) {
    const __m256d equal =
        _mm256_cmp_pd(four_squares(p + i * kWidth<View>, view), wanted, _CMP_EQ_OQ);
    if (_mm256_movemask_pd(equal) != 0) break;
  }
  return i + find_plain(p + i * kWidth<View>, count - i, view, value);
}

bool has_avx2() {
  static const bool has = __builtin_cpu_supports("avx2") != 0;
  return has;
}
#undef RONDURE_AVX2
#endif

template <class View>
Running scan_some(const double* p, std::size_t count, const View& view) {
#if defined(__x86_64__)
  if (has_avx2()) return scan_wide(p, count, view);
#endif
  return scan_plain(p, count, view);
}

template <class Point, class View>
std::size_t find_one(std::span<const Point> points, const View& view, double value) {
  if (points.empty()) return 0;
  const double* p = points.data()->data();
#if defined(__x86_64__)
  if (has_avx2()) return find_wide(p, points.size(), view, value);
#endif
  return find_plain(p, points.size(), view, value);
}

template <class Point, class View>
ScanExtremes scan_all(std::span<const Point> points, const View& view) {
  if (points.empty()) return {};
  const Running all = scan_some(points.data()->data(), points.size(), view);
  return {all.low, all.high, std::isfinite(all.sum)};
}

template <class Point, class View>
void scan_each_block(std::span<const Point> points, const View& view, BlockScan& out) {
  const std::size_t blocks = (points.size() + out.block - 1) / out.block;
  out.low.resize(blocks);
  out.high.resize(blocks);
  Running all;
  for (std::size_t k = 0; k < blocks; ++k) {
    const auto part =
        points.subspan(k * out.block, std::min(out.block, points.size() - k * out.block));
    const Running one = scan_some(part.data()->data(), part.size(), view);
    out.low[k] = one.low;
    out.high[k] = one.high;
    all.low = std::min(all.low, one.low);
    all.high = std::max(all.high, one.high);
    all.sum += one.sum;
  }
  out.all = {all.low, all.high, std::isfinite(all.sum)};
}

}  // namespace

ScanExtremes scan(SpacePoints points_mm, const Axis& axis) {
  return scan_all(points_mm, AxisView(axis));
}
ScanExtremes scan(SpacePoints points_mm, const Eigen::Vector3d& center_mm) {
  return scan_all(points_mm, center_mm);
}
ScanExtremes scan(PlanePoints points_mm, const Eigen::Vector2d& center_mm) {
  return scan_all(points_mm, center_mm);
}

void scan_blocks(SpacePoints points_mm, const Axis& axis, BlockScan& out) {
  scan_each_block(points_mm, AxisView(axis), out);
}
void scan_blocks(SpacePoints points_mm, const Eigen::Vector3d& center_mm, BlockScan& out) {
  scan_each_block(points_mm, center_mm, out);
}
void scan_blocks(PlanePoints points_mm, const Eigen::Vector2d& center_mm, BlockScan& out) {
  scan_each_block(points_mm, center_mm, out);
}

std::size_t find_square(SpacePoints points_mm, const Axis& axis, double square_mm2) {
  return find_one(points_mm, AxisView(axis), square_mm2);
}
std::size_t find_square(SpacePoints points_mm, const Eigen::Vector3d& center_mm,
                        double square_mm2) {
  return find_one(points_mm, center_mm, square_mm2);
}
std::size_t find_square(PlanePoints points_mm, const Eigen::Vector2d& center_mm,
                        double square_mm2) {
  return find_one(points_mm, center_mm, square_mm2);
}

}  // namespace rondure::fit
