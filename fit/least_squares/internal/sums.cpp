#include "fit/least_squares/internal/sums.h"

#include <cmath>

#include "fit/least_squares/internal/kernel.h"

namespace rondure::fit {
namespace {

const ls_kernel::Kernel& kernel_for(Simd simd) {
#if defined(RONDURE_LS_KERNEL_X86)
  if (simd == Simd::kAvx512) return ls_kernel::kAvx512;
  if (simd == Simd::kAvx2) return ls_kernel::kAvx2;
#endif
  static_cast<void>(simd);
  return ls_kernel::kPortable;
}

/// One pass: the block function, its coordinates and the numbers it reads.
struct Pass {
  const double* numbers = nullptr;
  std::size_t dimensions = 3;
  ls_kernel::Kernel::Block block = nullptr;
  ls_kernel::Spot spot = {};
  double radius_mm = 0.0;
  StretchExtremes* extremes = nullptr;
};

/// Sums of the points [first, first + count), pairwise over blocks.
ls_kernel::Sums total(const Pass& pass, std::size_t first, std::size_t count) {
  if (count <= ls_kernel::kBlock) {
    const ls_kernel::Sums out =
        pass.block(pass.numbers + first * pass.dimensions, count, pass.spot);
    if (pass.extremes != nullptr) {
      pass.extremes->add(first, pass.radius_mm * std::sqrt(out.low),
                         pass.radius_mm * std::sqrt(out.high));
    }
    return out;
  }
  const std::size_t half =
      (count / 2 + ls_kernel::kBlock - 1) / ls_kernel::kBlock * ls_kernel::kBlock;
  ls_kernel::Sums out = total(pass, first, half);
  const ls_kernel::Sums rest = total(pass, first + half, count - half);
  for (std::size_t k = 0; k < ls_kernel::kAll; ++k) out.sum[k] += rest.sum[k];
  return out;
}

}  // namespace

Simd best_simd() {
#if defined(RONDURE_LS_KERNEL_X86)
  static const Simd best = __builtin_cpu_supports("avx512f") != 0 ? Simd::kAvx512
                           : __builtin_cpu_supports("avx2") != 0  ? Simd::kAvx2
                                                                  : Simd::kPortable;
  return best;
#else
  return Simd::kPortable;
#endif
}

StretchExtremes::StretchExtremes(std::size_t n)
    : size_(((n + ls_kernel::kBlock - 1) / ls_kernel::kBlock + kStretches - 1) / kStretches *
            ls_kernel::kBlock) {
  low_mm_.fill(std::numeric_limits<double>::infinity());
  high_mm_.fill(0.0);
}

void StretchExtremes::add(std::size_t first, double low_mm, double high_mm) {
  const std::size_t i = first / size_;
  low_mm_[i] = std::min(low_mm_[i], low_mm);
  high_mm_[i] = std::max(high_mm_[i], high_mm);
  lowest_mm_ = std::min(lowest_mm_, low_mm);
  highest_mm_ = std::max(highest_mm_, high_mm);
}

bool StretchExtremes::may_hold(std::size_t i, double change_mm) const {
  return low_mm_[i] <= lowest_mm_ + 2.0 * change_mm || high_mm_[i] >= highest_mm_ - 2.0 * change_mm;
}

PassSums<5> cylinder_sums(SpacePoints points_mm, const Eigen::Vector3d& origin_mm,
                          const CylinderFrame& frame, double radius_mm,
                          const PassOptions& options) {
  using enum ls_kernel::Place;
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double));
  PassSums<5> out;
  out.squares = std::numeric_limits<double>::infinity();
  if (!(radius_mm > 0.0)) return out;
  const ls_kernel::Kernel& kernel = kernel_for(options.simd);
  const auto across = frame.across_axis();
  const Eigen::Vector3d row1 = across.col(0) / radius_mm;
  const Eigen::Vector3d row2 = across.col(1) / radius_mm;
  const Eigen::Vector3d along = frame.axis().direction / frame.half_length_mm();
  Pass pass{points_mm.front().data(),
            3,
            options.matrix ? kernel.cylinder_all : kernel.cylinder_gradient,
            {},
            radius_mm,
            options.extremes};
  for (Eigen::Index i = 0; i < 3; ++i) {
    pass.spot.origin[i] = origin_mm(i);
    pass.spot.row1[i] = row1(i);
    pass.spot.row2[i] = row2(i);
    pass.spot.along[i] = along(i);
  }
  pass.spot.shift1 = frame.axis().point_mm.dot(row1);
  pass.spot.shift2 = frame.axis().point_mm.dot(row2);
  // Tilts turn about the point of the axis, so s is measured from that point.
  const double foot = frame.axis().point_mm.dot(along);
  ls_kernel::Sums raw = total(pass, 0, points_mm.size());
  const double* m = raw.sum;
  const auto n = static_cast<double>(points_mm.size());
  out.along_mm = m[kS] / n * frame.half_length_mm();
  out.squares = radius_mm * radius_mm * m[kDD];
  out.right << m[kQ1K], m[kQ2K], m[kSQ1K] - foot * m[kQ1K], m[kSQ2K] - foot * m[kQ2K], m[kD];
  out.right *= radius_mm;
  if (!options.matrix) return out;
  // n2 n2 = 1 - n1 n1; s - foot then takes the place of s.
  const double m22 = n - m[kM11], sm22 = m[kS] - m[kSM11], ssm22 = m[kSS] - m[kSSM11];
  const auto once = [&](double s, double one) { return s - foot * one; };
  const auto twice = [&](double ss, double s, double one) {
    return ss - foot * (2.0 * s - foot * one);
  };
  const double s11 = once(m[kSM11], m[kM11]), s12 = once(m[kSM12], m[kM12]), s22 = once(sm22, m22);
  const double t11 = twice(m[kSSM11], m[kSM11], m[kM11]);
  const double t12 = twice(m[kSSM12], m[kSM12], m[kM12]);
  const double t22 = twice(ssm22, sm22, m22);
  const double s1 = once(m[kSN1], m[kN1]), s2 = once(m[kSN2], m[kN2]);
  out.lever = std::sqrt(t11 + t22);
  out.across_mm = Eigen::Vector2d(m[kN1], m[kN2]) * (radius_mm / n);
  out.matrix << m[kM11], m[kM12], s11, s12, m[kN1],  //
      m[kM12], m22, s12, s22, m[kN2],                //
      s11, s12, t11, t12, s1,                        //
      s12, s22, t12, t22, s2,                        //
      m[kN1], m[kN2], s1, s2, n;
  return out;
}

