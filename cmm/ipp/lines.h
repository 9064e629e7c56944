#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "cmm/ipp/grammar.h"

namespace rondure::cmm::ipp {

/// One line from a stream of bytes.
struct RawLine {
  enum class Fault {
    kNone,
    kLineEnd,  ///< LF without CR before it.
    kTooLong,  ///< Above the limit; the rest of it was discarded.
  };

  std::string text;  ///< Without CR LF.
  Fault fault = Fault::kNone;
};

/// Cuts bytes into lines. Never holds more than the limit: a line that exceeds it is reported once,
/// at the limit, and the rest of it is discarded.
class LineCutter {
 public:
  explicit LineCutter(std::size_t max_length = kMaxLineLength) : max_length_(max_length) {}

  /// Result of feed().
  struct Fed {
    std::size_t used = 0;         ///< Bytes taken, from the front; pass the rest to feed() again.
    std::optional<RawLine> line;  ///< Just completed, or too long.
  };

  /// Takes bytes up to the end of the first line in them, or all of them.
  [[nodiscard]] Fed feed(std::string_view bytes);

  /// Number of bytes of the incomplete line.
  [[nodiscard]] std::size_t pending() const { return line_.size(); }

 private:
  std::size_t max_length_;
  std::string line_;
  bool dropping_ = false;  ///< The rest of an overlong line is being discarded.
};

/// parse_command() of a received line: a wrong line end gives 0007, an overlong line 0008.
[[nodiscard]] tl::expected<Command, Refusal> parse_command(const RawLine& line);

}  // namespace rondure::cmm::ipp
