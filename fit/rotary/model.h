#pragma once

#include <vector>

#include "core/open_spline.h"
#include "core/result.h"
#include "fit/profiles/periodic_spline.h"
#include "fit/rotary/errors.h"

namespace rondure::fit {

/// The errors at one angle, averaged over both directions of approach.
struct RotaryTableRow {
  double angle_rad = 0.0;
  Vector6 errors = Vector6::Zero();      ///< (t; w) [mm, rad].
  Matrix6 covariance = Matrix6::Zero();  ///< Covariance of the measurement at this station alone.
  Vector6 hysteresis = Vector6::Zero();  ///< (forward - backward) / 2; zero for one direction.
  bool both_directions = false;
};

/// Method for the errors between the stations.
enum class RotaryCurve {
  kSpline,      ///< Cubic spline through the stations: periodic on a full circle, else not-a-knot.
  kFourier,     ///< Full circle: series up to order floor(stations / 3), least squares.
  kPolynomial,  ///< Arc: 1, cos, sin and powers up to min(4, (stations - 1) / 3), least squares.
};

/// The data from which a smooth model is made, as stored in a calibration file.
struct RotaryTable {
  RotaryAxis axis;
  double reference_rad = 0.0;  ///< Angle of the pose in which t = 0 and w = 0 by definition.
  bool full_circle = false;
  RotaryCurve curve = RotaryCurve::kSpline;
  std::vector<RotaryTableRow> rows;  ///< Angles strictly ascending, on a circle within one turn.
  /// Stations without a solution; the curve is interpolated across them.
  std::vector<double> missing_rad;
  /// Covariance from the noise of the reference pose, at the reference angle; it turns with the
  /// body and is common to all stations.
  Matrix6 reference_covariance = Matrix6::Zero();
  Vector6 hysteresis_rms = Vector6::Zero();  ///< Standard uncertainty from direction of approach.
};

/// The errors of one axis at any angle within its stations.
class RotaryModel {
 public:
  /// @return kTooFewPoints (spline: 4 stations on an arc, 3 on a circle; least squares: 4),
  ///         kBadOption (a Fourier series on an arc, a polynomial on a circle), kNotFinite,
  ///         kTable (angles not strictly ascending, or over more than one turn).
  [[nodiscard]] static core::Result<RotaryModel> of(RotaryTable table);

  /// Errors with their covariance, whose sigma() is the band of an error curve. On a full circle
  /// any angle is first reduced to the turn of the stations.
  /// @return kOutOfRange outside the stations of an arc (nothing is extrapolated), kNotFinite.
  ///         O(stations).
  [[nodiscard]] core::Result<RotaryErrors> at(double angle_rad) const;

  /// rotary_motion() at a commanded angle, with the errors at that angle. Errors as at().
  [[nodiscard]] core::Result<Eigen::Isometry3d> motion(double angle_rad) const;

  [[nodiscard]] const RotaryTable& table() const { return table_; }
  [[nodiscard]] double lowest_rad() const { return table_.rows.front().angle_rad; }
  [[nodiscard]] double highest_rad() const { return table_.rows.back().angle_rad; }

 private:
  /// errors(angle) = sum over rows of weight(row) * errors(row), one column per error.
  using Weights = Eigen::Matrix<double, Eigen::Dynamic, 6>;
  [[nodiscard]] Weights weights_at(double angle_rad) const;
  [[nodiscard]] bool bridged_at(double angle_rad) const;
  /// The angle within the turn, or the range, of the stations.
  [[nodiscard]] core::Result<double> within(double angle_rad) const;
  void make_splines();
  void make_least_squares();

  RotaryTable table_;
  /// For a full circle: 1 at one row and 0 at the others, one spline per row.
  std::vector<PeriodicSpline> circle_;
  std::vector<core::OpenSpline> arc_;  ///< The same for an arc; one of the two is empty.
  /// Least squares: coefficients from values, one matrix per error.
  std::vector<Eigen::MatrixXd> fit_;
};

}  // namespace rondure::fit
