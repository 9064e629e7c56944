#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "wire/transport.h"

namespace rondure::cmm {

/// A transport whose other end is a function of the test: each line that is sent gives the lines
/// that come back. Without further lines it stays silent, like a server that hangs.
class ScriptedServer final : public wire::LineTransport {
 public:
  /// Takes the tag and the rest of a line; returns whole lines.
  using Answer =
      std::function<std::vector<std::string>(const std::string& tag, const std::string& method)>;

  explicit ScriptedServer(Answer answer) : answer_(std::move(answer)) {}

  core::Result<void> write_line(std::string_view text) override {
    if (!open_) return core::fail(core::Code::kMachine, "the script is closed");
    const std::string line(text);
    for (std::string& reply : answer_(line.substr(0, 5), line.substr(6))) {
      lines_.push_back(std::move(reply));
    }
    return {};
  }
  core::Result<std::optional<wire::Line>> read_line(std::chrono::milliseconds) override {
    if (lines_.empty()) {
      if (open_ && !hangs_up_) return std::optional<wire::Line>{};
      open_ = false;
      return core::fail(core::Code::kMachine, "the script closed the connection");
    }
    wire::Line out{std::move(lines_.front()), true};
    lines_.pop_front();
    return out;
  }
  void close() override { open_ = false; }
  bool is_open() const override { return open_; }
  std::string unfinished() const override { return half_; }
  std::string peer() const override { return "script"; }
  /// Closes the connection after the last line.
  void hang_up() { hangs_up_ = true; }
  /// Sends `half`, a line without an end, after the last line.
  void trail_off(std::string half) { half_ = std::move(half); }
  /// Sends a line that answers no command.
  void say(std::string line) { lines_.push_back(std::move(line)); }

 private:
  Answer answer_;
  std::deque<std::string> lines_;
  std::string half_;
  bool open_ = true;
  bool hangs_up_ = false;
};

}  // namespace rondure::cmm
