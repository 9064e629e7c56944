#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace rondure::app::testing {

/// What is sent in place of a line.
struct Passed {
  std::string bytes;  ///< Line ends included.
  int wait_ms = 0;    ///< Before it.
  bool cut = false;   ///< The connection is closed after it.
};

/// A fault on the wire: what becomes of one command and of the lines that answer it.
struct WireFault {
  using Damage = std::function<std::vector<Passed>(const std::string& line)>;

  std::string command;  ///< How the text of the command begins, without its tag.
  int occurrence = 1;   ///< Which of these commands in a connection.
  Damage to_server;     ///< Of the command; empty: it passes.
  Damage to_client;     ///< Of each line with its tag, up to its %; empty: they pass.
};

/// Stands between a client and a server on this computer, counts the bytes that pass, and cuts the
/// connection behind a given number of them, or damages one transaction. One connection at a time.
class CuttingProxy {
 public:
  static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

  explicit CuttingProxy(std::uint16_t server_port);
  ~CuttingProxy();
  CuttingProxy(const CuttingProxy&) = delete;
  CuttingProxy& operator=(const CuttingProxy&) = delete;

  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// The next connection lives for so many bytes, both ways together; those after it for ever.
  void cut_after(std::uint64_t bytes) { cut_after_ = bytes; }
  /// The next connection has this fault; those after it have none.
  void damage(WireFault fault);
  /// Whether the command of the last fault came.
  [[nodiscard]] bool fault_met() const { return met_; }
  /// Bytes that have passed since this was asked last.
  [[nodiscard]] std::uint64_t take_count() { return passed_.exchange(0); }

 private:
  void serve();
  void forward(int client, int server);
  void forward_lines(int client, int server, const WireFault& fault);
  [[nodiscard]] std::optional<WireFault> take_fault();
  /// False when the connection is to end.
  [[nodiscard]] bool pass(int handle, const std::vector<Passed>& all) const;

  std::uint16_t server_port_;
  std::uint16_t port_ = 0;  // before the listener, which sets it
  int listener_ = -1;
  std::atomic<std::uint64_t> cut_after_ = kNever;
  std::atomic<std::uint64_t> passed_ = 0;
  std::mutex mutex_;
  std::optional<WireFault> fault_;  ///< Of the next connection.
  std::atomic<bool> met_ = false;
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

/// A port of this computer that nobody uses now.
[[nodiscard]] std::uint16_t free_port();
/// Whether somebody listens there within 10 s.
[[nodiscard]] bool wait_for_port(std::uint16_t port);

}  // namespace rondure::app::testing
