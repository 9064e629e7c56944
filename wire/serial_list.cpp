#include "wire/serial_port.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <fstream>

#include "wire/internal/device_holders.h"

namespace rondure::wire {
namespace {

namespace fs = std::filesystem;

/// The first line of a small file; "" when it cannot be read.
std::string line_of(const fs::path& file) {
  std::string out;
  std::getline(std::ifstream(file) >> std::ws, out);
  return out;
}

std::uint16_t id_of(const fs::path& file) {
  const std::string text = line_of(file);
  std::uint16_t out = 0;
  std::from_chars(text.data(), text.data() + text.size(), out, 16);
  return out;
}

/// The USB device that a serial device belongs to, in /sys; "" when it is none.
fs::path plug_of(const fs::path& tty) {
  std::error_code none;
  fs::path place = fs::canonical(tty / "device", none);
  for (; !none && place.has_relative_path(); place = place.parent_path()) {
    if (fs::exists(place / "idVendor", none)) return place;
  }
  return {};
}

}  // namespace

std::vector<SerialPortInfo> list_serial_ports() {
  std::vector<SerialPortInfo> out;
  std::error_code none;
  for (fs::directory_iterator entry("/sys/class/tty", none), end; !none && entry != end;
       entry.increment(none)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with("ttyUSB") && !name.starts_with("ttyACM")) continue;
    SerialPortInfo port;
    port.device = "/dev/" + name;
    const fs::path plug = plug_of(entry->path());
    if (!plug.empty()) {
      port.vendor = id_of(plug / "idVendor");
      port.product = id_of(plug / "idProduct");
      port.product_name = line_of(plug / "product");
      port.serial = line_of(plug / "serial");
    }
    std::error_code unbound;
    port.kernel_driver =
        fs::read_symlink(entry->path() / "device" / "driver", unbound).filename().string();
    if (::access(port.device.c_str(), R_OK | W_OK) != 0) {
      port.refused = why_not_opened(port.device, errno);
    }
    port.held_by = device_holders(port.device);
    out.push_back(std::move(port));
  }
  std::sort(out.begin(), out.end(),
            [](const SerialPortInfo& a, const SerialPortInfo& b) { return a.device < b.device; });
  return out;
}

}  // namespace rondure::wire
