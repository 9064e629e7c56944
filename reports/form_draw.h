#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "core/noise.h"
#include "reports/error_modes.h"
#include "reports/form_cloud.h"
#include "reports/form_spectrum.h"

namespace rondure::reports {

/// Deviations whose variance is s^2 + noise: s, the size of the form, is unknown.
struct NoiseLevel {
  double noise_mm2 = 0.0;   ///< Variance of the errors, >= 0.
  double square_mm2 = 0.0;  ///< Sum of the squares of the deviations.
  double count = 0.0;       ///< How many they are.
};

/// What deviations tell of the size of the form behind them: a distribution of s, tabulated.
///
/// Prior: p(s^2) ~ 1 / (s^2 + mean noise), which is Jeffreys' where there is no noise and stays
/// proper where noise is all there is.
class FormSize {
 public:
  /// A known size.
  explicit FormSize(double size) : sizes_{size, size}, below_{0.0, 1.0} {}
  explicit FormSize(const std::vector<NoiseLevel>& levels);

  /// @param share  In [0, 1).
  [[nodiscard]] double quantile(double share) const;

 private:
  std::vector<double> sizes_;
  std::vector<double> below_;  ///< Probability of less, from 0 to 1.
};

/// Forms at the sampled points that may stand behind the deviations. Of the form it is taken that
/// half its power lies in low undulations and degrees, the other half is independent from point to
/// point, and that its size is what the deviations tell: no spectrum is needed. (Without the first
/// half a drift or creep, which is as smooth as most form, would be taken for all of it.)
class SampledForm {
 public:
  SampledForm(const FormCloud& cloud, const ErrorModel& errors);

  /// One form [mm], in a frame that shifts, tilts and radius are taken out of.
  /// @param errors_mm  Of a simulated inspection.
  /// @param size       Chosen by size().quantile().
  void draw(core::KeyedNoise& noise, double size, const Eigen::VectorXd& errors_mm,
            Eigen::VectorXd& form_mm) const;

  [[nodiscard]] const FormSize& size() const { return size_; }

 private:
  void solve(const Eigen::MatrixXd& smooth, const Eigen::MatrixXd& systematic);
  void draw_rest(core::KeyedNoise& noise, double size, const Eigen::VectorXd& errors_mm,
                 Eigen::VectorXd& form_mm) const;
  [[nodiscard]] Eigen::VectorXd beside(const Eigen::VectorXd& values) const;

  Eigen::MatrixXd rigid_;
  Eigen::MatrixXd directions_;   ///< Orthonormal: smooth form and systematic errors.
  Eigen::MatrixXd whiten_;       ///< Deviations along them to a frame in which all is independent.
  Eigen::MatrixXd color_;        ///< And back.
  Eigen::VectorXd noise_;        ///< Variance of the errors in that frame, for size 1.
  Eigen::VectorXd deviations_;   ///< Measured, in that frame.
  Eigen::VectorXd rest_;         ///< Measured, beside the directions.
  double point_variance_ = 0.0;  ///< Mean over the points: of the errors beside the directions.
  bool has_rest_ = false;        ///< Few points have nothing beside the directions.
  FormSize size_;
};

/// Forms of the whole surface that may stand behind the deviations, under a form spectrum.
class WholeForm {
 public:
  /// Clouds above this many points are thinned to it, evenly, for this purpose.
  static constexpr std::size_t kMostPoints = 256;

  /// @param spectrum  As check_spectrum() accepts it.
  WholeForm(const FormCloud& cloud, const ErrorModel& errors, const FormSpectrum& spectrum);

  /// One form of the places() [mm]; parameters as in SampledForm.
  void draw(core::KeyedNoise& noise, double size, const Eigen::VectorXd& errors_mm,
            Eigen::VectorXd& form_mm) const;

  [[nodiscard]] const FormSize& size() const { return size_; }
  [[nodiscard]] const std::vector<FormPoint>& places() const { return places_; }

 private:
  void solve(const Eigen::MatrixXd& free, const Eigen::MatrixXd& sampled,
             const Eigen::MatrixXd& errors);

  std::vector<std::size_t> rows_;  ///< Of the cloud.
  std::vector<FormPoint> places_;
  Eigen::MatrixXd surface_;       ///< Coefficients to places.
  Eigen::MatrixXd whiten_;        ///< Deviations to the frame in which all is independent.
  Eigen::MatrixXd spectrum_;      ///< Coefficients to that frame.
  Eigen::MatrixXd rest_;          ///< What the spectrum does not hold, to that frame.
  Eigen::MatrixXd coefficients_;  ///< From that frame to coefficients.
  Eigen::VectorXd noise_;         ///< Variance of the errors in that frame, for size 1.
  Eigen::VectorXd deviations_;    ///< Measured, in that frame.
  FormSize size_;
};

}  // namespace rondure::reports
