#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include <Eigen/Core>

#include "core/phrase.h"
#include "core/words.h"
#include "fit/geometry/axis.h"
#include "fit/geometry/contacts.h"
#include "fit/geometry/points.h"

namespace rondure::fit {

/// The extent to which a minimum zone, or a one-sided reference, is proven to be optimal.
struct Certificate {
  enum class Kind {
    kNone,  ///< Nothing is proven; `reason` explains why.
    /// A strict local minimum: multipliers >= 0, no point outside, growth in all directions.
    kLocal,
    kGlobal,  ///< No better zone exists within `scope`.
  };
  Kind kind = Kind::kNone;
  core::Phrase scope;   ///< "all centres", "all directions", "next to the least-squares axis".
  double gap_mm = 0.0;  ///< Reported value minus proven lower bound [mm].
  core::Phrase reason;  ///< Why the kind is not higher; empty for kGlobal.
};

/// What an optimum is needed for. A trial of the uncertainty takes the one next to the
/// least-squares feature, without its proof.
enum class Proof { kFull, kNone };

RONDURE_WORDS(Certificate::Kind, {kNone, "none"}, {kLocal, "local"}, {kGlobal, "global"});

/// A zone as stated by any source: radii, and contacts with their multipliers. A minimum
/// circumscribed or maximum inscribed reference has contacts on one side only; the radius of the
/// other side is then that of its most distant point and claims nothing.
struct StatedZone {
  double inner_radius_mm = 0.0;
  double outer_radius_mm = 0.0;
  std::span<const Contact> outer;
  std::span<const Contact> inner;
};

/// Result of check_zone().
struct ZoneCheck {
  double outside_mm = 0.0;      ///< Distance of the worst point from the zone.
  double off_contact_mm = 0.0;  ///< Distance of the worst contact from its radius.
  double weight_error = 0.0;    ///< Greatest negative multiplier, or deviation of a sum from 1.
  double imbalance = 0.0;       ///< |sum lam grad r_h - sum mu grad r_l|, worst unknown.
  /// To first order, no place within one zone width has a value (the width, or the radius of a
  /// one-sided reference) better by more than this [mm].
  double gap_mm = 0.0;
  std::string fault;  ///< First condition that does not hold, in words; empty if all hold.
};

/// Checks the contacts and multipliers of a stated zone. Shares no code with the solvers: distances
/// by cross product, gradients by central differences, in the unknowns a, b, Z tx, Z ty (Z: half
/// the length of the points along the axis). With contacts on one side only, that side is checked;
/// without contacts, only that no point is outside.
///
/// @param tolerance_mm  Tolerance of distances; at least 1e-9 of the size of the coordinates is
///                      sensible. The other tolerances are fixed: 1e-9 for multipliers, 1e-6 for
///                      the imbalance.
/// @return `fault` is empty if the zone passes.
[[nodiscard]] ZoneCheck check_zone(SpacePoints points_mm, const Axis& axis, const StatedZone& zone,
                                   double tolerance_mm = 1e-9);
[[nodiscard]] ZoneCheck check_zone(PlanePoints points_mm, const Eigen::Vector2d& center_mm,
                                   const StatedZone& zone, double tolerance_mm = 1e-9);

}  // namespace rondure::fit
