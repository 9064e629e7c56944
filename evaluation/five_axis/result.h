#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "evaluation/results/analysis_value.h"
#include "evaluation/rotary/result.h"
#include "fit/rotary/head.h"
#include "record/tasks/five_axis.h"

namespace rondure::evaluation {

/// A run with a table loaded, beside the one that gave it.
struct HeadGain {
  std::string with;          ///< The feature that gave the table.
  fit::HeadRms before;       ///< There, without the table.
  double forecast_mm = 0.0;  ///< What it left at the same poses: rms, expected here.
};

/// All results for a head.
struct FiveAxisResult {
  record::FiveAxisTask task;
  fit::HeadStudy study;
  std::size_t readings = 0;
  double u_mm = 0.0;  ///< Of a coordinate of a reading: declared, of the file, or their scatter.
  double noise_mm = 0.0;   ///< `u_mm` times the a-posteriori factor of the stations, above 1.
  double condition = 0.0;  ///< fit::setup_condition() of the balls.
  double lever_mm = 0.0;   ///< Largest distance of a ball from the pivot.
  std::vector<CombinedPose> combined;  ///< Pose: C and A in place of alpha and beta.
  std::shared_ptr<const fixture::StationMotion> c_motion;
  std::shared_ptr<const fixture::StationMotion> a_motion;
  std::vector<fixture::AxisStation> c_table;  ///< What leaves the run, rounded.
  std::vector<fixture::AxisStation> a_table;
  std::string expires_utc;
  std::optional<HeadGain> gain;          ///< Of a repeat.
  std::optional<core::Phrase> withheld;  ///< Why it proves nothing.

  /// Left at the combined poses: of a repeat as read, else against the prediction.
  [[nodiscard]] const fit::HeadRms& left() const { return gain ? study.before : study.left; }
};

/// One of the eight location errors.
struct HeadLocation {
  record::Indication::AxisError error = record::Indication::AxisError::kXOC;
  double value_mm = 0.0;  ///< Of a tilt in mrad.
  double u_mm = 0.0;      ///< Without that of the slides.
};

/// In the order of Indication::AxisError; without those of an axis whose arc is short.
[[nodiscard]] std::vector<HeadLocation> locations_of(const FiveAxisResult& facts);

/// C and A, with the curves of their stations.
[[nodiscard]] std::vector<AxisFacts> axes_of(const FiveAxisResult& facts);

/// What the run without the table found, by the id of its feature; or why nothing is taken of it.
using HeadOf = std::function<core::Result<HeadGain>(const std::string& id)>;

/// Evaluates feature `index` of a record.
/// @param earlier  For a repeat.
/// @param result  Holds the feature; receives gates and warnings.
[[nodiscard]] core::Result<FiveAxisResult> evaluate_five_axis(const record::RunRecord& record,
                                                              int index, const HeadOf& earlier,
                                                              FeatureResult& result);

[[nodiscard]] core::Result<AnalysisValue> value_of(const FiveAxisResult& result,
                                                   const record::Characteristic& characteristic);
[[nodiscard]] std::vector<UncertaintyStatus> intervals_of(
    const FiveAxisResult& result, std::span<const record::Characteristic> characteristics,
    const UncertaintyOptions& options);
[[nodiscard]] ValueOperator operator_of(const FiveAxisResult& result,
                                        const record::Characteristic& characteristic,
                                        const core::Phrase& temperature);
[[nodiscard]] core::Phrase filter_text(const FiveAxisResult& result);
[[nodiscard]] core::Phrase sampling_text(const FiveAxisResult& result);

}  // namespace rondure::evaluation
