#pragma once

#include <string>
#include <vector>

#include "reports/pdf_box.h"

// Private to the room: which part of the report stands on which page.

namespace rondure::reports::pdf {

/// The next thing on a page, over its whole width.
struct Brick {
  BoxPtr box;                   ///< Laid out.
  double space_before = 0.0;    ///< Left out at the top of a page [pt].
  bool keep_with_next = false;  ///< Not the last of a page: a heading, the head of a table.
  bool may_be_cut = false;      ///< Text, a frame around text; where it is of many lines.
  bool figure = false;          ///< A drawing with its caption.
  const Box* head = nullptr;    ///< Repeated above it when it begins a page; of a brick before it.
  std::string heading;          ///< Text of a heading, for the outline.
  int level = 0;                ///< Of the heading: 1, 2, 3.
};

/// A box, or a slice of one, on a page.
struct Placed {
  const Brick* brick = nullptr;
  const Box* box = nullptr;  ///< That of the brick, or its head.
  int page = 0;              ///< From 0.
  double top = 0.0;          ///< Where the slice begins, from the top of the text area [pt].
  Slice slice;

  /// Height of what is shown [pt].
  [[nodiscard]] double height() const;
};

/// Breaks bricks into pages of a text area `height` high. Only what may be cut is cut, between its
/// lines; all else only where it is higher than a page. Linear in the number of lines.
[[nodiscard]] std::vector<Placed> paginate(const std::vector<Brick>& bricks, double height);

}  // namespace rondure::reports::pdf
