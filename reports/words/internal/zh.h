#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace rondure::reports {

/// A text of the catalogue zh.po in both languages. Format texts have the same arguments on both
/// sides.
struct Translation {
  /// Empty: a text of tr(), trf() or core::phrase(). kCode: the English text is the name of a
  /// core::Code.
  std::string_view context;
  std::string_view english;
  std::string_view chinese;

  static constexpr std::string_view kCode = "code";
};

/// The whole catalogue by context and English text, each pair once. docs/chinese.md is its
/// glossary.
[[nodiscard]] const std::vector<Translation>& chinese_texts();

/// zh.po as msgfmt compiled it, little-endian; the build makes this function (words/embed.cmake).
[[nodiscard]] std::span<const unsigned char> chinese_catalogue();

}  // namespace rondure::reports
