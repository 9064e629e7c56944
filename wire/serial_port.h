#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include "wire/byte_stream.h"

namespace rondure::wire {

/// Settings of a serial line, over a tty or over a USB bridge.
struct SerialSettings {
  enum class Parity { kNone, kOdd, kEven };

  int baud = 115'200;
  int data_bits = 8;  ///< 7 or 8.
  Parity parity = Parity::kNone;
  int stop_bits = 1;                            ///< 1 or 2.
  bool rts_cts = false;                         ///< Flow control by the RTS and CTS lines.
  std::chrono::milliseconds write_limit{1000};  ///< Time for the device to take what is sent.
};

/// Opens a serial device of the system, e.g. /dev/ttyACM0 or /dev/ttyUSB0, in raw mode and for this
/// program alone. Bytes received before the opening are discarded.
/// @return  kMachine when the device does not exist, is not a serial device, may not be opened by
///          this user (the message names the group to join), is in use (the message names the
///          holder), or does not support the settings.
[[nodiscard]] core::Result<std::unique_ptr<ByteStream>> open_serial(
    const std::filesystem::path& device, const SerialSettings& settings = {});

/// Says why the system refuses to open a serial device, and what to do about it.
/// @param error  The errno of the attempt.
[[nodiscard]] std::string why_not_opened(const std::filesystem::path& device, int error);

}  // namespace rondure::wire
