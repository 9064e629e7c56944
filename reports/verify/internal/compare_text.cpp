#include "reports/verify/internal/compare_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "core/json_text.h"
#include "reports/data/internal/json_parts.h"

namespace rondure::reports {
namespace {

/// A piece of a line: a number, or the text between two numbers.
struct Token {
  std::string_view text;
  std::size_t at = 0;  ///< Its position in the line [bytes].
  std::optional<double> number;
};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Whether a number may begin at `i`: a digit, or a sign or point before one.
bool begins_number(std::string_view line, std::size_t i) {
  if (line[i] == '-') ++i;
  if (i < line.size() && line[i] == '.') ++i;
  return i < line.size() && is_digit(line[i]);
}

std::vector<Token> tokens_of(std::string_view line) {
  std::vector<Token> tokens;
  std::size_t text_from = 0;
  const auto end_text = [&](std::size_t at) {
    if (at > text_from) tokens.push_back({line.substr(text_from, at - text_from), text_from, {}});
  };
  for (std::size_t i = 0; i < line.size();) {
    if (!begins_number(line, i)) {
      ++i;
      continue;
    }
    double value = 0.0;
    const char* const first = line.data() + i;
    const auto [stop, problem] = std::from_chars(first, line.data() + line.size(), value);
    const auto length = static_cast<std::size_t>(stop - first);
    if (problem == std::errc()) {  // digits beyond the range of doubles stay text
      end_text(i);
      tokens.push_back({line.substr(i, length), i, value});
      text_from = i + length;
    }
    i += length;
  }
  end_text(line.size());
  return tokens;
}

/// Whether two tokens are equal. Whole numbers (counts, digits of a digest) must match as text:
/// only a number with a point or an exponent was computed in floating point.
bool same(const Token& a, const Token& b, double tolerance) {
  if (a.text == b.text) return true;
  if (!a.number || !b.number) return false;
  const auto computed = [](const Token& t) {
    return t.text.find_first_of(".eE") != std::string_view::npos;
  };
  return (computed(a) || computed(b)) && std::abs(*a.number - *b.number) <= tolerance;
}

/// Positions in both lines where they begin to differ, or none.
std::optional<std::pair<std::size_t, std::size_t>> first_difference(std::string_view expected,
                                                                    std::string_view found,
                                                                    double tolerance) {
  if (expected == found) return std::nullopt;
  if (tolerance <= 0.0) {
    const auto [a, b] = std::mismatch(expected.begin(), expected.end(), found.begin(), found.end());
    const auto at = static_cast<std::size_t>(a - expected.begin());
    return std::pair(at, at);
  }
  const std::vector<Token> left = tokens_of(expected);
  const std::vector<Token> right = tokens_of(found);
  const auto [a, b] =
      std::mismatch(left.begin(), left.end(), right.begin(), right.end(),
                    [&](const Token& x, const Token& y) { return same(x, y, tolerance); });
  if (a == left.end() && b == right.end()) return std::nullopt;
  return std::pair(a == left.end() ? expected.size() : a->at,
                   b == right.end() ? found.size() : b->at);
}

/// A few quoted words around a place of a line; control characters as \x1b.
std::string excerpt(std::string_view line, std::size_t at) {
  constexpr std::size_t kBefore = 20;
  constexpr std::size_t kLength = 60;
  const std::size_t from = at > kBefore ? at - kBefore : 0;
  std::string shown = from > 0 ? "\"..." : "\"";
  for (const char c : line.substr(std::min(from, line.size()), kLength)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) {
      shown += fmt::format("\\x{:02x}", byte);
    } else {
      shown += c;
    }
  }
  return shown + (line.size() > from + kLength ? "...\"" : "\"");
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (true) {
    const std::size_t end = text.find('\n');
    lines.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return lines;
    text.remove_prefix(end + 1);
  }
}

/// The value as JSON, at most 60 bytes of it.
std::string shown(const Json& value) {
  constexpr std::size_t kLongest = 60;
  std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

std::string pointer_token(std::string key) {  // RFC 6901
  for (std::size_t at = 0; (at = key.find_first_of("~/", at)) != std::string::npos; at += 2) {
    key.replace(at, 1, key[at] == '~' ? "~0" : "~1");
  }
  return key;
}

std::string place(const std::string& pointer) {
  return pointer.empty() ? "the whole file" : pointer;
}

std::optional<std::string> value_difference(const Json& expected, const Json& found,
                                            const std::string& pointer, double tolerance);

std::optional<std::string> object_difference(const Json& expected, const Json& found,
                                             const std::string& pointer, double tolerance) {
  for (const auto& [key, value] : expected.items()) {
    const std::string below = pointer + "/" + pointer_token(key);
    const auto other = found.find(key);
    if (other == found.end()) {
      return fmt::format("{}: missing in the file, the journal gives {}", below, shown(value));
    }
    if (auto difference = value_difference(value, *other, below, tolerance)) return difference;
  }
  for (const auto& [key, value] : found.items()) {
    if (expected.contains(key)) continue;
    return fmt::format("{}/{}: the file says {}, the journal gives nothing there", pointer,
                       pointer_token(key), shown(value));
  }
  return std::nullopt;
}

std::optional<std::string> array_difference(const Json& expected, const Json& found,
                                            const std::string& pointer, double tolerance) {
  for (std::size_t i = 0; i < std::min(expected.size(), found.size()); ++i) {
    const std::string below = fmt::format("{}/{}", pointer, i);
    if (auto difference = value_difference(expected[i], found[i], below, tolerance)) {
      return difference;
    }
  }
  if (expected.size() == found.size()) return std::nullopt;
  return fmt::format("{}: the file has {} entries, the journal gives {}", place(pointer),
                     found.size(), expected.size());
}

std::optional<std::string> value_difference(const Json& expected, const Json& found,
                                            const std::string& pointer, double tolerance) {
  if (expected.is_object() && found.is_object()) {
    return object_difference(expected, found, pointer, tolerance);
  }
  if (expected.is_array() && found.is_array()) {
    return array_difference(expected, found, pointer, tolerance);
  }
  const bool close = expected.is_number() && found.is_number() && tolerance > 0.0 &&
                     std::abs(expected.get<double>() - found.get<double>()) <= tolerance;
  if (close || expected == found) return std::nullopt;
  return fmt::format("{}: the file says {}, the journal gives {}", place(pointer), shown(found),
                     shown(expected));
}

/// Compares one line of a table; `names` are its columns.
std::optional<std::string> row_difference(std::string_view expected, std::string_view found,
                                          const std::vector<std::string_view>& names,
                                          double tolerance) {
  const auto left = csv_fields(expected);
  const auto right = csv_fields(found);
  for (std::size_t i = 0; i < std::min(left.size(), right.size()); ++i) {
    const auto differs = first_difference(left[i], right[i], tolerance);
    if (!differs) continue;
    const std::string column =
        i < names.size() ? std::string(names[i]) : fmt::format("number {}", i + 1);
    return fmt::format("column {}: the file says {}, the journal gives {}", column,
                       excerpt(right[i], differs->second), excerpt(left[i], differs->first));
  }
  if (left.size() == right.size()) return std::nullopt;
  return fmt::format("the file has {} fields, the journal gives {}", right.size(), left.size());
}

}  // namespace

std::optional<std::string> first_text_difference(std::string_view expected, std::string_view found,
                                                 double tolerance) {
  if (expected == found) return std::nullopt;
  const auto left = lines_of(expected);
  const auto right = lines_of(found);
  for (std::size_t i = 0; i < std::min(left.size(), right.size()); ++i) {
    const auto differs = first_difference(left[i], right[i], tolerance);
    if (!differs) continue;
    return fmt::format("line {}: the file says {}, the journal gives {}", i + 1,
                       excerpt(right[i], differs->second), excerpt(left[i], differs->first));
  }
  if (left.size() == right.size()) return std::nullopt;
  return fmt::format("the file has {} lines, the journal gives {}", right.size(), left.size());
}

std::vector<std::string_view> csv_fields(std::string_view line) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  std::vector<std::string_view> fields;
  bool quoted = false;
  std::size_t from = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') quoted = !quoted;
    if (line[i] != ',' || quoted) continue;
    fields.push_back(line.substr(from, i - from));
    from = i + 1;
  }
  fields.push_back(line.substr(from));
  return fields;
}

