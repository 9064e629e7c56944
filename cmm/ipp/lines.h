#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "cmm/ipp/grammar.h"

namespace rondure::cmm::ipp {

/// One line out of a stream of bytes.
struct RawLine {
  enum class Fault {
    kNone,
    kLineEnd,  ///< LF without CR before it.
    kTooLong,  ///< Above the limit; what was beyond it is gone.
  };

  std::string text;  ///< Without CR LF.
  Fault fault = Fault::kNone;
};

/// Cuts lines out of bytes as they come. Holds at most the limit, whatever comes: a line that gets
/// longer is told once, at its limit, and the rest of it is thrown away.
class LineCutter {
 public:
  explicit LineCutter(std::size_t max_length = kMaxLineLength) : max_length_(max_length) {}

  /// What feed() did.
  struct Fed {
    std::size_t used = 0;         ///< Bytes taken, from the front; feed the others again.
    std::optional<RawLine> line;  ///< Complete, or too long, now.
  };

  /// Takes bytes up to the end of the first line in them, or all of them.
  [[nodiscard]] Fed feed(std::string_view bytes);

  /// Bytes of a line whose end has not come.
  [[nodiscard]] std::size_t pending() const { return line_.size(); }

 private:
  std::size_t max_length_;
  std::string line_;
  bool dropping_ = false;  ///< The rest of a line that was too long.
};

/// parse_command() of a line as it came: a wrong line end is 0007, one too long 0008.
[[nodiscard]] tl::expected<Command, Refusal> parse_command(const RawLine& line);

}  // namespace rondure::cmm::ipp
