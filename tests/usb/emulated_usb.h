#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "wire/usb.h"

namespace rondure::testing {

/// How a device in software answers.
struct UsbAnswer {
  enum class Kind {
    kData,    ///< `bytes`; for a transfer to the device: it took them.
    kWait,    ///< Nothing yet: the transfer stays pending.
    kStall,   ///< Refused.
    kBabble,  ///< More than was asked for.
  };

  Kind kind = Kind::kData;
  std::string bytes;

  static UsbAnswer data(std::string bytes) { return {Kind::kData, std::move(bytes)}; }
  static UsbAnswer wait() { return {Kind::kWait, {}}; }
  static UsbAnswer stall() { return {Kind::kStall, {}}; }
  static UsbAnswer babble() { return {Kind::kBabble, {}}; }
};

/// A USB device in software. Called from the thread of the test bed, under its lock.
class EmulatedUsb {
 public:
  virtual ~EmulatedUsb() = default;

  /// The 18 bytes of the device descriptor and the whole configuration descriptor after them.
  [[nodiscard]] virtual std::string descriptors() const = 0;
  /// The text of a string descriptor, from 1.
  [[nodiscard]] virtual std::string string(int index) const = 0;
  /// A control request that is not for a string. `bytes` came with it; at most `most` go back.
  virtual UsbAnswer control(const wire::UsbSetup& setup, std::string_view bytes,
                            std::size_t most) = 0;
  /// Bytes for an OUT endpoint.
  virtual UsbAnswer out(std::uint8_t endpoint, std::string_view bytes) = 0;
  /// What an IN endpoint has to send; asked again and again while a transfer is pending.
  virtual UsbAnswer in(std::uint8_t endpoint, std::size_t most) = 0;
};

/// One interface of made-up descriptors.
struct DescribedInterface {
  std::uint8_t device_class = 0xff;
  std::uint8_t subclass = 0;
  std::uint8_t protocol = 0;
  std::vector<wire::UsbEndpoint> endpoints;
};

/// The descriptors of a device with these interfaces, numbered from 0; its strings are 1 the maker,
/// 2 the product, 3 the serial number.
[[nodiscard]] std::string usb_descriptors(std::uint16_t vendor, std::uint16_t product,
                                          const std::vector<DescribedInterface>& interfaces);

}  // namespace rondure::testing
