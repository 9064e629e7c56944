#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "core/numbers.h"
#include "record/csv/internal/lines.h"
#include "record/points/internal/cloud.h"
#include "record/points/internal/head.h"
#include "record/points/internal/row_names.h"
#include "record/points/internal/units.h"

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

/// Parts of a file whose points belong together: points of several would be read as one cloud.
class Parts {
 public:
  Parts(std::string_view parts, std::string_view name) : parts_(parts), name_(name) {}

  void begin() { begun_ = true; }
  core::Result<void> take(std::size_t line) {
    if (!std::exchange(begun_, false)) return {};
    if (first_ > 0) {
      return core::fail(
          Code::kMeaning,
          fmt::format("the file holds the points of several {}: of one from line {} on, of another "
                      "from here on; bring each in a file of its own",
                      parts_, first_),
          fmt::format("{}:{}", name_, line));
    }
    first_ = line;
    return {};
  }

 private:
  std::string_view parts_;
  std::string_view name_;
  bool begun_ = true;
  std::size_t first_ = 0;
};

/// Reads measured points of DMIS: FA(...)=FEAT/POINT,CART,x,y,z and RAWDAT/CART,x,y,z of one
/// feature. Points after PTMEAS are targets.
core::Result<Cloud> read_dmis(std::string_view text, std::string_view name) {
  Cloud out;
  out.units.doubtful =
      unit_error("the DMIS file states no UNITS of its points").at(std::string(name));
  Parts features("features", name);
  Parts labels("features", name);
  std::string label;
  bool whole_file = true;  // a file that says where it begins says where it ends
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
      const auto unit = unit_of_field(fields_of(whole.substr(6), ',').front());
      if (unit && unit != out.units.unit.value_or(*unit)) {
        return core::fail(Code::kUnits,
                          fmt::format("UNITS changes from {} to {}; bring each part in a file of "
                                      "its own",
                                      name_of(*out.units.unit), name_of(*unit)),
                          fmt::format("{}:{}", name, begin));
      }
      out.units.unit = unit;
      if (!unit)
        out.units.doubtful = unit_error(fmt::format("the DMIS file says {}", quoted_text(whole)))
                                 .at(fmt::format("{}:{}", name, begin));
    }
    if (whole.starts_with("FILNAM/") || whole.starts_with("DMISMN/")) whole_file = false;
    if (whole.starts_with("ENDFIL")) whole_file = true;
    const std::size_t feature = whole.find("=FEAT/POINT,");
    const bool raw = whole.starts_with("RAWDAT/");
    if (feature == std::string_view::npos && whole.find("=FEAT/") != std::string_view::npos) {
      features.begin();
    }
    if (raw) TRY_DO(features.take(begin));
    if (whole.starts_with("FA(") && feature != std::string_view::npos) {
      const std::string_view own = feature_of_point(whole.substr(3, feature - 4));
      if (own != label) labels.begin();
      label = own;
      if (!own.empty()) TRY_DO(labels.take(begin));
    }
    if (raw || (whole.starts_with("FA(") && feature != std::string_view::npos)) {
      std::string_view list = whole.substr(raw ? 7 : feature + 12);
      if (list.starts_with("CART,")) list.remove_prefix(5);
      const auto place = place_of(list, ',');
      if (!place) return core::fail(place.error().at(fmt::format("{}:{}", name, begin)));
      out.points.push_back(*place);
    }
    statement.clear();
  }
  if (!whole_file) {
    return core::fail(Code::kSyntax, "the DMIS file has no ENDFIL: is it cut off?",
                      std::string(name));
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
  Parts sessions("sessions", name);
  out.read = "I++ DME log, answers to PtMeas";
  std::string_view tag;
  for (std::size_t line = 1; !text.empty(); ++line) {
    const std::string_view whole = take_line(text);
    if (whole.find(" StartSession()") != std::string_view::npos) sessions.begin();
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
    TRY_DO(sessions.take(line));
    out.points.emplace_back(*x, *y, *z);
  }
  if (!out.points.empty()) return out;
  return core::fail(Code::kNoPoints, "the log holds no answer to PtMeas", std::string(name));
}

