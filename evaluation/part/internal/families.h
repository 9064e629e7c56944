#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "evaluation/part/surface.h"
#include "evaluation/results/clamping.h"
#include "evaluation/results/evaluation.h"
#include "evaluation/results/finding.h"
#include "fit/profiles/generatrix.h"
#include "record/run_record.h"

namespace rondure::evaluation {

// Private to the room: the characteristics by family. Each fills Finding::judged with the limits of
// `asked`, the numbers and the local values; find() adds what the prepared surface knows.

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

// Private to the room: which features may be related to each other.

/// The frame in which the evaluated cloud of a feature was measured.
[[nodiscard]] Clamping clamping_of(const record::RunRecord& record, int feature);

/// Whether the cloud of a datum feature can be held against that of a toleranced feature: both were
/// measured in one clamping, and both are at 20 degC or both as measured.
/// @return Factor that takes the points of the datum to the temperature to which those of the
///         toleranced feature were corrected: the part has one temperature. kMeaning says what to
///         plan instead.
/// Source: methods, drawing section 3.4.
[[nodiscard]] core::Result<double> related(const FeatureResult& datum, const FeatureResult& to);

// Private to the room: what the characteristics about datums have in common.

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
