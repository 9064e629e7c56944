#include "reports/pdf_look.h"

#include <algorithm>
#include <array>
#include <string>

namespace rondure::reports::pdf {
namespace {

bool is_of(const pugi::xml_node& node, std::string_view name) {
  return name.front() == '.' ? has_class(node, name.substr(1)) : node.name() == name;
}

}  // namespace

double space_above(const pugi::xml_node& node) {
  double space = 1.5;
  for (const Space& entry : kSpaces) {
    if (is_of(node, entry.of)) space = entry.pt;
  }
  return space;
}

TextStyle styled(TextStyle style, const pugi::xml_node& node, const Source& page) {
  for (const Look& look : kLooks) {
    if (!is_of(node, look.of)) continue;
    if (look.size_pt > 0.0) style.size_pt = look.size_pt;
    if (look.weight != 0) style.bold = look.weight > 0;
    if (!look.colour.empty()) style.colour = page.colour(std::string(look.colour));
    style.mono = style.mono || look.mono;
    style.italic = style.italic || look.italic;
  }
  const std::string_view name = node.name();
  if (name == "sub" || name == "sup") {
    style.rise_pt = (name == "sub" ? -0.15 : 0.35) * style.size_pt;
    style.size_pt *= 0.75;
  }
  return style;
}

bool in_line(const pugi::xml_node& node) {
  if (node.type() != pugi::node_element) return true;
  static constexpr std::array<std::string_view, 21> kInLine = {
      "a",    "abbr", "b", "bdi",  "bdo",  "br",     "cite", "code", "em",  "i",   "kbd",
      "mark", "q",    "s", "samp", "span", "strong", "sub",  "sup",  "svg", "time"};
  return std::find(kInLine.begin(), kInLine.end(), node.name()) != kInLine.end();
}

}  // namespace rondure::reports::pdf
