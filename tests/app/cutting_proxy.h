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

/// Bytes that the proxy sends in place of a line.
struct Passed {
  std::string bytes;  ///< Line ends included.
  int wait_ms = 0;    ///< Pause before the bytes [ms].
  bool cut = false;   ///< Closes the connection after the bytes.
};

/// A fault on the wire: damages one command, or the lines that answer it.
struct WireFault {
  using Damage = std::function<std::vector<Passed>(const std::string& line)>;

  std::string command;  ///< Beginning of the command text, without its tag.
  int occurrence = 1;   ///< Number of the command among these in a connection, from 1.
  Damage to_server;     ///< Applied to the command; empty: it passes.
  Damage to_client;     ///< Applied to each answering line, up to its %; empty: all pass.
};

/// Stands between a client and a server on this computer, counts the bytes that pass, and cuts the
/// connection after a given number of them, or damages one transaction. One connection at a time.
class CuttingProxy {
 public:
  static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

  explicit CuttingProxy(std::uint16_t server_port);
  ~CuttingProxy();
  CuttingProxy(const CuttingProxy&) = delete;
  CuttingProxy& operator=(const CuttingProxy&) = delete;

  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// The next connection ends after `bytes` bytes in both directions; later ones have no limit.
  void cut_after(std::uint64_t bytes) { cut_after_ = bytes; }
  /// The next connection has this fault; those after it have none.
  void damage(WireFault fault);
  /// Whether the command of the last fault was met.
  [[nodiscard]] bool fault_met() const { return met_; }
  /// Bytes that have passed since the last call.
  [[nodiscard]] std::uint64_t take_count() { return passed_.exchange(0); }

 private:
  void serve();
  void forward(int client, int server);
  void forward_lines(int client, int server, const WireFault& fault);
  [[nodiscard]] std::optional<WireFault> take_fault();
  /// Sends the bytes; false when the connection must end.
  [[nodiscard]] bool pass(int handle, const std::vector<Passed>& all) const;

  std::uint16_t server_port_;
  std::uint16_t port_ = 0;  // before the listener, which sets it
  int listener_ = -1;
  std::atomic<std::uint64_t> cut_after_ = kNever;
  std::atomic<std::uint64_t> passed_ = 0;
  std::mutex mutex_;
  std::optional<WireFault> fault_;  ///< Fault of the next connection.
  std::atomic<bool> met_ = false;
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

/// A port of this computer that no program uses now.
[[nodiscard]] std::uint16_t free_port();
/// Whether a server listens on the port within 10 s.
[[nodiscard]] bool wait_for_port(std::uint16_t port);

}  // namespace rondure::app::testing
