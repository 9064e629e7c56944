#include "plans/schema/json_text.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/encodings.h"

namespace rondure::plans {
namespace {

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

bool is_unshowable(const core::Utf8Character& c) {
  const bool control = core::is_control(c.code) && c.code != '\n' && c.code != '\t';
  return !c.valid || control || core::is_noncharacter(c.code);
}

template <class Bad>
std::size_t first_where(std::string_view text, const Bad& bad) {
  std::size_t i = 0;
  while (i < text.size()) {
    const core::Utf8Character c = core::next_character(text.substr(i));
    if (bad(c)) return i;
    i += c.bytes;
  }
  return text.size();
}

}  // namespace

std::size_t first_unshowable(std::string_view text) { return first_where(text, is_unshowable); }

std::string unshowable_in_words(std::string_view text, std::size_t index) {
  const core::Utf8Character c = core::next_character(text.substr(index));
  if (!c.valid) return fmt::format("the byte 0x{:02X}", static_cast<unsigned char>(text[index]));
  return fmt::format("the character U+{:04X}", c.code);
}

std::optional<std::string> fault_of_name(std::string_view text) {
  constexpr std::size_t kMostCharacters = 200;
  constexpr std::uint32_t kNonJoiner = 0x200C;  // letters of Persian and of Indic scripts need both
  constexpr std::uint32_t kJoiner = 0x200D;
  const std::size_t at = first_where(text, [](const core::Utf8Character& c) {
    return is_unshowable(c) || c.code == '\n' || c.code == '\t' ||
           (core::is_layout_mark(c.code) && c.code != kNonJoiner && c.code != kJoiner);
  });
  if (at < text.size()) {
    return fmt::format("contains {}, which no report can show in a line; remove it",
                       unshowable_in_words(text, at));
  }
  if (text.starts_with(' ') || text.ends_with(' '))
    return "begins or ends with a blank, which nobody sees; remove it";
  const std::size_t count = characters(text);
  if (count <= kMostCharacters) return std::nullopt;
  return fmt::format("has {} characters, the limit is {}; shorten it", count, kMostCharacters);
}

std::string escaped_line(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const core::Utf8Character c = core::next_character(text);
    if (!c.valid) {
      out += fmt::format("\\x{:02x}", static_cast<unsigned char>(text.front()));
    } else if (c.code == '\n') {
      out += "\\n";
    } else if (c.code == '\t' || is_unshowable(c)) {
      out += fmt::format("\\u{:04x}", c.code);
    } else {
      out += text.substr(0, c.bytes);
    }
    text.remove_prefix(c.bytes);
  }
  return out;
}

std::size_t first_not_utf8(std::string_view text) {
  return first_where(text, [](const core::Utf8Character& c) { return !c.valid; });
}

std::size_t characters(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return !continues(c); }));
}

std::string_view head_of(std::string_view text, std::size_t bytes) {
  if (text.size() <= bytes) return text;
  while (bytes > 0 && continues(text[bytes])) --bytes;
  return text.substr(0, bytes);
}

