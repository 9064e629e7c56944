#include "fit/least_squares/cone.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/decompositions.h"
#include "core/units.h"
#include "fit/geometry/internal/cone_frame.h"
#include "fit/least_squares/internal/gauss_newton.h"
#include "fit/least_squares/internal/start_directions.h"

namespace rondure::fit {
namespace {

constexpr double kHalfTurn = 0.5 * core::kTwoPi;
constexpr double kLeastHalfAngle = 0.05 * core::kDegree;
/// Points of one section spread less along the generatrix than a section may be thick.
constexpr double kOneSection = 0.5;  // mm

/// The cone with the least sum of squares for its axis and angle: the offset is the mean distance.
struct ConeLsModel {
  static constexpr int kUnknowns = ConeFrame::kUnknowns;
  ConeFrame frame;

  [[nodiscard]] ConeLsModel moved(const ConeFrame::Step& step) const { return {frame.moved(step)}; }
  [[nodiscard]] double scale_mm() const { return frame.length_mm(); }
};

NormalSums<5> cone_sums(SpacePoints points, const ConeFrame& at) {
  const double share = 1.0 / static_cast<double>(points.size());
  double mean = 0.0;
  ConeFrame::Step mean_slope = ConeFrame::Step::Zero();
  for (const Eigen::Vector3d& p : points) {
    const auto [value, slope] = at.slope(p);
    mean += share * value;
    mean_slope += share * slope;
  }
  NormalSums<5> out;
  for (const Eigen::Vector3d& p : points) {
    const auto [value, slope] = at.slope(p);
    const ConeFrame::Step g = slope - mean_slope;
    out.matrix += g * g.transpose();
    out.right -= (value - mean) * g;
    out.squares += (value - mean) * (value - mean);
  }
  return out;
}

/// The cone next to a direction that is linear in its unknowns. With the centre c + h d of the
/// circle at the height h, |q|^2 = 2 c.q + 2 h d.q + a h^2 + b h + g; the radii about these centres
/// give the taper, and that gives the tilt of the axis to which the centres belong.
/// @param points  Relative to their mean.
ConeFrame algebraic_cone(SpacePoints points, const Eigen::Vector3d& direction, double length) {
  const auto frame = across(direction);
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(7, 7);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(7);
  Eigen::VectorXd row(7);
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector2d q = frame.transpose() * p / length;
    const double h = direction.dot(p) / length;
    row << 2.0 * q, 2.0 * h * q, h * h, h, 1.0;
    normal += row * row.transpose();
    right += q.squaredNorm() * row;
  }
  // Two sections leave the term h^2 open; the others do not change with it.
  const Eigen::VectorXd x = core::solve_pivoted_qr(normal, right);
  const Eigen::Vector2d center = length * x.head<2>();
  const Eigen::Vector2d drift = x.segment<2>(2);
  double hh = 0.0, he = 0.0, mean_h = 0.0, mean_e = 0.0;
  const double share = 1.0 / static_cast<double>(points.size());
  for (const Eigen::Vector3d& p : points) {
    const double h = direction.dot(p);
    const double e = (frame.transpose() * p - center - h * drift).norm();
    mean_h += share * h;
    mean_e += share * e;
    hh += share * h * h;
    he += share * h * e;
  }
  const double spread = hh - mean_h * mean_h;
  const double taper = spread > 0.0 ? (he - mean_h * mean_e) / spread : 0.0;
  const Eigen::Vector2d tilt = drift / (1.0 + taper * taper);
  const double radius = mean_e - taper * mean_h;
  return ConeFrame(
      {frame * (center - radius * taper * tilt), (direction + frame * tilt).normalized()},
      std::atan(taper), length);
}

struct SettledCone {
  ConeLsModel model;
  double squares = 0.0;
};

core::Result<SettledCone> settle_cone(SpacePoints points, const Eigen::Vector3d& direction,
                                      double length) {
  constexpr int kAlgebraic = 3;  // each removes most of the tilt left by the one before
  Eigen::Vector3d along = direction;
  for (int i = 1; i < kAlgebraic; ++i) {
    along = algebraic_cone(points, along, length).axis().direction;
  }
  SettledCone out{{algebraic_cone(points, along, length)}, 0.0};
  const auto sums_at = [&](const ConeLsModel& at, bool /*matrix*/) {
    return cone_sums(points, at.frame);
  };
  if (settle(out.model, out.squares, sums_at)) return out;
  return core::fail(core::Code::kNotConverged, "the least-squares cone did not settle");
}

core::Result<SettledCone> best_cone(SpacePoints points, double length,
                                    const std::optional<Eigen::Vector3d>& near_direction) {
  if (near_direction) return settle_cone(points, near_direction->normalized(), length);
  const auto starts = start_directions(
      points, [&](SpacePoints sample, const Eigen::Vector3d& direction) -> std::optional<double> {
        const double squares = cone_sums(sample, algebraic_cone(sample, direction, length)).squares;
        if (!std::isfinite(squares)) return std::nullopt;
        return std::sqrt(squares / static_cast<double>(sample.size()));
      });
  core::Result<SettledCone> best =
      core::fail(core::Code::kNotConverged, "the least-squares cone did not settle");
  for (const Eigen::Vector3d& direction : starts) {
    auto settled = settle_cone(points, direction, length);
    if (!best || (settled && settled->squares < best->squares)) best = std::move(settled);
  }
  return best;
}

core::Result<void> check_cone(SpacePoints points, const ConeFrame& cone) {
  const Eigen::Vector3d& axis = cone.axis().direction;
  const Extremes along = extremes_of(points, [&](const Eigen::Vector3d& p) {
    return (p - cone.axis().point_mm).dot(axis) * std::cos(cone.half_angle_rad()) +
           distance_mm(cone.axis(), p) * std::sin(cone.half_angle_rad());
  });
  if (!(along.width() > kOneSection)) {
    return core::fail_with(core::Code::kRank,
                           "the points spread {:.3g} mm along the generatrix of the cone, as those "
                           "of one section: measure at least two sections more than {:g} mm apart",
                           along.width(), kOneSection);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> principal(
      Eigen::MatrixXd(cone_sums(points, cone).matrix));
  if (principal.eigenvalues()(0) <= 1e-9 * principal.eigenvalues()(4)) {
    return core::fail(core::Code::kRank,
                      "the points do not fix the axis of the cone: measure at least two sections, "
                      "each all round");
  }
  const double half = std::abs(cone.half_angle_rad());
  if (half >= kLeastHalfAngle && half <= 0.5 * kHalfTurn - kLeastHalfAngle) return {};
  return core::fail_with(
      core::Code::kOutOfRange,
      "the half angle is {:.4g} deg, that of a cone 0.05 to 89.95 deg: plan the feature as a {}",
      core::degrees(half), half < kLeastHalfAngle ? "cylinder" : "plane");
}

}  // namespace

double Cone::diameter_mm(double height_mm) const {
  const double half = 0.5 * full_angle_rad;
  return 2.0 * (offset_mm + height_mm * std::sin(half)) / std::cos(half);
}

double Cone::deviation_mm(const Eigen::Vector3d& point_mm) const {
  return ConeFrame(axis, 0.5 * full_angle_rad, 1.0).distance(point_mm) - offset_mm;
}

core::Result<LsCone> ls_cone(SpacePoints points_mm,
                             const std::optional<Eigen::Vector3d>& near_direction) {
  constexpr std::size_t kFewest = 6;
  TRY_DO(check_points(points_mm));
  const std::size_t different = distinct_points(points_mm, kFewest);
  if (different < kFewest) {
    return core::fail_with(core::Code::kTooFewPoints,
                           "a cone needs at least {} different points, there are {}", kFewest,
                           different);
  }
  const Eigen::Vector3d mean = mean_point(points_mm);
  std::vector<Eigen::Vector3d> points;
  double length = 0.0;
  for (const Eigen::Vector3d& p : points_mm) {
    points.emplace_back(p - mean);
    length = std::max(length, points.back().norm());
  }
  TRY(const auto settled, best_cone(points, length, near_direction));
  // A step over 90 deg leads to the same surface with the other sign.
  const ConeFrame& found = settled.model.frame;
  const double half = std::remainder(found.half_angle_rad(), kHalfTurn);
  Axis axis = conventional(found.axis(), Eigen::Vector3d::Zero());
  const double opens = axis.direction.dot(found.axis().direction) < 0.0 ? -half : half;
  const ConeFrame cone(axis, opens, length);
  TRY_DO(check_cone(points, cone));
  LsCone out;
  const double count = static_cast<double>(points.size());
  Extremes range;
  double sum = 0.0;
  for (const Eigen::Vector3d& p : points) {
    const double value = cone.distance(p);
    range.take(value);
    sum += value;
  }
  out.cone.offset_mm = sum / count;
  axis.point_mm += mean;
  out.cone.axis = axis;
  out.cone.full_angle_rad = 2.0 * opens;
  out.deviation_mm = range.width();
  out.rms_mm = std::sqrt(settled.squares / count);
  return out;
}

}  // namespace rondure::fit
