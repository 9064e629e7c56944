#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rondure::wire {

/// A serial device of the system that a USB plug has made: /dev/ttyUSB*, /dev/ttyACM*.
struct SerialPortInfo {
  std::string device;  ///< E.g. "/dev/ttyUSB0".
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string product_name;  ///< As the plug says; "" when it says nothing.
  std::string serial;        ///< The same.
  std::string kernel_driver;
  std::string refused;  ///< Why this user may not open it, with what to do; "": he may.
  std::string held_by;  ///< Programs that have it open, device_holders().
};

/// The serial devices behind USB plugs, by name, from /sys/class/tty. None is opened.
[[nodiscard]] std::vector<SerialPortInfo> list_serial_ports();

}  // namespace rondure::wire
