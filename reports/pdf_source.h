#pragma once

#include <map>
#include <string>
#include <string_view>

#include <pugixml.hpp>

#include "core/result.h"

// Private to the room: report.html as what report.pdf is set from.

namespace rondure::reports::pdf {

/// A colour, each part 0 to 1.
struct Colour {
  double red = 0.0;
  double green = 0.0;
  double blue = 0.0;
};

/// The page as a tree, with what of its style the drawings need.
struct Source {
  pugi::xml_document tree;    ///< Its <body>; no scripts.
  std::string title;          ///< Text of <title>.
  std::string language;       ///< Of <html lang>, "en" without one.
  std::string drawing_style;  ///< Its style sheet as plain CSS: no variables, no @.
  std::map<std::string, std::string> colours;  ///< Variables of :root, "--ink" -> "#16202a".

  /// A colour variable of the page, spelled #rgb or #rrggbb; black where there is none.
  [[nodiscard]] Colour colour(const std::string& variable) const;
};

/// Reads a page as write_html() gives it.
/// @return kInternal when its body is not well-formed XML (void elements may stay open): a report
/// in two media must not differ because one reader guesses.
[[nodiscard]] core::Result<Source> read_page(std::string_view html);

/// Whether an element stands on paper: not of class screen-only, not `hidden`, no script, no style.
[[nodiscard]] bool on_paper(const pugi::xml_node& node);

/// Whether an element has this class.
[[nodiscard]] bool has_class(const pugi::xml_node& node, std::string_view name);

}  // namespace rondure::reports::pdf
