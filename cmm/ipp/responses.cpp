#include <algorithm>

#include <fmt/format.h>

#include "cmm/ipp/grammar.h"
#include "cmm/ipp/internal/reader.h"

namespace rondure::cmm::ipp {
namespace {

std::string_view trim(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(' ');
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

std::string_view without_quotes(std::string_view text) {
  text = trim(text);
  if (text.starts_with('"')) text.remove_prefix(1);
  if (text.ends_with('"')) text.remove_suffix(1);
  return text;
}

/// One to four digits, quoted or not.
std::optional<int> small_number(std::string_view text) {
  text = without_quotes(text);
  if (text.empty() || text.size() > 4) return std::nullopt;
  int value = 0;
  for (const char c : text) {
    if (c < '0' || c > '9') return std::nullopt;
    value = 10 * value + (c - '0');
  }
  return value;
}

/// Splits `text` at its first comma.
std::string_view take_field(std::string_view& text) {
  const std::size_t comma = text.find(',');
  const std::string_view field = text.substr(0, comma);
  text = comma == std::string_view::npos ? std::string_view() : text.substr(comma + 1);
  return field;
}

/// Parses Error(F1, F2, F3, Text). F3 is often a whole command and not always quoted: it is the
/// text between F2 and the last string.
std::optional<ErrorReport> read_error(std::string_view text) {
  text = trim(text);
  const std::size_t open = text.find('(');
  if (open == std::string_view::npos || trim(text.substr(0, open)) != "Error") return std::nullopt;
  text.remove_prefix(open + 1);
  if (text.ends_with(')')) text.remove_suffix(1);
  const auto severity = small_number(take_field(text));
  const auto number = small_number(take_field(text));
  if (!severity || !number) return std::nullopt;
  ErrorReport out{*severity, *number, {}, {}};
  text = trim(text);
  std::size_t cut = text.rfind(',');  // for an unquoted text
  if (text.size() >= 2 && text.ends_with('"')) {
    const std::size_t quote = text.rfind('"', text.size() - 2);
    cut = quote == std::string_view::npos || quote == 0 ? std::string_view::npos
                                                        : text.rfind(',', quote - 1);
  }
  if (cut == std::string_view::npos) {
    out.text = without_quotes(text);
    return out;
  }
  out.method = without_quotes(text.substr(0, cut));
  out.text = without_quotes(text.substr(cut + 1));
  return out;
}

std::optional<Response::Kind> kind_of(char c) {
  switch (c) {
    case '&':
      return Response::Kind::kAck;
    case '%':
      return Response::Kind::kComplete;
    case '#':
      return Response::Kind::kData;
    case '!':
      return Response::Kind::kError;
    default:
      return std::nullopt;
  }
}

tl::unexpected<core::Error> bad(std::string_view why, std::string_view line) {
  return core::fail_with(core::Code::kSyntax, "the machine sent a line with {}: \"{}\"", why,
                         excerpt(line, 60));
}

}  // namespace

ErrorReport error_report(int number, std::string_view method) {
  const ErrorEntry* entry = find_error(number);
  if (entry == nullptr) return {3, number, std::string(method), fmt::format("Error {}", number)};
  return {entry->severity, number, std::string(method), std::string(entry->text)};
}

std::string in_words(const ErrorReport& error) {
  const std::string where = error.method.empty() ? "" : fmt::format(" ({})", error.method);
  return fmt::format("error {:04}, severity {}: {}{}", error.number, error.severity, error.text,
                     where);
}

std::string ack_line(const Tag& tag) { return to_text(tag) + " &"; }

std::string complete_line(const Tag& tag) { return to_text(tag) + " %"; }

std::string data_line(const Tag& tag, std::span<const Item> items, NumberForm form) {
  return fmt::format("{} # {}", to_text(tag), to_text(items, form));
}

std::string error_line(const Tag& tag, const ErrorReport& error) {
  return fmt::format("{} ! Error({}, {:04}, {}, {})", to_text(tag), error.severity, error.number,
                     to_text(string_item(error.method)), to_text(string_item(error.text)));
}

core::Result<Response> parse_response(std::string_view line) {
  if (line.size() > kMaxLineLength) {
    return bad(fmt::format("{} characters, {} are allowed", line.size(), kMaxLineLength), line);
  }
  if (!is_plain(line)) return bad("a character outside ASCII 32 to 126", line);
  const auto tag = read_tag(line.substr(0, kTagLength));
  if (!tag) return bad("no tag", line);
  const std::string_view behind = trim(line.substr(kTagLength));
  const auto kind = behind.empty() ? std::nullopt : kind_of(behind.front());
  if (!kind || line[kTagLength] != ' ') return bad("no & # % or ! behind the tag", line);
  Response out;
  out.tag = *tag;
  out.kind = *kind;
  const std::string_view rest = trim(behind.substr(1));
  if (out.kind == Response::Kind::kError) {
    auto error = read_error(rest);
    if (!error) return bad("an error report out of form", line);
    out.error = std::move(*error);
  }
  if (out.kind == Response::Kind::kData) {
    out.raw = rest;
    auto items = ItemReader(rest, ItemReader::Manner::kLiberal).read_list();
    if (items) out.data = std::move(*items);
  }
  return out;
}

}  // namespace rondure::cmm::ipp
