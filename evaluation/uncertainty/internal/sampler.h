#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/noise.h"
#include "evaluation/uncertainty/internal/columns.h"
#include "evaluation/uncertainty/internal/error_modes.h"

namespace rondure::evaluation {

/// Logarithm of the odds that a point stands out by itself, of what the model leaves of it.
/// @param per_point  Spots expected of a point.
[[nodiscard]] double spot_log_odds(double rest_mm, double variance_mm2, double per_point);

/// Logarithm of how much more likely the data are with a column of normal size than without it.
/// @param product  Column times what the other columns leave of the data.
/// @param square   Column times itself.
[[nodiscard]] double column_evidence(double product, double square, double variance_mm2,
                                     double size_mm2);

/// What the two variances of a residual are drawn from.
struct VarianceTerms {
  double stated_mm2 = 0.0;          ///< Noise, as declared, > 0.
  double degrees_of_freedom = 0.0;  ///< Behind it; 0: known.
  double power_mm2 = 0.0;           ///< Mean square of the deviations.
  double floor_mm2 = 0.0;           ///< Unresolved form is not less.
};

/// One pair of variances; the unresolved one is spread evenly over a step of its logarithm.
struct VarianceOdd {
  double noise_mm2 = 0.0;
  double unresolved_mm2 = 0.0;
  double probability_1 = 0.0;
  double log_step = 0.0;
};
using VarianceOdds = std::vector<VarianceOdd>;

/// @param squares_mm2  Sum of the squares of the residual, of `count` points.
[[nodiscard]] VarianceOdds variance_odds(const VarianceTerms& terms, double squares_mm2,
                                         double count);

/// What is learnt together: how large the columns of a band are, and how many are there at all.
struct FormBand {
  double rareness = 1.0;  ///< alpha of pi ~ Beta(alpha, 1).
  int groups = 0;         ///< Also those that were left out: they count as absent.
  int kept = 0;
  double extra_mm2 = 0.0;  ///< Mean over the kept groups of KeptGroup::extra_mm2.
  bool always = false;     ///< Its groups are there in every draw.
  double least_mm2 = 0.0;  ///< The size is not below this.
};

/// A group that takes part in the draws.
struct KeptGroup {
  std::size_t source = 0;  ///< Into FormColumns::groups().
  Eigen::Index first = 0;  ///< Into the columns of the model.
  int width = 1;
  std::size_t band = 0;
  double extra_mm2 = 0.0;  ///< Variance that correlated noise gives its coefficients.
};

/// The form model of docs/uncertainty.md on one cloud: what stands before the first draw. All
/// values are weighted, so that every point has the same variance.
class FormModel {
 public:
  /// @param spectrum  Declared terms, in place of what the cloud shows by itself; or none.
  /// @param expected_spots  Of a part, > 0.
  FormModel(const FormCloud& cloud, const ErrorModel& errors, const FormSpectrum* spectrum,
            double expected_spots);

  [[nodiscard]] const FormColumns& columns() const { return columns_; }
  /// Mean square of what X^T of the deviations is, of each group, over their number [mm^2].
  [[nodiscard]] const Eigen::VectorXd& energy_mm2() const { return energy_; }
  /// Points that a robust start leaves out, as a share; beyond a fifth there is no smooth form.
  [[nodiscard]] double flagged_share() const;
  /// Standard deviation of what the start leaves unexplained [mm].
  [[nodiscard]] double residual_mm() const { return residual_mm_; }
  [[nodiscard]] std::size_t points() const { return static_cast<std::size_t>(y_.size()); }

 private:
  friend class FormChain;

  void weigh(const FormCloud& cloud, const ErrorModel& errors);
  void start();
  void screen();
  void assemble();
  void correlate(const FormCloud& cloud, const ErrorModel& errors);
  void find_bands();
  void find_joint();
  void first_state();
  [[nodiscard]] bool orthogonal() const { return gram_.size() == 0; }

