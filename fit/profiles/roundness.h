#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "core/words.h"
#include "fit/geometry/points.h"
#include "fit/profiles/form_parameters.h"
#include "fit/proof/certificate.h"
#include "fit/zone/deviation_range.h"

namespace rondure::fit {

/// Reference circles of ISO 12181-1.
enum class CircleReference {
  kLs,  ///< LSCI, least squares.
  kMz,  ///< MZCI, minimum zone.
  kMc,  ///< MCCI, minimum circumscribed.
  kMi,  ///< MICI, maximum inscribed.
};

RONDURE_WORDS(CircleReference, {kLs, "ls"}, {kMz, "mz"}, {kMc, "mc"}, {kMi, "mi"});

/// Roundness about one reference circle.
struct Roundness {
  CircleReference reference = CircleReference::kLs;
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();
  double radius_mm = 0.0;  ///< Mean radius of a zone; for a profile of deviations, their level.
  double total_mm = 0.0;   ///< RONt: peak to valley.
  /// RONp, RONv, RONq: defined about the least-squares circle only.
  std::optional<FormParameters> parameters;
  std::vector<std::size_t> outer;  ///< Rows that determine the outer circle (kMz) or kMc.
  std::vector<std::size_t> inner;  ///< Rows that determine the inner circle (kMz) or kMi.
  Certificate certificate;         ///< kNone for kLs.
  /// Range of RONt, for kMc and kMi, if several circles are equally good and RONt differs between
  /// them; `total_mm` belongs to one of them.
  std::optional<DeviationRange> range;
};

/// Data that the parameters of roundness need in addition to the points.
struct RoundnessSide {
  std::span<const double> cells = {};  ///< Angle of each value, as weight in RONq; empty: equal.
  bool inside = false;                 ///< True for a bore: peaks point to the centre.
};

/// Computes the roundness of points of a plane section about a circle fitted by ls_circle(),
/// min_zone_circle(), min_circumscribed_circle() or max_inscribed_circle().
/// @return the errors of these functions.
[[nodiscard]] core::Result<Roundness> roundness_of_points(PlanePoints points_mm,
                                                          CircleReference reference,
                                                          const RoundnessSide& side = {});

/// Computes the roundness of a profile whose nominal radius is unknown or irrelevant: small
/// deviations from a circle, r = r0 + a cos(theta) + b sin(theta) + form (limacon). The references
/// are then linear problems: least squares by QR, the others by one linear programme each, which is
/// global by duality. They differ from the circles of points by some form^2 / r0.
///
/// @param theta_rad, r_mm  n >= 3 (MZ: 4) values [rad, mm].
/// @return kNoPoints, kNotFinite, kTooFewPoints, kRank (fewer than 3 different angles),
///         kNotConverged; kReferenceAbsent for MC and MI of a profile with a gap of 180 deg or
///         more, into which the centre would move without bound.
/// Source: methods, roundness B.3 to B.5; cylindricity 11.4.
[[nodiscard]] core::Result<Roundness> roundness_of_profile(std::span<const double> theta_rad,
                                                           std::span<const double> r_mm,
                                                           CircleReference reference,
                                                           const RoundnessSide& side = {});

}  // namespace rondure::fit
