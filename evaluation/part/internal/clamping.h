#pragma once

#include "core/result.h"
#include "evaluation/results/clamping.h"
#include "evaluation/results/evaluation.h"
#include "record/run_record.h"

// Private to the room: which features may be related to each other.

namespace rondure::evaluation {

/// The frame in which the evaluated cloud of a feature was measured.
[[nodiscard]] Clamping clamping_of(const record::RunRecord& record, int feature);

/// Whether the cloud of a datum feature can be held against that of a toleranced feature: both were
/// measured in one clamping, and both are at 20 degC or both as measured.
/// @return Factor that takes the points of the datum to the temperature to which those of the
///         toleranced feature were corrected: the part has one temperature. kMeaning says what to
///         plan instead.
/// Source: methods, drawing section 3.4.
[[nodiscard]] core::Result<double> related(const FeatureResult& datum, const FeatureResult& to);

}  // namespace rondure::evaluation
