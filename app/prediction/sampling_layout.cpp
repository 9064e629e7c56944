#include "app/prediction/sampling_layout.h"

#include <algorithm>
#include <utility>

#include "plans/forecast/expected_record.h"

namespace rondure::app {

using evaluation::Measurand;

/// A run derives the repeatability from its repeats, unless the plan declares it.
int least_repeats(const plans::Plan& plan) {
  if (!plan.uncertainty || !plan.uncertainty->probe) return 1;
  const auto& probe = *plan.uncertainty->probe;
  const bool contained = probe.form_limit_um > 0.0;
  return probe.repeatability_um || contained ? 1 : 2;
}

SamplingLayout::SamplingLayout(plans::Plan plan, std::size_t feature, const Sampling& sampling)
    : plan_(std::move(plan)), feature_(feature), sampling_(sampling) {
  sampling_.repeats = least_repeats(plan_);
  plans::FeaturePlan& changed = plan_.features[feature_];
  changed.sampling.layers = sampling_.layers;
  changed.sampling.points_per_layer = sampling_.points_per_layer;
  changed.pose_search.repeats = sampling_.repeats;
  forecast_ = plans::forecast(plan_);
  changed.pose_search.repeats = sampling_.repeats + 1;
  const auto longer = plans::forecast(plan_);
  if (forecast_ && longer) again_s_ = longer->time_s - forecast_->time_s;
}

SamplingCandidate SamplingLayout::candidate(int repeats) const {
  SamplingCandidate out;
  out.sampling = sampling_;
  out.sampling.repeats = repeats;
  if (!forecast_) {
    out.out_of_reach = forecast_.error().what;
    return out;
  }
  const plans::Forecast changed = repeated(repeats);
  out.touches = changed.touches;
  out.time_s = changed.time_s;
  return out;
}

core::Result<evaluation::Prediction> SamplingLayout::predict(
    Measurand measurand, const evaluation::PredictionOptions& options,
    SamplingCandidate& candidate) const {
  plans::Plan plan = plan_;
  plan.features[feature_].pose_search.repeats = candidate.sampling.repeats;
  const auto expected = plans::expected_record(plan, repeated(candidate.sampling.repeats));
  evaluation::Prediction worst;
  candidate.expanded_mm = candidate.nine_of_ten_expanded_mm = 0.0;
  candidate.stated = 0;
  candidate.missing.clear();
  for (const record::Characteristic& asked : expected.features[feature_].characteristics) {
    auto found = evaluation::predict(expected, static_cast<int>(feature_), asked, options);
    if (!found) return found;
    const auto& said = found->about(measurand);
    if (!said) {
      if (worst.why.empty() && !worst.sampled) worst.why = found->why;
      if (candidate.missing.empty()) candidate.missing = found->why;
      continue;
    }
    ++candidate.stated;
    candidate.expanded_mm = std::max(candidate.expanded_mm, said->expanded_mm());
    if (said->nine_of_ten_expanded_mm() >= candidate.nine_of_ten_expanded_mm) {
      candidate.nine_of_ten_expanded_mm = said->nine_of_ten_expanded_mm();
      worst = *std::move(found);
    }
  }
  return worst;
}

/// The forecast with another number of repeats: the same path, more often.
plans::Forecast SamplingLayout::repeated(int repeats) const {
  plans::Forecast out = *forecast_;
  for (plans::ForecastStage& stage : out.stages) {
    if (!stage.final_cloud || stage.feature != static_cast<int>(feature_)) continue;
    const int more = repeats - stage.times;
    out.touches += more * stage.touches;
    // The first time starts at the park position or the last cloud; all others are the same.
    out.time_s += more * again_s_;
    stage.time_s += more * again_s_;
    stage.times = repeats;
  }
  return out;
}

}  // namespace rondure::app
