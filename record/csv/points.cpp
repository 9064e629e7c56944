#include "record/csv/points.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/numbers.h"
#include "record/csv/internal/lines.h"

namespace rondure::record {
namespace {

/// Columns that belong together, and the unit of each.
struct ColumnSet {
  std::array<std::string_view, 5> names;
  std::array<std::string_view, 3> units;
  std::size_t required;  ///< This many columns, from the first, are required.
};
constexpr std::size_t kLayer = 3;    ///< Index in the set: a whole number, no coordinate.
constexpr std::size_t kFeature = 4;  ///< Index in the set: a text.
constexpr ColumnSet kFeaturePoints = {{"x", "y", "z", "layer", "feature"}, {"mm", "mm", "mm"}, 2};
constexpr ColumnSet kSection = {{"x", "y"}, {"mm", "mm"}, 2};
constexpr ColumnSet kPolar = {{"theta_deg", "r_um"}, {"deg", "um"}, 2};

/// The column sets that a kind of file may have.
struct Format {
  std::array<ColumnSet, 2> sets;
  std::string_view columns;  ///< The columns in the wording of messages.
  std::string_view units;
};
constexpr Format kFeatureFormat = {
    {kFeaturePoints, kFeaturePoints}, "x,y or x,y,z, beside them layer and feature", " (mm)"};
constexpr Format kProfileFormat = {{kPolar, kSection}, "theta_deg,r_um or x,y", " (mm)"};

/// The columns of a file: fields[i] is the index of field i in the set.
struct Columns {
  ColumnSet set;
  std::array<std::size_t, 5> fields{};
  std::size_t count = 0;

  [[nodiscard]] std::string_view name(std::size_t i) const { return set.names[fields[i]]; }
  [[nodiscard]] std::string_view unit(std::size_t i) const {
    return fields[i] < kLayer ? set.units[fields[i]] : std::string_view();
  }
  [[nodiscard]] bool has(std::size_t field) const {
    const auto end = fields.begin() + static_cast<std::ptrdiff_t>(count);
    return std::find(fields.begin(), end, field) != end;
  }
};

/// One row. The layer is 0 and the feature empty where the file has no such column.
struct PointRow {
  Eigen::Vector3d values = Eigen::Vector3d::Zero();
  double layer = 0.0;
  std::string_view feature;
};

std::optional<std::size_t> place_of(std::string_view field, const ColumnSet& set) {
  for (std::size_t i = 0; i < set.names.size(); ++i) {
    if (!field.empty() && field == set.names[i]) return i;
  }
  return std::nullopt;
}

core::Result<Columns> read_header(std::string_view line, const Format& format) {
  if (auto foreign = foreign_format(line)) return core::fail(*std::move(foreign));
  const auto names = split_fields(line);
  Columns columns;
  columns.set = place_of(names.front(), format.sets[0]) ? format.sets[0] : format.sets[1];
  std::array<bool, 5> seen{};
  for (const std::string_view field : names) {
    const auto place = place_of(field, columns.set);
    if (!place) {
      return core::fail_with(core::Code::kSyntax,
                             "column {} is unknown; the first line must name the columns {}{}",
                             quoted_text(field), format.columns, format.units);
    }
    if (std::exchange(seen[*place], true)) {
      return core::fail_with(core::Code::kSyntax,
                             "column {} stands twice; the columns are {}, each once",
                             quoted_text(field), format.columns);
    }
    columns.fields[columns.count++] = *place;
  }
  for (std::size_t i = 0; i < columns.set.required; ++i) {
    if (seen[i]) continue;
    return core::fail_with(core::Code::kSyntax,
                           "column \"{}\" is missing in {}; the columns are {}{}",
                           columns.set.names[i], quoted_text(line), format.columns, format.units);
  }
  return columns;
}

/// Reads a number as std::from_chars does, to the same bits. If up to 19 digits without an exponent
/// form an integer that a double holds exactly, and the power of ten is exact too, one division
/// rounds correctly (Clinger's case) in a third of the time. All other numbers go to from_chars.
std::from_chars_result read_number(const char* at, const char* end, double& value) {
  static constexpr std::array<double, 20> kPowers = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,
                                                     1e7,  1e8,  1e9,  1e10, 1e11, 1e12, 1e13,
                                                     1e14, 1e15, 1e16, 1e17, 1e18, 1e19};
  constexpr std::uint64_t kExact = std::uint64_t{1} << 53;
  const char* next = at;
  const bool negative = next != end && *next == '-';
  if (negative) ++next;
  std::uint64_t digits = 0;
  const char* const first = next;
  const auto take_digits = [&] {
    while (next != end && static_cast<unsigned char>(*next - '0') < 10) {
      digits = 10 * digits + static_cast<unsigned char>(*next++ - '0');
    }
  };
  take_digits();
  auto count = next - first;
  std::ptrdiff_t decimals = 0;
  if (next != end && *next == '.') {
    const char* const point = ++next;
    take_digits();
    decimals = next - point;
    count += decimals;
  }
  // 19 digits cannot overflow the integer; with more, `digits` is not used.
  if (count == 0 || count > 19 || digits > kExact || next == end || *next == 'e' || *next == 'E') {
    return std::from_chars(at, end, value);
  }
  const double size = static_cast<double>(digits) / kPowers[static_cast<std::size_t>(decimals)];
  value = negative ? -size : size;
  return {next, std::errc()};
}

/// Reads the row at the start of `text` if it consists of numbers, commas, single blanks before
/// numbers and the line end, as nearly every row does.
/// @return Bytes of the row with its end; 0 for any other row, which read_row() must read.
std::size_t read_plain_row(std::string_view text, const Columns& columns,
                           Eigen::Vector3d& point_mm) {
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t i = 0; i < columns.count; ++i) {
    if (i > 0 && (at == end || *at++ != ',')) return 0;
    if (at != end && *at == ' ') ++at;
    double& value = point_mm[static_cast<Eigen::Index>(columns.fields[i])];
    const auto [stop, problem] = read_number(at, end, value);
    if (problem != std::errc() || !core::is_measurable(value)) return 0;
    at = stop;
  }
  if (at != end && *at == '\r') ++at;
  if (at == end || *at != '\n') return 0;
  return static_cast<std::size_t>(at + 1 - text.data());
}

