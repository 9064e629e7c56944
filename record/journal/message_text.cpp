#include "record/journal/message_text.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <fmt/args.h>
#include <fmt/format.h>

#include "core/numbers.h"

namespace rondure::record {
namespace {

using core::ArgumentKind;
using core::Message;
using core::MessageCode;

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

/// The whole text as a number, finite or not.
std::optional<double> number_of(std::string_view text) {
  double value = 0.0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end.ec != std::errc() || end.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<double> json_number(std::string_view text) {
  if (text == "null") return std::numeric_limits<double>::infinity();
  return number_of(text);
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

/// The sentences of journals up to version 5.
constexpr std::array<std::pair<MessageCode, std::string_view>, 13> kOldSentences = {{
    {MessageCode::kPartLocated,
     "part located in pose ({:.4f}, {:.4f}) deg: its axis is level at ({:.4f}, {:.4f}) deg"},
    {MessageCode::kLevellingStep,
     "pose ({:.4f}, {:.4f}) deg: zone of the cloud {:.3f} um; turning to ({:.4f}, {:.4f}) deg"},
    {MessageCode::kLevelToResolution,
     "pose ({:.4f}, {:.4f}) deg: zone of the cloud {:.3f} um; as level as the fixture can be set: "
     "{:.6f} deg is left, its resolution is {:.6f} deg"},
    {MessageCode::kLevelToScatter,
     "pose ({:.4f}, {:.4f}) deg: zone of the cloud {:.3f} um; as level as probe and fixture "
     "scatter: the step of {:.6f} deg is not below half the last one"},
    {MessageCode::kLevelPoseBeyondLimits,
     "pose ({:.4f}, {:.4f}) deg: zone of the cloud {:.3f} um; not level: the levelling pose "
     "({:.4f}, {:.4f}) deg is beyond the limits of the fixture"},
    {MessageCode::kLevelPoseUnreachable, "not level: {}"},
    {MessageCode::kNotLevelAfterPoses,
     "pose ({:.4f}, {:.4f}) deg: zone of the cloud {:.3f} um; not level after {:.0f} poses: a step "
     "of {:.4f} deg is left"},
    {MessageCode::kPoseSearchEnded,
     "pose search ended at ({:.4f}, {:.4f}) deg after {:.0f} poses with f = {:.3f} um, a search "
     "value; that pose is measured anew"},
    {MessageCode::kTargetsReachable,
     "pose ({:.4f}, {:.4f}) deg: {:.0f} of {:.0f} targets can be reached"},
    {MessageCode::kFixtureBaseFound,
     "base of the fixture: shifted by ({:.4f}, {:.4f}, {:.4f}) mm, turned by ({:.5f}, {:.5f}, "
     "{:.5f}) deg, largest residual {:.3f} um"},
    {MessageCode::kSingleSteps,
     "single-step mode: travel at {:g} mm/s at most, moves confirmed by the operator"},
    {MessageCode::kRunResumed,
     "resumed on {} after {:.0f} touches; the last {:.0f} repeated, largest difference {:.3f} um, "
     "limit {:g} um"},
    {MessageCode::kPartLocatedAgain, "part located again behind {:.0f} touches: {}"},
}};

/// The message of a sentence with this form. Only the last argument may contain the fixed text that
/// follows it.
std::optional<Message> read_with(MessageCode code, std::string_view form,
                                 std::string_view sentence) {
  Message out{code, {}};
  for (const ArgumentKind& kind : core::arguments_of(code)) {
    const std::size_t open = form.find('{');
    const std::size_t close = form.find('}');
    if (!sentence.starts_with(form.substr(0, open))) return std::nullopt;
    sentence.remove_prefix(open);
    form.remove_prefix(close + 1);
    const std::string_view behind = form.substr(0, form.find('{'));
    const std::size_t end = behind.empty() ? sentence.size() : sentence.find(behind);
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view value = sentence.substr(0, end);
    sentence.remove_prefix(end);
    if (kind.type != ArgumentKind::Type::kNumber) {
      out.arguments.emplace_back(std::string(value));
    } else if (const auto number = number_of(value)) {
      out.arguments.emplace_back(*number);
    } else {
      return std::nullopt;
    }
  }
  return sentence == form ? std::optional(std::move(out)) : std::nullopt;
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

std::string old_sentence(const Message& message) {
  for (const auto& [code, form] : kOldSentences) {
    if (code != message.code) continue;
    fmt::dynamic_format_arg_store<fmt::format_context> values;
    for (const core::Argument& argument : message.arguments) {
      std::visit([&](const auto& value) { values.push_back(value); }, argument);
    }
    return fmt::vformat(form, values);
  }
  return message.text(0);
}

Message read_old_sentence(const std::string& sentence) {
  for (const auto& [code, form] : kOldSentences) {
    if (auto message = read_with(code, form, sentence)) return *std::move(message);
  }
  return {MessageCode::kSentence, {sentence}};
}

}  // namespace rondure::record
