#pragma once

#include <chrono>

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

}  // namespace rondure::wire
