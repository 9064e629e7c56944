#pragma once

#include <optional>

#include "core/error.h"
#include "plans/plan.h"
#include "record/points/points.h"

namespace rondure::plans {

/// How the points of a source are to be read.
[[nodiscard]] record::PointsOptions points_options(const SourcePlan& source);

/// Why the unit of points is in doubt: neither the file nor anybody else states it, and the
/// diameter that they show (of a cylinder, circle or sphere) is more usual in another one. Nothing
/// where there is no doubt.
/// @param file  Its name for the sentence.
[[nodiscard]] std::optional<core::Error> doubtful_unit(record::Shape shape,
                                                       const record::PointTable& table,
                                                       std::string_view file);

}  // namespace rondure::plans
