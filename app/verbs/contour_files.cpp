#include "app/verbs/contour_files.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/units.h"
#include "plans/schema/json_text.h"
#include "record/csv/series.h"
#include "record/files.h"

namespace rondure::app {
namespace {

using core::Code;

/// A unit by its name: its size in rad or mm.
struct Unit {
  std::string_view name;
  bool angle;
  double size;
};
constexpr std::array kUnits = {Unit{"deg", true, core::kDegree},
                               Unit{"mdeg", true, 1e-3 * core::kDegree},
                               Unit{"arcsec", true, core::kDegree / 3600},
                               Unit{"rad", true, 1.0},
                               Unit{"mrad", true, 1e-3},
                               Unit{"mm", false, 1.0},
                               Unit{"um", false, core::kMicrometre},
                               Unit{"nm", false, 1e-6}};

/// A quantity of `fit contour`, with its default column; the name of that column carries its unit.
struct ContourQuantity {
  std::string_view name;
  std::string_view column;
};
constexpr std::array kQuantities = {
    ContourQuantity{"c", "c_deg"},
    ContourQuantity{"c_error", "c_error_deg"},
    ContourQuantity{"x_error", "x_error_mm"},
    ContourQuantity{"alpha_cmd", "alpha_cmd_deg"},
    ContourQuantity{"alpha_act", "alpha_act_deg"},
    ContourQuantity{"d_cmd", "d_cmd_mm"},
    ContourQuantity{"d_act", "d_act_mm"},
    ContourQuantity{"angle", "angle_deg"},
    ContourQuantity{"deviation", "deviation_um"},
    ContourQuantity{"main_angle", "angle_deg"},
    ContourQuantity{"main_deviation", "deviation_um"},
};

const Unit* unit_named(std::string_view name) {
  const auto found = std::find_if(kUnits.begin(), kUnits.end(),
                                  [&](const Unit& unit) { return unit.name == name; });
  return found == kUnits.end() ? nullptr : &*found;
}

const ContourQuantity* quantity_named(std::string_view name) {
  const auto found = std::find_if(kQuantities.begin(), kQuantities.end(),
                                  [&](const ContourQuantity& q) { return q.name == name; });
  return found == kQuantities.end() ? nullptr : &*found;
}

/// The unit of a quantity without a mapping: the end of its column's name.
const Unit& unit_of(const ContourQuantity& quantity) {
  const Unit* const found = unit_named(quantity.column.substr(quantity.column.rfind('_') + 1));
  assert(found != nullptr);
  return *found;
}

/// Column of a quantity in a file, and its conversion.
struct ContourReading {
  std::string column;
  double factor = 1.0;  ///< Factor to rad or mm, signed.
};

ContourReading reading_of(const ContourQuantity& quantity,
                          const std::vector<ContourColumn>& mapping) {
  ContourReading out{std::string(quantity.column), unit_of(quantity).size};
  for (const ContourColumn& column : mapping) {
    if (column.quantity != quantity.name) continue;
    out.column = column.column;
    out.factor =
        column.sign * (column.unit.empty() ? unit_of(quantity) : *unit_named(column.unit)).size;
  }
  return out;
}

/// The quantities in a file, in rad and mm; none for one without its column.
using Columns = std::vector<std::optional<std::vector<double>>>;

core::Result<Columns> read_columns(const std::string& file,
                                   const std::vector<ContourQuantity>& quantities,
                                   const std::vector<ContourColumn>& mapping, bool required) {
  TRY(const auto bytes, record::read_file(file, record::kMostPointsBytes));
  std::vector<record::WantedColumn> wanted;
  std::vector<record::ColumnName> names;
  for (const ContourQuantity& quantity : quantities) {
    wanted.push_back({quantity.column, required});
    names.push_back({std::string(quantity.column), reading_of(quantity, mapping).column});
  }
  const std::string name = std::filesystem::path(file).filename().string();
  TRY(const auto series, record::parse_series_csv(bytes, name, wanted, names));
  Columns out;
  for (const ContourQuantity& quantity : quantities) {
    auto values = series.column(quantity.column);
    if (values) {
      const double factor = reading_of(quantity, mapping).factor;
      for (double& v : *values) v *= factor;
    }
    out.push_back(std::move(values));
  }
  return out;
}

std::vector<ContourQuantity> quantities(std::initializer_list<std::string_view> names) {
  std::vector<ContourQuantity> out;
  for (const std::string_view name : names) out.push_back(*quantity_named(name));
  return out;
}

std::string column_list(const std::vector<ContourQuantity>& list,
                        const std::vector<ContourColumn>& mapping) {
  std::string out;
  for (const ContourQuantity& one : list) {
    out += fmt::format("{}{}", out.empty() ? "" : ",", reading_of(one, mapping).column);
  }
  return out;
}

core::Result<void> read_axes(const std::string& file, const std::vector<ContourColumn>& mapping,
                             ContourImport& out) {
  const auto errors = quantities({"c", "c_error", "x_error"});
  const auto places = quantities({"alpha_cmd", "d_cmd", "alpha_act", "d_act"});
  std::vector<ContourQuantity> all = errors;
  all.insert(all.end(), places.begin(), places.end());
  TRY(auto columns, read_columns(file, all, mapping, false));
  Columns& c = columns;
  fit::AxisTrace& trace = out.part.trace;
  if (c[0] && c[1] && c[2]) {
    trace = {*std::move(c[0]), *std::move(c[1]), *std::move(c[2]), {}};
    if (c[4]) trace.x_mm = *std::move(c[4]);
    return {};
  }
  if (!(c[3] && c[4] && c[5] && c[6])) {
    return core::fail(Code::kMissingKey,
                      fmt::format("the file needs the columns {} or {}; name others with --column "
                                  "or --mapping",
                                  column_list(errors, mapping), column_list(places, mapping)),
                      std::filesystem::path(file).filename().string() + ":1");
  }
  out.positions = true;
  trace.c_rad = *c[3];
  trace.x_mm = *c[4];
  for (std::size_t i = 0; i < c[3]->size(); ++i) {
    trace.c_error_rad.push_back(std::remainder((*c[5])[i] - (*c[3])[i], core::kTwoPi));
    trace.x_error_mm.push_back((*c[6])[i] - (*c[4])[i]);
  }
  return {};
}

core::Result<fit::GaugeRows> read_gauge(const std::string& file, bool main,
                                        const std::vector<ContourColumn>& mapping) {
  auto wanted = quantities({"angle", "deviation"});
  // A main journal has its own columns only where they are named.
  const auto of_main = quantities({"main_angle", "main_deviation"});
  for (std::size_t i = 0; i < 2; ++i) {
    const bool named = std::any_of(mapping.begin(), mapping.end(), [&](const auto& column) {
      return column.quantity == of_main[i].name;
    });
    if (main && named) wanted[i] = of_main[i];
  }
  TRY(auto columns, read_columns(file, wanted, mapping, true));
  return fit::GaugeRows{*std::move(columns[0]), *std::move(columns[1])};
}

template <class List>
std::string names_of(const List& list) {
  std::string out;
  for (const auto& one : list) out += fmt::format("{}{}", out.empty() ? "" : ", ", one.name);
  return out;
}

/// Checks that quantity, unit and sign exist and fit each other.
core::Result<void> check(const ContourColumn& column) {
  const ContourQuantity* const quantity = quantity_named(column.quantity);
  if (quantity == nullptr) {
    return core::fail_with(Code::kBadOption, "there is no quantity \"{}\"; they are {}",
                           column.quantity, names_of(kQuantities));
  }
  if (column.column.empty()) {
    return core::fail_with(Code::kBadOption, "the column of {} has no name", column.quantity);
  }
  if (column.sign != 1.0 && column.sign != -1.0) {
    return core::fail_with(Code::kBadOption, "the sign of {} is {}; it is 1 or -1", column.quantity,
                           column.sign);
  }
  if (column.unit.empty()) return {};
  const Unit* const unit = unit_named(column.unit);
  if (unit != nullptr && unit->angle == unit_of(*quantity).angle) return {};
  return core::fail_with(
      Code::kBadOption, "{} has the unit \"{}\"; it is {} (of {})", column.quantity, column.unit,
      unit == nullptr ? "none that is known" : (unit->angle ? "one of angles" : "one of lengths"),
      names_of(kUnits));
}

core::Result<ContourColumn> column_of(const plans::JsonMember& member, const std::string& file) {
  const std::string place =
      fmt::format("{}#{}", file, plans::member_pointer("/columns", member.key));
  ContourColumn out;
  out.quantity = member.key;
  if (member.value.kind != plans::JsonValue::Kind::kObject) {
    return core::fail(Code::kWrongType,
                      fmt::format("found {}; an object with column, unit and sign is expected",
                                  plans::found(member.value)),
                      place);
  }
  for (const plans::JsonMember& entry : member.value.members) {
    using Kind = plans::JsonValue::Kind;
    const bool text = entry.key == "column" || entry.key == "unit";
    if (!text && entry.key != "sign") {
      return core::fail(Code::kUnknownKey, "the keys are column, unit and sign",
                        place + "/" + entry.key);
    }
    if (entry.value.kind != (text ? Kind::kText : Kind::kNumber)) {
      return core::fail(Code::kWrongType,
                        fmt::format("found {}; {} is expected", plans::found(entry.value),
                                    text ? "a text" : "1 or -1"),
                        place + "/" + entry.key);
    }
    if (entry.key == "column") out.column = entry.value.text;
    if (entry.key == "unit") out.unit = entry.value.text;
    if (entry.key == "sign") out.sign = entry.value.number;
  }
  if (auto checked = check(out); !checked) return core::fail(checked.error().at(place));
  return out;
}

}  // namespace

core::Result<ContourImport> read_contour_part(const ContourFiles& files,
                                              const std::vector<ContourColumn>& mapping) {
  ContourImport out;
  TRY_DO(read_axes(files.axes, mapping, out));
  TRY(out.part.pin, read_gauge(files.pin, false, mapping));
  if (files.main.empty()) return out;
  TRY(out.part.main, read_gauge(files.main, true, mapping));
  return out;
}

core::Result<ContourColumn> parse_contour_column(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) {
    return core::fail_with(
        Code::kBadOption,
        "--column {}: quantity=column[:unit[:sign]] is expected, e.g. x_error=X_FOLLOW:um:-1",
        text);
  }
  ContourColumn out;
  out.quantity = text.substr(0, equals);
  std::string_view rest = text.substr(equals + 1);
  const auto next = [&] {
    const std::size_t colon = std::min(rest.find(':'), rest.size());
    const std::string_view field = rest.substr(0, colon);
    rest.remove_prefix(std::min(colon + 1, rest.size()));
    return std::string(field);
  };
  out.column = next();
  out.unit = next();
  if (!rest.empty()) out.sign = core::parse_number(next()).value_or(0.0);
  if (auto checked = check(out); !checked) {
    return core::fail(checked.error().at(fmt::format("--column {}", text)));
  }
  return out;
}

core::Result<std::vector<ContourColumn>> read_contour_mapping(const std::string& file) {
  TRY(const auto bytes, record::read_file(file));
  const std::string name = std::filesystem::path(file).filename().string();
  TRY(const auto json, plans::parse_json(bytes, name));
  const plans::JsonValue* const columns = json.find("columns");
  if (columns == nullptr || columns->kind != plans::JsonValue::Kind::kObject ||
      json.members.size() != 1) {
    return core::fail(Code::kMissingKey,
                      "one key \"columns\" is expected, an object with an entry a quantity", name);
  }
  std::vector<ContourColumn> out;
  for (const plans::JsonMember& member : columns->members) {
    TRY(auto column, column_of(member, name));
    out.push_back(std::move(column));
  }
  return out;
}

}  // namespace rondure::app
