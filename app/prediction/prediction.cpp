#include "app/prediction/prediction.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "plans/analyses/analysis.h"
#include "plans/forecast/forecast.h"

namespace rondure::app {
namespace {

using Predictions = std::vector<PredictedCharacteristic>;

/// A characteristic of an analysis of which nothing is predicted.
PredictedCharacteristic not_predicted(std::size_t feature, const record::Characteristic& asked,
                                      std::string why) {
  PredictedCharacteristic out;
  out.feature = feature;
  out.characteristic = asked;
  out.prediction.why = std::move(why);
  return out;
}

/// Predicts the characteristics of an analysis of series.
/// @param simulated  The expected record with simulated series.
core::Result<Predictions> predict_series(const plans::Plan& plan,
                                         const record::RunRecord& simulated, std::size_t feature) {
  const auto& asked = simulated.features[feature].characteristics;
  Predictions out;
  if (plans::has_files(plan.features[feature])) {
    for (const record::Characteristic& one : asked) {
      out.push_back(not_predicted(feature, one,
                                  "its data come from a file: a run states the interval at once"));
    }
    return out;
  }
  TRY(auto found, evaluation::predict_analysis(simulated, static_cast<int>(feature)));
  for (std::size_t c = 0; c < asked.size(); ++c) {
    PredictedCharacteristic one = not_predicted(feature, asked[c], found[c].why);
    if (one.prediction.why.empty()) {
      one.analysis = std::move(found[c]);
      one.simulated_seed = plans::forecast_seed(plan);
    }
    out.push_back(std::move(one));
  }
  return out;
}

/// The planned touches of each ball in each combined pose.
std::vector<evaluation::BallTouches> combined_touches(const plans::Forecast& forecast,
                                                      std::size_t feature, int points) {
  std::vector<evaluation::BallTouches> out;
  for (const plans::ForecastStage& stage : forecast.stages) {
    const bool combined = stage.pose.alpha_rad != 0.0 && stage.pose.beta_rad != 0.0;
    if (stage.feature != static_cast<int>(feature) || !combined ||
        stage.kind != plans::ForecastStage::Kind::kCloud) {
      continue;
    }
    for (std::size_t i = 0; i < stage.contacts_W.size(); ++i) {
      if (i % static_cast<std::size_t>(points) == 0) out.emplace_back();
      out.back().push_back(stage.contacts_W[i]);
    }
  }
  return out;
}

bool is_residual(record::Form form) {
  return form == record::Form::kFixtureResidual || form == record::Form::kFixtureResidualRms;
}

/// Predicts the uncertainties of the residuals of a calibration; of errors of an axis it gives the
/// reason why there is none.
core::Result<Predictions> predict_calibration(const plans::Plan& plan,
                                              const plans::Forecast& forecast,
                                              const record::RunRecord& expected,
                                              std::size_t feature) {
  const auto touches =
      combined_touches(forecast, feature, plan.features[feature].rotary_axes->points);
  TRY(const auto found, evaluation::predict_residual(expected, static_cast<int>(feature), touches));
  Predictions out;
  for (const record::Characteristic& asked : expected.features[feature].characteristics) {
    std::string why = evaluation::why_not_foretold(asked.form).value_or("");
    if (!found.why.empty()) why = found.why;
    PredictedCharacteristic& one = out.emplace_back(not_predicted(feature, asked, std::move(why)));
    if (found.why.empty() && is_residual(asked.form)) one.residual = found;
  }
  return out;
}

}  // namespace

core::Result<std::vector<PredictedCharacteristic>> predict_plan(const plans::Plan& plan,
                                                                const plans::Forecast& forecast) {
  TRY(const auto simulated,
      plans::with_series(plans::expected_record(plan, forecast), plan, plans::forecast_seed(plan)));
  const record::RunRecord& expected = simulated;
  evaluation::PredictionOptions options;
  options.budget_trials = 20;
  std::vector<int> surfaces;
  for (std::size_t i = 0; i < expected.features.size(); ++i) {
    if (!record::is_analysis(expected.features[i].shape)) surfaces.push_back(static_cast<int>(i));
  }
  TRY(auto found, evaluation::predict(expected, surfaces, options));
  std::vector<PredictedCharacteristic> out;
  auto next = found.begin();
  for (std::size_t i = 0; i < expected.features.size(); ++i) {
    if (record::is_analysis(expected.features[i].shape)) {
      TRY(auto analysis, plans::measures_by_touch(plan.features[i])
                             ? predict_calibration(plan, forecast, expected, i)
                             : predict_series(plan, expected, i));
      std::move(analysis.begin(), analysis.end(), std::back_inserter(out));
      continue;
    }
    for (std::size_t c = 0; c < next->size(); ++c) {
      out.push_back({i, expected.features[i].characteristics[c], std::move((*next)[c])});
    }
    ++next;
  }
  return out;
}

std::string largest_of(const std::vector<evaluation::BudgetLine>& budget) {
  constexpr double kWorthNaming = 0.05;
  double sum = 0.0;
  for (const evaluation::BudgetLine& line : budget) {
    sum += line.standard_uncertainty_mm * line.standard_uncertainty_mm;
  }
  std::string out;
  for (const evaluation::BudgetLine& line : budget) {
    const double square = line.standard_uncertainty_mm * line.standard_uncertainty_mm;
    if (!(square > kWorthNaming * sum)) continue;
    out += fmt::format("{}{} {:.0f} %", out.empty() ? "" : ", ", line.name, 100.0 * square / sum);
  }
  return out;
}

std::string largest_influences(const evaluation::Prediction& prediction,
                               evaluation::Measurand measurand) {
  std::vector<evaluation::BudgetLine> counted;
  for (const evaluation::BudgetLine& line : prediction.budget) {
    if (measurand == evaluation::Measurand::kWholeSurface || line.measurand == measurand) {
      counted.push_back(line);
    }
  }
  return largest_of(counted);
}

}  // namespace rondure::app
