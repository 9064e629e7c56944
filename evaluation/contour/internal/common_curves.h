#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "evaluation/contour/internal/curves.h"
#include "evaluation/uncertainty/curve_trials.h"
#include "record/tasks/analysis_influences.h"

// Declared influences that act on all parts alike.

namespace rondure::evaluation::contour_trials {

/// A declared influence with its draws.
struct DrawnInfluence {
  const record::Influence* said = nullptr;
  double unit = 1.0;  ///< From the unit of the key to that of the calculation.
  std::string_view id;

  [[nodiscard]] double u() const { return unit * record::u_of(*said); }
  [[nodiscard]] double draw(std::uint64_t seed, std::uint64_t instance, int trial) const {
    if (u() == 0.0) return 0.0;
    const bool flat =
        *said && (*said)->distribution == record::DeclaredInfluence::Distribution::kRectangular;
    return u() * (flat ? uniform_draw(seed, id, instance, trial)
                       : normal_draw(seed, id, instance, trial));
  }
};

/// Random curves common to all parts: `columns` with one draw each.
struct CommonCurves {
  Curves columns;  ///< Change of a curve for one standard uncertainty, with sign.
  DrawnInfluence declared;

  void add(std::uint64_t seed, int trial, Curves& curves) const {
    const double u = declared.u();
    if (u == 0.0) return;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const double z = declared.draw(seed, c, trial) / u;
      for (auto& curve : curves) {
        for (std::size_t j = 0; j < curve.size(); ++j) curve[j] += z * columns[c][j];
      }
    }
  }
  /// Adds the squares of the standard uncertainties of the coefficients.
  void add_squares(std::vector<double>& squares) const {
    for (const auto& column : columns) {
      for (std::size_t j = 0; j < column.size(); ++j) squares[j] += column[j] * column[j];
    }
  }
};

}  // namespace rondure::evaluation::contour_trials
