#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "wire/usb.h"

namespace rondure::testing {

/// Answer of an emulated device.
struct UsbAnswer {
  enum class Kind {
    kData,    ///< `bytes`; for a transfer to the device: they were accepted.
    kWait,    ///< No data yet: the transfer stays pending.
    kStall,   ///< Refused.
    kBabble,  ///< More bytes than requested.
  };

  Kind kind = Kind::kData;
  std::string bytes;

  static UsbAnswer data(std::string bytes) { return {Kind::kData, std::move(bytes)}; }
  static UsbAnswer wait() { return {Kind::kWait, {}}; }
  static UsbAnswer stall() { return {Kind::kStall, {}}; }
  static UsbAnswer babble() { return {Kind::kBabble, {}}; }
};

/// An emulated USB device. Called from the thread of the test bed, under its lock.
class EmulatedUsb {
 public:
  virtual ~EmulatedUsb() = default;

  /// The 18 bytes of the device descriptor and the whole configuration descriptor after them.
  [[nodiscard]] virtual std::string descriptors() const = 0;
  /// The text of a string descriptor, from 1.
  [[nodiscard]] virtual std::string string(int index) const = 0;
  /// Answers a control request that is not for a string. `bytes` is its data; the answer has at
  /// most `most` bytes.
  virtual UsbAnswer control(const wire::UsbSetup& setup, std::string_view bytes,
                            std::size_t most) = 0;
  /// Takes bytes for an OUT endpoint.
  virtual UsbAnswer out(std::uint8_t endpoint, std::string_view bytes) = 0;
  /// Returns the data of an IN endpoint; called repeatedly while a transfer is pending.
  virtual UsbAnswer in(std::uint8_t endpoint, std::size_t most) = 0;
};

/// One interface of synthetic descriptors.
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
