#include "plans/analyses/contour_columns.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/units.h"
#include "record/csv/series.h"

namespace rondure::plans {
namespace {

using core::Code;
using Quantity = record::ContourColumnTask::Quantity;
using Unit = record::ContourColumnTask::Unit;

bool is_angle(Unit unit) { return unit <= Unit::kMilliRad; }

/// In deg or mm.
double size_of(Unit unit) {
  switch (unit) {
    case Unit::kMilliDeg:
    case Unit::kUm:
      return 1e-3;
    case Unit::kArcSec:
      return 1.0 / 3600.0;
    case Unit::kRad:
      return 1.0 / core::kDegree;
    case Unit::kMilliRad:
      return 1e-3 / core::kDegree;
    case Unit::kNm:
      return 1e-6;
    default:
      return 1.0;
  }
}

/// The unit of a quantity without a column, which its series has too.
Unit unit_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::kDeviation:
    case Quantity::kMainDeviation:
      return Unit::kUm;
    case Quantity::kXError:
    case Quantity::kCommandedX:
    case Quantity::kActualX:
      return Unit::kMm;
    default:
      return Unit::kDeg;
  }
}

/// "c_error_deg"; a main journal has the columns of a pin.
std::string series_name(Quantity quantity) {
  std::string name(name_of(quantity));
  if (name.starts_with("main_")) name = name.substr(5);
  return fmt::format("{}_{}", name, name_of(unit_of(quantity)));
}

const record::ContourColumnTask* column_of(Quantity quantity, ContourColumns columns) {
  const auto found = std::ranges::find(columns, quantity, &record::ContourColumnTask::quantity);
  return found == columns.end() ? nullptr : &*found;
}

std::string name_in_file(Quantity quantity, ContourColumns columns) {
  const auto* const column = column_of(quantity, columns);
  return column == nullptr ? series_name(quantity) : column->in_file;
}

/// The values of each quantity, in the unit of its series; none for one without its column. After
/// them the temperature, where the file has it.
using Values = std::vector<std::optional<std::vector<double>>>;

core::Result<Values> read(std::string_view text, std::string_view name,
                          const std::vector<Quantity>& quantities, ContourColumns columns,
                          bool required) {
  std::vector<std::string> names;
  for (const Quantity quantity : quantities) names.push_back(series_name(quantity));
  std::vector<record::WantedColumn> wanted;
  std::vector<record::ColumnName> in_file;
  for (std::size_t i = 0; i < names.size(); ++i) {
    wanted.push_back({names[i], required});
    // Only a file whose columns are named may have others.
    if (!columns.empty()) in_file.push_back({names[i], name_in_file(quantities[i], columns), true});
  }
  TRY(const auto series, record::parse_series_csv(text, name, wanted, in_file));
  Values out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    auto values = series.column(names[i]);
    const auto* const column = column_of(quantities[i], columns);
    if (values && column != nullptr) {
      const Unit target = unit_of(quantities[i]);
      const double factor =
          column->scale * size_of(column->unit.value_or(target)) / size_of(target);
      for (double& value : *values) value *= factor;
    }
    out.push_back(std::move(values));
  }
  out.push_back(series.column(record::kTemperatureColumn));
  return out;
}

std::string list_of(std::initializer_list<Quantity> quantities, ContourColumns columns) {
  std::string out;
  for (const Quantity one : quantities) {
    out += (out.empty() ? "" : ",") + name_in_file(one, columns);
  }
  return out;
}

using Column = std::optional<std::vector<double>>;

