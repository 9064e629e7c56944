#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/error.h"
#include "core/pose.h"
#include "core/result.h"
#include "evaluation/decision/decision.h"
#include "evaluation/results/clamping.h"
#include "evaluation/results/gate.h"
#include "evaluation/results/merged_poses.h"
#include "evaluation/results/stated_value.h"
#include "evaluation/results/thermal.h"
#include "fit/geometry/axis.h"
#include "fit/least_squares/circle.h"
#include "fit/least_squares/cone.h"
#include "fit/least_squares/cylinder.h"
#include "fit/least_squares/plane.h"
#include "fit/least_squares/probe_tip.h"
#include "fit/profiles/roundness.h"
#include "fit/references/min_zone.h"
#include "fit/references/one_sided.h"
#include "record/run_record.h"

namespace rondure::evaluation {

struct AnalysisResult;  // analysis_result.h
struct Finding;         // finding.h

/// One point of the evaluated cloud: the mean of its repeated touches or, where repeats do not meet
/// at one place (scans), one of them.
struct CloudPoint {
  int layer = 0;
  int point = 0;
  int repeats = 1;
  std::optional<int> pass;  ///< Repeat in which a point that was not averaged was measured.
  double time_s = 0.0;      ///< Mean time of its touches.
  int pose = 0;             ///< Index of the pose, in a cloud of several poses.
  /// Mean tip centre, machine frame; body frame in a cloud of several poses.
  Eigen::Vector3d tip_mm = Eigen::Vector3d::Zero();
  double angle_rad = 0.0;     ///< Angle about the minimum-zone axis, in [0, 2 pi).
  double height_mm = 0.0;     ///< Height along that axis, from the mean point.
  double deviation_mm = 0.0;  ///< Distance from the axis minus the mean of the two zone radii.
  bool left_out = false;      ///< In a window: it enters no fit.
  bool outer_contact = false;
  bool inner_contact = false;
};

/// f in one pose: the least zone whose axis is parallel to machine z.
struct PoseValue {
  core::Pose pose;
  double f_mm = 0.0;
  std::string ending;    ///< "cross", "spoke", "co-circular", ...; or why there is no f.
  bool valid = false;    ///< f could be computed.
  bool physical = true;  ///< false: rotated in software.
  bool final_pose = false;
};

/// The value of a reference that was not requested.
[[nodiscard]] inline tl::unexpected<core::Error> not_fitted() {
  return core::fail(core::Code::kReferenceAbsent, "it was not fitted");
}

/// One section of a cylinder, normal to the minimum-zone axis; or the circle itself.
struct LayerResult {
  int layer = 0;
  double height_mm = 0.0;
  std::vector<std::size_t> rows;        ///< Rows of the cloud.
  core::Result<fit::MinZoneCircle> mz;  ///< Zone about its own minimum-zone centre (RONt).
  core::Result<fit::LsCircle> ls;
  core::Result<fit::OneSidedCircle> mc = not_fitted();  ///< Or why there is none.
  core::Result<fit::OneSidedCircle> mi = not_fitted();
  /// Gaussian, 50 UPR, with harmonics, where there are 7 points per undulation; else none.
  std::optional<fit::RoundnessEvaluation> filtered = {};
  /// The fitted points: `rows`, in the frame of the centres.
  std::vector<Eigen::Vector2d> points_mm = {};
};

/// Value and verdict of one characteristic.
struct CharacteristicResult {
  record::Characteristic characteristic;
  std::optional<StatedValue> value;  ///< None when it could not be evaluated.
  Verdict verdict = Verdict::kVoid;
  core::Phrase reason;                 ///< One sentence behind the verdict.
  std::optional<RuleOutcome> outcome;  ///< Outcome of the rule; none for void, not toleranced.
  std::optional<GlobalRisks> risks;    ///< Where the rule has a prior.
  /// How find() came to the value; null for values of other origin.
  std::shared_ptr<const Finding> finding = {};
  /// Each value that `finding` judged, as stated; `value` is the one that decides.
  std::vector<StatedValue> judged = {};
  /// What each judged value, or the value, is without errors of measurement at the same touches;
  /// only of a simulation.
  std::vector<double> truths_mm = {};