bool is_layer(double number) {
  constexpr double kMostLayers = 10'000.0;
  return number >= 0.0 && number < kMostLayers && number == std::floor(number);
}

/// Reads one row; false when it has an error, which explain() then describes.
bool read_row(std::string_view line, const Columns& columns, PointRow& row) {
  const char* at = line.data();
  const char* const end = at + line.size();
  const auto skip_blanks = [&] {
    while (at != end && (*at == ' ' || *at == '\t')) ++at;
  };
  for (std::size_t i = 0; i < columns.count; ++i) {
    if (i > 0 && (at == end || *at++ != ',')) return false;
    skip_blanks();
    const std::size_t field = columns.fields[i];
    if (field == kFeature) {
      const char* const stop = std::find(at, end, ',');
      row.feature = split_fields({at, static_cast<std::size_t>(stop - at)}).front();
      if (row.feature.empty()) return false;
      at = stop;
      continue;
    }
    if (at != end && *at == '+') {  // from_chars does not accept a plus sign
      ++at;
      if (at != end && *at == '-') return false;
    }
    double& value =
        field == kLayer ? row.layer : row.values[static_cast<Eigen::Index>(columns.fields[i])];
    const auto [stop, problem] = std::from_chars(at, end, value);
    if (problem != std::errc() || !core::is_measurable(value)) return false;
    if (field == kLayer && !is_layer(value)) return false;
    at = stop;
    skip_blanks();
  }
  return at == end;
}

/// Why read_row() refused a row.
core::Error explain(std::string_view line, const Columns& columns) {
  if (auto foreign = foreign_format(line)) return *std::move(foreign);
  const auto fields = split_fields(line);
  std::string names;
  for (std::size_t i = 0; i < columns.count; ++i) {
    if (i > 0) names += ',';
    names += columns.name(i);
  }
  if (fields.size() != columns.count) {
    return syntax_error(fmt::format(
        "{} field{} in {}, {} expected ({}){}", fields.size(), fields.size() == 1 ? "" : "s",
        quoted_text(line), columns.count, names,
        fields.size() == 2 * columns.count ? "; write decimals with a point, not a comma" : ""));
  }
  for (std::size_t i = 0; i < columns.count; ++i) {
    if (columns.fields[i] == kFeature) {
      if (fields[i].empty()) return syntax_error("the feature has no name");
      continue;
    }
    if (auto error = explain_field(fields[i], columns.name(i), columns.unit(i)))
      return *std::move(error);
    double layer = 0.0;
    std::from_chars(fields[i].data(), fields[i].data() + fields[i].size(), layer);
    if (columns.fields[i] == kLayer && !is_layer(layer)) {
      return syntax_error(
          fmt::format("{} is no layer; give whole numbers from 0 on", quoted_text(fields[i])));
    }
  }
  return syntax_error(
      fmt::format("{} cannot be read; numbers for {} are expected", quoted_text(line), names));
}

/// A whole file.
struct Rows {
  Columns columns;
  std::vector<Eigen::Vector3d> values;
  std::vector<int> layers = {};                 ///< Empty without that column.
  std::vector<std::string_view> features = {};  ///< In the text; empty without that column.
  std::vector<std::size_t> lines = {};          ///< Of each row, from 1; as many as features.
};

