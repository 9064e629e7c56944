#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "tests/fixture/zaber_emulator.h"
#include "tests/usb/emulated_usb.h"

namespace rondure::testing {

/// A Zaber X-MCC2 on USB: the emulated controller with a CDC-ACM interface.
class ZaberUsb final : public EmulatedUsb {
 public:
  ZaberUsb(ZaberEmulator& controller, std::string serial)
      : controller_(controller), serial_(std::move(serial)) {}

  [[nodiscard]] std::string descriptors() const override {
    using Kind = wire::UsbEndpoint::Kind;
    return usb_descriptors(
        0x2939, 0x49c2,
        {{0x02, 0x02, 0x01, {{0x82, Kind::kInterrupt, 16}}},
         {0x0a, 0x00, 0x00, {{0x03, Kind::kBulk, 64}, {0x83, Kind::kBulk, 64}}}});
  }
  [[nodiscard]] std::string string(int index) const override {
    return index == 1 ? "Zaber Technologies Inc." : index == 2 ? "X-MCC2" : serial_;
  }
  UsbAnswer control(const wire::UsbSetup& setup, std::string_view, std::size_t) override {
    const bool known =
        setup.request_type == 0x21 && (setup.request == 0x20 || setup.request == 0x22);
    return known ? UsbAnswer::data("") : UsbAnswer::stall();
  }
  UsbAnswer out(std::uint8_t endpoint, std::string_view bytes) override {
    if (stalled) return UsbAnswer::stall();
    if (endpoint == 0x03) controller_.receive(bytes);
    return UsbAnswer::data("");
  }
  UsbAnswer in(std::uint8_t endpoint, std::size_t most) override {
    if (endpoint != 0x83) return UsbAnswer::wait();
    std::string bytes = controller_.take(std::min(most, packet_bytes));
    return bytes.empty() ? UsbAnswer::wait() : UsbAnswer::data(std::move(bytes));
  }

  bool stalled = false;           ///< Refuses bytes from now on.
  std::size_t packet_bytes = 63;  ///< Most bytes in a packet; below 64 every packet is short.

 private:
  ZaberEmulator& controller_;
  std::string serial_;
};

}  // namespace rondure::testing
