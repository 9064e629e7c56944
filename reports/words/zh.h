#pragma once

#include <span>
#include <string_view>

#include "core/error.h"

namespace rondure::reports {

/// A text of the reports in both languages. Format texts have the same arguments on both sides.
struct Translation {
  std::string_view english;
  std::string_view chinese;
};

/// The table, by topic; each English text stands in one of them once. docs/chinese.md is its
/// glossary.
[[nodiscard]] std::span<const Translation> chinese_page();  ///< Page: words, tables, provenance.
[[nodiscard]] std::span<const Translation> chinese_drawings();   ///< Captions, axes, labels.
[[nodiscard]] std::span<const Translation> chinese_analyses();   ///< Spindle, wheel, contour, axes.
[[nodiscard]] std::span<const Translation> chinese_sentences();  ///< Made by evaluation: told().
[[nodiscard]] std::span<const Translation> chinese_summary();    ///< The terminal.
[[nodiscard]] std::span<const Translation> chinese_live();       ///< The live page.

/// Title of a code.
[[nodiscard]] std::string_view chinese_title(core::Code code);

}  // namespace rondure::reports
