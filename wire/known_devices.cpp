#include "wire/known_devices.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>

#include <fmt/format.h>

#include "wire/internal/device_holders.h"

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

namespace {

namespace fs = std::filesystem;

bool has_open(const fs::path& process, const fs::path& device) {
  std::error_code none;
  for (fs::directory_iterator fd(process / "fd", none), end; !none && fd != end;
       fd.increment(none)) {
    std::error_code gone;
    if (fs::read_symlink(fd->path(), gone) == device) return true;
  }
  return false;
}

}  // namespace

std::string device_holders(const fs::path& device) {
  std::error_code none;
  const fs::path real = fs::canonical(device, none);
  std::string out;
  for (fs::directory_iterator entry("/proc", none), end; !none && entry != end;
       entry.increment(none)) {
    const std::string number = entry->path().filename().string();
    const bool process = std::all_of(number.begin(), number.end(),
                                     [](unsigned char c) { return std::isdigit(c) != 0; });
    if (!process || !has_open(entry->path(), real.empty() ? device : real)) continue;
    std::string name;
    std::ifstream(entry->path() / "comm") >> name;
    out += fmt::format("{}{} (process {})", out.empty() ? "" : ", ", name, number);
  }
  return out;
}

}  // namespace rondure::wire
