#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/noise.h"
#include "evaluation/uncertainty/cloud.h"
#include "evaluation/uncertainty/influences.h"

namespace rondure::evaluation {

/// A touched point as the influences act on it, of a surface of any kind.
struct TouchedPoint {
  Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();  ///< Tip centre, machine frame.
  /// Unit normal along which deviations count, machine frame.
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d approach = -Eigen::Vector3d::UnitZ();  ///< Unit vector, along the normal.
  double radius_mm = 0.0;    ///< Distance along the normal that grows with the part: nominal,
  double distance_mm = 0.0;  ///< and as measured.
  int repeats = 1;           ///< Number of touches that the point is the mean of.
  int pose = 0;              ///< Fixture pose in which it was touched.
  double time_1 = 0.0;       ///< From 0 (first touch) to 1 (last touch).
};

/// The points of a cloud, in its order.
[[nodiscard]] std::vector<TouchedPoint> touched_points(const FormCloud& cloud);

/// Distribution of the random number of a mode; its variance is always 1.
enum class Distribution {
  kNormal,
  kRectangular,
  kPhase,  ///< sqrt(2) cos psi and sqrt(2) sin psi, psi uniform: two columns.
};

/// One systematic error: one draw per inspection moves all points by its column.
struct ErrorMode {
  std::size_t influence = 0;  ///< Index into ErrorModel::names.
  Distribution distribution = Distribution::kNormal;
  Eigen::Index column = 0;  ///< The first of one or two columns.
};

/// An independent error of each point.
struct PointError {
  std::size_t influence = 0;
  Distribution distribution = Distribution::kNormal;
  Eigen::VectorXd sigma_mm;         ///< Standard deviation, one per point.
  double degrees_of_freedom = 0.0;  ///< Degrees of freedom of `sigma_mm`; 0: known exactly.
  /// Correlation of each point's error with that of the previous point; empty: independent.
  Eigen::VectorXd likeness_1 = {};
};

/// Effect of the declared influences on each point, along its normal, to first order.
struct DeclaredModes {
  std::vector<std::string> names;  ///< Names of the declared influences.
  std::vector<ErrorMode> modes;
  std::vector<PointError> point_errors;
  std::vector<Eigen::VectorXd> columns;  ///< Columns of the modes [mm].
};

/// Draws the random number of each mode: one coefficient for each column, of variance 1.
[[nodiscard]] Eigen::VectorXd drawn_coefficients(const DeclaredModes& declared,
                                                 core::KeyedNoise& noise);

/// Every declared number as a mode, including motions of the whole part. Points of several surfaces
/// share each mode.
[[nodiscard]] DeclaredModes declared_modes(std::span<const TouchedPoint> points,
                                           const Influences& influences);

/// The declared influences as they act on the deviations of a cloud, to first order: along the
/// normals, without motions or a change of size of the whole part.
class ErrorModel {
 public:
  /// @param influences  As accepted by check_influences().
  ErrorModel(const FormCloud& cloud, const Influences& influences);
  /// @param rigid  Orthonormal columns of what counts as motion and size: rigid_basis().
  ErrorModel(std::span<const TouchedPoint> points, const Eigen::MatrixXd& rigid,
             const Influences& influences);

  /// Names of the declared influences, including those that change no form.
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  /// Systematic errors, n x k, unit variance each.
  [[nodiscard]] const Eigen::MatrixXd& columns() const { return columns_; }
  /// Variance of the independent errors of each point [mm^2].
  [[nodiscard]] const Eigen::VectorXd& point_variance_mm2() const { return point_variance_; }
  /// Degrees of freedom of that variance (Welch and Satterthwaite); 0: known exactly.
  [[nodiscard]] double degrees_of_freedom() const { return degrees_of_freedom_; }
  /// Path length over which the errors of neighbours correlate [mm]; 0: independent points.
  [[nodiscard]] double correlation_mm() const { return correlation_mm_; }

  /// Whether an influence changes any form: some were declared as zero, some move the part as a
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
