#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "evaluation/uncertainty/cloud.h"
#include "fit/zone/fit.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// The form value at given places with varying deviations, about the reference of a cloud, without
/// proof: for loops. Minimum zones allocate no memory after the first call. A search starts where
/// the previous one ended; one for a one-sided cylinder, which has several close optima for few
/// points, at the best one of the deviations of the cloud. The same calls in the same order give
/// the same bits.
class FormValue {
 public:
  /// @param cloud   Gives kind, reference and radius; its places are not used.
  FormValue(const FormCloud& cloud, std::span<const FormPoint> places);

  /// The value [mm] of radius + deviation at each place: radial peak to valley about the reference;
  /// NaN where that reference does not exist.
  [[nodiscard]] double of(const Eigen::VectorXd& deviations_mm);

 private:
  [[nodiscard]] double of_circle();
  [[nodiscard]] double of_cylinder();

  FormKind kind_;
  record::Reference reference_;
  fit::Axis start_ = {};                              ///< Start of searches for a cylinder.
  Eigen::Vector2d center_ = Eigen::Vector2d::Zero();  ///< Start of searches for a circle.
  double radius_;
  std::vector<Eigen::Vector3d> directions_;  ///< cos, sin, height.
  std::vector<Eigen::Vector2d> plane_;
  std::vector<Eigen::Vector3d> space_;
  fit::CircleZoneFitter circles_;
  fit::CylinderZoneFitter cylinders_;
};

}  // namespace rondure::evaluation
