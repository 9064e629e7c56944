#pragma once

#include <optional>
#include <span>

namespace rondure::fit {

/// A Gaussian low pass that values have passed before they came here.
struct PassedFilter {
  double cutoff_upr = 0.0;
  double steepness = 0.0;  ///< 1 / cutoff^2.
  double u_steepness = 0.0;

  /// Whether the cut-off surely lies below, or above, `upr`: by a factor of 1.5 at least, and by
  /// more than the scatter of the amplitudes explains.
  [[nodiscard]] bool below(double upr) const;
  [[nodiscard]] bool above(double upr) const;
};

/// Finds the low pass from the fall of noise and roughness: log2 of the amplitudes over k^2 is then
/// a line of slope -1/cutoff^2 that leads from 0.8 of the cut-off down to what the file itself adds
/// (digits, noise after the filter), which the last quarter of the orders shows. Surfaces fall by
/// themselves, as a power 0.75 +- 0.5 of the order; single orders that stand out are form and left
/// out.
///
/// @param amplitude_mm  By order, from 0, as far as the points resolve them.
/// @return  Nothing where the amplitudes do not fall so: no filter, form down to the digits, fewer
///          than 15 orders in the fall.
[[nodiscard]] std::optional<PassedFilter> passed_filter(std::span<const double> amplitude_mm);

}  // namespace rondure::fit
