#pragma once

#include <string>
#include <vector>

#include "core/result.h"
#include "fit/rotary/axes.h"

// The swivel head of a five-axis machine: axis C (along z) on the slides carries axis A (along x),
// which carries the ball. Finds the errors of both from one ball read in a gauge nest while the
// control holds its place (RTCP); start with identify_head(). Formulas: methods, machine cell 1.

namespace rondure::fit {

/// Both axes through the pivot, where they nominally cross. Translations refer to it.
[[nodiscard]] RotaryAxis head_axis_c();
[[nodiscard]] RotaryAxis head_axis_a();

struct HeadPose {
  double c_rad = 0.0;
  double a_rad = 0.0;
};

/// Motion of the body of A from C = A = 0 to a pose, from the pivot: the errors of A are in the
/// body of C, those of C in the axes of the slides.
///     E_C Rz(C) E_A Rx(A),   E = [ exp([w]x) t ; 0 1 ]
[[nodiscard]] Eigen::Isometry3d head_motion(const HeadPose& pose, const RotaryErrors& c = {},
                                            const RotaryErrors& a = {});

enum class HeadStep { kReference, kC, kA, kVerification };

/// One reading of the nest.
struct HeadReading {
  HeadStep step = HeadStep::kReference;
  HeadPose pose;
  std::size_t ball = 0;                            ///< Index in HeadMeasurement::balls.
  Eigen::Vector3d d_mm = Eigen::Vector3d::Zero();  ///< Deviation, from the zero of the nest.
};

struct HeadMeasurement {
  /// Places from the pivot at C = A = 0 as the control knows them; u_mm is not used. The first is
  /// the origin: locations of the axes are relative to its tool.
  std::vector<BallCentre> balls;
  std::vector<HeadReading> readings;  ///< In the order of measurement.
  double u_mm = 1e-6;                 ///< Standard uncertainty of a coordinate of a reading; > 0.
};

/// What the nest would read, and reads, in one pose of both axes that found no error.
struct HeadVerification {
  HeadPose pose;
  std::vector<Eigen::Vector3d> at_mm;      ///< Predicted places of the balls, from the pivot.
  std::vector<Eigen::Vector3d> left_mm;    ///< Found minus predicted.
  std::vector<Eigen::Vector3d> before_mm;  ///< Found minus nominal.
  Matrix6 covariance = Matrix6::Zero();    ///< Of the predicted motion (t; w) about the pivot.
};

/// Root mean square and greatest length of vectors.
struct HeadRms {
  double rms_mm = 0.0;
  double max_mm = 0.0;
};

struct HeadStudy {
  /// Stations, table, and axis offset: d and e are the location errors (XOC, YOC; AOC, BOC) and
  /// (YOA, ZOA; BOA, COA), with the uncertainty of the origin.
  RotaryStudy c;
  RotaryStudy a;
  std::vector<HeadVerification> poses;
  std::vector<core::Error> warnings;  ///< kInconsistent: two places of the ball read alike.
  HeadRms before;
  HeadRms left;
  double expected_mm = 0.0;  ///< What noise and covariances explain of left.rms_mm.
  /// Greatest coordinate of a difference of two references of a ball.
  double reference_step_mm = 0.0;
  /// One column per coordinate of a ball: (t; w) at the reference pose by the noise of its mean
  /// reading there, times that noise; and the shift of the origin.
  Eigen::Matrix<double, 6, Eigen::Dynamic> reference_modes;
  Eigen::Matrix<double, 3, Eigen::Dynamic> origin_modes;

  /// What each of these noises does to the errors (t; w) of an axis at an angle; nothing at 0.
  [[nodiscard]] Eigen::Matrix<double, 6, Eigen::Dynamic> modes_at(const RotaryAxis& axis,
                                                                  double angle_rad) const;
};

/// Finds the errors of both axes, and verifies them in poses of both.
///
///     p0_k = b_k + r_k(0,0) - r_1(0,0),   q_k = Rz Rx b_k + r_k(C,A) - r_1(0,0)
///
/// All readings at C = A = 0 are references; those of a ball are averaged. E = I there by
/// definition: it is a station of both axes without error.
/// @return  Errors of identify_rotary_axis() with the axis named; kMissingKey (a ball without
///          reference), kMeaning (a station of one axis at which the other does not stand at 0),
///          kOutOfRange (a combined pose beyond the stations of A). O(readings * balls).
/// Source: CN105479268A; methods, machine cell 1.
[[nodiscard]] core::Result<HeadStudy> identify_head(const HeadMeasurement& measurement);

/// One row of the compensation table.
struct HeadTableRow {
  double angle_rad = 0.0;
  Vector6 errors = Vector6::Zero();
  Vector6 u = Vector6::Zero();
};

/// The errors of one axis at some angles, with all that is uncertain of them.
[[nodiscard]] core::Result<std::vector<HeadTableRow>> head_errors(
    const HeadStudy& study, const RotaryStudy& axis, const std::vector<double>& angles_rad);

/// The errors of one axis in steps between its outermost stations, a full circle from 0 to 360 deg,
/// which has the errors of 0. The last step may be shorter. Steps of whole degrees give whole ones.
[[nodiscard]] core::Result<std::vector<HeadTableRow>> head_table(const HeadStudy& study,
                                                                 const RotaryStudy& axis,
                                                                 double step_rad);

/// Rounds the errors of a table to multiples of these [mm, rad]; 0: not.
void round_table(double shift_mm, double tilt_rad, std::vector<HeadTableRow>& rows);

/// The error of a table at an angle, linear between its rows as a control takes it; the ends stand
/// beyond them.
[[nodiscard]] RotaryErrors table_error(const std::vector<HeadTableRow>& rows, double angle_rad);

}  // namespace rondure::fit
