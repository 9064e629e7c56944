#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "core/words.h"
#include "evaluation/results/evaluation.h"
#include "record/run_record.h"

namespace rondure::evaluation {

using Points3 = std::vector<Eigen::Vector3d>;

/// The points of a characteristic, processed as another program might: subset chosen, outliers
/// removed, sections filtered, reference fitted, in this order.
struct FactorPoints {
  record::Form form = record::Form::kCylindricity;  ///< CYLt, or RONt of the worst layer.
  bool layers_known = true;                         ///< false: one list, in the order of the data.
  /// The layers in order; points of each by angle from its first point. The reported axis of the
  /// feature is z.
  std::vector<Points3> layers_mm;
  /// Cut-off of the Gaussian low pass of the reported value; 0: unfiltered.
  double reported_upr = 0.0;

  [[nodiscard]] std::size_t count() const;
  /// All points, layer by layer.
  [[nodiscard]] Points3 all_mm() const;
};

/// Points of a layer across the axis.
[[nodiscard]] std::vector<Eigen::Vector2d> across_axis(const Points3& points_mm);

/// Points that another sampling plan would have touched. Even: the first, third, ... one.
enum class PointSubset {
  kAll,
  kEvenPoints,
  kOddPoints,
  kEvenLayers,
  kOddLayers,
  kWithoutFirstLayer,
  kWithoutLastLayer,
};

RONDURE_WORDS(PointSubset, {kAll, "all points"}, {kEvenPoints, "points 1, 3, 5, ..."},
              {kOddPoints, "points 2, 4, 6, ..."}, {kEvenLayers, "layers 1, 3, 5, ..."},
              {kOddLayers, "layers 2, 4, 6, ..."}, {kWithoutFirstLayer, "first layer left out"},
              {kWithoutLastLayer, "last layer left out"});

/// The points of an evaluated feature. Of a wheel all points as given, with those that a robust
/// centre leaves out; of a spindle the recovered profile of the part before the filter, its samples
/// on a circle so large that fitted circles are those of the limacon model.
/// @return The failure of the feature; kNoPoints where RONt is asked for and the layers are not
///         known, and for an analysis that has no section.
[[nodiscard]] core::Result<FactorPoints> factor_points(const FeatureResult& result,
                                                       record::Form form);

/// The subsets that make sense for these points: leaving out layers needs at least two.
[[nodiscard]] std::vector<PointSubset> subsets_of(const FactorPoints& points);
[[nodiscard]] FactorPoints chosen(const FactorPoints& points, PointSubset subset);

/// The low passes that make sense for these points [UPR], 0: unfiltered; that of the reported value
/// is among them.
[[nodiscard]] std::vector<double> cutoffs_of(const FactorPoints& points);

/// Filters every layer with a Gaussian low pass about its least-squares circle, as
/// fit::evaluate_section() does; heights follow the plane of the layer.
/// @return kSampling where a layer has fewer than 7 points per undulation or a wide gap, or where
///         layers are not known; the errors of fit::evaluate_section().
[[nodiscard]] core::Result<FactorPoints> filtered(const FactorPoints& points, double cutoff_upr);

/// The peak to valley deviation about a reference [mm]: CYLt of all points, RONt of the worst
/// layer. The optimum is proven locally only.
/// @return kTooFewPoints for fewer than 6 points (4 in a section), whose zone is 0 for any part;
///         the errors of the fits.
[[nodiscard]] core::Result<double> deviation_mm(const FactorPoints& points,
                                                record::Reference reference);

}  // namespace rondure::evaluation
