#pragma once

#include <span>
#include <vector>

#include "core/result.h"

namespace rondure::fit {

/// Mean line of the robust Gaussian filter.
struct RobustMeanLine {
  std::vector<double> r_mm;
  int iterations = 0;
  bool scale_floored = false;  ///< c was raised to the floor that robust_mean_line() describes.
};

/// Robust Gaussian regression of order 0 of a closed profile (ISO 16610-31): minimises
/// sum_i rho(r_i - w_k) s_ik at every k, s the Gaussian weight of ISO 16610-21, rho Tukey's
/// function.
///
/// Solved by repeated weighting: w = conv(s, delta r) / conv(s, delta),
/// delta = (1 - ((r - w)/c)^2)^2 where |r - w| <= c and 0 beyond, c = 4.4478 median|r - w|. The
/// convolutions are products of spectra and so have no end effects.
///
/// This scale c does not suit a smooth profile: the residuals are then the parts of its undulations
/// that the filter removes, and with a c from their median whole undulations count as outliers. If
/// the iteration does not converge for that reason, it is repeated with
/// c >= 6.83 max|w - conv(s, w)|, and `scale_floored` is set.
///
/// @param r_mm        Finite values at uniform angles [mm].
/// @param cutoff_upr  > 0, below half the number of values.
/// @return kNotConverged if neither converges within 3000 iterations, or outliers fill a whole
///         undulation.
[[nodiscard]] core::Result<RobustMeanLine> robust_mean_line(std::span<const double> r_mm,
                                                            double cutoff_upr);

}  // namespace rondure::fit
