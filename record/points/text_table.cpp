#include "record/points/internal/text_table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "core/encodings.h"
#include "core/numbers.h"
#include "record/csv/internal/lines.h"
#include "record/points/internal/row_names.h"
#include "record/points/internal/table_layout.h"

namespace rondure::record {

using core::Code;

// If up to 19 digits without an exponent form an integer that a double holds exactly, and the power
// of ten is exact too, one division rounds correctly (Clinger's case) in a third of the time. All
// other numbers go to from_chars.
std::from_chars_result read_number(const char* at, const char* end, char decimal, double& value) {
  static constexpr std::array<double, 20> kPowers = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,
                                                     1e7,  1e8,  1e9,  1e10, 1e11, 1e12, 1e13,
                                                     1e14, 1e15, 1e16, 1e17, 1e18, 1e19};
  constexpr std::uint64_t kExact = std::uint64_t{1} << 53;
  if (at != end && *at == '+') {  // from_chars does not accept a plus sign
    if (++at != end && *at == '-') return {at, std::errc::invalid_argument};
  }
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
  const char* const mark = next;
  if (next != end && *next == decimal) {
    const char* const point = ++next;
    take_digits();
    decimals = next - point;
    if (decimal == ',' && (count == 0 || decimals == 0)) return {at, std::errc::invalid_argument};
    count += decimals;
  }
  // 19 digits cannot overflow the integer; with more, `digits` is not used.
  const char exponent = next == end ? '\0' : static_cast<char>(*next | 0x20);
  const bool fortran = exponent == 'd' && end - next > 2 && (next[1] == '+' || next[1] == '-');
  if (count > 0 && count <= 19 && digits <= kExact && exponent != 'e' && !fortran) {
    const double size = static_cast<double>(digits) / kPowers[static_cast<std::size_t>(decimals)];
    value = negative ? -size : size;
    return {next, std::errc()};
  }
  if (!fortran && (decimal == '.' || mark == next)) return std::from_chars(at, end, value);
  std::string text(at, std::find_if(next + (fortran ? 1 : 0), end, [](char c) {
                     return (c < '0' || c > '9') && (c | 0x20) != 'e' && c != '+' && c != '-';
                   }));
  if (mark != next && *mark == decimal) text[static_cast<std::size_t>(mark - at)] = '.';
  if (fortran) text[static_cast<std::size_t>(next - at)] = 'e';
  const auto [stop, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  return {at + (stop - text.data()), problem};
}

namespace {

constexpr std::array<std::string_view, 5> kNoValue = {"", "#NV", "#N/A", "N/A", "n/a"};

constexpr auto kEndWords =
    std::to_array<std::string_view>({"end", "ende", "eof", "fin", "fine", "koniec", "结束"});

bool has_no_value(std::string_view field) {
  return std::ranges::find(kNoValue, field) != kNoValue.end() || is_nan(field) ||
         field.find_first_not_of('-') == std::string_view::npos ||
         field.find_first_not_of('*') == std::string_view::npos;
}

/// Reads the rows of a table of which the layout is known.
class RowReader {
 public:
  RowReader(const TableLayout& layout, std::string_view name, const PointsOptions& options,
            const WantedColumns& wanted)
      : layout_(layout), name_(name), options_(options), wanted_(wanted) {
    table_.unit = layout.units.unit;
  }

  core::Result<TextTable> read() {
    Lines lines = layout_.rows;
    std::size_t bytes = 0;
    while (!lines.rest.empty()) {
      const std::string_view line = lines.take();
      if (holds_no_row(line)) {
        if (auto fault = text(line, lines.number)) return core::fail(*std::move(fault));
        gap_ = count_ > 0;
        continue;
      }
      if (row(line)) {
        if (table_.rows.empty()) bytes = line.size() + 1;
        if (below_) return core::fail(*std::move(below_));
        table_.left_out += std::exchange(empty_, 0);
        if (auto full = keep(lines, bytes)) return core::fail(*std::move(full));
        continue;
      }
      auto error = explain(line);
      if (!error) error = syntax_error(fmt::format("{} cannot be read", quoted_text(line)));
      error = at_line(*std::move(error), name_, lines.number);
      if (!no_value_ && ends_table(line)) {
        text(line, lines.number);
        at_least_ = std::max(at_least_, points_in_text(line));
        ++table_.below;
        if (!below_) below_ = std::move(error);
        continue;
      }
      if (below_ || !no_value_) return core::fail(below_ ? *std::move(below_) : *std::move(error));
      if (!first_without_) first_without_ = std::move(error);
      // empty rows at the end are none
      ++(filled_fields(fields_of(line, layout_.notation.separator)) == 0 ? empty_
                                                                         : table_.left_out);
    }
    return finish(lines);
  }

