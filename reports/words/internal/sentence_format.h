#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rondure::reports {

/// Whether a text says nothing in words: numbers, units and symbols alone ("MZCY", "8.31 um
/// [7.60, 9.40]"). Three small letters in a row are a word, but for the units deg, degC and urad.
[[nodiscard]] bool has_no_words(std::string_view text);

/// A format text ("{:.3f} um is {} the tolerance of {:g} um") that is also read backwards: it finds
/// the arguments in a sentence that was made with it.
class SentenceFormat {
 public:
  /// @param format  As for fmt::format(), at most ten arguments, no doubled braces.
  explicit SentenceFormat(std::string_view format);

  [[nodiscard]] std::size_t arguments() const { return kinds_.size(); }
  /// Bytes of fixed text: how particular the format is.
  [[nodiscard]] std::size_t letters() const { return letters_; }
  /// Whether an argument is a name that stays as it is: "{:s}".
  [[nodiscard]] bool stays(std::size_t argument) const;

  /// The arguments in the order of their index, or nothing when the sentence was not made with this
  /// format. None is empty; one of ":g" or ":.3f" is a number; one that stands twice is alike in
  /// both places. Where several readings fit, the first argument is the shortest.
  [[nodiscard]] std::optional<std::vector<std::string>> arguments_of(
      std::string_view sentence) const;

  /// The text with these arguments, as many as arguments(); how they are formatted is theirs.
  [[nodiscard]] std::string with(const std::vector<std::string>& arguments) const;

 private:
  enum class Kind { kText, kNumber, kName };

  [[nodiscard]] bool match(std::string_view rest, std::size_t place,
                           std::vector<std::string>& found) const;

  std::vector<std::string> pieces_;   ///< Fixed text before, between and after the places.
  std::vector<std::size_t> indices_;  ///< Which argument stands at each place.
  std::vector<Kind> kinds_;           ///< Of each argument.
  std::size_t letters_ = 0;
};

}  // namespace rondure::reports
