#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "fit/geometry/contacts.h"
#include "fit/geometry/enclosing_ball.h"
#include "fit/geometry/frames.h"
#include "fit/geometry/scan.h"
#include "fit/geometry/working_points.h"
#include "fit/zone/ending.h"
#include "fit/zone/local_certificate.h"
#include "fit/zone/simplex.h"

namespace rondure::fit {

/// Size of the rounding error of a distance [mm]; relative coordinates carry the error of the given
/// ones.
/// @param size_mm  Largest absolute coordinate [mm].
[[nodiscard]] double distance_round_off(double size_mm);

/// A descent works on all points of a set of this size or smaller.
inline constexpr std::size_t kAllWorked = 128;

/// Result of a descent.
template <class Frame>
struct Descent {
  explicit Descent(const Frame& start) : frame(start) {}

  Frame frame;     ///< Final place, relative to the origin.
  Extremes zone;   ///< Extreme distances of all points.
  Contacts outer;  ///< Rows of the data; the multipliers of each side sum to 1.
  Contacts inner;
  int passes = 0;           ///< Passes over all points.
  int linear_programs = 0;  ///< linear programs solved.
  int pivots = 0;
  ZoneEnding ending = ZoneEnding::kLimit;
};

/// Descends from a start to a local minimum of  outer weight * max r - inner weight * min r
/// (minimum zone, minimum circumscribed, maximum inscribed) by linear programs inside a trust
/// region, by Newton's method on the equations of the contacts where curvature determines the
/// minimum, and out of saddles and valleys that weak contacts close. Circumscribed circles and
/// spheres use EnclosingBall instead.
///
/// A set of more than kAllWorked points is represented by a sample; passes over all points add
/// those that stick out farthest, at most one per block, until none does: the optimum of a subset
/// is that of the whole set if its zone holds all points. An object keeps its memory between calls.
///
/// Cost: some 0.3 to 10 us up to 128 points; commonly two to four passes over more.
/// Sources: methods, cylindricity sections 9.3, 11.2 and 11.4; performance, the method in words.
template <class Frame>
class ZoneDescent {
 public:
  static constexpr int K = Frame::kUnknowns;
  static constexpr int D = Frame::kDimension;
  using Point = Eigen::Matrix<double, D, 1>;
  using Points = std::span<const Point>;
  using Result = Descent<Frame>;

  /// @param points     At least one, in the frame of the data.
  /// @param origin     A point near them, to which `start` is relative.
  /// @param round_off  Rounding error of a distance, see distance_round_off().
  /// @param limit_mm   Greatest distance from the start (see Frame::strayed); minimum zones need no
  ///                   limit.
  /// @return `ending` is kConverged at a local minimum, else it names the reason.
  Result run(Points points, const Point& origin, const Frame& start, const ZoneWeights& weights,
             double round_off, double limit_mm = std::numeric_limits<double>::infinity());

 private:
  struct Newton;

  void minimise_large(Points points, const Point& origin, const Frame& start, double limit_mm,
                      Result& state);
  std::size_t add_worst(Points points, const Point& origin, const Result& state, bool high);
  void minimise(Result& state, const Frame& start, double limit_mm);
  void enclose(Result& state);
  [[nodiscard]] Extremes linearise(const Frame& frame, ZoneRows<K>& rows) const;
  ZoneStep<K> programme(Result& state, double box);
  void settle(Result& state);
  bool stride(Result& state, double least);
  void settle_by_curvature(Result& state, double box);
  bool level(Result& state, const ZoneStep<K>& step);
  [[nodiscard]] bool is_vertex(const ZoneStep<K>& step) const;
  bool polish(Result& state);
  [[nodiscard]] Newton newton_step(const Result& state) const;
  [[nodiscard]] bool contacts_hold(const Result& state) const;
  [[nodiscard]] Eigen::Matrix<double, K, 1> curvature_of(const Result& state) const;
  void slip(Result& state);
  [[nodiscard]] Eigen::Matrix<double, K, 1> escape(const Result& state) const;
  bool leave_saddle(Result& state);
  [[nodiscard]] Extremes extremes(const Frame& frame);
  void name_rows(Contacts& contacts) const;

  ZoneWeights weights_;
  double round_off_ = 0.0;
  bool vertex_ = false;    ///< The last place is fixed by as many contacts as unknowns.
  bool polished_ = false;  ///< Newton's method converged on the contacts of the last place.
  bool coarse_ = false;    ///< Stop near the minimum, which is enough for a sample.
  bool warm_ = false;      ///< The linear program has a starting basis.
  WorkingPoints<D> working_;
  ZoneRows<K> rows_;
  ZoneRows<K> trial_rows_;   ///< Rows at the place to which a step leads.
  ZoneRows<K> looked_rows_;  ///< Scratch rows of extremes().
  ZoneSimplex<K> program_;
  EnclosingBall<D> ball_;
  BlockScan blocks_;
  std::vector<std::size_t> order_;
};

}  // namespace rondure::fit