 private:
  /// Takes the unit that a line of text among the rows states, and the feature that it names.
  /// @return  An error for another feature, and for columns in another order.
  std::optional<core::Error> text(std::string_view line, std::size_t number) {
    std::string_view words = line;
    words.remove_prefix(std::min(words.find_first_not_of("#/ \t"), words.size()));
    if (words.empty()) return std::nullopt;
    if (!wanted_.polar) units_.take(line, name_, number, true);
    const auto head = head_of(fields_of(words, layout_.notation.separator), options_, wanted_);
    if (head && count_ > 0 && head->roles != layout_.roles &&
        std::ranges::is_permutation(head->roles, layout_.roles)) {
      return at_line(syntax_error(fmt::format("{} names the columns in another order than above; "
                                              "bring the rows below in a file of their own",
                                              quoted_text(line))),
                     name_, number);
    }
    std::string feature = feature_of_heading(line);
    if (feature.empty()) return std::nullopt;
    const bool other = !heading_.empty() && feature != heading_ && count_ > 0;
    if (other) {
      return at_line({Code::kMeaning,
                      fmt::format("{} begins the points of another feature; bring each in a file "
                                  "of its own, or add a column feature",
                                  quoted_text(line)),
                      {}},
                     name_, number);
    }
    heading_ = std::move(feature);
    return std::nullopt;
  }

  /// Whether a line is text that ends a protocol: "Ende", "Points: 360", "Operator: M. Weber". It
  /// is no row that was cut off.
  bool ends_table(std::string_view line) const {
    const char separator = layout_.notation.separator;
    const NameWords words = words_in(line);
    if (count_ == 0 || words.empty() || (words[0][0] >= '0' && words[0][0] <= '9')) return false;
    if (separator != ' ' && filled_fields(fields_of(line, separator)) > 1) return false;
    const bool digits = line.find_first_of("0123456789") != std::string_view::npos;
    const bool states = line.find_first_of(":=") != std::string_view::npos;
    return points_in_text(line) || (states && (!digits || layout_.roles[0] <= Role::kZ)) ||
           (!digits && (words.size() > 1 || is_one_of(kEndWords, words[0])));
  }

  /// Reads one row; false when it has an error, which explain() then describes.
  bool row(std::string_view line) {
    const char separator = layout_.notation.separator;
    // Commas are decimal ones between quotes only, where they separate fields, too.
    const char decimal =
        separator == ',' && layout_.notation.decimal == ',' ? '\0' : layout_.notation.decimal;
    const char* at = line.data();
    const char* const end = at + line.size();
    const auto skip_blanks = [&] {
      while (at != end && (*at == ' ' || (*at == '\t' && separator != '\t'))) ++at;
    };
    skip_blanks();
    unit_.reset();
    named_ = false;
    for (std::size_t i = 0; i < layout_.roles.size(); ++i) {
      if (i > 0 && separator != ' ') {
        if (at == end || *at != separator) return false;
        ++at;
        skip_blanks();
      } else if (at == end) {
        return false;
      }
      const Role role = layout_.roles[i];
      const std::size_t close =
          at != end && (*at == '"' || *at == '\'')
              ? closing_quote({at, static_cast<std::size_t>(end - at)}, separator)
              : std::string_view::npos;
      const bool quoted = close != std::string_view::npos;
      if (!quoted && role <= Role::kLayer) {
        double& value = role == Role::kLayer ? layer_ : values_[static_cast<Eigen::Index>(role)];
        const auto [stop, problem] = read_number(at, end, decimal, value);
        if (problem != std::errc() || !core::is_measurable(value)) return false;
        at = stop;
        if (separator == ' ' && at != end && *at != ' ' && *at != '\t') return false;
      } else {
        const char* stop = quoted ? at + close : at;
        stop = std::find_if(
            stop, end, [&](char c) { return c == separator || (separator == ' ' && c == '\t'); });
        const Cells field = fields_of({at, static_cast<std::size_t>(stop - at)}, '\n');
        if (!take(role, field.front())) return false;
        at = stop;
      }
      skip_blanks();
    }
    while (separator != ' ' && at != end && *at == separator) {  // empty fields may follow
      ++at;
      skip_blanks();
    }
    return at == end && (!has_layer_ || is_layer(layer_));
  }

