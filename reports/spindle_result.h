#pragma once

#include <string>
#include <utility>

#include "fit/spindle/axis_motion.h"
#include "fit/profiles/roundness_evaluation.h"
#include "fit/spindle/three_probe.h"
#include "reports/analysis.h"

namespace rondure::reports {

/// Everything found of a spindle feature.
struct SpindleFacts {
  fit::SwingArm arm;
  fit::ThreeProbeResult separation;
  fit::RoundnessEvaluation roundness;  ///< Of the recovered profile.
  fit::AxisMotion x;                   ///< ISO 230-7, fixed directions.
  fit::AxisMotion y;
};

/// evaluate_spindle.cpp evaluates and judges; json_spindle.cpp, html_spindle.cpp write.
class SpindleResult final : public AnalysisResult {
 public:
  explicit SpindleResult(SpindleFacts facts) : facts_(std::move(facts)) {}

  [[nodiscard]] core::Result<AnalysisValue> value_of(
      const record::Characteristic& characteristic) const override;
  [[nodiscard]] ValueOperator operator_of(const record::Characteristic& characteristic,
                                          const std::string& temperature) const override;
  [[nodiscard]] std::string filter_text() const override;
  [[nodiscard]] std::string sampling_text() const override;
  [[nodiscard]] nlohmann::ordered_json json() const override;
  [[nodiscard]] std::string html(const record::RunRecord& record, int feature) const override;
  [[nodiscard]] std::vector<SummaryLine> summary() const override;

  [[nodiscard]] const SpindleFacts& facts() const { return facts_; }

 private:
  SpindleFacts facts_;
};

/// A separation as JSON, as report.json and `rondure fit spindle --json` have it.
[[nodiscard]] nlohmann::ordered_json separation_json(const SpindleFacts& facts);

/// Roundness of a recovered profile, all references.
/// @param cutoff_upr  Gaussian low pass; 0: unfiltered.
[[nodiscard]] core::Result<SpindleFacts> spindle_facts(const fit::ProbeReadings& readings,
                                                       const fit::SwingArm& arm,
                                                       const fit::ProbeLayout& layout,
                                                       const fit::ThreeProbeOptions& options,
                                                       double cutoff_upr, bool inside);

/// The readings of a series with the columns alpha_deg, H1_um, H2_um, H3_um[, beta_deg].
[[nodiscard]] fit::ProbeReadings probe_readings(const record::Series& series);

}  // namespace rondure::reports
