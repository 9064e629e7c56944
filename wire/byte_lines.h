#pragma once

#include <cstddef>
#include <memory>

#include "wire/byte_stream.h"
#include "wire/clock.h"
#include "wire/line_transport.h"

namespace rondure::wire {

/// Settings of lines_over().
struct ByteLinesOptions {
  std::size_t max_line_bytes = std::size_t{1} << 20;  ///< A longer line ends the connection.
  Clock* clock = nullptr;  ///< For time limits; nullptr: system_clock(). Outlives the transport.
};

/// Returns a transport that cuts lines out of a byte stream. A line that arrives in pieces is put
/// together. A line that is incomplete when the time limit passes is kept for the next call.
[[nodiscard]] std::unique_ptr<LineTransport> lines_over(std::unique_ptr<ByteStream> stream,
                                                        const ByteLinesOptions& options = {});

}  // namespace rondure::wire
