#include "record/points/internal/head.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "core/encodings.h"
#include "core/numbers.h"
#include "record/csv/internal/lines.h"
#include "record/points/internal/units.h"

namespace rondure::record {
namespace {

void append(std::uint32_t code, std::string& out) {
  const auto add = [&](std::uint32_t byte) { out += static_cast<char>(byte); };
  if (code < 0x80) return add(code);
  if (code < 0x800) {
    add(0xC0U | (code >> 6U));
  } else {
    if (code < 0x10000) {
      add(0xE0U | (code >> 12U));
    } else {
      add(0xF0U | (code >> 18U));
      add(0x80U | ((code >> 12U) & 0x3FU));
    }
    add(0x80U | ((code >> 6U) & 0x3FU));
  }
  add(0x80U | (code & 0x3FU));
}

std::string from_utf16(std::string_view bytes, bool little) {
  std::string out;
  out.reserve(bytes.size() / 2);
  const auto unit = [&](std::size_t i) -> std::uint32_t {
    const auto low = static_cast<unsigned char>(bytes[little ? i : i + 1]);
    const auto high = static_cast<unsigned char>(bytes[little ? i + 1 : i]);
    return low | (std::uint32_t{high} << 8U);
  };
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    std::uint32_t code = unit(i);
    if (code >= 0xD800 && code < 0xE000) {
      const std::uint32_t low = code < 0xDC00 && i + 3 < bytes.size() ? unit(i + 2) : 0;
      const bool pair = low >= 0xDC00 && low < 0xE000;
      code = pair ? 0x10000 + ((code - 0xD800) << 10U) + (low - 0xDC00) : 0xFFFD;
      if (pair) i += 2;
    }
    append(code, out);
  }
  return out;
}

std::string from_windows_1252(std::string_view bytes) {
  constexpr std::array<std::uint16_t, 32> kUpper = {
      0x20AC, 0xFFFD, 0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
      0x2039, 0x0152, 0xFFFD, 0x017D, 0xFFFD, 0xFFFD, 0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
      0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0xFFFD, 0x017E, 0x0178};
  std::string out;
  out.reserve(bytes.size() + bytes.size() / 8);
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    append(byte >= 0x80 && byte < 0xA0 ? kUpper.at(byte - 0x80U) : byte, out);
  }
  return out;
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    std::uint64_t eight = 0;
    if (text.size() >= sizeof(eight)) {
      std::memcpy(&eight, text.data(), sizeof(eight));
      if ((eight & 0x8080808080808080U) == 0) {
        text.remove_prefix(sizeof(eight));
        continue;
      }
    }
    const core::Utf8Character c = core::next_character(text);
    if (!c.valid) return false;
    text.remove_prefix(c.bytes);
  }
  return true;
}

/// Without the sign that ended a text in memory. More of them are no text.
std::string_view without_end(std::string_view bytes) {
  return bytes.substr(0, bytes.size() - (bytes.ends_with('\0') ? 1 : 0));
}

}  // namespace

std::string_view DecodedText::text(std::string_view bytes) const {
  std::string_view out = encoding.empty() ? without_end(bytes) : converted;
  while (out.ends_with('\x1a')) out.remove_suffix(1);
  for (int mark = 0; mark < 2; ++mark) out = without_byte_order_mark(out);  // as two programs wrote
  return out;
}

core::Result<DecodedText> decode_text(std::string_view bytes, std::string_view name) {
  using namespace std::string_view_literals;
  if (bytes.starts_with("\xff\xfe\0\0"sv) || bytes.starts_with("\0\0\xfe\xff"sv)) {
    return core::fail(core::Code::kSyntax, "the file is saved as UTF-32; save it as UTF-8",
                      fmt::format("{}:1", name));
  }
  const std::string_view begin = bytes.substr(0, 4096);
  std::array<std::size_t, 2> zeros = {};  // at even and at odd places
  for (std::size_t i = 0; i < begin.size(); ++i) zeros.at(i % 2) += begin[i] == '\0' ? 1 : 0;
  const bool marked = is_utf16(bytes);
  if (marked || 4 * (zeros[0] + zeros[1]) > begin.size()) {
    const bool little = marked ? bytes.starts_with('\xff') : zeros[1] > zeros[0];
    std::string text = from_utf16(bytes.substr(marked ? 2 : 0), little);
    if (text.find('\0') == std::string::npos) {
      return DecodedText{std::move(text), little ? "UTF-16 LE"sv : "UTF-16 BE"sv};
    }
  }
  if (const std::size_t zero = without_end(bytes).find('\0'); zero != std::string_view::npos) {
    const auto line = 1 + std::ranges::count(bytes.substr(0, zero), '\n');
    return core::fail(core::Code::kSyntax,
                      "the line holds a NUL byte; plain text is expected, saved as UTF-8",
                      fmt::format("{}:{}", name, line));
  }
  if (is_utf8(bytes)) return DecodedText{};
  return DecodedText{from_windows_1252(bytes), "Windows-1252"};
}

