#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "core/noise.h"
#include "evaluation/uncertainty/internal/form_value.h"
#include "evaluation/uncertainty/internal/sampler.h"

namespace rondure::evaluation {

/// The value of a whole surface: of a grid on it, with crests between its places interpolated by
/// parabolas, together with the sampled points. Never below the value of the points.
class WholeSurface {
 public:
  /// @param low_mm,high_mm  Ends along the axis, in the heights of the cloud.
  /// @param declared        The form is a declared spectrum: it has nothing finer than its terms.
  WholeSurface(const FormCloud& cloud, const FormColumns& columns, double low_mm, double high_mm,
               bool declared);

  /// @param noise  Source of the random form that the points do not resolve.
  [[nodiscard]] double of(const FormDraw& draw, core::KeyedNoise& noise);

 private:
  struct Level {
    FormGrid grid;
    std::unique_ptr<FormValue> value;
  };

  Level& level_for(int undulations);
  void add_waves(const FormDraw& draw, core::KeyedNoise& noise, const FormGrid& grid,
                 Eigen::MatrixXd& surface) const;

  const FormCloud& cloud_;
  const FormColumns& columns_;
  Eigen::VectorXd heights_mm_;
  bool declared_;
  int undulations_ = 1;        ///< The most undulations of any form.
  std::vector<Level> levels_;  ///< Each finer than the previous one; created when first needed.
  Eigen::VectorXd all_mm_;
};

}  // namespace rondure::evaluation
