#include "record/journal/internal/contradiction.h"

#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/numbers.h"

namespace rondure::record {

void require_number(std::string_view column, double value) {
  if (core::is_measurable(value)) return;
  if (std::isnan(value)) throw Contradiction(fmt::format("{} is not a number (NaN)", column));
  throw Contradiction(fmt::format("{} holds {:g}, beyond the limit of {:g} for any number", column,
                                  value, core::kGreatestNumber));
}

void require_numbers(std::string_view column, std::initializer_list<double> values) {
  for (const double value : values) require_number(column, value);
}

void require_touch(const Touch& touch) {
  const std::array<std::pair<std::string_view, double>, 9> numbers = {
      {{"touch.tip_x_mm", touch.tip_mm.x()},
       {"touch.tip_y_mm", touch.tip_mm.y()},
       {"touch.tip_z_mm", touch.tip_mm.z()},
       {"touch.approach_x", touch.approach.x()},
       {"touch.approach_y", touch.approach.y()},
       {"touch.approach_z", touch.approach.z()},
       {"touch.temperature_degC", touch.temperature_degC.value_or(0.0)},
       {"touch.time_s", touch.time_s},
       {"touch.scale_temperature_degC", touch.scale_temperature_degC.value_or(0.0)}}};
  for (const auto& [column, value] : numbers) require_number(column, value);
}

}  // namespace rondure::record
