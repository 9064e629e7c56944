#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "evaluation/rotary/result.h"

namespace rondure::evaluation {

/// The errors of prediction at the combined poses, free of the noise of the balls there.
///
/// In each pose the error is a rigid motion. The residuals are projected on the motions that the
/// covariance of the calibration allows, in its principal directions: coefficients of unit variance
/// times a scale common to all poses, each with the noise u / s_k. The scale has a log-normal prior
/// of one decade about 1; its posterior follows from the coefficients. A scale about 1 says that
/// the calibration explains what is left; one above says that errors depend on both angles. Source:
/// docs/rotary-axes.md, "Residual at combined poses".
class CombinedField {
 public:
  struct Residual {
    double rms_mm = 0.0;
    double max_mm = 0.0;
  };

  /// @param noise_mm  Standard uncertainty of a coordinate of a ball centre; > 0.
  CombinedField(std::span<const CombinedPose> poses, double noise_mm);

  /// Quantile of the posterior of the scale.
  [[nodiscard]] double scale_at(double probability) const;
  /// Residual of a draw of the true errors: a pure function of its arguments.
  [[nodiscard]] Residual draw(std::uint64_t seed, int trial) const;
  /// Change of both values for one standard uncertainty of the ball centres, to first order.
  [[nodiscard]] Residual per_noise() const;

 private:
  struct Pose {
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic>
        motions;                ///< Columns per coefficient [mm].
    std::vector<double> found;  ///< Of unit variance.
    std::vector<double> u;      ///< Noise of each.
  };

  void weigh_scales();

  double noise_mm_ = 0.0;
  std::vector<Pose> poses_;
  double points_ = 0.0;
  std::vector<double> scales_;
  std::vector<double> cumulative_;  ///< Posterior of the scales, 0..1.
};

/// What the poses show of the errors of prediction: the rigid motion of the balls of each, as found
/// by registration. The rest of a residual is how far the balls themselves are known. Three balls
/// in line, or fewer, show all they have.
[[nodiscard]] CombinedField::Residual moved_by(std::span<const CombinedPose> poses);

/// The residual in every trial, and its change with the noise of the balls.
struct ResidualTrials {
  std::vector<double> rms_mm;
  std::vector<double> max_mm;
  CombinedField::Residual noise;
};
[[nodiscard]] ResidualTrials residual_trials(std::span<const CombinedPose> poses, double noise_mm,
                                             const UncertaintyOptions& options);

/// The interval of the residual, its root mean square or the largest.
[[nodiscard]] UncertaintyStatus residual_interval(double as_measured_mm, bool rms,
                                                  const ResidualTrials& trials,
                                                  std::vector<InfluenceStatement> declaration,
                                                  const UncertaintyOptions& options);

}  // namespace rondure::evaluation
