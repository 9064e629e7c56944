#include "core/utc.h"

#include <chrono>

#include <fmt/format.h>

namespace rondure::core {
namespace {

constexpr std::int64_t kDay_s = 86'400;
constexpr std::string_view kForm = "0000-00-00T00:00:00Z";  // 0: a digit

}  // namespace

std::optional<std::int64_t> parse_utc(std::string_view text) {
  if (text.size() != kForm.size()) return std::nullopt;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool digit = text[i] >= '0' && text[i] <= '9';
    if (kForm[i] == '0' ? !digit : text[i] != kForm[i]) return std::nullopt;
  }
  const auto number = [&](std::size_t from, std::size_t count) {
    int out = 0;
    for (const char c : text.substr(from, count)) out = 10 * out + (c - '0');
    return out;
  };
  const std::chrono::year_month_day day{std::chrono::year(number(0, 4)),
                                        std::chrono::month(static_cast<unsigned>(number(5, 2))),
                                        std::chrono::day(static_cast<unsigned>(number(8, 2)))};
  const int hour = number(11, 2);
  const int minute = number(14, 2);
  const int second = number(17, 2);
  if (!day.ok() || number(0, 4) < 1970 || hour > 23 || minute > 59 || second > 59) {
    return std::nullopt;
  }
  const std::int64_t days = std::chrono::sys_days(day).time_since_epoch().count();
  return days * kDay_s + 3600 * hour + 60 * minute + second;
}

std::string utc_text(std::int64_t seconds) {
  const std::int64_t days = seconds >= 0 ? seconds / kDay_s : -((kDay_s - 1 - seconds) / kDay_s);
  const std::int64_t rest = seconds - days * kDay_s;
  const std::chrono::year_month_day day{
      std::chrono::sys_days(std::chrono::days(static_cast<int>(days)))};
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", static_cast<int>(day.year()),
                     static_cast<unsigned>(day.month()), static_cast<unsigned>(day.day()),
                     rest / 3600, rest / 60 % 60, rest % 60);
}

}  // namespace rondure::core
