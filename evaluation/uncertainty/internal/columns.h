#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "evaluation/uncertainty/cloud.h"
#include "evaluation/uncertainty/internal/point_layout.h"
#include "evaluation/uncertainty/spectrum.h"

namespace rondure::evaluation {

/// Columns that enter or leave the model together: cos and sin of one undulation times one degree.
struct FormGroup {
  double undulations = 0.0;           ///< Undulations; on an arc half waves, counted per full turn.
  int harmonic = 0;                   ///< Undulations; on an arc, half waves along it.
  int degree = 0;                     ///< Degree along the axis.
  std::vector<Eigen::Index> columns;  ///< Column indices; one or two.
  /// Octave of the undulations and class of the degree (0; 1 and 2; 3 and more): groups of one
  /// class share a common size.
  int octave = 0;
  int degree_class = 0;
};

/// Places of a whole surface, in even angular steps, with the factors that the columns need there.
struct FormGrid {
  int undulations = 0;  ///< The most undulations that the grid resolves.
  Eigen::VectorXd angles_rad;
  Eigen::VectorXd heights_mm;
  Eigen::VectorXd heights_1;  ///< Heights, normalised as in the columns.
  Eigen::MatrixXd cosines;    ///< One row per angle, one column per undulation.
  Eigen::MatrixXd sines;
  Eigen::MatrixXd along;  ///< One row per height, one column per degree.
};

/// The columns of a form model at the points of a cloud: undulations times polynomials along the
/// axis, without position, size and tilt. Values are recomputed where they are needed: 5000 points
/// have 1200 columns.
class FormColumns {
 public:
  /// All forms that the points can distinguish, orthonormal over them.
  FormColumns(const FormCloud& cloud, const Eigen::VectorXd& root_weights);
  /// The terms of a declared spectrum, including the motions of the part: a form that equals a
  /// change of size at few points is form between them.
  FormColumns(const FormCloud& cloud, const Eigen::VectorXd& root_weights,
              const FormSpectrum& spectrum);

  [[nodiscard]] const PointLayout& layout() const { return layout_; }
  [[nodiscard]] const std::vector<FormGroup>& groups() const { return groups_; }
  [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(columns_.size()); }
  [[nodiscard]] int most_undulations() const { return most_undulations_; }
  [[nodiscard]] int most_degree() const { return most_degree_; }

  /// Position, size and tilt: n x 5 (3 for each section), orthogonal, mean square 1.
  [[nodiscard]] const Eigen::MatrixXd& rigid() const { return rigid_; }

  /// X^T values, for all columns.
  [[nodiscard]] Eigen::VectorXd products(const Eigen::VectorXd& values) const;
  /// Columns of some groups, in their order.
  [[nodiscard]] Eigen::MatrixXd matrix(std::span<const std::size_t> groups) const;

  /// A grid of a full turn, for forms with at most `undulations`.
  [[nodiscard]] FormGrid grid(int undulations, int angles, const Eigen::VectorXd& heights_mm) const;
  /// Values of a form on a grid: one row per angle, one column per height.
  /// Of sections, the heights are theirs, in their order.
  /// @param coefficients  Of all columns; those with more undulations than the grid has must be 0.
  [[nodiscard]] Eigen::MatrixXd on_grid(const Eigen::VectorXd& coefficients,
                                        const FormGrid& grid) const;

 private:
  struct Column {
    int harmonic = 0;  ///< Of a face: power along one side, and `degree` along the other.
    int degree = 0;
    bool sine = false;
    double scale = 1.0;
    Eigen::VectorXd rigid;  ///< Its component in rigid_; empty where motions stay.
  };

  void make_rigid(const FormCloud& cloud, const Eigen::VectorXd& root_weights);
  [[nodiscard]] Eigen::VectorXd heights_1(const Eigen::VectorXd& heights_mm) const;
  void make_polynomials(const Eigen::VectorXd& q, int degrees);
  [[nodiscard]] Eigen::MatrixXd polynomials(const Eigen::VectorXd& q) const;
  [[nodiscard]] Eigen::MatrixXd radial_polynomials(int undulations) const;
  void make_sides();
  void project(std::vector<Column> wanted);
  void visit(const std::function<void(std::size_t, const Eigen::VectorXd&)>& work) const;

  PointLayout layout_;
  Eigen::VectorXd height_mm_;
  Eigen::VectorXd radial_1_;  ///< Of a face touched on circles: their radii; else empty.
  /// Of a face without circles: polynomials along its sides, the first weighted; else empty.
  std::array<Eigen::MatrixXd, 2> sides_;
  Eigen::VectorXd root_weight_;
  double middle_mm_ = 0.0;
  double reach_mm_ = 0.0;  ///< Height of q = 1 above the middle.
  bool legendre_ = false;
  bool sections_ = false;
  Eigen::MatrixXd recurrence_;  ///< Shift and scale of each polynomial.
  Eigen::MatrixXd along_;       ///< Polynomials at the points, weighted.
  Eigen::MatrixXd rigid_;
  Eigen::MatrixXd rigid_map_;  ///< Map from 1, cos, sin, q cos, q sin to rigid_.
  std::vector<Column> columns_;
  std::vector<FormGroup> groups_;
  int most_undulations_ = 0;
  int most_degree_ = 0;
};

}  // namespace rondure::evaluation
