#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <thread>

namespace rondure::app::testing {

/// Stands between a client and a server on this computer, counts the bytes that pass, and cuts the
/// connection behind a given number of them. One connection at a time.
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
  /// Bytes that have passed since this was asked last.
  [[nodiscard]] std::uint64_t take_count() { return passed_.exchange(0); }

 private:
  void serve();
  void forward(int client, int server);

  std::uint16_t server_port_;
  std::uint16_t port_ = 0;  // before the listener, which sets it
  int listener_ = -1;
  std::atomic<std::uint64_t> cut_after_ = kNever;
  std::atomic<std::uint64_t> passed_ = 0;
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

/// A port of this computer that nobody uses now.
[[nodiscard]] std::uint16_t free_port();
/// Whether somebody listens there within 10 s.
[[nodiscard]] bool wait_for_port(std::uint16_t port);

}  // namespace rondure::app::testing
