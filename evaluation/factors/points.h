#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "evaluation/results/evaluation.h"
#include "record/run_record.h"

namespace rondure::evaluation {

using Points3 = std::vector<Eigen::Vector3d>;

/// The points behind a characteristic, on their way through another program: some of them chosen,
/// outliers left out, sections filtered, a reference fitted, in this order.
struct FactorPoints {
  record::Form form = record::Form::kCylindricity;  ///< CYLt, or RONt of the worst layer.
  bool layers_known = true;                         ///< false: one list, in the order of the data.
  /// The layers from the first, each by angle from its first point on; axis of the feature along z,
  /// as it was reported.
  std::vector<Points3> layers_mm;

  [[nodiscard]] std::size_t count() const;
  /// All points, layer by layer.
  [[nodiscard]] Points3 all_mm() const;
};

/// Points of a layer across the axis.
[[nodiscard]] std::vector<Eigen::Vector2d> across_axis(const Points3& points_mm);

/// Which points another sampling plan would have touched. Even: the first, third, ... one.
enum class PointSubset {
  kAll,
  kEvenPoints,
  kOddPoints,
  kEvenLayers,
  kOddLayers,
  kWithoutFirstLayer,
  kWithoutLastLayer,
};

/// "all points", "points 1, 3, 5, ...", "first layer left out".
[[nodiscard]] std::string_view name_of(PointSubset subset);

/// The points of an evaluated feature.
/// @return Its failure; kNoPoints where RONt is asked of points whose layers are not known.
[[nodiscard]] core::Result<FactorPoints> factor_points(const FeatureResult& result,
                                                       record::Form form);

/// The subsets that mean something for these points: those of layers need two.
[[nodiscard]] std::vector<PointSubset> subsets_of(const FactorPoints& points);
[[nodiscard]] FactorPoints chosen(const FactorPoints& points, PointSubset subset);

/// Every layer through a Gaussian low pass about its least-squares circle, as
/// fit::evaluate_section() does; heights follow the plane of the layer.
/// @return kSampling where a layer has fewer than 7 points per undulation or a wide gap, or where
///         layers are not known; the errors of fit::evaluate_section().
[[nodiscard]] core::Result<FactorPoints> filtered(const FactorPoints& points, double cutoff_upr);

/// The peak to valley deviation about a reference [mm]: CYLt of all points, RONt of the worst
/// layer. Proven locally only.
/// @return kTooFewPoints for fewer than 6 points (of a section 4), whose zone is 0 whatever the
///         part; the errors of the fits.
[[nodiscard]] core::Result<double> deviation_mm(const FactorPoints& points,
                                                record::Reference reference);

}  // namespace rondure::evaluation
