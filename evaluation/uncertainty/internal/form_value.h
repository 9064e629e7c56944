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
  /// Points of one section, with the start of searches for its circle.
  struct Section {
    std::size_t first = 0;  ///< Of the rows in `rows_`.
    std::size_t count = 0;
    Eigen::Vector2d center = Eigen::Vector2d::Zero();
  };

  [[nodiscard]] double of_circle(Section& section, const Eigen::VectorXd& deviations_mm);
  [[nodiscard]] double of_cylinder();

  FormKind kind_;
  record::Reference reference_;
  fit::Axis start_ = {};  ///< Start of searches for a cylinder.
  std::vector<Section> sections_;
  std::vector<std::size_t> rows_;  ///< Of the places, section by section.
  double radius_;
  std::vector<Eigen::Vector3d> directions_;  ///< cos, sin, height.
  std::vector<Eigen::Vector2d> plane_;
  std::vector<Eigen::Vector3d> space_;
  fit::CircleZoneFitter circles_;
  fit::CylinderZoneFitter cylinders_;
};

}  // namespace rondure::evaluation
