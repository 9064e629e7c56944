#pragma once

#include <string>
#include <utility>
#include <vector>

#include "fit/contour/study.h"
#include "reports/analysis.h"

namespace rondure::reports {

/// Everything found of a contour feature.
struct ContourFacts {
  fit::ContourStudyOptions options;
  fit::ContourStudy study;
  std::vector<std::string> names;  ///< One a part.
};

/// evaluate_contour.cpp evaluates and judges, html_contour.cpp writes the page.
class ContourResult final : public AnalysisResult {
 public:
  explicit ContourResult(ContourFacts facts) : facts_(std::move(facts)) {}

  [[nodiscard]] core::Result<AnalysisValue> value_of(
      const record::Characteristic& characteristic) const override;
  [[nodiscard]] ValueOperator operator_of(const record::Characteristic& characteristic,
                                          const std::string& temperature) const override;
  [[nodiscard]] std::string filter_text() const override;
  [[nodiscard]] std::string sampling_text() const override;
  [[nodiscard]] nlohmann::ordered_json json() const override;
  [[nodiscard]] std::string html(const record::RunRecord& record, int feature) const override;
  [[nodiscard]] std::vector<SummaryLine> summary() const override;

  [[nodiscard]] const ContourFacts& facts() const { return facts_; }

 private:
  ContourFacts facts_;
};

}  // namespace rondure::reports
