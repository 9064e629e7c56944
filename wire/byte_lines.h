#pragma once

#include <cstddef>
#include <memory>

#include "wire/byte_stream.h"
#include "wire/clock.h"
#include "wire/line_transport.h"

namespace rondure::wire {

/// How lines are cut out of a stream of bytes.
struct ByteLinesOptions {
  std::size_t max_line_bytes = std::size_t{1} << 20;  ///< A longer line ends the connection.
  Clock* clock = nullptr;  ///< Of the time limits; nullptr: system_clock(). Outlives the transport.
};

/// Lines over any stream of bytes. A line that came in pieces is put together; what is not complete
/// within a time limit waits for the next call.
[[nodiscard]] std::unique_ptr<LineTransport> lines_over(std::unique_ptr<ByteStream> stream,
                                                        const ByteLinesOptions& options = {});

}  // namespace rondure::wire
