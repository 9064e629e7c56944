#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "evaluation/part/surface.h"
#include "evaluation/results/finding.h"

// Private to the room: what the characteristics about datums have in common.

namespace rondure::evaluation {

/// Starts the finding of a characteristic about datums: the words of the operator, length and
/// distance of the datum, the warning of one that rocks.
/// @param datum  The one that counts.
[[nodiscard]] Finding found_about(const PreparedSurface& surface,
                                  std::span<const DatumResult> datums, const DatumResult& datum);

/// The datum that is an axis, or an error that says what to name.
[[nodiscard]] core::Result<DatumResult> datum_axis_of(std::span<const DatumResult> datums,
                                                      const record::Characteristic& asked);

/// Number of sections of a surface; the passes of a layer are one.
[[nodiscard]] std::size_t layers_in(std::span<const SurfaceSection> sections);

/// Adds the rows at which a measure of the points is greatest and least, in this order.
void add_extreme_rows(const PreparedSurface& surface, const std::vector<double>& measure,
                      Finding& finding);

}  // namespace rondure::evaluation
