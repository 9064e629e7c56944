#include "record/csv/balls.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "core/numbers.h"
#include "record/csv/internal/lines.h"

namespace rondure::record {
namespace {

using core::Code;

constexpr std::string_view kColumnList =
    "axis,station_deg,ball,x_mm,y_mm,z_mm,u_um (or ux_um,uy_um,uz_um)[,direction]";

constexpr std::array<std::string_view, 11> kColumns = {"axis",  "station_deg", "ball",     "x_mm",
                                                       "y_mm",  "z_mm",        "u_um",     "ux_um",
                                                       "uy_um", "uz_um",       "direction"};

/// Position of each column in a row; empty for a column that the file does not have.
using Places = std::array<std::optional<std::size_t>, kColumns.size()>;

std::optional<std::size_t> index_of(std::string_view column) {
  const auto at = std::find(kColumns.begin(), kColumns.end(), column);
  if (at == kColumns.end()) return std::nullopt;
  return static_cast<std::size_t>(at - kColumns.begin());
}

core::Result<Places> read_header(std::string_view line) {
  if (auto foreign = foreign_format(line)) return core::fail(*std::move(foreign));
  Places out;
  const auto fields = split_fields(line);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const auto column = index_of(fields[i]);
    if (!column) {
      return core::fail(unknown_column(fields[i], kColumns, kColumnList,
                                       ": all centres are in mm and all uncertainties in um"));
    }
    if (out[*column]) {
      return core::fail(syntax_error(fmt::format("column {} stands twice", fields[i])));
    }
    out[*column] = i;
  }
  const bool each = out[7] && out[8] && out[9];
  const bool any = out[7] || out[8] || out[9];
  for (std::size_t i = 0; i < 6; ++i) {
    if (out[i]) continue;
    return core::fail(syntax_error(
        fmt::format("column \"{}\" is missing; the columns are {}", kColumns[i], kColumnList)));
  }
  if (out[6].has_value() == any || any != each) {
    return core::fail(syntax_error(
        fmt::format("give u_um for all directions or all of ux_um,uy_um,uz_um; the columns are {}",
                    kColumnList)));
  }
  return out;
}

/// The fields of one row by column.
struct Fields {
  const Places& places;
  std::vector<std::string_view> fields;

  [[nodiscard]] std::string_view text(std::size_t column) const {
    return places[column] ? fields[*places[column]] : std::string_view();
  }
  [[nodiscard]] core::Result<double> number(std::size_t column) const {
    std::string_view field = text(column);
    const std::string_view name = kColumns[column];
    if (auto wrong = explain_field(field, name, unit_of_column(name))) {
      return core::fail(*std::move(wrong));
    }
    if (field.starts_with('+')) field.remove_prefix(1);
    const auto value = core::parse_number(field);
    if (value) return *value;
    return core::fail(syntax_error(fmt::format("{} is {}", name, quoted_text(field))));
  }
};

core::Result<int> direction_of(std::string_view text) {
  if (text.empty()) return 0;
  if (text == "+" || text == "forward") return 1;
  if (text == "-" || text == "backward") return -1;
  return core::fail(
      syntax_error(fmt::format("direction is {}; +, - or nothing is expected", quoted_text(text))));
}

core::Result<void> read_numbers(const Fields& fields, BallRow& out) {
  for (Eigen::Index k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    TRY(const auto place, fields.number(3 + i));
    const std::size_t column = fields.places[6] ? 6 : 7 + i;
    TRY(const auto u, fields.number(column));
    if (u < 0.0) {
      return core::fail_with(Code::kOutOfRange, "{} is {:g}, less than 0", kColumns[column], u);
    }
    out.centre_mm(k) = place;
    out.u_um(k) = u;
  }
  return {};
}

core::Result<BallRow> read_row(std::string_view line, const Places& places, std::size_t columns) {
  const Fields fields = {places, split_fields(line)};
  if (fields.fields.size() != columns) {
    if (auto foreign = foreign_format(line)) return core::fail(*std::move(foreign));
    return core::fail(syntax_error(fmt::format("{} fields in {}, {} expected", fields.fields.size(),
                                               quoted_text(line), columns)));
  }
  BallRow out;
  out.axis = fields.text(0);
  out.ball = fields.text(2);
  if (out.axis.empty() || out.ball.empty()) {
    return core::fail(syntax_error(
        fmt::format("{} is empty; a name is expected", out.axis.empty() ? "axis" : "ball")));
  }
  if (fields.text(1) != "reference") {
    const auto station = fields.number(1);
    if (!station) {
      core::Error error = station.error();
      error.what += ", or the word reference";
      return core::fail(std::move(error));
    }
    out.station_deg = *station;
  }
  TRY(out.direction, direction_of(fields.text(10)));
  TRY_DO(read_numbers(fields, out));
  return out;
}

}  // namespace

core::Result<std::vector<BallRow>> parse_ball_csv(std::string_view text, std::string_view name) {
  std::vector<BallRow> out;
  Places places;
  std::size_t columns = 0;
  const auto header = [&](std::string_view line) -> core::Result<void> {
    TRY(places, read_header(line));
    columns = split_fields(line).size();
    return {};
  };
  const auto add = [&](std::string_view line, std::size_t number) -> core::Result<void> {
    TRY(auto row, read_row(line, places, columns));
    row.line = number;
    out.push_back(std::move(row));
    return {};
  };
  TRY_DO(read_table(text, name, header, add, [](bool) {
    return fmt::format("the file holds no rows; a header line {} and a row a ball are expected",
                       kColumnList);
  }));
  return out;
}

}  // namespace rondure::record
