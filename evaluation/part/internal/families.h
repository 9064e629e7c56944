#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/result.h"
#include "evaluation/part/surface.h"
#include "evaluation/results/finding.h"
#include "fit/profiles/generatrix.h"
#include "record/run_record.h"

// Private to the room: the characteristics by family. Each fills Finding::judged with the limits of
// `asked`, the numbers and the local values; find() adds what the prepared surface knows.

namespace rondure::evaluation {

class PartState;

/// diameter.
[[nodiscard]] core::Result<Finding> find_size(const PreparedSurface& surface,
                                              const record::Characteristic& asked, Proof proof);
/// cylindricity, roundness, flatness as t, p, v, q about any reference.
[[nodiscard]] core::Result<Finding> find_form(const PreparedSurface& surface,
                                              const record::Characteristic& asked, Proof proof);
/// A generatrix with the points of the surface that it consists of; empty of a series.
struct TouchedLine {
  fit::Generatrix line;
  std::vector<std::size_t> points;
};
/// The generatrices of a surface, once they were found.
struct SharedLines {
  std::optional<std::vector<TouchedLine>> found;
};
/// straightness, taper, generatrix-parallelism.
/// @param shared  Of the same surface; filled where it is empty.
[[nodiscard]] core::Result<Finding> find_straightness(const PreparedSurface& surface,
                                                      const record::Characteristic& asked,
                                                      Proof proof, SharedLines& shared);
[[nodiscard]] inline core::Result<Finding> find_straightness(const PreparedSurface& surface,
                                                             const record::Characteristic& asked,
                                                             Proof proof) {
  SharedLines own;
  return find_straightness(surface, asked, proof, own);
}

/// The datums of a characteristic, in their order.
/// @param part   As in find(); windows of the datum features are left out, nothing is filtered.
/// @param proof  kNone: without the equalised one and the play beside a one-sided datum.
[[nodiscard]] core::Result<std::vector<DatumResult>> datums_of(const PartState& part,
                                                               std::size_t feature,
                                                               const record::Characteristic& asked,
                                                               Proof proof);
/// Whether a characteristic needs a place, an axis; the others need a direction only.
[[nodiscard]] bool needs_datum_axis(record::Form form);

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
