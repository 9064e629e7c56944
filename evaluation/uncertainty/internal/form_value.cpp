#include "evaluation/uncertainty/internal/form_value.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fit/least_squares/circle.h"
#include "fit/least_squares/cylinder.h"

namespace rondure::evaluation {
namespace {

using record::Reference;

/// Zone weights of a one-sided reference.
fit::ZoneWeights weights_of(Reference reference) {
  return reference == Reference::kMinimumCircumscribed ? fit::kMinimumCircumscribed
                                                       : fit::kMaximumInscribed;
}

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Start of trials about a one-sided cylinder, in the frame of the cloud.
fit::Axis start_of(const FormCloud& cloud, fit::CylinderZoneFitter& fitter) {
  const Reference reference = cloud.reference;
  if (reference == Reference::kMinimumZone || reference == Reference::kLeastSquares) return {};
  std::vector<Eigen::Vector3d> points;
  for (const FormPoint& p : cloud.points) {
    const double r = cloud.radius_mm + p.deviation_mm;
    points.emplace_back(r * std::cos(p.angle_rad), r * std::sin(p.angle_rad), p.height_mm);
  }
  const auto best = fitter.fit(points, fit::Axis().direction, weights_of(reference));
  return best ? best->place : fit::Axis();
}

}  // namespace

FormValue::FormValue(const FormCloud& cloud, std::span<const FormPoint> places)
    : kind_(cloud.kind), reference_(cloud.reference), radius_(cloud.radius_mm) {
  for (const FormPoint& place : places) {
    directions_.emplace_back(std::cos(place.angle_rad), std::sin(place.angle_rad), place.height_mm);
  }
  space_.resize(directions_.size());
  if (kind_ == FormKind::kRoundness || kind_ == FormKind::kSections) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto section = static_cast<std::size_t>(places[i].section);
      if (section >= sections_.size()) sections_.resize(section + 1);
      ++sections_[section].count;
      rows_.push_back(i);
    }
    std::stable_sort(rows_.begin(), rows_.end(), [&](std::size_t a, std::size_t b) {
      return places[a].section < places[b].section;
    });
    for (std::size_t s = 1; s < sections_.size(); ++s) {
      sections_[s].first = sections_[s - 1].first + sections_[s - 1].count;
    }
  }
  if (cloud.kind == FormKind::kCylindricity) start_ = start_of(cloud, cylinders_);
}

double FormValue::of(const Eigen::VectorXd& deviations_mm) {
  if (!sections_.empty()) {
    double greatest = 0.0;
    for (Section& section : sections_) {
      const double value = of_circle(section, deviations_mm);
      if (std::isnan(value)) return kNone;
      greatest = std::max(greatest, value);
    }
    return greatest;
  }
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    const double r = radius_ + deviations_mm[static_cast<Eigen::Index>(i)];
    const Eigen::Vector3d& d = directions_[i];
    space_[i] = {r * d.x(), r * d.y(), d.z()};
  }
  return of_cylinder();
}

double FormValue::of_circle(Section& section, const Eigen::VectorXd& deviations_mm) {
  plane_.resize(section.count);
  for (std::size_t k = 0; k < section.count; ++k) {
    const std::size_t i = rows_[section.first + k];
    const double r = radius_ + deviations_mm[static_cast<Eigen::Index>(i)];
    plane_[k] = {r * directions_[i].x(), r * directions_[i].y()};
  }
  if (reference_ == Reference::kMinimumZone) {
    auto circle = circles_.fit_from(plane_, section.center);
    if (circle.ending != fit::ZoneEnding::kConverged) {
      circle = circles_.fit_from(plane_, Eigen::Vector2d::Zero());
    }
    section.center = circle.place;
    return circle.width_mm();
  }
  if (reference_ == Reference::kLeastSquares) {
    const auto circle = fit::ls_circle(plane_);
    return circle ? circle->deviation_mm : kNone;
  }
  const auto circle = circles_.fit(plane_, weights_of(reference_));
  return circle ? circle->width_mm() : kNone;
}

double FormValue::of_cylinder() {
  const fit::Axis axis;
  if (reference_ == Reference::kMinimumZone) {
    auto cylinder = cylinders_.fit_from(space_, start_);
    if (cylinder.ending != fit::ZoneEnding::kConverged) {
      cylinder = cylinders_.fit_from(space_, axis);
    }
    start_ = cylinder.place;
    return cylinder.width_mm();
  }
  if (reference_ == Reference::kLeastSquares) {
    const auto cylinder = fit::ls_cylinder(space_, axis.direction);
    return cylinder ? cylinder->deviation_mm : kNone;
  }
  const auto cylinder = cylinders_.fit_from(space_, start_, weights_of(reference_), radius_);
  return cylinder.ending == fit::ZoneEnding::kConverged ? cylinder.width_mm() : kNone;
}

}  // namespace rondure::evaluation
