#include "fit/datums/datum_axis.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/decompositions.h"
#include "fit/geometry/column_extremes.h"
#include "fit/geometry/frames.h"
#include "fit/least_squares/cylinder.h"
#include "fit/least_squares/internal/gauss_newton.h"
#include "fit/references/one_sided.h"
#include "fit/zone/internal/coupled_zone.h"

namespace rondure::fit {
namespace {

/// Share of the one-sided optimum [mm] within which positions count as equally good.
constexpr double kRockTolerance = 1e-5;

/// The points of all features, relative to their mean.
struct DatumPoints {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> points;
  std::vector<CoupledBound> features;  ///< Rows of each feature; upper: a shaft.
};

core::Result<DatumPoints> gathered(std::span<const DatumCylinder> features) {
  if (features.empty()) {
    return core::fail(core::Code::kNoPoints, "there is no datum feature; at least one is needed");
  }
  DatumPoints out;
  for (std::size_t f = 0; f < features.size(); ++f) {
    const SpacePoints points = features[f].points_mm;
    if (auto checked = check_points(points); !checked) {
      return core::fail_with(checked.error().code, "datum feature {}: {}", f, checked.error().what);
    }
    const std::size_t begin = out.points.size();
    out.points.insert(out.points.end(), points.begin(), points.end());
    out.features.push_back({begin, out.points.size(), !features[f].inside});
  }
  out.origin = mean_point(out.points);
  for (Eigen::Vector3d& p : out.points) p -= out.origin;
  return out;
}

/// An axis about which the distances of all points are measured.
struct AxisModel {
  static constexpr int kUnknowns = 4;
  const DatumPoints* data;
  CylinderFrame frame;

  [[nodiscard]] double value(std::size_t i) const { return frame.distance(data->points[i]); }
  [[nodiscard]] std::pair<double, Eigen::Vector4d> slope(std::size_t i) const {
    const Eigen::Vector3d v = data->points[i] - frame.axis().point_mm;
    const Eigen::Vector2d q = frame.across_axis().transpose() * v;
    const double r = q.norm();
    const Eigen::Vector2d n = r > 0.0 ? Eigen::Vector2d(-q / r) : Eigen::Vector2d::Zero();
    Eigen::Vector4d gradient;
    gradient << n, v.dot(frame.axis().direction) / frame.half_length_mm() * n;
    return {r, gradient};
  }
  [[nodiscard]] MeasuredRow row(std::size_t i) const {
    const auto exact = frame.contact_row(data->points[i], i);
    return {exact.distance, exact.gradient, exact.hessian};
  }
  [[nodiscard]] AxisModel moved(const Eigen::VectorXd& step) const {
    return {data, frame.moved(Eigen::Vector4d(step))};
  }
  [[nodiscard]] bool strayed(const AxisModel& from) const {
    return frame.strayed(from.frame, from.scale_mm());
  }
  [[nodiscard]] double scale_mm() const {
    return extremes_of(data->points, [&](const auto& p) { return frame.distance(p); }).high;
  }
};

/// The axis with the least sum of squared distances from the mean radius of each feature.
struct LsAxisModel {
  static constexpr int kUnknowns = 4;
  AxisModel at;

