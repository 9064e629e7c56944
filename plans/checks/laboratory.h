#pragma once

#include "core/result.h"
#include "plans/plan.h"
#include "record/tasks/run.h"

namespace rondure::plans {

/// The laboratory that the file `reports.laboratory` of a plan names; without one an empty head.
///
/// @return  kFile for a file or a logo that cannot be read, a logo of more than 256 KiB or 4000
///          pixels a side, or one that is no whole PNG or JPEG; kSyntax, or the code of the first
///          key that is wrong. `where` is always /reports/laboratory.
[[nodiscard]] core::Result<record::HeadSettings> laboratory_of(const Plan& plan);

}  // namespace rondure::plans
