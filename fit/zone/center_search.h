#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "core/words.h"
#include "fit/geometry/points.h"

namespace rondure::fit {

/// A point that becomes a contact when the centre moves far enough along a direction.
struct ContactCandidate {
  std::size_t index = 0;
  /// It becomes as near as the inner contact; otherwise as far as the outer one.
  bool inner = false;
  double step_mm = 0.0;  ///< Exact length of the move that makes it a contact, > 1e-9.
};

/// Returns all candidates of a move from `center_mm` along the unit vector `direction`, in order of
/// their steps. The steps are exact, as the difference of two squared distances is a linear
/// function of the move. The contacts in `outer` and `inner` are left out; of each set, the one
/// that stays extreme is the reference. Source: methods, cylindricity section 6, formulas 6.2
/// and 6.3.
/// @pre `outer` and `inner` are not empty and hold valid rows of `points_mm`.
[[nodiscard]] std::vector<ContactCandidate> contact_candidates(PlanePoints points_mm,
                                                               const Eigen::Vector2d& center_mm,
                                                               const Eigen::Vector2d& direction,
                                                               std::span<const std::size_t> outer,
                                                               std::span<const std::size_t> inner);

inline constexpr int kCenterMoveLimit = 100;  ///< Most moves of one search.

/// One move of a centre search.
struct CenterMove {
  Eigen::Vector2d from_mm = Eigen::Vector2d::Zero();
  double width_mm = 0.0;           ///< Width of the zone before the move [mm].
  std::vector<std::size_t> outer;  ///< Contacts before the move.
  std::vector<std::size_t> inner;
  Eigen::Vector2d direction = Eigen::Vector2d::Zero();
  double descent = 0.0;  ///< Rate at which the zone shrinks, |p_h - p_l|; 0 as published.
  ContactCandidate met;  ///< The new contact that ended the move.
};

/// Result of a centre search.
struct CenterSearch {
  enum class Ending {
    kCross,       ///< Two outer and two inner contacts alternate: a strict local minimum.
    kSpoke,       ///< An outer and an inner contact on one ray: stationary to first order.
    kCoCircular,  ///< All points on one circle within the contact tolerance.
    kUnbounded,   ///< No point limits the move: the points do not surround the centre.
    kMoveLimit,   ///< 100 moves made.
  };
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();
  double inner_radius_mm = 0.0;  ///< Least distance of all points from the final centre [mm].
  double outer_radius_mm = 0.0;
  std::vector<std::size_t> outer;  ///< Contacts at the end of the search.
  std::vector<std::size_t> inner;
  std::vector<CenterMove> moves;
  Ending ending = Ending::kMoveLimit;  ///< Why the search ended.

  /// f [306] = largest minus least distance of all points at the final centre.
  [[nodiscard]] double width_mm() const { return outer_radius_mm - inner_radius_mm; }
};

RONDURE_WORDS(CenterSearch::Ending, {kCross, "cross"}, {kSpoke, "spoke"},
              {kCoCircular, "co-circular"}, {kUnbounded, "unbounded"}, {kMoveLimit, "move-limit"});

/// Iterative minimum-zone centre search [301-306], corrected.
///
/// Starts at the algebraic least-squares centre. At each centre the unit vectors to the contacts
/// span two convex polygons, outer and inner; the shortest vector between these is the direction of
/// steepest descent of the zone. The centre moves along it exactly until a new point comes into
/// contact. The search ends where the polygons meet: outer and inner contacts alternate.
///
/// @param points_mm  At least 3 different points of a projected section [mm].
/// @return kNoPoints, kNotFinite, kTooFewPoints, kCollinear (from algebraic_circle()). Every other
///         outcome is an `ending`. Mean 2.3 moves, O(n) each.
/// Source: methods, cylindricity sections 6 and 7.
[[nodiscard]] core::Result<CenterSearch> center_search(PlanePoints points_mm);

/// The same search in the most favourable reading of the published text (reading D of the method
/// specification): bisector directions with correct signs and the mirror branch, but with the fixed
/// exchange of contacts, and with the chord test on contacts that are never checked again. In 3 to
/// 17 % of full sections it ends at a wrong centre and still reports "cross"; kept for comparison
/// only. Parameters and errors as center_search().
/// Source: methods, cylindricity section 8.
[[nodiscard]] core::Result<CenterSearch> center_search_as_published(PlanePoints points_mm);

}  // namespace rondure::fit