core::Result<Rows> parse(std::string_view text, std::string_view name, const Format& format) {
  Rows out;
  Columns& columns = out.columns;
  PointRow values;
  bool plain_rows = true;  // numbers alone
  const auto add_row = [&](std::size_t bytes) {
    // Rows are about as long as the first.
    if (out.values.empty()) out.values.reserve(std::min(text.size() / bytes + 1, kMostRows));
    out.values.push_back(values.values);
    if (columns.has(kLayer)) out.layers.push_back(static_cast<int>(values.layer));
    if (columns.has(kFeature)) out.features.push_back(values.feature);
  };
  const auto header = [&](std::string_view line) -> core::Result<void> {
    TRY(columns, read_header(line, format));
    plain_rows = !columns.has(kLayer) && !columns.has(kFeature);
    return {};
  };
  const auto row = [&](std::string_view line, std::size_t number) -> core::Result<void> {
    if (!read_row(line, columns, values)) return core::fail(explain(line, columns));
    add_row(line.size() + 1);
    if (columns.has(kFeature)) out.lines.push_back(number);
    return {};
  };
  const auto plain = [&](std::string_view rest) {
    const std::size_t bytes = plain_rows ? read_plain_row(rest, columns, values.values) : 0;
    if (bytes > 0) add_row(bytes);
    return bytes;
  };
  const auto no_rows = [&](bool has_header) {
    if (has_header) {
      return std::string("the file holds a header line and no points; a row a point is expected");
    }
    return fmt::format(
        "the file {}; a header line {} and a row a point are expected",
        without_byte_order_mark(text).empty() ? "is empty" : "holds only comments and blank lines",
        format.columns);
  };
  TRY_DO(read_table(text, name, header, row, no_rows, plain));
  return out;
}

/// "A, B": the features of a file in the order of their first rows.
std::string names_in(const std::vector<std::string_view>& features) {
  std::vector<std::string_view> seen;
  std::string out;
  for (const std::string_view feature : features) {
    if (std::find(seen.begin(), seen.end(), feature) != seen.end()) continue;
    seen.push_back(feature);
    out += fmt::format("{}{}", out.empty() ? "" : ", ", quoted_text(feature));
  }
  return out;
}

/// Counts a row of another feature.
void count_other(std::string_view feature, std::size_t line, std::vector<OtherRows>& others) {
  auto at = std::find_if(others.begin(), others.end(),
                         [&](const OtherRows& rows) { return rows.feature == feature; });
  if (at == others.end()) at = others.insert(at, {std::string(feature), 0, line});
  ++at->count;
}

/// How many points each layer has, layer 0 first.
std::vector<int> points_of_layers(const std::vector<int>& layers) {
  std::vector<int> out;
  for (const int layer : layers) {
    if (layer >= static_cast<int>(out.size())) out.resize(static_cast<std::size_t>(layer) + 1);
    ++out[static_cast<std::size_t>(layer)];
  }
  return out;
}

}  // namespace

int PointTable::layer_count() const { return static_cast<int>(points_of_layers(layers).size()); }

int PointTable::least_points_per_layer() const {
  const std::vector<int> points = points_of_layers(layers);
  return points.empty() ? 0 : *std::min_element(points.begin(), points.end());
}

core::Result<PointTable> parse_feature_csv(std::string_view text, std::string_view name,
                                           std::string_view feature) {
  TRY(auto rows, parse(text, name, kFeatureFormat));
  const auto fail = [&](core::Code code, std::string what) {
    return core::fail(core::Error{code, std::move(what), std::string(name)});
  };
  if (feature.empty() != rows.features.empty()) {
    return feature.empty()
               ? fail(core::Code::kMissingKey,
                      fmt::format("the file holds the features {}; choose one by feature, as {}",
                                  names_in(rows.features), quoted_text(rows.features.front())))
               : fail(core::Code::kMeaning,
                      fmt::format("the file has no column feature, {} is asked for; add the "
                                  "column, or name no feature",
                                  quoted_text(feature)));
  }
  PointTable out{rows.columns.has(2) ? 3 : 2, {}, {}, {}};
  if (rows.features.empty()) {
    out.points_mm = std::move(rows.values);
    out.layers = std::move(rows.layers);
  }
  for (std::size_t i = 0; i < rows.features.size(); ++i) {
    if (rows.features[i] != feature) {
      count_other(rows.features[i], rows.lines[i], out.others);
      continue;
    }
    out.points_mm.push_back(rows.values[i]);
    if (!rows.layers.empty()) out.layers.push_back(rows.layers[i]);
  }
  if (out.points_mm.empty()) {
    return fail(core::Code::kNoPoints, fmt::format("no row is of feature {}; the file has {}",
                                                   quoted_text(feature), names_in(rows.features)));
  }
  const std::vector<int> points = points_of_layers(out.layers);
  const auto gap = std::find(points.begin(), points.end(), 0);
  if (gap == points.end()) return out;
  return fail(core::Code::kSampling,
              fmt::format("there are points of layer {} and none of layer {}; layers count from 0 "
                          "without a gap",
                          points.size() - 1, gap - points.begin()));
}

core::Result<ProfileTable> parse_profile_csv(std::string_view text, std::string_view name) {
  TRY(const auto rows, parse(text, name, kProfileFormat));
  ProfileTable table{rows.columns.set.names[0] == kPolar.names[0], {}};
  table.rows.reserve(rows.values.size());
  for (const Eigen::Vector3d& values : rows.values) table.rows.emplace_back(values.head<2>());
  return table;
}

}  // namespace rondure::record
