#pragma once

#include <memory>

#include "app/run/arguments.h"
#include "core/result.h"
#include "plans/plan.h"
#include "plans/run/runner.h"
#include "web/view.h"

namespace rondure::app {

/// Opens the live page of a run (--watch), prints its address, and connects it to the run through
/// `options`. The stop button acts as Ctrl-C.
/// @return  Null when no page is requested; kFile when its port is not available.
[[nodiscard]] core::Result<std::unique_ptr<web::LiveView>> open_live(const RunArguments& arguments,
                                                                     const plans::Plan& plan,
                                                                     plans::RunOptions& options);

/// The predicted times of a plan, stage by stage; empty when it has no forecast.
[[nodiscard]] std::vector<web::PredictedStage> predicted_stages(const plans::Plan& plan);

/// kBadOption for --speed with a machine that is not simulated here and has its own speed.
[[nodiscard]] core::Result<void> check_speed(const RunArguments& arguments,
                                             const plans::Plan& plan);

}  // namespace rondure::app
