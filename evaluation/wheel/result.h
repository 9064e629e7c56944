#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "evaluation/results/analysis_value.h"
#include "evaluation/results/gate.h"
#include "evaluation/results/measured_radius.h"
#include "fit/wheel/evaluation.h"
#include "record/tasks/analysis_influences.h"
#include "record/tasks/wheel.h"

namespace rondure::evaluation {

struct FeatureResult;  // results/evaluation.h

/// The spindle axis as an earlier feature found it.
struct MeasuredAxis {
  std::string feature;  ///< Id of that feature.
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();
  /// Columns: change of the axis for one standard draw of the noise of its points, the greater
  /// first; their squares add to the covariance. None: that feature declares no noise.
  std::optional<Eigen::Matrix2d> root_mm;
  record::Influence squareness_urad;  ///< Of the stage, as that feature declares it.
  /// Shift of the axis for one radian of squareness, which an arc does not see evenly.
  Eigen::Vector2d per_squareness_mm = Eigen::Vector2d::Zero();
};

/// All results for a wheel feature, with its settings.
struct WheelResult {
  std::vector<Eigen::Vector2d> points_mm;  ///< x and z as recorded.
  fit::WheelTask task;
  fit::WheelEvaluation evaluation;
  std::optional<record::WheelInfluencesTask> declared;  ///< As the plan declares them.
  std::optional<MeasuredAxis> measured_axis;  ///< Where the axis is that of another feature.
  /// Of the effective radius [mm]; none where it is not known.
  UncertaintyStatus effective_radius = UncertaintyStatus::none({});
  std::optional<double> expansion_1_K;  ///< Of the wheel, as the plan states it.
  std::optional<double> above_20_K;     ///< Its temperature less 20 degC; none: not known.

  /// R that is judged: at 20 degC where temperature and expansion are known, else as measured.
  [[nodiscard]] double judged_radius_mm() const {
    return evaluation.wheel.radius_mm /
           (1.0 + expansion_1_K.value_or(0.0) * above_20_K.value_or(0.0));
  }
};

/// The radius that a wheel at speed shows, for a feature that takes it.
/// @param id  Of its feature.
/// @return  The radius with its errors; or why the feature gives none: points of its body, or a
///          radius that is void or that form moves by an unknown amount.
[[nodiscard]] core::Result<MeasuredRadius> measured_radius(const WheelResult& swept,
                                                           const std::string& id);

/// Finds the result of an earlier wheel by the id of its feature; or says why nothing can be taken
/// from it: there is none, it is void, it is no wheel.
using EarlierWheel = std::function<core::Result<const WheelResult*>(const std::string& id)>;

/// The settings of a measurement as a plan or the command line spells them.
[[nodiscard]] fit::WheelOptions wheel_options(const record::WheelTask& task, std::uint64_t seed);

/// Evaluates feature `index` of a record.
/// @param earlier  Asked where another feature gives the axis.
/// @param result  Holds the feature; receives the warnings.
/// @return  The result, or the reason why there is none.
[[nodiscard]] core::Result<WheelResult> evaluate_wheel(const record::RunRecord& record, int index,
                                                       const EarlierWheel& earlier,
                                                       FeatureResult& result);

[[nodiscard]] core::Result<AnalysisValue> value_of(const WheelResult& result,
                                                   const record::Characteristic& characteristic);
/// The intervals of these values, in their order; or why there is none.
[[nodiscard]] std::vector<UncertaintyStatus> intervals_of(
    const WheelResult& result, std::span<const record::Characteristic> characteristics,
    const UncertaintyOptions& options);
/// The interval of the effective radius.
[[nodiscard]] UncertaintyStatus effective_radius_interval(const WheelResult& result,
                                                          const UncertaintyOptions& options);
/// The gates of these characteristics, passed or not.
[[nodiscard]] std::vector<Gate> gates_of(const WheelResult& result,
                                         std::span<const record::Characteristic> characteristics);
[[nodiscard]] ValueOperator operator_of(const WheelResult& result,
                                        const record::Characteristic& characteristic,
                                        const core::Phrase& temperature);
[[nodiscard]] core::Phrase filter_text(const WheelResult& result);
[[nodiscard]] core::Phrase sampling_text(const WheelResult& result);

}  // namespace rondure::evaluation
