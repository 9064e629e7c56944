#pragma once

// Shared by planted circles and cylinders: radii, and the order of the points.

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/noise.h"
#include "planted.h"

namespace rondure::test {

/// Radii of a planted set; the contacts lie on one or both of them.
struct Band {
  double low_mm = 0.0;
  double high_mm = 0.0;

  /// A radius strictly between the two, by at least 2 % of the form.
  [[nodiscard]] double inside(double share) const {
    return low_mm + (high_mm - low_mm) * (0.02 + 0.96 * share);
  }
  [[nodiscard]] Optimum optimum(Reference reference) const {
    Optimum out;
    if (reference != Reference::kCircumscribed) out.inner_mm = low_mm;
    if (reference != Reference::kInscribed) out.outer_mm = high_mm;
    out.form_mm = high_mm - low_mm;
    return out;
  }
};

/// @param ball_mm  Largest form allowed.
inline Band draw_band(const Plot& plot, double ball_mm, core::KeyedNoise& noise) {
  const double form = std::min(plot.form_mm, ball_mm) * (0.2 + 0.8 * noise.uniform());
  return {plot.radius_mm - form / 2.0, plot.radius_mm + form / 2.0};
}

/// Shuffles the points; returns the new indices of the first `contacts` points.
template <class Points>
std::vector<std::size_t> shuffle(Points& points, std::size_t contacts, core::KeyedNoise& noise) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  for (std::size_t k = order.size(); k > 1; --k) {
    std::swap(order[k - 1],
              order[static_cast<std::size_t>(noise.uniform() * static_cast<double>(k))]);
  }
  Points mixed;
  std::vector<std::size_t> places(contacts);
  for (std::size_t k = 0; k < order.size(); ++k) {
    mixed.push_back(points[order[k]]);
    if (order[k] < contacts) places[order[k]] = k;
  }
  points = std::move(mixed);
  return places;
}

}  // namespace rondure::test
