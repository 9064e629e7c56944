#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "fit/geometry/column_extremes.h"
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

}  // namespace rondure::fit
