#include "reports/pdf_table.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace rondure::reports::pdf {
namespace {

constexpr double kGap = 8.0;       ///< Between columns.
constexpr double kPad = 2.6;       ///< Above and below the text of a cell.
constexpr double kOneLine = 90.0;  ///< Text that is not to be broken takes no more.
constexpr double kShort = 160.0;   ///< A table that is no higher stays on one page.

struct Cell {
  BoxPtr box;
  std::size_t column = 0;
  std::size_t span = 1;
  bool one_line = false;  ///< A number with its unit, a verdict: not broken without need.
};

struct Row {
  std::vector<Cell> cells;
  bool head = false;
  bool drawing = false;  ///< One of its cells holds one.
  std::size_t columns = 0;

  /// Belongs to the row above.
  [[nodiscard]] bool is_note(std::size_t all) const {
    return !head && cells.size() == 1 && cells.front().span == all && all > 1;
  }
};

Row row_of(Flow& flow, const pugi::xml_node& tr, const Setting& setting) {
  Row row;
  row.head = std::string_view(tr.parent().name()) == "thead";
  row.drawing = !tr.select_nodes(".//svg").empty();
  const Setting mine = flow.inside(tr, setting);
  for (const pugi::xml_node cell : tr.children()) {
    if (cell.type() != pugi::node_element || !on_paper(cell)) continue;
    Setting inner = flow.inside(cell, mine);
    inner.style.bold = inner.style.bold || row.head;
    const auto span = std::max(1U, cell.attribute("colspan").as_uint(1));
    const bool one_line = has_class(cell, "n") || has_class(cell, "verdict-word");
    row.cells.push_back({flow.stack(cell, inner), row.columns, span, one_line});
    row.columns += span;
  }
  return row;
}

std::vector<Row> rows_of(Flow& flow, const pugi::xml_node& table, const Setting& setting) {
  std::vector<Row> rows;
  for (const auto& tr : table.select_nodes(".//tr")) {
    if (!on_paper(tr.node()) || !on_paper(tr.node().parent())) continue;
    rows.push_back(row_of(flow, tr.node(), setting));
  }
  return rows;
}

std::vector<Widths> columns_of(const std::vector<Row>& rows, std::size_t number) {
  std::vector<Widths> columns(number);
  for (const Row& row : rows) {
    for (const Cell& cell : row.cells) {
      if (cell.span > 1) continue;
      Widths widths = cell.box->widths();
      if (cell.one_line) widths.least = std::max(widths.least, std::min(widths.wanted, kOneLine));
      Widths& column = columns[cell.column];
      column.least = std::max(column.least, widths.least);
      column.wanted = std::max(column.wanted, widths.wanted);
    }
  }
  return columns;
}

/// Shares the room: what is over the wanted widths in proportion to them, what is over the least
/// ones in proportion to what is still wanted; when even those do not fit, all alike are narrower.
std::vector<double> shared(const std::vector<Widths>& columns, double room) {
  double least = 0.0;
  double wanted = 0.0;
  for (const Widths& column : columns) {
    least += column.least;
    wanted += std::max(column.wanted, column.least);
  }
  std::vector<double> out;
  for (const Widths& column : columns) {
    const double most = std::max(column.wanted, column.least);
    if (wanted <= room) {
      out.push_back(wanted > 0.0 ? most * room / wanted
                                 : room / static_cast<double>(columns.size()));
    } else if (least <= room) {
      out.push_back(column.least + (most - column.least) * (room - least) / (wanted - least));
    } else {
      out.push_back(column.least * room / least);
    }
  }
  return out;
}

BoxPtr box_of(Row row, const std::vector<double>& widths, const Source& page, bool underlined) {
  auto box = std::make_unique<Beside>(row.drawing);
  for (Cell& cell : row.cells) {
    const auto from = widths.begin() + static_cast<std::ptrdiff_t>(cell.column);
    const auto span = static_cast<std::ptrdiff_t>(cell.span);
    const double x =
        std::accumulate(widths.begin(), from, 0.0) + kGap * static_cast<double>(cell.column);
    const double width =
        std::accumulate(from, from + span, 0.0) + kGap * static_cast<double>(cell.span - 1);
    box->add(x, width, std::move(cell.box));
  }
  box->pad(kPad, kPad);
  if (row.head) {
    box->underline(0.9, page.colour("--ink"));
  } else if (underlined) {
    box->underline(0.5, page.colour("--line"));
  }
  return box;
}

/// Which rows stay together.
void keep_together(std::vector<Brick>& bricks, const std::vector<bool>& note_follows) {
  double height = 0.0;
  for (const Brick& brick : bricks) height += brick.box->height();
  for (std::size_t i = 0; i + 1 < bricks.size(); ++i) {
    if (height <= kShort || note_follows[i]) bricks[i].keep_with_next = true;
  }
}

}  // namespace

std::vector<Brick> set_table(Flow& flow, const pugi::xml_node& table, const Setting& setting) {
  std::vector<Brick> out;
  if (const pugi::xml_node caption = table.child("caption"); caption && on_paper(caption)) {
    out = flow.bricks(caption, flow.inside(caption, setting));
    for (Brick& brick : out) brick.keep_with_next = true;
  }
  std::vector<Row> rows = rows_of(flow, table, setting);
  std::size_t number = 0;
  for (const Row& row : rows) number = std::max(number, row.columns);
  if (number == 0) return out;
  const double room = setting.width - kGap * static_cast<double>(number - 1);
  const auto widths = shared(columns_of(rows, number), room);
  std::vector<bool> note_follows(out.size(), true);
  const Box* head = nullptr;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    note_follows.push_back(rows[i].head || (i + 1 < rows.size() && rows[i + 1].is_note(number)));
    const bool is_head = rows[i].head;
    Brick brick;
    brick.head = head;
    brick.box = box_of(std::move(rows[i]), widths, flow.press().page(), !note_follows.back());
    brick.box->lay(setting.width);
    out.push_back(std::move(brick));
    if (is_head) head = out.back().box.get();
  }
  keep_together(out, note_follows);
  return out;
}

}  // namespace rondure::reports::pdf
