#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "fit/geometry/column_extremes.h"
#include "fit/geometry/contacts.h"
#include "fit/geometry/working_points.h"

namespace rondure::fit {

/// The smallest circle (D = 2) or sphere (D = 3) that encloses a set of points.
template <int D>
struct Ball {
  Eigen::Matrix<double, D, 1> center_mm = Eigen::Matrix<double, D, 1>::Zero();
  Extremes zone;        ///< Least and largest distance of the points from the centre.
  Contacts outer;       ///< Points on the ball; their mean by multipliers >= 0 is the centre.
  int exchanges = 0;    ///< Points that entered or left the contacts.
  bool solved = false;  ///< false: round-off or the limit of 1000 exchanges ended the search.
};

/// Minimum circumscribed circles and spheres. They need no linear programme: the squared distances
/// are |p|^2 - 2 p c + |c|^2, linear in c except for a term common to all points, so the dual is a
/// quadratic programme in at most D + 1 contacts whose simplex step has a closed form: the farthest
/// point enters, contacts whose multiplier would turn negative leave. The radius grows with every
/// point that enters, up to the optimum, which is unique.
///
/// An object keeps its memory, and its contacts as the next start. Cost: one pass over the working
/// points for each point that enters, commonly five to eight. Sources: methods, cylindricity
/// section 11.4; D. Goldfarb, A. Idnani, Mathematical Programming 27 (1983) (dual active sets);
/// K. Fischer, B. Gaertner, SoCG 2003 (balls).
template <int D>
class EnclosingBall {
 public:
  using Point = Eigen::Matrix<double, D, 1>;

  /// @param points     At least one.
  /// @param again      Start from the contacts of the last call; `points` begins with its points.
  /// @param round_off  Rounding error of a distance [mm]; a point outside by less than twice this
  ///                   is on the ball.
  Ball<D> enclose(const WorkingPoints<D>& points, bool again, double round_off);

 private:
  static constexpr int kMost = D + 2;  // including the entering point

  void start(const WorkingPoints<D>& points, Ball<D>& out);
  std::size_t look(const WorkingPoints<D>& points);
  void append(const WorkingPoints<D>& points, std::size_t row, double multiplier);
  void drop(int i);
  bool enter(Ball<D>& out);
  template <int M>
  [[nodiscard]] bool balance(Eigen::Matrix<double, D + 1, 1>& target) const;
  [[nodiscard]] bool balance(Eigen::Matrix<double, D + 1, 1>& target) const;
  [[nodiscard]] Eigen::Matrix<double, D + 1, 1> dependence() const;

  int count_ = 0;  ///< Number of contacts; the entering one is the last.
  std::array<std::size_t, kMost> rows_{};
  std::array<Point, kMost> points_;
  std::array<double, kMost> multipliers_{};
  Point center_ = Point::Zero();
  double square_ = 0.0;         ///< Squared radius.
  Extremes squares_;            ///< Extremes of the squared distances of all points.
  std::vector<double> column_;  ///< The squared distances.
};

}  // namespace rondure::fit
