#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/proof/certificate.h"
#include "fit/geometry/deviation_range.h"
#include "fit/profiles/form_parameters.h"

namespace rondure::fit {

/// Reference circles of ISO 12181-1. A further one is one enumerator, its name and its case in
/// roundness_of_points() and roundness_of_profile().
enum class CircleReference {
  kLs,  ///< LSCI, least squares.
  kMz,  ///< MZCI, minimum zone.
  kMc,  ///< MCCI, minimum circumscribed.
  kMi,  ///< MICI, maximum inscribed.
};

/// "ls", "mz", "mc", "mi".
[[nodiscard]] std::string_view name_of(CircleReference reference);

/// Roundness about one reference circle.
struct Roundness {
  CircleReference reference = CircleReference::kLs;
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();
  double radius_mm = 0.0;  ///< Of a zone: its middle. Of a profile of deviations: their level.
  double total_mm = 0.0;   ///< RONt: peak to valley.
  /// RONp, RONv, RONq: defined about the least-squares circle only.
  std::optional<FormParameters> parameters;
  std::vector<std::size_t> outer;  ///< Rows that carry the outer circle of kMz, the circle of kMc.
  std::vector<std::size_t> inner;  ///< Those of the inner circle of kMz, the circle of kMi.
  Certificate certificate;         ///< kNone for kLs.
  /// Of kMc and kMi where several circles are as good and RONt differs: `total_mm` is about one of
  /// them.
  std::optional<DeviationRange> range;

  /// Distance of the centre from the origin of the profile [mm].
  [[nodiscard]] double eccentricity_mm() const { return center_mm.norm(); }
};

/// What the parameters of roundness need beside the data.
struct RoundnessSide {
  std::span<const double> cells = {};  ///< Angle each value stands for, in RONq; empty: all alike.
  bool inside = false;                 ///< A bore: peaks point to the centre.
};

/// Roundness of points of a plane section: the circle fits of ls_circle.h, min_zone_circle.h and
/// one_sided_center.h.
/// @return their errors.
[[nodiscard]] core::Result<Roundness> roundness_of_points(
    std::span<const Eigen::Vector2d> points_mm, CircleReference reference,
    const RoundnessSide& side = {});

/// Roundness of a profile whose nominal radius is not known or of no interest: small deviations
/// from a circle, r = r0 + a cos(theta) + b sin(theta) + form (limacon). The references are then
/// linear problems: least squares by QR; the others by one linear programme each, global by
/// duality. They differ from the circles of points by some form^2 / r0.
///
/// @param theta_rad, r_mm  n >= 3 (MZ: 4) values [rad, mm].
/// @return kNoPoints, kNotFinite, kTooFewPoints, kRank (fewer than 3 different angles),
///         kNotConverged; kReferenceAbsent for MC and MI of a profile with a gap of 180 deg or
///         more, into which their centre runs away.
/// Source: methods, roundness B.3 to B.5; cylindricity 11.4.
[[nodiscard]] core::Result<Roundness> roundness_of_profile(std::span<const double> theta_rad,
                                                           std::span<const double> r_mm,
                                                           CircleReference reference,
                                                           const RoundnessSide& side = {});

}  // namespace rondure::fit