  /// A field that is quoted or no number.
  bool take(Role role, std::string_view field) {
    if (role == Role::kNone) return true;
    if (role == Role::kFeature) {
      if (layout_.by_point && !feature_of_point(field).empty()) field = feature_of_point(field);
      if (!field.empty() || !layout_.elements) {  // a name in two columns reads as in the line
        const char* const begin = std::exchange(named_, true) ? feature_.data() : field.data();
        feature_ = {begin, static_cast<std::size_t>(field.data() + field.size() - begin)};
      }
      return !feature_.empty();
    }
    if (role == Role::kCount) return core::parse_number(field).has_value();
    if (role == Role::kUnit) {
      if (field.empty()) return true;
      const auto unit = unit_of_field(field);
      const bool one = unit && unit == unit_.value_or(*unit);
      unit_ = unit;
      return one;
    }
    double& value = role == Role::kLayer ? layer_ : values_[static_cast<Eigen::Index>(role)];
    const char* const end = field.data() + field.size();
    const auto [stop, problem] = read_number(field.data(), end, layout_.notation.decimal, value);
    return problem == std::errc() && stop == end && !field.empty() && core::is_measurable(value);
  }

  static bool is_layer(double number) {
    constexpr double kMostLayers = 10'000.0;
    return number >= 0.0 && number <= kMostLayers && number == std::floor(number);
  }

  /// Keeps the row that was read, or counts it where it is of another feature.
  std::optional<core::Error> keep(const Lines& lines, std::size_t bytes) {
    blocks_ += std::exchange(gap_, false) ? 1 : 0;
    if (++count_ > kMostRows) return at_line(too_many_rows(), name_, lines.number);
    if (has_feature_) {
      if (table_.feature.empty())
        table_.feature = options_.feature.empty() ? feature_ : options_.feature;
      if (feature_ != table_.feature) {
        const auto [at, is_new] = others_.try_emplace(feature_, table_.others.size());
        if (is_new) table_.others.push_back({std::string(feature_), 0, lines.number});
        ++table_.others[at->second].count;
        return std::nullopt;
      }
    }
    if (unit_ && unit_ != table_.unit.value_or(*unit_)) {
      return at_line(unit_error(fmt::format("the column of units says {}, another unit than above",
                                            name_of(*unit_))),
                     name_, lines.number);
    }
    if (unit_) table_.unit = unit_;
    if (table_.rows.empty()) {  // rows are about as long as the first
      table_.rows.reserve(std::min(lines.rest.size() / bytes + 1, kMostRows));
    }
    table_.rows.push_back(values_);
    if (has_layer_) table_.layers.push_back(static_cast<int>(layer_));
    return std::nullopt;
  }

