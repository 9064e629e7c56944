#include "evaluation/prediction/predict_residual.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/units.h"
#include "core/watch.h"
#include "fit/rotary/ball_center.h"
#include "record/tasks/rotary_axes.h"
#include "record/tasks/settings.h"
#include "record/tasks/uncertainty.h"

namespace rondure::evaluation {
namespace {

constexpr double kMeanRangeOf25 = 3.93;  // of normal values: the touches of the qualification

ResidualPrediction no_residual(std::string why) {
  ResidualPrediction out;
  out.why = std::move(why);
  return out;
}

/// Standard deviation of a touch, with its source in words.
std::pair<double, std::string> touch_scatter(const record::RunRecord& expected) {
  const auto recorded = record::recorded_uncertainty(expected.settings);
  if (recorded && *recorded && (*recorded)->task.probe &&
      (*recorded)->task.probe->repeatability_um) {
    const double sigma_um = *(*recorded)->task.probe->repeatability_um;
    return {sigma_um * core::kMicrometre, fmt::format("{:.2g} um, as declared", sigma_um)};
  }
  const double sigma_mm = expected.artefact.form_limit_mm / kMeanRangeOf25;
  return {sigma_mm, fmt::format("{:.2g} um, the most that the qualification lets pass",
                                sigma_mm / core::kMicrometre)};
}

}  // namespace

core::Result<ResidualPrediction> predict_residual(const record::RunRecord& expected, int feature,
                                                  std::span<const BallTouches> combined) {
  const bool exists = feature >= 0 && static_cast<std::size_t>(feature) < expected.features.size();
  if (!exists ||
      expected.features[static_cast<std::size_t>(feature)].shape != record::Shape::kRotaryAxes) {
    return core::fail_with(core::Code::kBadOption, "feature {} is no calibration of a fixture",
                           feature);
  }
  const core::Working work("predicting U of the calibration");
  TRY(const auto task, record::task_of<record::RotaryTask>(
                           expected.features[static_cast<std::size_t>(feature)].settings));
  if (!task.uncertainty) {
    return no_residual(
        "no influence is declared: state `uncertainty` of `rotary_axes`, with `ball_um`, "
        "`repeat_urad` and `reading_urad`");
  }
  if (combined.empty()) return no_residual("no combined pose is planned");
  const auto [sigma_mm, words] = touch_scatter(expected);
  const double radius_mm = 0.5 * task.ball_diameter_mm + expected.artefact.nominal_tip_radius_mm;
  double cofactors = 0.0;
  for (const BallTouches& tips : combined) {
    const auto center = fit::ball_center(tips, radius_mm);
    if (!center) return no_residual(center.error().what);
    cofactors += center->cofactor.trace() / 3.0;
  }
  ResidualPrediction out;
  out.centers = combined.size();
  const auto count = static_cast<double>(combined.size());
  out.center_u_mm = std::hypot(sigma_mm * std::sqrt(cofactors / count),
                               record::u_of(task.uncertainty->ball_um) * core::kMicrometre);
  out.rms_u_mm = out.center_u_mm / std::sqrt(count);
  out.largest_u_mm = out.center_u_mm;
  out.repeatability = words;
  return out;
}

}  // namespace rondure::evaluation
