#include "record/points/internal/table_layout.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <functional>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "core/encodings.h"
#include "core/numbers.h"
#include "record/csv/internal/lines.h"
#include "record/points/internal/number_rows.h"
#include "record/points/internal/row_names.h"

namespace rondure::record {
namespace {

using core::Code;

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
constexpr std::size_t kLookedAt = 200;     ///< Lines that show how a file is written,
constexpr std::size_t kComments = 10'000;  ///< and comments above and among them.

/// Whether a field is one number of a notation; a fraction counts for more.
struct Numeric {
  bool number = false;
  bool fraction = false;
  double value = 0.0;
};
Numeric numeric(std::string_view field, char decimal) {
  double value = 0.0;
  const char* const end = field.data() + field.size();
  const auto [stop, problem] = read_number(field.data(), end, decimal, value);
  const bool number =
      !field.empty() && problem == std::errc() && stop == end && std::isfinite(value);
  return {number, number && field.find(decimal) != std::string_view::npos, value};
}

/// A line at the begin of a file that is not empty.
struct Line {
  std::string_view text;  ///< Of a comment without its sign.
  Lines before;           ///< The file from this line on.
  std::size_t number;
  bool comment;
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
    if (const std::size_t k = next(0); k < lines_.size() && begins_off(lines_[k].text)) {
      return core::fail(error_at(lines_[k].number, "the file is an OFF mesh; convert it to PLY"));
    }
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
    std::size_t others = 0;
    while (!lines.rest.empty() && others < kLookedAt) {
      Lines before = lines;
      std::string_view line = lines.take();
      const std::size_t first = line.find_first_not_of(" \t");
      if (first == std::string_view::npos || line.starts_with("sep=")) continue;
      const bool comment = line[first] == '#';
      if (comment && ++comments > kComments) continue;
      others += comment ? 0 : 1;
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

  /// "OFF", "COFF", "STCN4nOFF": the counts of such a mesh would be taken for its first point.
  static bool begins_off(std::string_view line) {
    const std::string_view word = fields_of(line, ' ').front();
    return word.ends_with("OFF") && word.find_first_not_of("STCN4nOF") == std::string_view::npos;
  }

  /// Lines from a place on that are no comments.
  [[nodiscard]] std::size_t next(std::size_t k) const {
    while (k < lines_.size() && lines_[k].comment) ++k;
    return k;
  }

  /// The number of rows that a line states above them.
  static std::optional<std::size_t> announced_by(std::string_view line) {
    const Cells fields = fields_of(line, ' ');
    return fields.size() == 1 ? count_of(fields[0]) : std::nullopt;
  }

  /// What the lines above the rows state: the unit, unless it contradicts another one, or is the
  /// only one and not understood, and the number of points.
  core::Result<void> take_texts(TableLayout& layout, std::size_t end) const {
    for (std::size_t k = 0; k < end; ++k) {
      layout.at_least = std::max(layout.at_least, points_in_text(lines_[k].text));
      if (auto feature = feature_of_heading(lines_[k].text); !feature.empty()) {
        layout.heading = std::move(feature);
      }
    }
    if (options_.unit || wanted_.polar) return {};
    for (std::size_t k = 0; k < end; ++k)
      layout.units.take(lines_[k].text, name_, lines_[k].number);
    const auto fault = layout.units.fault();
    if (!fault || (layout.has(Role::kUnit) && !layout.units.contradiction)) return {};
    return core::fail(*fault);
  }

  /// Takes the units of x, y and z from a row that holds units: ";mm;mm;mm".
  /// @return  Whether the row is one; kUnits where they differ.
  core::Result<bool> take_unit_row(TableLayout& layout, const Cells& fields,
                                   std::size_t number) const {
    std::optional<LengthUnit> found;
    const bool alone = filled_fields(fields) == 1;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const bool coordinate = i < layout.roles.size() && layout.roles[i] <= Role::kZ;
      if (fields[i].empty() || !(coordinate || alone)) continue;
      const auto unit = unit_of_field(fields[i]);
      if (!unit) return false;
      const LengthUnit other = found.value_or(layout.units.unit.value_or(*unit));
      if (unit != other) {
        return core::fail(at_line({Code::kUnits, columns_differ(other, *unit), {}}, name_, number));
      }
      found = unit;
    }
    if (found) layout.units.unit = found;
    return found.has_value();
  }

