#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "fit/zone_fit.h"
#include "reports/form_cloud.h"

namespace rondure::reports {

/// The minimum zone of given places with varying deviations, without proof and, after the first
/// call, without memory: for loops. Starts at the axis the angles count about.
class FormValue {
 public:
  /// @param radius_mm  > 0.
  FormValue(FormKind kind, double radius_mm, std::span<const FormPoint> places);

  /// The zone [mm] of radius + deviation at each place.
  [[nodiscard]] double of(const Eigen::VectorXd& deviations_mm);

 private:
  FormKind kind_;
  double radius_;
  std::vector<Eigen::Vector3d> directions_;  ///< cos, sin, height.
  std::vector<Eigen::Vector2d> plane_;
  std::vector<Eigen::Vector3d> space_;
  fit::CircleZoneFitter circles_;
  fit::CylinderZoneFitter cylinders_;
};

}  // namespace rondure::reports
