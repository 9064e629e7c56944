#include "cmm/indicators/mitutoyo_itn.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "core/numbers.h"

namespace rondure::cmm {
namespace {

using std::chrono::milliseconds;

constexpr std::uint8_t kVendorOut = 0x40;
constexpr std::uint8_t kVendorIn = 0xc0;
constexpr std::uint8_t kLeaveKeyboard = 0x01;
constexpr std::uint8_t kGreeting = 0x02;
constexpr std::uint8_t kCommand = 0x03;
constexpr std::uint16_t kKey = 0xa5a5;
constexpr milliseconds kControlLimit(1000);
constexpr milliseconds kAnswerLimit(1000);  // a gauge takes half a second at most
constexpr std::size_t kLongestMessage = 64;

std::optional<wire::UsbEndpoint> interrupt_end(const wire::UsbDevice& device) {
  for (const wire::UsbInterface& interface : device.interfaces()) {
    if (interface.number != 0) continue;
    for (const wire::UsbEndpoint& end : interface.endpoints) {
      if (end.kind == wire::UsbEndpoint::Kind::kInterrupt && end.is_in() && end.packet_bytes > 0) {
        return end;
      }
    }
  }
  return std::nullopt;
}

class MitutoyoItn final : public DisplacementProbe {
 public:
  MitutoyoItn(std::unique_ptr<wire::UsbDevice> device, const wire::UsbEndpoint& in,
              const MitutoyoItnOptions& options, wire::Clock& clock)
      : device_(std::move(device)), in_(in), options_(options), clock_(clock) {}
  ~MitutoyoItn() override { device_->close(); }

  [[nodiscard]] wire::UsbResult<void> prepare() {
    if (auto reset = device_->reset(); !reset) return reset;
    if (auto chosen = device_->configure(1); !chosen) return chosen;
    if (auto taken = device_->claim(0); !taken) return taken;
    if (auto left = device_->control_out({kVendorOut, kLeaveKeyboard, kKey, 0}, {}, kControlLimit);
        !left) {
      return left;
    }
    TRY_DO(device_->control_in({kVendorIn, kGreeting, 0, 0}, 1, kControlLimit));
    return {};
  }

  [[nodiscard]] std::string description() const override {
    const wire::UsbDeviceInfo& info = device_->info();
    return fmt::format("Mitutoyo USB-ITN {}, resolution {:g} um",
                       info.serial.empty() ? info.place() : info.serial,
                       1e3 * options_.resolution_mm);
  }

  [[nodiscard]] IndicatorTraits traits() const override { return {options_.resolution_mm, 0.05}; }

  [[nodiscard]] core::Result<double> read_mm() override {
    if (auto quiet = drain(); !quiet) return core::fail(quiet.error().error());
    const auto asked = device_->control_out({kVendorOut, kCommand, 0, 0}, "1\r", kControlLimit);
    if (!asked) return core::fail(asked.error().error());
    const auto message = receive();
    if (!message) {
      late_ = true;
      return core::fail(message.error());
    }
    const auto value = digimatic_reading(*message);
    if (!value) return core::fail(value.error().code, description() + ": " + value.error().what);
    return *value * options_.unit_mm;
  }

 private:
  /// Discards data without a request: from a press of the button, or a late answer.
  [[nodiscard]] wire::UsbResult<void> drain() {
    for (;;) {
      TRY(const auto old, device_->interrupt_in(in_.address, in_.packet_bytes,
                                                late_ ? kAnswerLimit : milliseconds(1)));
      if (old.empty()) break;
    }
    late_ = false;
    return {};
  }

  /// One message, joined from its packets, without its CR.
  [[nodiscard]] core::Result<std::string> receive() {
    std::string message;
    const wire::Clock::Time end = clock_.now() + kAnswerLimit;
    while (clock_.now() < end) {
      const auto part = device_->interrupt_in(in_.address, in_.packet_bytes, milliseconds(100));
      if (!part) return core::fail(part.error().error());
      for (const char c : *part) {
        if (c == '\r') return message;
        if (c != '\0') message += c;
      }
      if (message.size() > kLongestMessage) break;
    }
    return core::machine_fault(
        "{}: no reading within {} ms; check that the gauge is on and its cable plugged in at both "
        "ends",
        description(), kAnswerLimit.count());
  }

  std::unique_ptr<wire::UsbDevice> device_;
  wire::UsbEndpoint in_;
  MitutoyoItnOptions options_;
  wire::Clock& clock_;
  bool late_ = false;  ///< A missing answer may still arrive.
};

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

core::Result<std::unique_ptr<DisplacementProbe>> open_mitutoyo_itn(
    std::unique_ptr<wire::UsbDevice> device, const MitutoyoItnOptions& options,
    wire::Clock* clock) {
  const auto in = interrupt_end(*device);
  if (!in) {
    return core::machine_fault("the USB device {} has no endpoint that readings could come from",
                               device->info().place());
  }
  auto probe = std::make_unique<MitutoyoItn>(std::move(device), *in, options,
                                             clock != nullptr ? *clock : wire::system_clock());
  if (auto ready = probe->prepare(); !ready) return core::fail(ready.error().error());
  return probe;
}

core::Result<double> digimatic_reading(std::string_view message) {
  if (message.starts_with('9')) {
    return core::machine_fault(
        "the gauge interface says \"{}\": no gauge is connected, or it is off or gives no data",
        shown(message));
  }
  const bool reading = message.size() == kLength && message.starts_with(kHead) &&
                       (message[3] == '+' || message[3] == '-');
  const std::string_view digits = reading ? message.substr(4) : std::string_view();
  const bool plain = digits.find_first_not_of("0123456789.") == std::string_view::npos;
  const auto value = plain ? core::parse_number(digits) : std::nullopt;
  if (!value) {
    return core::machine_fault("\"{}\" is no reading of a gauge (01A+0000.123 is one)",
                               shown(message));
  }
  return message[3] == '-' ? -*value : *value;
}

}  // namespace rondure::cmm
