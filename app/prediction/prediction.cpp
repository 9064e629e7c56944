#include "app/prediction/prediction.h"

#include <fmt/format.h>

#include "plans/forecast/expected_record.h"

namespace rondure::app {

core::Result<std::vector<PredictedCharacteristic>> predict_plan(const plans::Plan& plan,
                                                                const plans::Forecast& forecast) {
  const record::RunRecord expected = plans::expected_record(plan, forecast);
  evaluation::PredictionOptions options;
  options.budget_trials = 20;
  std::vector<PredictedCharacteristic> out;
  for (std::size_t i = 0; i < expected.features.size(); ++i) {
    for (const record::Characteristic& asked : expected.features[i].characteristics) {
      auto found = evaluation::predict(expected, static_cast<int>(i), asked, options);
      if (!found) return core::fail(found.error());
      out.push_back({i, asked, *std::move(found)});
    }
  }
  return out;
}

std::string largest_influences(const evaluation::Prediction& prediction,
                               evaluation::Measurand measurand) {
  constexpr double kWorthNaming = 0.05;
  const auto counts = [&](const evaluation::BudgetLine& line) {
    return measurand == evaluation::Measurand::kWholeSurface || line.measurand == measurand;
  };
  double sum = 0.0;
  for (const evaluation::BudgetLine& line : prediction.budget) {
    if (counts(line)) sum += line.standard_uncertainty_mm * line.standard_uncertainty_mm;
  }
  std::string out;
  for (const evaluation::BudgetLine& line : prediction.budget) {
    const double square = line.standard_uncertainty_mm * line.standard_uncertainty_mm;
    if (!counts(line) || !(square > kWorthNaming * sum)) continue;
    out += fmt::format("{}{} {:.0f} %", out.empty() ? "" : ", ", line.name, 100.0 * square / sum);
  }
  return out;
}

}  // namespace rondure::app
