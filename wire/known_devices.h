#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace rondure::wire {

/// A kind of device by its USB numbers.
struct KnownDevice {
  enum class Role {
    kFixture,    ///< A driver of the fixture speaks to it.
    kIndicator,  ///< An indicator.
    kSerial,     ///< A serial line; what hangs on it cannot be seen from here.
  };

  std::uint16_t vendor = 0;
  std::uint16_t product = 0;  ///< 0: all of this vendor.
  Role role = Role::kFixture;
  std::string_view what;    ///< E.g. "Zaber controller".
  std::string_view driver;  ///< How plans and commands call its driver; "" for a serial line.
};

/// "fixture", "indicator", "serial".
[[nodiscard]] std::string_view name_of(KnownDevice::Role role);

/// All kinds that are known: the one list of USB numbers.
[[nodiscard]] std::span<const KnownDevice> known_devices();
/// The kind of a device; nullptr when it is none of them.
[[nodiscard]] const KnownDevice* known_device(std::uint16_t vendor, std::uint16_t product);

}  // namespace rondure::wire
