#include <fmt/format.h>

#include "app/forecast_text.h"
#include "app/terminal.h"
#include "app/verbs.h"
#include "plans/forecast.h"
#include "plans/forecast_picture.h"
#include "record/files.h"

namespace rondure::app {
namespace {

int refuse(const std::vector<core::Error>& problems, const PlanArguments& arguments) {
  complain(problems);
  if (arguments.json) say(problems_json(problems));
  return kBadInput;
}

/// The cloud to draw: the final one of the first feature, or of the one that is named.
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
  const auto stage = drawn_stage(plan, forecast, arguments.feature);
  if (!stage) return core::fail(stage.error());
  return record::write_file(arguments.svg, plans::forecast_picture(plan, **stage));
}

}  // namespace

int plan(const PlanArguments& arguments) {
  const auto read = plans::read_plan(arguments.plan);
  if (!read) return refuse(read.error(), arguments);
  const auto forecast = plans::forecast(*read);
  if (!forecast) return refuse({forecast.error()}, arguments);
  if (!arguments.svg.empty()) {
    if (auto drawn = draw(*read, *forecast, arguments); !drawn) {
      return refuse({drawn.error()}, arguments);
    }
  }
  say(arguments.json ? forecast_json(*read, *forecast) : forecast_table(*read, *forecast));
  return kAllWell;
}

}  // namespace rondure::app
