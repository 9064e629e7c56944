#pragma once

#include "core/result.h"
#include "plans/run/internal/run_context.h"

namespace rondure::plans {

/// Finds where a part without a fixture stands, as `part.system` or `part.alignment` of the plan
/// asks, journals it, and sets the base of the cell accordingly; does nothing without these keys.
///
/// "control": the tip goes around the reference sphere and is read in the part system of the
/// control and in that of the machine; both lists of points give the frame, whatever the control
/// means by its transformation. "alignment": a face shows the height, then two sections of a
/// cylinder show the axis; the turn about it stays that of the plan.
///
/// @return  kMachine when the two systems do not differ by a rigid motion, or the control has no
///          part system; kUnreachable when the park height does not clear the part where it was
///          found; the errors of touches. The tip is at park height, except after a collision.
[[nodiscard]] core::Result<void> find_part_place(RunContext& context);

}  // namespace rondure::plans