  /// The value as measured, without its qualifying words: for computing, not for writing.
  [[nodiscard]] std::optional<double> value_mm() const {
    return value ? std::optional(value->value_mm()) : std::nullopt;
  }
};

/// Puts another verdict in the place of what a rule said; the caller gives the reason.
template <class Judgement>
void overrule(Judgement& judgement, Verdict verdict) {
  judgement.verdict = verdict;
  judgement.outcome.reset();
  judgement.risks.reset();
}

/// The calibration of the fixture that a run used.
struct FixtureUse {
  std::string id;
  std::string fixture_id;
  std::string measured_utc;
  std::string expires_utc;
  std::optional<double> age_days;          ///< Age at the start of the run.
  double residual_rms_mm = 0.0;            ///< Residual at its combined poses.
  double residual_max_mm = 0.0;            ///< Largest such residual.
  double residual_tilt_rad = 0.0;          ///< Largest residual rotation of a pose.
  std::optional<double> temperature_degC;  ///< Of the calibration, or as this plan declares it.
  std::optional<double> expansion_1_K;     ///< Of the fixture, as the calibration declares it.
  double axis_height_mm = 0.0;             ///< Of the base-fixed axis, in the base of the fixture.
  std::optional<core::Error> invalid;      ///< Why it does not hold; results are then void.
  int source = -1;  ///< Feature of this run that found it for those after it; -1: a file.
};

/// All results for one feature.
struct FeatureResult {
  record::Feature feature;
  std::vector<CloudPoint> cloud;
  /// Turns the frame of the part, as planned and as its place was found, to that of the cloud.
  Eigen::Matrix3d part_turn = Eigen::Matrix3d::Identity();
  std::optional<Clamping> clamping;  ///< None: no points that datums can be held against.
  std::optional<fit::LsCylinder> ls_cylinder;
  std::optional<fit::MinZoneCylinder> mz_cylinder;                 ///< Only for cylinder features.
  core::Result<fit::OneSidedCylinder> mc_cylinder = not_fitted();  ///< Or why there is none.
  core::Result<fit::OneSidedCylinder> mi_cylinder = not_fitted();
  std::optional<fit::LsPlane> ls_plane;  ///< These two only for planes.
  std::optional<fit::MinZonePlane> mz_plane;
  std::optional<fit::LsCone> ls_cone;  ///< These two only for cones.
  std::optional<fit::MinZoneCone> mz_cone;
  std::optional<fit::LsSphere> ls_sphere;  ///< These two only for spheres.
  std::optional<fit::MinZoneSphere> mz_sphere;
  std::vector<LayerResult> layers;
  fit::Axis section_axis = {};  ///< For a circle: origin and normal of its plane.
  /// A circle of a file whose plane leans, evaluated about z; null where that makes no difference
  /// or the plan asks for it.
  std::shared_ptr<const FeatureResult> about_nominal;
  std::vector<PoseValue> poses;         ///< In the order of the visits.
  std::optional<double> tip_radius_mm;  ///< Tip radius used; none for points with an unknown tip.
  std::optional<core::Pose> levelling_pose;   ///< Pose that would turn the found axis to machine z.
  std::optional<double> repeat_sigma_mm;      ///< Pooled standard deviation of a single touch.
  int repeat_freedom = 0;                     ///< Degrees of freedom of `repeat_sigma_mm`.
  std::optional<double> repeat_zone_mean_mm;  ///< Mean of the zones of the single repeats.
  std::optional<double> repeat_zone_sd_mm;
  std::optional<Temperatures> temperatures;        ///< During the final cloud; none: not known.
  std::shared_ptr<const MergedPoses> merged;       ///< Only for the strategy "merged".
  std::shared_ptr<const AnalysisResult> analysis;  ///< Only for a feature whose data are series.
  std::shared_ptr<const AnalysisResult> exact;  ///< `analysis` of a simulation without its errors.
  std::vector<Gate> gates;  ///< Of an analysis, and of the fixture: all that were checked.
  /// All values above are at 20 degC; none: as measured.
  std::optional<ThermalCorrection> thermal;
  bool complete = true;  ///< All of it was measured; false: the run ended before that.
  std::vector<CharacteristicResult> characteristics;
  std::vector<core::Error> warnings;
  std::optional<core::Error> failure;  ///< Why there is no result.
};

/// The plane in which a circle of a file is evaluated, as its plan states it: "points", "nominal";
/// else empty.
inline constexpr const char* kPlaneSetting = "source/plane";
[[nodiscard]] inline std::string stated_plane(const record::Feature& feature) {
  const auto found = std::ranges::find(feature.settings, kPlaneSetting, &record::Setting::name);
  return found == feature.settings.end() ? std::string() : found->text;
}

/// Evaluation of a record: a pure function of it.
struct Evaluation {
  std::optional<fit::ProbeTip> probe;
  std::optional<FixtureUse> fixture;                 ///< None: the fixture was treated as nominal.
  core::Result<DecisionRule> rule = DecisionRule();  ///< Rule of the run, or why it is not known.
  std::vector<FeatureResult> features;
  Verdict verdict = Verdict::kVoid;  ///< The worst of all toleranced characteristics.
};

}  // namespace rondure::evaluation
