#pragma once

#include <cstddef>
#include <optional>

#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "core/units.h"
#include "fit/geometry/points.h"
#include "fit/least_squares/circle.h"
#include "fit/references/min_zone_circle.h"
#include "fit/wheel/centers.h"
#include "fit/wheel/outliers.h"
#include "fit/wheel/spread.h"

namespace rondure::fit {

/// How the edge points of a wheel were measured, which determines what they represent.
enum class WheelMode {
  kIndexed,   ///< Wheel at known angles: points of its body; the centre is that of its profile.
  kEnvelope,  ///< Wheel at speed, long exposure: points of the circle it sweeps about its axis.
};
/// "indexed", "envelope".
[[nodiscard]] std::string_view name_of(WheelMode mode);

/// Method for the centre.
enum class WheelMean {
  kLeastSquares,  ///< Geometric least squares of all points.
  kAsPublished,   ///< Mean of the centres of quadruples: the "direct least squares" of the patent.
  kWeighted,      ///< The same, weighted by 1/kappa^2.
};
/// "least-squares", "as-published", "weighted".
[[nodiscard]] std::string_view name_of(WheelMean mean);

/// Settings of measure_wheel(). A value outside its range gives Code::kBadOption.
struct WheelOptions {
  WheelMode mode = WheelMode::kIndexed;
  WheelMean mean = WheelMean::kLeastSquares;
  QuadrupleOptions quadruples;  ///< With kLeastSquares only an additional indicator.
  bool robust = false;          ///< Drop isolated outliers first.
  OutlierOptions outliers;
  std::optional<Eigen::Vector2d> axis_mm;   ///< Spindle axis, from calibration or kEnvelope [mm].
  std::optional<double> nominal_radius_mm;  ///< R must be within 5 % of it.
  bool allow_short_arc = false;             ///< Also evaluate less than 20 deg of the circle.
  bool minimum_zone = true;                 ///< Also compute the minimum-zone roundness.
};

/// Radial run-out and derived values; known only with the spindle axis.
struct WheelRunout {
  Eigen::Vector2d axis_mm = Eigen::Vector2d::Zero();
  double fim_mm = 0.0;               ///< Full indicator movement: max - min distance from the axis.
  double eccentricity_mm = 0.0;      ///< Distance of the centre of the profile from the axis.
  double effective_radius_mm = 0.0;  ///< Largest distance from the axis: the radius that cuts.
  double fim_with_dropped_mm = 0.0;  ///< FIM including dropped points: a protruding one is run-out.
  /// Why `fim_mm` and `effective_radius_mm` are only lower bounds: points that cover too little of
  /// the turn, or a dropped point that adds to them. Empty if they are values.
  core::Phrase bound_because;
};

/// A grinding wheel's centre and radius.
struct WheelMeasurement {
  WheelMode mode = WheelMode::kIndexed;
  WheelMean mean = WheelMean::kLeastSquares;
  std::size_t points = 0;  ///< Number given, including those dropped.
  std::vector<DroppedPoint> dropped;
  double outlier_scale_mm = 0.0;  ///< Scale of the robust variant, otherwise 0.
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();  ///< S
  double radius_mm = 0.0;                               ///< R, mean distance of the points from S.
  double center_uncertainty_mm = 0.0;  ///< u(S), both coordinates: s_r factors.center sqrt(tau).
  double radius_uncertainty_mm = 0.0;  ///< u(R), standard: s_r factors.radius sqrt(tau).
  double spread_mm = 0.0;              ///< s_r, standard deviation of the distances, n - 3.
  double deviation_mm = 0.0;           ///< PV of the distances: roundness about S, not run-out.
  std::vector<double> deviations_mm;   ///< Distance from S minus R, for every given point.
  AngularOrder order;        ///< Order of the points used about S; rows of the given points.
  CircleFactors factors;     ///< Factors of the reported centre and radius.
  double correlation = 1.0;  ///< tau
  WheelCenters centers;      ///< With rows of the given points.
  /// Mean of the quadruple centres: plain with kAsPublished, otherwise weighted.
  Eigen::Vector2d quadruple_center_mm = Eigen::Vector2d::Zero();
  double center_scatter_mm = 0.0;     ///< s_c about that mean; an indicator only.
  double expected_scatter_mm = 0.0;   ///< s_r rms(kappa): expected from noise alone.
  double farthest_center_mm = 0.0;    ///< Greatest distance of a quadruple centre from their mean.
  LsCircle check;                     ///< Geometric least squares of the same points.
  std::optional<MinZoneCircle> zone;  ///< Minimum-zone roundness.
  std::optional<WheelRunout> runout;  ///< kIndexed with an axis; absent otherwise.
  core::Phrase runout_absent;         ///< Why there is none; empty when there is.
  std::vector<core::Error> warnings;

  /// Whether the points are close enough all round to show run-out and roundness: no gap above 60
  /// deg. A wider gap can hide more than 7 % of the run-out caused by an eccentricity.
  [[nodiscard]] bool sees_whole_turn() const;
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
