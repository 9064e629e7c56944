#include "tests/app/cutting_proxy.h"

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

namespace rondure::app::testing {
namespace {

sockaddr_in local(std::uint16_t port) {
  sockaddr_in out = {};
  out.sin_family = AF_INET;
  out.sin_port = htons(port);
  out.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return out;
}

// None of the sockets outlives the connection in a program that is started meanwhile (CLOEXEC).

/// A socket that listens on a free port.
int listening(std::uint16_t& port) {
  const int handle = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
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
  const int handle = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const sockaddr_in place = local(port);
  if (::connect(handle, reinterpret_cast<const sockaddr*>(&place), sizeof(place)) == 0) {
    const int at_once = 1;
    ::setsockopt(handle, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof(at_once));
    return handle;
  }
  ::close(handle);
  return -1;
}

/// Takes the first whole line, its end included, off the bytes; "" when there is none.
std::string cut_line(std::string& bytes) {
  const std::size_t end = bytes.find('\n');
  if (end == std::string::npos) return {};
  std::string line = bytes.substr(0, end + 1);
  bytes.erase(0, end + 1);
  return line;
}

std::string without_end(std::string line) {
  while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.pop_back();
  return line;
}

constexpr std::size_t kTag = 5;  // characters, and a space behind them

}  // namespace

std::uint16_t free_port() {
  std::uint16_t port = 0;
  ::close(listening(port));
  return port;
}

bool wait_for_port(std::uint16_t port) {
  for (int i = 0; i < 12'000; ++i) {
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
    const int client = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    const int server = connected(server_port_);
    const std::optional<WireFault> fault = take_fault();
    if (client >= 0 && server >= 0) {
      fault ? forward_lines(client, server, *fault) : forward(client, server);
    }
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

void CuttingProxy::damage(WireFault fault) {
  const std::lock_guard lock(mutex_);
  fault_ = std::move(fault);
  met_ = false;
}

std::optional<WireFault> CuttingProxy::take_fault() {
  const std::lock_guard lock(mutex_);
  return std::exchange(fault_, std::nullopt);
}

bool CuttingProxy::pass(int handle, const std::vector<Passed>& all) const {
  for (const Passed& passed : all) {
    for (int waited_ms = 0; waited_ms < passed.wait_ms && !ends_; waited_ms += 5) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    const auto size = static_cast<ssize_t>(passed.bytes.size());
    if (::send(handle, passed.bytes.data(), passed.bytes.size(), MSG_NOSIGNAL) != size)
      return false;
    if (passed.cut) return false;
  }
  return true;
}

void CuttingProxy::forward_lines(int client, int server, const WireFault& fault) {
  const int at_once = 1;
  ::setsockopt(client, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof(at_once));
  std::string tag;  // of the command whose answer is damaged
  int seen = 0;
  std::array<std::string, 2> waiting_bytes;
  std::array<char, 4096> bytes;
  while (!ends_) {
    std::array<pollfd, 2> waiting = {{{client, POLLIN, 0}, {server, POLLIN, 0}}};
    if (::poll(waiting.data(), waiting.size(), 20) <= 0) continue;
    for (std::size_t from = 0; from < 2; ++from) {
      if (waiting[from].revents == 0) continue;
      const auto count = ::recv(waiting[from].fd, bytes.data(), bytes.size(), 0);
      if (count <= 0) return;
      waiting_bytes[from].append(bytes.data(), static_cast<std::size_t>(count));
      for (std::string line; !(line = cut_line(waiting_bytes[from])).empty();) {
        const bool command = from == 0 && line.size() > kTag &&
                             line.compare(kTag + 1, fault.command.size(), fault.command) == 0;
        const bool meant = command && ++seen == fault.occurrence;
        if (meant) {
          met_ = true;
          tag = line.substr(0, kTag);
        }
        const bool answer = from == 1 && !tag.empty() && line.starts_with(tag + " ");
        std::vector<Passed> out = {{line}};
        if (meant && fault.to_server) out = fault.to_server(without_end(line));
        if (answer && fault.to_client) out = fault.to_client(without_end(line));
        if (answer && line.compare(kTag + 1, 1, "%") == 0) tag.clear();
        if (!pass(waiting[1 - from].fd, out)) return;
      }
    }
  }
}

}  // namespace rondure::app::testing
