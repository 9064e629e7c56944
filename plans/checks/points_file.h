#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "core/error.h"
#include "core/result.h"
#include "plans/plan.h"
#include "record/points/points.h"

namespace rondure::plans {

/// Reads the points file of a feature as its plan says. `read` names the rows that it leaves out.
/// @param bytes  Of the file.
[[nodiscard]] core::Result<record::PointTable> points_of(const Plan& plan, std::size_t index,
                                                         std::string_view bytes);

/// Why the unit of points is in doubt: neither the file nor anybody else states it, and the
/// diameter that they show (of a cylinder, circle or sphere) is more usual in another one. Nothing
/// where there is no doubt.
/// @param file  Its name for the sentence.
[[nodiscard]] std::optional<core::Error> doubtful_unit(record::Shape shape,
                                                       const record::PointTable& table,
                                                       std::string_view file);

}  // namespace rondure::plans
