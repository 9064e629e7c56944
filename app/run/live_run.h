#pragma once

#include <memory>

#include "app/verbs/verbs.h"
#include "core/result.h"
#include "plans/plan.h"
#include "plans/run/runner.h"
#include "web/view.h"

namespace rondure::app {

/// Opens the live page of a run that is asked for (--watch), tells where it is, and lets the run
/// fill it through `options`. The stop button does what Ctrl-C does.
/// @return  None when no page is asked for; kFile when its port cannot be had.
[[nodiscard]] core::Result<std::unique_ptr<web::LiveView>> open_live(const RunArguments& arguments,
                                                                     const plans::Plan& plan,
                                                                     plans::RunOptions& options);

/// The time model of a plan, stage by stage; empty where it does not say.
[[nodiscard]] std::vector<web::PredictedStage> predicted_stages(const plans::Plan& plan);

/// kBadOption for --speed with a machine that is not simulated here: that has its own.
[[nodiscard]] core::Result<void> check_speed(const RunArguments& arguments,
                                             const plans::Plan& plan);

}  // namespace rondure::app
