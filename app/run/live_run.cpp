#include "app/run/live_run.h"

#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "app/text/terminal.h"
#include "core/numbers.h"
#include "plans/forecast/forecast.h"
#include "reports/words/language.h"

namespace rondure::app {

std::vector<web::PredictedStage> predicted_stages(const plans::Plan& plan) {
  std::vector<web::PredictedStage> out;
  const auto forecast = plans::forecast(plan);
  if (!forecast) return out;  // the run says why
  for (const plans::ForecastStage& stage : forecast->stages) {
    out.push_back({stage.touches * stage.times, stage.time_s});
  }
  return out;
}

core::Result<std::unique_ptr<web::LiveView>> open_live(const RunArguments& arguments,
                                                       const plans::Plan& plan,
                                                       plans::RunOptions& options) {
  if (arguments.watch.empty()) return std::unique_ptr<web::LiveView>();
  web::LiveOptions live;
  if (arguments.watch != "auto")
    live.port = static_cast<std::uint16_t>(core::parse_number(arguments.watch).value_or(0.0));
  live.control = arguments.control;
  live.stages = predicted_stages(plan);
  live.stop = request_stop;
  live.language = reports::language_named(arguments.language).value_or(reports::Language::kEnglish);
  auto record = std::make_shared<record::GrowingRecord>();
  auto view = web::LiveView::start(std::move(live), record);
  if (!view) return core::fail(view.error());
  options.followed_by = std::move(record);
  tell(fmt::format("rondure: live page at {} ({})\n", (*view)->url(),
                   arguments.control ? "with a stop button; keep the address to yourself"
                                     : "read-only; --control adds a stop button"));
  return std::move(*view);
}

core::Result<void> check_speed(const RunArguments& arguments, const plans::Plan& plan) {
  if (!arguments.speed || !plan.machine || plan.machine->driver == "simulated") return {};
  return core::fail(core::Code::kBadOption,
                    fmt::format("--speed is for a machine that is simulated here, this one is "
                                "\"{}\" and has its own",
                                plan.machine->driver),
                    "/machine/driver");
}

}  // namespace rondure::app
