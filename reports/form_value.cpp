#include "reports/form_value.h"

#include <cmath>

namespace rondure::reports {

FormValue::FormValue(FormKind kind, double radius_mm, std::span<const FormPoint> places)
    : kind_(kind), radius_(radius_mm) {
  for (const FormPoint& place : places) {
    directions_.emplace_back(std::cos(place.angle_rad), std::sin(place.angle_rad), place.height_mm);
  }
  plane_.resize(directions_.size());
  space_.resize(directions_.size());
}

double FormValue::of(const Eigen::VectorXd& deviations_mm) {
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    const double r = radius_ + deviations_mm[static_cast<Eigen::Index>(i)];
    const Eigen::Vector3d& d = directions_[i];
    if (kind_ == FormKind::kRoundness) {
      plane_[i] = {r * d.x(), r * d.y()};
    } else {
      space_[i] = {r * d.x(), r * d.y(), d.z()};
    }
  }
  if (kind_ == FormKind::kRoundness) {
    return circles_.fit_from(plane_, Eigen::Vector2d::Zero()).width_mm();
  }
  return cylinders_.fit_from(space_, fit::Axis{}).width_mm();
}

}  // namespace rondure::reports
