#include "benchmarks/streaming_pass.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace rondure::benchmarks {
namespace {

constexpr std::size_t kLanes = 16;
using Lanes = std::array<double, kLanes>;

/// Squared distances of kLanes points taken into the extremes of each lane. Comparisons are
/// written as the processor's minimum and maximum, or they would not become SIMD.
inline void take(const Lanes& squared, Lanes& low, Lanes& high) {
  for (std::size_t j = 0; j < kLanes; ++j) {
    low[j] = squared[j] < low[j] ? squared[j] : low[j];
    high[j] = squared[j] > high[j] ? squared[j] : high[j];
  }
}

Extremes least_and_largest(const Lanes& low, const Lanes& high) {
  Extremes out{low[0], high[0]};
  for (std::size_t j = 1; j < kLanes; ++j) {
    out.low = low[j] < out.low ? low[j] : out.low;
    out.high = high[j] > out.high ? high[j] : out.high;
  }
  return out;
}

/// Squared distance is |Q (p - o)|^2 with the 2 x 3 matrix Q across the axis.
struct Rows {
  std::array<double, 4> u;
  std::array<double, 4> v;  ///< v . p + v[3]
};

[[gnu::target_clones("avx512f", "avx2", "default")]] Extremes pass3(const double* p,
                                                                    std::size_t count,
                                                                    const Rows& rows) {
  Lanes low;
  Lanes high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(0.0);
  Lanes squared;
  for (std::size_t i = 0; i < count; i += kLanes) {
    const double* const q = p + 3 * (i + kLanes <= count ? i : count - kLanes);
    for (std::size_t j = 0; j < kLanes; ++j) {
      const double x = q[3 * j];
      const double y = q[3 * j + 1];
      const double z = q[3 * j + 2];
      const double a = rows.u[0] * x + rows.u[1] * y + rows.u[2] * z + rows.u[3];
      const double b = rows.v[0] * x + rows.v[1] * y + rows.v[2] * z + rows.v[3];
      squared[j] = a * a + b * b;
    }
    take(squared, low, high);
  }
  return least_and_largest(low, high);
}

[[gnu::target_clones("avx512f", "avx2", "default")]] Extremes pass2(const double* p,
                                                                    std::size_t count, double cx,
                                                                    double cy) {
  Lanes low;
  Lanes high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(0.0);
  Lanes squared;
  for (std::size_t i = 0; i < count; i += kLanes) {
    const double* const q = p + 2 * (i + kLanes <= count ? i : count - kLanes);
    for (std::size_t j = 0; j < kLanes; ++j) {
      const double x = q[2 * j] - cx;
      const double y = q[2 * j + 1] - cy;
      squared[j] = x * x + y * y;
    }
    take(squared, low, high);
  }
  return least_and_largest(low, high);
}

[[gnu::target_clones("avx512f", "avx2", "default")]] double sum(const double* p,
                                                                std::size_t count) {
  Lanes sums{};
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    for (std::size_t j = 0; j < kLanes; ++j) sums[j] += p[i + j];
  }
  double out = 0.0;
  for (; i < count; ++i) out += p[i];
  for (const double lane : sums) out += lane;
  return out;
}

/// A set smaller than one step of the pass: repeated to fill it.
template <class Point>
std::array<Point, kLanes> repeated(std::span<const Point> points_mm) {
  std::array<Point, kLanes> out;
  for (std::size_t i = 0; i < kLanes; ++i) out[i] = points_mm[i % points_mm.size()];
  return out;
}

}  // namespace

double Extremes::width_mm() const { return std::sqrt(high) - std::sqrt(low); }

Extremes streaming_pass(std::span<const Eigen::Vector3d> points_mm, const fit::Axis& axis) {
  const Eigen::Matrix<double, 3, 2> q = fit::across(axis.direction);
  const Eigen::Vector2d o = q.transpose() * axis.point_mm;
  const Rows rows{{q(0, 0), q(1, 0), q(2, 0), -o.x()}, {q(0, 1), q(1, 1), q(2, 1), -o.y()}};
  if (points_mm.size() < kLanes) {
    return pass3(repeated(points_mm).front().data(), kLanes, rows);
  }
  return pass3(points_mm.front().data(), points_mm.size(), rows);
}

Extremes streaming_pass(std::span<const Eigen::Vector2d> points_mm,
                        const Eigen::Vector2d& center_mm) {
  if (points_mm.size() < kLanes) {
    return pass2(repeated(points_mm).front().data(), kLanes, center_mm.x(), center_mm.y());
  }
  return pass2(points_mm.front().data(), points_mm.size(), center_mm.x(), center_mm.y());
}

double read_and_sum(std::span<const double> numbers) { return sum(numbers.data(), numbers.size()); }

}  // namespace rondure::benchmarks
