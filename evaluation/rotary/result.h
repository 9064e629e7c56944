#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "evaluation/results/analysis_value.h"
#include "fit/least_squares/probe_tip.h"
#include "fit/rotary/axes.h"
#include "fixture/error_model.h"
#include "record/tasks/analysis_influences.h"

namespace rondure::evaluation {

struct FeatureResult;  // results/evaluation.h

/// Name of the common mode by the qualified tip radius.
inline constexpr const char* kTipRadius = "tip-radius";

/// Residual at one combined pose.
struct CombinedPose {
  core::Pose pose;  ///< Pose as the fixture read it.
  std::size_t points = 0;
  double rms_mm = 0.0;
  double max_mm = 0.0;
  double tilt_rad = 0.0;                     ///< Residual rotation.
  double before_rms_mm = 0.0;                ///< Residual against the nominal kinematics.
  std::vector<Eigen::Vector3d> at_mm;        ///< Predicted balls, from the base-fixed axis.
  std::vector<Eigen::Vector3d> residual_mm;  ///< Measured minus predicted, for each.
  /// Covariance of the predicted motion (t; w) about the base-fixed axis: stations of both axes and
  /// readings of this pose.
  fit::Matrix6 covariance = fit::Matrix6::Zero();
};

/// All results for the fixture.
struct RotaryResult {
  fit::RotaryStudy alpha;
  fit::RotaryStudy beta;
  std::vector<std::string> balls;
  std::size_t poses = 0;
  std::size_t touches = 0;
  double tip_u_mm = 0.0;        ///< Of the qualified tip radius, by that scatter.
  double touch_sigma_mm = 0.0;  ///< Pooled scatter of a touch about its ball.
  double center_u_mm = 0.0;     ///< Root mean square standard uncertainty of a centre coordinate.
  double condition = 0.0;       ///< Condition of the set of balls; see fit::setup_condition().
  std::vector<CombinedPose> combined;
  std::optional<record::RotaryInfluencesTask> declared;  ///< None: no interval.
  /// `center_u_mm` times the a-posteriori factor of the stations, where that is above 1.
  double noise_mm = 0.0;
  /// Scale of the errors at combined poses over what the calibration explains: median and ends of
  /// its 95 % interval. Above 1 at the lower end, covariances of the calibration were scaled by its
  /// square. 0 without combined poses.
  double scale = 0.0;
  double scale_low = 0.0;
  double scale_high = 0.0;
  /// Why the calibration proves nothing: its values are void, and no run may use it.
  std::optional<core::Phrase> withheld;
  fixture::Calibration calibration;
};

/// Evaluates feature `index` of a record.
/// @param probe   As qualified; the scatter of its radius moves all balls alike.
/// @param result  Holds the feature; receives the warnings and the temperatures.
/// @return  The result, or the reason why there is none.
[[nodiscard]] core::Result<RotaryResult> evaluate_rotary(const record::RunRecord& record, int index,
                                                         const std::optional<fit::ProbeTip>& probe,
                                                         FeatureResult& result);

[[nodiscard]] core::Result<AnalysisValue> value_of(const RotaryResult& result,
                                                   const record::Characteristic& characteristic);
/// The intervals of these values, in their order; or why there is none.
[[nodiscard]] std::vector<UncertaintyStatus> intervals_of(
    const RotaryResult& result, std::span<const record::Characteristic> characteristics,
    const UncertaintyOptions& options);
[[nodiscard]] ValueOperator operator_of(const RotaryResult& result,
                                        const record::Characteristic& characteristic,
                                        const core::Phrase& temperature);
[[nodiscard]] core::Phrase filter_text(const RotaryResult& result);
[[nodiscard]] core::Phrase sampling_text(const RotaryResult& result);

/// One axis, "alpha" or "beta", with its study.
struct AxisFacts {
  const char* key = "";
  const fit::RotaryStudy* study = nullptr;
  const fixture::StationMotion* motion = nullptr;
};
[[nodiscard]] std::vector<AxisFacts> axes_of(const RotaryResult& facts);

}  // namespace rondure::evaluation
