#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rondure::reports {

/// Whether a text contains no words, only numbers, units and symbols ("MZCY", "8.31 um [7.60,
/// 9.40]"). Three small letters in a row are a word, except the units deg, degC and urad.
[[nodiscard]] bool has_no_words(std::string_view text);

/// A format text ("{:.3f} um is {} the tolerance of {:g} um") that also works in reverse: it finds
/// the arguments in a sentence made with it.
class SentenceFormat {
 public:
  /// @param format  As for fmt::format(), at most ten arguments, no doubled braces.
  explicit SentenceFormat(std::string_view format);

  [[nodiscard]] std::size_t arguments() const { return kinds_.size(); }
  /// Number of bytes of fixed text, a measure of how specific the format is.
  [[nodiscard]] std::size_t letters() const { return letters_; }
  /// Whether an argument is a name that is not translated: "{:s}".
  [[nodiscard]] bool stays(std::size_t argument) const;

  /// The arguments in the order of their index, or none when the sentence was not made with this
  /// format. No argument is empty; one of ":g" or ":.3f" is a number; one that occurs twice is
  /// equal in both places. Where several readings fit, the first argument is the shortest.
  [[nodiscard]] std::optional<std::vector<std::string>> arguments_of(
      std::string_view sentence) const;

  /// The text with these arguments, as many as arguments(); the caller formats them.
  [[nodiscard]] std::string with(const std::vector<std::string>& arguments) const;

 private:
  enum class Kind { kText, kNumber, kName };

  [[nodiscard]] bool match(std::string_view rest, std::size_t place,
                           std::vector<std::string>& found) const;

  std::vector<std::string> pieces_;   ///< Fixed text before, between and after the places.
  std::vector<std::size_t> indices_;  ///< Index of the argument at each place.
  std::vector<Kind> kinds_;           ///< Kind of each argument.
  std::size_t letters_ = 0;
};

}  // namespace rondure::reports