namespace {

using core::Code;
using nlohmann::json;

constexpr int kNumberOverflow = 406;  // error number of the parser
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

std::string place(std::string_view text, std::size_t index, std::string_view name) {
  const std::string_view before = text.substr(0, std::min(index, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  std::string_view row = before.substr(before.rfind('\n') + 1);  // npos + 1 is 0
  if (row.starts_with(kByteOrderMark)) row.remove_prefix(kByteOrderMark.size());
  return fmt::format("{}:{}:{}", name, line, characters(row) + 1);
}

// Builds JsonValues from the events of the parser.
class Builder final : public nlohmann::json_sax<json> {
 public:
  bool null() override { return add(JsonValue::Kind::kNull) != nullptr; }
  bool boolean(bool value) override {
    JsonValue* added = add(JsonValue::Kind::kBoolean);
    if (added != nullptr) added->boolean = value;
    return added != nullptr;
  }
  bool number_integer(number_integer_t value) override {
    return number(static_cast<double>(value));
  }
  bool number_unsigned(number_unsigned_t value) override {
    return number(static_cast<double>(value));
  }
  bool number_float(number_float_t value, const string_t&) override { return number(value); }
  bool string(string_t& value) override {
    JsonValue* added = add(JsonValue::Kind::kText);
    if (added != nullptr) added->text = std::move(value);
    return added != nullptr;
  }
  bool binary(binary_t&) override { return false; }  // JSON text has no binary
  bool start_object(std::size_t) override { return open(JsonValue::Kind::kObject); }
  bool start_array(std::size_t) override { return open(JsonValue::Kind::kArray); }
  bool key(string_t& value) override {
    key_ = std::move(value);
    return true;
  }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool parse_error(std::size_t position, const std::string& last_token,
                   const nlohmann::detail::exception& error) override {
    error_position = position;
    error_token = last_token;
    error_id = error.id;
    return false;
  }

  JsonValue root;
  std::size_t error_position = 0;  ///< Number of characters read when the parser stopped.
  std::string error_token;
  int error_id = 0;   ///< 0: no error.
  std::string limit;  ///< The limit of this reader that ended the parsing.

  [[nodiscard]] std::size_t depth() const { return open_.size(); }

 private:
  bool number(double value) {
    JsonValue* added = add(JsonValue::Kind::kNumber);
    if (added != nullptr) added->number = value;
    return added != nullptr;
  }

  JsonValue* add(JsonValue::Kind kind) {
    if (++count_ > kMaxValues) {
      limit = fmt::format("holds more than {} values; this is not a plan", kMaxValues);
      return nullptr;
    }
    JsonValue* added = &root;
    if (!open_.empty()) {
      JsonValue& parent = *open_.back();
      added = parent.kind == JsonValue::Kind::kArray
                  ? &parent.items.emplace_back()
                  : &parent.members.emplace_back(JsonMember{std::move(key_), {}}).value;
    }
    added->kind = kind;
    added->order = count_;
    return added;
  }

  bool open(JsonValue::Kind kind) {
    if (open_.size() == kMaxNesting) {
      limit = fmt::format("is nested deeper than {} levels; a plan needs 6", kMaxNesting);
      return false;
    }
    JsonValue* added = add(kind);
    if (added != nullptr) open_.push_back(added);
    return added != nullptr;
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  std::vector<JsonValue*> open_;  // a container grows only while it is the last one
  std::string key_;
  std::size_t count_ = 0;
};

// The run of letters, digits and signs around an index: "NaN", "-Infinity", "1e999".
std::string_view word_at(std::string_view text, std::size_t index) {
  const auto in_word = [&](std::size_t i) {
    const auto c = static_cast<unsigned char>(text[i]);
    return std::isalnum(c) != 0 || c == '-' || c == '+' || c == '.' || c == '_' || c >= 0x80;
  };
  if (index >= text.size() || !in_word(index)) return text.substr(std::min(index, text.size()), 1);
  std::size_t first = index;
  std::size_t last = index;
  while (first > 0 && in_word(first - 1)) --first;
  while (last + 1 < text.size() && in_word(last + 1)) ++last;
  return text.substr(first, last - first + 1);
}

bool is_not_a_number(std::string_view word) {
  std::string lower(word);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (lower.starts_with('-') || lower.starts_with('+')) lower.erase(0, 1);
  return lower == "nan" || lower == "inf" || lower == "infinity";
}

char last_visible_before(std::string_view text, std::size_t index) {
  const auto end = text.substr(0, std::min(index, text.size())).find_last_not_of(" \t\r\n");
  return end == std::string_view::npos ? '\0' : text[end];
}

// The cause of the syntax error at text[index], in words for the author of the plan.
std::string complaint(std::string_view text, std::size_t index, const Builder& builder) {
  const std::string_view word = word_at(text, index);
  const char here = index < text.size() ? text[index] : '\0';
  if (builder.error_id == kNumberOverflow) {
    return fmt::format("the number {} is beyond the limit of 1.8e308; is the exponent right?",
                       in_quotes(builder.error_token));
  }
  if (is_not_a_number(word)) {
    return fmt::format("{} is not a JSON number; give a finite number or leave the key out",
                       in_quotes(word));
  }
  if (index >= text.size()) {
    return fmt::format("the text ends here with {} bracket{} still open; was the file cut off?",
                       builder.depth(), builder.depth() == 1 ? "" : "s");
  }
  if ((here == '}' || here == ']') && last_visible_before(text, index) == ',') {
    return fmt::format(
        "a comma stands before this \"{}\"; JSON allows none after the last entry, "
        "remove it",
        here);
  }
  if (here == '/' || here == '#') {
    return "JSON has no comments; use the key \"note\" of the plan";
  }
  if (here == '\'') return "text stands in double quotes in JSON, not in single ones";
  if (here == '\n' || here == '\r') {
    return "this line ends inside a text; close it with a double quote, write a line break as \\n";
  }
  if (here == '"') return "a comma or a colon is missing before this text";
  return fmt::format(
      "{} is not expected here; a comma, a quote, a colon or a bracket before it is "
      "missing or one too many",
      in_quotes(word));
}

// The position of the error: when the parser finds a whole text or number misplaced, it is already
// past it.
std::size_t error_index(std::string_view text, const Builder& builder) {
  const std::size_t end = builder.error_position;
  const std::string& token = builder.error_token;
  const bool number = builder.error_id == kNumberOverflow;
  const bool whole_text = token.size() >= 2 && token.starts_with('"') && token.ends_with('"');
  if ((number || whole_text) && end >= token.size() &&
      text.substr(end - token.size()).starts_with(token)) {
    return end - token.size();
  }
  return end > 0 ? end - 1 : 0;
}

core::Result<void> check_bytes(std::string_view text, std::string_view name) {
  if (text.size() > kMaxPlanBytes) {
    return core::fail(Code::kSyntax,
                      fmt::format("the file has {} bytes, the limit is {}; this is not a plan",
                                  text.size(), kMaxPlanBytes),
                      std::string(name));
  }
  const std::size_t bad = first_not_utf8(text);
  if (bad < text.size()) {
    return core::fail(
        Code::kSyntax,
        fmt::format("the byte 0x{:02X} is not UTF-8; save the file with the encoding UTF-8",
                    static_cast<unsigned char>(text[bad])),
        place(text, bad, name));
  }
  const std::string_view body =
      text.substr(text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0);
  if (body.find_first_not_of(" \t\r\n") == std::string_view::npos) {
    return core::fail(Code::kSyntax, "the file is empty; a plan is a JSON object, { ... }",
                      place(text, 0, name));
  }
  return {};
}

}  // namespace

const JsonValue* JsonValue::find(std::string_view key) const {
  const auto it = std::find_if(members.begin(), members.end(),
                               [&](const JsonMember& member) { return member.key == key; });
  return it == members.end() ? nullptr : &it->value;
}

core::Result<JsonValue> parse_json(std::string_view text, std::string_view name) {
  TRY_DO(check_bytes(text, name));
  Builder builder;
  if (!json::sax_parse(text, &builder)) {
    if (!builder.limit.empty()) {
      return core::fail(Code::kSyntax, "the text " + builder.limit, std::string(name));
    }
    const std::size_t index = error_index(text, builder);
    return core::fail(Code::kSyntax, complaint(text, index, builder), place(text, index, name));
  }
  if (builder.root.kind != JsonValue::Kind::kObject) {
    return core::fail(
        Code::kSyntax,
        fmt::format("the file holds {}; a plan is a JSON object, {{ ... }}", found(builder.root)),
        place(text, 0, name));
  }
  return std::move(builder.root);
}

std::string found(const JsonValue& value) {
  const auto count = [](std::size_t n, std::string_view what) {
    return n == 0 ? fmt::format("an empty {}", what)
                  : fmt::format("an {} of {} value{}", what, n, n == 1 ? "" : "s");
  };
  switch (value.kind) {
    case JsonValue::Kind::kNull:
      return "null";
    case JsonValue::Kind::kBoolean:
      return value.boolean ? "true" : "false";
    case JsonValue::Kind::kNumber:
      return "the number " + plain(value.number);
    case JsonValue::Kind::kText:
      return "the text " + in_quotes(value.text);
    case JsonValue::Kind::kArray:
      return count(value.items.size(), "array");
    case JsonValue::Kind::kObject:
      return count(value.members.size(), "object");
  }
  return "nothing";
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kShown = 60;
  const std::string_view head = head_of(text, kShown);
  return fmt::format("\"{}{}\"", escaped_line(head), head.size() < text.size() ? "..." : "");
}

std::string plain(double value) { return fmt::format("{}", value); }

std::string member_pointer(std::string_view pointer, std::string_view key) {
  std::string out(pointer);
  out += '/';
  for (const char c : escaped_line(key)) {
    if (c == '~') {
      out += "~0";
    } else if (c == '/') {
      out += "~1";
    } else {
      out += c;
    }
  }
  return out;
}

std::string item_pointer(std::string_view pointer, std::size_t index) {
  return fmt::format("{}/{}", pointer, index);
}

std::string feature_pointer(std::size_t index) { return item_pointer("/features", index); }

}  // namespace rondure::plans
