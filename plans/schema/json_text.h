#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/json_text.h"
#include "core/result.h"

namespace rondure::plans {

/// Index of the first byte that is not part of well-formed UTF-8 (RFC 3629), or text.size().
[[nodiscard]] std::size_t first_not_utf8(std::string_view text);

/// Index of the first character that a report cannot show, or text.size(): a control character
/// other than line feed and tab (DEL and U+0080..9F among them), a noncharacter (U+FDD0..FDEF,
/// U+FFFE and U+FFFF of every plane), or a byte that is not UTF-8.
[[nodiscard]] std::size_t first_unshowable(std::string_view text);

/// The character or byte at first_unshowable(), in words: "the character U+FFFE", "the byte 0xFF".
[[nodiscard]] std::string unshowable_in_words(std::string_view text, std::size_t index);

/// What forbids a name on page one, as a clause after it: it must fit its line, at most 200
/// characters, without blanks at its ends, and not reorder what stands beside it. Nothing where it
/// may stand there.
[[nodiscard]] std::optional<std::string> fault_of_name(std::string_view text);

/// The text on one line: a line feed becomes \n, other unshowable characters \u001b or \xff.
[[nodiscard]] std::string escaped_line(std::string_view text);

/// Number of characters (code points) of well-formed UTF-8.
[[nodiscard]] std::size_t characters(std::string_view text);

/// At most `bytes` of well-formed UTF-8, cut between characters.
[[nodiscard]] std::string_view head_of(std::string_view text, std::size_t bytes);

struct JsonMember;

/// A JSON value that keeps repeated keys and the order of the text.
struct JsonValue {
  enum class Kind { kNull, kBoolean, kNumber, kText, kArray, kObject };

  Kind kind = Kind::kNull;
  bool boolean = false;
  double number = 0.0;
  std::string text;
  std::vector<JsonValue> items;
  std::vector<JsonMember> members;  ///< In the order of the text, including repeated keys.
  std::size_t order = 0;  ///< Number of the value, counted from the start of the document.

  /// The first member of that key, or nullptr.
  [[nodiscard]] const JsonValue* find(std::string_view key) const;
};

struct JsonMember {
  std::string key;
  JsonValue value;
};

/// Limits that keep a hostile file from exhausting memory; real plans are far smaller.
inline constexpr std::size_t kMaxPlanBytes = 10'000'000;
inline constexpr std::size_t kMaxNesting = core::kDeepestJson;
inline constexpr std::size_t kMaxValues = 100'000;

/// Parses the text of a plan. A UTF-8 byte order mark is skipped.
///
/// @param name  Name in `where`: "name:line:column", both from 1, the column in characters.
/// @return  An object; or kSyntax: not UTF-8, not JSON (NaN, comments, trailing commas, numbers
///          beyond double), not an object, or beyond the limits above.
[[nodiscard]] core::Result<JsonValue> parse_json(std::string_view text, std::string_view name);

/// A value in the wording of messages: `the text "abc"`, `the number 4.5`, `an array of 3 values`.
[[nodiscard]] std::string found(const JsonValue& value);

/// Text in quotes, shortened, control characters escaped: safe for one line of a message.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// A number in the form of messages: the shortest digits that read back, "100000" and not "1e+05".
[[nodiscard]] std::string plain(double value);

/// The pointer to a member of an object or to an item of an array (RFC 6901: "~" and "/" escaped).
[[nodiscard]] std::string member_pointer(std::string_view pointer, std::string_view key);
[[nodiscard]] std::string item_pointer(std::string_view pointer, std::size_t index);

/// The pointer of a feature: "/features/2".
[[nodiscard]] std::string feature_pointer(std::size_t index);

}  // namespace rondure::plans
