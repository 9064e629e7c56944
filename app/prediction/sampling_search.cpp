#include "app/prediction/sampling_search.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "app/prediction/prediction.h"
#include "evaluation/decision/decision.h"
#include "evaluation/prediction/predict.h"
#include "plans/analyses/features.h"
#include "plans/forecast/forecast.h"

namespace rondure::app {
namespace {

using evaluation::Measurand;

constexpr std::array kRepeats = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 14, 16, 20, 25, 32, 40, 50};

Sampling sampling_of(const plans::FeaturePlan& feature) {
  const int layers = feature.type == record::Shape::kCircle ? 1 : feature.sampling.layers;
  return {layers, feature.sampling.points_per_layer, feature.pose_search.repeats};
}

/// Layers and points to try, the plan's own among them.
std::vector<Sampling> layouts_of(const plans::FeaturePlan& feature, Measurand measurand) {
  const Sampling planned = sampling_of(feature);
  const bool whole = measurand == Measurand::kWholeSurface;
  const bool section = feature.type == record::Shape::kCircle;
  const bool scan = feature.sampling.method == record::SamplingMethod::kScan;
  std::set<int> layers = {planned.layers};
  std::set<int> points = {planned.points_per_layer};
  if (whole) {
    if (!section) layers.insert({3, 4, 6, 9});
    if (!scan) points.insert({6, 8, 12, 18, 27, 40});
    if (!scan && section) points.insert({60, 90});
  } else {  // more points hardly reduce U here: try just enough to show that
    if (!section) layers.insert(planned.layers + (planned.layers + 1) / 2);
    if (!scan) points.insert({planned.points_per_layer * 3 / 2, planned.points_per_layer * 2});
  }
  std::vector<Sampling> out;
  for (const int l : layers) {
    for (const int p : points) out.push_back({l, p, 1});
  }
  std::stable_sort(out.begin(), out.end(), [](const Sampling& a, const Sampling& b) {
    return a.layers * a.points_per_layer < b.layers * b.points_per_layer;
  });
  return out;
}

evaluation::PredictionOptions few_parts(Measurand measurand) {
  evaluation::PredictionOptions options;
  options.plain_forms_only = true;
  options.whole_surface = measurand == Measurand::kWholeSurface;
  options.least_inspections = options.most_inspections = 24;
  return options;
}

evaluation::PredictionOptions all_parts() {
  evaluation::PredictionOptions options;
  options.plain_forms_only = true;
  options.budget_trials = 20;
  return options;
}

/// The smallest number of repeats to propose: 2 if the run determines the repeatability from them
/// because the plan does not declare it.
int least_repeats(const plans::Plan& plan) {
  if (!plan.uncertainty || !plan.uncertainty->probe) return 1;
  const auto& probe = *plan.uncertainty->probe;
  const bool contained = probe.form_limit_um > 0.0;
  return probe.repeatability_um || contained ? 1 : 2;
}

/// One layout of one feature: its path is planned once, its repeats are varied.
class SamplingLayout {
 public:
  /// @param sampling  Its repeats are ignored.
  SamplingLayout(plans::Plan plan, std::size_t feature, const Sampling& sampling)
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

  /// The forecast with the fewest repeats, or why the layout cannot be touched.
  [[nodiscard]] const core::Result<plans::Forecast>& forecast() const { return forecast_; }

