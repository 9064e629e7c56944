#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <string>

#include <httplib.h>

namespace rondure::web {

/// A connected socket for one request and its answer, with a common time limit: a client that sends
/// or reads too slowly is dropped, and so is one that sends more than 32 kB. After `ending` becomes
/// true, the stream waits for no request, and an answer may take half a second. Does not close the
/// socket.
class LiveStream final : public httplib::Stream {
 public:
  LiveStream(socket_t socket, std::chrono::milliseconds limit, const std::atomic<bool>& ending);

  [[nodiscard]] bool is_readable() const override;
  [[nodiscard]] bool is_writable() const override;
  ssize_t read(char* ptr, size_t size) override;
  ssize_t write(const char* ptr, size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  [[nodiscard]] socket_t socket() const override { return socket_; }

  /// Ends the answer and reads some of what the client still sends, so that a reset of the
  /// connection does not destroy the answer.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  /// Waits until the socket is ready for `events` of poll(); false at the limit.
  [[nodiscard]] bool wait(short events) const;

  socket_t socket_;
  mutable Clock::time_point end_;
  mutable bool hurried_ = false;  ///< The end of the run was noticed.
  const std::atomic<bool>& ending_;
  std::array<char, 4096> buffer_{};
  std::size_t begin_ = 0;
  std::size_t filled_ = 0;
  std::size_t taken_ = 0;  ///< Bytes of the request received in total.
};

}  // namespace rondure::web
