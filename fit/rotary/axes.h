#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "fit/rotary/axis_offset.h"
#include "fit/rotary/errors.h"
#include "fit/rotary/model.h"

// Identifies the six position-dependent errors of a rotary axis from balls measured at several
// angles; start with identify_rotary_axis(). Formulas and figures: docs/rotary-axes.md.

namespace rondure::fit {

/// A measured ball.
struct BallCentre {
  std::string ball;  ///< Name of the ball, the same at all poses.
  Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();  ///< Centre in the frame of the machine.
  Eigen::Vector3d u_mm =
      Eigen::Vector3d::Constant(1e-3);  ///< Standard uncertainty of x, y, z; > 0.
};

/// Direction from which the angle was approached.
enum class Approach { kUnknown, kForward, kBackward };

/// All balls at one angle, approached once.
struct RotaryPose {
  double angle_rad = 0.0;
  Approach approach = Approach::kUnknown;
  std::vector<BallCentre> balls;
  /// Motion of the body before the axis turns it, in the frame of the machine at the reference
  /// pose: by another axis, which the body sits on, and which does not read its zero.
  Eigen::Isometry3d carried = Eigen::Isometry3d::Identity();
  /// Covariance of (t; w) by which the body as a whole may be misplaced here: the uncertainty of
  /// the readings of the axes. No ball shows it.
  Matrix6 placing_covariance = Matrix6::Zero();
};

/// Measurement of an axis. Stations and references are in the order of measurement.
struct RotaryMeasurement {
  RotaryAxis axis;
  double lowest_rad = -1e9;  ///< Range of the axis; a station outside is refused.
  double highest_rad = 1e9;
  double reference_rad = 0.0;  ///< Angle of the reference pose.
  /// The reference pose, measured several times (start, middle, end) and averaged. u_mm = 0 states
  /// that the positions are exact.
  std::vector<std::vector<BallCentre>> references;
  std::vector<RotaryPose> stations;
  /// Whether the table has a row at the reference angle, of no error and no noise: E = I there by
  /// definition.
  bool reference_is_station = false;
  /// Covariance of (t; w) by which the body may be misplaced in the mean of the references: it
  /// turns with the body and is in all stations alike.
  Matrix6 reference_placing = Matrix6::Zero();
};

/// Settings of identify_rotary_axis().
struct RotaryOptions {
  enum class Solver {
    kExact,        ///< Rigid registration; Gauss-Newton on exp([w]x) for unequal weights.
    kLinear,       ///< One linear step of dp = t + w x p: wrong by |w|^2 |p| / 2.
    kAsPublished,  ///< kLinear with the matrices printed in the source.
  };
  Solver solver = Solver::kExact;
  RotaryCurve curve = RotaryCurve::kSpline;
  bool remove_outliers = true;
  double outlier_probability = 0.999;  ///< Probability of the global test; 0.5 .. 1, exclusive.
};

/// Errors found at one station.
struct RotaryStation {
  double angle_rad = 0.0;
  Approach approach = Approach::kUnknown;
  /// No solution (too few balls here): errors and covariance are invalid.
  bool undetermined = false;
  bool flagged = false;              ///< The global test fails and no single ball explains it.
  std::vector<std::string> removed;  ///< Balls left out as outliers.
  RotaryErrors errors;               ///< Including the noise of reference and station.
  Matrix6 measured_covariance = Matrix6::Zero();  ///< Noise of the station alone.
  double chi2 = 0.0;  ///< v^T W v of the balls used, with the uncertainties as stated.
  int dof = 0;        ///< 3n - 6.
  double chi2_limit = 0.0;
  double condition = 0.0;                     ///< setup_condition() of the balls used.
  std::vector<std::string> balls;             ///< Balls used.
  std::vector<Eigen::Vector3d> residuals_mm;  ///< Measured minus adjusted, for the balls used.
  /// For each coordinate; near 0: errors are not detected.
  std::vector<Eigen::Vector3d> redundancy;
};

/// Results for one axis.
struct RotaryStudy {
  double reference_rad = 0.0;
  std::vector<BallCentre> reference;    ///< Averaged.
  double drift_mm = 0.0;                ///< Greatest shift of a ball between two references.
  std::vector<RotaryStation> stations;  ///< Results at the stations, in the order of measurement.
  double s0 = 1.0;  ///< A-posteriori factor of all stations; covariances hold max(1, s0)^2.
  int dof = 0;      ///< Degrees of freedom of s0.
  RotaryTable table;
  std::optional<AxisOffset> offset;  ///< Absent below 45 deg of arc; a warning states this.
  /// Whether 0 and 360 deg were compared, which needs stations a full turn apart.
  bool periodicity_checked = false;
  std::vector<core::Error> warnings;
};

/// Identifies the six errors at each station, then axis location and orientation, then the table of
/// the smooth model (RotaryModel::of(study.table)).
///
/// Errors are relative to the reference pose, where they are zero by definition. A ball may be
/// missing at a station; balls that are not in the reference are refused.
///
/// @return kMissingKey (no reference), kUnknownKey (ball), kRepeatedKey (station, ball), kBadOption
///         (axis not a unit vector, u not positive), kNotFinite, kPoseRange, kTooFewPoints and
///         kCollinear (check_setup), kUnits, kSense (more than 0.1 rad of rotation left, or another
///         sense or unit of the angles fits better), kInconsistent (a station does not fit its
///         neighbours, distances between balls drift, 0 and 360 deg differ), kRank (no station
///         determined). O(stations * balls).
/// Sources: CN105479268A (ball setups); B. K. P. Horn, J. Opt. Soc. Am. A 4 (1987); W. Baarda
/// (1968) for redundancy numbers; ISO 230-1, ISO 230-7 for the names.
[[nodiscard]] core::Result<RotaryStudy> identify_rotary_axis(const RotaryMeasurement& measurement,
                                                             const RotaryOptions& options = {});

}  // namespace rondure::fit