  [[nodiscard]] LsAxisModel moved(const Eigen::Vector4d& step) const { return {at.moved(step)}; }
  [[nodiscard]] double scale_mm() const { return at.scale_mm() + at.frame.half_length_mm(); }
};

NormalSums<4> axis_sums(const LsAxisModel& model) {
  NormalSums<4> out;
  for (const CoupledBound& feature : model.at.data->features) {
    double mean = 0.0;
    Eigen::Vector4d slope = Eigen::Vector4d::Zero();
    const double share = 1.0 / static_cast<double>(feature.end - feature.begin);
    for (std::size_t i = feature.begin; i < feature.end; ++i) {
      const auto [distance, gradient] = model.at.slope(i);
      mean += share * distance;
      slope += share * gradient;
    }
    for (std::size_t i = feature.begin; i < feature.end; ++i) {
      const auto [distance, gradient] = model.at.slope(i);
      const Eigen::Vector4d g = gradient - slope;
      const double residual = distance - mean;
      out.matrix += g * g.transpose();
      out.right -= residual * g;
      out.squares += residual * residual;
    }
  }
  return out;
}

core::Result<Eigen::Vector3d> start_direction(const DatumPoints& data) {
  const auto mean = [&](const CoupledBound& f) {
    return mean_point(SpacePoints(data.points).subspan(f.begin, f.end - f.begin));
  };
  const Eigen::Vector3d apart = mean(data.features.back()) - mean(data.features.front());
  if (apart.norm() > 0.0) return apart.normalized();
  return core::fail(core::Code::kRank,
                    "the datum features have one mean, so that no line leads from one to the "
                    "other: a start direction is needed");
}

/// The least-squares axis, from which all other associations start.
core::Result<AxisModel> ls_axis(const DatumPoints& data,
                                const std::optional<Eigen::Vector3d>& near_direction) {
  Axis axis;
  if (data.features.size() == 1) {
    TRY(const auto cylinder, ls_cylinder(data.points, near_direction));
    axis = cylinder.axis;
  } else if (near_direction) {
    axis.direction = near_direction->normalized();
  } else {
    TRY(axis.direction, start_direction(data));
  }
  const double half = half_extent(data.points, axis.direction);
  LsAxisModel model{{&data, CylinderFrame(axis, half > 0.0 ? half : 1.0)}};
  double squares = 0.0;
  const auto sums_at = [](const LsAxisModel& at, bool /*matrix*/) { return axis_sums(at); };
  const bool settled = settle(model, squares, sums_at);
  // One section leaves the tilt open: every axis through its centre is as good.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> principal(axis_sums(model).matrix);
  if (principal.eigenvalues()(0) <= 1e-9 * principal.eigenvalues()(3)) {
    return core::fail(core::Code::kRank,
                      "the datum features do not fix the axis: two sections apart from each other "
                      "are needed, each all round");
  }
  if (!settled) {
    return core::fail(core::Code::kNotConverged, "the least-squares datum axis did not settle");
  }
  // The scale of the tilts is the greatest height from the place of the axis.
  const double longest = extremes_of(data.points, [&](const auto& p) {
                           return std::abs(p.dot(model.at.frame.axis().direction));
                         }).high;
  Axis found = model.at.frame.axis();
  found.point_mm -= found.point_mm.dot(found.direction) * found.direction;
  return AxisModel{&data, CylinderFrame(found, longest)};
}

DatumAxis stated_datum(const DatumPoints& data, const AxisModel& model) {
  DatumAxis out;
  Axis axis = model.frame.axis();
  axis.point_mm += data.origin;
  out.axis = conventional(axis, data.origin);
  return out;
}

DatumAxis ls_datum(const DatumPoints& data, const AxisModel& model) {
  DatumAxis out = stated_datum(data, model);
  for (const CoupledBound& f : data.features) {
    double mean = 0.0;
    for (std::size_t i = f.begin; i < f.end; ++i) mean += model.value(i);
    out.radii_mm.push_back(mean / static_cast<double>(f.end - f.begin));
  }
  out.ending = ZoneEnding::kConverged;
  return out;
}

/// The one-sided datum: a bound for each feature; the zone: a second one on the other side.
core::Result<DatumAxis> coupled_datum(const DatumPoints& data, const AxisModel& start, bool both) {
  std::vector<CoupledBound> bounds = data.features;
  if (both) {
    for (CoupledBound bound : data.features) {
      bound.upper = !bound.upper;
      bounds.push_back(bound);
    }
  }
  const auto zone = CoupledDescent<AxisModel>(start, bounds).run();
  if (zone.ending == ZoneEnding::kStrayed) {
    return core::fail(core::Code::kReferenceAbsent,
                      "the datum cylinder grows without bound: the points do not surround the "
                      "axis; measure the feature all round, or plan a least-squares datum");
  }
  DatumAxis out = stated_datum(data, zone.model);
  out.ending = zone.rests ? ZoneEnding::kConverged : zone.ending;
  const auto count = static_cast<Eigen::Index>(data.features.size());
  for (Eigen::Index f = 0; f < count; ++f) {
    out.radii_mm.push_back(both ? 0.5 * (zone.bounds(f) + zone.bounds(f + count)) : zone.bounds(f));
  }
  for (const CoupledContact& c : zone.contacts) out.contacts.push_back({c.row, c.multiplier});
  std::ranges::sort(out.contacts, {}, &Contact::index);
  return out;
}

/// The one-sided limits s (R_f - d_i - J_i x) >= 0 about an axis, with the unknowns x and R_f -
/// radius_f, and a last row that a caller may fill.
struct LinearLimits {
  Eigen::MatrixXd normals;
  Eigen::VectorXd limits;
  Eigen::VectorXd sum;  ///< Gradient of the sum of radii, bores negative.

