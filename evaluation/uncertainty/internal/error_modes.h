#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/noise.h"
#include "evaluation/uncertainty/cloud.h"
#include "evaluation/uncertainty/influences.h"

namespace rondure::evaluation {

/// How the random number of a mode is distributed; its variance is always 1.
enum class Distribution {
  kNormal,
  kRectangular,
  kPhase,  ///< sqrt(2) cos psi and sqrt(2) sin psi, psi uniform: two columns.
};

/// One systematic error: one draw an inspection moves all points by its column.
struct ErrorMode {
  std::size_t influence = 0;  ///< Into ErrorModel::names.
  Distribution distribution = Distribution::kNormal;
  Eigen::Index column = 0;  ///< The first of one, or of two.
};

/// An error that each point has for itself.
struct PointError {
  std::size_t influence = 0;
  Distribution distribution = Distribution::kNormal;
  Eigen::VectorXd sigma_mm;         ///< Standard deviation, one a point.
  double degrees_of_freedom = 0.0;  ///< Behind it; 0: known.
  /// Likeness of each point's error to that of the point before; empty: each point anew.
  Eigen::VectorXd likeness_1 = {};
};

/// What the declared influences do to each point, along its normal, to first order.
struct DeclaredModes {
  std::vector<std::string> names;  ///< Of the influences declared.
  std::vector<ErrorMode> modes;
  std::vector<PointError> point_errors;
  std::vector<Eigen::VectorXd> columns;  ///< Of the modes [mm].
};

/// Every number declared, as modes; motions of the whole part still in them.
[[nodiscard]] DeclaredModes declared_modes(const FormCloud& cloud, const Influences& influences);

/// The declared influences as they act on the deviations of a cloud, to first order: along the
/// normals, without what only moves or resizes the part as a whole.
class ErrorModel {
 public:
  /// @param influences  As check_influences() accepts them.
  ErrorModel(const FormCloud& cloud, const Influences& influences);

  /// Names of the influences declared, also of those that move no form.
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  /// Systematic errors, n x k, unit variance each.
  [[nodiscard]] const Eigen::MatrixXd& columns() const { return columns_; }
  /// Variance of the errors that each point has for itself [mm^2].
  [[nodiscard]] const Eigen::VectorXd& point_variance_mm2() const { return point_variance_; }
  /// Degrees of freedom of it (Welch and Satterthwaite); 0: known.
  [[nodiscard]] double degrees_of_freedom() const { return degrees_of_freedom_; }
  /// Way over which the errors of neighbours are alike [mm]; 0: each point anew.
  [[nodiscard]] double correlation_mm() const { return correlation_mm_; }

  /// Whether an influence moves any form: some were declared as zero, some move the part as a
  /// whole.
  [[nodiscard]] bool acts(std::size_t influence) const;

  /// The errors of one inspection [mm], of all influences or of one alone.
  void draw(core::KeyedNoise& noise, const std::optional<std::size_t>& only,
            Eigen::VectorXd& errors_mm) const;

 private:
  std::vector<std::string> names_;
  std::vector<ErrorMode> modes_;
  std::vector<PointError> point_errors_;
  Eigen::MatrixXd columns_;
  Eigen::VectorXd point_variance_;
  double degrees_of_freedom_ = 0.0;
  double correlation_mm_ = 0.0;
};

}  // namespace rondure::evaluation
