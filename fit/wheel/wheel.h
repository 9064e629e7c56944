#pragma once

#include <cstddef>
#include <optional>

#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "core/units.h"
#include "core/words.h"
#include "fit/geometry/points.h"
#include "fit/least_squares/circle.h"
#include "fit/references/min_zone.h"
#include "fit/wheel/centers.h"
#include "fit/wheel/outliers.h"
#include "fit/wheel/spread.h"

namespace rondure::fit {

/// How the edge points of a wheel were measured, which determines what they represent.
enum class WheelMode {
  kIndexed,   ///< Wheel at known angles: points of its body; the centre is that of its profile.
  kEnvelope,  ///< Wheel at speed, long exposure: points of the circle it sweeps about its axis.
};
RONDURE_WORDS(WheelMode, {kIndexed, "indexed"}, {kEnvelope, "envelope"});

/// Method for the centre.
enum class WheelMean {
  kLeastSquares,  ///< Geometric least squares of all points.
  kAsPublished,   ///< Mean of the centres of quadruples: the "direct least squares" of the patent.
};
RONDURE_WORDS(WheelMean, {kLeastSquares, "least-squares"}, {kAsPublished, "as-published"});

/// Declared standard uncertainties of the points of a wheel, >= 0.
struct WheelPointErrors {
  double point_mm = 0.0;      ///< Of one point, along the radius.
  double scale_1 = 0.0;       ///< Of the scale of stage and pixels, relative.
  double threshold_mm = 0.0;  ///< Bias of the edge detection: moves the radius only.
  double wear_mm = 0.0;       ///< Of the radius since the measurement.
};

/// Settings of measure_wheel(). A value outside its range gives Code::kBadOption.
struct WheelOptions {
  WheelMode mode = WheelMode::kIndexed;
  WheelMean mean = WheelMean::kLeastSquares;
  QuadrupleOptions quadruples;  ///< With kLeastSquares only an additional indicator.
  bool robust = false;          ///< Leave isolated outliers out of centre and radius.
  OutlierOptions outliers;
  std::optional<Eigen::Vector2d> axis_mm;   ///< Spindle axis, from calibration or kEnvelope [mm].
  std::optional<double> nominal_radius_mm;  ///< R must be within 5 % of it.
  bool allow_short_arc = false;             ///< Also evaluate less than 20 deg of the circle.
  bool minimum_zone = true;                 ///< Also compute the minimum-zone roundness.
  std::optional<WheelPointErrors> errors;   ///< For u(S) and u(R) in place of the spread.
};

/// Radial run-out and derived values, of all points, dropped ones included: a proud point is
/// run-out, and cuts. Known only with the spindle axis.
struct WheelRunout {
  Eigen::Vector2d axis_mm = Eigen::Vector2d::Zero();
  double fim_mm = 0.0;               ///< Full indicator movement: max - min distance from the axis.
  double eccentricity_mm = 0.0;      ///< Distance of the centre of the profile from the axis.
  double effective_radius_mm = 0.0;  ///< Largest distance from the axis: the radius that cuts.
  /// Why `fim_mm` and `effective_radius_mm` are only lower bounds: points that leave too much of
  /// the turn unseen. Empty if they are values.
  core::Phrase bound_because;
};

/// Gap between neighbouring points above which there is no run-out and no roundness.
inline constexpr double kWidestGap = 90.0 * core::kDegree;
/// Conditioning of the best quadruple above which the radius proves nothing.
inline constexpr double kWorstBestKappa = 20.0;
/// Correlation of neighbouring residuals above which they are form, not noise.
inline constexpr double kCorrelationLimit = 2.0;

/// A grinding wheel's centre and radius.
struct WheelMeasurement {
  WheelMode mode = WheelMode::kIndexed;
  WheelMean mean = WheelMean::kLeastSquares;
  std::size_t points = 0;  ///< Number given, including those dropped.
  std::vector<DroppedPoint> dropped;
  double outlier_scale_mm = 0.0;  ///< Scale of the robust variant, otherwise 0.
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();  ///< S
  double radius_mm = 0.0;                               ///< R, mean distance of the points from S.
  /// u(S), both coordinates: s_r factors.center sqrt(tau), or of the declared errors of the points.
  double center_uncertainty_mm = 0.0;
  /// u(R), standard: s_r factors.radius sqrt(tau), or of the declared errors.
  double radius_uncertainty_mm = 0.0;
  /// Standard uncertainty of R by lobes of orders 2 and 3 of a wheel at rest, and where
  /// neighbouring residuals are alike (tau > kCorrelationLimit); 0 of points that go round. Not in
  /// u(R).
  double lobes_in_radius_mm = 0.0;
  double spread_mm = 0.0;  ///< s_r, standard deviation of the distances, n - 3.
  /// PV of the distances of the points that count in S and R: the roundness about S, not run-out,
  /// unless points were dropped.
  double deviation_mm = 0.0;
  std::vector<double> deviations_mm;  ///< Distance from S minus R, for every given point.
  AngularOrder order;        ///< Order of the points used about S; rows of the given points.
  CircleFactors factors;     ///< Factors of the reported centre and radius.
  double correlation = 1.0;  ///< tau
  WheelCenters centers;      ///< With rows of the given points.
  /// Mean of the quadruple centres: plain with kAsPublished, otherwise weighted by 1/kappa^2.
  Eigen::Vector2d quadruple_center_mm = Eigen::Vector2d::Zero();
  double center_scatter_mm = 0.0;      ///< s_c about that mean; an indicator only.
  double expected_scatter_mm = 0.0;    ///< s_r rms(kappa): expected from noise alone.
  double farthest_center_mm = 0.0;     ///< Greatest distance of a quadruple centre from their mean.
  LsCircle check;                      ///< Geometric least squares of the same points.
  double center_apart_mm = 0.0;        ///< Distance of quadruple_center_mm from that centre.
  double center_apart_limit_mm = 0.0;  ///< Three standard uncertainties of it: more voids R.
  core::Phrase radius_void_because;    ///< Why S and R prove nothing; empty if they do.
  std::optional<MinZoneCircle> zone;   ///< Minimum-zone roundness of all points, dropped included.
  std::optional<WheelRunout> runout;   ///< kIndexed with an axis; absent otherwise.
  core::Phrase runout_absent;          ///< Why there is none; empty when there is.
  std::vector<core::Error> warnings;

