#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/result.h"
#include "fit/geometry/probe_tip.h"
#include "record/run_record.h"
#include "reports/decision.h"
#include "reports/stated_value.h"

namespace rondure::reports {

struct FeatureResult;

/// What an analysis found for one characteristic.
struct AnalysisValue {
  double value_mm = 0.0;
  std::optional<double> limit_mm;           ///< In place of the tolerance: the line of a mask.
  std::string detail;                       ///< Joins the reason, e.g. "harmonic 5".
  std::optional<std::string> void_because;  ///< Why the value proves nothing.
  /// With `void_because`: the true value is not below `value_mm`, so that above the tolerance it
  /// does prove something.
  bool lower_bound = false;
};

/// A line of the terminal's summary: at most 13 characters of name, then text.
struct SummaryLine {
  std::string name;
  std::string text;
};

/// What one analysis (spindle, wheel, contour, calibration of the fixture) found of a feature, and
/// what each report says of it. Immutable; every function is pure. README.md says how to add one.
class AnalysisResult {
 public:
  AnalysisResult() = default;
  AnalysisResult(const AnalysisResult&) = delete;
  AnalysisResult& operator=(const AnalysisResult&) = delete;
  virtual ~AnalysisResult() = default;

  /// The value of a characteristic, or why there is none.
  [[nodiscard]] virtual core::Result<AnalysisValue> value_of(
      const record::Characteristic& characteristic) const = 0;
  /// How that value came about: "LSCI; gaussian low pass 50 UPR; ...; 20.3 degC".
  [[nodiscard]] virtual ValueOperator operator_of(const record::Characteristic& characteristic,
                                                  const std::string& temperature) const = 0;
  /// The filter, and what was recorded, as the archive keeps them.
  [[nodiscard]] virtual std::string filter_text() const = 0;
  [[nodiscard]] virtual std::string sampling_text() const = 0;
  /// Everything under the name of the shape in report.json. Curves (one number a sample) stand
  /// under the key "curves", which the stored results leave out.
  [[nodiscard]] virtual nlohmann::ordered_json json() const = 0;
  /// The body of the feature's section: key numbers, drawings, tables. `record` for the hidden
  /// truth of a simulation.
  [[nodiscard]] virtual std::string html(const record::RunRecord& record, int feature) const = 0;
  [[nodiscard]] virtual std::vector<SummaryLine> summary() const = 0;
  /// fixture-calibration.json, of a calibration of the fixture; empty for everything else.
  [[nodiscard]] virtual std::string calibration_file() const { return {}; }
};

/// Evaluates a feature whose shape is an analysis, by the file of its shape. Same record, same
/// bits.
/// @param probe  The qualification of the run, for an analysis of touches.
[[nodiscard]] FeatureResult evaluate_analysis(const record::RunRecord& record, int index,
                                              const std::optional<fit::ProbeTip>& probe);

/// Fills the characteristics of such a feature under the rule. Void without a result, without the
/// value, outside the temperature limits, where the value proves nothing, when the run did not
/// finish, or when the rule needs an interval: of series none is computed yet.
void decide_analysis(const record::RunRecord& record, const core::Result<DecisionRule>& rule,
                     FeatureResult& result);

/// The evaluations themselves, a file each. They set `analysis` and `warnings`, or `failure`.
void evaluate_spindle(const record::RunRecord& record, int index, FeatureResult& result);
void evaluate_wheel(const record::RunRecord& record, int index, FeatureResult& result);
void evaluate_contour(const record::RunRecord& record, int index, FeatureResult& result);
void evaluate_rotary(const record::RunRecord& record, int index, FeatureResult& result);

/// The parts of the reports that all analyses share: entries of report.json, the section of the
/// page.
[[nodiscard]] nlohmann::ordered_json analysis_json(const FeatureResult& feature);
[[nodiscard]] std::string analysis_section(const record::RunRecord& record, std::size_t index,
                                           const FeatureResult& feature);

}  // namespace rondure::reports
