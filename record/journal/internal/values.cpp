#include "record/journal/internal/values.h"

#include <array>
#include <cmath>
#include <utility>

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

Feature& feature_at(RunRecord& record, int feature, std::string_view table) {
  if (feature < 0 || feature >= static_cast<int>(record.features.size())) {
    throw Contradiction(fmt::format("table {} names feature {}, the journal has {}", table, feature,
                                    record.features.size()));
  }
  return record.features[static_cast<std::size_t>(feature)];
}

void Measured::take(const std::optional<double>& number, const std::string& name) {
  if (number && std::isnan(*number)) throw std::runtime_error(name + " is not a number (NaN)");
  value = number.value_or(0.0);
  given = number ? soci::i_ok : soci::i_null;
}

std::optional<double> Measured::get() const {
  return given == soci::i_ok ? std::optional(value) : std::nullopt;
}

}  // namespace rondure::record
