#pragma once

#include <filesystem>
#include <memory>

#include "core/result.h"
#include "wire/line_transport.h"

namespace rondure::wire {

/// Which end of the connection this program is.
enum class Side { kClient, kServer };

/// A transport that hands everything on to another one and writes it down:
///
///     2026-11-21T02:33:02.123456Z -> C: 00001 StartSession()
///     2026-11-21T02:33:02.123512Z <- S: 00001 &
///     2026-11-21T02:33:02.130000Z -- #: 127.0.0.1:1294 closed the connection
///
/// -> was sent, <- was received, -- happened; C: is the client, S: the server. Bytes that do not
/// print stand as \xNN, of a line of more than 4096 bytes the beginning. Every line is in the file
/// before the call returns; a disk that is full ends the log, never the measurement.
///
/// @param file  Lines are added behind what it holds.
/// @return kFile when it cannot be opened for writing.
[[nodiscard]] core::Result<std::unique_ptr<LineTransport>> logged(
    std::unique_ptr<LineTransport> inner, const std::filesystem::path& file, Side side);

}  // namespace rondure::wire
