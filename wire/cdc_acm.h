#pragma once

#include <memory>

#include "wire/byte_stream.h"
#include "wire/serial_settings.h"
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

}  // namespace rondure::wire
