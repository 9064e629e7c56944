#pragma once

#include <cstddef>
#include <span>

#include "core/result.h"
#include "evaluation/part/surface.h"
#include "evaluation/results/finding.h"
#include "record/run_record.h"

// Private to the room: the characteristics by family. Each fills Finding::judged with the limits of
// `asked`, the numbers and the local values; find() adds what the prepared surface knows.

namespace rondure::evaluation {

/// diameter.
[[nodiscard]] core::Result<Finding> find_size(const PreparedSurface& surface,
                                              const record::Characteristic& asked, Proof proof);
/// cylindricity, roundness, flatness as t, p, v, q about any reference.
[[nodiscard]] core::Result<Finding> find_form(const PreparedSurface& surface,
                                              const record::Characteristic& asked, Proof proof);
/// straightness, taper, generatrix-parallelism.
[[nodiscard]] core::Result<Finding> find_straightness(const PreparedSurface& surface,
                                                      const record::Characteristic& asked,
                                                      Proof proof);

/// The datums of a characteristic, in their order.
/// @param part   As in find(); windows of the datum features are left out, nothing is filtered.
/// @param proof  kNone: without the equalised one and the play beside a one-sided datum.
[[nodiscard]] core::Result<std::vector<DatumResult>> datums_of(
    std::span<const MeasuredSurface> part, std::size_t feature, const record::Characteristic& asked,
    Proof proof);

/// coaxiality, concentricity, parallelism, perpendicularity, angularity about the given datums.
[[nodiscard]] core::Result<Finding> find_location(const PreparedSurface& surface,
                                                  const record::Characteristic& asked,
                                                  std::span<const DatumResult> datums);
/// run-out and total-run-out, radial, axial, conical.
[[nodiscard]] core::Result<Finding> find_run_out(const PreparedSurface& surface,
                                                 const record::Characteristic& asked,
                                                 std::span<const DatumResult> datums);

/// The limits of a characteristic, for a value that is held against both.
[[nodiscard]] inline Limits limits_of(const record::Characteristic& asked) {
  return {.lower_mm = asked.lower_mm, .upper_mm = asked.tolerance_mm};
}

}  // namespace rondure::evaluation
