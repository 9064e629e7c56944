#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/spindle/first_harmonic.h"
#include "fit/spindle/three_probe.h"

namespace rondure::fit {

/// Part and motion as coefficients [mm], cosine and sine of each order: c2, s2, c3, s3, ...
struct SpindleCurves {
  Eigen::VectorXd profile_mm;  ///< Over the angle on the part, orders 2..highest.
  /// Motion over the work angle, without eccentricity and probe zeros, orders 2..highest motion.
  Eigen::VectorXd x_mm;
  Eigen::VectorXd y_mm;
};

/// A separation as a function of the errors of the probes: what the same readings say about part
/// and motion if the gains and angles are not as stated. For trials: an evaluation costs as much as
/// a few transforms of a revolution, and the curves are coefficients from which the values follow
/// by one product.
class SeparationModel {
 public:
  /// @return kSampling for so many samples and orders that the products take too long (4e6
  /// numbers).
  [[nodiscard]] static core::Result<SeparationModel> of(const ThreeProbeResult& result);

  /// Highest order of the motion: that of the part, or fewer where the samples do not carry it.
  [[nodiscard]] int highest_motion() const { return highest_motion_; }

  /// The curves if the probes have the errors `q`.
  /// @pre |q| leaves no two probes in line.
  [[nodiscard]] SpindleCurves at(const ProbeErrors& q) const;
  /// The curves of other readings of the mean revolution with the stated probes, e.g. of noise.
  [[nodiscard]] SpindleCurves of_readings(
      const std::array<std::vector<double>, 3>& readings_mm) const;

  /// Coefficients 1, c1, s1, c2, s2, ... up to highest_motion() of values on the samples, over the
  /// work angle, by least squares.
  [[nodiscard]] Eigen::VectorXd over_work(const std::vector<double>& values) const;
  /// One revolution out of several as coefficients: those of over_work() of what is left when a
  /// ramp from its beginning to its end is taken away, then the height of that ramp. A motion
  /// slower than the turn does not end where it began; its waves alone would overshoot that step.
  [[nodiscard]] Eigen::VectorXd over_turn(const std::vector<double>& values) const;
  /// Standard deviation of the motion in X and in Y of one sample per unit of noise of a reading.
  [[nodiscard]] std::array<double, 2> motion_per_noise() const;

  /// Angles on the part at which profile_waves() has its rows [rad].
  [[nodiscard]] const std::vector<double>& places_rad() const { return places_rad_; }
  /// Values from the coefficients of a profile: one row for each of places_rad().
  [[nodiscard]] const Eigen::MatrixXd& profile_waves() const { return profile_waves_; }
  /// Motion from its coefficients, about the centre of its polar plot.
  [[nodiscard]] const Eigen::MatrixXd& motion_waves() const { return motion_waves_; }
  /// Values from the coefficients of over_turn(), at the same work angles.
  [[nodiscard]] const Eigen::MatrixXd& turn_waves() const { return turn_waves_; }

 private:
  explicit SeparationModel(const ThreeProbeResult& result);
  [[nodiscard]] SpindleCurves separate(const std::array<std::vector<double>, 3>& readings_mm,
                                       const std::array<double, 3>& drift_mm,
                                       const ProbeErrors& q) const;

  ThreeProbeResult result_;
  int highest_motion_ = 2;
  Eigen::MatrixXd work_;            ///< 1, cos, sin, ... of the work angle of every sample.
  Eigen::MatrixXd normal_inverse_;  ///< Of the least squares over them.
  Eigen::VectorXd ramp_;            ///< From -1/2 to 1/2 over the turn, at every sample.
  std::vector<double> places_rad_;
  Eigen::MatrixXd profile_waves_;
  Eigen::MatrixXd motion_waves_;
  Eigen::MatrixXd turn_waves_;
};

}  // namespace rondure::fit