namespace {

/// NameWords beside x, y and z that say: as measured. One that says nominal or deviation is another
/// column.
constexpr auto kMeasuredWords = std::to_array<std::string_view>(
    {"ist",      "istwert",  "actual",      "act",          "measured",   "meas",     "mess",
     "messwert", "gemessen", "mmt",         "koordinate",   "coordinate", "coord",    "koord",
     "wert",     "value",    "val",         "position",     "pos",        "achse",    "axis",
     "real",     "mesure",   "mesur\u00e9", "mesur\u00e9e", "medido",     "misurato", "实测",
     "实测值",   "坐标",     "座標",        "測定値"});
constexpr auto kLayerWords =
    std::to_array<std::string_view>({"layer", "layers", "schicht", "ebene", "schnitt", "section",
                                     "couche", "strato", "capa", "层"});
/// NameWords of a column that names the feature of each row, where it does so for several rows.
constexpr auto kElementWords = std::to_array<std::string_view>({"group",
                                                                "groupname",
                                                                "gruppe",
                                                                "groupe",
                                                                "grupo",
                                                                "gruppo",
                                                                "collection",
                                                                "element",
                                                                "elementname",
                                                                "featurename",
                                                                "featureid",
                                                                "merkmal",
                                                                "merkmalname",
                                                                "élément",
                                                                "elemento",
                                                                "caractéristique",
                                                                "característica",
                                                                "caratteristica",
                                                                "元素",
                                                                "要素",
                                                                "特征"});
bool is_measured(std::string_view word) { return is_one_of(kMeasuredWords, word); }

/// "x", "xactual", "posx": the coordinate that a word names.
std::optional<Role> coordinate(std::string_view word) {
  const auto role = [](char letter) { return static_cast<Role>(letter - 'x'); };
  const auto letter = [](char c) { return c >= 'x' && c <= 'z'; };
  if (word.empty()) return std::nullopt;
  const bool alone = word.size() == 1;
  if (letter(word.front()) && (alone || is_measured(word.substr(1)))) return role(word.front());
  if (letter(word.back()) && is_measured(word.substr(0, word.size() - 1))) return role(word.back());
  return std::nullopt;
}

struct Column {
  Role role = Role::kNone;
  bool element = false;  ///< A feature by one of kElementWords.
  std::optional<LengthUnit> unit = {};
  std::string unknown_unit = {};
};

/// Reads "X-Ist [mm]".
Column column_of(std::string_view field) {
  Column out;
  const std::size_t open = field.find_first_of("[(");
  std::string_view bracket;
  std::string_view outside = field;
  if (open != std::string_view::npos) {
    bracket = field.substr(open);
    outside = field.substr(0, open);
  }
  NameWords words = words_in(outside);
  for (const std::string& word : words_in(bracket)) {
    if (const auto unit = unit_named(word)) {
      out.unit = unit;
    } else if (!is_measured(word)) {
      out.unknown_unit = word;
    }
  }
  while (words.size() > 1 && unit_named(words.back()) && !out.unit) {
    out.unit = unit_named(words.back());
    words.pop_back();
    if (words.size() > 1 && words.back() == "in") words.pop_back();  // "X in mm"
  }
  std::optional<Role> role;
  for (const std::string& word : words) {
    const auto named = coordinate(word);
    if ((named && role) || (!named && !is_measured(word))) {
      role.reset();
      break;
    }
    if (named) role = named;
  }
  std::string whole;
  for (const std::string& word : words) whole += word;
  out.element = is_one_of(kElementWords, whole);
  if (role) {
    out.role = *role;
  } else if (whole == "feature" || out.element) {
    out.role = Role::kFeature;
  } else if (is_one_of(kLayerWords, whole)) {
    out.role = Role::kLayer;
  } else if (names_unit(whole)) {
    out.role = Role::kUnit;
  }
  return out;
}

/// A column of a profile: exactly its name.
Column polar_column(std::string_view field) {
  return {field == "theta_deg" ? Role::kX : field == "r_um" ? Role::kY : Role::kNone};
}

core::Error fault_of(core::Code code, std::string what) { return {code, std::move(what), {}}; }

/// The place of a named column, as it stands in the file or in other capitals.
std::optional<std::size_t> place_named(std::string_view name,
                                       const std::vector<std::string_view>& fields) {
  if (const auto place = place_of_column(name)) return place;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (lower_case(fields[i]) == lower_case(name)) return i;
  }
  return std::nullopt;
}