PassSums<3> circle_sums(PlanePoints points_mm, const Eigen::Vector2d& origin_mm,
                        const Eigen::Vector2d& center_mm, double radius_mm,
                        const PassOptions& options) {
  using enum ls_kernel::Place;
  static_assert(sizeof(Eigen::Vector2d) == 2 * sizeof(double));
  PassSums<3> out;
  out.squares = std::numeric_limits<double>::infinity();
  if (!(radius_mm > 0.0)) return out;
  const ls_kernel::Kernel& kernel = kernel_for(options.simd);
  Pass pass{points_mm.front().data(),
            2,
            options.matrix ? kernel.circle_all : kernel.circle_gradient,
            {},
            radius_mm,
            options.extremes};
  pass.spot.origin[0] = origin_mm.x();
  pass.spot.origin[1] = origin_mm.y();
  pass.spot.row1[0] = 1.0 / radius_mm;
  pass.spot.shift1 = center_mm.x() / radius_mm;
  pass.spot.shift2 = center_mm.y() / radius_mm;
  const ls_kernel::Sums raw = total(pass, 0, points_mm.size());
  const double* m = raw.sum;
  const auto n = static_cast<double>(points_mm.size());
  out.squares = radius_mm * radius_mm * m[kDD];
  out.right << m[kQ1K], m[kQ2K], m[kD];
  out.right *= radius_mm;
  if (!options.matrix) return out;
  out.matrix << m[kM11], m[kM12], m[kN1],  //
      m[kM12], n - m[kM11], m[kN2],        //
      m[kN1], m[kN2], n;
  return out;
}

}  // namespace rondure::fit