/// A series of those of these columns that are there, and the temperature.
record::Series series_of(std::initializer_list<std::pair<Quantity, const Column*>> columns,
                         const Column& temperature) {
  record::Series out;
  std::vector<const std::vector<double>*> all;
  for (const auto& [quantity, values] : columns) {
    if (!*values) continue;
    out.columns.push_back({series_name(quantity), std::string(name_of(unit_of(quantity)))});
    all.push_back(&**values);
  }
  if (temperature) {
    out.columns.push_back({std::string(record::kTemperatureColumn), "degC"});
    all.push_back(&*temperature);
  }
  for (std::size_t row = 0; row < all.front()->size(); ++row) {
    for (const auto* const values : all) out.values.push_back((*values)[row]);
  }
  return out;
}

}  // namespace

core::Result<void> check_column(const record::ContourColumnTask& column) {
  const std::string_view name = name_of(column.quantity);
  if (column.scale == 0.0) {
    return core::fail_with(Code::kBadOption, "the scale of {} is {}: every value would be the same",
                           name, column.scale);
  }
  const bool angle = is_angle(unit_of(column.quantity));
  if (!column.unit || is_angle(*column.unit) == angle) return {};
  return core::fail_with(Code::kBadOption, "{} has the unit \"{}\", one of {}; it takes {}", name,
                         name_of(*column.unit), angle ? "lengths" : "angles",
                         angle ? "deg, mdeg, arcsec, rad, mrad" : "mm, um, nm");
}

core::Result<ContourTrace> read_trace(std::string_view text, std::string_view name,
                                      ContourColumns columns) {
  const std::vector<Quantity> all = {
      Quantity::kC,          Quantity::kCError,  Quantity::kXError, Quantity::kCommandedC,
      Quantity::kCommandedX, Quantity::kActualC, Quantity::kActualX};
  TRY(const auto found, read(text, name, all, columns, false));
  const auto& [c, c_error, x_error, alpha_cmd, d_cmd, alpha_act, d_act, temperature] =
      std::tie(found[0], found[1], found[2], found[3], found[4], found[5], found[6], found[7]);
  ContourTrace out;
  if (c && c_error && x_error) {
    out.series = series_of({{Quantity::kC, &c},
                            {Quantity::kCError, &c_error},
                            {Quantity::kXError, &x_error},
                            {Quantity::kCommandedX, &d_cmd}},
                           temperature);
    return out;
  }
  if (!(alpha_cmd && d_cmd && alpha_act && d_act)) {
    return core::fail(
        Code::kMissingKey,
        fmt::format("the file needs the columns {} or {}; name others with contour.columns",
                    list_of({Quantity::kC, Quantity::kCError, Quantity::kXError}, columns),
                    list_of({Quantity::kCommandedC, Quantity::kCommandedX, Quantity::kActualC,
                             Quantity::kActualX},
                            columns)),
        fmt::format("{}:1", name));
  }
  Column c_errors = *alpha_act;
  Column x_errors = *d_act;
  for (std::size_t i = 0; i < alpha_cmd->size(); ++i) {
    (*c_errors)[i] = std::remainder((*alpha_act)[i] - (*alpha_cmd)[i], 360.0);
    (*x_errors)[i] -= (*d_cmd)[i];
  }
  out.positions = true;
  out.series = series_of({{Quantity::kC, &alpha_cmd},
                          {Quantity::kCError, &c_errors},
                          {Quantity::kXError, &x_errors},
                          {Quantity::kCommandedX, &d_cmd}},
                         temperature);
  return out;
}

core::Result<record::Series> read_gauge(std::string_view text, std::string_view name, bool main,
                                        ContourColumns columns) {
  const auto named = [&](Quantity of_main, Quantity of_pin) {
    return main && column_of(of_main, columns) != nullptr ? of_main : of_pin;
  };
  const std::vector<Quantity> wanted = {named(Quantity::kMainAngle, Quantity::kAngle),
                                        named(Quantity::kMainDeviation, Quantity::kDeviation)};
  TRY(const auto found, read(text, name, wanted, columns, true));
  return series_of({{Quantity::kAngle, &found[0]}, {Quantity::kDeviation, &found[1]}}, found[2]);
}

}  // namespace rondure::plans
