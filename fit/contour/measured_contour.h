#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/error.h"
#include "core/result.h"
#include "fit/contour/error.h"

namespace rondure::fit {

/// How the rows of a roundness gauge are to be read.
struct MeasuredContourOptions {
  /// Gauge angle of the direction from O to the pin centre, known from the set-up.
  double phase_offset_rad = 0.0;
  int direction = 1;           ///< 1: gauge angles run as beta; -1: against it.
  std::size_t samples = 1440;  ///< M of the result.
  double nominal_mm = 24.56;   ///< Radius of the journal.
  ContourErrorOptions error;   ///< Base circle, filter, and whether the gauge has filtered.
};

/// What the upper end of a spectrum tells of a filter the gauge has applied.
struct FilterTrace {
  double upper_rms_mm = 0.0;  ///< Above 3 times the cut-off.
  /// Cut-off of a Gaussian filter that fits the fall of the amplitudes, where one does.
  std::optional<double> cutoff_upr;
  bool filtered = false;  ///< Hardly anything is left up there: no bare surface looks like that.
};

/// A contour of a gauge as contour error on the angles 2 pi m / M.
struct MeasuredContour {
  ContourError contour;
  std::size_t rows = 0;
  double largest_gap_rad = 0.0;
  FilterTrace filter;
  std::vector<core::Error> warnings;
};

/// What is left above the cut-off in a contour on uniform angles: less than 0.01 um and 1 % of its
/// form is the mark of a filter; a ground surface keeps more.
///
/// @param resolved_upr  Undulations the rows of the gauge resolve, half their number; below 4 times
///                      the cut-off nothing can be said.
[[nodiscard]] FilterTrace filter_trace(std::span<const double> deviation_mm, double cutoff_upr,
                                       double resolved_upr);

/// Brings a contour to the zero, the sense and the points of the method, then takes circle and
/// filter off.
///
/// @param angle_rad     Gauge angles, one way round, one turn, n >= 16.
/// @param deviation_mm  Radii or their deviations from any constant.
/// @return kMeaning (different lengths, direction not +-1), kTooFewPoints, kNotFinite (row),
///         kAngleOrder (row) where the angle goes back, kNotFullSection for a gap above 1 deg;
///         contour_error()'s. Warnings: kSparse for missing samples below 1 deg, kFilteredTwice
///         for a contour that seems filtered and is filtered again, kUndersampled for an unfiltered
///         one of more rows than samples that holds more than 0.01 um rms beyond them, kUnits for a
///         contour below 0.05 um or above 1 mm.
/// Source: methods, contour sections 4, 7 and 9.
[[nodiscard]] core::Result<MeasuredContour> measured_contour(
    std::span<const double> angle_rad, std::span<const double> deviation_mm,
    const MeasuredContourOptions& options = {});

}  // namespace rondure::fit
