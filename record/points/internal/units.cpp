#include "record/points/internal/units.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "record/csv/internal/lines.h"
#include "record/points/internal/fields.h"

namespace rondure::record {
namespace {

constexpr auto kUnitWords = std::to_array<std::pair<std::string_view, LengthUnit>>(
    {{"mm", LengthUnit::kMm},          {"millimeter", LengthUnit::kMm},
     {"millimetre", LengthUnit::kMm},  {"millimeters", LengthUnit::kMm},
     {"millimetres", LengthUnit::kMm}, {"um", LengthUnit::kUm},
     {"\u00b5m", LengthUnit::kUm},     {"\u03bcm", LengthUnit::kUm},
     {"micron", LengthUnit::kUm},      {"microns", LengthUnit::kUm},
     {"micrometer", LengthUnit::kUm},  {"mikrometer", LengthUnit::kUm},
     {"cm", LengthUnit::kCm},          {"m", LengthUnit::kM},
     {"meter", LengthUnit::kM},        {"metre", LengthUnit::kM},
     {"meters", LengthUnit::kM},       {"inch", LengthUnit::kInch},
     {"inches", LengthUnit::kInch},    {"zoll", LengthUnit::kInch},
     {"in", LengthUnit::kInch},        {"\u2033", LengthUnit::kInch},
     {"pulgada", LengthUnit::kInch},   {"pulgadas", LengthUnit::kInch},
     {"polegada", LengthUnit::kInch},  {"polegadas", LengthUnit::kInch},
     {"pouce", LengthUnit::kInch},     {"pouces", LengthUnit::kInch},
     {"pollice", LengthUnit::kInch},   {"pollici", LengthUnit::kInch},
     {"cal", LengthUnit::kInch},       {"cale", LengthUnit::kInch},
     {"tum", LengthUnit::kInch},       {"英寸", LengthUnit::kInch},
     {"毫米", LengthUnit::kMm},        {"微米", LengthUnit::kUm},
     {"厘米", LengthUnit::kCm},        {"milímetro", LengthUnit::kMm},
     {"milímetros", LengthUnit::kMm},  {"millimètre", LengthUnit::kMm},
     {"millimètres", LengthUnit::kMm}, {"millimetro", LengthUnit::kMm},
     {"millimetri", LengthUnit::kMm},  {"milimetr", LengthUnit::kMm},
     {"milimetry", LengthUnit::kMm}});
/// NameWords that announce a unit in the text above a table, those that may stand between, and
/// those that show that "in" was the unit: "Units: in, deg".
constexpr auto kUnitNames = std::to_array<std::string_view>(
    {"unit", "units", "einheit", "einheiten", "maßeinheit", "masseinheit", "längeneinheit", "单位",
     "unidad", "unidades", "unidade", "unité", "unités", "unità", "jednostka", "jednostki", "enhet",
     "eenheid"});
constexpr auto kMeasures = std::to_array<std::string_view>({"dimensions", "coordinates", "values"});
constexpr auto kBetween = std::to_array<std::string_view>(
    {"in", "is", "are", "of", "for", "all", "ist", "sind", "length", "linear", "used", "system",
     "measure", "measurement", "measurements"});
/// Words that speak of inches wherever they stand: "Measured in inches", "G20".
constexpr auto kInchWords = std::to_array<std::string_view>(
    {"inch", "inches", "zoll", "imperial", "g20", "pouce", "pouces", "pulgada", "pulgadas",
     "polegada", "polegadas", "pollice", "pollici", "дюйм", "дюймы", "дюймах", "英寸", "インチ",
     "\u2033"});
/// Words that speak of inches beside one of kUnitNames: "English units".
constexpr auto kInchSystems = std::to_array<std::string_view>({"english", "customary", "uscs"});
/// Words of a title that are units, too.
constexpr auto kOtherMeanings = std::to_array<std::string_view>({"cal", "cale", "tum"});
/// NameWords of "Number of points: 180".
constexpr auto kPointWords = std::to_array<std::string_view>(
    {"points", "punkte", "messpunkte", "pts", "puntos", "punti", "点数"});
constexpr auto kCountWords =
    std::to_array<std::string_view>({"number", "no", "num", "count", "total", "anzahl", "nombre",
                                     "número", "numero", "of", "der", "de", "di", "measured"});
constexpr auto kAngles =
    std::to_array<std::string_view>({"deg", "degree", "degrees", "rad", "radian", "grad"});

constexpr auto kAngleNames = std::to_array<std::string_view>(
    {"angle", "winkel", "phi", "theta", "azimuth", "ángulo", "ângulo", "angolo", "角度"});
constexpr auto kRadiusNames =
    std::to_array<std::string_view>({"radius", "radii", "radial", "r", "rho", "rayon", "半径"});

bool is_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || static_cast<unsigned char>(c) >= 0x80;
}

/// The place of a sign of inches: `X (")`, `Unit: "`. Quotes around words come in pairs.
std::size_t inch_sign(std::string_view text) {
  constexpr auto kNone = std::string_view::npos;
  const std::size_t at = text.find('"');
  if (at == kNone || at == 0 || text.find('"', at + 1) != kNone) return kNone;
  const bool alone =
      std::string_view(" \t([:=").find(text[at - 1]) != kNone &&
      (at + 1 == text.size() || std::string_view(" \t)]").find(text[at + 1]) != kNone);
  return alone ? at : kNone;
}

/// "unit", "LengthUnit", "dimensions".
bool announces_unit(std::string_view word) {
  const auto ends = [&](std::string_view name) { return word.ends_with(name); };
  return std::ranges::any_of(kUnitNames, ends) || is_one_of(kMeasures, word);
}

/// The units of a line that holds nothing else: "in,in,in", "# in mm".
std::vector<LengthUnit> units_alone(NameWords words) {
  const auto is_in = [](std::string_view word) { return word == "in"; };
  if (!std::ranges::all_of(words, is_in)) std::erase_if(words, is_in);
  std::vector<LengthUnit> out;
  for (const std::string& word : words) {
    const auto unit = is_one_of(kOtherMeanings, word) ? std::nullopt : unit_named(word);
    if (!unit) return {};
    out.push_back(*unit);
  }
  return out;
}

/// Whether a line that unit_in_text() does not understand may state a unit all the same: it speaks
/// of inches, or is "Units: thousandths".
bool may_state_unit(std::string_view line) {
  NameWords words = words_in(line);
  const auto has = [&](const auto& list) {
    return std::ranges::any_of(words, [&](std::string_view word) { return is_one_of(list, word); });
  };
  if (has(kInchWords) || (has(kUnitNames) && has(kInchSystems))) return true;
  const std::vector<LengthUnit> alone = units_alone(words);
  if (!alone.empty()) return alone.size() > 1 || alone[0] != LengthUnit::kMm;
  // "measured in in"; PC-DMIS writes inches where METRIC does not stand beside XYZIJK
  if (std::ranges::adjacent_find(
          words, [](std::string_view a, std::string_view b) { return a == "in" && b == "in"; }) !=
          words.end() ||
      (!words.empty() && words[0] == "xyzijk")) {
    return true;
  }
  // "Units: thousandths", but neither "Unit: 3" nor "Units: degrees"
  const bool stated = line.find_first_of(":=") != std::string_view::npos;
  if (!stated || words.empty() || !is_one_of(kUnitNames, words[0])) return false;
  std::erase_if(words, [](std::string_view word) {
    return is_one_of(kUnitNames, word) || is_one_of(kBetween, word);
  });
  const auto is_no_unit = [](std::string_view word) {
    return is_one_of(kAngles, word) || word.find_first_of("0123456789") != std::string_view::npos;
  };
  const auto is_unit = [](std::string_view word) { return unit_named(word).has_value(); };
  return (words.size() == 1 || std::ranges::any_of(words, is_unit)) &&
         std::ranges::none_of(words, is_no_unit);
}

}  // namespace

