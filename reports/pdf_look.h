#pragma once

#include <string_view>

#include "reports/pdf_flow.h"

// Private to the room: how tags and classes look on paper. Only looks: an element that is not here
// is set like what stands around it.

namespace rondure::reports::pdf {

inline constexpr double kBodySize = 8.8;
inline constexpr double kSmallSize = 7.6;

/// Changes of the text style; the colour is a variable of the page's style.
struct Look {
  std::string_view of;           ///< Tag, or class behind a dot.
  double size_pt = 0.0;          ///< 0: as around.
  int weight = 0;                ///< 1 bold, -1 not bold, 0 as around.
  std::string_view colour = {};  ///< Empty: as around.
  bool mono = false;
  bool italic = false;
};

inline constexpr Look kLooks[] = {
    {"h1", 16.0, 1},
    {"h2", 13.0, 1},
    {"h3", 10.0, 1},
    {"h4", kBodySize, 1},
    {"b", 0.0, 1},
    {"strong", 0.0, 1},
    {"summary", 0.0, 1},
    {"i", 0.0, 0, {}, false, true},
    {"em", 0.0, 0, {}, false, true},
    {"th", kSmallSize, 0, "--soft"},
    {"dt", kSmallSize, -1, "--soft"},
    {"dd", 0.0, 0, "--ink"},
    {"small", kSmallSize, -1, "--soft"},
    {"caption", kSmallSize, 0, "--soft"},
    {"figcaption", kSmallSize, 0, "--soft"},
    {"footer", kSmallSize, 0, "--soft"},
    {"code", kSmallSize, 0, {}, true},
    {".note", kSmallSize, -1, "--soft"},
    {".brand", kSmallSize, 0, "--soft"},
    {".code", kSmallSize, 0, "--soft", true},
    {".mono", kSmallSize, 0, {}, true},
    {".id", 0.0, 1},
    {".value", 11.5, 1},
    {".verdict-word", 0.0, 1},
    {".word", 24.0, 1},
    {".why", 10.0, 0, "--soft"},
    {".words", kSmallSize, 0, "--soft"},
    {".is-conforms", 0.0, 0, "--good"},
    {".is-does-not-conform", 0.0, 0, "--bad"},
    {".is-undecided", 0.0, 0, "--amber"},
    {".is-void", 0.0, 0, "--soft"},
    {".is-not-toleranced", 0.0, 0, "--soft"},
};

/// Space above an element [pt].
struct Space {
  std::string_view of;
  double pt = 0.0;
};

inline constexpr Space kSpaces[] = {
    {"h1", 8.0},        {"h2", 20.0},      {"h3", 13.0},    {"p", 4.0},
    {"table", 7.0},     {"figure", 8.0},   {"dl", 7.0},     {"figcaption", 3.0},
    {"footer", 14.0},   {"ul", 5.0},       {"li", 3.0},     {".brand", 0.0},
    {".verdict", 14.0}, {".banner", 10.0}, {".truth", 9.0}, {".rule", 9.0},
};

/// Space above an element, 1.5 for one that is not listed.
[[nodiscard]] double space_above(const pugi::xml_node& node);

/// A style with the looks of a tag and of its classes, in this order.
[[nodiscard]] TextStyle styled(TextStyle style, const pugi::xml_node& node, const Source& page);

/// Whether an element is part of a line: letters, a drawing among them.
[[nodiscard]] bool in_line(const pugi::xml_node& node);

}  // namespace rondure::reports::pdf
