#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "fit/geometry/center_frame.h"
#include "fit/geometry/cylinder_frame.h"
#include "fit/geometry/enclosing_ball.h"
#include "fit/geometry/scan.h"
#include "fit/proof/local_certificate.h"
#include "fit/zone/contacts.h"
#include "fit/zone/ending.h"
#include "fit/zone/simplex.h"
#include "fit/zone/working_points.h"

namespace rondure::fit {

/// Size of rounding errors of a distance: relative coordinates carry the error of the given ones.
/// @param size_mm  Largest absolute coordinate.
[[nodiscard]] double distance_round_off(double size_mm);

/// Up to so many points a descent works on all of them.
inline constexpr std::size_t kAllWorked = 128;

/// Where a descent ended.
template <class Frame>
struct Descent {
  explicit Descent(const Frame& start) : frame(start) {}

  Frame frame;     ///< Relative to the origin.
  Extremes zone;   ///< Of all points.
  Contacts outer;  ///< By row of the data, multipliers of each side sum to 1.
  Contacts inner;
  int passes = 0;           ///< Over all points.
  int linear_programs = 0;  ///< Linear programs solved.
  int pivots = 0;
  ZoneEnding ending = ZoneEnding::kLimit;
};

/// Goes from a place to a local minimum of  outer weight * max r - inner weight * min r  (minimum
/// zone, minimum circumscribed, maximum inscribed): linear programs inside a trust region, Newton
/// on the stationarity equations of the contacts where curvature holds the place, and ways out of
/// saddles and of valleys that weak contacts close. Circumscribed circles and spheres need none of
/// it: EnclosingBall.
///
/// Up to kAllWorked points all are worked on. Of more, a sample is; then passes over all points add
/// those that stick out farthest, at most one a block, until none does: the optimum of a subset
/// that holds all points is the optimum of the whole. An object keeps its memory between calls.
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
  /// @param origin     A point near them, on which `start` rests.
  /// @param round_off  As distance_round_off().
  /// @param limit_mm   How far the place may go from the start (see Frame::strayed); minimum zones
  ///                   need none.
  Result run(Points points, const Point& origin, const Frame& start, const ZoneWeights& weights,
             double round_off, double limit_mm = std::numeric_limits<double>::infinity());

 private:
  struct Newton;

  [[nodiscard]] double value(const Extremes& zone) const {
    return weights_.outer * zone.high - weights_.inner * zone.low;
  }
  void take(Points points, const Point& origin, std::size_t row);
  void minimise_large(Points points, const Point& origin, const Frame& start, double limit_mm,
                      Result& state);
  bool add_violators(Points points, const Point& origin, const Result& state);
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
  bool vertex_ = false;    ///< As many contacts as unknowns hold the last place.
  bool polished_ = false;  ///< Newton settled on the contacts of the last place.
  bool coarse_ = false;    ///< Near the minimum is near enough: of a sample.
  bool warm_ = false;      ///< The programme has a basis to start from.
  WorkingPoints<D> working_;
  ZoneRows<K> rows_;
  ZoneRows<K> trial_rows_;   ///< At the place a step leads to.
  ZoneRows<K> looked_rows_;  ///< Of extremes(), which wants no more than these.
  ZoneSimplex<K> program_;
  EnclosingBall<D> ball_;
  BlockScan blocks_;
  std::vector<std::size_t> order_;
};

extern template class ZoneDescent<CenterFrame<2>>;
extern template class ZoneDescent<CenterFrame<3>>;
extern template class ZoneDescent<CylinderFrame>;

}  // namespace rondure::fit
