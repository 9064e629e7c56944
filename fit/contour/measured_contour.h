#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/error.h"
#include "core/result.h"
#include "fit/contour/error.h"
#include "fit/profiles/profile_filter.h"

namespace rondure::fit {

/// Conventions of the rows of a roundness gauge, and settings of the evaluation.
struct MeasuredContourOptions {
  /// Gauge angle of the direction from O to the pin centre, known from the set-up.
  double phase_offset_rad = 0.0;
  int direction = 1;           ///< 1: gauge angles increase with beta; -1: against it.
  std::size_t samples = 1440;  ///< M of the result.
  double nominal_mm = 24.56;   ///< Radius of the journal.
  ContourErrorOptions error;   ///< Base circle, filter, and whether the gauge has filtered.
};

/// Signs of a filter that the gauge has applied: less than 0.01 um and 1 % of the form above 3
/// times the cut-off; a ground surface has more.
struct FilterTrace {
  double upper_rms_mm = 0.0;  ///< rms above 3 times the cut-off.
  /// The Gaussian filter by which the amplitudes fall, if there is one.
  std::optional<PassedFilter> passed;
  bool filtered = false;  ///< Less remains above the cut-off than on an unfiltered surface.

  /// Whether that filter is another one than that of `cutoff_upr`.
  [[nodiscard]] bool other_than(double cutoff_upr) const {
    return passed && (passed->below(cutoff_upr) || passed->above(cutoff_upr));
  }
};

/// A contour from a gauge as a contour error at the angles 2 pi m / M.
struct MeasuredContour {
  ContourError contour;
  std::size_t rows = 0;
  double largest_gap_rad = 0.0;
  /// Step from the last row to the first, the slope taken off; 0 where their angles lie apart.
  double seam_mm = 0.0;
  double rough_mm = 0.0;  ///< Standard deviation of such steps elsewhere, by their median.
  FilterTrace filter;
  std::vector<core::Error> warnings;
};

/// Converts a contour to the zero angle, direction and sampling of the method, then filters it and
/// removes the base circle.
///
/// @param angle_rad     Gauge angles, in one direction, one turn, n >= 16.
/// @param deviation_mm  Radii or their deviations from any constant.
/// @return kMeaning (different lengths, direction not +-1), kTooFewPoints, kNotFinite (row),
///         kAngleOrder (row) where the angle decreases, kNotFullSection for a gap above 1 deg; the
///         errors of contour_error(). Warnings: kSparse for missing samples below 1 deg,
///         kFilteredTwice for a contour that seems filtered and is filtered again, kInconsistent
///         for one that the gauge has filtered at another cut-off than stated, kUndersampled
///         for an unfiltered one of more rows than samples that contains more than 0.01 um rms
///         beyond them, kUnits for a contour below 0.05 um or above 1 mm.
/// Source: methods, contour sections 4, 7 and 9.
[[nodiscard]] core::Result<MeasuredContour> measured_contour(
    std::span<const double> angle_rad, std::span<const double> deviation_mm,
    const MeasuredContourOptions& options = {});

}  // namespace rondure::fit
