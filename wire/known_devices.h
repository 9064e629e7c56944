#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "core/words.h"

namespace rondure::wire {

/// A kind of device by its USB numbers.
struct KnownDevice {
  enum class Role {
    kFixture,    ///< The device of a fixture driver.
    kIndicator,  ///< An indicator.
    kSerial,     ///< A serial line; the device connected to it cannot be identified.
  };

  std::uint16_t vendor = 0;
  std::uint16_t product = 0;  ///< 0: all of this vendor.
  Role role = Role::kFixture;
  std::string_view what;    ///< E.g. "Zaber controller".
  std::string_view driver;  ///< Name of its driver in plans and commands; "" for a serial line.
};

RONDURE_WORDS(KnownDevice::Role, {kFixture, "fixture"}, {kIndicator, "indicator"},
              {kSerial, "serial"});

/// All known kinds; the only list of USB numbers in the program.
[[nodiscard]] std::span<const KnownDevice> known_devices();
/// The kind of a device; nullptr when it is not in the list.
[[nodiscard]] const KnownDevice* known_device(std::uint16_t vendor, std::uint16_t product);

}  // namespace rondure::wire
