#include "cmm/ipp/lines.h"

#include <algorithm>

#include <fmt/format.h>

#include "cmm/ipp/internal/errors.h"

namespace rondure::cmm::ipp {

LineCutter::Fed LineCutter::feed(std::string_view bytes) {
  const std::size_t end = std::min(bytes.find('\n'), bytes.size());
  const bool ended = end < bytes.size();
  Fed out{ended ? end + 1 : end, std::nullopt};
  if (dropping_) {
    dropping_ = !ended;
    return out;
  }
  const std::size_t room = max_length_ + 1 - line_.size();  // one more for CR
  if (end > room) {
    out.line = RawLine{line_.append(bytes.substr(0, room)), RawLine::Fault::kTooLong};
    line_.clear();
    dropping_ = !ended;
    return out;
  }
  line_.append(bytes.substr(0, end));
  if (!ended) return out;
  out.line.emplace();
  std::string& text = out.line->text;
  text.swap(line_);
  if (text.ends_with('\r')) {
    text.pop_back();
  } else {
    out.line->fault =
        text.size() > max_length_ ? RawLine::Fault::kTooLong : RawLine::Fault::kLineEnd;
  }
  return out;
}

tl::expected<Command, Refusal> parse_command(const RawLine& line) {
  switch (line.fault) {
    case RawLine::Fault::kLineEnd:
      return tl::unexpected(Refusal{kIllegalCharacter, {}, "the line ends without CR"});
    case RawLine::Fault::kTooLong:
      return tl::unexpected(
          Refusal{kProtocolError, {}, fmt::format("a line above {} characters", kMaxLineLength)});
    case RawLine::Fault::kNone:
      break;
  }
  return parse_command(std::string_view(line.text));
}

}  // namespace rondure::cmm::ipp
