#include <algorithm>
#include <utility>

#include "reports/pdf_flow.h"
#include "reports/pdf_look.h"

// Lists of names and values (<dl>): facts in lines, key numbers in a grid, all others in rows.

namespace rondure::reports::pdf {
namespace {

constexpr int kKeyColumns = 3;
constexpr double kKeyGap = 14.0;
constexpr double kLeadSize = 12.0;
constexpr double kKeySize = 9.6;

/// Entries: <div><dt/><dd/></div>, or whatever else stands there.
std::vector<pugi::xml_node> entries_of(const pugi::xml_node& list) {
  std::vector<pugi::xml_node> out;
  for (const pugi::xml_node child : list.children()) {
    if (child.type() == pugi::node_element && on_paper(child)) out.push_back(child);
  }
  return out;
}

/// How the value of a key number is set: large, usual, or as plain text.
void set_value_style(const pugi::xml_node& entry, TextStyle& style) {
  const bool plain = has_class(entry, "wide-key");
  style.bold = !plain;
  style.size_pt = has_class(entry, "lead") ? kLeadSize : plain ? kBodySize : kKeySize;
}

}  // namespace

void Flow::definitions(const pugi::xml_node& node, const Setting& setting,
                       std::vector<Brick>& out) {
  if (has_class(node, "facts")) return facts(node, setting, out);
  if (has_class(node, "keys")) return keys(node, setting, out);
  for (const pugi::xml_node& entry : entries_of(node)) {
    Brick brick;
    brick.box = definition(entry, setting);
    brick.space_before = 4.0;
    brick.may_be_cut = true;
    out.push_back(std::move(brick));
  }
}

/// Name above value. An entry that is a bare <dt> or <dd> is set alone.
BoxPtr Flow::definition(const pugi::xml_node& entry, const Setting& setting) {
  const Setting mine = inside(entry, setting);
  const std::string_view name = entry.name();
  if (name == "dt" || name == "dd") return stack(entry, mine);
  auto box = std::make_unique<Stack>();
  for (Brick& brick : bricks(entry, mine)) box->add(brick.space_before, std::move(brick.box));
  return box;
}

void Flow::facts(const pugi::xml_node& node, const Setting& setting, std::vector<Brick>& out) {
  Words text(press_);
  for (const pugi::xml_node& entry : entries_of(node)) {
    if (!text.empty()) text.add("\u2003 ", setting.style);
    for (const pugi::xml_node child : entry) {
      if (child.type() == pugi::node_element) text.add(" ", setting.style);
      words(child, setting, text);
    }
  }
  if (text.empty()) return;
  Brick brick;
  brick.box = text.set(setting.align);
  brick.may_be_cut = true;
  out.push_back(std::move(brick));
}

void Flow::keys(const pugi::xml_node& node, const Setting& setting, std::vector<Brick>& out) {
  const double column = (setting.width - (kKeyColumns - 1) * kKeyGap) / kKeyColumns;
  std::unique_ptr<Beside> row;
  int filled = 0;
  const auto finish = [&] {
    if (!row) return;
    Brick brick;
    brick.box = std::exchange(row, nullptr);
    brick.space_before = 8.0;
    out.push_back(std::move(brick));
    filled = 0;
  };
  for (const pugi::xml_node& entry : entries_of(node)) {
    const bool wide = has_class(entry, "wide-key");
    if (wide || filled == kKeyColumns) finish();
    if (!row) row = std::make_unique<Beside>();
    Setting cell = setting;
    cell.width = wide ? setting.width : column;
    set_value_style(entry, cell.style);
    row->add(filled * (column + kKeyGap), cell.width, definition(entry, cell));
    ++filled;
    if (wide) finish();
  }
  finish();
}

}  // namespace rondure::reports::pdf