  /// A candidate, without its U.
  [[nodiscard]] SamplingCandidate candidate(int repeats) const {
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

  /// Predicts the U of a candidate of this layout.
  /// @return  The prediction with the largest U of its characteristics; `why` when none has one.
  [[nodiscard]] core::Result<evaluation::Prediction> predict(
      Measurand measurand, const evaluation::PredictionOptions& options,
      SamplingCandidate& candidate) const {
    plans::Plan plan = plan_;
    plan.features[feature_].pose_search.repeats = candidate.sampling.repeats;
    const auto expected = plans::expected_record(plan, repeated(candidate.sampling.repeats));
    evaluation::Prediction worst;
    candidate.expanded_mm = candidate.nine_of_ten_expanded_mm = 0.0;
    candidate.stated = 0;
    candidate.missing.clear();
    const int feature = static_cast<int>(feature_);
    TRY(auto all, evaluation::predict(expected, {&feature, 1}, options));
    for (evaluation::Prediction& found : all.front()) {
      const auto& said = found.about(measurand);
      if (!said) {
        if (worst.why.empty() && !worst.sampled) worst.why = found.why;
        if (candidate.missing.empty()) candidate.missing = found.why;
        continue;
      }
      ++candidate.stated;
      candidate.expanded_mm = std::max(candidate.expanded_mm, said->expanded_mm());
      if (said->nine_of_ten_expanded_mm() >= candidate.nine_of_ten_expanded_mm) {
        candidate.nine_of_ten_expanded_mm = said->nine_of_ten_expanded_mm();
        worst = std::move(found);
      }
    }
    return worst;
  }

 private:
  /// The forecast with another number of repeats: the same path, repeated.
  [[nodiscard]] plans::Forecast repeated(int repeats) const {
    plans::Forecast out = *forecast_;
    for (plans::ForecastStage& stage : out.stages) {
      if (!stage.final_cloud || stage.feature != static_cast<int>(feature_)) continue;
      const int more = repeats - stage.times;
      out.touches += more * stage.touches;
      // The first repeat starts at the park position or the last cloud; all others take the same
      // time.
      out.time_s += more * again_s_;
      stage.time_s += more * again_s_;
      stage.times = repeats;
    }
    return out;
  }

  plans::Plan plan_;
  std::size_t feature_;
  Sampling sampling_;
  core::Result<plans::Forecast> forecast_;
  double again_s_ = 0.0;  ///< Time of one additional final cloud.
};

/// The search of one feature.
class Search {
 public:
  Search(const plans::Plan& plan, std::size_t feature, double target_mm)
      : plan_(plan), target_mm_(target_mm) {
    out_.feature = feature;
    out_.planned = sampling_of(plan.features[feature]);
    out_.measurand = evaluation::measurand_of(plan.decision_rule.measurand);
  }

  core::Result<SamplingSearch> run() {
    const SamplingLayout planned(plan_, out_.feature, out_.planned);
    if (!planned.forecast()) return core::fail(planned.forecast().error());
    TRY_DO(look_at_plan(planned));
    if (!out_.why.empty()) return out_;
    for (const Sampling& sampling : layouts_of(plan_.features[out_.feature], out_.measurand)) {
      const SamplingLayout layout(plan_, out_.feature, sampling);
      TRY_DO(try_layout(layout));
    }
    TRY_DO(confirm_cheapest());
    finish();
    return out_;
  }

 private:
  /// Evaluates the unchanged plan: the first candidate, or why there is none.
  core::Result<void> look_at_plan(const SamplingLayout& planned) {
    SamplingCandidate as_planned = planned.candidate(out_.planned.repeats);
    TRY(const auto found, planned.predict(out_.measurand, all_parts(), as_planned));
    if (!found.about(out_.measurand)) {
      out_.why = !found.why.empty()
                     ? found.why
                     : fmt::format("nothing is stated {}", evaluation::name_of(out_.measurand));
      return {};
    }
    stated_ = as_planned.stated;
    // With one touch per point and no declared repeatability, U would be too small: noise is
    // missing.
    if (out_.planned.repeats >= least_repeats(plan_)) keep(as_planned, found, true);
    return {};
  }

  /// @return Whether the candidate meets the target, with an interval wherever the plan has one.
  bool keep(SamplingCandidate candidate, const evaluation::Prediction& found, bool confirmed) {
    candidate.confirmed = confirmed;
    if (candidate.stated < stated_) candidate.out_of_reach = candidate.missing;
    const bool sound = candidate.out_of_reach.empty();
    const bool meets = sound && candidate.nine_of_ten_expanded_mm <= target_mm_;
    candidate.meets = meets;
    if (sound && confirmed && (smallest_mm_ < 0.0 || candidate.expanded_mm < smallest_mm_)) {
      smallest_mm_ = candidate.expanded_mm;
      out_.limit = largest_influences(found, out_.measurand);
    }
    const auto same = std::find_if(
        out_.candidates.begin(), out_.candidates.end(),
        [&](const SamplingCandidate& other) { return other.sampling == candidate.sampling; });
    if (same == out_.candidates.end()) {
      out_.candidates.push_back(std::move(candidate));
    } else if (!same->confirmed) {
      *same = std::move(candidate);
    }
    return meets;
  }

  /// Whether a candidate with this time could still be the fastest.
  [[nodiscard]] bool worth_trying(double time_s) const {
    return std::none_of(out_.candidates.begin(), out_.candidates.end(),
                        [&](const SamplingCandidate& c) { return c.meets && c.time_s <= time_s; });
  }

  core::Result<bool> meets(const SamplingLayout& layout, int repeats) {
    SamplingCandidate candidate = layout.candidate(repeats);
    TRY(const auto found, layout.predict(out_.measurand, few_parts(out_.measurand), candidate));
    return keep(std::move(candidate), found, false);
  }

