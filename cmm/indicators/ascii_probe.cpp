#include "cmm/indicators/ascii_probe.h"

#include <regex.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cmm/indicators/mitutoyo_itn.h"
#include "core/numbers.h"

namespace rondure::cmm {
namespace {

using std::chrono::duration_cast;
using std::chrono::milliseconds;
using Parity = wire::SerialSettings::Parity;

constexpr std::size_t kLongestReply = 256;

constexpr const char* kNumber = "^ *([+-]? *[0-9]*[.]?[0-9]+) *$";

/// The kinds of indicator: name, line, request, reply.
const std::vector<AsciiProbeSettings>& kinds() {
  const auto line = [](int baud, int data_bits, Parity parity, int stop_bits) {
    wire::SerialSettings out;
    out.baud = baud;
    out.data_bits = data_bits;
    out.parity = parity;
    out.stop_bits = stop_bits;
    return out;
  };
  static const std::vector<AsciiProbeSettings> kKinds = {
      {"sylvac", line(4800, 7, Parity::kEven, 2), "?\r", kNumber},
      {"tesa", line(4800, 7, Parity::kEven, 2), "?\r", kNumber},
      {"mahr", line(9600, 7, Parity::kEven, 2), "M1?\r",
       "^1 +([+-] *[0-9]*[.]?[0-9]+) *(mm|um|in)$"},
      {"qm-height", line(9600, 8, Parity::kNone, 1), "1\r", "^01A([+-][0-9]*[.][0-9]+)$"}};
  return kKinds;
}

/// A regular expression of the C library: std::regex of GCC 12 causes warnings in this build.
class Pattern {
 public:
  Pattern() = default;
  ~Pattern() {
    if (compiled_) ::regfree(&expression_);
  }
  Pattern(const Pattern&) = delete;
  Pattern& operator=(const Pattern&) = delete;

  [[nodiscard]] bool compile(const std::string& text) {
    compiled_ = ::regcomp(&expression_, text.c_str(), REG_EXTENDED) == 0;
    return compiled_ && expression_.re_nsub >= 1;
  }
  /// Groups 1 and 2; empty if missing. Nothing when the text does not match.
  [[nodiscard]] std::optional<std::array<std::string, 2>> match(const std::string& text) const {
    std::array<regmatch_t, 3> found = {};
    if (::regexec(&expression_, text.c_str(), found.size(), found.data(), 0) != 0) {
      return std::nullopt;
    }
    std::array<std::string, 2> out;
    for (std::size_t i = 0; i < 2; ++i) {
      const regmatch_t& group = found[i + 1];
      if (group.rm_so < 0) continue;
      out[i] = text.substr(static_cast<std::size_t>(group.rm_so),
                           static_cast<std::size_t>(group.rm_eo - group.rm_so));
    }
    return out;
  }

 private:
  regex_t expression_ = {};
  bool compiled_ = false;
};

std::optional<double> unit_mm_of(const std::string& unit, double otherwise_mm) {
  if (unit.empty()) return otherwise_mm;
  if (unit == "mm") return 1.0;
  if (unit == "um") return 1e-3;
  if (unit == "in") return kInch_mm;
  return std::nullopt;
}

std::string without_spaces(std::string number) {
  number.erase(std::remove(number.begin(), number.end(), ' '), number.end());
  return number;
}

class AsciiProbe final : public DisplacementProbe {
 public:
  AsciiProbe(std::unique_ptr<wire::ByteStream> stream, const AsciiProbeSettings& settings,
             wire::Clock& clock)
      : stream_(std::move(stream)), settings_(settings), clock_(clock) {}

  [[nodiscard]] bool prepare() { return pattern_.compile(settings_.reply); }

  [[nodiscard]] std::string description() const override {
    return fmt::format("{} at {}, resolution {:g} um", settings_.name, stream_->peer(),
                       1e3 * settings_.resolution_mm);
  }
  [[nodiscard]] IndicatorTraits traits() const override { return {settings_.resolution_mm, 0.05}; }