  Eigen::VectorXd root_weight_;
  double noise_mm2_ = 0.0;     ///< Of a point, mean.
  double residual_mm2_ = 0.0;  ///< The part of it that neighbours do not share.
  double freedom_ = 0.0;       ///< Degrees of freedom of the noise; 0: known.
  double expected_spots_ = 0.5;
  FormColumns columns_;
  bool declared_ = false;
  bool absolute_ = false;
  Eigen::VectorXd y_;        ///< Deviations, free of place, size and tilt.
  Eigen::VectorXd imputed_;  ///< Those, as the start takes them.
  std::vector<std::size_t> flagged_;
  double residual_mm_ = 0.0;
  double power_mm2_ = 0.0;  ///< Mean square of the imputed deviations.
  Eigen::VectorXd energy_;  ///< Of each group.
  std::vector<std::size_t> kept_sources_;
  std::vector<KeptGroup> groups_;
  std::vector<FormBand> bands_;
  Eigen::MatrixXd systematic_;  ///< Declared modes.
  Eigen::MatrixXd all_;         ///< rigid, systematic, form: one column each.
  Eigen::Index base_ = 0;       ///< First column of form.
  Eigen::VectorXd square_;      ///< Of each column, summed.
  Eigen::MatrixXd gram_;        ///< Empty where the columns are orthogonal.
  bool joint_all_ = false;
  std::vector<bool> joint_;      ///< Columns that are drawn together.
  double spectrum_power_ = 0.0;  ///< Mean square of a declared spectrum of size 1.
  // First state.
  Eigen::VectorXd coefficients_;
  std::vector<bool> on_;
  std::vector<double> size_mm2_;
};

/// One form that may stand behind the deviations.
struct FormDraw {
  Eigen::VectorXd form_mm;         ///< At the points.
  std::vector<std::size_t> spots;  ///< Points that stand out by themselves.
  Eigen::VectorXd coefficients;    ///< Of all columns of the model.
  double unresolved_mm2 = 0.0;     ///< Variance of what is rougher than the columns.
  double noise_mm2 = 0.0;          ///< Variance of the error of a point.
  int groups = 0;                  ///< That are there.
  double scatter_1 = 0.0;          ///< Of the residual, over the noise; without unresolved form.
};

/// A chain of draws: a pure function of the model, the seed and its number.
class FormChain {
 public:
  FormChain(const FormModel& model, std::uint64_t seed, std::uint64_t number);

  /// The next draw.
  const FormDraw& next();
  [[nodiscard]] core::KeyedNoise& noise() { return noise_; }

 private:
  void sweep();
  void draw_variances();
  void draw_spots();
  void draw_rigid();
  void draw_group(std::size_t g);
  void draw_together();
  void draw_bands();
  void predict();
  void draw_form();
  void move(Eigen::Index column, double by);
  void impute(std::size_t row, double value);
  [[nodiscard]] double pull(Eigen::Index column) const;
  [[nodiscard]] double gamma(double shape);
  [[nodiscard]] double least_size(const FormBand& band) const;
  [[nodiscard]] double floor_mm2() const;

  const FormModel& model_;
  core::KeyedNoise noise_;
  int sweeps_ = 0;
  Eigen::VectorXd coefficients_;  ///< Form and, where noise is correlated, its share of them.
  Eigen::VectorXd form_;          ///< The form in them.
  std::vector<bool> on_;
  std::vector<double> size_mm2_;
  std::vector<double> share_1_;  ///< pi of each band.
  std::vector<bool> spot_;
  std::vector<std::size_t> candidates_;
  Eigen::VectorXd y_;
  Eigen::VectorXd pull_;  ///< X^T y, less what the coefficients explain where columns overlap.
  Eigen::VectorXd prediction_;
  Eigen::VectorXd shape_;  ///< The form in the prediction.
  double unresolved_mm2_ = 0.0;
  double noise_mm2_ = 0.0;
  double variance_mm2_ = 0.0;  ///< Of the residual: both.
  double scatter_1_ = 0.0;
  FormDraw draw_;
};

}  // namespace rondure::evaluation
