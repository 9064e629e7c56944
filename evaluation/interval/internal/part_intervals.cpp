#include "evaluation/interval/internal/part_intervals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "evaluation/interval/internal/declared.h"
#include "evaluation/interval/internal/form_interval.h"
#include "evaluation/part/find.h"
#include "evaluation/part/trials.h"

namespace rondure::evaluation {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

/// Numbers the poses in which the features were measured; those of one file share one.
class PoseNumbers {
 public:
  explicit PoseNumbers(const record::RunRecord& record) : record_(record) {}

  int of(const record::Feature& feature, std::size_t index) {
    std::tuple<std::string, double, double> place(feature.points_file, 0.0, 0.0);
    for (const record::PoseVisit& visit : record_.poses) {
      if (static_cast<std::size_t>(visit.feature) != index || !visit.final_cloud) continue;
      std::get<1>(place) = visit.reached.alpha_rad;
      std::get<2>(place) = visit.reached.beta_rad;
    }
    return numbers_.try_emplace(place, static_cast<int>(numbers_.size())).first->second;
  }

 private:
  const record::RunRecord& record_;
  std::map<std::tuple<std::string, double, double>, int> numbers_;
};

/// Standard uncertainty of the factor that brings the lengths of a feature to 20 degC.
double growth_of(const FeatureResult& result, const Influences& influences) {
  if (!influences.thermal) return 0.0;
  if (result.thermal) return result.thermal->factor_uncertainty;
  const ThermalInfluences& thermal = *influences.thermal;
  return std::hypot(thermal.expansion_1_K * thermal.temperature_K,
                    thermal.from_reference_K * thermal.expansion_uncertainty_1_K);
}

/// The rows outside the windows of a feature.
std::vector<std::size_t> rows_of_surface(const MeasuredSurface& surface) {
  if (const auto open = prepared(surface, record::Indication())) return open->rows;
  std::vector<std::size_t> all(surface.tips_mm.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  return all;
}

std::vector<std::size_t> surfaces_of_question(const PartQuestion& question) {
  std::vector<std::size_t> out = {question.feature};
  for (const DatumResult& datum : question.found->datums) {
    for (const std::size_t feature : datum.features) {
      if (std::find(out.begin(), out.end(), feature) == out.end()) out.push_back(feature);
    }
  }
  return out;
}

std::optional<double> conformance_of(const PartQuestion& question, const TrialAnswer& answer) {
  const auto no_interval = [](const auto& value) { return !value.has_value(); };
  if (answer.rows_mm.empty() ||
      std::any_of(answer.values.begin(), answer.values.end(), no_interval)) {
    return std::nullopt;
  }
  std::vector<Limits> limits;
  for (const JudgedValue& judged : question.found->judged) limits.push_back(judged.limits);
  return share_within(answer, limits);
}

}  // namespace

std::vector<double> judged_values(const core::Result<Finding>& found, std::size_t count) {
  std::vector<double> out(count, kNoValue);
  if (!found || found->judged.size() != count) return out;
  for (std::size_t v = 0; v < count; ++v) out[v] = found->judged[v].value_mm;
  return out;
}

std::vector<PartInterval> intervals_of(const record::RunRecord& record,
                                       std::span<const FeatureResult> features,
                                       const std::optional<fit::ProbeTip>& probe,
                                       std::span<const PartQuestion> questions,
                                       const std::optional<UncertaintyOptions>& trials) {
  std::vector<PartInterval> out(questions.size());
  const std::vector<MeasuredSurface> measured = surfaces_of(features);
  std::vector<std::optional<core::Phrase>> why(features.size());
  std::vector<bool> needed(features.size(), false);
  for (const PartQuestion& question : questions) {
    for (const std::size_t f : surfaces_of_question(question)) needed[f] = true;
  }
  std::vector<TrialSurface> surfaces;
  UncertaintyOptions options;
  bool whole = false;
  PoseNumbers poses(record);
  for (std::size_t f = 0; f < features.size(); ++f) {
    TrialSurface& surface = surfaces.emplace_back();
    surface.measured = measured[f];
    surface.pose = poses.of(features[f].feature, f);
    if (!needed[f]) continue;
    why[f] = why_no_interval(record, features[f].feature);
    if (!why[f]) why[f] = too_many_points(features[f].cloud.size());
    const auto declared = declared_for(record, features[f], probe);
    if (why[f] || !declared) continue;
    surface.rows = rows_of_surface(surface.measured);
    surface.influences = declared->influences;
    surface.growth_1 = growth_of(features[f], declared->influences);
    options = trials.value_or(declared->options);
    whole = declared->spectrum.has_value();
  }
  ReferenceTouches reference{{}, probe && probe->on_column()};
  for (const record::Touch& touch : record.touches) {
    if (touch.purpose == record::Touch::Purpose::kQualification)
      reference.tips_mm.push_back(touch.tip_mm);
  }
  std::vector<TrialQuestion> asked;
  std::vector<std::size_t> places;
  for (std::size_t q = 0; q < questions.size(); ++q) {
    const PartQuestion& question = questions[q];
    TrialQuestion trial;
    trial.surfaces = surfaces_of_question(question);
    const std::size_t count = question.found->judged.size();
    for (const std::size_t f : trial.surfaces) {
      if (why[f] && out[q].judged.empty()) {
        out[q].judged.assign(count, UncertaintyStatus::none(*why[f]));
      }
    }
    if (!out[q].judged.empty()) continue;
    for (const JudgedValue& judged : question.found->judged) {
      trial.read_mm.push_back(judged.value_mm);
    }
    trial.values = [feature = question.feature, task = question.asked,
                    count](const PartState& part) {
      return judged_values(find(part, feature, *task, Proof::kNone), count);
    };
    places.push_back(q);
    asked.push_back(std::move(trial));
  }
  if (asked.empty()) return out;
  const PartTrials part(std::move(surfaces), reference, options);
  std::vector<TrialAnswer> answers = part.answers(asked);
  for (std::size_t k = 0; k < asked.size(); ++k) {
    PartInterval& interval = out[places[k]];
    interval.conformance_1 = conformance_of(questions[places[k]], answers[k]);
    for (core::Result<UncertaintyResult>& value : answers[k].values) {
      if (!value) {
        interval.judged.push_back(UncertaintyStatus::none(value.error().said()));
        continue;
      }
      if (whole) {
        value->notes.push_back(core::phrase(
            "an interval of the whole surface is computed of unfiltered cylindricity and roundness "
            "alone"));
      }
      interval.judged.push_back(UncertaintyStatus::stated(*std::move(value), options.coverage));
    }
    interval.rows_mm = std::move(answers[k].rows_mm);
  }
  return out;
}

}  // namespace rondure::evaluation
