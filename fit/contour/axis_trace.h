#pragma once

#include <cstddef>
#include <vector>

#include "core/error.h"
#include "core/result.h"
#include "fit/contour/ground_contour.h"

namespace rondure::fit {

/// Recording of both axes by the control, sample by sample on a common time base.
struct AxisTrace {
  std::vector<double> c_rad;        ///< Commanded C position; wrapped or not, any number of turns.
  std::vector<double> c_error_rad;  ///< Error of C.
  std::vector<double> x_error_mm;   ///< Error of X.
  /// Commanded X position, to be checked against the geometry; empty if it was not recorded.
  std::vector<double> x_mm;
};

/// Conventions of a trace, and the number of samples of the result.
struct AxisTraceOptions {
  int error_sign = 1;          ///< 1: errors are actual minus command; -1: command minus actual.
  int c_direction = 1;         ///< 1: C is the polar angle of the wheel; -1: it turns against it.
  std::size_t samples = 1440;  ///< Number of samples of the result.
};

/// One turn of a trace on uniform command angles.
struct AxisTurn {
  AxisErrors errors;
  std::vector<double> x_mm;       ///< Commanded X positions at the same angles, or empty.
  double samples_per_turn = 0.0;  ///< Samples per turn of the recording.
  double turns = 0.0;             ///< Turns recorded.
  std::vector<core::Error> warnings;
};

/// Extracts the last whole turn of a trace, from alpha = 0 on, and resamples it to uniform command
/// angles by a cubic spline over alpha.
///
/// The spline includes 0.2 rad on both sides if they are recorded; otherwise the turn is treated as
/// closed. A turn that ends within a step of alpha = 0 is whole. A trace without a turn from 0 to 0
/// but with 360 deg in total, such as 300 samples of 1.2 deg, is also treated as closed.
///
/// @return kMeaning (different lengths, c_direction or error_sign not +-1), kTooFewPoints (fewer
///         than 16 samples), kNotFinite (row), kAngleOrder where C goes back (row), kSampling for a
///         step of 1.6 times its neighbours: a missing sample (row); kNotFullSection for less than
///         one turn. Warnings: kUnits for errors above 0.5 mm or 0.5 deg, and for a mean error of X
///         above 0.1 mm.
/// Source: methods, contour sections 1 and 6.
[[nodiscard]] core::Result<AxisTurn> last_turn(const AxisTrace& trace,
                                               const AxisTraceOptions& options = {});

}  // namespace rondure::fit
