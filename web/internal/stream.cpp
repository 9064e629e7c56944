#include "web/internal/stream.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace rondure::web {
namespace {

/// A browser's request has one or two kB. The library limits the length of a line, but neither the
/// number of lines nor a chunked body.
constexpr std::size_t kMostRequest_bytes = 32'768;
constexpr std::size_t kMostRest_bytes = 262'144;  ///< Bytes read after a refused request.

}  // namespace

LiveStream::LiveStream(socket_t socket, std::chrono::milliseconds limit,
                       const std::atomic<bool>& ending)
    : socket_(socket), end_(Clock::now() + limit), ending_(ending) {}

bool LiveStream::wait(short events) const {
  constexpr int kLook_ms = 20;  // time after which the end of the run is noticed
  constexpr auto kLastAnswer = std::chrono::milliseconds(500);
  while (Clock::now() < end_) {
    if (ending_ && events == POLLIN) return false;
    if (ending_ && !hurried_) {
      end_ = std::min(end_, Clock::now() + kLastAnswer);
      hurried_ = true;
    }
    pollfd look{socket_, events, 0};
    const int ready = ::poll(&look, 1, kLook_ms);
    if (ready > 0) return true;  // the next call reports an error
    if (ready < 0 && errno != EINTR) return false;
  }
  return false;
}

bool LiveStream::is_readable() const { return begin_ < filled_ || wait(POLLIN); }

bool LiveStream::is_writable() const { return wait(POLLOUT); }

ssize_t LiveStream::read(char* ptr, size_t size) {
  if (begin_ == filled_) {
    if (taken_ >= kMostRequest_bytes || !wait(POLLIN)) return -1;
    const ssize_t got = ::recv(socket_, buffer_.data(), buffer_.size(), MSG_DONTWAIT);
    if (got <= 0) return got;
    begin_ = 0;
    filled_ = static_cast<std::size_t>(got);
    taken_ += filled_;
  }
  const std::size_t n = std::min(size, filled_ - begin_);
  std::memcpy(ptr, buffer_.data() + begin_, n);
  begin_ += n;
  return static_cast<ssize_t>(n);
}

ssize_t LiveStream::write(const char* ptr, size_t size) {
  if (!wait(POLLOUT)) return -1;
  return ::send(socket_, ptr, size, MSG_DONTWAIT | MSG_NOSIGNAL);
}

void LiveStream::get_remote_ip_and_port(std::string& ip, int& port) const {
  ip = "127.0.0.1";  // only this computer can connect
  port = 0;
}

void LiveStream::get_local_ip_and_port(std::string& ip, int& port) const {
  ip = "127.0.0.1";
  port = 0;
}

void LiveStream::finish() {
  constexpr auto kRest = std::chrono::milliseconds(200);
  end_ = std::min(end_, Clock::now() + kRest);
  ::shutdown(socket_, SHUT_WR);
  std::array<char, 4096> rest{};
  for (std::size_t taken = 0; taken < kMostRest_bytes && wait(POLLIN);) {
    const ssize_t got = ::recv(socket_, rest.data(), rest.size(), MSG_DONTWAIT);
    if (got <= 0) return;
    taken += static_cast<std::size_t>(got);
  }
}

}  // namespace rondure::web
