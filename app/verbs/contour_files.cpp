#include "app/verbs/contour_files.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "core/numbers.h"
#include "evaluation/contour/result.h"
#include "plans/analyses/contour_columns.h"
#include "plans/schema/json_text.h"
#include "record/files.h"

namespace rondure::app {
namespace {

using core::Code;
using record::ContourColumnTask;

/// "c, c_error, ...": the words of an enumeration.
template <class Enum>
std::string words_of_all() {
  std::string out;
  for (const auto& word : words_of(Enum{})) {
    out += fmt::format("{}{}", out.empty() ? "" : ", ", word.text);
  }
  return out;
}

/// The texts of a column, as a line or a file states them.
struct ColumnText {
  std::string quantity;
  std::string column;
  std::string unit;  ///< Empty: that of the quantity without a mapping.
  double sign = 1.0;
};

core::Result<ContourColumnTask> column_of(const ColumnText& text) {
  const auto quantity = record::value_named<ContourColumnTask::Quantity>(text.quantity);
  if (!quantity) {
    return core::fail_with(Code::kBadOption, "there is no quantity \"{}\"; they are {}",
                           text.quantity, words_of_all<ContourColumnTask::Quantity>());
  }
  if (text.sign != 1.0 && text.sign != -1.0) {
    return core::fail_with(Code::kBadOption, "the sign of {} is {}; it is 1 or -1", text.quantity,
                           text.sign);
  }
  ContourColumnTask out{*quantity, text.column, {}, text.sign};
  if (!text.unit.empty()) {
    out.unit = record::value_named<ContourColumnTask::Unit>(text.unit);
    if (!out.unit) {
      return core::fail_with(Code::kBadOption, "{} has the unit \"{}\"; units are {}",
                             text.quantity, text.unit, words_of_all<ContourColumnTask::Unit>());
    }
  }
  TRY_DO(plans::check_column(out));
  return out;
}

core::Result<void> read_axes(const std::string& file, const std::vector<ContourColumnTask>& mapping,
                             ContourImport& out) {
  TRY(const auto text, record::read_file(file, record::kMostPointsBytes));
  const std::string name = std::filesystem::path(file).filename().string();
  TRY(const auto trace, plans::read_trace(text, name, mapping));
  out.positions = trace.positions;
  out.part.trace = evaluation::trace_of(trace.series);
  return {};
}

core::Result<fit::GaugeRows> read_gauge(const std::string& file, bool main,
                                        const std::vector<ContourColumnTask>& mapping) {
  TRY(const auto text, record::read_file(file, record::kMostPointsBytes));
  const std::string name = std::filesystem::path(file).filename().string();
  TRY(const auto series, plans::read_gauge(text, name, main, mapping));
  return evaluation::rows_of(series);
}

core::Result<ContourColumnTask> column_of(const plans::JsonMember& member,
                                          const std::string& file) {
  const std::string place =
      fmt::format("{}#{}", file, plans::member_pointer("/columns", member.key));
  ColumnText out;
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
  auto column = column_of(out);
  if (!column) return core::fail(column.error().at(place));
  return column;
}

}  // namespace

core::Result<ContourImport> read_contour_part(const ContourFiles& files,
                                              const std::vector<ContourColumnTask>& mapping) {
  ContourImport out;
  if (!files.axes.empty()) TRY_DO(read_axes(files.axes, mapping, out));
  TRY(out.part.pin, read_gauge(files.pin, false, mapping));
  if (files.main.empty()) return out;
  TRY(out.part.main, read_gauge(files.main, true, mapping));
  return out;
}

core::Result<ContourColumnTask> parse_contour_column(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) {
    return core::fail_with(
        Code::kBadOption,
        "--column {}: quantity=column[:unit[:sign]] is expected, e.g. x_error=X_FOLLOW:um:-1",
        text);
  }
  ColumnText out;
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
  auto column = column_of(out);
  if (!column) return core::fail(column.error().at(fmt::format("--column {}", text)));
  return column;
}

core::Result<std::vector<ContourColumnTask>> read_contour_mapping(const std::string& file) {
  TRY(const auto bytes, record::read_file(file));
  const std::string name = std::filesystem::path(file).filename().string();
  TRY(const auto json, plans::parse_json(bytes, name));
  const plans::JsonValue* const columns = json.find("columns");
  if (columns == nullptr || columns->kind != plans::JsonValue::Kind::kObject ||
      json.members.size() != 1) {
    return core::fail(Code::kMissingKey,
                      "one key \"columns\" is expected, an object with an entry a quantity", name);
  }
  std::vector<ContourColumnTask> out;
  for (const plans::JsonMember& member : columns->members) {
    TRY(auto column, column_of(member, name));
    out.push_back(std::move(column));
  }
  return out;
}

}  // namespace rondure::app
