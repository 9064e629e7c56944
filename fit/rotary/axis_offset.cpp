#include "fit/rotary/axis_offset.h"

#include <cmath>
#include <complex>

#include <Eigen/LU>

#include "core/units.h"
#include "fit/geometry/axis.h"
#include "fit/profiles/internal/dft.h"

namespace rondure::fit {
namespace {

using PlaneFrame = Eigen::Matrix<double, 3, 2>;

/// Weights of the stations: c = sum of to_c tau, d = sum of to_d tau.
struct Estimator {
  std::vector<Complex> to_c;
  std::vector<Complex> to_d;
};

/// Complex least squares of tau = c + (1 - z) d, with z taken about its mean, which decouples the
/// sum from d.
Estimator estimator_of(const std::vector<Complex>& z) {
  const auto n = static_cast<double>(z.size());
  Complex mean = 0.0;
  for (const Complex& one : z) mean += one / n;
  double squares = 0.0;
  for (const Complex& one : z) squares += std::norm(one - mean);
  Estimator out;
  for (const Complex& one : z) {
    out.to_d.push_back(-std::conj(one - mean) / squares);
    out.to_c.push_back(1.0 / n - (1.0 - mean) * out.to_d.back());
  }
  return out;
}

struct OffsetPart {
  Eigen::Vector3d constant = Eigen::Vector3d::Zero();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  Eigen::Vector3d offset_u = Eigen::Vector3d::Zero();
};

/// The offset of t (first = 0) or of w (first = 3).
OffsetPart part_of(const RotaryTable& table, const Estimator& estimator, const PlaneFrame& plane,
                   Eigen::Index first) {
  Complex constant = 0.0;
  Complex offset = 0.0;
  // The noise of the reference pose turns with the body and so acts as a d of the opposite sign.
  Eigen::Matrix2d covariance =
      plane.transpose() * table.reference_covariance.block<3, 3>(first, first) * plane;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const Eigen::Vector2d v = plane.transpose() * table.rows[i].errors.segment<3>(first);
    const Complex tau(v.x(), v.y());
    constant += estimator.to_c[i] * tau;
    offset += estimator.to_d[i] * tau;
    const Complex g = estimator.to_d[i];
    Eigen::Matrix2d turn;
    turn << g.real(), -g.imag(), g.imag(), g.real();
    covariance += turn * plane.transpose() * table.rows[i].covariance.block<3, 3>(first, first) *
                  plane * turn.transpose();
  }
  OffsetPart out;
  out.constant = plane * Eigen::Vector2d(constant.real(), constant.imag());
  out.offset = plane * Eigen::Vector2d(offset.real(), offset.imag());
  out.offset_u = (plane * covariance * plane.transpose()).diagonal().cwiseMax(0.0).cwiseSqrt();
  return out;
}

}  // namespace

core::Result<AxisOffset> axis_offset(const RotaryTable& table) {
  if (table.rows.size() < 3) {
    return core::fail_with(core::Code::kTooFewPoints,
                           "{} stations do not give the place of the axis, at least 3 are needed",
                           table.rows.size());
  }
  AxisOffset out;
  const double span = table.rows.back().angle_rad - table.rows.front().angle_rad;
  out.arc_rad = table.full_circle ? core::kTwoPi : span;
  if (out.arc_rad < 45.0 * core::kDegree - 1e-9) {
    return core::fail_with(
        core::Code::kShortArc,
        "the stations span {:.1f} deg, at least 45 deg are needed to tell the place of the axis "
        "from its motion errors; their sum is known and is what compensation needs",
        out.arc_rad / core::kDegree);
  }
  std::vector<Complex> z;
  Complex mean = 0.0;
  for (const RotaryTableRow& row : table.rows) {
    z.push_back(std::polar(1.0, row.angle_rad - table.reference_rad));
    mean += z.back() / static_cast<double>(table.rows.size());
  }
  out.arc_factor = 1.0 / std::sqrt(1.0 - std::norm(mean));
  const PlaneFrame plane = across(table.axis.direction);
  const Estimator estimator = estimator_of(z);
  const OffsetPart t = part_of(table, estimator, plane, 0);
  const OffsetPart w = part_of(table, estimator, plane, 3);
  out.d_mm = t.offset;
  out.d_u_mm = t.offset_u;
  out.c_mm = t.constant;
  out.e_rad = w.offset;
  out.e_u_rad = w.offset_u;
  out.c_rad = w.constant;
  for (const RotaryTableRow& row : table.rows) {
    out.zero_point_rad +=
        row.errors.tail<3>().dot(table.axis.direction) / static_cast<double>(table.rows.size());
  }
  out.axis.origin_mm = table.axis.origin_mm + out.d_mm;
  out.axis.direction = (table.axis.direction + out.e_rad.cross(table.axis.direction)).normalized();
  return out;
}

}  // namespace rondure::fit
