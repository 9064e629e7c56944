#pragma once

#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "evaluation/factors/study.h"
#include "evaluation/spindle/result.h"
#include "fit/contour/study.h"
#include "fit/wheel/evaluation.h"
#include "fit/wheel/path.h"

namespace rondure::reports {

/// A study of crank pins as JSON, keys in their published order (docs/contour.md): a contour
/// feature in report.json.
/// @param names  One per part.
[[nodiscard]] nlohmann::ordered_json contour_document(const fit::ContourStudy& study,
                                                      const fit::ContourStudyOptions& options,
                                                      std::span<const std::string> names);

/// How f was found: "direct" from the traces of the axes, "indirect" from the main journals.
[[nodiscard]] const char* separation_of(const fit::ContourStudy& study);

/// Conclusions from the stability indices, one sentence each; below 4 parts one sentence that there
/// are too few.
[[nodiscard]] std::vector<core::Phrase> contour_verdicts(const fit::ContourStudy& study);

/// A comparison as JSON (docs/compare.md), always with every combination; a line feed at the end.
[[nodiscard]] std::string comparison_json(const std::string& run_id,
                                          const evaluation::RunComparison& comparison);

/// A separation as report.json has it.
[[nodiscard]] nlohmann::ordered_json separation_json(const evaluation::SpindleResult& facts);

/// A wheel evaluation with its settings and limits, in report.json (docs/wheel.md). A number that is not finite is written as null. Deviations, path
/// and residual form are under "curves", one list per column.
[[nodiscard]] nlohmann::ordered_json wheel_json(const fit::WheelEvaluation& evaluation,
                                                const fit::WheelTask& task);

/// The path as a table: x_mm, f_mm, slope, xc_mm, zc_mm, phi_deg, R_ks, clearance_um; zc is the
/// height that the controller needs (centre or lowest point). Numbers have the shortest form that
/// reads back to the same double.
[[nodiscard]] std::string wheel_path_csv(const fit::WheelPath& path);

/// Settings for the G-code of a path.
struct GcodeOptions {
  double feed_mm_min = 100.0;  ///< Feed along the path, > 0.
  double retract_mm = 5.0;     ///< Height above the highest place of the path, >= 0.
};

/// The path as G-code (ISO 6983): plane XZ (G18), mm (G21), absolute (G90), feed in mm/min (G94), X
/// as radius. The moves go from above to the first place, along the path in straight lines, and up
/// again. Six decimals.
[[nodiscard]] std::string wheel_gcode(const fit::WheelPath& path, const GcodeOptions& options = {});

}  // namespace rondure::reports
