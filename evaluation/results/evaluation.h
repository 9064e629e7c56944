#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/error.h"
#include "core/pose.h"
#include "core/result.h"
#include "evaluation/decision/decision.h"
#include "evaluation/decision/verdict.h"
#include "evaluation/results/merged_poses.h"
#include "evaluation/results/stated_value.h"
#include "evaluation/results/thermal.h"
#include "fit/geometry/axis.h"
#include "fit/least_squares/circle.h"
#include "fit/least_squares/cylinder.h"
#include "fit/least_squares/probe_tip.h"
#include "fit/profiles/roundness_evaluation.h"
#include "fit/references/min_zone_circle.h"
#include "fit/references/min_zone_cylinder.h"
#include "fit/references/one_sided_center.h"
#include "fit/references/one_sided_cylinder.h"
#include "record/run_record.h"

namespace rondure::evaluation {

struct AnalysisResult;  // analysis_result.h

/// One point of the cloud that is evaluated: the mean of its repeated touches, or, where those do
/// not meet at one place (scans), one of them.
struct CloudPoint {
  int layer = 0;
  int point = 0;
  int repeats = 1;
  std::optional<int> pass;  ///< Of a point that was not averaged: in which repeat it was measured.
  double time_s = 0.0;      ///< Mean time of its touches.
  int pose = 0;             ///< Of a cloud that several poses make: in which of them.
  /// Mean tip centre, machine frame; of a cloud that several poses make: body frame.
  Eigen::Vector3d tip_mm = Eigen::Vector3d::Zero();
  double angle_rad = 0.0;     ///< About the minimum-zone axis, in [0, 2 pi).
  double height_mm = 0.0;     ///< Along that axis, from the mean point.
  double deviation_mm = 0.0;  ///< Distance from the axis minus the mean of the two zone radii.
  bool outer_contact = false;
  bool inner_contact = false;
};

/// f in one pose: the least zone with the axis held parallel to machine z.
struct PoseValue {
  core::Pose pose;
  double f_mm = 0.0;
  std::string ending;    ///< "cross", "spoke", "co-circular", ...; or why there is no f.
  bool valid = false;    ///< f could be computed.
  bool physical = true;  ///< false: rotated in software.
  bool final_pose = false;
};

/// What stands in place of a reference that nobody asked the fits for.
[[nodiscard]] inline tl::unexpected<core::Error> not_fitted() {
  return core::fail(core::Code::kReferenceAbsent, "it was not fitted");
}

/// One section of a cylinder, normal to the minimum-zone axis; or the circle itself.
struct LayerResult {
  int layer = 0;
  double height_mm = 0.0;
  std::vector<std::size_t> rows;        ///< Of the cloud.
  core::Result<fit::MinZoneCircle> mz;  ///< About its own minimum-zone centre (RONt).
  core::Result<fit::LsCircle> ls;
  core::Result<fit::OneSidedCircle> mc = not_fitted();  ///< Where there is none: why.
  core::Result<fit::OneSidedCircle> mi = not_fitted();
  /// Gaussian, 50 UPR, with harmonics, where 7 points stand for an undulation; else nothing.
  std::optional<fit::RoundnessEvaluation> filtered = {};
  std::vector<Eigen::Vector2d> points_mm = {};  ///< What was fitted: `rows`, in the centres' frame.
};

/// Verdict on one characteristic.
struct CharacteristicResult {
  record::Characteristic characteristic;
  std::optional<StatedValue> value;  ///< Nothing when it could not be evaluated.
  Verdict verdict = Verdict::kVoid;
  core::Phrase reason;                 ///< One sentence behind the verdict.
  std::optional<RuleOutcome> outcome;  ///< What the rule made of it; none for void, not toleranced.
  std::optional<GlobalRisks> risks;    ///< Where the rule has a prior.

  /// The value as measured, without what must be said with it: for computing, not for writing.
  [[nodiscard]] std::optional<double> value_mm() const {
    return value ? std::optional(value->value_mm()) : std::nullopt;
  }
};

/// The calibration of the fixture that a run used.
struct FixtureUse {
  std::string id;
  std::string fixture_id;
  std::string measured_utc;
  std::string expires_utc;
  std::optional<double> age_days;      ///< At the start of the run.
  double residual_rms_mm = 0.0;        ///< Left at its combined poses.
  double residual_max_mm = 0.0;        ///< The largest of them.
  double residual_tilt_rad = 0.0;      ///< Largest turn of a pose.
  std::optional<core::Error> invalid;  ///< Why it does not hold; results are void then.
};

/// Everything evaluated of one feature.
struct FeatureResult {
  record::Feature feature;
  std::vector<CloudPoint> cloud;
  std::optional<fit::LsCylinder> ls_cylinder;
  std::optional<fit::MinZoneCylinder> mz_cylinder;                 ///< Cylinder features.
  core::Result<fit::OneSidedCylinder> mc_cylinder = not_fitted();  ///< Where there is none: why.
  core::Result<fit::OneSidedCylinder> mi_cylinder = not_fitted();
  std::vector<LayerResult> layers;
  fit::Axis section_axis = {};               ///< Of a circle: origin and normal of its plane.
  std::vector<PoseValue> poses;              ///< In the order visited.
  std::optional<double> tip_radius_mm;       ///< rho that was used; none for points of unknown tip.
  std::optional<core::Pose> levelling_pose;  ///< That would turn the found axis to machine z.
  std::optional<double> repeat_sigma_mm;     ///< Pooled standard deviation of a single touch.
  int repeat_freedom = 0;                    ///< Degrees of freedom behind it.
  std::optional<double> repeat_zone_mean_mm;  ///< Mean of the zones of the single repeats.
  std::optional<double> repeat_zone_sd_mm;
  std::optional<Temperatures> temperatures;        ///< Of the final cloud; none: not known.
  std::shared_ptr<const MergedPoses> merged;       ///< Of the strategy "merged".
  std::shared_ptr<const AnalysisResult> analysis;  ///< Of a feature whose data are series.
  std::optional<ThermalCorrection> thermal;        ///< All above is at 20 degC; none: as measured.
  std::vector<CharacteristicResult> characteristics;
  std::vector<core::Error> warnings;
  std::optional<core::Error> failure;  ///< Why there is no result.
};

/// What a record says: a pure function of it.
struct Evaluation {
  std::optional<fit::ProbeTip> probe;
  std::optional<FixtureUse> fixture;                 ///< None: taken as nominal.
  core::Result<DecisionRule> rule = DecisionRule();  ///< Of the run, or why it is not known.
  std::vector<FeatureResult> features;
  Verdict verdict = Verdict::kVoid;  ///< The worst of all toleranced characteristics.
};

}  // namespace rondure::evaluation
