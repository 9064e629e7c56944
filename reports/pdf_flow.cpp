#include "reports/pdf_flow.h"

#include <algorithm>
#include <utility>

#include "reports/pdf_drawing.h"
#include "reports/pdf_look.h"
#include "reports/pdf_table.h"

namespace rondure::reports::pdf {
namespace {

// What is isolated does not reorder its neighbours: U+2068, U+2069, as <bdi> does on a screen.
constexpr std::string_view kIsolate = "\u2068";
constexpr std::string_view kEndIsolate = "\u2069";
constexpr double kWidestInGrid = 200.0;
constexpr double kLeastScale = 0.62;  ///< At which the labels of a drawing can still be read.

bool is(const pugi::xml_node& node, std::string_view name) { return node.name() == name; }

bool blank(const pugi::xml_node& node) {
  return node.type() == pugi::node_pcdata &&
         std::string_view(node.value()).find_first_not_of(" \t\r\n\f") == std::string_view::npos;
}

/// Children that are seen, without white space between them.
std::vector<pugi::xml_node> parts_of(const pugi::xml_node& node) {
  std::vector<pugi::xml_node> out;
  for (const pugi::xml_node child : node) {
    if (on_paper(child) && !blank(child)) out.push_back(child);
  }
  return out;
}

bool all_are(const std::vector<pugi::xml_node>& nodes, std::string_view name) {
  return std::all_of(nodes.begin(), nodes.end(), [&](const auto& node) { return is(node, name); });
}

Brick brick_of(BoxPtr box, double space_before) {
  Brick brick;
  brick.box = std::move(box);
  brick.space_before = space_before;
  return brick;
}

}  // namespace

Setting Flow::inside(const pugi::xml_node& node, const Setting& around) const {
  Setting out = around;
  out.style = styled(around.style, node, press_.page());
  if (has_class(node, "n")) out.align = Align::kRight;
  return out;
}

std::vector<Brick> Flow::bricks(const pugi::xml_node& parent, const Setting& setting) {
  std::vector<Brick> out;
  gather(parent, setting, out);
  return out;
}

BoxPtr Flow::stack(const pugi::xml_node& parent, const Setting& setting) {
  auto box = std::make_unique<Stack>();
  for (Brick& brick : bricks(parent, setting)) box->add(brick.space_before, std::move(brick.box));
  return box;
}

void Flow::gather(const pugi::xml_node& parent, const Setting& setting, std::vector<Brick>& out) {
  Nodes run;
  for (const pugi::xml_node child : parent) {
    if (!on_paper(child)) continue;
    if (in_line(child)) {
      run.push_back(child);
      continue;
    }
    paragraph(run, setting, out);
    run.clear();
    block(child, setting, out);
  }
  paragraph(run, setting, out);
}

void Flow::paragraph(const Nodes& run, const Setting& setting, std::vector<Brick>& out) {
  Nodes seen;
  std::copy_if(run.begin(), run.end(), std::back_inserter(seen),
               [](const auto& node) { return !blank(node); });
  if (seen.empty()) return;
  const double space = space_above(seen.front().parent());
  if (seen.size() == 1 && is(seen.front(), "svg")) {
    const bool centred = setting.align == Align::kCentre;
    const double widest = std::min(setting.width, setting.widest_drawing);
    out.push_back(brick_of(set_drawing(press_, seen.front(), widest, centred), space));
    return;
  }
  Words text(press_);
  for (const pugi::xml_node& node : run) words(node, setting, text);
  Brick brick = brick_of(text.set(setting.align), space);
  brick.may_be_cut = true;
  out.push_back(std::move(brick));
}

void Flow::words(const pugi::xml_node& node, const Setting& setting, Words& out) {
  if (!on_paper(node)) return;
  if (node.type() != pugi::node_element) return out.add(node.value(), setting.style);
  if (is(node, "br")) return out.line_break();
  if (is(node, "svg"))
    return out.add(set_drawing(press_, node, setting.width, false), setting.style);
  const Setting mine = inside(node, setting);
  if (has_class(node, "frame-box")) return framed_words(node, mine, out);
  const bool isolated = is(node, "bdi");
  if (isolated) out.add_mark(kIsolate, mine.style);
  for (const pugi::xml_node child : node) words(child, mine, out);
  if (isolated) out.add_mark(kEndIsolate, mine.style);
}

void Flow::framed_words(const pugi::xml_node& node, const Setting& setting, Words& out) {
  TextStyle gap = setting.style;
  gap.size_pt = 6.0;
  out.add("\u2002", gap);  // half of its size wide: what the frame stands out by
  gap.size_pt = 12.0;
  for (const pugi::xml_node& part : parts_of(node)) {
    const std::size_t from = out.place();
    words(part, setting, out);
    out.frame_since(from);
    out.add("\u2002", gap);
  }
}

void Flow::block(const pugi::xml_node& node, const Setting& around, std::vector<Brick>& out) {
  const Setting setting = inside(node, around);
  const std::string_view name = node.name();
  const std::size_t first = out.size();
  if (name.size() == 2 && name.front() == 'h' && name[1] >= '1' && name[1] <= '6') {
    heading(node, setting, out);
  } else if (name == "table") {
    auto rows = set_table(*this, node, setting);
    std::move(rows.begin(), rows.end(), std::back_inserter(out));
  } else if (name == "figure") {
    figure(node, setting, out);
  } else if (name == "dl") {
    definitions(node, setting, out);
  } else if (name == "li") {
    item(node, setting, out);
  } else {
    division(node, setting, out);
  }
  const std::string_view before = node.previous_sibling().name();
  const bool explains = name == "p" && before.size() == 2 && before.front() == 'h';
  if (first < out.size()) {
    out.back().keep_with_next = out.back().keep_with_next || explains;
    out[first].space_before = std::max(out[first].space_before, space_above(node));
  }
}

void Flow::division(const pugi::xml_node& node, const Setting& setting, std::vector<Brick>& out) {
  const bool frame =
      has_class(node, "banner") || has_class(node, "truth") || has_class(node, "rule");
  if (frame) return framed(node, setting, out);
  const Nodes parts = parts_of(node);
  if (parts.size() > 1 && all_are(parts, "figure")) return figures(parts, setting, out);
  if (parts.size() > 1 && is(parts.front(), "svg") && !in_line(parts[1])) {
    return mark_and_words(parts, setting, out);
  }
  if (parts.size() > 1 && all_are(parts, "span")) {
    Words text(press_);
    for (const pugi::xml_node& part : parts) {
      words(part, setting, text);
      if (part != parts.back()) text.add("\u2003\u2003", setting.style);
    }
    return out.push_back(brick_of(text.set(setting.align), 0.0));
  }
  gather(node, setting, out);
}

void Flow::heading(const pugi::xml_node& node, const Setting& setting, std::vector<Brick>& out) {
  Words text(press_);
  for (const pugi::xml_node child : node) words(child, setting, text);
  Brick brick;
  for (const auto& piece : node.select_nodes(".//text()")) brick.heading += piece.node().value();
  brick.level = node.name()[1] - '0';
  brick.keep_with_next = true;
  brick.may_be_cut = true;
  brick.box = text.set(setting.align);
  if (brick.level == 2) {
    Border line;
    line.top = 0.6;
    line.colour = press_.page().colour("--line");
    line.pad_y = 6.0;
    brick.box = std::make_unique<Framed>(line, std::move(brick.box));
  }
  out.push_back(std::move(brick));
}

void Flow::figure(const pugi::xml_node& node, const Setting& setting, std::vector<Brick>& out) {
  Setting mine = setting;
  mine.align = Align::kCentre;
  Brick brick = brick_of(stack(node, mine), 0.0);
  brick.figure = true;
  out.push_back(std::move(brick));
}

void Flow::figures(const Nodes& all, const Setting& setting, std::vector<Brick>& out) {
  constexpr double kGap = 14.0;
  double natural = 0.0;
  for (const pugi::xml_node& one : all) {
    natural = std::max(natural, drawing_width(one.select_node(".//svg").node()));
  }
  const bool charts = kLeastScale * natural > 0.5 * (setting.width - kGap);
  const std::size_t columns = charts ? 1 : 2;
  Setting cell = setting;
  cell.width = charts ? setting.width : 0.5 * (setting.width - kGap);
  cell.align = Align::kCentre;
  cell.widest_drawing = charts ? kLeastScale * natural : kWidestInGrid;
  for (std::size_t i = 0; i < all.size(); i += columns) {
    auto row = std::make_unique<Beside>();
    for (std::size_t k = 0; k < columns && i + k < all.size(); ++k) {
      const double x = static_cast<double>(k) * (cell.width + kGap);
      row->add(x, cell.width, stack(all[i + k], inside(all[i + k], cell)));
    }
    Brick brick = brick_of(std::move(row), 8.0);
    brick.figure = true;
    out.push_back(std::move(brick));
  }
}

void Flow::mark_and_words(const Nodes& parts, const Setting& setting, std::vector<Brick>& out) {
  constexpr double kGap = 14.0;
  BoxPtr mark = set_drawing(press_, parts.front(), 0.3 * setting.width, false);
  const double x = mark->widths().wanted + kGap;
  Setting beside = setting;
  beside.width = setting.width - x;
  auto text = std::make_unique<Stack>();
  for (std::size_t i = 1; i < parts.size(); ++i) {
    std::vector<Brick> inner;
    block(parts[i], beside, inner);
    for (Brick& brick : inner) text->add(brick.space_before, std::move(brick.box));
  }
  auto row = std::make_unique<Beside>(true);
  row->add(0.0, x - kGap, std::move(mark));
  row->add(x, beside.width, std::move(text));
  out.push_back(brick_of(std::move(row), 0.0));
}

void Flow::item(const pugi::xml_node& node, const Setting& setting, std::vector<Brick>& out) {
  constexpr double kIndent = 12.0;
  Setting mine = setting;
  mine.width = setting.width - kIndent;
  BoxPtr box;
  if (has_class(node.parent(), "warnings")) {
    Border bar;
    bar.left = 3.0;
    bar.left_colour = press_.page().colour("--amber");
    bar.pad_x = kIndent;
    mine.width -= kIndent;
    box = std::make_unique<Framed>(bar, stack(node, mine));
  } else {
    auto row = std::make_unique<Beside>();
    Words bullet(press_);
    bullet.add("\u2022", setting.style);
    row->add(2.0, kIndent - 2.0, bullet.set(Align::kLeft));
    row->add(kIndent, mine.width, stack(node, mine));
    box = std::move(row);
  }
  Brick brick = brick_of(std::move(box), 0.0);
  brick.may_be_cut = true;
  out.push_back(std::move(brick));
}

void Flow::framed(const pugi::xml_node& node, const Setting& setting, std::vector<Brick>& out) {
  const Source& page = press_.page();
  Border border;
  border.round = 0.6;
  border.pad_x = 10.0;
  border.pad_y = 6.0;
  border.colour = page.colour("--line");
  if (has_class(node, "truth")) {
    border.colour = page.colour("--soft");
    border.dashed = true;
  } else if (has_class(node, "banner")) {
    border.left = 3.0;
    border.left_colour = page.colour(has_class(node, "alarm") ? "--bad" : "--blue");
    border.filled = true;
    border.ground = page.colour("--pale");
  }
  Setting mine = setting;
  mine.width -= 2.0 * border.pad_x;
  Brick brick = brick_of(std::make_unique<Framed>(border, stack(node, mine)), 0.0);
  brick.may_be_cut = true;
  out.push_back(std::move(brick));
}

}  // namespace rondure::reports::pdf
