#include "wire/byte_lines.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace rondure::wire {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kShown_bytes = 100;

class ByteLines final : public LineTransport {
 public:
  ByteLines(std::unique_ptr<ByteStream> stream, const ByteLinesOptions& options)
      : stream_(std::move(stream)),
        clock_(options.clock != nullptr ? *options.clock : system_clock()),
        max_line_bytes_(options.max_line_bytes) {}

  [[nodiscard]] core::Result<void> write_line(std::string_view text) override {
    if (failure_) return core::fail(*failure_);
    auto written = stream_->write(fmt::format("{}\r\n", text));
    if (!written) failure_ = written.error();
    return written;
  }

  [[nodiscard]] core::Result<std::optional<Line>> read_line(milliseconds time_limit) override {
    if (failure_) return core::fail(*failure_);
    if (!stream_->is_open()) return core::fail(closed());
    const auto deadline = clock_.now() + time_limit;
    for (;;) {
      if (auto line = take_line()) return line;
      if (received_.size() > max_line_bytes_) return lose_for_length();
      const auto left =
          std::chrono::duration_cast<milliseconds>(deadline - clock_.now() + milliseconds(1));
      auto more = stream_->read_some(std::max(milliseconds(0), left));
      if (!more) return lose(more.error());
      if (more->empty() && clock_.now() >= deadline) return std::optional<Line>{};
      received_ += *more;
    }
  }

  [[nodiscard]] std::string unfinished() const override {
    return received_.find('\n') == std::string::npos ? received_.substr(0, kShown_bytes) : "";
  }
  void close() override { stream_->close(); }
  [[nodiscard]] bool is_open() const override { return stream_->is_open(); }
  [[nodiscard]] std::string peer() const override { return stream_->peer(); }

 private:
  /// Takes the first complete line of the received bytes; nothing when there is none.
  std::optional<Line> take_line() {
    const auto end = received_.find('\n', searched_);
    if (end == std::string::npos || end > max_line_bytes_) {
      searched_ = received_.size();
      return std::nullopt;
    }
    Line line{received_.substr(0, end), false};
    received_.erase(0, end + 1);
    searched_ = 0;
    line.crlf = !line.text.empty() && line.text.back() == '\r';
    if (line.crlf) line.text.pop_back();
    return line;
  }

  [[nodiscard]] core::Error closed() const {
    return {core::Code::kMachine, fmt::format("the connection to {} is closed", peer()), {}};
  }

  tl::unexpected<core::Error> lose_for_length() {
    stream_->close();
    failure_ = {core::Code::kMachine,
                fmt::format("{} sent a line of more than {} bytes; the connection was closed",
                            peer(), max_line_bytes_),
                {}};
    return core::fail(*failure_);
  }

  /// Reports that the stream is lost, and names the line that it cut.
  tl::unexpected<core::Error> lose(core::Error error) {
    if (!received_.empty()) {
      error.what += fmt::format(" in the middle of a line, after {} bytes of it", received_.size());
    }
    failure_ = std::move(error);
    return core::fail(*failure_);
  }

  std::unique_ptr<ByteStream> stream_;
  Clock& clock_;
  std::size_t max_line_bytes_;
  std::string received_;
  std::size_t searched_ = 0;  ///< Number of received bytes that are known to contain no line end.
  std::optional<core::Error> failure_;
};

}  // namespace

std::unique_ptr<LineTransport> lines_over(std::unique_ptr<ByteStream> stream,
                                          const ByteLinesOptions& options) {
  return std::make_unique<ByteLines>(std::move(stream), options);
}

}  // namespace rondure::wire