  [[nodiscard]] core::Result<double> read_mm() override {
    TRY_DO(drain());
    TRY_DO(stream_->write(settings_.request));
    const auto reply = receive();
    if (!reply) {
      late_ = true;
      return core::fail(reply.error());
    }
    const auto groups = pattern_.match(*reply);
    const auto number = groups ? core::parse_number(without_spaces((*groups)[0])) : std::nullopt;
    const auto unit_mm = groups ? unit_mm_of((*groups)[1], settings_.unit_mm) : std::nullopt;
    if (number && unit_mm) return *number * *unit_mm;
    late_ = true;
    const bool says_error = reply->starts_with("ERR");
    return core::machine_fault("{} answered \"{}\", {}", description(), *reply,
                               says_error ? "an error of the instrument; see its manual"
                                          : "which is no reading; check kind and line settings");
  }

 private:
  /// Discards bytes that arrived without a request.
  [[nodiscard]] core::Result<void> drain() {
    const wire::Clock::Time end = clock_.now() + 5 * settings_.answer_limit;
    for (;;) {
      TRY(const auto old, stream_->read_some(late_ ? settings_.answer_limit : milliseconds(0)));
      if (old.empty()) break;
      if (clock_.now() < end) continue;
      return core::machine_fault("{} does not stop sending; end its continuous output",
                                 description());
    }
    buffer_.clear();
    late_ = false;
    return {};
  }

  /// The first line that is neither empty nor an echo of the request.
  [[nodiscard]] core::Result<std::string> receive() {
    const std::string echo = settings_.request.substr(0, settings_.request.find_first_of("\r\n"));
    const wire::Clock::Time end = clock_.now() + settings_.answer_limit;
    for (;;) {
      for (std::size_t at = buffer_.find_first_of("\r\n"); at != std::string::npos;
           at = buffer_.find_first_of("\r\n")) {
        const std::string line = buffer_.substr(0, at);
        buffer_.erase(0, at + 1);
        if (!line.empty() && line != echo) return line;
      }
      const auto left = duration_cast<milliseconds>(end - clock_.now());
      if (left <= milliseconds(0) || buffer_.size() > kLongestReply) break;
      TRY(const auto part, stream_->read_some(left));
      buffer_ += printable(part);
    }
    return core::machine_fault(
        "{}: no reading within {} ms; check that it is on, its cable, and its line settings",
        description(), settings_.answer_limit.count());
  }

  /// Replaces non-printing bytes, except line ends, by question marks.
  [[nodiscard]] static std::string printable(std::string text) {
    std::replace_if(
        text.begin(), text.end(),
        [](char c) { return c != '\r' && c != '\n' && (c < ' ' || c > '~'); }, '?');
    return text;
  }

  std::unique_ptr<wire::ByteStream> stream_;
  AsciiProbeSettings settings_;
  wire::Clock& clock_;
  Pattern pattern_;
  std::string buffer_;
  bool late_ = false;  ///< A missing answer may still arrive.
};

}  // namespace

std::optional<AsciiProbeSettings> ascii_probe_settings(std::string_view name) {
  for (const AsciiProbeSettings& kind : kinds()) {
    if (name == kind.name) return kind;
  }
  return std::nullopt;
}

std::string ascii_probe_names() {
  std::string out;
  for (const AsciiProbeSettings& kind : kinds()) {
    out += fmt::format("{}{}", out.empty() ? "" : ", ", kind.name);
  }
  return out;
}

core::Result<std::unique_ptr<DisplacementProbe>> open_ascii_probe(
    std::unique_ptr<wire::ByteStream> stream, const AsciiProbeSettings& settings,
    wire::Clock* clock) {
  auto probe = std::make_unique<AsciiProbe>(std::move(stream), settings,
                                            clock != nullptr ? *clock : wire::system_clock());
  if (!probe->prepare()) {
    return core::fail_with(core::Code::kBadOption,
                           "\"{}\" is no regular expression with a group for the number",
                           settings.reply);
  }
  return probe;
}

}  // namespace rondure::cmm
