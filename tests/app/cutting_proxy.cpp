#include "tests/app/cutting_proxy.h"

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>

namespace rondure::app::testing {
namespace {

sockaddr_in local(std::uint16_t port) {
  sockaddr_in out = {};
  out.sin_family = AF_INET;
  out.sin_port = htons(port);
  out.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return out;
}

/// A socket that listens on a free port.
int listening(std::uint16_t& port) {
  const int handle = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in place = local(0);
  socklen_t size = sizeof(place);
  ::bind(handle, reinterpret_cast<const sockaddr*>(&place), size);
  ::listen(handle, 4);
  ::getsockname(handle, reinterpret_cast<sockaddr*>(&place), &size);
  port = ntohs(place.sin_port);
  return handle;
}

/// A connected socket, or -1.
int connected(std::uint16_t port) {
  const int handle = ::socket(AF_INET, SOCK_STREAM, 0);
  const sockaddr_in place = local(port);
  if (::connect(handle, reinterpret_cast<const sockaddr*>(&place), sizeof(place)) == 0) {
    const int at_once = 1;
    ::setsockopt(handle, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof(at_once));
    return handle;
  }
  ::close(handle);
  return -1;
}

}  // namespace

std::uint16_t free_port() {
  std::uint16_t port = 0;
  ::close(listening(port));
  return port;
}

bool wait_for_port(std::uint16_t port) {
  for (int i = 0; i < 1000; ++i) {
    const int handle = connected(port);
    if (handle >= 0) {
      ::close(handle);
      return true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

CuttingProxy::CuttingProxy(std::uint16_t server_port)
    : server_port_(server_port), listener_(listening(port_)), thread_([this] { serve(); }) {}

CuttingProxy::~CuttingProxy() {
  ends_ = true;
  thread_.join();
  ::close(listener_);
}

void CuttingProxy::serve() {
  while (!ends_) {
    pollfd waiting = {listener_, POLLIN, 0};
    if (::poll(&waiting, 1, 20) <= 0) continue;
    const int client = ::accept(listener_, nullptr, nullptr);
    const int server = connected(server_port_);
    if (client >= 0 && server >= 0) forward(client, server);
    ::close(client);
    ::close(server);
  }
}

void CuttingProxy::forward(int client, int server) {
  const int at_once = 1;
  ::setsockopt(client, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof(at_once));
  std::uint64_t left = cut_after_.exchange(kNever);
  std::array<char, 4096> bytes;
  while (!ends_ && left > 0) {
    std::array<pollfd, 2> waiting = {{{client, POLLIN, 0}, {server, POLLIN, 0}}};
    if (::poll(waiting.data(), waiting.size(), 20) <= 0) continue;
    for (std::size_t from = 0; from < 2 && left > 0; ++from) {
      if (waiting[from].revents == 0) continue;
      const auto most = static_cast<std::size_t>(std::min<std::uint64_t>(left, bytes.size()));
      const auto count = ::recv(waiting[from].fd, bytes.data(), most, 0);
      if (count <= 0) return;
      const auto size = static_cast<std::size_t>(count);
      if (::send(waiting[1 - from].fd, bytes.data(), size, MSG_NOSIGNAL) != count) return;
      left -= size;
      passed_ += size;
    }
  }
}

}  // namespace rondure::app::testing
