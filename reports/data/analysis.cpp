#include <cmath>
#include <optional>

#include "core/units.h"
#include "evaluation/analysis_result.h"
#include "reports/data/analyses.h"
#include "reports/data/internal/json_parts.h"
#include "reports/words/internal/messages.h"

namespace rondure::reports {
namespace {

/// A number beside the characteristics, with its interval or why there is none.
Json number_json(const evaluation::ContourNumber& number, const std::vector<std::string>& names) {
  const bool length = number.kind != evaluation::ContourNumber::Kind::kIndex;
  const auto in_unit = [&](double value) { return length ? in_um(value) : value; };
  Json out = {{"name", number.name()},
              {"part", number.part ? Json(names[*number.part]) : Json(nullptr)},
              {"unit", length ? "um" : "1"},
              {"as_measured", in_unit(number.as_measured)}};
  const auto& found = number.uncertainty.result();
  if (!found) {
    out["why_no_interval"] = number.uncertainty.why().english();
    return out;
  }
  out["estimate"] = in_unit(found->sampled.estimate_mm);
  out["low"] = in_unit(found->sampled.low_mm);
  out["high"] = in_unit(found->sampled.high_mm);
  out["standard_uncertainty"] = in_unit(found->sampled.standard_uncertainty_mm);
  out["at_most"] = found->sampled.at_most;
  out["notes"] = list_json(found->notes, [](const core::Phrase& note) { return note.english(); });
  return out;
}

Json found_json(const evaluation::ContourResult& facts) {
  auto out = contour_document(facts.study, facts.options, facts.names);
  out.erase("warnings");  // written beside the analysis, as for every feature
  auto curves = Json::array();
  const auto um_of = [](double value) { return value / core::kMicrometre; };
  for (const fit::ContourPartResult& part : facts.study.parts) {
    curves.push_back({{"total_um", list_json(part.pin.contour.error_mm, um_of)},
                      {"following_um", list_json(part.following.error_mm, um_of)},
                      {"rest_um", list_json(part.direct.rest_mm, um_of)}});
  }
  out["numbers"] = list_json(facts.numbers, [&](const evaluation::ContourNumber& number) {
    return number_json(number, facts.names);
  });
  out["curves"] = std::move(curves);
  out["gain"] = nullptr;
  if (const auto& gain = facts.gain) {
    out["gain"] = {{"with", gain->with},
                   {"before_um", um_of(gain->before_mm)},
                   {"after_um", um_of(fit::peak_to_valley(fit::mean_following(facts.study)))}};
  }
  return out;
}

Json found_json(const evaluation::SpindleResult& found) { return separation_json(found); }
Json found_json(const evaluation::WheelResult& found) {
  Json out = wheel_json(found.evaluation, found.task);
  const auto* radius = found.effective_radius.about(evaluation::Measurand::kSampledPoints);
  if (radius != nullptr) {
    out["effective_radius_interval"] = {{"estimate_mm", radius->estimate_mm},
                                        {"low_mm", radius->low_mm},
                                        {"high_mm", radius->high_mm}};
    // Where points may be missing, the edge may reach farther out than the interval says.
    const auto& runout = found.evaluation.wheel.runout;
    out["effective_radius_interval"]["at_least"] = runout && !runout->bound_because.empty();
  } else if (!found.effective_radius.why().empty()) {
    out["effective_radius_no_interval"] = found.effective_radius.why();
  }
  return out;
}
Json found_json(const evaluation::RotaryResult& found) { return rotary_json(found); }
Json found_json(const evaluation::FiveAxisResult& found) { return five_axis_json(found); }

/// The result under the name of its shape. Curves (one number per sample) are written under the key
/// "curves", which the stored results omit.
Json found_json(const evaluation::AnalysisResult& result) {
  return std::visit([](const auto& found) { return found_json(found); }, result.found);
}

/// A number that is not finite, as one that could not be computed, is null.
Json finite_json(const std::optional<double>& number) {
  return number && std::isfinite(*number) ? Json(*number) : Json(nullptr);
}

Json gate_json(const evaluation::Gate& gate) {
  return {{"code", gate.code},
          {"condition", gate.condition.english()},
          {"found", finite_json(gate.found)},
          {"limit", finite_json(gate.limit)},
          {"unit", gate.unit},
          {"outcome", name_of(gate.outcome)},
          {"reason", gate.reason.english()}};
}

}  // namespace

Json gates_json(const std::vector<evaluation::Gate>& gates) { return list_json(gates, gate_json); }

Json analysis_json(const evaluation::FeatureResult& feature) {
  const record::Feature& asked = feature.feature;
  Json json;
  json["id"] = asked.id;
  json["shape"] = record::name_of(asked.shape);
  json["side"] = record::name_of(asked.side);
  json["data_file"] = asked.points_file;
  json["data_sha256"] = asked.points_sha256;
  json["characteristics"] = characteristics_json(feature);
  json["gates"] = gates_json(feature.gates);
  json[std::string(record::name_of(asked.shape))] =
      feature.analysis ? found_json(*feature.analysis) : Json(nullptr);
  json["warnings"] = list_json(feature.warnings, error_json);
  json["failure"] = optional_json(feature.failure);
  return json;
}

}  // namespace rondure::reports
