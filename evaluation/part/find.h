#pragma once

#include <cstddef>
#include <span>

#include "core/result.h"
#include "evaluation/part/part_state.h"
#include "evaluation/part/surface.h"
#include "evaluation/results/finding.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// Whether find() computes a characteristic. The others are values of analyses, masks of harmonics
/// and unfiltered peak-to-valley form without a window, whose certificates the evaluation of the
/// feature holds.
[[nodiscard]] bool is_found(const record::Feature& feature, const record::Characteristic& asked);

/// Computes what a drawing asks of a feature, from the touched points of the whole part. Pure: the
/// same function computes the value as read and every trial of its uncertainty.
/// @param part     Surfaces of all features: a datum may be any of them.
/// @param feature  Index of the toleranced feature.
/// @return Or why there is no value: `code` as section 11 of the specification, `what` says what to
///         plan instead.
/// Source: methods, drawing.
[[nodiscard]] core::Result<Finding> find(std::span<const MeasuredSurface> part, std::size_t feature,
                                         const record::Characteristic& asked,
                                         Proof proof = Proof::kFull);
/// The same of a state of the part, which keeps what further characteristics can use.
[[nodiscard]] core::Result<Finding> find(const PartState& part, std::size_t feature,
                                         const record::Characteristic& asked,
                                         Proof proof = Proof::kFull);

}  // namespace rondure::evaluation
