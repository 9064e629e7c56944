#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "core/units.h"
#include "fit/geometry/points.h"

namespace rondure::fit {

/// The centre of a circle from four points: the intersection of the perpendicular bisectors of the
/// chords AB and CD.
struct FourPointCenter {
  std::array<std::size_t, 4> rows{};  ///< A, B, C, D.
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();
  double psi_rad = 0.0;          ///< Angle between the chords, 0 to pi/2.
  double first_chord_mm = 0.0;   ///< |AB|
  double second_chord_mm = 0.0;  ///< |CD|
  /// Scatter of the centre relative to the scatter of a point along its radius, >= 1 on a circle;
  /// infinite for parallel chords, for which the centre stays zero.
  double kappa = 0.0;
};

/// Computes centre and conditioning of one pairing of four points. Exact if they are on one circle.
///
/// kappa = sqrt(2) R sqrt(1/|AB|^2 + 1/|CD|^2) / sin psi.
///
/// @param points_mm  All points; `rows` are valid indices into it [mm].
/// @param radius_mm  Radius of the circle, used only for kappa.
/// Source: methods, wheel section 3 (patent CN103029041A, step one c).
[[nodiscard]] FourPointCenter four_point_center(PlanePoints points_mm,
                                                const std::array<std::size_t, 4>& rows,
                                                double radius_mm);

/// Limits of select_centers().
struct QuadrupleOptions {
  std::uint64_t seed = 1;                        ///< Of the subsets drawn of more than 20 points.
  double least_chord_mm = 1e-3;                  ///< A shorter chord has no direction, > 0.
  double least_chord_per_radius = 0.05;          ///< The same as a fraction of the radius, 0 to 1.
  double least_angle_rad = 5.0 * core::kDegree;  ///< Chords closer to parallel are refused.
  /// Largest kappa accepted; none: max(5, twice the best).
  std::optional<double> kappa_limit;
};

/// Centres of the accepted quadruples, and counts of the refused ones by reason.
struct WheelCenters {
  std::vector<FourPointCenter> accepted;
  std::size_t short_chord = 0;      ///< Refused: a chord below its least length.
  std::size_t parallel_chords = 0;  ///< Refused: the chords are too close to parallel.
  std::size_t ill_conditioned = 0;  ///< Refused: kappa above its limit.
  double kappa_limit = 0.0;         ///< The limit applied.

  [[nodiscard]] double best_kappa() const;
  [[nodiscard]] double worst_kappa() const;
  [[nodiscard]] double rms_kappa() const;
};

/// The least number of centres from which a wheel centre is combined.
inline constexpr std::size_t kLeastCenters = 6;
/// The greatest number of subsets used.
inline constexpr std::size_t kMostQuadruples = 5000;

/// Selects well conditioned quadruples and computes their centres: every subset in its best
/// pairing, of more than 20 points 5000 drawn ones.
///
/// @param points_mm  n >= 4 points [mm].
/// @param radius_mm  Radius of the least-squares circle, for kappa and chord lengths.
/// @return kBadOption; kTooFewCenters (fewer than 6 accepted; `what` holds the counts of all
///         reasons). Same input, same bits. At most 5000 subsets, some 0.5 ms.
/// Source: methods, wheel section 4.
[[nodiscard]] core::Result<WheelCenters> select_centers(PlanePoints points_mm, double radius_mm,
                                                        const QuadrupleOptions& options = {});

}  // namespace rondure::fit
