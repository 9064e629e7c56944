#pragma once

namespace rondure::fit {

/// Returns the quantile of the chi-square distribution: the value below which the variable lies
/// with this probability, to a relative 1e-12. Computes the incomplete gamma function by series or
/// continued fraction and inverts it by bisection.
/// @pre 0 < probability < 1, dof >= 1.
[[nodiscard]] double chi_square_quantile(double probability, int dof);

}  // namespace rondure::fit
