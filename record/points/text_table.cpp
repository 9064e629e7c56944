#include "record/points/internal/text_table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "core/numbers.h"
#include "core/utf8.h"
#include "record/csv/internal/lines.h"

namespace rondure::record {
namespace {

using core::Code;
using Cells = std::vector<std::string_view>;

/// How numbers and fields are told apart.
struct Notation {
  char separator;  ///< ' ' for any number of blanks.
  char decimal;
};
/// Where two notations fit equally well the first counts: beside other separators there are blanks,
/// too. Commas may do both where quotes hold the numbers together.
constexpr auto kNotations = std::to_array<Notation>({{'\t', '.'},
                                                     {'\t', ','},
                                                     {';', '.'},
                                                     {';', ','},
                                                     {'|', '.'},
                                                     {'|', ','},
                                                     {',', '.'},
                                                     {',', ','},
                                                     {' ', '.'},
                                                     {' ', ','}});
constexpr std::array<std::string_view, 5> kNoValue = {"", "#NV", "#N/A", "N/A", "n/a"};
constexpr std::size_t kLookedAt = 200;  ///< Lines that show how a file is written.

std::string_view name_of_separator(char separator) {
  switch (separator) {
    case '\t':
      return "tab";
    case ';':
      return "semicolon";
    case '|':
      return "bar";
    case ',':
      return "comma";
    default:
      return "blanks";
  }
}

/// Reads a number as std::from_chars does, to the same bits. If up to 19 digits without an exponent
/// form an integer that a double holds exactly, and the power of ten is exact too, one division
/// rounds correctly (Clinger's case) in a third of the time. All other numbers go to from_chars. A
/// decimal comma stands between digits: "1," may be a number and a separator.
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
  if (count > 0 && count <= 19 && digits <= kExact && (next == end || (*next | 0x20) != 'e')) {
    const double size = static_cast<double>(digits) / kPowers[static_cast<std::size_t>(decimals)];
    value = negative ? -size : size;
    return {next, std::errc()};
  }
  if (decimal == '.' || mark == next) return std::from_chars(at, end, value);
  std::string text(at, std::find_if(next, end, [](char c) {
                     return (c < '0' || c > '9') && (c | 0x20) != 'e' && c != '+' && c != '-';
                   }));
  text[static_cast<std::size_t>(mark - at)] = '.';
  const auto [stop, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  return {at + (stop - text.data()), problem};
}

/// Whether a field is one number of a notation; a fraction counts for more.
struct Numeric {
  bool number = false;
  bool fraction = false;
};
Numeric numeric(std::string_view field, char decimal) {
  double value = 0.0;
  const char* const end = field.data() + field.size();
  const auto [stop, problem] = read_number(field.data(), end, decimal, value);
  const bool number =
      !field.empty() && problem == std::errc() && stop == end && std::isfinite(value);
  return {number, number && field.find(decimal) != std::string_view::npos};
}

bool has_no_value(std::string_view field) {
  return std::ranges::find(kNoValue, field) != kNoValue.end() ||
         field.find_first_not_of('-') == std::string_view::npos ||
         field.find_first_not_of('*') == std::string_view::npos;
}

/// Takes a line off a text. Lines end with LF or CR LF, or, where there is no LF, with CR.
struct Lines {
  std::string_view rest;
  char end = '\n';
  std::size_t number = 0;  ///< Of the line taken last, from 1.

