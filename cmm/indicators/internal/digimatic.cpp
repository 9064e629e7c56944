#include "cmm/indicators/internal/digimatic.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "core/numbers.h"

namespace rondure::cmm {
namespace {

constexpr std::string_view kHead = "01A";  // reading, channel 1, item A
constexpr std::size_t kLength = 12;

/// The message with non-printing bytes as dots.
std::string shown(std::string_view message) {
  std::string out(message.substr(0, 40));
  std::replace_if(
      out.begin(), out.end(), [](char c) { return c < ' ' || c > '~'; }, '.');
  return out;
}

}  // namespace

core::Result<double> digimatic_reading(std::string_view message) {
  if (message.starts_with('9')) {
    return core::fail(
        core::Code::kMachine,
        fmt::format("the gauge interface says \"{}\": no gauge is connected, or it is "
                    "off or gives no data",
                    shown(message)));
  }
  const bool reading = message.size() == kLength && message.starts_with(kHead) &&
                       (message[3] == '+' || message[3] == '-');
  const std::string_view digits = reading ? message.substr(4) : std::string_view();
  const bool plain = digits.find_first_not_of("0123456789.") == std::string_view::npos;
  const auto value = plain ? core::parse_number(digits) : std::nullopt;
  if (!value) {
    return core::fail(
        core::Code::kMachine,
        fmt::format("\"{}\" is no reading of a gauge (01A+0000.123 is one)", shown(message)));
  }
  return message[3] == '-' ? -*value : *value;
}

}  // namespace rondure::cmm
