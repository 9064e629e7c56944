#pragma once

namespace rondure::fit {

/// The value that a chi-square variable of `dof` >= 1 degrees of freedom stays below with this
/// probability (0 < p < 1), to 1e-12 of it. Incomplete gamma function by series or continued
/// fraction, then bisection.
[[nodiscard]] double chi_square_quantile(double probability, int dof);

}  // namespace rondure::fit