std::optional<std::string> first_json_difference(std::string_view expected, std::string_view found,
                                                 double tolerance) {
  if (expected == found) return std::nullopt;
  const auto right = core::read_json<Json>(found, "");
  if (!right) return right.error().what;
  if (auto difference = value_difference(Json::parse(expected), *right, "", tolerance)) {
    return difference;
  }
  const auto written = first_text_difference(expected, found, tolerance);
  if (!written) return std::nullopt;
  return "the values are equal, but written differently (spaces, order of keys, a repeated key or "
         "digits): " +
         *written;
}

std::optional<std::string> first_csv_difference(std::string_view expected, std::string_view found,
                                                double tolerance) {
  if (expected == found) return std::nullopt;
  const auto left = lines_of(expected);
  const auto right = lines_of(found);
  std::vector<std::string_view> names;  // names of the columns; empty before the header line
  for (std::size_t i = 0; i < std::min(left.size(), right.size()); ++i) {
    if (names.empty() && !left[i].starts_with('#')) names = csv_fields(left[i]);
    if (auto difference = row_difference(left[i], right[i], names, tolerance)) {
      return fmt::format("line {}, {}", i + 1, *difference);
    }
  }
  if (left.size() != right.size()) {
    return fmt::format("the file has {} lines, the journal gives {}", right.size(), left.size());
  }
  const auto written = first_text_difference(expected, found, tolerance);
  if (!written) return std::nullopt;
  return "the fields are equal, but the line ends differ: " + *written;
}

}  // namespace rondure::reports
