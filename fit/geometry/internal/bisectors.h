#pragma once

#include <Eigen/Core>

#include "fit/geometry/points.h"

namespace rondure::fit {

/// The best centre of all candidates.
struct BisectorSearch {
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();
  double width_mm = 0.0;
  double strip_mm = 0.0;  ///< Least width of a strip that holds the points.
  bool complete = false;  ///< No centre of the whole plane has a narrower zone.
};

/// Finds the exact global minimum-zone centre of a small set. A minimum lies where two
/// perpendicular bisectors of point pairs cross, so the search tries all crossings inside the disc
/// that can hold a better centre than the start.
///
/// For a full section the disc is some tens of micrometres wide. For an arc it follows from the
/// least width S of a strip that holds the points: farther out every zone is wider than that of the
/// start.
///
/// @param points_mm  n >= 3, finite.
/// @param start_mm   A good centre; its zone determines the disc around it.
/// @return `complete` is false only if S is not above the zone found: the narrowest zone may then
///         be a strip, with its centre at infinity. Cost n^4/8 crossings.
/// Source: methods, cylindricity sections 9.1 and 9.2, certificates section 2.
[[nodiscard]] BisectorSearch search_bisectors(PlanePoints points_mm,
                                              const Eigen::Vector2d& start_mm);

}  // namespace rondure::fit
