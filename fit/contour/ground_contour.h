#pragma once

#include <cstddef>
#include <vector>

#include "core/result.h"
#include "fit/contour/crank_motion.h"

namespace rondure::fit {

inline constexpr std::size_t kLeastTurnSamples = 16;  ///< Least N and M of one turn.

/// Errors of both axes over one turn, ACTUAL minus COMMAND, at the command angles 2 pi m / N.
struct AxisErrors {
  std::vector<double> c_rad;  ///< dalpha.
  std::vector<double> x_mm;   ///< dd.
};

/// Centre of the wheel about the nominal pin centre, x from O to Op, at 2 pi m / N.
struct GrindingPath {
  std::vector<double> x_mm;
  std::vector<double> y_mm;
};

/// Computes the true path of the wheel centre.
/// @return the errors of check_geometry(); kMeaning for arrays of different length; kTooFewPoints
///         (N < 16); kNotFinite (row); kOutOfRange if the wheel centre reaches O.
[[nodiscard]] core::Result<GrindingPath> wheel_path(const CrankGeometry& geometry,
                                                    const AxisErrors& errors);

/// Evaluates the Fourier series of a path at `times` as many places.
[[nodiscard]] GrindingPath refined(const GrindingPath& path, std::size_t times);

/// Method for the parallel curve.
enum class ParallelForm {
  kFourier,      ///< From x', y' by the Fourier transform: the default.
  kDifferences,  ///< From x', y' by central differences: 0.01 um off in r at 300 samples.
};

/// The inner parallel curve of a wheel path at the wheel radius. Where it is regular, it is the
/// ground contour.
struct ParallelCurve {
  std::vector<double> beta_rad;  ///< Polar angle about Op, continuous, one per path point.
  std::vector<double> r_mm;
  double regularity = 0.0;         ///< Least 1 - Rgw kappa; the curve is regular where it is > 0.
  double least_regular_rad = 0.0;  ///< Command angle there.
  bool undercut = false;           ///< Loops: not regular, or beta not strictly increasing.
};
[[nodiscard]] ParallelCurve parallel_curve(const GrindingPath& path, double wheel_radius_mm,
                                           ParallelForm form = ParallelForm::kFourier);

/// Computes the ground contour as the envelope of all wheel positions: for every polar angle the
/// least distance to a wheel circle, valid also where the parallel curve has loops. The path is
/// refined() `oversampling` times, and a parabola gives the least distance at each angle.
/// @param samples  Number of angles 2 pi m / samples.
[[nodiscard]] std::vector<double> envelope_radii_mm(const GrindingPath& path,
                                                    double wheel_radius_mm, std::size_t samples,
                                                    std::size_t oversampling = 40);

/// Settings of ground_contour().
struct GroundContourOptions {
  std::size_t samples = 1440;  ///< M, points of the contour.
  ParallelForm form = ParallelForm::kFourier;
  /// Refine a path of fewer samples than the contour by its Fourier series; otherwise a spline over
  /// beta interpolates (300 samples: 1e-4 um off before the filter, 2e-5 um after it).
  bool refine = true;
};

/// A ground pin at the angles 2 pi m / M.
struct GroundContour {
  std::vector<double> r_mm;
  double regularity = 0.0;         ///< Regularity of the path, see ParallelCurve.
  double least_regular_rad = 0.0;  ///< Command angle of the least regular place.
  bool undercut = false;           ///< The path has loops: r_mm is the envelope_radii_mm().
};

/// Computes the contour that given axis errors grind. If the parallel curve has loops, the envelope
/// is used instead.
///
/// @return the errors of wheel_path(); kBadOption for fewer than 16 samples.
///         O(N log N + M); some ms more for the envelope.
/// Source: methods, contour section 3.
[[nodiscard]] core::Result<GroundContour> ground_contour(const CrankGeometry& geometry,
                                                         const AxisErrors& errors,
                                                         const GroundContourOptions& options = {});

}  // namespace rondure::fit