/// ": --columns 1,2,3 or 4,5,6": columns that may be x, y and z where their names stand twice.
std::string sets_of(const std::vector<Column>& columns) {
  std::string out;
  for (std::size_t set = 0;; ++set) {
    std::string numbers;
    std::size_t axes = 0;
    for (const Role role : {Role::kX, Role::kY, Role::kZ}) {
      std::size_t before = 0;
      for (std::size_t i = 0; i < columns.size(); ++i) {
        if (columns[i].role != role || before++ != set) continue;
        numbers += fmt::format("{}{}", axes++ == 0 ? "" : ",", i + 1);
      }
    }
    if (axes < 2) return out;
    out += fmt::format("{}{}", out.empty() ? ": --columns " : " or ", numbers);
  }
}

}  // namespace

std::optional<Head> head_of(const std::vector<std::string_view>& fields,
                            const PointsOptions& options, const WantedColumns& wanted) {
  const std::size_t count = filled_fields(fields);
  std::vector<Column> columns;
  std::size_t coordinates = 0;
  for (std::size_t i = 0; i < count; ++i) {
    columns.push_back(wanted.polar ? polar_column(fields[i]) : column_of(fields[i]));
    coordinates += columns.back().role <= Role::kZ ? 1 : 0;
  }
  // "X,Y,5.00,275.00,...": the frame of a grid of heights
  const auto is_number = [](std::string_view field) {
    return core::parse_number(field).has_value();
  };
  if (std::ranges::any_of(fields, is_number)) coordinates = 0;
  if (!options.columns.empty()) {
    bool named = false;
    for (Column& column : columns) {
      if (column.role <= Role::kZ) column.role = Role::kNone;
    }
    for (std::size_t k = 0; k < options.columns.size(); ++k) {
      const auto place = place_named(options.columns[k], fields);
      if (!place || *place >= count) return std::nullopt;
      named = named || !place_of_column(options.columns[k]);
      columns[*place].role = static_cast<Role>(k);
    }
    if (named) coordinates = 2;
  }
  if (coordinates < 2) return std::nullopt;
  Head out;
  const auto names_feature = [](const Column& column) {
    return column.role == Role::kFeature && !column.element;
  };
  const bool named_feature = std::ranges::any_of(columns, names_feature);
  std::array<bool, 5> seen{};
  for (std::size_t i = 0; i < count; ++i) {
    Column& column = columns[i];
    const bool feature = column.role == Role::kFeature;
    if (feature && column.element) {  // the rows show whether it names features
      if (!named_feature) out.elements.push_back(i);
      column.role = Role::kNone;
    }
    if (column.role == Role::kUnit && options.unit) column.role = Role::kNone;
    out.roles.push_back(column.role);
    if (column.role >= Role::kUnit) continue;
    const auto role = static_cast<std::size_t>(column.role);
    if (std::exchange(seen.at(role), true) && !out.fault) {
      out.fault = fault_of(
          core::Code::kSyntax,
          fmt::format("column {} stands twice; {}",
                      quoted_text(role < 3 ? wanted.names.at(role) : fields[i]),
                      role < 3 ? fmt::format("name the columns to read{}, in a plan source.columns",
                                             sets_of(columns))
                               : std::string("one of them is expected")));
    }
    if (role >= 3) continue;
    out.names.at(role) = core::printable(fields[i].substr(0, 40));
    if (!column.unit && !column.unknown_unit.empty() && !options.unit && !out.fault) {
      out.fault = fault_of(core::Code::kUnits,
                           fmt::format("{} is in the unknown unit {}; known are mm, um, cm, m and "
                                       "inch: give --unit, in a plan source.unit",
                                       quoted_text(fields[i]), quoted_text(column.unknown_unit)));
    }
    if (column.unit && out.unit && column.unit != out.unit && !out.fault) {
      out.fault = fault_of(core::Code::kUnits, columns_differ(*out.unit, *column.unit));
    }
    if (column.unit) out.unit = column.unit;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    if (seen.at(i) || out.fault) continue;
    out.fault =
        fault_of(core::Code::kSyntax, fmt::format("column \"{}\" is missing; the columns are {}",
                                                  wanted.names.at(i), wanted.list));
  }
  return out;
}

}  // namespace rondure::record