NameWords words_in(std::string_view text) {
  NameWords out;
  bool inside = false;
  const std::size_t sign = inch_sign(text);
  if (sign != std::string_view::npos) {
    return words_in(fmt::format("{}inch{}", text.substr(0, sign), text.substr(sign + 1)));
  }
  for (const char c : lower_case(text)) {
    if (is_word(c) && !inside) out.emplace_back();
    inside = is_word(c);
    if (inside) out.back() += c;
  }
  return out;
}

double mm_in(LengthUnit unit) {
  switch (unit) {
    case LengthUnit::kMm:
      return 1.0;
    case LengthUnit::kUm:
      return 1e-3;
    case LengthUnit::kCm:
      return 10.0;
    case LengthUnit::kM:
      return 1e3;
    case LengthUnit::kInch:
      return 25.4;
  }
  return 1.0;
}

std::optional<LengthUnit> unit_named(std::string_view word) {
  for (const auto& [name, unit] : kUnitWords) {
    if (name == word) return unit;
  }
  return std::nullopt;
}

std::optional<LengthUnit> unit_of_field(std::string_view field) {
  const NameWords words = words_in(field);
  return words.size() == 1 ? unit_named(words[0]) : std::nullopt;
}

bool names_unit(std::string_view word) { return is_one_of(kUnitNames, word); }

