#include "record/csv/internal/lines.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

#include "core/encodings.h"
#include "core/numbers.h"

namespace rondure::record {
namespace {

constexpr std::string_view kBlanks = " \t";
constexpr std::array<std::string_view, 14> kUnits = {
    "um", "mm", "m", "nm", "inch", "deg", "rad", "s", "ms", "rpm", "degC", "V", "mV", "N"};
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

/// The name without its unit ("H1" of "H1_um").
std::string_view stem_of(std::string_view name) {
  const std::string_view unit = unit_of_column(name);
  return unit.empty() ? name : name.substr(0, name.size() - unit.size() - 1);
}

}  // namespace

core::Error syntax_error(std::string what) { return {core::Code::kSyntax, std::move(what), {}}; }

core::Error too_many_rows() {
  return syntax_error(fmt::format(
      "the file has more than {} rows, which is the limit; take fewer points", kMostRows));
}

std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

bool holds_no_row(std::string_view line) {
  const std::size_t first = line.find_first_not_of(kBlanks);
  return first == std::string_view::npos || line[first] == '#' ||
         line.substr(first).starts_with("//");
}

std::vector<std::string_view> split_fields(std::string_view line) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t comma = line.find(',');
    fields.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

std::string quoted_text(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string shown = "\"";
  std::size_t at = 0;
  while (at < std::min(text.size(), kLongest)) {
    const core::Utf8Character c = core::next_character(text.substr(at));
    const std::string_view bytes = text.substr(at, c.bytes);
    const bool blank = c.code == 0xA0 || c.code == 0x202F || c.code == 0x3000 ||
                       (c.code >= 0x2000 && c.code <= 0x200F);
    if (c.valid && !blank && core::printable(bytes) == bytes) {
      shown += bytes;
    } else {
      for (const char byte : bytes) {
        shown += fmt::format("\\x{:02x}", static_cast<unsigned char>(byte));
      }
    }
    at += bytes.size();
  }
  return shown + (at < text.size() ? "...\"" : "\"");
}

std::optional<core::Error> foreign_format(std::string_view line) {
  const auto has = [&](char c) { return line.find(c) != std::string_view::npos; };
  if (has('\0')) {
    return syntax_error(
        fmt::format("the line holds a NUL byte ({}); plain text is expected, saved as UTF-8 "
                    "and not as UTF-16",
                    quoted_text(line)));
  }
  if (has('\r')) {
    return syntax_error(
        fmt::format("{} holds a carriage return without a line feed; end lines with LF or "
                    "CRLF",
                    quoted_text(line)));
  }
  if (has('"') || has('\'')) {
    return syntax_error(
        fmt::format("{} holds quotes; write names and numbers without them", quoted_text(line)));
  }
  if (has(';')) {
    return syntax_error(
        fmt::format("{} is separated by semicolons; separate fields by commas and write "
                    "12.5 with a point",
                    quoted_text(line)));
  }
  if (!has(',') && trimmed(line).find_first_of(kBlanks) != std::string_view::npos) {
    return syntax_error(
        fmt::format("{} is separated by blanks; separate fields by commas", quoted_text(line)));
  }
  return std::nullopt;
}

std::optional<core::Error> explain_field(std::string_view field, std::string_view column,
                                         std::string_view unit) {
  double value = 0.0;
  std::string_view digits = field;
  if (digits.starts_with('+') && !digits.starts_with("+-")) digits.remove_prefix(1);
  const char* const end = digits.data() + digits.size();
  const auto [stop, problem] = std::from_chars(digits.data(), end, value);
  const bool whole = !digits.empty() && stop == end;
  // Of a column without unit neither.
  const std::string of_unit = unit.empty() ? "" : fmt::format(" {}", unit);
  const std::string in_unit = unit.empty() ? "" : fmt::format(" in {}", unit);
  if (whole && problem == std::errc() && core::is_measurable(value)) return std::nullopt;
  if (whole && problem == std::errc::result_out_of_range) {
    return core::Error{core::Code::kNotFinite,
                       fmt::format("{} is {}, beyond the range of numbers (4.9e-324 to 1.8e308)",
                                   column, quoted_text(field)),
                       {}};
  }
  if (whole && problem == std::errc() && std::isfinite(value)) {
    return core::Error{core::Code::kOutOfRange,
                       fmt::format("{} is {}{}, beyond the limit of {:g}{} for any number; is it "
                                   "a mark for a missing value? Remove the row",
                                   column, field, of_unit, core::kGreatestNumber, of_unit),
                       {}};
  }
  if (whole && problem == std::errc()) {
    return core::Error{
        core::Code::kNotFinite,
        fmt::format("{} is {}; a finite number{} is expected", column, quoted_text(field), in_unit),
        {}};
  }
  if (field.empty()) {
    return syntax_error(
        fmt::format("{} is empty; a number{} such as 12.5 is expected", column, in_unit));
  }
  const auto has = [&](std::string_view part) { return field.find(part) != field.npos; };
  std::string_view hint;
  if (has("#")) hint = " (a comment needs a line of its own)";
  if (field.starts_with('#') && field.find_last_of("!?") == field.size() - 1)
    hint = " (an error of the spreadsheet)";
  if (has("\u2212")) hint = " (the minus is the sign U+2212; write -)";
  if (has("\u00a0") || has("\u202f")) hint = " (a blank stands in it; write numbers without)";
  return syntax_error(fmt::format("{} is {}; a number{} such as 12.5 is expected{}", column,
                                  quoted_text(field), in_unit, hint));
}

std::string_view unit_of_column(std::string_view name) {
  const std::size_t cut = name.rfind('_');
  if (cut == std::string_view::npos || cut == 0) return {};
  const std::string_view unit = name.substr(cut + 1);
  return std::find(kUnits.begin(), kUnits.end(), unit) == kUnits.end() ? std::string_view() : unit;
}

core::Error unknown_column(std::string_view field, std::span<const std::string_view> columns,
                           std::string_view list, std::string_view rule) {
  for (const std::string_view column : columns) {
    const std::string_view unit = unit_of_column(column);
    if (unit.empty() || field == column || stem_of(field) != stem_of(column)) continue;
    return {
        core::Code::kWrongUnit,
        fmt::format("column {} is not in {}; give {}{}", quoted_text(field), unit, column, rule),
        {}};
  }
  return syntax_error(fmt::format("column {} is unknown; the first line must name the columns {}",
                                  quoted_text(field), list));
}

bool is_utf16(std::string_view text) {
  return text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff");
}

std::string_view without_byte_order_mark(std::string_view text) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  return text;
}

}  // namespace rondure::record
