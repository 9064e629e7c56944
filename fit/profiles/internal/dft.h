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
/// @param half  floor(N/2) + 1 values; the imaginary parts of k = 0 and k = N/2 are ignored.
[[nodiscard]] std::vector<double> series_of(std::span<const Complex> half, std::size_t count);

/// Reduces a periodic series to fewer samples without aliasing. Undulations up to `kept` and 3/8 of
/// `count` remain unchanged; a raised cosine attenuates the others up to count/2, so that none is
/// aliased. White noise is averaged over all values, not only over those kept.
///
/// @param series  A whole multiple of `count` values.
/// @param kept    Highest undulation to be kept unchanged; < count/2.
[[nodiscard]] std::vector<double> decimated(std::span<const double> series, std::size_t count,
                                            double kept = 0.0);

/// The highest undulation that decimated() leaves unchanged.
[[nodiscard]] double last_untouched(std::size_t count, double kept);

/// Transmission of the Gaussian low pass at harmonic n: 2^-(n/fc)^2 = exp(-ln 2 (n/fc)^2).
[[nodiscard]] double gaussian_transmission(double harmonic, double cutoff_upr);

}  // namespace rondure::fit