  /// Why row() refused a row; sets no_value_ where a coordinate has none.
  std::optional<core::Error> explain(std::string_view line) {
    no_value_ = false;
    const Cells fields = fields_of(line, layout_.notation.separator);
    const std::size_t columns = layout_.roles.size();
    if (line.find('\r') != std::string_view::npos || !agrees(fields, columns)) {
      return wrong_count(line, layout_.notation.separator, columns);
    }
    std::optional<core::Error> without;
    std::optional<std::size_t> odd;  // a column of numbers of rows that has none
    for (std::size_t i = 0; i < columns; ++i) {
      const Role role = layout_.roles[i];
      if (role == Role::kFeature && fields[i].empty()) {
        return syntax_error("the feature has no name");
      }
      if (role == Role::kLayer && !(take(role, fields[i]) && is_layer(layer_))) {
        return syntax_error(
            fmt::format("{} is no layer; give whole numbers from 0 or 1 on, or "
                        "read without layers: --layers none, in a plan "
                        "source.layers",
                        quoted_text(fields[i])));
      }
      if (role == Role::kCount && !odd && !take(role, fields[i])) odd = i;
      if (role == Role::kUnit && !take(role, fields[i])) {
        return unit_error(fmt::format("the column of units says {}", quoted_text(fields[i])));
      }
      if (role > Role::kZ || take(role, fields[i])) continue;
      auto error = explain_number(fields[i], static_cast<std::size_t>(role));
      if (!has_no_value(fields[i]) || (wanted_.profile && is_nan(fields[i]))) return error;
      if (!without) without = std::move(error);
    }
    no_value_ = without.has_value();
    if (without || !odd) return without;
    return syntax_error(fmt::format(
        "{} stands in column {}, where other rows have a number: delete the line if it sums up the "
        "points, or name the columns of x, y and z: --columns {}, in a plan source.columns",
        fields[*odd].empty() ? "nothing" : quoted_text(fields[*odd]), *odd + 1,
        column_numbers(layout_.roles)));
  }

  core::Error explain_number(std::string_view field, std::size_t role) const {
    const std::string_view column = wanted_.names.at(role);
    const std::size_t comma = field.find(',');
    const std::size_t point = field.find('.');
    const char decimal = layout_.notation.decimal;
    if (comma != std::string_view::npos && point != std::string_view::npos) {
      return syntax_error(
          fmt::format("{} is {}, with a comma and a point: thousands are not "
                      "separated in a points file",
                      column, quoted_text(field)));
    }
    if ((decimal == '.' ? comma : point) != std::string_view::npos) {
      return syntax_error(
          fmt::format("{} is {}, other numbers have a decimal {}; a file has one "
                      "decimal sign",
                      column, quoted_text(field), decimal == '.' ? "point" : "comma"));
    }
    std::string text(field);
    std::ranges::replace(text, ',', '.');
    if (auto error = explain_field(text, column, wanted_.units.at(role))) return *std::move(error);
    return syntax_error(fmt::format("{} is {}; a number such as 12{}5 is expected", column,
                                    quoted_text(field), decimal));
  }

  core::Result<TextTable> finish(const Lines& lines) {
    const auto fault = units_.fault();
    if (fault && !options_.unit && !has_unit_) return core::fail(*fault);
    if (!has_unit_) table_.unit = units_.unit;
    const std::size_t all = count_ + table_.left_out;
    // a few lost points are dirt, more are another kind of file
    if (table_.left_out * 100 > all) return core::fail(*first_without_);
    if (all == 0) {
      return core::fail(
          at_line({Code::kNoPoints,
                   "the file holds a header line and no points; a row a point is expected",
                   {}},
                  name_, std::max<std::size_t>(lines.number, 1)));
    }
    const auto announced = layout_.announced ? layout_.announced : layout_.at_least;
    if (layout_.announced ? *announced != all : announced > all) {
      return core::fail(at_line(
          syntax_error(fmt::format("a line above the rows announces {} of them, {} follow: is the "
                                   "file cut off?",
                                   *announced, all)),
          name_, lines.number));
    }
    if (at_least_ > all) {
      return core::fail(at_line(
          syntax_error(fmt::format("a line below the rows states {} of them, {} stand above it: is "
                                   "a part missing?",
                                   *at_least_, all)),
          name_, lines.number));
    }
    if (table_.rows.empty()) {
      return core::fail(Code::kNoPoints,
                        fmt::format("no row is of feature {}; the file has {}",
                                    quoted_text(options_.feature), other_names()),
                        std::string(name_));
    }
    if (options_.feature.empty() && !table_.others.empty()) {
      table_.others.insert(table_.others.begin(), {table_.feature, table_.rows.size(), 0});
      return core::fail(
          Code::kMissingKey,
          fmt::format("the file holds the features {}; choose one by feature, as {}{}",
                      other_names(), quoted_text(table_.feature),
                      layout_.elements ? ", or name the columns of x, y and z where "
                                         "they are one: --columns, in a plan "
                                         "source.columns"
                                       : ""),
          std::string(name_));
    }
    table_.dimensions = layout_.has(Role::kZ) ? 3 : 2;
    table_.read = fmt::format(
        "{}, decimal {}, {}", name_of_separator(layout_.notation.separator),
        layout_.notation.decimal == '.' ? "point" : "comma",
        fmt::join(layout_.names.begin(), layout_.names.begin() + table_.dimensions, " "));
    if (blocks_ > 1) table_.read += fmt::format(", rows in {} blocks", blocks_);
    return std::move(table_);
  }

