#pragma once

#include <string>
#include <vector>

#include "wire/serial_port.h"
#include "wire/usb.h"

namespace rondure::app {

/// A found device, as it is displayed.
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

/// The known devices that are plugged in: fixtures and indicators, then serial lines.
[[nodiscard]] std::vector<FoundDevice> found_devices(
    const std::vector<wire::UsbDeviceInfo>& devices,
    const std::vector<wire::SerialPortInfo>& ports);

[[nodiscard]] std::string devices_text(const std::vector<FoundDevice>& found);
[[nodiscard]] std::string devices_json(const std::vector<FoundDevice>& found);

}  // namespace rondure::app
