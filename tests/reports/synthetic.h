#pragma once

#include <string>
#include <vector>

#include "evaluation/results/evaluation.h"
#include "record/run_record.h"

namespace rondure::reports {

/// A record with an evaluation made by hand: plausible numbers for the writers, without a fit.
struct Case {
  record::RunRecord record;
  evaluation::Evaluation evaluation;
};

/// A simulated outside cylinder, axis along z, zone 8.3 um wide, three outer and three inner
/// contacts; `poses` poses whose f falls towards the last, final one.
[[nodiscard]] Case cylinder_case(int layers, int points_per_layer, int poses);

/// The same as cylinder_case(4, 7, 3), 2.3 um above its limit, with warnings.
[[nodiscard]] Case failing_case();

/// A circle of 500 points from a file: no poses, no tip, no temperature.
[[nodiscard]] Case circle_case(int points);

/// A cylinder of `points` points on a spiral from a file: layers unknown.
[[nodiscard]] Case spiral_case(int points);

/// A run that ended at a machine fault before its second feature.
[[nodiscard]] Case unfinished_case();

/// cylinder_case(4, 7, 3) whose every text is `text`.
[[nodiscard]] Case hostile_case(const std::string& text);

/// A journal, land-A, and a face, face-B, of which a drawing asks an envelope size, a mean size in
/// sections, run-out about the common datum of both, perpendicularity and flatness.
[[nodiscard]] Case drawing_case();

/// The HTML report of a case.
[[nodiscard]] std::string page_of(const Case& made);

}  // namespace rondure::reports
