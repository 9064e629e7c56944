#pragma once

// Inner loops of sums.h. Each file kernel_*.cpp compiles them for one instruction set, with its own
// type T, so that no code of one set can be linked into another; for the same reason this header
// includes only <cstddef>. All sets perform the same operations in the same order (eight partial
// sums, point i goes to sum i mod 8, no fused multiply-add) and so give the same bits.

#include <cstddef>

namespace rondure::fit::ls_kernel {

inline constexpr std::size_t kLanes = 8;
inline constexpr std::size_t kAhead = 192;   ///< Numbers that are prefetched ahead of their use.
inline constexpr std::size_t kBlock = 1024;  ///< Most points of one call, so that they stay in L1.

/// Coordinates in which the sums are taken: the position across the axis in radii,
/// q = ((p - origin) . row1 - shift1, (p - origin) . row2 - shift2), and the position along it in
/// half lengths, s = (p - origin) . along.
struct Spot {
  double origin[3];
  double row1[3], row2[3], along[3];
  double shift1, shift2;
};

/// Places in Sums::sum. With r = |q|, d = r - 1, k = 1 - 1/r, n = q/r (or q, see below).
enum Place : std::size_t {
  kQ1K,  // q1 k, ...: n d
  kQ2K,
  kSQ1K,
  kSQ2K,
  kD,
  kDD,
  kS,
  kGradientOnly,         // number of sums above
  kM11 = kGradientOnly,  // n1 n1
  kM12,                  // n1 n2; n2 n2 follows, as n1 n1 + n2 n2 = 1
  kSM11,
  kSM12,
  kSSM11,
  kSSM12,
  kN1,
  kN2,
  kSN1,
  kSN2,
  kSS,
  kAll
};

/// Sums of one block, and the least and the largest r^2.
struct Sums {
  double sum[kAll];
  double low, high;
};

/// Operations of every instruction set on single numbers. A template on the type that uses it, so
/// that each set has functions of its own.
template <class T>
struct Singles {
  static void store(double* p, double v) { *p = v; }
  static void load3(const double* p, double& x, double& y, double& z) {
    x = p[0];
    y = p[1];
    z = p[2];
  }
  static void load2(const double* p, double& x, double& y) {
    x = p[0];
    y = p[1];
  }
};

/// (1 - 1/sqrt(1 + e)) / e by its binomial series; the next term is below 1e-15 within kNear.
inline constexpr double kSeries[] = {1.0 / 2.0, -3.0 / 8.0, 5.0 / 16.0, -35.0 / 128.0,
                                     63.0 / 256.0};
inline constexpr double kNear = 1.0 / 256.0;  ///< Largest |r^2 - 1| for which the series is used.

/// Adds the points i, i + 8, ... of a block to `lanes`, from lane `first` on, as many lanes as V
/// holds. kMatrix: all sums, else kGradientOnly. kSeriesOnly: r by the series instead of square
/// root and division; the matrix then uses q for n, which is accurate to |r - 1|.
template <class T, class V, int kDimensions, bool kMatrix, bool kSeriesOnly>
inline void add_lanes(const double* points, std::size_t groups, const Spot& spot, std::size_t first,
                      double (*lanes)[kLanes], double (*range)[kLanes]) {
  constexpr std::size_t kCount = kMatrix ? kAll : kGradientOnly;
  V sum[kCount];
  for (std::size_t k = 0; k < kCount; ++k) sum[k] = T::template load<V>(lanes[k] + first);
  V low = T::template load<V>(range[0] + first);
  V high = T::template load<V>(range[1] + first);
  const double* at = points + kDimensions * first;
  for (std::size_t i = 0; i < groups; ++i, at += kDimensions * kLanes) {
    for (int line = 0; line < kDimensions; ++line) __builtin_prefetch(at + kAhead + 8 * line);
    V x, y, z;
    V q1, q2, s;
    if constexpr (kDimensions == 3) {
      T::load3(at, x, y, z);
      x = x - spot.origin[0];
      y = y - spot.origin[1];
      z = z - spot.origin[2];
      q1 = ((x * spot.row1[0] + y * spot.row1[1]) + z * spot.row1[2]) - spot.shift1;
      q2 = ((x * spot.row2[0] + y * spot.row2[1]) + z * spot.row2[2]) - spot.shift2;
      s = (x * spot.along[0] + y * spot.along[1]) + z * spot.along[2];
    } else {
      T::load2(at, x, y);
      q1 = (x - spot.origin[0]) * spot.row1[0] - spot.shift1;
      q2 = (y - spot.origin[1]) * spot.row1[0] - spot.shift2;
      s = q1 - q1;
    }
    const V rr = q1 * q1 + q2 * q2;
    low = rr < low ? rr : low;
    high = rr > high ? rr : high;
    V k, d, n1 = q1, n2 = q2;
    if constexpr (kSeriesOnly) {
      const V e = rr - 1.0;
      k = e *
          ((((e * kSeries[4] + kSeries[3]) * e + kSeries[2]) * e + kSeries[1]) * e + kSeries[0]);
      d = e - rr * k;
    } else {
      // A point on the axis has no direction; n becomes 0 and k stays finite.
      const V r = T::root(rr > 1e-280 ? rr : rr - rr + 1e-280);
      const V inverse = 1.0 / r;
      k = 1.0 - inverse;
      d = r - 1.0;
      n1 = q1 * inverse;
      n2 = q2 * inverse;
    }
    const V q1k = q1 * k, q2k = q2 * k;
    sum[kQ1K] += q1k;
    sum[kQ2K] += q2k;
    sum[kD] += d;
    sum[kDD] += d * d;
    if constexpr (kDimensions == 3) {
      sum[kSQ1K] += s * q1k;
      sum[kSQ2K] += s * q2k;
      sum[kS] += s;
    }
    if constexpr (kMatrix) {
      const V m11 = n1 * n1, m12 = n1 * n2;
      sum[kM11] += m11;
      sum[kM12] += m12;
      sum[kN1] += n1;
      sum[kN2] += n2;
      if constexpr (kDimensions == 3) {
        const V ss = s * s;
        sum[kSM11] += s * m11;
        sum[kSM12] += s * m12;
        sum[kSSM11] += ss * m11;
        sum[kSSM12] += ss * m12;
        sum[kSN1] += s * n1;
        sum[kSN2] += s * n2;
        sum[kSS] += ss;
      }
    }
  }
  for (std::size_t k = 0; k < kCount; ++k) T::store(lanes[k] + first, sum[k]);
  T::store(range[0] + first, low);
  T::store(range[1] + first, high);
}

/// The sums of one block (count <= kBlock) with the series or without.
template <class T, int kDimensions, bool kMatrix, bool kSeriesOnly>
inline Sums block_by(const double* points, std::size_t count, const Spot& spot) {
  using V = typename T::Vector;
  constexpr std::size_t kCount = kMatrix ? kAll : kGradientOnly;
  alignas(64) double lanes[kCount][kLanes] = {};
  alignas(64) double range[2][kLanes];
  for (std::size_t j = 0; j < kLanes; ++j) {
    range[0][j] = 1e308;
    range[1][j] = 0.0;
  }
  const std::size_t groups = count / kLanes;
  if (groups > 0) {
    for (std::size_t j = 0; j < kLanes; j += sizeof(V) / sizeof(double)) {
      add_lanes<T, V, kDimensions, kMatrix, kSeriesOnly>(points, groups, spot, j, lanes, range);
    }
  }
  const double* rest = points + groups * kLanes * kDimensions;
  for (std::size_t j = 0; j < count % kLanes; ++j) {
    add_lanes<T, double, kDimensions, kMatrix, kSeriesOnly>(rest, 1, spot, j, lanes, range);
  }
  Sums out = {};
  for (std::size_t k = 0; k < kCount; ++k) {
    const double* l = lanes[k];
    out.sum[k] = ((l[0] + l[1]) + (l[2] + l[3])) + ((l[4] + l[5]) + (l[6] + l[7]));
  }
  out.low = range[0][0];
  out.high = range[1][0];
  for (std::size_t j = 1; j < kLanes; ++j) {
    out.low = range[0][j] < out.low ? range[0][j] : out.low;
    out.high = range[1][j] > out.high ? range[1][j] : out.high;
  }
  return out;
}

/// The sums of one block: by the series, and again without it if a point is outside kNear.
template <class T, int kDimensions, bool kMatrix>
inline Sums block(const double* points, std::size_t count, const Spot& spot) {
  const Sums out = block_by<T, kDimensions, kMatrix, true>(points, count, spot);
  if (out.low >= 1.0 - kNear && out.high <= 1.0 + kNear) return out;
  return block_by<T, kDimensions, kMatrix, false>(points, count, spot);
}

/// The four loops of one instruction set.
struct Kernel {
  using Block = Sums (*)(const double* points, std::size_t count, const Spot& spot);
  Block cylinder_all, cylinder_gradient, circle_all, circle_gradient;
};

template <class T>
constexpr Kernel kernel_of() {
  return {block<T, 3, true>, block<T, 3, false>, block<T, 2, true>, block<T, 2, false>};
}

// One per file kernel_*.cpp; the last two only on x86-64.
extern const Kernel kPortable;
extern const Kernel kAvx2;
extern const Kernel kAvx512;

}  // namespace rondure::fit::ls_kernel
