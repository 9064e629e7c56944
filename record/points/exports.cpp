#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "core/numbers.h"
#include "record/csv/internal/lines.h"
#include "record/points/internal/cloud.h"
#include "record/points/internal/head.h"

namespace rondure::record {
namespace {

using core::Code;

constexpr std::string_view kExport = "export the points, as a text table or in another format";

std::string capitals(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return out;
}

/// The three numbers at the begin of a list.
core::Result<Eigen::Vector3d> place_of(std::string_view list, char separator) {
  const auto fields = fields_of(list, separator);
  Eigen::Vector3d out;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto value = k < fields.size() ? core::parse_number(fields[k]) : std::nullopt;
    if (!value) {
      return core::fail_with(Code::kSyntax, "{} does not begin with three numbers within 1e9",
                             quoted_text(list));
    }
    out[static_cast<Eigen::Index>(k)] = *value;
  }
  return out;
}

/// Reads measured points of DMIS: FA(...)=FEAT/POINT,CART,x,y,z and RAWDAT/CART,x,y,z. Points
/// after PTMEAS are targets.
core::Result<Cloud> read_dmis(std::string_view text, std::string_view name) {
  Cloud out;
  out.read = "DMIS, x y z of points";
  std::string statement;
  std::size_t begin = 0;
  for (std::size_t line = 1; !text.empty(); ++line) {
    const std::string part = capitals(take_line(text));
    const std::size_t comment = part.find("$$");
    if (statement.empty()) begin = line;
    statement += part.substr(0, comment);
    while (!statement.empty() && statement.back() == ' ') statement.pop_back();
    if (statement.ends_with('$') && comment == std::string::npos) {  // the next line continues it
      statement.pop_back();
      continue;
    }
    const std::string_view whole = statement;
    if (whole.starts_with("UNITS/")) {
      for (const auto& [word, unit] :
           std::to_array<std::pair<std::string_view, LengthUnit>>({{"INCH", LengthUnit::kInch},
                                                                   {"CM", LengthUnit::kCm},
                                                                   {"MM", LengthUnit::kMm},
                                                                   {"M", LengthUnit::kM}})) {
        if (fields_of(whole.substr(6), ',').front() == word) out.unit = unit;
      }
    }
    const std::size_t feature = whole.find("=FEAT/POINT,");
    const bool raw = whole.starts_with("RAWDAT/");
    if (raw || (whole.starts_with("FA(") && feature != std::string_view::npos)) {
      std::string_view list = whole.substr(raw ? 7 : feature + 12);
      if (list.starts_with("CART,")) list.remove_prefix(5);
      const auto place = place_of(list, ',');
      if (!place) return core::fail(place.error().at(fmt::format("{}:{}", name, begin)));
      out.points.push_back(*place);
    }
    statement.clear();
  }
  if (!out.points.empty()) return out;
  return core::fail(
      Code::kNoPoints,
      fmt::format("a DMIS file without FEAT/POINT or RAWDAT holds results or targets, "
                  "not points: {}",
                  kExport),
      std::string(name));
}

/// The number in "X(12.5)".
std::optional<double> log_item(std::string_view line, std::string_view key) {
  for (std::size_t at = line.find(key); at != std::string_view::npos; at = line.find(key, at + 1)) {
    if (at > 0 && std::isalnum(static_cast<unsigned char>(line[at - 1])) != 0) continue;
    const std::string_view rest = line.substr(at + key.size());
    const auto fields = fields_of(rest.substr(0, rest.find(')')), ' ');
    return core::parse_number(fields.front());
  }
  return std::nullopt;
}

/// Reads the hits of an I++ DME log: the answers "00021 # X(..), Y(..), Z(..)" to PtMeas().
core::Result<Cloud> read_log(std::string_view text, std::string_view name) {
  constexpr std::size_t kTag = 5;
  Cloud out;
  out.read = "I++ DME log, answers to PtMeas";
  std::string_view tag;
  for (std::size_t line = 1; !text.empty(); ++line) {
    const std::string_view whole = take_line(text);
    const std::size_t command = whole.find(" PtMeas(");
    if (command != std::string_view::npos && command >= kTag) {
      tag = whole.substr(command - kTag, kTag);
    }
    const std::size_t answer = whole.find(" # ");
    if (answer == std::string_view::npos || answer < kTag || tag.empty() ||
        whole.substr(answer - kTag, kTag) != tag) {
      continue;
    }
    const auto x = log_item(whole.substr(answer), "X(");
    const auto y = log_item(whole.substr(answer), "Y(");
    const auto z = log_item(whole.substr(answer), "Z(");
    if (!x || !y || !z) {
      return core::fail(Code::kSyntax,
                        fmt::format("the answer {} has no X, Y and Z", quoted_text(whole)),
                        fmt::format("{}:{}", name, line));
    }
    out.points.emplace_back(*x, *y, *z);
  }
  if (!out.points.empty()) return out;
  return core::fail(Code::kNoPoints, "the log holds no answer to PtMeas", std::string(name));
}

/// Reads the one point set of a QIF document.
core::Result<Cloud> read_qif(std::string_view text, std::string_view name) {
  const auto fail = [&](Code code, std::string what) {
    return core::fail(code, std::move(what), std::string(name));
  };
  pugi::xml_document document;
  const auto loaded = document.load_buffer(text.data(), text.size());
  if (!loaded) return fail(Code::kSyntax, fmt::format("no XML: {}", loaded.description()));
  const auto named = [](const char* wanted) {
    return [wanted](const pugi::xml_node& node) {
      const std::string_view own = node.name();
      const std::size_t colon = own.find(':');
      return own.substr(colon == std::string_view::npos ? 0 : colon + 1) == wanted;
    };
  };
  const auto is_set = named("MeasuredPointSet");
  const pugi::xml_node set = document.find_node(is_set);
  if (!set) {
    return fail(Code::kNoPoints,
                fmt::format("the QIF document holds results and no points: {}", kExport));
  }
  for (pugi::xml_node other = set.next_sibling(); other; other = other.next_sibling()) {
    if (!is_set(other)) continue;
    return fail(Code::kMeaning, "the QIF document has several point sets; export one of them");
  }
  Cloud out;
  const pugi::xml_node unit =
      document.find_node(named("PrimaryUnits")).find_node(named("LinearUnit"));
  const std::string_view word = unit.find_node(named("UnitName")).child_value();
  if (!word.empty()) {
    out.unit = unit_in_text(fmt::format("unit {}", word));
    if (!out.unit) {
      return fail(Code::kUnits, fmt::format("the unit {} is unknown", quoted_text(word)));
    }
  }
  std::string points = set.find_node(named("Points")).child_value();
  std::ranges::replace_if(
      points, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  std::string_view rest = points;
  while (rest.find_first_not_of(" \t") != std::string_view::npos) {
    rest.remove_prefix(rest.find_first_not_of(" \t"));
    const auto place = place_of(rest.substr(0, 256), ' ');
    if (!place) return core::fail(place.error().at(std::string(name)));
    out.points.push_back(*place);
    for (int k = 0; k < 3; ++k) {
      rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
      rest.remove_prefix(std::min(rest.find_first_of(" \t"), rest.size()));
    }
  }
  if (out.points.empty()) {
    return fail(Code::kNoPoints, "the point set has no Points; BinaryPoints are not read");
  }
  const std::string_view compensated = set.find_node(named("Compensated")).child_value();
  out.read = fmt::format("QIF, {}", compensated == "true" ? "compensated points" : "points");
  return out;
}

}  // namespace

std::optional<core::Result<Cloud>> read_export(std::string_view text, std::string_view name) {
  const std::string begin = capitals(text.substr(0, 4096));
  const auto says = [&](std::string_view word) { return begin.find(word) != std::string::npos; };
  if (begin.starts_with("PLANID\t")) {
    return core::fail(Code::kNoPoints,
                      fmt::format("a table of CALYPSO holds results, not points: {}", kExport),
                      fmt::format("{}:1", name));
  }
  if (says("<") && says("QIFDOCUMENT")) return read_qif(text, name);
  if (says("FILNAM/") || says("DMISMN/") || says("DMISMD/") || says("=FEAT/")) {
    return read_dmis(text, name);
  }
  if (says(" PTMEAS(") || says(" STARTSESSION()")) return read_log(text, name);
  return std::nullopt;
}

}  // namespace rondure::record
