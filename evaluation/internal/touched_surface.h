#pragma once

#include <optional>

#include "evaluation/results/evaluation.h"
#include "fit/least_squares/probe_tip.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// The qualification of the tip; none without touches of a reference artefact, or where they
/// determine no tip.
[[nodiscard]] std::optional<fit::ProbeTip> evaluate_probe(const record::RunRecord& record);

/// The start of the evaluation of a surface: cloud, tip, temperatures and windows, and of a circle
/// its plane. Nothing is fitted; this takes as long as reading the touches.
/// @param index  Of a surface that is not merged from several poses.
/// @return  `failure` of the result says why there is no cloud.
[[nodiscard]] FeatureResult touched_surface(const record::RunRecord& record, int index,
                                            const std::optional<fit::ProbeTip>& probe);

}  // namespace rondure::evaluation
