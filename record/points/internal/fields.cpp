#include "record/points/internal/fields.h"

#include <algorithm>
#include <cctype>
#include <charconv>

#include <fmt/format.h>

#include "record/csv/internal/lines.h"

namespace rondure::record {
namespace {

constexpr std::size_t kMostFields = 1000;

std::string_view blanks_of(char separator) { return separator == '\t' ? " " : " \t"; }

/// The end of a field that begins before a place.
std::size_t end_of_field(std::string_view text, char separator, std::size_t from) {
  const std::string_view ends = separator == ' ' ? " \t" : std::string_view(&separator, 1);
  return std::min(text.find_first_of(ends, from), text.size());
}

}  // namespace

std::size_t closing_quote(std::string_view text, char separator) {
  const bool one = text.starts_with('\'');
  if (!one && !text.starts_with('"')) return std::string_view::npos;
  const std::size_t close = text.find(text[0], 1);
  const bool ends =
      close != std::string_view::npos && text.find_first_not_of(blanks_of(separator), close + 1) >=
                                             end_of_field(text, separator, close);
  return one && !ends ? std::string_view::npos : close;
}

std::vector<std::string_view> fields_of(std::string_view line, char separator) {
  const std::string_view blanks = blanks_of(separator);
  std::vector<std::string_view> out;
  const auto skip = [&] {
    line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
  };
  while (out.size() <= kMostFields) {
    skip();
    const std::size_t close = closing_quote(line, separator);
    const bool quoted = close != std::string_view::npos;
    const std::size_t end = end_of_field(line, separator, quoted ? close : 0);
    // what follows the quotes would be lost without them
    const bool whole = quoted && line.find_first_not_of(blanks, close + 1) >= end;
    std::string_view field = whole ? line.substr(1, close - 1) : line.substr(0, end);
    const std::size_t last = field.find_last_not_of(" \t");
    field = field.substr(0, last == std::string_view::npos ? 0 : last + 1);
    field.remove_prefix(std::min(field.find_first_not_of(" \t"), field.size()));
    out.push_back(field);
    line.remove_prefix(end);
    if (separator == ' ') skip();
    if (line.empty()) break;
    if (separator != ' ') line.remove_prefix(1);
  }
  return out;
}

std::size_t filled_fields(const std::vector<std::string_view>& fields) {
  std::size_t out = fields.size();
  while (out > 0 && fields[out - 1].empty()) --out;
  return out;
}

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return out;
}

bool is_nan(std::string_view field) {
  const std::string word = lower_case(field);
  const std::size_t begin = word.starts_with('-') || word.starts_with('+') ? 1 : 0;
  const std::string_view rest = std::string_view(word).substr(begin);
  return rest == "nan" || rest.starts_with("nan(") || rest.starts_with("1.#qnan") ||
         rest.starts_with("1.#ind");
}

std::optional<std::size_t> count_of(std::string_view word) {
  std::size_t out = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, problem] = std::from_chars(word.data(), end, out);
  return problem == std::errc() && stop == end ? std::optional(out) : std::nullopt;
}

std::optional<std::size_t> place_of_column(std::string_view column) {
  const auto number = count_of(column);
  if (!number || *number < 1 || *number > kMostFields) return std::nullopt;
  return *number - 1;
}

std::string both_readings(std::string_view line) {
  const Cells fields = fields_of(line, ',');
  if (fields[0].find('.') != std::string_view::npos) return {};
  const auto text = [&](char between) {
    return quoted_text(fmt::format("{}{}{}", fields[0], between, fields[1]));
  };
  return fmt::format(
      "; {} may be one number, {}, or two: separate fields by semicolons, or write "
      "decimals with a point",
      text(','), text('.'));
}

std::string_view name_of_separator(char separator) {
  switch (separator) {
    case '\t':
      return "tab";
    case ';':
      return "semicolon";
    case '|':
      return "bar";
    case ',':
      return "comma";
    default:
      return "blanks";
  }
}

bool agrees(const Cells& fields, std::size_t columns) {
  return fields.size() >= columns && filled_fields(fields) <= columns;
}

core::Error wrong_count(std::string_view line, char separator, std::size_t columns) {
  if (line.find('\r') != std::string_view::npos) {
    return syntax_error(
        fmt::format("{} holds a carriage return without a line feed; end lines with LF or CRLF",
                    quoted_text(line)));
  }
  const Cells fields = fields_of(line, separator);
  const std::size_t found = std::max<std::size_t>(filled_fields(fields), 1);
  const bool commas = separator == ',' && found == 2 * columns;
  const bool words = line.find_first_of("0123456789") == std::string_view::npos ||
                     (found == 1 && std::isalpha(static_cast<unsigned char>(line[0])) != 0);
  return syntax_error(fmt::format("{} field{} in {}, {} expected ({} between them){}{}", found,
                                  found == 1 ? "" : "s", quoted_text(line), columns,
                                  name_of_separator(separator), commas ? both_readings(line) : "",
                                  words ? "; put # before a line of text, or delete it" : ""));
}

core::Error at_line(core::Error error, std::string_view name, std::size_t line) {
  return error.at(fmt::format("{}:{}", name, line));
}

}  // namespace rondure::record
