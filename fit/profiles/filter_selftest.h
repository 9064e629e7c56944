#pragma once

#include <vector>

#include "core/result.h"

namespace rondure::fit {

/// Transmission of the Gaussian low pass at one harmonic, as found and by definition.
struct TransmissionRow {
  int harmonic = 0;
  double found = 0.0;       ///< Part in phase with the input.
  double expected = 0.0;    ///< 2^-(n/fc)^2
  double difference = 0.0;  ///< Magnitude of the complex difference, which includes phase.
};

/// Self-test of the Gaussian filter of closed profiles at one cut-off.
struct FilterSelfTest {
  static constexpr double kTolerance = 1e-9;  ///< Greatest difference that passes.

  double cutoff_upr = 0.0;
  std::size_t samples = 0;
  std::vector<TransmissionRow> rows;  ///< n = 1 .. 3 fc.

  [[nodiscard]] double greatest_difference() const;
  [[nodiscard]] bool passed() const;
};

/// Tests the Gaussian filter: passes an impulse, which contains all harmonics with the same
/// amplitude, through filter_closed() and finds the harmonics of the response by direct summation,
/// not by the transform that the filter uses. The profile has 7 values per undulation of 3 fc.
///
/// @param cutoff_upr  1 to 10000.
/// @return kBadOption outside that range; the errors of filter_closed(). A failed test is no error:
///         see passed().
[[nodiscard]] core::Result<FilterSelfTest> filter_selftest(double cutoff_upr);

}  // namespace rondure::fit