  /// A column of the rows from a line on.
  [[nodiscard]] ColumnText column(const TableLayout& layout, std::size_t place,
                                  std::size_t first) const {
    ColumnText out;
    for (std::size_t k = next(first); k < lines_.size(); k = next(k + 1)) {
      const Cells fields = fields_of(lines_[k].text, layout.notation.separator);
      if (agrees(fields, layout.roles.size())) out.push_back(fields[place]);
    }
    return out;
  }

  /// Takes what columns beside x, y and z say of the rows: their features, or their numbers.
  void take_names(TableLayout& layout, const Head& head, std::size_t first) const {
    const bool alone = !options_.columns.empty();  // those of x, y and z: all rows are one feature
    std::optional<std::size_t> last;
    for (const std::size_t place : head.elements) {  // "Collection, Group": the name has two parts
      if ((alone && options_.feature.empty()) || place > last.value_or(place) + 1) continue;
      if (!names_features(column(layout, place, first))) continue;
      layout.roles[place] = Role::kFeature;
      layout.elements = true;
      last = place;
    }
    for (std::size_t i = 0; i < layout.roles.size() && !alone; ++i) {
      if (layout.roles[i] != Role::kNone) continue;
      const ColumnText names = column(layout, i, first);
      const auto of_feature = [](std::string_view name) { return !feature_of_point(name).empty(); };
      if (!layout.has(Role::kFeature) && !names.empty() && std::ranges::all_of(names, of_feature)) {
        layout.roles[i] = Role::kFeature;
        layout.elements = layout.by_point = true;
      } else if (counts_rows(names)) {
        layout.roles[i] = Role::kCount;
      }
    }
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
    TableLayout layout{{separator, '.'}, head.roles, head.names, {head.unit}};
    std::size_t first = next(k + 1);
    const auto text = [&] { return first < lines_.size() ? lines_[first].text : ""; };
    if (first < lines_.size()) {
      TRY(const bool units,
          take_unit_row(layout, fields_of(text(), separator), lines_[first].number));
      if (units) first = next(first + 1);
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
      core::Error error = wrong_count(text(), separator, head.roles.size());
      if (filled_fields(fields_of(text(), separator)) == head.roles.size() + 1) {
        error.what += fmt::format("; where the first one is the name of the row, give --columns {}",
                                  column_numbers(head.roles, 1));
      }
      return core::fail(at_line(std::move(error), name_, lines_[first].number));
    }
    std::ranges::stable_sort(fitting, std::greater(),
                             [&](Notation d) { return score(head.roles, d, first); });
    const auto by_number = [](const std::string& column) {
      return place_of_column(column).has_value();
    };
    if (std::ranges::all_of(options_.columns, by_number)) {  // names show which line is the head
      TRY_DO(check_above(k, head.roles, fitting.front()));
    }
    layout.notation = fitting.front();
    take_names(layout, head, first);
    TRY_DO(take_texts(layout, first));
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
    const std::string_view word = fields_of(lines_[best->first].text, ' ').front();
    if (word == "v" || word == "vn" || word == "vt") {
      return core::fail(
          error_at(lines_[best->first].number, "the file is an OBJ mesh; save it as PLY or STL"));
    }
    TRY(const auto places, places_of(*best));
    TableLayout layout{best->notation, std::vector<Role>(best->columns, Role::kNone), {}, {}};
    for (std::size_t k = 0; k < places.size(); ++k) {
      layout.roles[places[k]] = static_cast<Role>(k);
      layout.names.at(k) = fmt::format("{}{}", k == 0 ? "columns " : "", places[k] + 1);
    }
    layout.rows = lines_[best->first].before;
    if (best->first > 0) layout.announced = announced_by(lines_[best->first - 1].text);
    TRY_DO(take_texts(layout, best->first));
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
    const NumberRows rows = rows_of(found);
    std::size_t above = 0;
    for (std::size_t k = next(0); k < found.first; k = next(k + 1)) {
      const Cells fields = fields_of(lines_[k].text, found.notation.separator);
      const bool names = fields.size() > 1 && agrees(fields, found.columns) &&
                         filled_fields(fields) == found.columns;
      above += announced_by(lines_[k].text) ? 0 : 1;
      if (names || above > 2) {
        const bool polar = names && is_polar(lines_[k].text);
        return core::fail(error_at(
            lines_[k].number,
            fmt::format(
                "{} names none of the columns {}; {}", quoted_text(lines_[k].text), wanted_.list,
                polar ? "these are polar coordinates: export x, y and z" : rows.name_columns())));
      }
    }
    if (rows.counts()) {
      return core::fail(error_at(
          first.number, fmt::format("column {} counts the rows, and no head line says what the "
                                    "columns are; {}",
                                    found.numbers[0] + 1, rows.name_columns())));
    }
    const auto is = [&](std::string_view ending) { return name_.ends_with(ending); };
    const bool cloud =
        is(".xyz") || is(".XYZ") || is(".asc") || is(".ASC") || is(".pts") || is(".PTS");
    if (!rows.begin_with_points(cloud)) {
      const bool commas = found.notation.separator == ',' && found.numbers.size() % 2 == 0;
      return core::fail(error_at(
          first.number, fmt::format("{} has {} columns of numbers and no head line; {}{}",
                                    quoted_text(first.text), found.numbers.size(),
                                    rows.name_columns(), commas ? both_readings(first.text) : "")));
    }
    out = found.numbers;
    out.resize(std::min<std::size_t>(out.size(), 3));
    return out;
  }

