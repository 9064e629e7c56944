#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/result.h"
#include "fit/contour/crank_motion.h"

namespace rondure::fit {

inline constexpr std::size_t kLeastTurnSamples = 16;  ///< N and M of one turn.

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

/// Where the wheel centre really went.
/// @return check_geometry()'s errors; kMeaning for arrays of different length; kTooFewPoints
///         (N < 16); kNotFinite (row); kOutOfRange where the wheel centre comes to O.
[[nodiscard]] core::Result<GrindingPath> wheel_path(const CrankGeometry& geometry,
                                                    const AxisErrors& errors);

/// The Fourier series of a path at `times` as many places.
[[nodiscard]] GrindingPath refined(const GrindingPath& path, std::size_t times);

/// How the parallel curve is computed.
enum class ParallelForm {
  kCartesian,    ///< From x', y' by the Fourier transform: the default.
  kPolar,        ///< From rho(theta), the same derivatives; equal to kCartesian to 1e-9 um.
  kDifferences,  ///< From x', y' by central differences: 0.01 um off in r at 300 samples.
};

/// The inner parallel curve of a wheel path at the wheel radius: the ground contour, where it is
/// regular.
struct ParallelCurve {
  std::vector<double> beta_rad;  ///< Polar angle about Op, continuous, one per path point.
  std::vector<double> r_mm;
  double regularity = 0.0;         ///< Least 1 - Rgw kappa; the curve is regular where it is > 0.
  double least_regular_rad = 0.0;  ///< Command angle there.
  bool undercut = false;           ///< Loops: not regular, or beta not strictly increasing.
};
[[nodiscard]] ParallelCurve parallel_curve(const GrindingPath& path, double wheel_radius_mm,
                                           ParallelForm form = ParallelForm::kCartesian);

/// The ground contour as what all wheel positions leave of the pin: for every polar angle the least
/// distance to a wheel circle, also where the parallel curve has loops.
///
/// The path is refined() `oversampling` times, the least of each angle by a
/// parabola. Positions that cannot reach the least found so far are not looked at; the result is
/// that of looking at all.
/// @param samples  Angles 2 pi m / samples.
[[nodiscard]] std::vector<double> envelope_radii_mm(const GrindingPath& path,
                                                    double wheel_radius_mm, std::size_t samples,
                                                    std::size_t oversampling = 40);

/// Settings of ground_contour().
struct GroundContourOptions {
  std::size_t samples = 1440;   ///< M, points of the contour.
  double pre_filter_upr = 0.0;  ///< Gaussian low pass of the axis errors first; 0: none.
  ParallelForm form = ParallelForm::kCartesian;
  /// Refine a path of fewer samples than the contour by its Fourier series; otherwise a spline over
  /// beta bridges them (300 samples: 1e-4 um off before the filter, 2e-5 um behind it).
  bool refine = true;
};

/// A ground pin at the angles 2 pi m / M.
struct GroundContour {
  std::vector<double> r_mm;
  double regularity = 0.0;         ///< Of the unfiltered path, as ParallelCurve.
  double least_regular_rad = 0.0;  ///< Command angle of the least regular place.
  bool undercut = false;           ///< The unfiltered path has loops.
  bool from_envelope = false;      ///< The radii are those of envelope_radii_mm().
};

/// The contour that given axis errors grind. Where the parallel curve has loops the envelope takes
/// its place; with a pre-filter, loops of the filtered path decide that and those of the unfiltered
/// one are still flagged.
///
/// @return wheel_path()'s errors; kBadOption for fewer than 16 samples.
///         O(N log N + M); some ms more for the envelope.
/// Source: methods, contour section 3.
[[nodiscard]] core::Result<GroundContour> ground_contour(const CrankGeometry& geometry,
                                                         const AxisErrors& errors,
                                                         const GroundContourOptions& options = {});

}  // namespace rondure::fit
