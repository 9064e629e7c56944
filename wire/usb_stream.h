#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "wire/clock.h"
#include "wire/serial_port.h"
#include "wire/transport.h"
#include "wire/usb.h"

namespace rondure::wire {

/// Opens a USB device of the communications class (CDC-ACM) as a byte stream, without the kernel's
/// /dev/ttyACM*. Finds the communication and the data interface and their endpoints in the
/// descriptors, claims both, sets the line coding, and raises DTR and RTS.
/// @return  kMachine when the device has no such interfaces, is busy, or refuses the settings.
/// Source: USB Class Definitions for Communication Devices 1.2, PSTN subclass 1.2, sections 6.3.10
/// to 6.3.12 (requests 0x20 and 0x22).
[[nodiscard]] core::Result<std::unique_ptr<ByteStream>> open_cdc_acm(
    std::unique_ptr<UsbDevice> device, const SerialSettings& settings = {});

/// Removes the two status bytes at the start of every packet from the data of a transfer from an
/// FTDI bridge. The bridge sends a packet of only these bytes whenever its latency timer expires.
[[nodiscard]] std::string without_ftdi_status(std::string_view transfer, std::size_t packet_bytes);

/// Opens a serial line on an FTDI bridge as a byte stream, without the kernel's /dev/ttyUSB*:
/// 115200 baud, 8N1, RTS and CTS as flow control. Bytes received before the opening are discarded.
/// @param clock  Measures the pauses of the opening and the time limits; nullptr: system_clock().
/// @return  kMachine when the device is not such a bridge, is busy, or refuses a setting.
/// Source: vendor requests 0 (reset, purge), 1 (modem lines), 2 (flow control), 3 (baud rate), 4
/// (format), 9 (latency timer) as used by the kernel's ftdi_sio and by libftdi.
[[nodiscard]] core::Result<std::unique_ptr<ByteStream>> open_ftdi(std::unique_ptr<UsbDevice> device,
                                                                  Clock* clock = nullptr);

}  // namespace rondure::wire
