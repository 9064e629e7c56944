#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace rondure::fit {

using Complex = std::complex<double>;
using Spectrum = std::vector<Complex>;

/// Spectrum of a real periodic series: F(k) = sum_i x_i e^{-2 pi j k i / N}, k = 0..floor(N/2); the
/// other half is its conjugate.
///
/// @param series  N >= 1. Any N costs O(N log N): 1e5 values take about 1 ms.
[[nodiscard]] Spectrum spectrum(std::span<const double> series);

/// The real series of N values with that half spectrum.
/// @param half  floor(N/2) + 1 values; the imaginary parts of k = 0 and k = N/2 are not looked at.
[[nodiscard]] std::vector<double> series_of(std::span<const Complex> half, std::size_t count);

/// A periodic series on fewer samples, without what those cannot carry: undulations up to `kept`
/// and 3/8 of `count` stay as they are, a raised cosine takes the rest away up to count/2, so that
/// none comes back as a lower one. The mean of white noise falls with all values, not with those
/// kept.
///
/// @param series  count times a whole number of values.
/// @param kept    Highest undulation needed whole; < count/2.
[[nodiscard]] std::vector<double> decimated(std::span<const double> series, std::size_t count,
                                            double kept = 0.0);

/// The last undulation that decimated() leaves as it is.
[[nodiscard]] double last_untouched(std::size_t count, double kept);

}  // namespace rondure::fit
