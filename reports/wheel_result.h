#pragma once

#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "fit/wheel/evaluation.h"
#include "reports/analysis.h"

namespace rondure::reports {

/// Everything found of a wheel feature, with what was asked for.
struct WheelFacts {
  std::vector<Eigen::Vector2d> points_mm;  ///< As recorded, x and z.
  fit::WheelTask task;
  fit::WheelEvaluation evaluation;
};

/// evaluate_wheel.cpp evaluates and judges; wheel_json.cpp, html_wheel.cpp, plot_wheel.cpp write.
class WheelResult final : public AnalysisResult {
 public:
  explicit WheelResult(WheelFacts facts) : facts_(std::move(facts)) {}

  [[nodiscard]] core::Result<AnalysisValue> value_of(
      const record::Characteristic& characteristic) const override;
  [[nodiscard]] ValueOperator operator_of(const record::Characteristic& characteristic,
                                          const std::string& temperature) const override;
  [[nodiscard]] std::string filter_text() const override;
  [[nodiscard]] std::string sampling_text() const override;
  [[nodiscard]] nlohmann::ordered_json json() const override;
  [[nodiscard]] std::string html(const record::RunRecord& record, int feature) const override;
  [[nodiscard]] std::vector<SummaryLine> summary() const override;

 private:
  WheelFacts facts_;
};

}  // namespace rondure::reports