  /// Whether the points lie all round: no gap above kWidestGap. A wider gap leaves no run-out and
  /// no roundness; what a narrower one hides, loss_in_gap_mm() bounds.
  [[nodiscard]] bool sees_whole_turn() const;
  /// What lobes may move R on an arc, to each side: two standard uncertainties [mm].
  [[nodiscard]] double form_in_radius_mm() const { return 2.0 * lobes_in_radius_mm; }
  /// The radius that cuts: the farthest from the axis (kIndexed with an axis; none if that is only
  /// a bound), or R itself (kEnvelope).
  [[nodiscard]] std::optional<double> effective_radius_mm() const;
};

/// Measures a wheel from points of its edge: centre by least squares or by perpendicular bisectors
/// of quadruples, mean radius, spread, and run-out if the spindle axis is known. Without `robust`,
/// points beyond 5 scales are used, and a warning names them.
///
/// @param points_mm  n >= 8 points (x, z) of the wheel's plane [mm].
/// @return kNotFinite (row), kTooFewPoints (fewer than 8 that are more than 1 um apart),
///         kCollinear, kShortArc (below 20 deg), kUnits (R outside 0.5 to 1000 mm), kOutOfRange
///         (more than 5 % off the nominal radius), kTooFewCenters, kOutliers, kMeaning (an axis in
///         envelope mode: the sweep hides run-out), kBadOption, and those of ls_circle(). Warnings:
///         kShortArc (below 90 deg), kCenterDisagrees, kNoAxis, kOutliers, kLocalForm,
///         kCorrelated. Some 1 ms.
/// Source: methods, wheel sections 2 to 7; patent CN103029041A, step one.
[[nodiscard]] core::Result<WheelMeasurement> measure_wheel(PlanePoints points_mm,
                                                           const WheelOptions& options = {});

}  // namespace rondure::fit
