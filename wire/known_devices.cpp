#include "wire/known_devices.h"

#include <array>

namespace rondure::wire {
namespace {

using Role = KnownDevice::Role;

constexpr std::array<KnownDevice, 8> kKnown = {{
    {0x2939, 0, Role::kFixture, "Zaber controller", "zaber"},
    {0x0403, 0xfaf0, Role::kFixture, "Thorlabs APT unit", "thorlabs"},
    {0x0fe7, 0x4001, Role::kIndicator, "Mitutoyo USB-ITN cable", "itn"},
    {0x0403, 0x6001, Role::kSerial, "FTDI FT232R serial line", ""},
    {0x0403, 0x6015, Role::kSerial, "FTDI FT-X serial line", ""},
    {0x067b, 0x2303, Role::kSerial, "Prolific PL2303 serial line", ""},
    {0x10c4, 0xea60, Role::kSerial, "Silicon Labs CP210x serial line", ""},
    {0x1a86, 0x7523, Role::kSerial, "WCH CH340 serial line", ""},
}};

}  // namespace

std::span<const KnownDevice> known_devices() { return kKnown; }

const KnownDevice* known_device(std::uint16_t vendor, std::uint16_t product) {
  for (const KnownDevice& known : kKnown) {
    if (known.vendor == vendor && (known.product == 0 || known.product == product)) return &known;
  }
  return nullptr;
}

}  // namespace rondure::wire
