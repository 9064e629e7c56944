#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "evaluation/uncertainty/cloud.h"
#include "fit/zone/fit.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// The form value of given places with varying deviations, about the reference of a cloud, without
/// proof: for loops. Minimum zones take no memory after the first call. Searches start where the
/// one before ended; those for one-sided cylinders, of which few points have several close to one
/// another, at the best one of the deviations of the cloud. An object gives the same bits for the
/// same calls in the same order.
class FormValue {
 public:
  /// @param cloud   Kind, reference and radius are taken of it, the places are not.
  FormValue(const FormCloud& cloud, std::span<const FormPoint> places);

  /// The value [mm] of radius + deviation at each place: radial peak to valley about the reference;
  /// NaN where there is no such reference.
  [[nodiscard]] double of(const Eigen::VectorXd& deviations_mm);

 private:
  [[nodiscard]] double of_circle();
  [[nodiscard]] double of_cylinder();

  FormKind kind_;
  record::Reference reference_;
  fit::Axis start_ = {};                              ///< Of searches for a cylinder.
  Eigen::Vector2d center_ = Eigen::Vector2d::Zero();  ///< Of searches for a circle.
  double radius_;
  std::vector<Eigen::Vector3d> directions_;  ///< cos, sin, height.
  std::vector<Eigen::Vector2d> plane_;
  std::vector<Eigen::Vector3d> space_;
  fit::CircleZoneFitter circles_;
  fit::CylinderZoneFitter cylinders_;
};

}  // namespace rondure::evaluation
