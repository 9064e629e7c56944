#pragma once

#include <cstddef>
#include <vector>

#include "core/error.h"
#include "core/result.h"
#include "fit/contour/ground_contour.h"

namespace rondure::fit {

/// What the control recorded of both axes, sample by sample on one time base.
struct AxisTrace {
  std::vector<double> c_rad;        ///< Commanded C position; wrapped or not, any number of turns.
  std::vector<double> c_error_rad;  ///< Of C.
  std::vector<double> x_error_mm;   ///< Of X.
  /// Commanded X position, to hold against the geometry; empty where it was not recorded.
  std::vector<double> x_mm;
};

/// How a trace is to be read.
struct AxisTraceOptions {
  int error_sign = 1;          ///< 1: errors are actual minus command; -1: command minus actual.
  int c_direction = 1;         ///< 1: C is the polar angle of the wheel; -1: it turns against it.
  std::size_t samples = 1440;  ///< N of the result.
};

/// One turn of a trace on uniform command angles.
struct AxisTurn {
  AxisErrors errors;
  std::vector<double> x_mm;       ///< Commanded X positions on the same angles; or empty.
  double samples_per_turn = 0.0;  ///< Of the control.
  double turns = 0.0;             ///< Recorded.
  std::vector<core::Error> warnings;
};

/// Takes the last whole turn recorded, from alpha = 0 on, out of a trace and brings it to uniform
/// command angles by a cubic spline over alpha.
///
/// With 0.2 rad recorded on both sides of that turn the spline runs through those samples, too;
/// otherwise the turn is taken as closed; one that ends within a step of alpha = 0 is whole. A
/// trace that holds no turn from 0 to 0 but 360 deg altogether, such as 300 samples of 1.2 deg, is
/// closed as well.
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
