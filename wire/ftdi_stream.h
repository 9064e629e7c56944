#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "wire/byte_stream.h"
#include "wire/clock.h"
#include "wire/usb.h"

namespace rondure::wire {

/// Returns the data of a transfer from an FTDI bridge. Every packet begins with two status bytes,
/// which are removed; the bridge sends a packet of only these whenever its latency timer expires.
[[nodiscard]] std::string without_ftdi_status(std::string_view transfer, std::size_t packet_bytes);

/// Opens a serial line on an FTDI bridge as a byte stream, without the kernel's /dev/ttyUSB*:
/// 115200 baud, 8N1, RTS and CTS as flow control. Bytes received before the opening are discarded.
/// @param clock  Measures the pauses of the opening and the time limits; nullptr: system_clock().
/// @return  kMachine when the device is no such bridge, is busy, or refuses a setting.
/// Source: vendor requests 0 (reset, purge), 1 (modem lines), 2 (flow control), 3 (baud rate), 4
/// (format), 9 (latency timer) as the kernel's ftdi_sio and libftdi use them.
[[nodiscard]] core::Result<std::unique_ptr<ByteStream>> open_ftdi(std::unique_ptr<UsbDevice> device,
                                                                  Clock* clock = nullptr);

}  // namespace rondure::wire
