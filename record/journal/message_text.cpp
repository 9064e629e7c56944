#include "record/journal/message_text.h"

#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "core/numbers.h"

namespace rondure::record {
namespace {

using core::ArgumentKind;
using core::Message;

std::string json_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04x}", static_cast<int>(c));
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string json_of(const core::Argument& argument) {
  if (const auto* text = std::get_if<std::string>(&argument)) return json_text(*text);
  const double number = std::get<double>(argument);
  return std::isfinite(number) ? core::shortest(number) : "null";
}

std::optional<double> json_number(std::string_view text) {
  if (text == "null") return std::numeric_limits<double>::infinity();
  double value = 0.0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end.ec != std::errc() || end.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Bytes of the JSON text that begins here, with its quotes; npos when it does not end.
std::size_t length_of_text(std::string_view json) {
  for (std::size_t i = 1; i < json.size(); ++i) {
    if (json[i] == '\\') {
      ++i;
    } else if (json[i] == '"') {
      return i + 1;
    }
  }
  return std::string_view::npos;
}

std::string unescaped(std::string_view json) {
  std::string out;
  for (std::size_t i = 1; i + 1 < json.size(); ++i) {
    if (json[i] != '\\') {
      out += json[i];
    } else if (json[++i] != 'u') {
      out += json[i];
    } else {
      int code = 0;
      const std::string_view digits = json.substr(i + 1, 4);
      (void)std::from_chars(digits.data(), digits.data() + digits.size(), code, 16);
      out += static_cast<char>(code);
      i += 4;
    }
  }
  return out;
}

/// The value at the start of the text, which is removed from it.
std::optional<core::Argument> take_value(std::string_view& json) {
  const bool is_text = json.starts_with('"');
  const std::size_t end = is_text ? length_of_text(json) : json.find_first_of(",}");
  if (end == std::string_view::npos) return std::nullopt;
  const std::string_view value = json.substr(0, end);
  json.remove_prefix(end);
  if (is_text) return unescaped(value);
  const auto number = json_number(value);
  return number ? std::optional<core::Argument>(*number) : std::nullopt;
}

bool is_of(const ArgumentKind& kind, const core::Argument& argument) {
  return std::holds_alternative<double>(argument) == (kind.type == ArgumentKind::Type::kNumber);
}

}  // namespace

std::string arguments_json(const Message& message) {
  std::string out = "{";
  const auto kinds = core::arguments_of(message.code);
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    out += fmt::format("{}\"{}\":{}", i == 0 ? "" : ",", kinds[i].name,
                       json_of(message.arguments.at(i)));
  }
  return out + '}';
}

std::optional<Message> read_message(std::string_view code, std::string_view arguments) {
  const auto known = core::message_named(code);
  if (!known) return std::nullopt;
  Message out{*known, {}};
  std::string_view rest = arguments;
  for (const ArgumentKind& kind : core::arguments_of(*known)) {
    const std::string key = fmt::format("{}\"{}\":", out.arguments.empty() ? '{' : ',', kind.name);
    if (!rest.starts_with(key)) return std::nullopt;
    rest.remove_prefix(key.size());
    auto value = take_value(rest);
    if (!value || !is_of(kind, *value)) return std::nullopt;
    out.arguments.push_back(*std::move(value));
  }
  if (arguments_json(out) != arguments) return std::nullopt;
  return out;
}

}  // namespace rondure::record
