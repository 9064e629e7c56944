#pragma once

#include <cstddef>
#include <memory>

#include "wire/clock.h"
#include "wire/transport.h"

namespace rondure::wire {

/// Settings of lines_over().
struct ByteLinesOptions {
  std::size_t max_line_bytes = 4096;  ///< A longer line ends the connection.
  Clock* clock = nullptr;  ///< For time limits; nullptr: system_clock(). Outlives the transport.
};

/// Returns a transport that cuts lines out of a byte stream. Joins lines that arrive in pieces;
/// keeps a line that is incomplete at the time limit for the next call.
[[nodiscard]] std::unique_ptr<LineTransport> lines_over(std::unique_ptr<ByteStream> stream,
                                                        const ByteLinesOptions& options = {});

}  // namespace rondure::wire
