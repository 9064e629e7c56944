#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/error.h"
#include "core/result.h"
#include "fit/geometry/points.h"
#include "fit/profiles/closed_profile.h"
#include "fit/profiles/harmonics.h"
#include "fit/profiles/profile_filter.h"
#include "fit/profiles/roundness.h"

namespace rondure::fit {

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
