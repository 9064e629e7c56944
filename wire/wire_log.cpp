#include "wire/wire_log.h"

#include <chrono>
#include <ctime>
#include <fstream>
#include <string>
#include <utility>

#include <fmt/chrono.h>

namespace rondure::wire {
namespace {

constexpr std::size_t kLogged_bytes = 4096;

/// The current time as "2026-11-21T02:33:02.123456Z".
std::string utc_now() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const auto since = std::chrono::duration_cast<std::chrono::microseconds>(now).count();
  return fmt::format("{:%FT%T}.{:06}Z", fmt::gmtime(static_cast<std::time_t>(since / 1'000'000)),
                     since % 1'000'000);
}

std::string printable(std::string_view text) {
  std::string out;
  for (const char c : text.substr(0, kLogged_bytes)) {
    if (c >= ' ' && c <= '~') {
      out += c;
    } else {
      out += fmt::format("\\x{:02X}", static_cast<unsigned char>(c));
    }
  }
  if (text.size() > kLogged_bytes) out += fmt::format(" ... ({} bytes)", text.size());
  return out;
}

class LoggedLine final : public LineTransport {
 public:
  LoggedLine(std::unique_ptr<LineTransport> inner, std::ofstream file, Side side)
      : inner_(std::move(inner)),
        file_(std::move(file)),
        sent_(side == Side::kClient ? "-> C:" : "-> S:"),
        received_(side == Side::kClient ? "<- S:" : "<- C:") {
    write("-- #:", fmt::format("connected with {}", inner_->peer()));
  }
  ~LoggedLine() override { close(); }

  [[nodiscard]] core::Result<void> write_line(std::string_view text) override {
    write(sent_, text);
    return noting_loss(inner_->write_line(text));
  }
  [[nodiscard]] core::Result<std::optional<Line>> read_line(
      std::chrono::milliseconds time_limit) override {
    auto line = noting_loss(inner_->read_line(time_limit));
    if (line && *line) {
      write(received_, (*line)->text);
      if (!(*line)->crlf) write("-- #:", "that line was ended by LF alone");
    }
    return line;
  }
  void close() override {
    if (inner_->is_open()) write("-- #:", "closed");
    inner_->close();
  }
  [[nodiscard]] bool is_open() const override { return inner_->is_open(); }
  [[nodiscard]] std::string unfinished() const override { return inner_->unfinished(); }
  [[nodiscard]] std::string peer() const override { return inner_->peer(); }

 private:
  void write(std::string_view who, std::string_view text) {
    file_ << utc_now() << ' ' << who << ' ' << printable(text) << '\n' << std::flush;
  }

  /// Logs once how the connection was lost.
  template <class T>
  core::Result<T> noting_loss(core::Result<T> result) {
    if (!result && !lost_) {
      lost_ = true;
      write("-- #:", result.error().what);
    }
    return result;
  }

  std::unique_ptr<LineTransport> inner_;
  std::ofstream file_;
  std::string_view sent_;
  std::string_view received_;
  bool lost_ = false;
};

}  // namespace

core::Result<std::unique_ptr<LineTransport>> logged(std::unique_ptr<LineTransport> inner,
                                                    const std::filesystem::path& file, Side side) {
  std::ofstream stream(file, std::ios::app);
  if (!stream) {
    return core::fail(core::Code::kFile,
                      "the wire log cannot be opened for writing; check folder and permission",
                      file.string());
  }
  return std::make_unique<LoggedLine>(std::move(inner), std::move(stream), side);
}

}  // namespace rondure::wire
