#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/prediction/prediction.h"
#include "app/prediction/sampling_search.h"
#include "app/text/answer.h"
#include "app/text/forecast.h"
#include "app/text/prediction.h"
#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "core/numbers.h"
#include "core/result.h"
#include "plans/checks/doubts.h"
#include "plans/forecast/forecast.h"
#include "plans/forecast/picture.h"
#include "record/files.h"

namespace rondure::app {
namespace {

/// The text without blanks at either end.
std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// Parses a length with its unit, as "1um", "0.5 um", "2e-3mm", "800nm", to mm.
/// @return  kBadOption: no unit, an unknown unit, no number, or not above 0; names the expected
///          form.
core::Result<double> length_from(std::string_view word) {
  const auto refuse = [&](const char* why) {
    return core::fail_with(core::Code::kBadOption,
                           "\"{}\" {}; write a length as 1um, 0.001mm or 1000nm", word, why);
  };
  constexpr std::array<std::pair<std::string_view, double>, 3> kLengthUnits = {
      {{"um", 1e-3}, {"mm", 1.0}, {"nm", 1e-6}}};
  const std::string_view text = trimmed(word);
  if (core::parse_number(text)) return refuse("has no unit");
  for (const auto& [unit, unit_mm] : kLengthUnits) {
    if (!text.ends_with(unit)) continue;
    const auto number = core::parse_number(trimmed(text.substr(0, text.size() - unit.size())));
    if (!number) return refuse("is no number with a unit");
    const double length_mm = *number * unit_mm;
    if (!(length_mm > 0.0) || !std::isfinite(length_mm)) return refuse("is not above 0");
    return length_mm;
  }
  return refuse("is no length in um, mm or nm");
}

int refuse_plan(const std::vector<core::Error>& problems, const PlanArguments& arguments) {
  const int status = refuse(problems);
  if (arguments.json) say(problems_json(problems));
  return status;
}

/// The cloud to draw: the final one of the first or of the named feature.
core::Result<const plans::ForecastStage*> drawn_stage(const plans::Plan& plan,
                                                      const plans::Forecast& forecast,
                                                      const std::string& feature) {
  for (const plans::ForecastStage& stage : forecast.stages) {
    if (!stage.final_cloud) continue;
    const std::string& id = plan.features[static_cast<std::size_t>(stage.feature)].id;
    if (feature.empty() || feature == id) return &stage;
  }
  return core::fail(core::Code::kBadOption,
                    feature.empty() ? std::string("nothing is touched, so there is no picture")
                                    : fmt::format("no touched feature has the id {}", feature));
}

core::Result<void> draw(const plans::Plan& plan, const plans::Forecast& forecast,
                        const PlanArguments& arguments) {
  std::error_code ignored;  // a picture that does not exist yet cannot be the plan
  if (std::filesystem::equivalent(arguments.svg, arguments.plan, ignored)) {
    return core::fail_with(core::Code::kBadOption, "--svg {} is the plan itself; name another file",
                           arguments.svg);
  }
  TRY(const auto stage, drawn_stage(plan, forecast, arguments.feature));
  return record::write_file(arguments.svg, plans::forecast_picture(plan, *stage));
}

/// Results in addition to the forecast.
struct Outlook {
  std::vector<PredictedCharacteristic> predicted;
  std::optional<double> target_mm;
  std::vector<SamplingSearch> searches;
};

core::Result<Outlook> look_ahead(const plans::Plan& plan, const plans::Forecast& forecast,
                                 std::optional<double> target_mm) {
  Outlook out;
  out.target_mm = target_mm;
  TRY(out.predicted, predict_plan(plan, forecast));
  if (!target_mm) return out;
  TRY(out.searches, search_samplings(plan, *target_mm));
  return out;
}

nlohmann::ordered_json document_of(const plans::Plan& plan, const plans::Forecast& forecast,
                                   const Outlook& outlook) {
  nlohmann::ordered_json out = forecast_json(plan, forecast);
  out["prediction"] = prediction_json(plan, outlook.predicted);
  if (outlook.target_mm) out["target"] = search_json(plan, outlook.searches, *outlook.target_mm);
  return out;
}

void print(const plans::Plan& plan, const plans::Forecast& forecast, const Outlook& outlook) {
  say(forecast_table(plan, forecast));
  say(prediction_table(plan, outlook.predicted));
  if (outlook.target_mm) say(search_table(plan, outlook.searches, *outlook.target_mm));
}

/// Whether every touched feature has a sampling that meets the target.
bool target_met(const Outlook& outlook) {
  if (!outlook.target_mm) return true;
  return !outlook.searches.empty() &&
         std::all_of(outlook.searches.begin(), outlook.searches.end(),
                     [](const SamplingSearch& of) { return of.best.has_value(); });
}

}  // namespace

int plan(const PlanArguments& arguments) {
  std::optional<double> target_mm;
  if (arguments.target_expanded) {
    const auto length = length_from(*arguments.target_expanded);
    if (!length) return refuse_plan({core::Error(length.error()).at("--target-U")}, arguments);
    target_mm = *length;
  }
  const auto read = plans::read_plan(arguments.plan);
  if (!read) return refuse_plan(read.error(), arguments);
  const auto forecast = plans::forecast(*read);
  if (!forecast) return refuse_plan({forecast.error()}, arguments);
  if (!arguments.svg.empty()) {
    if (auto drawn = draw(*read, *forecast, arguments); !drawn) {
      return refuse_plan({drawn.error()}, arguments);
    }
  }
  const auto outlook = look_ahead(*read, *forecast, target_mm);
  if (!outlook) return refuse_plan({outlook.error()}, arguments);
  const auto document = document_of(*read, *forecast, *outlook);
  if (auto finite = check_finite(document); !finite)
    return refuse_plan({finite.error()}, arguments);
  if (arguments.json) {
    say(document.dump(2) + "\n");
  } else {
    print(*read, *forecast, *outlook);
    tell_doubts(plans::doubts_of(*read));
  }
  return target_met(*outlook) ? kAllWell : kBadInput;
}

}  // namespace rondure::app
