#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "wire/transport.h"

namespace rondure::wire {

/// Settings of a serial line, over a tty or over a USB bridge.
struct SerialSettings {
  enum class Parity { kNone, kOdd, kEven };

  int baud = 115'200;
  int data_bits = 8;  ///< 7 or 8.
  Parity parity = Parity::kNone;
  int stop_bits = 1;                            ///< 1 or 2.
  std::chrono::milliseconds write_limit{1000};  ///< Time for the device to accept the bytes sent.
};

/// Opens a serial device of the system, e.g. /dev/ttyACM0 or /dev/ttyUSB0, in raw mode and for this
/// program alone. Bytes received before the opening are discarded.
/// @return  kMachine when the device does not exist, is not a serial device, may not be opened by
///          this user (the message names the group to join), is in use (the message names the
///          holder), or does not support the settings.
[[nodiscard]] core::Result<std::unique_ptr<ByteStream>> open_serial(
    const std::filesystem::path& device, const SerialSettings& settings = {});

/// Returns why the system refuses to open a serial device, and the remedy.
/// @param error  The errno of the attempt.
[[nodiscard]] std::string why_not_opened(const std::filesystem::path& device, int error);

/// A serial device that the system created for a USB device: /dev/ttyUSB*, /dev/ttyACM*.
struct SerialPortInfo {
  std::string device;  ///< E.g. "/dev/ttyUSB0".
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string product_name;  ///< From the USB descriptor; "" when it has none.
  std::string serial;        ///< From the USB descriptor; "" when it has none.
  std::string kernel_driver;
  std::string refused;  ///< Why this user may not open it, and the remedy; "": allowed.
  std::string held_by;  ///< Programs that have it open, as given by device_holders().
};

/// Lists the serial devices of USB adapters, by name, from /sys/class/tty. None is opened.
[[nodiscard]] std::vector<SerialPortInfo> list_serial_ports();

}  // namespace rondure::wire
