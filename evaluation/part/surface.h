#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "evaluation/results/evaluation.h"
#include "evaluation/results/finding.h"
#include "fit/geometry/axis.h"
#include "fit/sizes/material.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// The points of a feature as they enter the characteristics of a part: its evaluated cloud, or
/// that cloud moved by a trial of the uncertainty.
struct MeasuredSurface {
  const FeatureResult* of = nullptr;     ///< Never null.
  std::vector<Eigen::Vector3d> tips_mm;  ///< As many as rows in its cloud; at 20 degC.
  std::optional<double> tip_radius_mm;   ///< None: unknown, so that the feature has no size.
};

/// The surfaces of a part, one for each feature of the run, in its order. Analyses have no points.
[[nodiscard]] std::vector<MeasuredSurface> surfaces_of(std::span<const FeatureResult> features);

/// A section of a prepared surface: a layer, or a group of neighbouring heights of a file.
struct SurfaceSection {
  int layer = 0;           ///< 0-based.
  double height_mm = 0.0;  ///< Mean, along the axis; of a plane: mean radius of the circle.
  std::vector<std::size_t> points;  ///< Index into PreparedSurface::points_mm.
  bool dense = false;               ///< Carries a filter and calculated sizes (drawing, 6.1).
  bool gap = false;                 ///< A window takes a part of the turn.
};

/// A surface as one characteristic sees it: without windows and outliers, restricted to its
/// portion, in sections square to the least-squares axis, filtered (drawing, 1: steps 2 to 4).
struct PreparedSurface {
  const FeatureResult* of = nullptr;
  fit::Material material;  ///< Tip radius 0 where it is unknown.
  bool tip_known = false;
  fit::Axis axis;                          ///< Least squares; of a plane its normal, outward.
  std::vector<Eigen::Vector3d> points_mm;  ///< Filtered, where the characteristic asks for it.
  std::vector<std::size_t> rows;           ///< Row in the cloud of each point.
  std::vector<SurfaceSection> sections;    ///< Lowest (innermost) first; may be empty of a file.
  std::vector<LeftOut> left_out;
  std::vector<core::Error> warnings;
  core::Phrase filter;  ///< For the operator: "unfiltered", "gaussian 50 UPR".
};

/// Prepares a surface for a characteristic: leaves out windows and outliers, parts the rest into
/// sections, filters them.
/// @return kSampling where the sections cannot carry the filter, with the numbers asked and there;
///         kRank, kTooFewPoints where a window leaves too little; the failure of the feature.
[[nodiscard]] core::Result<PreparedSurface> prepared(const MeasuredSurface& surface,
                                                     const record::Indication& indication);

/// The points of each section, in the order of the sections.
[[nodiscard]] std::vector<std::vector<Eigen::Vector3d>> layers_of(const PreparedSurface& surface);

}  // namespace rondure::evaluation