  /// Finds the fewest repeats of a layout that meet the target, among those worth trying.
  core::Result<void> try_layout(const SamplingLayout& layout) {
    if (!layout.forecast()) {
      out_.candidates.push_back(layout.candidate(least_repeats(plan_)));
      return {};
    }
    std::vector<int> repeats;
    for (const int q : kRepeats) {
      if (q < least_repeats(plan_)) continue;
      if (worth_trying(layout.candidate(q).time_s)) repeats.push_back(q);
    }
    if (repeats.empty()) return {};
    std::size_t low = 0;  // the fewest repeats that may meet the target
    std::size_t high = repeats.size() - 1;
    if (const auto most = meets(layout, repeats[high]); !most || !*most) {
      return most ? core::Result<void>() : core::fail(most.error());
    }
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      TRY(const auto enough, meets(layout, repeats[middle]));
      (enough ? high : low) = enough ? middle : middle + 1;
    }
    return {};
  }

  /// Predicts the fastest candidate that meets the target with all parts, until one is confirmed.
  core::Result<void> confirm_cheapest() {
    for (;;) {
      const SamplingCandidate* cheapest = cheapest_that_meets();
      if (cheapest == nullptr || cheapest->confirmed) break;
      SamplingCandidate candidate = *cheapest;
      const SamplingLayout layout(plan_, out_.feature, candidate.sampling);
      TRY(const auto found, layout.predict(out_.measurand, all_parts(), candidate));
      if (keep(candidate, found, true)) break;
      const auto* more =
          std::upper_bound(kRepeats.begin(), kRepeats.end(), candidate.sampling.repeats);
      if (more == kRepeats.end()) continue;
      TRY_DO(meets(layout, *more));
    }
    return confirm_smallest();
  }

  /// If no candidate meets the target: predicts the smallest U, with its main influences.
  core::Result<void> confirm_smallest() {
    if (cheapest_that_meets() != nullptr) return {};
    const SamplingCandidate* smallest = nullptr;
    for (const SamplingCandidate& c : out_.candidates) {
      if (!c.out_of_reach.empty()) continue;
      if (smallest == nullptr || c.expanded_mm < smallest->expanded_mm) smallest = &c;
    }
    if (smallest == nullptr || smallest->confirmed) return {};
    SamplingCandidate candidate = *smallest;
    const SamplingLayout layout(plan_, out_.feature, candidate.sampling);
    TRY(const auto found, layout.predict(out_.measurand, all_parts(), candidate));
    smallest_mm_ = -1.0;  // its influences are stated
    keep(candidate, found, true);
    return {};
  }

  [[nodiscard]] const SamplingCandidate* cheapest_that_meets() const {
    const SamplingCandidate* out = nullptr;
    for (const SamplingCandidate& c : out_.candidates) {
      if (c.meets && (out == nullptr || c.time_s < out->time_s)) out = &c;
    }
    return out;
  }

  void finish() {
    std::stable_sort(
        out_.candidates.begin(), out_.candidates.end(),
        [](const SamplingCandidate& a, const SamplingCandidate& b) { return a.time_s < b.time_s; });
    const SamplingCandidate* cheapest = cheapest_that_meets();
    if (cheapest != nullptr) {
      out_.best = static_cast<std::size_t>(cheapest - out_.candidates.data());
      out_.limit.clear();
    }
  }

  const plans::Plan& plan_;
  double target_mm_;
  SamplingSearch out_;
  int stated_ = 0;  ///< Characteristics of the plan that have an interval.
  double smallest_mm_ = -1.0;
};

}  // namespace

std::vector<SamplingChange> changes_of(const SamplingSearch& search) {
  std::vector<SamplingChange> out;
  if (!search.best) return out;
  const Sampling& wanted = search.candidates[*search.best].sampling;
  const auto change = [&](const char* object, const char* key, int planned, int value) {
    if (planned == value) return;
    out.push_back({fmt::format("/features/{}/{}", search.feature, object), key, value});
  };
  change("sampling", "layers", search.planned.layers, wanted.layers);
  change("sampling", "points_per_layer", search.planned.points_per_layer, wanted.points_per_layer);
  change("pose_search", "repeats", search.planned.repeats, wanted.repeats);
  return out;
}

core::Result<std::vector<SamplingSearch>> search_samplings(const plans::Plan& plan,
                                                           double target_mm) {
  std::vector<SamplingSearch> out;
  for (std::size_t i = 0; i < plan.features.size(); ++i) {
    if (!plans::is_touched(plan.features[i])) continue;
    TRY(auto found, Search(plan, i, target_mm).run());
    out.push_back(std::move(found));
  }
  return out;
}

}  // namespace rondure::app
