#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <string>

#include <httplib.h>

namespace rondure::web {

/// A connected socket for one request and its answer, within a time for both together: a client
/// that sends or reads by drops is left, and so is one that sends more than 32 kB. When `ending`
/// becomes true no request is waited for, and an answer has half a second. Does not close the
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

  /// Ends the answer and takes some of what the client still sends, so that the answer is not lost
  /// with a reset of the connection.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  /// Waits until the socket is ready for `events` of poll(); false at the limit.
  [[nodiscard]] bool wait(short events) const;

  socket_t socket_;
  mutable Clock::time_point end_;
  mutable bool hurried_ = false;  ///< The end of the run was seen.
  const std::atomic<bool>& ending_;
  std::array<char, 4096> buffer_{};
  std::size_t begin_ = 0;
  std::size_t filled_ = 0;
  std::size_t taken_ = 0;  ///< Of the request, in all.
};

}  // namespace rondure::web
