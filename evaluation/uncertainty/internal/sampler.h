#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/noise.h"
#include "evaluation/uncertainty/internal/columns.h"
#include "evaluation/uncertainty/internal/error_modes.h"

namespace rondure::evaluation {

/// Logarithm of the odds that a point is a spot, from its residual of the model.
/// @param per_point  Expected number of spots per point.
[[nodiscard]] double spot_log_odds(double rest_mm, double variance_mm2, double per_point);

/// Logarithm of the likelihood ratio of the data with a column of normal size and without it.
/// @param product  Column times the residual of the other columns.
/// @param square   Column times itself.
[[nodiscard]] double column_evidence(double product, double square, double variance_mm2,
                                     double size_mm2);

/// Inputs for drawing the two variances of a residual.
struct VarianceTerms {
  double stated_mm2 = 0.0;          ///< Declared noise, > 0.
  double degrees_of_freedom = 0.0;  ///< Degrees of freedom of the declared noise; 0: known exactly.
  double power_mm2 = 0.0;           ///< Mean square of the deviations.
  double floor_mm2 = 0.0;           ///< Least variance of unresolved form.
  /// Too few points are left to show how large form is: any size of it is as likely.
  bool flat = false;
};

/// One pair of variances; the unresolved one is uniform over a step of its logarithm.
struct VarianceOdd {
  double noise_mm2 = 0.0;
  double unresolved_mm2 = 0.0;
  double probability_1 = 0.0;
  double log_step = 0.0;
};
using VarianceOdds = std::vector<VarianceOdd>;

/// @param squares_mm2  Sum of the squares of the residuals of `count` points.
[[nodiscard]] VarianceOdds variance_odds(const VarianceTerms& terms, double squares_mm2,
                                         double count);

/// Learnt jointly for a band: the size of its columns, and how many of them are present.
struct FormBand {
  double rareness = 1.0;  ///< alpha of pi ~ Beta(alpha, 1).
  int groups = 0;         ///< Including those that were left out: they count as absent.
  int kept = 0;
  double extra_mm2 = 0.0;  ///< Mean over the kept groups of KeptGroup::extra_mm2.
  bool always = false;     ///< Its groups are present in every draw.
  double least_mm2 = 0.0;  ///< Lower bound of the size.
};

/// A group that takes part in the draws.
struct KeptGroup {
  std::size_t source = 0;  ///< Index into FormColumns::groups().
  Eigen::Index first = 0;  ///< Index of the first column in the model.
  int width = 1;
  std::size_t band = 0;
  double extra_mm2 = 0.0;  ///< Variance that correlated noise gives its coefficients.
};

/// What the points see of a declared spectrum, free of position, size and tilt: covariances of as
/// many numbers as there are points, however many columns the spectrum has.
struct SeenSpectrum {
  Eigen::MatrixXd free;        ///< Orthonormal columns: values at the points without a motion.
  Eigen::MatrixXd columns;     ///< Systematic errors, then form.
  Eigen::MatrixXd systematic;  ///< Covariance that the systematic errors give.
  Eigen::MatrixXd form;        ///< Covariance that a form of size 1 gives.
};

/// The form model of docs/uncertainty.md on one cloud: the state before the first draw. All values
/// are weighted, so that every point has the same variance.
class FormModel {
 public:
  /// @param spectrum  Declared terms, which replace those that the cloud shows; or none.
  /// @param expected_spots  Expected number of spots on a part, > 0.
  FormModel(const FormCloud& cloud, const ErrorModel& errors, const FormSpectrum* spectrum,
            double expected_spots);

  [[nodiscard]] const FormColumns& columns() const { return columns_; }
  /// For each group, the mean square of X^T deviations divided by their number [mm^2].
  [[nodiscard]] const Eigen::VectorXd& energy_mm2() const { return energy_; }
  /// Fraction of points that a robust start leaves out; above a fifth there is no smooth form.
  [[nodiscard]] double flagged_share() const;
  /// Standard deviation of the residual of the start [mm].
  [[nodiscard]] double residual_mm() const { return residual_mm_; }
  [[nodiscard]] std::size_t points() const { return static_cast<std::size_t>(y_.size()); }

 private:
  friend class FormChain;

