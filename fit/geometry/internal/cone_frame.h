#pragma once

#include <utility>

#include <Eigen/Core>

#include "fit/geometry/frames.h"

namespace rondure::fit {

/// A cone during the iteration, with the five unknowns that move it, all in mm: the shifts of its
/// axis times cos phi, so that each moves the surface as far as it is long, the tilts of the axis
/// (CylinderFrame) and the half angle phi times the length Z. Points are given relative to an
/// origin near them.
///
/// The distance of a point is v = e cos phi - h sin phi, for the distance e from the axis and the
/// height h along it: v - D is the distance from the cone whose surface passes the point of the
/// axis at D. The cone opens along the axis if phi > 0.
///
/// Source: methods, drawing section 9.2.
class ConeFrame {
 public:
  static constexpr int kUnknowns = 5;
  using Step = Eigen::Matrix<double, kUnknowns, 1>;

  /// @param length_mm  Z > 0: the scale of the angles.
  ConeFrame(const Axis& axis, double half_angle_rad, double length_mm)
      : frame_(axis, length_mm), half_angle_(half_angle_rad) {}

  [[nodiscard]] const Axis& axis() const { return frame_.axis(); }
  [[nodiscard]] double half_angle_rad() const { return half_angle_; }
  [[nodiscard]] double length_mm() const { return frame_.half_length_mm(); }
  [[nodiscard]] double distance(const Eigen::Vector3d& p) const;
  [[nodiscard]] std::pair<double, Step> slope(const Eigen::Vector3d& p) const;
  /// Distance with its first and second derivative.
  [[nodiscard]] ContactRow<kUnknowns> contact_row(const Eigen::Vector3d& p,
                                                  std::size_t index) const;
  [[nodiscard]] ConeFrame moved(const Step& x_mm) const;
  [[nodiscard]] bool strayed(const ConeFrame& from) const {
    return frame_.strayed(from.frame_, length_mm());
  }

 private:
  CylinderFrame frame_;
  double half_angle_;
};

}  // namespace rondure::fit
