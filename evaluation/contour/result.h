#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "evaluation/results/analysis_value.h"
#include "evaluation/results/measured_radius.h"
#include "fit/contour/study.h"
#include "record/tasks/analysis_influences.h"
#include "record/tasks/contour.h"

namespace rondure::evaluation {

struct FeatureResult;  // results/evaluation.h

/// A number that the report shows beside the characteristics, with its interval.
struct ContourNumber {
  enum class Kind { kPeakToValley, kRms, kIndex };
  enum class Curve { kTotal, kFollowing, kRest, kIndirect, kMain };

  Curve curve = Curve::kTotal;
  Kind kind = Kind::kPeakToValley;
  std::optional<std::size_t> part;  ///< None: of all parts together (the stability index).
  double as_measured = 0.0;         ///< mm; of an index a plain number.
  /// Interval, or why there is none. Of an index the members named _mm hold a plain number.
  UncertaintyStatus uncertainty = UncertaintyStatus::none({});

  /// "following-pv", "rest-rms", "total-index": stable, kebab-case.
  [[nodiscard]] std::string name() const;
};

/// Parts ground with a correction, beside those that gave it.
struct ContourGain {
  std::string with;        ///< The feature that gave the correction.
  double before_mm = 0.0;  ///< Peak to valley of its mean f.
};

/// All results for a contour feature.
struct ContourResult {
  fit::ContourStudyOptions options;
  fit::ContourStudy study;
  std::vector<std::string> names;  ///< One name per part.
  std::string feature_id;          ///< Draws of its own gauge noise carry this name.
  std::optional<record::ContourInfluencesTask> influences;
  std::optional<MeasuredRadius> wheel_radius;  ///< Where it is that of another feature.
  double sampling_ms = 0.0;  ///< From sample to sample of the control; 0: not known.
  /// Why a curve proves nothing: a gate that did not pass. A void t voids n as well, a void f too;
  /// without traces a void t voids f.
  std::optional<core::Phrase> total_void;
  std::optional<core::Phrase> following_void;
  std::optional<core::Phrase> rest_void;
  std::optional<ContourGain> gain;  ///< Of a repeat.
  bool indirect_is_bound = false;   ///< Pins and mains differ: f from the main is only a bound.
  std::vector<ContourNumber> numbers;
};

/// The settings of a study as a plan or the command line spells them.
[[nodiscard]] fit::ContourStudyOptions contour_options(const record::ContourTask& task);

/// What pins without a correction had, by the id of their feature; or why nothing is taken of it.
using ContourOf = std::function<core::Result<ContourGain>(const std::string& id)>;

/// A trace and a contour of the gauge as the fit takes them, from the series of a record.
[[nodiscard]] fit::AxisTrace trace_of(const record::Series& series);
[[nodiscard]] fit::GaugeRows rows_of(const record::Series& series);

/// Evaluates feature `index` of a record.
/// @param earlier  Asked where another feature gives the wheel radius.
/// @param pins     Asked where another feature gave a correction of X: f is then that of the axes
///                 with it.
/// @param result  Holds the feature; receives the warnings and the gates.
/// @return  The result, or the reason why there is none.
[[nodiscard]] core::Result<ContourResult> evaluate_contour(const record::RunRecord& record,
                                                           int index, const RadiusOf& earlier,
                                                           const ContourOf& pins,
                                                           FeatureResult& result);

[[nodiscard]] core::Result<AnalysisValue> value_of(const ContourResult& result,
                                                   const record::Characteristic& characteristic);
/// The intervals of these values, in their order; or why there is none.
[[nodiscard]] std::vector<UncertaintyStatus> intervals_of(
    const ContourResult& result, std::span<const record::Characteristic> characteristics,
    const UncertaintyOptions& options);
/// Peak to valley and rms of t, f and n of every part (of f by the main journal, where there is
/// one), and the stability indices, with intervals. A value of a void curve has none.
[[nodiscard]] std::vector<ContourNumber> contour_numbers(const ContourResult& facts,
                                                         const UncertaintyOptions& options);

[[nodiscard]] ValueOperator operator_of(const ContourResult& result,
                                        const record::Characteristic& characteristic,
                                        const core::Phrase& temperature);
[[nodiscard]] core::Phrase filter_text(const ContourResult& result);
[[nodiscard]] core::Phrase sampling_text(const ContourResult& result);

}  // namespace rondure::evaluation
