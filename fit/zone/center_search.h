#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"

namespace rondure::fit {

/// A point that would become a contact when the centre moves along a direction.
struct ContactCandidate {
  std::size_t index = 0;
  bool inner = false;    ///< Becomes as near as the inner reference; otherwise as far as the outer.
  double step_mm = 0.0;  ///< Exact move at which it does; > 0.
};

/// All candidates of a move from `center` along the unit vector `direction`, by step.
///
/// The squared distances of two points stay a linear function of the move, so each step is exact.
/// Contacts in `outer` and `inner` are left out; of each set the one that stays extreme is the
/// reference. Source: methods, cylindricity section 6, formulas 6.2 and 6.3.
[[nodiscard]] std::vector<ContactCandidate> contact_candidates(
    std::span<const Eigen::Vector2d> points_mm, const Eigen::Vector2d& center_mm,
    const Eigen::Vector2d& direction, std::span<const std::size_t> outer,
    std::span<const std::size_t> inner);

inline constexpr int kCenterMoveLimit = 100;  ///< Moves of one search.

/// One move of a centre search, for the log and for tests.
struct CenterMove {
  Eigen::Vector2d from_mm = Eigen::Vector2d::Zero();
  double width_mm = 0.0;           ///< Zone before the move.
  std::vector<std::size_t> outer;  ///< Contacts before the move.
  std::vector<std::size_t> inner;
  Eigen::Vector2d direction = Eigen::Vector2d::Zero();
  double descent = 0.0;  ///< Rate at which the zone shrinks, |p_h - p_l|; 0 as published.
  ContactCandidate met;  ///< The new contact that ended the move.
};

/// Where a centre search ended.
struct CenterSearch {
  enum class Ending {
    kCross,       ///< Two outer and two inner contacts alternate: a strict local minimum.
    kSpoke,       ///< An outer and an inner contact on one ray: stationary to first order.
    kCoCircular,  ///< All points on one circle within the contact tolerance.
    kUnbounded,   ///< No point limits the move: the points do not surround the centre.
    kMoveLimit,   ///< 100 moves made.
  };
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();
  double inner_radius_mm = 0.0;  ///< Least distance of all points at the end.
  double outer_radius_mm = 0.0;
  std::vector<std::size_t> outer;  ///< Contacts the search holds at its end.
  std::vector<std::size_t> inner;
  std::vector<CenterMove> moves;
  Ending ending = Ending::kMoveLimit;

  /// f [306] = largest minus least distance of all points at the final centre.
  [[nodiscard]] double width_mm() const { return outer_radius_mm - inner_radius_mm; }
};

/// "cross", "spoke", "co-circular", "unbounded", "move-limit".
[[nodiscard]] std::string_view name_of(CenterSearch::Ending ending);

/// Iterative minimum-zone centre search [301-306], corrected.
///
/// Starts at the algebraic least-squares centre. At each centre the contacts' unit vectors span two
/// convex polygons, outer and inner; the shortest vector between them is the steepest descent of
/// the zone. The centre moves along it until a new point comes into contact, exactly. It ends where
/// the polygons meet: outer and inner contacts alternate.
///
/// @param points_mm  At least 3 different points of a projected section [mm].
/// @return kNoPoints, kNotFinite, kTooFewPoints, kCollinear (from algebraic_circle()). Every other
///         outcome is an `ending`. Mean 2.3 moves, O(n) each.
/// Source: methods, cylindricity sections 6 and 7.
[[nodiscard]] core::Result<CenterSearch> center_search(std::span<const Eigen::Vector2d> points_mm);

/// The same search in the most charitable reading of the published text (reading D of the method
/// specification): bisector directions with correct signs and the mirror branch, but the fixed
/// exchange of contacts, and the chord test on contacts it never checks again. It ends at a wrong
/// centre in 3 to 17 % of full sections and still says "cross"; kept for comparison only.
/// Source: methods, cylindricity section 8.
[[nodiscard]] core::Result<CenterSearch> center_search_as_published(
    std::span<const Eigen::Vector2d> points_mm);

}  // namespace rondure::fit
