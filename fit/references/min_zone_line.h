#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/axis.h"
#include "fit/geometry/contacts.h"
#include "fit/geometry/points.h"
#include "fit/proof/certificate.h"

namespace rondure::fit {

/// The smallest cylinder about a line in space that holds all points.
struct MinZoneLine {
  Axis axis;
  double diameter_mm = 0.0;       ///< Straightness of the line (ISO 1101, zone with diameter sign).
  std::vector<Contact> contacts;  ///< Points that determine the cylinder; multipliers sum to 1.
  /// Of three points global, of more local at best: next to the least-squares line.
  Certificate certificate;
};

/// Finds the minimum-zone straightness of a line in space, or of a median line given by the centres
/// of its sections: the diameter of the minimum circumscribed cylinder next to the least-squares
/// line.
///
/// @param points_mm  n >= 2 different points, any order [mm].
/// @param proof      kNone: axis and diameter alone, without contacts and certificate.
/// @return as ls_line(). Same input, same bits. Cost: as ZoneDescent; of few points the proof costs
///         more than the search.
/// Sources: ISO 1101, ISO 12780-1; methods, cylindricity section 11.4.
[[nodiscard]] core::Result<MinZoneLine> min_zone_line(SpacePoints points_mm,
                                                      Proof proof = Proof::kFull);

}  // namespace rondure::fit
