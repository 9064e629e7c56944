#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/units.h"
#include "fit/contour/crank_motion.h"

namespace rondure::fit {

// Curves here are contour errors on the same angles 2 pi m / M, M >= 16 (asserted), mean 0 [mm].

/// A total contour error t in two parts: f follows from the axis errors, n is the rest.
struct ContourSeparation {
  std::vector<double> rest_mm;  ///< n = t - f.
  double total_mm2 = 0.0;       ///< mean(t^2) = following + rest + cross.
  double following_mm2 = 0.0;   ///< mean(f^2).
  double rest_mm2 = 0.0;        ///< mean(n^2).
  double cross_mm2 = 0.0;       ///< 2 mean(f n); negative where n lowers the total.
  double correlation = 0.0;     ///< Correlation of f with n; 0 where one of them is zero.

  /// Whether n makes the total greater than f alone.
  [[nodiscard]] bool enlarges() const { return rest_mm2 + cross_mm2 > 0.0; }
};

/// Direct separation with the following part of the same pin.
[[nodiscard]] ContourSeparation separate_contour(std::span<const double> total_mm,
                                                 std::span<const double> following_mm);

/// Correlation of two curves, in [-1, 1]; 0 where one of them is zero.
[[nodiscard]] double correlation_of(std::span<const double> a, std::span<const double> b);

/// Angle by which a curve must be turned onto another for the greatest circular cross-correlation.
/// For diagnosis only: turning f absorbs part of the rest, which amounts to some degrees even for a
/// correct alignment.
struct CorrelationOffset {
  double angle_rad = 0.0;
  /// Standard uncertainty of the angle from the amplitudes of the rest, whose phases are unknown.
  double u_rad = 0.0;
  double correlation = 0.0;  ///< Correlation at this angle, of all pairs together.
  bool at_edge = false;      ///< The greatest value lies at the end of the window.

  /// Whether the angle is larger than a rest of any phase explains: more than 3 standard
  /// uncertainties, and more than 2 deg.
  [[nodiscard]] bool alignment_suspect() const;
};

/// A total error and the following part to be turned onto it.
struct CurvePair {
  std::span<const double> total_mm;
  std::span<const double> following_mm;
};

/// Finds one offset from the sum of the correlations of all pairs: by a search at 16 places per
/// sample, then Newton's method.
/// @param window_rad  Range of the search to both sides of 0.
[[nodiscard]] CorrelationOffset correlation_offset(std::span<const CurvePair> pairs,
                                                   double window_rad = 8.0 * core::kDegree);

/// Evidence that the axis traces have the wrong sign or the wrong sense.
struct SenseEvidence {
  double as_given = 0.0;           ///< Correlation of t with f, all parts together.
  double mirrored = 0.0;           ///< Correlation with f(-beta), as for the opposite sense of C.
  double rms_difference_mm = 0.0;  ///< rms(t - f) over all parts.
  double rms_sum_mm = 0.0;         ///< rms(t + f): the rest for the opposite sign.
  double rms_mirrored_mm = 0.0;    ///< rms(t - f(-beta)): the rest for the opposite sense.
  std::size_t parts = 0;
  /// Parts that the negated f, or the mirrored one, fits better than the given f does. Better: the
  /// mean square of the rest is less by more than 1.96 times what a rest of its amplitudes, in any
  /// phase, adds to that difference.
  std::size_t negated_better = 0;
  std::size_t mirrored_better = 0;

  /// Whether the negated f fits better in the majority of the parts: the errors are then probably
  /// command minus actual.
  [[nodiscard]] bool sign_suspect() const { return 2 * negated_better > parts; }
  /// The same of the mirrored f.
  [[nodiscard]] bool sense_suspect() const { return 2 * mirrored_better > parts; }
};
[[nodiscard]] SenseEvidence sense_evidence(std::span<const CurvePair> pairs);

/// Whether another f fits t better than the given one, as SenseEvidence counts it.
[[nodiscard]] bool fits_better(const CurvePair& pair, std::span<const double> other_mm);

/// Slope of t over f through the origin: 1 where gauge and axes have the same scale.
struct GainEvidence {
  double slope = 1.0;
  double u = 0.0;  ///< Standard uncertainty, from the amplitudes of the rest in any phase.
};
/// @return  Nothing where f is zero.
[[nodiscard]] std::optional<GainEvidence> gain_evidence(const CurvePair& pair);

// Source: methods, contour section 7.

}  // namespace rondure::fit