  LinearLimits(const DatumPoints& data, const AxisModel& at, const Eigen::VectorXd& radii) {
    const auto rows = static_cast<Eigen::Index>(data.points.size());
    const Eigen::Index unknowns = 4 + radii.size();
    normals = Eigen::MatrixXd::Zero(rows + 1, unknowns);
    limits = Eigen::VectorXd::Zero(rows + 1);
    sum = Eigen::VectorXd::Zero(unknowns);
    for (Eigen::Index f = 0; f < radii.size(); ++f) {
      const CoupledBound& feature = data.features[static_cast<std::size_t>(f)];
      sum(4 + f) = feature.sign();
      for (std::size_t i = feature.begin; i < feature.end; ++i) {
        const auto [distance, gradient] = at.slope(i);
        const auto row = static_cast<Eigen::Index>(i);
        normals.row(row).head<4>() = -feature.sign() * gradient.transpose();
        normals(row, 4 + f) = feature.sign();
        limits(row) = feature.sign() * (distance - radii(f));
      }
    }
  }
  /// Limits the sum of the radii: sum' x <= most.
  void limit_sum(double most) {
    normals.row(normals.rows() - 1) = -sum.transpose();
    limits(limits.size() - 1) = -most;
  }
};

/// Minimises a linear function by quadratic programmes with a proximal term. A step is as long as
/// the function falls, times the reach; a datum that rocks falls by 1e-7 per mm only.
/// @return The least value; nothing if it is unbounded.
std::optional<double> least_linear(const LinearLimits& from, const Eigen::VectorXd& gradient,
                                   double round_off) {
  constexpr int kSteps = 1000;
  constexpr double kReach = 1e3;     // mm; rounds a step by 1e-13 mm
  constexpr double kNoFall = 1e-15;  // mm; what is left is below 1e-9 of the way
  constexpr double kBeyond = 1e4;    // mm
  Eigen::VectorXd x = Eigen::VectorXd::Zero(gradient.size());
  const Eigen::MatrixXd hessian =
      Eigen::MatrixXd::Identity(gradient.size(), gradient.size()) / kReach;
  for (int i = 0; i < kSteps; ++i) {
    const auto step = solve_quadratic_program(hessian, gradient, from.normals,
                                              from.limits - from.normals * x, 4.0 * round_off);
    if (!step.solved) return std::nullopt;
    x += step.x;
    if (x.cwiseAbs().maxCoeff() > kBeyond) return std::nullopt;
    // The first step may also rise, from a place that does not obey the limits.
    if (i > 0 && gradient.dot(step.x) >= -kNoFall) return gradient.dot(x);
  }
  return std::nullopt;
}

Eigen::VectorXd mean_radii(const DatumPoints& data, const AxisModel& at) {
  const auto radii = ls_datum(data, at).radii_mm;
  return Eigen::Map<const Eigen::VectorXd>(radii.data(), static_cast<Eigen::Index>(radii.size()));
}

double linear_round_off(const AxisModel& at) {
  return 64.0 * std::numeric_limits<double>::epsilon() * at.scale_mm();
}

core::Error unbounded_datum() {
  return {core::Code::kReferenceAbsent,
          "the datum features do not surround the axis to first order: measure them all round, or "
          "plan a least-squares datum"};
}

/// The optimal sum of the signed radii to first order.
core::Result<double> first_order_sum(const DatumPoints& data, const AxisModel& at) {
  const Eigen::VectorXd radii = mean_radii(data, at);
  const LinearLimits limits(data, at, radii);
  const auto least = least_linear(limits, limits.sum, linear_round_off(at));
  if (!least) return core::fail(unbounded_datum());
  return limits.sum.tail(radii.size()).dot(radii) + *least;
}

/// Equalised datum: quadratic programmes with exact distances about the last axis; the squares have
/// the matrix of least squares, so that each step reduces the error to a share of form / radius.
core::Result<DatumAxis> equalised_datum(const DatumPoints& data, AxisModel at) {
  constexpr int kSteps = 60;
  constexpr double kAtRest = 1e-8;  // mm
  TRY(const auto sum, first_order_sum(data, at));
  Eigen::VectorXd radii = mean_radii(data, at);
  DatumAxis out;
  const double round_off = linear_round_off(at);
  double last = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kSteps && out.ending != ZoneEnding::kConverged; ++i) {
    LinearLimits limits(data, at, radii);
    limits.limit_sum(sum + kRockTolerance - limits.sum.tail(radii.size()).dot(radii));
    // A limit holds s (R_f - d_i); its square is that of the residual.
    const auto residuals = limits.normals.topRows(limits.normals.rows() - 1);
    const Eigen::MatrixXd hessian = residuals.transpose() * residuals;
    const Eigen::VectorXd gradient = -residuals.transpose() * limits.limits.head(residuals.rows());
    const auto step =
        solve_quadratic_program(hessian, gradient, limits.normals, limits.limits, round_off);
    if (!step.solved) return core::fail(unbounded_datum());
    at = at.moved(step.x.head<4>());
    radii += step.x.tail(radii.size());
    // Where many points touch alike, round-off exchanges contacts and the steps stop shrinking.
    const double size = step.x.cwiseAbs().maxCoeff();
    const bool rests = size <= round_off || (size <= kAtRest && size >= 0.5 * last);
    last = size;
    if (!rests) continue;
    out.ending = ZoneEnding::kConverged;
    for (std::size_t k = 0; k < step.active.size(); ++k) {
      if (step.active[k] == data.points.size()) continue;  // the limit of the sum
      out.contacts.push_back({step.active[k], step.multipliers[k]});
    }
  }
  out.axis = stated_datum(data, at).axis;
  out.radii_mm.assign(radii.begin(), radii.end());
  std::ranges::sort(out.contacts, {}, &Contact::index);
  return out;
}

}  // namespace

