#include "cmm/ipp/numbers.h"

#include <algorithm>
#include <array>
#include <charconv>

#include <fmt/format.h>

#include "core/numbers.h"

namespace rondure::cmm::ipp {
namespace {

constexpr int kDigits = 16;
constexpr std::size_t kCharacters = 16;

std::size_t skip_digits(std::string_view text, std::size_t at) {
  while (at < text.size() && is_digit(text[at])) ++at;
  return at;
}

/// End of the mantissa, or 0 when there is none or it is too long.
std::size_t mantissa_end(std::string_view text, std::size_t begin, int max_digits) {
  std::size_t end = skip_digits(text, begin);
  std::size_t digits = end - begin;
  if (end < text.size() && text[end] == '.') {
    const std::size_t fraction = end + 1;
    end = skip_digits(text, fraction);
    digits += end - fraction;
  }
  return digits == 0 || digits > static_cast<std::size_t>(max_digits) ? 0 : end;
}

/// Whether `text` is an exponent from `begin` to its end: E, sign, one to three digits.
bool is_exponent(std::string_view text, std::size_t begin) {
  if (text[begin] != 'e' && text[begin] != 'E') return false;
  std::size_t at = begin + 1;
  if (at < text.size() && (text[at] == '+' || text[at] == '-')) ++at;
  const std::size_t end = skip_digits(text, at);
  return end == text.size() && end - at >= 1 && end - at <= 3;
}

/// Number of mantissa digits in the output of to_chars().
std::ptrdiff_t digits_of(std::string_view text) {
  text = text.substr(0, text.find('e'));
  return std::count_if(text.begin(), text.end(), is_digit);
}

std::string rounded(double value, std::chars_format form, int digits) {
  std::array<char, 32> out{};
  const auto end = std::to_chars(out.data(), out.data() + out.size(), value, form, digits);
  return {out.data(), end.ptr};
}

/// The number with at most 16 digits.
std::string in_digits(double value) {
  std::string text = core::shortest(value + 0.0);  // + 0.0: no negative zero
  if (digits_of(text) <= kDigits) return text;
  // Fifteen significant digits, because a leading zero counts as well.
  text = rounded(value, std::chars_format::general, kDigits - 1);
  if (digits_of(text) <= kDigits) return text;
  return rounded(value, std::chars_format::scientific, kDigits - 1);
}

}  // namespace

std::string wire_number(double value, NumberForm form) {
  if (form == NumberForm::kFiveDecimals) return fmt::format("{:.5f}", value);
  std::string text = in_digits(value);
  for (int digits = kDigits - 1;
       form == NumberForm::kSixteenCharacters && text.size() > kCharacters && digits > 0;
       --digits) {
    text = rounded(value, std::chars_format::general, digits);
  }
  return text;
}

std::optional<double> read_number(std::string_view text, int max_digits) {
  const std::size_t begin = !text.empty() && (text[0] == '+' || text[0] == '-') ? 1 : 0;
  const std::size_t end = mantissa_end(text, begin, max_digits);
  if (end == 0 || (end < text.size() && !is_exponent(text, end))) return std::nullopt;
  return core::parse_number(text);
}

}  // namespace rondure::cmm::ipp