/// Local name of an element: its prefix differs from document to document.
std::string_view local_name(const pugi::xml_node& node) {
  const std::string_view own = node.name();
  const std::size_t colon = own.find(':');
  return own.substr(colon == std::string_view::npos ? 0 : colon + 1);
}

/// Elements of a name below another one, in the order of the document.
std::vector<pugi::xml_node> elements_below(const pugi::xml_node& root, std::string_view wanted) {
  struct Walker final : pugi::xml_tree_walker {
    std::string_view wanted;
    std::vector<pugi::xml_node> found;
    bool for_each(pugi::xml_node& node) override {
      if (local_name(node) == wanted) found.push_back(node);
      return true;
    }
  } walker;
  walker.wanted = wanted;
  pugi::xml_node(root).traverse(walker);
  return std::move(walker.found);
}

/// Reads the one point set of a QIF document, or the points of its one measured feature.
core::Result<Cloud> read_qif(std::string_view text, std::string_view name) {
  const auto fail = [&](Code code, std::string what) {
    return core::fail(code, std::move(what), std::string(name));
  };
  pugi::xml_document document;
  const auto loaded = document.load_buffer(text.data(), text.size());
  if (!loaded) return fail(Code::kSyntax, fmt::format("no XML: {}", loaded.description()));
  const auto sets = elements_below(document, "MeasuredPointSet");
  std::vector<pugi::xml_node> lists;  // of measured features; those of nominal ones hold targets
  for (const pugi::xml_node& measured : elements_below(document, "MeasuredFeatures")) {
    for (const pugi::xml_node& list : elements_below(measured, "PointList")) {
      if (!elements_below(list, "MeasurePoint").empty()) lists.push_back(list);
    }
  }
  if (sets.empty() && lists.empty()) {
    return fail(Code::kNoPoints,
                fmt::format("the QIF document holds results and no points: {}", kExport));
  }
  if (sets.size() > 1 || (sets.empty() && lists.size() > 1)) {
    return fail(Code::kMeaning, fmt::format("the QIF document has the points of several {}; export "
                                            "one of them",
                                            sets.empty() ? "features" : "point sets"));
  }
  Cloud out;
  const auto text_of = [](const pugi::xml_node& root, std::string_view wanted) {
    const auto found = elements_below(root, wanted);
    return std::string_view(found.empty() ? "" : found.front().child_value());
  };
  const auto units = elements_below(document, "PrimaryUnits");
  const auto lengths = elements_below(units.empty() ? document : units.front(), "LinearUnit");
  const std::string_view word =
      units.empty() || lengths.empty() ? "" : text_of(lengths.front(), "UnitName");
  const auto metres = core::parse_number(lengths.empty() ? "" : text_of(lengths.front(), "Factor"));
  for (const LengthUnit unit :
       {LengthUnit::kMm, LengthUnit::kUm, LengthUnit::kCm, LengthUnit::kM, LengthUnit::kInch}) {
    const bool same = metres && std::abs(1e3 * *metres / mm_in(unit) - 1.0) < 1e-9;
    if (same || unit_of_field(lower_case(word)) == unit) out.units.state(unit, std::string(name));
  }
  if (!out.units.unit) {
    out.units.doubtful =
        unit_error(word.empty() ? std::string("the QIF document states no unit of length")
                                : fmt::format("the unit {} is unknown", quoted_text(word)))
            .at(std::string(name));
  }
  if (sets.empty()) {
    out.read = "QIF, points of a measured feature";
    for (const pugi::xml_node& point : elements_below(lists.front(), "MeasurePoint")) {
      const auto place = place_of(text_of(point, "Point"), ' ');
      if (!place) return core::fail(place.error().at(std::string(name)));
      out.points.push_back(*place);
    }
    return out;
  }
  const pugi::xml_node& set = sets.front();
  std::string points(text_of(set, "Points"));
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
  const std::string_view compensated = text_of(set, "Compensated");
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
