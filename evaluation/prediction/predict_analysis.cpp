#include "evaluation/prediction/predict_analysis.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "evaluation/analysis.h"
#include "evaluation/analysis_result.h"
#include "evaluation/interval/internal/declared.h"
#include "evaluation/results/evaluation.h"

namespace rondure::evaluation {
namespace {

AnalysisPrediction nothing(std::string why) {
  AnalysisPrediction out;
  out.why = std::move(why);
  return out;
}

AnalysisPrediction foretold(const AnalysisResult& result, const record::Characteristic& asked,
                            const UncertaintyStatus& interval) {
  if (auto why = why_not_foretold(asked.form)) return nothing(*std::move(why));
  const auto value = value_of(result, asked);
  if (!value) return nothing(value.error().what);
  if (value->void_because) {
    return nothing(fmt::format("the simulated data give no value that proves anything: {}",
                               value->void_because->english()));
  }
  const UncertaintyStatement* said = interval.about(Measurand::kSampledPoints);
  if (said == nullptr) return nothing(interval.why().english());
  AnalysisPrediction out;
  out.coverage_1 = interval.coverage_1();
  out.as_read_mm = value->value_mm;
  out.at_most = said->at_most;
  out.expected_mm = said->at_most ? said->high_mm : said->estimate_mm;
  out.below_mm = out.expected_mm - said->low_mm;
  out.above_mm = said->high_mm - out.expected_mm;
  out.budget = interval.result()->budget;
  double variance_mm2 = 0.0;
  for (const BudgetLine& line : out.budget) {
    variance_mm2 += line.standard_uncertainty_mm * line.standard_uncertainty_mm;
  }
  out.linear_u_mm = std::sqrt(variance_mm2);
  return out;
}

}  // namespace

std::optional<std::string> why_not_foretold(record::Form form) {
  switch (form) {
    case record::Form::kMotionAsynchronous:
      return "it is what differs from turn to turn, and only readings show that";
    case record::Form::kContourSpread:
      return "it is what differs from part to part, and only measured parts show that";
    case record::Form::kFixtureResidual:
    case record::Form::kFixtureResidualRms:
      return "it is what the axes do together beyond their calibration, and only the fixture shows "
             "that";
    case record::Form::kLeftRms:
    case record::Form::kLeftLargest:
      return "it is what the axes do together beyond their errors, and only readings show that";
    case record::Form::kAxisError:
      return "it is an error of the axis itself, and only measured balls show that";
    default:
      return std::nullopt;
  }
}

core::Result<std::vector<AnalysisPrediction>> predict_analysis(const record::RunRecord& simulated,
                                                               int feature) {
  const bool exists = feature >= 0 && static_cast<std::size_t>(feature) < simulated.features.size();
  const record::Feature* of =
      exists ? &simulated.features[static_cast<std::size_t>(feature)] : nullptr;
  if (of == nullptr || !record::is_analysis(of->shape) || of->shape == record::Shape::kRotaryAxes) {
    return core::fail_with(core::Code::kBadOption, "feature {} is no analysis of series", feature);
  }
  std::vector<FeatureResult> wheels;  // and heads: no other feature gives a value to a later one
  for (int i = 0; i < feature; ++i) {
    const record::Shape shape = simulated.features[static_cast<std::size_t>(i)].shape;
    if (shape != record::Shape::kWheel && shape != record::Shape::kFiveAxis) continue;
    wheels.push_back(evaluate_analysis(simulated, i, std::nullopt, wheels));
  }
  const FeatureResult result = evaluate_analysis(simulated, feature, std::nullopt, wheels);
  if (!result.analysis) {
    const std::string why =
        result.failure ? result.failure->what : std::string("there is no result");
    return std::vector<AnalysisPrediction>(of->characteristics.size(), nothing(why));
  }
  const auto intervals =
      intervals_of(*result.analysis, of->characteristics, uncertainty_options(simulated));
  std::vector<AnalysisPrediction> out;
  for (std::size_t c = 0; c < of->characteristics.size(); ++c) {
    out.push_back(foretold(*result.analysis, of->characteristics[c], intervals[c]));
  }
  return out;
}

}  // namespace rondure::evaluation
