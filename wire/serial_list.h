#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rondure::wire {

/// A serial device that the system made for a USB device: /dev/ttyUSB*, /dev/ttyACM*.
struct SerialPortInfo {
  std::string device;  ///< E.g. "/dev/ttyUSB0".
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string product_name;  ///< From the USB descriptor; "" when it has none.
  std::string serial;        ///< From the USB descriptor; "" when it has none.
  std::string kernel_driver;
  std::string refused;  ///< Why this user may not open it and how to fix that; "": allowed.
  std::string held_by;  ///< Programs that have it open, as given by device_holders().
};

/// Lists the serial devices of USB adapters, by name, from /sys/class/tty. None is opened.
[[nodiscard]] std::vector<SerialPortInfo> list_serial_ports();

}  // namespace rondure::wire
