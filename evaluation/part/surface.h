#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "evaluation/results/evaluation.h"
#include "evaluation/results/finding.h"
#include "fit/geometry/axis.h"
#include "fit/sizes/sizes.h"
#include "record/run_record.h"

namespace rondure::evaluation {

struct SurfaceLayout;  // internal/layout.h

/// The points of a feature as they enter the characteristics of a part: its evaluated cloud, or
/// that cloud moved by a trial of the uncertainty.
struct MeasuredSurface {
  const FeatureResult* of = nullptr;     ///< Never null.
  std::vector<Eigen::Vector3d> tips_mm;  ///< As many as rows in its cloud; at 20 degC.
  std::optional<double> tip_radius_mm;   ///< None: unknown, so that the feature has no size.
  /// Windows, outliers and sections of the cloud as measured: a trial moves points, but never
  /// changes which ones take part. Null: prepared() finds them anew, at its cost.
  std::shared_ptr<const SurfaceLayout> layout = nullptr;
  /// The axis that sections stand square to; none: that of least squares of the points.
  std::optional<fit::Axis> across = std::nullopt;
};

/// The surfaces of a part, one for each feature of the run, in its order. Analyses have no points.
/// @param features  Must outlive the surfaces.
[[nodiscard]] std::vector<MeasuredSurface> surfaces_of(std::span<const FeatureResult> features);

/// The rows of the cloud in the windows of a feature that is not fitted yet; none where they cannot
/// be told, which its characteristics will say.
[[nodiscard]] std::vector<LeftOut> rows_in_windows(const FeatureResult& feature);

/// A section of a prepared surface: a layer, or a group of neighbouring heights of a file. Each
/// pass of a layer whose repeats were not averaged is a section of its own, so that opposite points
/// and generatrices are taken within one pass; they follow each other with the same `layer`.
struct SurfaceSection {
  int layer = 0;           ///< 0-based.
  double height_mm = 0.0;  ///< Mean, along the axis; of a plane: mean radius of the circle.
  std::vector<std::size_t> points;  ///< Index into PreparedSurface::points_mm.
  /// Carries the filter that is asked for, without one 15 UPR: 7 points per undulation, and no gap
  /// of a quarter of one beside windows (drawing, 6.1).
  bool dense = false;
  bool gap = false;  ///< A window takes a part of the turn.
};

/// A surface as one characteristic sees it: without windows and outliers, restricted to its
/// portion, in sections square to the least-squares axis, filtered (drawing, 1: steps 2 to 4).
struct PreparedSurface {
  const FeatureResult* of = nullptr;
  fit::Material material;  ///< Tip radius 0 where it is unknown.
  bool tip_known = false;
  fit::Axis axis;                          ///< Least squares; of a plane its normal, outward.
  std::vector<Eigen::Vector3d> points_mm;  ///< Filtered, where the characteristic asks for it.
  std::vector<std::size_t> rows;           ///< Row in the cloud of each point, ascending.
  std::vector<SurfaceSection> sections;    ///< Lowest (innermost) first; may be empty of a file.
  std::optional<core::Error> no_sections;  ///< Why they are: the points follow no circles.
  std::vector<LeftOut> left_out;
  std::vector<core::Error> warnings;
  core::Phrase filter;  ///< For the operator: "unfiltered", "gaussian 50 UPR".
  /// No trial has moved the points, and without_rows() took none. Only then are there warnings, and
  /// is what they leave unseen looked for: a trial has the same gaps.
  bool as_measured = true;
};

/// Prepares a surface for a characteristic: leaves out windows and outliers, parts the rest into
/// sections, filters them.
/// @return kSampling where the sections cannot carry the filter, with the numbers asked and there;
///         kRank, kTooFewPoints where a window leaves too little; kOutliers where the rule would
///         take more than a quarter of the points; the failure of the feature.
[[nodiscard]] core::Result<PreparedSurface> prepared(const MeasuredSurface& surface,
                                                     const record::Indication& indication);

/// The points of each section, in the order of the sections.
[[nodiscard]] std::vector<std::vector<Eigen::Vector3d>> layers_of(const PreparedSurface& surface);

/// Rows that lie more than five robust scales off the least-squares feature, though no window and
/// no rule took them out, farthest first. None where they are more than a quarter: that is form.
[[nodiscard]] std::vector<std::size_t> outlying_rows(const MeasuredSurface& surface);

/// The surface without some points, for their share of a value.
[[nodiscard]] MeasuredSurface without_rows(const MeasuredSurface& surface,
                                           std::span<const std::size_t> rows);

}  // namespace rondure::evaluation
