#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "fit/geometry/axis.h"
#include "fit/geometry/column_extremes.h"
#include "fit/geometry/points.h"
#include "fit/geometry/working_points.h"
#include "fit/geometry/zone_rows.h"

namespace rondure::fit {

/// The centre of a circle (D = 2) or a sphere (D = 3) during the iteration, relative to an origin
/// near the points. The unknowns are its coordinates.
template <int D>
class CenterFrame {
 public:
  static constexpr int kUnknowns = D;
  static constexpr int kDimension = D;
  static constexpr bool kHasBall = true;  ///< EnclosingBall minimises the outer distance.
  using Point = Eigen::Matrix<double, D, 1>;
  using Place = Point;  ///< Reference of the distances in a scan.

  explicit CenterFrame(const Point& center_mm) : center_(center_mm) {}

  [[nodiscard]] const Point& center() const { return center_; }
  [[nodiscard]] CenterFrame moved(const Point& x_mm) const { return CenterFrame(center_ + x_mm); }
  /// The centre in the frame of the data.
  [[nodiscard]] Place place(const Point& origin) const { return origin + center_; }
  /// The centre after the rounding of place(), so that scan and iteration use the same centre.
  [[nodiscard]] CenterFrame snapped(const Point& origin) const {
    return CenterFrame(place(origin) - origin);
  }
  /// Whether the centre is farther than `limit_mm` from that of `from`, or not finite.
  [[nodiscard]] bool strayed(const CenterFrame& from, double limit_mm) const {
    return !((center_ - from.center_).norm() <= limit_mm);
  }

  [[nodiscard]] double distance(const Point& p) const { return (p - center_).norm(); }
  [[nodiscard]] ContactRow<D> contact_row(const Point& p, std::size_t index) const;
  /// Distances and gradients of all points. @return The extreme distances.
  Extremes linearise(const WorkingPoints<D>& points, ZoneRows<D>& rows) const;

 private:
  Point center_;
};

/// An axis during the iteration, with the four unknowns that move it, all in mm: shifts a, b across
/// the axis and tilts scaled by the half length Z of the points, x = (a, b, Z tx, Z ty). The frame
/// follows the axis, so that the linearisation is always at tilt 0.
///
/// Points are given relative to an origin near them. Source: methods, certificates section 1.
class CylinderFrame {
 public:
  static constexpr int kUnknowns = 4;
  static constexpr int kDimension = 3;
  static constexpr bool kHasBall = false;
  using Point = Eigen::Vector3d;
  using Place = Axis;  ///< Reference of the distances in a scan.

  /// @param half_length_mm  Z > 0: the scale of the tilts.
  CylinderFrame(const Axis& axis, double half_length_mm);

  [[nodiscard]] const Axis& axis() const { return axis_; }
  [[nodiscard]] double half_length_mm() const { return half_length_; }
  /// Two unit vectors across the axis, along which a and b are measured.
  [[nodiscard]] const Eigen::Matrix<double, 3, 2>& across_axis() const { return across_; }
  /// The axis after a move x.
  [[nodiscard]] CylinderFrame moved(const Eigen::Vector4d& x_mm) const;

  /// The axis in the frame of the data.
  [[nodiscard]] Place place(const Eigen::Vector3d& origin) const;
  /// The axis after the rounding of place(), so that scan and iteration use the same axis.
  [[nodiscard]] CylinderFrame snapped(const Eigen::Vector3d& origin) const;
  /// Whether the axis is farther than `limit_mm` from that of `from`, or inclined to it by more
  /// than 10 deg. Always false for an infinite limit.
  [[nodiscard]] bool strayed(const CylinderFrame& from, double limit_mm) const;

  [[nodiscard]] double distance(const Eigen::Vector3d& p) const;
  /// Distance with its first and second derivative.
  [[nodiscard]] ContactRow<4> contact_row(const Eigen::Vector3d& p, std::size_t index) const;
  /// Distances and gradients of all points. @return The extreme distances.
  Extremes linearise(const WorkingPoints<3>& points, ZoneRows<4>& rows) const;

 private:
  Axis axis_;
  Eigen::Matrix<double, 3, 2> across_;
  double half_length_;
};

/// Half the extent of the points along a direction [mm].
[[nodiscard]] double half_extent(SpacePoints points, const Eigen::Vector3d& direction);

}  // namespace rondure::fit
