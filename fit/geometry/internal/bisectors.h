#pragma once

#include <span>

#include <Eigen/Core>

namespace rondure::fit {

/// Best centre found by trying every candidate.
struct BisectorSearch {
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();
  double width_mm = 0.0;
  double strip_mm = 0.0;            ///< Least width of a strip that holds the points.
  double radius_searched_mm = 0.0;  ///< Of the disc that holds every centre as good as the start.
  bool complete = false;            ///< No centre, however far, has a narrower zone.
};

/// Exact global minimum-zone centre of a small set: a minimum lies where two perpendicular
/// bisectors of point pairs cross, so all crossings are tried, or those inside the disc that can
/// hold a better centre.
///
/// @param points_mm  n >= 3, finite.
/// @param start_mm   A good centre; the disc around it follows from its zone.
/// For a full section the disc is some tens of micrometres wide. For an arc it follows from the
/// least width S of a strip that holds the points: farther out every zone is wider than the
/// start's.
///
/// @return `complete` is false only where S is not above the zone found: then the narrowest zone
/// may
///         be a strip, with its centre at infinity. Cost n^4/8 crossings.
/// Source: methods, cylindricity sections 9.1 and 9.2, certificates section 2.
[[nodiscard]] BisectorSearch search_bisectors(std::span<const Eigen::Vector2d> points_mm,
                                              const Eigen::Vector2d& start_mm);

}  // namespace rondure::fit