  void weigh(const FormCloud& cloud, const ErrorModel& errors);
  void start();
  void screen();
  void assemble();
  void correlate(const FormCloud& cloud, const ErrorModel& errors);
  void find_bands(FormKind kind);
  void find_joint();
  void find_seen();
  void first_state();
  [[nodiscard]] bool orthogonal() const { return gram_.size() == 0; }

  Eigen::VectorXd root_weight_;
  double noise_mm2_ = 0.0;     ///< Mean variance of a point.
  double residual_mm2_ = 0.0;  ///< The part of noise_mm2_ that neighbours do not share.
  double freedom_ = 0.0;       ///< Degrees of freedom of the noise; 0: known.
  double expected_spots_ = 0.5;
  FormColumns columns_;
  bool declared_ = false;
  bool absolute_ = false;
  Eigen::VectorXd removed_;  ///< Position, size and tilt in the deviations.
  Eigen::VectorXd y_;        ///< Deviations, free of position, size and tilt.
  Eigen::VectorXd imputed_;  ///< y_, as the start imputes it.
  std::vector<std::size_t> flagged_;
  double residual_mm_ = 0.0;
  double power_mm2_ = 0.0;  ///< Mean square of the imputed deviations.
  Eigen::VectorXd energy_;  ///< Energy of each group.
  std::vector<std::size_t> kept_sources_;
  std::vector<KeptGroup> groups_;
  std::vector<FormBand> bands_;
  Eigen::MatrixXd systematic_;  ///< Declared modes.
  Eigen::MatrixXd all_;         ///< rigid, systematic, form: one column each.
  Eigen::Index base_ = 0;       ///< First column of form.
  Eigen::VectorXd square_;      ///< Sum of squares of each column.
  Eigen::MatrixXd gram_;        ///< Empty where the columns are orthogonal.
  bool joint_all_ = false;
  std::vector<bool> joint_;           ///< Columns that are drawn together.
  bool flat_ = false;                 ///< See VarianceTerms.
  double spectrum_power_ = 0.0;       ///< Mean square of a declared spectrum of size 1.
  std::optional<SeenSpectrum> seen_;  ///< Of a declared spectrum with more columns than points.
  // First state.
  Eigen::VectorXd coefficients_;
  std::vector<bool> on_;
  std::vector<double> size_mm2_;
};

/// One form that is compatible with the deviations.
struct FormDraw {
  Eigen::VectorXd form_mm;  ///< Form at the points.
  /// Position, size and tilt at the points: deviations are place, form and errors.
  Eigen::VectorXd place_mm;
  std::vector<std::size_t> spots;  ///< Rows of the spots.
  Eigen::VectorXd coefficients;    ///< For all columns of the model.
  double unresolved_mm2 = 0.0;     ///< Variance of form rougher than the columns.
  double noise_mm2 = 0.0;          ///< Variance of the error of a point.
  int groups = 0;                  ///< Number of groups present.
  /// Scatter of the residual relative to the noise; without unresolved form.
  double scatter_1 = 0.0;
};

/// A chain of draws: a pure function of the model, the seed and the number of the chain.
class FormChain {
 public:
  FormChain(const FormModel& model, std::uint64_t seed, std::uint64_t number);

  const FormDraw& next();
  [[nodiscard]] core::KeyedNoise& noise() { return noise_; }

 private:
  void sweep();
  void draw_variances();
  void draw_spots();
  void draw_rigid();
  void draw_group(std::size_t g);
  void draw_together();
  void draw_seen();
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
  Eigen::VectorXd form_;          ///< The form given by the coefficients.
  std::vector<bool> on_;
  std::vector<double> size_mm2_;
  std::vector<double> share_1_;  ///< pi of each band.
  std::vector<bool> spot_;
  std::vector<std::size_t> candidates_;
  Eigen::VectorXd y_;
  /// X^T y, minus the part that the coefficients explain where columns overlap.
  Eigen::VectorXd pull_;
  Eigen::VectorXd prediction_;
  Eigen::VectorXd shape_;  ///< The form in the prediction.
  double unresolved_mm2_ = 0.0;
  double noise_mm2_ = 0.0;
  double variance_mm2_ = 0.0;  ///< Variance of the residual: noise and unresolved form.
  double scatter_1_ = 0.0;
  FormDraw draw_;
};

}  // namespace rondure::evaluation
