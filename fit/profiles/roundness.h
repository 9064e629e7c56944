#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/error.h"
#include "core/result.h"
#include "core/words.h"
#include "fit/geometry/points.h"
#include "fit/profiles/closed_profile.h"
#include "fit/profiles/form_parameters.h"
#include "fit/profiles/harmonics.h"
#include "fit/profiles/profile_filter.h"
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

/// Settings of a roundness evaluation.
struct RoundnessOptions {
  FilterOptions filter;
  std::vector<CircleReference> references = {CircleReference::kLs, CircleReference::kMz};
  int highest_harmonic = 50;  ///< Fewer if the points determine fewer; 0: no table.
  bool inside = false;        ///< True for a bore: peaks point to the centre.
};

/// Roundness of one section, with all intermediate results.
struct RoundnessEvaluation {
  std::size_t points = 0;  ///< Rows given.
  FilterOptions filter;    ///< As requested.
  Sampling sampling;
  std::size_t samples = 0;    ///< Number of values evaluated: after resampling, or the points.
  bool interpolated = false;  ///< Resampled by a periodic cubic spline.
  double resampling_error_mm = 0.0;
  int filter_iterations = 0;
  AngularProfile measured;        ///< Profile in order of angle, before the filter.
  std::vector<double> theta_rad;  ///< Angles evaluated; contacts are rows of these.
  std::vector<double> r_mm;  ///< The filtered profile there (points: relative to the LS circle).
  std::vector<Roundness> values;        ///< One for each reference that exists, in order.
  std::vector<CircleReference> absent;  ///< Requested, but not existing; see `warnings`.
  HarmonicTable harmonics;              ///< Harmonics before the filter.
  std::vector<core::Error> warnings;
};

/// Evaluates a profile of deviations r(theta) in the limacon model. Sorts, resamples and filters
/// the profile and fits the reference circles.
///
/// @param theta_rad  Any order, any number of turns.
/// @return kNoPoints, kNotFinite (row), kTooFewPoints; the errors of check_sampling(); kSampling
///         also for a gap of a quarter undulation or more at the cut-off (unless overridden);
///         kNotFullSection for a filter on an arc, and for any arc below 20 deg; the errors of the
///         fits.
/// Source: methods, roundness part B.
[[nodiscard]] core::Result<RoundnessEvaluation> evaluate_profile(std::span<const double> theta_rad,
                                                                 std::span<const double> r_mm,
                                                                 const RoundnessOptions& options);

/// Evaluates points of a plane section. Angles and radii are taken about the least-squares centre.
/// The filtered profile is converted back to points about it, to which the circles are fitted
/// exactly. Without a filter the circles are fitted to the points as given.
/// @return as evaluate_profile(); also kCollinear.
[[nodiscard]] core::Result<RoundnessEvaluation> evaluate_section(PlanePoints points_mm,
                                                                 const RoundnessOptions& options);

}  // namespace rondure::fit
