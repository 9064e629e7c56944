#include "fit/chi_square.h"

#include <cassert>
#include <cmath>

namespace rondure::fit {
namespace {

/// Regularised lower incomplete gamma function P(a, x).
/// Source: M. Abramowitz, I. A. Stegun, Handbook of Mathematical Functions, 6.5.29 and 6.5.31.
double lower_gamma(double a, double x) {
  if (x <= 0.0) return 0.0;
  const double factor = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1.0) {
    double term = 1.0 / a;
    double sum = term;
    for (int n = 1; n < 1000 && term > 1e-17 * sum; ++n) {
      term *= x / (a + n);
      sum += term;
    }
    return factor * sum;
  }
  // Evaluates the continued fraction of the upper function from its far end.
  double tail = 0.0;
  for (int n = 500; n >= 1; --n) tail = n * (n - a) / (x + 2.0 * n + 1.0 - a - tail);
  return 1.0 - factor / (x + 1.0 - a - tail);
}

}  // namespace

double chi_square_quantile(double probability, int dof) {
  assert(probability > 0.0 && probability < 1.0 && dof >= 1);
  const double a = 0.5 * dof;
  double low = 0.0;
  double high = dof + 10.0;
  while (lower_gamma(a, 0.5 * high) < probability && high < 1e9) high *= 2.0;
  while (high - low > 1e-13 * high) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (lower_gamma(a, 0.5 * middle) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace rondure::fit