  explicit Lines(std::string_view text) : rest(text) {
    if (text.find('\n') == std::string_view::npos) end = '\r';
  }
  std::string_view take() {
    ++number;
    const std::size_t stop = std::min(rest.find(end), rest.size());
    std::string_view line = rest.substr(0, stop);
    rest.remove_prefix(std::min(stop + 1, rest.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }
};

/// A line at the begin of a file that is not empty.
struct Line {
  std::string_view text;  ///< Of a comment without its sign.
  Lines before;           ///< The file from this line on.
  std::size_t number;
  bool comment;
};

/// How a table is written, and where its rows begin.
struct TableLayout {
  Notation notation;
  std::vector<Role> roles;  ///< One a field.
  std::array<std::string, 3> names;
  std::optional<LengthUnit> unit;
  Lines rows{std::string_view()};
  std::optional<std::size_t> announced = {};  ///< Rows that the line above them states.

  [[nodiscard]] bool has(Role role) const { return std::ranges::find(roles, role) != roles.end(); }
};

/// Whether fields are a row of so many columns: empty ones may follow.
bool agrees(const Cells& fields, std::size_t columns) {
  return fields.size() >= columns && filled_fields(fields) <= columns;
}

/// "1,5" as a reader takes it for one number or for two.
std::string both_readings(std::string_view line) {
  const Cells fields = fields_of(line, ',');
  const auto text = [&](char between) {
    return quoted_text(fmt::format("{}{}{}", fields[0], between, fields[1]));
  };
  return fmt::format(
      "{} may be one number, {}, or two: separate fields by semicolons, or write "
      "decimals with a point",
      text(','), text('.'));
}

/// Says that a line has not as many fields as there are columns.
core::Error wrong_count(std::string_view line, char separator, std::size_t columns) {
  if (line.find('\r') != std::string_view::npos) {
    return syntax_error(
        fmt::format("{} holds a carriage return without a line feed; end lines with LF or CRLF",
                    quoted_text(line)));
  }
  const Cells fields = fields_of(line, separator);
  const std::size_t found = std::max<std::size_t>(filled_fields(fields), 1);
  const bool commas = separator == ',' && found == 2 * columns;
  return syntax_error(fmt::format("{} field{} in {}, {} expected ({} between them){}", found,
                                  found == 1 ? "" : "s", quoted_text(line), columns,
                                  name_of_separator(separator),
                                  commas ? "; " + both_readings(line) : ""));
}

core::Error at_line(core::Error error, std::string_view name, std::size_t line) {
  return error.at(fmt::format("{}:{}", name, line));
}

/// What is said where columns must be named.
constexpr std::string_view kNameColumns =
    "name the columns of x, y and z, counted from 1: --columns 2,3,4, in a plan source.columns";

/// Reads the rows of a table of which the layout is known.
class RowReader {
 public:
  RowReader(const TableLayout& layout, std::string_view name, const PointsOptions& options,
            const WantedColumns& wanted)
      : layout_(layout), name_(name), options_(options), wanted_(wanted) {}

  core::Result<TextTable> read() {
    Lines lines = layout_.rows;
    std::size_t bytes = 0;
    while (!lines.rest.empty()) {
      const std::string_view line = lines.take();
      if (holds_no_row(line)) continue;
      if (row(line)) {
        if (table_.rows.empty()) bytes = line.size() + 1;
        if (auto full = keep(lines, bytes)) return core::fail(*std::move(full));
        continue;
      }
      auto error = explain(line);
      if (!error) error = syntax_error(fmt::format("{} cannot be read", quoted_text(line)));
      error = at_line(*std::move(error), name_, lines.number);
      if (!no_value_) return core::fail(*std::move(error));
      if (!first_without_) first_without_ = std::move(error);
      ++table_.left_out;
    }
    return finish(lines);
  }

 private:
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
    for (std::size_t i = 0; i < layout_.roles.size(); ++i) {
      if (i > 0 && separator != ' ') {
        if (at == end || *at != separator) return false;
        ++at;
        skip_blanks();
      } else if (at == end) {
        return false;
      }
      const Role role = layout_.roles[i];
      const bool quoted = at != end && *at == '"' && std::find(at + 1, end, '"') != end;
      if (!quoted && role <= Role::kLayer) {
        double& value = role == Role::kLayer ? layer_ : values_[static_cast<Eigen::Index>(role)];
        const auto [stop, problem] = read_number(at, end, decimal, value);
        if (problem != std::errc() || !core::is_measurable(value)) return false;
        at = stop;
        if (separator == ' ' && at != end && *at != ' ' && *at != '\t') return false;
      } else {
        const char* stop = quoted ? std::find(at + 1, end, '"') : at;
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
      feature_ = field;
      return !field.empty();
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
      if (role > Role::kZ || take(role, fields[i])) continue;
      auto error = explain_number(fields[i], static_cast<std::size_t>(role));
      if (!has_no_value(fields[i])) return error;
      if (!without) without = std::move(error);
    }
    no_value_ = without.has_value();
    return without;
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
    if (layout_.announced && *layout_.announced != all) {
      return core::fail(at_line(
          syntax_error(fmt::format("the line above the rows announces {} of them, {} follow: is "
                                   "the file cut off?",
                                   *layout_.announced, all)),
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
      return core::fail(Code::kMissingKey,
                        fmt::format("the file holds the features {}; choose one by feature, as {}",
                                    other_names(), quoted_text(table_.feature)),
                        std::string(name_));
    }
    table_.dimensions = layout_.has(Role::kZ) ? 3 : 2;
    table_.unit = layout_.unit;
    table_.read = fmt::format(
        "{}, decimal {}, {}", name_of_separator(layout_.notation.separator),
        layout_.notation.decimal == '.' ? "point" : "comma",
        fmt::join(layout_.names.begin(), layout_.names.begin() + table_.dimensions, " "));
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
  TextTable table_;
  std::size_t count_ = 0;
  std::map<std::string_view, std::size_t> others_;
  std::optional<core::Error> first_without_;  ///< Of a row without values.
  bool no_value_ = false;
  Eigen::Vector3d values_ = Eigen::Vector3d::Zero();
  double layer_ = 0.0;
  std::string_view feature_;
};

/// Finds out how a file is written.
class Finder {
 public:
  Finder(std::string_view text, std::string_view name, const PointsOptions& options,
         const WantedColumns& wanted)
      : text_(text), name_(name), options_(options), wanted_(wanted) {
    collect();
  }

  /// The layouts to try, the best one first.
  core::Result<std::vector<TableLayout>> find() {
    std::optional<core::Error> fault;
    for (const bool comment : {false, true}) {
      for (std::size_t k = 0; k < lines_.size(); ++k) {
        if (lines_[k].comment != comment) continue;
        for (const char separator : {'\t', ';', '|', ',', ' '}) {
          const auto head = head_of(fields_of(lines_[k].text, separator), options_, wanted_);
          if (!head) continue;
          auto found = below(*head, k, separator);
          if (found) return found;
          const bool certain = !comment || found.error().code == Code::kUnits;
          if (!fault && certain) fault = found.error();
        }
      }
      if (fault) return core::fail(*std::move(fault));
    }
    return without_head();
  }

 private:
  void collect() {
    Lines lines(text_);
    std::size_t comments = 0;
    while (!lines.rest.empty() && lines_.size() - comments < kLookedAt) {
      Lines before = lines;
      std::string_view line = lines.take();
      const std::size_t first = line.find_first_not_of(" \t");
      if (first == std::string_view::npos || line.starts_with("sep=")) continue;
      const bool comment = line[first] == '#';
      if (comment && ++comments > kLookedAt) continue;
      if (comment || line.substr(first).starts_with("//")) {
        line.remove_prefix(std::min(line.find_first_not_of("#/ \t"), line.size()));
      }
      lines_.push_back({line, before, lines.number, comment});
    }
    last_line_ = std::max<std::size_t>(lines.number, 1);
  }

  [[nodiscard]] core::Error error_at(std::size_t line, std::string what) const {
    return at_line(syntax_error(std::move(what)), name_, line);
  }

  /// Lines from a place on that are no comments.
  [[nodiscard]] std::size_t next(std::size_t k) const {
    while (k < lines_.size() && lines_[k].comment) ++k;
    return k;
  }

  /// The number of rows that a line states above them.
  static std::optional<std::size_t> announced_by(std::string_view line) {
    const Cells fields = fields_of(line, ' ');
    std::size_t count = 0;
    const char* const end = fields[0].data() + fields[0].size();
    const auto [stop, problem] = std::from_chars(fields[0].data(), end, count);
    return fields.size() == 1 && problem == std::errc() && stop == end ? std::optional(count)
                                                                       : std::nullopt;
  }

  /// The unit that a line above the rows states, unless it contradicts another one.
  core::Result<void> take_units(TableLayout& layout, std::size_t end) const {
    for (std::size_t k = 0; k < end && !options_.unit && !wanted_.polar; ++k) {
      const auto unit = unit_in_text(lines_[k].text);
      if (!unit) continue;
      if (layout.unit && layout.unit != unit) {
        return core::fail(at_line({Code::kUnits,
                                   fmt::format("the file says {} and {}: give --unit, in a plan "
                                               "source.unit",
                                               name_of(*layout.unit), name_of(*unit)),
                                   {}},
                                  name_, lines_[k].number));
      }
      layout.unit = unit;
    }
    return {};
  }

  /// How well rows fit: (rows, numbers, fractions).
  using Score = std::tuple<std::size_t, std::size_t, std::size_t>;
  [[nodiscard]] Score score(const std::vector<Role>& roles, Notation notation,
                            std::size_t from) const {
    Score out;
    for (std::size_t k = next(from); k < lines_.size(); k = next(k + 1)) {
      const Cells fields = fields_of(lines_[k].text, notation.separator);
      if (!agrees(fields, roles.size())) continue;
      ++std::get<0>(out);
      for (std::size_t i = 0; i < roles.size(); ++i) {
        if (roles[i] > Role::kZ) continue;
        const Numeric kind = numeric(fields[i], notation.decimal);
        std::get<1>(out) += kind.number ? 1 : 0;
        std::get<2>(out) += kind.fraction ? 1 : 0;
      }
    }
    return out;
  }

  core::Result<std::vector<TableLayout>> below(const Head& head, std::size_t k,
                                               char separator) const {
    if (head.fault) return core::fail(at_line(*head.fault, name_, lines_[k].number));
    TableLayout layout{{separator, '.'}, head.roles, head.names, head.unit};
    std::size_t first = next(k + 1);
    const auto text = [&] { return first < lines_.size() ? lines_[first].text : ""; };
    if (const auto unit = unit_of_row(fields_of(text(), separator))) {
      if (!layout.unit) layout.unit = unit;
      first = next(first + 1);
    }
    if (next(first + 1) < lines_.size()) layout.announced = announced_by(text());
    if (layout.announced) first = next(first + 1);
    if (first == lines_.size()) {  // RowReader finds no row
      layout.rows.number = last_line_;
      return std::vector<TableLayout>{layout};
    }
    layout.rows = lines_[first].before;
    std::vector<Notation> fitting;
    const auto fits = [&](Notation d) {
      return agrees(fields_of(lines_[first].text, d.separator), head.roles.size());
    };
    for (const bool own : {true, false}) {
      for (const Notation d : kNotations) {
        if (fitting.empty() || fitting.front().separator == d.separator) {
          if ((d.separator == separator) == own && fits(d)) fitting.push_back(d);
        }
      }
    }
    if (fitting.empty()) {
      return core::fail(
          at_line(wrong_count(text(), separator, head.roles.size()), name_, lines_[first].number));
    }
    std::ranges::stable_sort(fitting, std::greater(),
                             [&](Notation d) { return score(head.roles, d, first); });
    TRY_DO(check_above(k, head.roles, fitting.front()));
    TRY_DO(take_units(layout, first));
    std::vector<TableLayout> out;
    for (const Notation d : fitting) {
      out.push_back(layout);
      out.back().notation = d;
    }
    return out;
  }

  /// Refuses rows above the head, which would be lost.
  [[nodiscard]] core::Result<void> check_above(std::size_t head, const std::vector<Role>& roles,
                                               Notation notation) const {
    for (std::size_t k = next(0); k < head; k = next(k + 1)) {
      const Cells fields = fields_of(lines_[k].text, notation.separator);
      bool row = agrees(fields, roles.size());
      for (std::size_t i = 0; row && i < roles.size(); ++i) {
        row = roles[i] > Role::kZ || numeric(fields[i], notation.decimal).number;
      }
      if (row) {
        return core::fail(error_at(lines_[k].number,
                                   fmt::format("{} stands above the head line in line {}; rows "
                                               "follow the head",
                                               quoted_text(lines_[k].text), lines_[head].number)));
      }
    }
    return {};
  }

  /// A table that begins in some line without a head.
  struct Found {
    Notation notation;
    std::size_t first = 0;
    std::vector<std::size_t> numbers;  ///< Columns of numbers in the first row.
    std::size_t columns = 0;
    Score score;
  };

  /// "5;2": several numbers in one field.
  static bool is_glued(std::string_view field) {
    return field.find_first_of("0123456789") != std::string_view::npos &&
           field.find_first_not_of("0123456789+-.,;| \teE") == std::string_view::npos;
  }

  [[nodiscard]] std::optional<Found> table_in(Notation notation, std::size_t least) const {
    Found out{notation, 0, {}, 0, {}};
    for (std::size_t k = next(0); k < lines_.size(); k = next(k + 1)) {
      const Cells fields = fields_of(lines_[k].text, notation.separator);
      out.numbers.clear();
      bool enough = true;
      for (std::size_t i = 0; i < fields.size(); ++i) {
        const bool number = numeric(fields[i], notation.decimal).number;
        if (number) out.numbers.push_back(i);
        enough = enough && (number || !options_.columns.empty() || !is_glued(fields[i]));
      }
      enough = enough && out.numbers.size() >= least;
      for (const std::string& column : options_.columns) {
        const auto place = place_of_column(column);
        enough = enough && place && std::ranges::find(out.numbers, *place) != out.numbers.end();
      }
      if (!enough) continue;
      out.first = k;
      out.columns = filled_fields(fields);
      std::vector<Role> roles(out.columns, Role::kNone);
      for (const std::size_t place : out.numbers) roles[place] = Role::kX;
      out.score = score(roles, notation, k);
      return out;
    }
    return std::nullopt;
  }

  core::Result<std::vector<TableLayout>> without_head() const {
    std::optional<Found> best;
    for (std::size_t least = 3; least >= 2 && !best; --least) {
      for (const Notation notation : kNotations) {
        const auto found = wanted_.polar ? std::nullopt : table_in(notation, least);
        if (found && (!best || found->score > best->score)) best = found;
      }
    }
    const bool empty = std::ranges::all_of(lines_, [](const Line& line) { return line.comment; });
    if (empty) {
      return core::fail(
          at_line({Code::kNoPoints,
                   fmt::format("the file {}; a header line {} and a row a point are expected",
                               text_.empty() ? "is empty" : "holds only comments and blank lines",
                               wanted_.list),
                   {}},
                  name_, last_line_));
    }
    if (!best) {
      const Line& line = lines_[next(0)];
      for (const std::string& column : options_.columns) {
        if (place_of_column(column)) continue;
        return core::fail(error_at(line.number, fmt::format("no line above the rows names a column "
                                                            "{}",
                                                            quoted_text(column))));
      }
      return core::fail(error_at(
          line.number, fmt::format("{} names no columns {}, and no row of two or three numbers "
                                   "follows in the first {} lines",
                                   quoted_text(line.text), wanted_.list, kLookedAt)));
    }
    TRY(const auto places, places_of(*best));
    TableLayout layout{best->notation, std::vector<Role>(best->columns, Role::kNone), {}, {}};
    for (std::size_t k = 0; k < places.size(); ++k) {
      layout.roles[places[k]] = static_cast<Role>(k);
      layout.names.at(k) = fmt::format("{}{}", k == 0 ? "columns " : "", places[k] + 1);
    }
    layout.rows = lines_[best->first].before;
    if (best->first > 0) layout.announced = announced_by(lines_[best->first - 1].text);
    TRY_DO(take_units(layout, best->first));
    std::vector<TableLayout> out = {layout};
    layout.notation.decimal = layout.notation.decimal == '.' ? ',' : '.';
    out.push_back(layout);
    return out;
  }

  /// The columns of x, y and z of a table without a head.
  [[nodiscard]] core::Result<std::vector<std::size_t>> places_of(const Found& found) const {
    std::vector<std::size_t> out;
    for (const std::string& column : options_.columns) out.push_back(*place_of_column(column));
    if (!out.empty()) return out;
    const Line& first = lines_[found.first];
    std::size_t above = 0;
    for (std::size_t k = next(0); k < found.first; k = next(k + 1)) {
      const Cells fields = fields_of(lines_[k].text, found.notation.separator);
      const bool names = fields.size() > 1 && agrees(fields, found.columns) &&
                         filled_fields(fields) == found.columns;
      above += announced_by(lines_[k].text) ? 0 : 1;
      if (names || above > 2) {
        return core::fail(
            error_at(lines_[k].number,
                     fmt::format("{} names none of the columns {}; {}", quoted_text(lines_[k].text),
                                 wanted_.list, kNameColumns)));
      }
    }
    if (counts(found)) {
      return core::fail(error_at(
          first.number, fmt::format("column {} counts the rows, and no head line says what the "
                                    "columns are; {}",
                                    found.numbers[0] + 1, kNameColumns)));
    }
    const auto is = [&](std::string_view ending) { return name_.ends_with(ending); };
    const bool xyz =
        is(".xyz") || is(".XYZ") || is(".asc") || is(".ASC") || is(".pts") || is(".PTS");
    if (found.numbers.size() > 3 && !xyz) {
      const bool commas = found.notation.separator == ',' && found.numbers.size() % 2 == 0;
      return core::fail(error_at(
          first.number, fmt::format("{} has {} columns of numbers and no head line; {}{}",
                                    quoted_text(first.text), found.numbers.size(), kNameColumns,
                                    commas ? "; " + both_readings(first.text) : "")));
    }
    out = found.numbers;
    out.resize(std::min<std::size_t>(out.size(), 3));
    return out;
  }

  /// Whether the first column of numbers is 0, 1, 2, ... or 1, 2, 3, ...
  [[nodiscard]] bool counts(const Found& found) const {
    std::size_t rows = 0;
    double before = 0.0;
    for (std::size_t k = found.first; k < lines_.size(); k = next(k + 1)) {
      const Cells fields = fields_of(lines_[k].text, found.notation.separator);
      if (fields.size() <= found.numbers[0]) return false;
      const auto value = core::parse_number(fields[found.numbers[0]]);
      if (!value || (rows == 0 ? *value != 0.0 && *value != 1.0 : *value != before + 1.0)) {
        return false;
      }
      before = *value;
      ++rows;
    }
    return rows >= 3;
  }

  std::string_view text_;
  std::string_view name_;
  const PointsOptions& options_;
  const WantedColumns& wanted_;
  std::vector<Line> lines_;
  std::size_t last_line_ = 1;
};

}  // namespace

core::Result<TextTable> read_text_table(std::string_view text, std::string_view name,
                                        const PointsOptions& options, const WantedColumns& wanted) {
  TRY(const auto layouts, Finder(text, name, options, wanted).find());
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