std::optional<LengthUnit> unit_in_text(std::string_view line) {
  const NameWords words = words_in(line);
  if (words.size() == 2 && words[0] == "xyzijk" && words[1] == "metric") return LengthUnit::kMm;
  const std::vector<LengthUnit> alone = units_alone(words);
  if (words.size() > 1 && !alone.empty() &&
      std::ranges::count(alone, alone[0]) == std::ssize(alone)) {
    return alone[0];
  }
  // The unit follows at once: "Unit 3, M. Weber" and "unit clamped in a vice" state none.
  std::size_t k = 0;
  while (k < words.size() && !announces_unit(words[k])) ++k;
  for (++k; k < words.size(); ++k) {
    const bool between = is_one_of(kBetween, words[k]) || announces_unit(words[k]);
    const bool ends = k + 1 == words.size() || is_one_of(kAngles, words[k + 1]);
    if (!between || ends) return unit_named(words[k]);  // "in" at the end is inch
  }
  return std::nullopt;
}

core::Error unit_error(const std::string& fault) {
  return {core::Code::kUnits, fault + ": give --unit, in a plan source.unit", {}};
}

std::string columns_differ(LengthUnit unit, LengthUnit other) {
  return fmt::format("the columns are in {} and in {}; one unit is expected", name_of(unit),
                     name_of(other));
}

bool is_polar(std::string_view line) {
  const NameWords words = words_in(line);
  const auto has = [&](const auto& list) {
    return std::ranges::any_of(words, [&](std::string_view word) { return is_one_of(list, word); });
  };
  return has(kAngleNames) && has(kRadiusNames);
}

std::optional<std::size_t> points_in_text(std::string_view line) {
  NameWords words = words_in(line);
  if (words.size() < 2) return std::nullopt;
  const auto count = count_of(words.back());
  words.pop_back();
  const auto speaks_of_points = [](std::string_view word) { return is_one_of(kPointWords, word); };
  const auto counts = [&](std::string_view word) {
    return speaks_of_points(word) || is_one_of(kCountWords, word);
  };
  const bool stated =
      std::ranges::any_of(words, speaks_of_points) && std::ranges::all_of(words, counts);
  return stated ? count : std::nullopt;
}

void UnitLines::state(LengthUnit stated, const std::string& where, bool below) {
  const LengthUnit taken = unit.value_or(below ? LengthUnit::kMm : stated);
  if (stated != taken && !contradiction) {
    contradiction =
        unit_error(unit ? fmt::format("the file says {} and {}", name_of(*unit), name_of(stated))
                        : fmt::format("the file says {} below points for which it states no unit",
                                      name_of(stated)));
    contradiction = contradiction->at(where);
  }
  if (!unit) unit = taken;
}

void UnitLines::take(std::string_view line, std::string_view name, std::size_t number, bool below) {
  const std::string whole =
      before.ends_with(':') ? fmt::format("{} {}", before, line) : std::string(line);
  before = line;
  if (const auto stated = unit_in_text(whole)) {
    state(*stated, fmt::format("{}:{}", name, number), below);
  } else if (!unit && !doubtful && may_state_unit(whole)) {
    doubtful = unit_error(
        fmt::format("{} seems to state a unit, which is not understood", quoted_text(line)));
    doubtful = doubtful->at(fmt::format("{}:{}", name, number));
  }
}

std::optional<core::Error> UnitLines::fault() const {
  return contradiction ? contradiction : unit ? std::nullopt : doubtful;
}

}  // namespace rondure::record
