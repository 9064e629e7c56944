#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "fit/contour/study.h"

// Curves of a contour by their harmonics from 2 up to where the filter transmits 1 %, and the
// numbers read from them. What lies above moves no value by more than that share of the noise.

namespace rondure::evaluation::contour_trials {

/// Highest order that a curve holds, whatever the filter transmits.
inline constexpr int kHighestOrder = 720;

/// Harmonics 2 .. highest of each part: a2, b2, a3, b3, ...
using Curves = std::vector<std::vector<double>>;

/// Where the curves are known: up to which order, and what the filter leaves of each.
struct Basis {
  explicit Basis(const fit::ContourStudyOptions& options);

  [[nodiscard]] std::vector<double> of(std::span<const double> error_mm) const {
    return fit::contour_coefficients(error_mm, highest);
  }
  [[nodiscard]] double range(const std::vector<double>& curve) const {
    return fit::peak_to_valley(fit::contour_of(curve, points));
  }
  [[nodiscard]] std::size_t size() const { return transmission.size(); }
  [[nodiscard]] static int order(std::size_t j) { return static_cast<int>(j / 2) + 2; }

  int highest = 1;
  std::size_t points = 0;
  std::vector<double> transmission;  ///< Of each coefficient.
};

/// Root mean square of a curve.
double rms_of(std::span<const double> curve);

/// Mean square of the mean curve, and of the parts about it.
struct Spread {
  double mean2 = 0.0;
  double spread2 = 0.0;
  double parts = 0.0;

  [[nodiscard]] double index() const {
    const double repeating = mean2 - spread2 / parts;
    return repeating + spread2 > 0.0 ? repeating / (repeating + spread2) : 0.0;
  }
};

Spread spread_of(const Curves& curves);

std::vector<double> mean_curve(const Curves& curves);

/// The greatest peak to valley of all curves.
double greatest_range(const Basis& basis, const Curves& curves);

}  // namespace rondure::evaluation::contour_trials
