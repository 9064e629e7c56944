#pragma once

#include <vector>

#include "core/result.h"
#include "fit/least_squares/cylinder.h"
#include "fit/least_squares/sections.h"

namespace rondure::fit {

/// One term of the form of a cylinder: L_p(zeta) (cosine cos(k angle) + sine sin(k angle)), with
/// the Legendre polynomial L_p of the height, which runs from zeta = -1 to 1.
struct FormTerm {
  int axial = 0;       ///< p: 0 constant, 1 linear, 2 curved along the axis.
  int undulation = 0;  ///< k; 0: the same all round.
  double cosine_mm = 0.0;
  double sine_mm = 0.0;

  [[nodiscard]] double amplitude_mm() const;
};

/// The form of a cylinder as a sum of terms, and what a drawing calls them.
struct FormTerms {
  std::vector<FormTerm> terms;  ///< By p, then by k from 0 on.
  int highest_axial = 0;        ///< P.
  int highest_undulation = 0;   ///< K.
  double rms_mm = 0.0;          ///< Of the residuals.

  /// @pre axial <= P, undulation <= K.
  [[nodiscard]] const FormTerm& at(int axial, int undulation) const;
  /// Change of diameter over the length, > 0: widening along the axis [mm].
  [[nodiscard]] double taper_mm() const { return 4.0 * at(1, 0).cosine_mm; }
  /// Greatest minus least radius of the mean profile, < 0: barrel, > 0: saddle [mm].
  [[nodiscard]] double saddle_mm() const { return 1.5 * at(2, 0).cosine_mm; }
  /// Bow of the median line [mm].
  [[nodiscard]] double bend_mm() const { return 1.5 * at(2, 1).amplitude_mm(); }
};

/// Separates the form of a cylinder into taper, barrel, bend and lobes: plain least squares of all
/// terms p = 0..P, k = 0..K at once over the deviations from the cylinder. The set is fixed by the
/// data, as dropping one term moves the others: P = 2, with two sections 1; K = 15, or as much as
/// the smallest section and its largest gap determine, or as leaves more points than terms.
///
/// saddle_mm() and bend_mm() need three sections (P = 2), bend_mm() K >= 1.
/// @param cylinder  Least-squares cylinder of the points.
/// @return as sections_across(); kRank (one layer, or points that do not determine the terms).
///         O(n T^2) for T terms.
/// Source: methods, drawing section 4.5.
[[nodiscard]] core::Result<FormTerms> form_terms(Layers layers_mm, const LsCylinder& cylinder);

}  // namespace rondure::fit
