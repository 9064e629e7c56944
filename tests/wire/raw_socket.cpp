#include "tests/wire/raw_socket.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

namespace rondure::wire {

RawSocket::RawSocket(std::uint16_t port) : handle_(::socket(AF_INET, SOCK_STREAM, 0)) {
  const timeval patience = {5, 0};
  ::setsockopt(handle_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
  sockaddr_in place = {};
  place.sin_family = AF_INET;
  place.sin_port = htons(port);
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  connected_ = ::connect(handle_, reinterpret_cast<const sockaddr*>(&place), sizeof(place)) == 0;
}

RawSocket::~RawSocket() { close(); }

bool RawSocket::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const auto taken = ::send(handle_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (taken <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(taken));
  }
  return true;
}

std::string RawSocket::receive(std::size_t most) {
  std::string out(most, '\0');
  const auto count = ::recv(handle_, out.data(), most, 0);
  out.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  return out;
}

void RawSocket::close() {
  if (handle_ >= 0) ::close(handle_);
  handle_ = -1;
}

}  // namespace rondure::wire