  /// "A, B": the features of the file in the order of their first rows.
  [[nodiscard]] std::string other_names() const {
    constexpr std::size_t kMostNamed = 20;
    std::string out;
    for (std::size_t i = 0; i < std::min(table_.others.size(), kMostNamed); ++i) {
      out += fmt::format("{}{}", i == 0 ? "" : ", ", quoted_text(table_.others[i].feature));
    }
    return out + (table_.others.size() > kMostNamed ? ", ..." : "");
  }

  const TableLayout& layout_;
  std::string_view name_;
  const PointsOptions& options_;
  const WantedColumns& wanted_;
  bool has_layer_ = layout_.has(Role::kLayer);
  bool has_feature_ = layout_.has(Role::kFeature);
  bool has_unit_ = layout_.has(Role::kUnit);
  UnitLines units_ = layout_.units;
  TextTable table_;
  std::size_t count_ = 0;
  std::map<std::string_view, std::size_t> others_;
  std::optional<core::Error> first_without_;  ///< Of a row without values.
  std::optional<core::Error> below_;          ///< Of a line of text below the rows.
  std::optional<std::size_t> at_least_;       ///< Rows that such a line states.
  std::size_t empty_ = 0;                     ///< Rows since the last one that had values.
  bool gap_ = false;        ///< Blank lines or comments stand between the rows here.
  std::size_t blocks_ = 1;  ///< Of rows.
  bool no_value_ = false;
  Eigen::Vector3d values_ = Eigen::Vector3d::Zero();
  double layer_ = 0.0;
  std::string_view feature_;
  bool named_ = false;  ///< feature_ is that of the row.
  std::string heading_ = layout_.heading;
  std::optional<LengthUnit> unit_;  ///< Of the row.
};

}  // namespace

core::Result<TextTable> read_text_table(std::string_view text, std::string_view name,
                                        const PointsOptions& options, const WantedColumns& wanted) {
  TRY(const auto layouts, find_layouts(text, name, options, wanted));
  std::optional<core::Error> fault;
  for (TableLayout layout : layouts) {
    if (options.layers && options.layers != LayersFrom::kColumn) {
      std::ranges::replace(layout.roles, Role::kLayer, Role::kNone);
    }
    if (!options.feature.empty() && !layout.has(Role::kFeature)) {
      return core::fail(Code::kMeaning,
                        fmt::format("the file has no column feature, {} is asked for; add the "
                                    "column, or name no feature",
                                    quoted_text(options.feature)),
                        std::string(name));
    }
    if (options.layers == LayersFrom::kColumn && !layout.has(Role::kLayer)) {
      return core::fail(Code::kMeaning, "the file has no column layer, which is asked for",
                        std::string(name));
    }
    auto table = RowReader(layout, name, options, wanted).read();
    if (table) return table;
    if (!fault) fault = std::move(table).error();
  }
  return core::fail(*std::move(fault));
}

}  // namespace rondure::record
