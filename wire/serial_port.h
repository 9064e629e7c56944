#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "wire/byte_stream.h"
#include "wire/serial_settings.h"

namespace rondure::wire {

/// Opens a serial device of the system, e.g. /dev/ttyACM0 or /dev/ttyUSB0, raw and for this program
/// alone. What came before is thrown away.
/// @return  kMachine when it is not there, is no serial device, may not be opened by this user (the
///          group to join is named), is in use (by whom), or does not know the settings.
[[nodiscard]] core::Result<std::unique_ptr<ByteStream>> open_serial(
    const std::filesystem::path& device, const SerialSettings& settings = {});

/// Why the system refuses to open a serial device, with what to do.
/// @param error  As errno says it.
[[nodiscard]] std::string why_not_opened(const std::filesystem::path& device, int error);

}  // namespace rondure::wire
