#include "app/verbs/contour_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/units.h"
#include "record/csv/series.h"
#include "record/files.h"

namespace rondure::app {
namespace {

using core::Code;

/// The quantities that a file holds, in rad and mm; nothing for one without its column.
using Columns = std::vector<std::optional<std::vector<double>>>;

core::Result<Columns> read_columns(const std::string& file,
                                   const std::vector<ContourQuantity>& quantities,
                                   const std::vector<ContourColumn>& mapping, bool required) {
  const auto bytes = record::read_file(file);
  if (!bytes) return core::fail(bytes.error());
  std::vector<record::WantedColumn> wanted;
  std::vector<record::ColumnName> names;
  for (const ContourQuantity& quantity : quantities) {
    wanted.push_back({quantity.column, required});
    names.push_back({std::string(quantity.column), reading_of(quantity, mapping).column});
  }
  const std::string name = std::filesystem::path(file).filename().string();
  const auto series = record::parse_series_csv(*bytes, name, wanted, names);
  if (!series) return core::fail(series.error());
  Columns out;
  for (const ContourQuantity& quantity : quantities) {
    auto values = series->column(quantity.column);
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
  for (const std::string_view name : names) out.push_back(contour_quantity(name));
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
  auto columns = read_columns(file, all, mapping, false);
  if (!columns) return core::fail(columns.error());
  Columns& c = *columns;
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
  // A main journal has columns of its own only where they are named.
  const auto of_main = quantities({"main_angle", "main_deviation"});
  for (std::size_t i = 0; i < 2; ++i) {
    const bool named = std::any_of(mapping.begin(), mapping.end(), [&](const auto& column) {
      return column.quantity == of_main[i].name;
    });
    if (main && named) wanted[i] = of_main[i];
  }
  auto columns = read_columns(file, wanted, mapping, true);
  if (!columns) return core::fail(columns.error());
  return fit::GaugeRows{*std::move((*columns)[0]), *std::move((*columns)[1])};
}

}  // namespace

core::Result<ContourImport> read_contour_part(const ContourFiles& files,
                                              const std::vector<ContourColumn>& mapping) {
  ContourImport out;
  if (auto read = read_axes(files.axes, mapping, out); !read) return core::fail(read.error());
  auto pin = read_gauge(files.pin, false, mapping);
  if (!pin) return core::fail(pin.error());
  out.part.pin = *std::move(pin);
  if (files.main.empty()) return out;
  auto main = read_gauge(files.main, true, mapping);
  if (!main) return core::fail(main.error());
  out.part.main = *std::move(main);
  return out;
}

}  // namespace rondure::app