  [[nodiscard]] NumberRows rows_of(const Found& found) const {
    NumberRows out{found.numbers, std::vector<std::size_t>(found.numbers.size()), {}};
    for (std::size_t k = next(found.first); k < lines_.size(); k = next(k + 1)) {
      const Cells fields = fields_of(lines_[k].text, found.notation.separator);
      if (!agrees(fields, found.columns)) continue;
      std::vector<Numeric> row;
      for (const std::size_t place : found.numbers) {
        row.push_back(numeric(fields[place], found.notation.decimal));
      }
      if (!std::ranges::all_of(row, &Numeric::number)) continue;
      std::vector<double>& values = out.rows.emplace_back();
      for (std::size_t i = 0; i < row.size(); ++i) {
        out.decimals[i] += row[i].fraction ? 1 : 0;
        values.push_back(row[i].value);
      }
    }
    return out;
  }

  std::string_view text_;
  std::string_view name_;
  const PointsOptions& options_;
  const WantedColumns& wanted_;
  std::vector<Line> lines_;
  std::size_t last_line_ = 1;
};

}  // namespace

core::Result<std::vector<TableLayout>> find_layouts(std::string_view text, std::string_view name,
                                                    const PointsOptions& options,
                                                    const WantedColumns& wanted) {
  return Finder(text, name, options, wanted).find();
}

std::string column_numbers(const std::vector<Role>& roles, std::size_t more) {
  std::string out;
  for (const Role role : {Role::kX, Role::kY, Role::kZ}) {
    const auto at = std::ranges::find(roles, role);
    if (at == roles.end()) continue;
    out += fmt::format("{}{}", out.empty() ? "" : ",",
                       at - roles.begin() + 1 + static_cast<std::ptrdiff_t>(more));
  }
  return out;
}

}  // namespace rondure::record