core::Result<DatumAxis> datum_axis(std::span<const DatumCylinder> features,
                                   DatumAssociation association,
                                   const std::optional<Eigen::Vector3d>& near_direction) {
  TRY(const auto data, gathered(features));
  TRY(const auto start, ls_axis(data, near_direction));
  switch (association) {
    case DatumAssociation::kLeastSquares:
      return ls_datum(data, start);
    case DatumAssociation::kEqualised:
      return equalised_datum(data, start);
    case DatumAssociation::kZone:
      return coupled_datum(data, start, true);
    case DatumAssociation::kOneSided:
      break;
  }
  return coupled_datum(data, start, false);
}

core::Result<DatumRock> datum_rock(std::span<const DatumCylinder> features,
                                   const std::optional<Eigen::Vector3d>& near_direction) {
  TRY(const auto data, gathered(features));
  TRY(const auto at, ls_axis(data, near_direction));
  TRY(const auto sum, first_order_sum(data, at));
  const Eigen::VectorXd radii = mean_radii(data, at);
  LinearLimits limits(data, at, radii);
  limits.limit_sum(sum + kRockTolerance - limits.sum.tail(radii.size()).dot(radii));
  DatumRock out;
  out.sum_mm = sum;
  for (const Eigen::Index tilt : {2, 3}) {
    double range = 0.0;
    for (const double sign : {1.0, -1.0}) {
      const Eigen::VectorXd gradient = sign * Eigen::VectorXd::Unit(limits.sum.size(), tilt);
      const auto least = least_linear(limits, gradient, linear_round_off(at));
      if (!least) return core::fail(unbounded_datum());
      range -= *least;
    }
    out.play_mm = std::max(out.play_mm, 2.0 * range);
  }
  return out;
}

core::Result<DatumAxis> datum_axis_square_to(const Plane& primary, const DatumCylinder& feature) {
  TRY_DO(check_points(feature.points_mm));
  const Eigen::Vector3d mean = mean_point(feature.points_mm);
  const auto frame = across(primary.normal);
  std::vector<Eigen::Vector2d> flat;
  for (const Eigen::Vector3d& p : feature.points_mm) {
    flat.emplace_back(frame.transpose() * (p - mean));
  }
  TRY(const auto circle,
      feature.inside ? max_inscribed_circle(flat) : min_circumscribed_circle(flat));
  DatumAxis out;
  out.axis = conventional({mean + frame * circle.center_mm, primary.normal}, mean);
  out.radii_mm = {circle.radius_mm};
  out.contacts = circle.contacts;
  out.ending = ZoneEnding::kConverged;
  return out;
}

}  // namespace rondure::fit
