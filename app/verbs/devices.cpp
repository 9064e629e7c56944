#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/text/answer.h"
#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "wire/known_devices.h"
#include "wire/serial_port.h"
#include "wire/usb.h"

namespace rondure::app {
namespace {

/// A device found, prepared for display.
struct FoundDevice {
  std::string role;    ///< "fixture", "indicator", "serial".
  std::string what;    ///< E.g. "Zaber controller X-MCC2".
  std::string id;      ///< "2939:49c2".
  std::string serial;  ///< "" when it cannot be read.
  std::string place;   ///< "bus 1, address 2" or "/dev/ttyUSB0".
  std::string driver;  ///< Name of its driver in plans and commands; "" for a serial line.
  std::string state;   ///< "usable", "permission-denied", "busy", "fault".
  std::string note;    ///< The remedy for the state, or further information.
};

using Json = nlohmann::ordered_json;
using wire::KnownDevice;

std::string id_text(std::uint16_t vendor, std::uint16_t product) {
  return fmt::format("{:04x}:{:04x}", vendor, product);
}

/// State of a device and the remedy.
std::pair<std::string, std::string> state_of(const wire::UsbDeviceInfo& device) {
  using Kind = wire::UsbFault::Kind;
  if (device.refused) {
    const Kind kind = device.refused->kind;
    return {kind == Kind::kPermission ? "permission-denied"
            : kind == Kind::kBusy     ? "busy"
                                      : "fault",
            device.refused->what};
  }
  if (!device.held_by.empty()) {
    return {"busy", fmt::format("open in {}; end it first", device.held_by)};
  }
  if (device.kernel_driver.empty()) return {"usable", ""};
  return {"usable",
          fmt::format("the kernel driver {} has it, and gives it up while rondure uses it",
                      device.kernel_driver)};
}

FoundDevice described(const wire::UsbDeviceInfo& device, const KnownDevice& known) {
  FoundDevice out;
  out.role = wire::name_of(known.role);
  out.what = known.what;
  if (!device.product_name.empty()) out.what += " " + device.product_name;
  out.id = id_text(device.vendor, device.product);
  out.serial = device.serial;
  out.place = fmt::format("bus {}, address {}", device.bus, device.address);
  out.driver = known.driver;
  std::tie(out.state, out.note) = state_of(device);
  return out;
}

FoundDevice described(const wire::SerialPortInfo& port) {
  const KnownDevice* known = wire::known_device(port.vendor, port.product);
  FoundDevice out;
  out.role = wire::name_of(KnownDevice::Role::kSerial);
  out.what = known != nullptr ? std::string(known->what) : "serial line";
  if (!port.product_name.empty()) out.what += " " + port.product_name;
  out.id = port.vendor == 0 ? "" : id_text(port.vendor, port.product);
  out.serial = port.serial;
  out.place = port.device;
  if (known != nullptr) out.driver = known->driver;
  out.state = !port.refused.empty()   ? "permission-denied"
              : !port.held_by.empty() ? "busy"
                                      : "usable";
  out.note = !port.refused.empty()   ? port.refused
             : !port.held_by.empty() ? fmt::format("open in {}; end it first", port.held_by)
                                     : "";
  return out;
}

std::string line_of(const FoundDevice& device) {
  std::string out = fmt::format("{:<10} {:<40} {:<10} {:<18} {}", device.role, device.what,
                                device.id, device.place, device.state);
  if (!device.serial.empty()) out += fmt::format(", serial number {}", device.serial);
  if (!device.driver.empty()) out += fmt::format(", driver \"{}\"", device.driver);
  if (!device.note.empty()) out += fmt::format("\n           {}", device.note);
  return out + "\n";
}

std::vector<FoundDevice> found_devices(const std::vector<wire::UsbDeviceInfo>& devices,
                                       const std::vector<wire::SerialPortInfo>& ports) {
  std::vector<FoundDevice> out;
  for (const wire::UsbDeviceInfo& device : devices) {
    const KnownDevice* known = wire::known_device(device.vendor, device.product);
    // A serial line is listed by its /dev name, below.
    if (known == nullptr || known->role == KnownDevice::Role::kSerial) continue;
    out.push_back(described(device, *known));
  }
  for (const wire::SerialPortInfo& port : ports) out.push_back(described(port));
  return out;
}

std::string devices_text(const std::vector<FoundDevice>& found) {
  if (found.empty()) {
    std::string kinds;
    for (const KnownDevice& known : wire::known_devices()) {
      if (known.role == KnownDevice::Role::kSerial) continue;
      kinds += fmt::format("{}{} ({})", kinds.empty() ? "" : ", ", known.what,
                           known.product == 0 ? fmt::format("{:04x}", known.vendor)
                                              : id_text(known.vendor, known.product));
    }
    return fmt::format(
        "No fixture, no indicator and no serial line is plugged in.\nKnown: {}, and serial "
        "lines.\n",
        kinds);
  }
  std::string out;
  for (const FoundDevice& device : found) out += line_of(device);
  return out;
}

std::string devices_json(const std::vector<FoundDevice>& found) {
  Json list = Json::array();
  for (const FoundDevice& device : found) {
    list.push_back({{"role", device.role},
                    {"what", device.what},
                    {"usb_id", device.id},
                    {"serial", device.serial},
                    {"place", device.place},
                    {"driver", device.driver},
                    {"state", device.state},
                    {"note", device.note}});
  }
  return Json{{"devices", list}}.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

int devices(const DevicesArguments& arguments) {
  const auto plugged_in = wire::list_usb_devices();
  if (!plugged_in) return refuse(plugged_in.error().error());
  const auto found = found_devices(*plugged_in, wire::list_serial_ports());
  say(arguments.json ? devices_json(found) : devices_text(found));
  return kAllWell;
}

}  // namespace rondure::app
