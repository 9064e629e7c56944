#include "fit/wheel/wheel.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "core/statistics.h"
#include "fit/geometry/column_extremes.h"
#include "fit/wheel/loss.h"

namespace rondure::fit {
namespace {

using Points = std::vector<Eigen::Vector2d>;

constexpr std::size_t kLeastPoints = 8;
constexpr double kSamePoint = 1e-3;  ///< mm
constexpr double kLeastArc = 20.0 * core::kDegree;
constexpr double kShortArc = 90.0 * core::kDegree;
constexpr double kLeastRadius = 0.5;        ///< mm; less suggests metres
constexpr double kGreatestRadius = 1000.0;  ///< mm; more suggests micrometres
constexpr double kNominalShare = 0.05;

core::Result<void> check_distinct(PlanePoints points_mm) {
  Points found;
  for (const Eigen::Vector2d& p : points_mm) {
    const bool seen =
        std::ranges::any_of(found, [&](const auto& q) { return (p - q).norm() <= kSamePoint; });
    if (!seen) found.push_back(p);
    if (found.size() == kLeastPoints) return {};
  }
  return core::fail_with(core::Code::kTooFewPoints,
                         "{} of {} points are more than {} mm apart; a wheel needs at least {}",
                         found.size(), points_mm.size(), kSamePoint, kLeastPoints);
}

core::Result<void> check_radius(double radius_mm, const WheelOptions& options) {
  if (radius_mm < kLeastRadius || radius_mm > kGreatestRadius) {
    const bool large = radius_mm > kGreatestRadius;
    return core::fail_with(core::Code::kUnits,
                           "the radius is {:.6g} mm, outside {} to {} mm: are the coordinates in "
                           "{}? Give x and z in mm",
                           radius_mm, kLeastRadius, kGreatestRadius, large ? "um" : "m");
  }
  if (!options.nominal_radius_mm) return {};
  const double nominal = *options.nominal_radius_mm;
  if (std::abs(radius_mm - nominal) <= kNominalShare * nominal) return {};
  return core::fail_with(core::Code::kOutOfRange,
                         "the radius is {:.6g} mm, {:.3g} % off the nominal {:.6g} mm; the limit "
                         "is 5 %: another wheel, or another unit?",
                         radius_mm, 100.0 * std::abs(radius_mm / nominal - 1.0), nominal);
}

core::Result<void> check_options(const WheelOptions& options) {
  if (options.axis_mm && options.mode == WheelMode::kEnvelope) {
    return core::fail(core::Code::kMeaning,
                      "run-out cannot be stated in envelope mode: the turning wheel shows the "
                      "circle it sweeps about its axis; measure it indexed, or give no axis");
  }
  if (options.axis_mm && !check_points(std::span(&*options.axis_mm, 1))) {
    return core::fail(core::Code::kBadOption,
                      "the spindle axis is not a finite point within 1e7 mm");
  }
  if (options.errors) {
    const WheelPointErrors& e = *options.errors;
    for (const double u : {e.point_mm, e.scale_1, e.threshold_mm, e.wear_mm}) {
      if (u >= 0.0 && std::isfinite(u)) continue;
      return core::fail_with(core::Code::kBadOption,
                             "a declared error of the points is {}; 0 or more is needed", u);
    }
  }
  if (options.nominal_radius_mm && !(*options.nominal_radius_mm > 0.0)) {
    return core::fail_with(core::Code::kBadOption, "the nominal radius is {} mm; above 0 is needed",
                           *options.nominal_radius_mm);
  }
  return {};
}

core::Result<void> check_arc(PlanePoints points, const LsCircle& circle,
                             const WheelOptions& options) {
  const AngularOrder order = angular_order(points, circle.center_mm);
  if (order.coverage_rad() >= kLeastArc || options.allow_short_arc) return {};
  const double factor = circle_factors(order.angles_rad).center;
  return core::fail_with(
      core::Code::kShortArc,
      "the points cover {:.2f} deg of the circle, at least 20 deg are needed: {}",
      order.coverage_rad() / core::kDegree,
      std::isfinite(factor)
          ? fmt::format("a point error would show {:.1f} times in the centre", factor)
          : "they do not determine the centre");
}

/// Makes the checks that are possible before quadruples are chosen.
core::Result<LsCircle> check_and_start(PlanePoints points_mm, const WheelOptions& options) {
  TRY_DO(check_options(options));
  if (points_mm.size() < kLeastPoints) {
    return core::fail_with(core::Code::kTooFewPoints,
                           "there are {} points, a wheel needs at least {}", points_mm.size(),
                           kLeastPoints);
  }
  TRY_DO(check_points(points_mm));
  TRY_DO(check_distinct(points_mm));
  const auto circle = ls_circle(points_mm);
  if (!circle) return circle;
  TRY_DO(check_arc(points_mm, *circle, options));
  TRY_DO(check_radius(circle->radius_mm, options));
  return circle;
}

Eigen::Vector2d combined(const WheelCenters& centers, WheelMean mean) {
  // Relative to the first centre, as sums of points far from the origin would lose digits.
  const Eigen::Vector2d origin = centers.accepted.front().center_mm;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double weights = 0.0;
  for (const FourPointCenter& c : centers.accepted) {
    const double weight = mean == WheelMean::kAsPublished ? 1.0 : 1.0 / (c.kappa * c.kappa);
    sum += weight * (c.center_mm - origin);
    weights += weight;
  }
  return origin + sum / weights;
}

/// Effect of unit noise along the radius of every point on the mean of the centres of quadruples
/// and on the mean distance from it. A point B of the chord AB moves its
/// bisector by the radius, A by the same amount in the opposite direction: a . dS = +-R.
CircleFactors quadruple_factors(const Points& used, const WheelMeasurement& m) {
  std::vector<Eigen::Vector2d> moves(used.size(), Eigen::Vector2d::Zero());
  const auto weights = static_cast<double>(m.centers.accepted.size());
  for (const FourPointCenter& c : m.centers.accepted) {
    const Eigen::Vector2d ab = used[c.rows[1]] - used[c.rows[0]];
    const Eigen::Vector2d cd = used[c.rows[3]] - used[c.rows[2]];
    const double scale = m.radius_mm / (ab.x() * cd.y() - ab.y() * cd.x());
    const Eigen::Vector2d by_ab(scale * cd.y(), -scale * cd.x());
    const Eigen::Vector2d by_cd(-scale * ab.y(), scale * ab.x());
    moves[c.rows[0]] -= by_ab;
    moves[c.rows[1]] += by_ab;
    moves[c.rows[2]] -= by_cd;
    moves[c.rows[3]] += by_cd;
  }
  const auto n = static_cast<double>(used.size());
  Eigen::Vector2d mean_direction = Eigen::Vector2d::Zero();
  for (const auto& p : used) mean_direction += (p - m.center_mm).normalized() / n;
  double center = 0.0;
  double radius = 0.0;
  for (const Eigen::Vector2d& move : moves) {
    center += move.squaredNorm() / (weights * weights);
    radius += std::pow(1.0 / n - mean_direction.dot(move) / weights, 2);
  }
  return {std::sqrt(center), std::sqrt(radius)};
}

/// Fills in centre, radius and related values from the points used.
void fill_circle(const Points& used, const std::optional<WheelPointErrors>& errors,
                 WheelMeasurement& out) {
  const bool least_squares = out.mean == WheelMean::kLeastSquares;
  out.quadruple_center_mm = combined(out.centers, out.mean);
  out.center_mm = least_squares ? out.check.center_mm : out.quadruple_center_mm;
  const auto n = static_cast<double>(used.size());
  std::vector<double> distances;
  for (const auto& p : used) distances.push_back((p - out.center_mm).norm());
  out.radius_mm = core::mean(distances);
  out.deviation_mm = column_extremes(distances).width();
  out.order = angular_order(used, out.center_mm);
  std::vector<double> residuals;
  double squares = 0.0;
  for (const std::size_t row : out.order.rows) {
    residuals.push_back(distances[row] - out.radius_mm);
    squares += residuals.back() * residuals.back();
  }
  out.spread_mm = std::sqrt(squares / (n - 3.0));
  out.factors = least_squares ? circle_factors(out.order.angles_rad) : quadruple_factors(used, out);
  out.correlation = correlation_time(residuals, out.order.closed());
  // The circle that a wheel sweeps has no lobes, unless its points say so.
  const bool lobed = out.mode == WheelMode::kIndexed || out.correlation > kCorrelationLimit;
  if (lobed && !out.order.even()) {
    out.lobes_in_radius_mm = lobes_in_radius_mm(out.order.angles_rad, residuals,
                                                errors ? errors->point_mm : out.spread_mm);
  }
  if (errors) {
    // The spread holds the form of the wheel as well; a declared error of a point does not.
    out.center_uncertainty_mm = errors->point_mm * out.factors.center;
    out.radius_uncertainty_mm = std::hypot(
        std::hypot(errors->point_mm * out.factors.radius, errors->scale_1 * out.radius_mm),
        errors->threshold_mm, errors->wear_mm);
    return;
  }
  const double one = out.spread_mm * std::sqrt(out.correlation);
  out.center_uncertainty_mm = one * out.factors.center;
  out.radius_uncertainty_mm = one * out.factors.radius;
}

void fill_scatter(WheelMeasurement& out) {
  double squares = 0.0;
  for (const FourPointCenter& c : out.centers.accepted) {
    const double distance = (c.center_mm - out.quadruple_center_mm).norm();
    squares += distance * distance;
    out.farthest_center_mm = std::max(out.farthest_center_mm, distance);
  }
  const auto k = static_cast<double>(out.centers.accepted.size());
  out.center_scatter_mm = std::sqrt(squares / (k - 1.0));
  out.expected_scatter_mm = out.spread_mm * out.centers.rms_kappa();
}

/// Compares both centres, and says why S and R prove nothing.
void check_center(WheelMeasurement& out) {
  constexpr double kSolved = 1e-4;  // mm; without noise the two agree within some 0.1 um
  constexpr double kCoverage = 3.0;
  const auto k = static_cast<double>(out.centers.accepted.size());
  const double of_quadruples = out.expected_scatter_mm / std::sqrt(k);
  out.center_apart_mm = (out.quadruple_center_mm - out.check.center_mm).norm();
  out.center_apart_limit_mm =
      kCoverage * std::hypot(out.center_uncertainty_mm, of_quadruples) + kSolved;
  const double best = out.centers.best_kappa();
  if (best > kWorstBestKappa) {
    out.radius_void_because = core::phrase(
        "the best four points amplify the error of a point {:.1f} times in the centre, the limit "
        "is "
        "{:g} times: measure more of the circle",
        best, kWorstBestKappa);
  } else if (out.center_apart_mm > out.center_apart_limit_mm) {
    out.radius_void_because = core::phrase(
        "the centre of the quadruples is {:.3f} um from that of least squares, more than three "
        "standard uncertainties, {:.3f} um: take more or better spread points",
        out.center_apart_mm / core::kMicrometre, out.center_apart_limit_mm / core::kMicrometre);
  }
}

void fill_runout(PlanePoints all, const WheelOptions& options, WheelMeasurement& out) {
  if (out.mode == WheelMode::kEnvelope) {
    out.runout_absent =
        core::phrase("envelope mode: the points lie on the circle swept about the axis");
    return;
  }
  if (!options.axis_mm) {
    out.runout_absent = core::phrase("the spindle axis is not given: roundness only");
    return;
  }
  const auto distance = [&](const Eigen::Vector2d& p) { return (p - *options.axis_mm).norm(); };
  const Extremes reach = extremes_of(all, distance);
  WheelRunout& found = out.runout.emplace();
  found.axis_mm = *options.axis_mm;
  found.fim_mm = reach.width();
  found.eccentricity_mm = (out.center_mm - *options.axis_mm).norm();
  found.effective_radius_mm = reach.high;
  if (!out.sees_whole_turn()) {
    found.bound_because = core::phrase(
        "the points leave {:.0f} deg of the turn unseen, more than {:.0f} deg: run-out is at least "
        "{:.3f} um; measure the whole turn",
        out.order.largest_gap_rad / core::kDegree, kWidestGap / core::kDegree,
        found.fim_mm / core::kMicrometre);
  }
}

void warn(WheelMeasurement& out) {
  const auto add = [&](core::Code code, std::string what) {
    out.warnings.push_back({code, std::move(what)});
  };
  const double coverage = out.order.coverage_rad();
  if (coverage < kShortArc) {
    add(core::Code::kShortArc,
        fmt::format("the points cover {:.1f} deg of the circle, less than 90 deg: a point error "
                    "shows {:.2f} times in the centre and {:.2f} times in the radius",
                    coverage / core::kDegree, out.factors.center, out.factors.radius));
  }
  const double apart = out.center_apart_mm;
  const double limit = 3.0 * out.centers.rms_kappa() * out.spread_mm /
                           std::sqrt(static_cast<double>(out.centers.accepted.size())) +
                       1e-4;
  if (apart > limit) {
    add(core::Code::kCenterDisagrees,
        fmt::format("the mean of the quadruples is {:.3f} um from the geometric least-squares "
                    "centre, more than noise explains ({:.3f} um): take more or better spread "
                    "points",
                    apart / core::kMicrometre, limit / core::kMicrometre));
  }
  if (out.mode == WheelMode::kIndexed && !out.runout) {
    add(core::Code::kNoAxis,
        "roundness only: radial run-out and the effective radius need the spindle axis");
  }
  constexpr double kSameAxis = 1e-4;  // mm; no spindle holds a wheel that well
  if (out.runout && out.runout->eccentricity_mm < kSameAxis) {
    add(core::Code::kNoAxis,
        "the stated axis is the centre of these points within 0.1 um: run-out about it is their "
        "roundness; state the axis of the spindle, not that of the wheel");
  }
  if (out.correlation > kCorrelationLimit) {
    add(core::Code::kCorrelated,
        fmt::format("neighbouring residuals are alike (tau {:.2f}, white noise 1.0 to 1.1): form "
                    "or wear, and u(R) is optimistic on a partial arc",
                    out.correlation));
  }
}

core::Result<Outliers> outliers_of(const OutlierOptions& options,
                                   const QuadrupleOptions& quadruples, const Points& used,
                                   const WheelMeasurement& out) {
  TRY(const auto all, select_centers(used, out.check.radius_mm, quadruples));
  return find_outliers(used, all.accepted, options);
}

/// Adds a warning that names the points that the robust variant would drop; they are kept.
void name_outliers(const OutlierOptions& options, const QuadrupleOptions& quadruples,
                   const Points& used, WheelMeasurement& out) {
  constexpr std::size_t kNamed = 5;
  const auto outliers = outliers_of(options, quadruples, used, out);
  if (!outliers) {
    if (outliers.error().code == core::Code::kOutliers) out.warnings.push_back(outliers.error());
    return;
  }
  for (const core::Error& warning : outliers->warnings) {
    if (warning.code == core::Code::kLocalForm) out.warnings.push_back(warning);
  }
  const std::vector<DroppedPoint>& gross = outliers->dropped;
  if (gross.empty()) return;
  std::string names;
  for (std::size_t i = 0; i < std::min(gross.size(), kNamed); ++i) {
    names += fmt::format("{}{} ({:+.2f} um)", i > 0 ? ", " : "", gross[i].row,
                         gross[i].deviation_mm / core::kMicrometre);
  }
  if (gross.size() > kNamed) names += fmt::format(" and {} more", gross.size() - kNamed);
  out.warnings.push_back(
      {core::Code::kOutliers,
       fmt::format("{} of {} points lie more than {:g} scales of {:.2f} um off and count in centre "
                   "and radius: {}, counted from 0; look at them, or take the robust variant",
                   gross.size(), used.size(), options.scales,
                   outliers->scale_mm / core::kMicrometre, names)});
}

/// Drops outliers from `rows` and `used`, and selects the quadruples again if there were any.
core::Result<void> make_robust(const OutlierOptions& options, const QuadrupleOptions& quadruples,
                               std::vector<std::size_t>& rows, Points& used,
                               WheelMeasurement& out) {
  TRY(const auto outliers, outliers_of(options, quadruples, used, out));
  out.outlier_scale_mm = outliers.scale_mm;
  out.warnings = outliers.warnings;
  out.dropped = outliers.dropped;
  if (out.dropped.empty()) return {};
  for (auto point = out.dropped.rbegin(); point != out.dropped.rend(); ++point) {
    rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(point->row));
    used.erase(used.begin() + static_cast<std::ptrdiff_t>(point->row));
  }
  TRY(const auto circle, ls_circle(used));
  out.check = circle;
  TRY(out.centers, select_centers(used, circle.radius_mm, quadruples));
  return {};
}

}  // namespace

