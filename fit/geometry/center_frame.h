#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "fit/proof/local_certificate.h"
#include "fit/zone/working_points.h"
#include "fit/zone/simplex.h"

namespace rondure::fit {

/// The centre of a circle (D = 2) or a sphere (D = 3) under iteration, relative to an origin near
/// the points; its unknowns are its coordinates.
template <int D>
class CenterFrame {
 public:
  static constexpr int kUnknowns = D;
  static constexpr int kDimension = D;
  static constexpr bool kHasBall = true;  ///< EnclosingBall minimises the outer distance.
  using Point = Eigen::Matrix<double, D, 1>;
  using Place = Point;  ///< What a scan measures from.

  explicit CenterFrame(const Point& center_mm) : center_(center_mm) {}

  [[nodiscard]] const Point& center() const { return center_; }
  [[nodiscard]] CenterFrame moved(const Point& x_mm) const { return CenterFrame(center_ + x_mm); }
  /// The centre in the frame of the data.
  [[nodiscard]] Place place(const Point& origin) const { return origin + center_; }
  /// The centre that rounding of place() leaves, so that a scan and the iteration see the same.
  [[nodiscard]] CenterFrame snapped(const Point& origin) const {
    return CenterFrame(place(origin) - origin);
  }
  /// Whether it went farther from another than a limit.
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

extern template class CenterFrame<2>;
extern template class CenterFrame<3>;

}  // namespace rondure::fit
