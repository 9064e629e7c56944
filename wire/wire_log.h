#pragma once

#include <filesystem>
#include <memory>

#include "core/result.h"
#include "wire/transport.h"

namespace rondure::wire {

/// Role of this program in the connection.
enum class Side { kClient, kServer };

/// Returns a transport that forwards every call to another one and logs its lines:
///
///     2026-11-21T02:33:02.123456Z -> C: 00001 StartSession()
///     2026-11-21T02:33:02.123512Z <- S: 00001 &
///     2026-11-21T02:33:02.130000Z -- #: 127.0.0.1:1294 closed the connection
///
/// -> sent, <- received, -- event; C: the client, S: the server. Non-printing bytes appear as \xNN;
/// a line of more than 4096 bytes is logged up to that length. Every line is in the file before the
/// call returns. A full disk ends the log, but not the measurement.
///
/// @param file  New lines are appended.
/// @return kFile when it cannot be opened for writing.
[[nodiscard]] core::Result<std::unique_ptr<LineTransport>> logged(
    std::unique_ptr<LineTransport> inner, const std::filesystem::path& file, Side side);

}  // namespace rondure::wire