bool WheelMeasurement::sees_whole_turn() const {
  return order.largest_gap_rad <= kWidestGap * (1.0 + 1e-9);
}

std::optional<double> WheelMeasurement::effective_radius_mm() const {
  if (mode == WheelMode::kEnvelope) return radius_mm;
  if (runout && runout->bound_because.empty()) return runout->effective_radius_mm;
  return std::nullopt;
}

core::Result<WheelMeasurement> measure_wheel(PlanePoints points_mm, const WheelOptions& options) {
  TRY(const auto start, check_and_start(points_mm, options));
  WheelMeasurement out;
  out.mode = options.mode;
  out.mean = options.mean;
  out.points = points_mm.size();
  out.check = start;
  TRY(auto centers, select_centers(points_mm, start.radius_mm, options.quadruples));
  out.centers = std::move(centers);
  std::vector<std::size_t> rows(points_mm.size());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  Points used(points_mm.begin(), points_mm.end());
  if (options.robust) {
    TRY_DO(make_robust(options.outliers, options.quadruples, rows, used, out));
  } else {
    name_outliers(options.outliers, options.quadruples, used, out);
  }
  fill_circle(used, options.errors, out);
  for (std::size_t& row : out.order.rows) row = rows[row];
  for (FourPointCenter& c : out.centers.accepted) {
    for (std::size_t& row : c.rows) row = rows[row];
  }
  for (const Eigen::Vector2d& p : points_mm) {
    out.deviations_mm.push_back((p - out.center_mm).norm() - out.radius_mm);
  }
  fill_scatter(out);
  check_center(out);
  fill_runout(points_mm, options, out);
  if (options.minimum_zone) {
    if (auto zone = min_zone_circle(points_mm)) out.zone = *std::move(zone);
  }
  warn(out);
  return out;
}

}  // namespace rondure::fit
