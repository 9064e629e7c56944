#pragma once

#include <string>

#include "fit/wheel/evaluation.h"

namespace rondure::app {

/// A wheel evaluation as a table.
[[nodiscard]] std::string wheel_table(const fit::WheelEvaluation& evaluation,
                                      const fit::WheelTask& task);

}  // namespace rondure::app
