#include "wire/tcp_line.h"

#include <netinet/tcp.h>
#include <sys/socket.h>

#include <array>
#include <utility>

#include <fmt/format.h>
#include <asio.hpp>

#include "wire/byte_lines.h"

namespace rondure::wire {
namespace {

using std::chrono::milliseconds;
using Tcp = asio::ip::tcp;

constexpr std::size_t kTcpChunk_bytes = 16'384;

/// Detects within about 25 s a peer that vanished without closing (power, cable): by probes on an
/// idle connection, and by data that is not acknowledged. The system default is two hours.
void notice_a_dead_peer(int handle) {
  const auto set = [handle](int level, int name, int value) {  // failures do no harm
    (void)::setsockopt(handle, level, name, &value, sizeof(value));
  };
  set(SOL_SOCKET, SO_KEEPALIVE, 1);
  set(IPPROTO_TCP, TCP_KEEPIDLE, 10);          // s of silence until the first probe
  set(IPPROTO_TCP, TCP_KEEPINTVL, 5);          // s between two probes
  set(IPPROTO_TCP, TCP_KEEPCNT, 3);            // probes without an answer
  set(IPPROTO_TCP, TCP_USER_TIMEOUT, 25'000);  // ms, for data that was sent
}

std::string place(const std::string& host, std::uint16_t port) {
  return fmt::format("{}:{}", host, port);
}

/// Runs the pending operation to its end, or calls `cancel` at the time limit and returns false. In
/// both cases the operation's handler has been called.
template <class Cancel>
bool run_within(asio::io_context& io, milliseconds limit, Cancel cancel) {
  io.restart();
  io.run_for(limit);
  if (io.stopped()) return true;
  cancel();
  io.run();
  return false;
}

class TcpStream final : public ByteStream {
 public:
  TcpStream(std::unique_ptr<asio::io_context> io, Tcp::socket socket, const TcpOptions& options)
      : io_(std::move(io)), socket_(std::move(socket)), write_limit_(options.write_limit) {
    asio::error_code ignored;  // the connection works without these options
    socket_.set_option(Tcp::no_delay(true), ignored);
    notice_a_dead_peer(socket_.native_handle());
    asio::error_code unknown;
    const auto end = socket_.remote_endpoint(unknown);
    peer_ = unknown ? "a peer that has gone" : place(end.address().to_string(), end.port());
  }
  ~TcpStream() override { close(); }

  [[nodiscard]] core::Result<void> write(std::string_view bytes) override {
    if (!open_) return core::fail(failure_);
    asio::error_code result;
    asio::async_write(socket_, asio::buffer(bytes),
                      [&](const asio::error_code& error, std::size_t) { result = error; });
    if (!run_within(*io_, write_limit_, [&] { cancel(); }) && result) {
      return lose(fmt::format("{} takes no data for {:g} s; the connection was closed", peer_,
                              static_cast<double>(write_limit_.count()) / 1000.0));
    }
    if (result) return lose(fmt::format("the connection to {} broke: {}", peer_, result.message()));
    return {};
  }

  [[nodiscard]] core::Result<std::string> read_some(milliseconds time_limit) override {
    if (!open_) return core::fail(failure_);
    asio::error_code result;
    std::size_t count = 0;
    socket_.async_read_some(asio::buffer(chunk_),
                            [&](const asio::error_code& error, std::size_t n) {
                              result = error;
                              count = n;
                            });
    (void)run_within(*io_, time_limit, [&] { cancel(); });
    if (!result || result == asio::error::operation_aborted || count > 0) {
      return std::string(chunk_.data(), count);
    }
    if (result == asio::error::eof) return lose(fmt::format("{} closed the connection", peer_));
    return lose(fmt::format("the connection to {} broke: {}", peer_, result.message()));
  }

  void close() override {
    if (!open_) return;
    open_ = false;
    failure_ = {core::Code::kMachine, fmt::format("the connection to {} is closed", peer_), {}};
    asio::error_code ignored;
    socket_.shutdown(Tcp::socket::shutdown_both, ignored);
    socket_.close(ignored);
  }

  [[nodiscard]] bool is_open() const override { return open_; }
  [[nodiscard]] std::string peer() const override { return peer_; }

 private:
  void cancel() {
    asio::error_code ignored;
    socket_.cancel(ignored);
  }

  tl::unexpected<core::Error> lose(std::string what) {
    close();
    failure_ = {core::Code::kMachine, std::move(what), {}};
    return core::fail(failure_);
  }

  std::unique_ptr<asio::io_context> io_;  // outlives the socket
  Tcp::socket socket_;
  milliseconds write_limit_;
  std::string peer_;
  std::array<char, kTcpChunk_bytes> chunk_ = {};
  bool open_ = true;
  core::Error failure_;
};

std::unique_ptr<LineTransport> lines_of(std::unique_ptr<asio::io_context> io, Tcp::socket socket,
                                        const TcpOptions& options) {
  return lines_over(std::make_unique<TcpStream>(std::move(io), std::move(socket), options),
                    {.max_line_bytes = options.max_line_bytes, .clock = nullptr});
}

}  // namespace

core::Result<std::unique_ptr<LineTransport>> connect_tcp(const std::string& host,
                                                         std::uint16_t port,
                                                         const TcpOptions& options) {
  auto io = std::make_unique<asio::io_context>();
  Tcp::resolver resolver(*io);
  Tcp::socket socket(*io);
  asio::error_code result;
  bool resolved = false;
  resolver.async_resolve(
      host, std::to_string(port),
      [&](const asio::error_code& error, const Tcp::resolver::results_type& places) {
        result = error;
        if (error) return;
        resolved = true;
        asio::async_connect(
            socket, places,
            [&](const asio::error_code& refused, const Tcp::endpoint&) { result = refused; });
      });
  const bool in_time = run_within(*io, options.connect_limit, [&] {
    resolver.cancel();
    asio::error_code ignored;
    socket.close(ignored);
  });
  const std::string where = place(host, port);
  if (!in_time && result) {
    return core::machine_fault("{} does not answer within {} ms; check address, cable and firewall",
                               where, options.connect_limit.count());
  }
  if (result && !resolved) {
    return core::machine_fault("the computer {} is not known here: {}", host, result.message());
  }
  if (result) {
    return core::machine_fault(
        "no connection to {}: {}; check that the server runs and listens on port {}", where,
        result.message(), port);
  }
  return lines_of(std::move(io), std::move(socket), options);
}

struct TcpListener::Socket {
  asio::io_context io;
  Tcp::acceptor acceptor{io};
  TcpOptions options;
};

TcpListener::TcpListener(std::unique_ptr<Socket> socket) : socket_(std::move(socket)) {}
TcpListener::TcpListener(TcpListener&&) noexcept = default;
TcpListener& TcpListener::operator=(TcpListener&&) noexcept = default;
TcpListener::~TcpListener() = default;

core::Result<TcpListener> TcpListener::open(const std::string& address, std::uint16_t port,
                                            const TcpOptions& options) {
  auto socket = std::make_unique<Socket>();
  socket->options = options;
  asio::error_code error;
  const auto ip = asio::ip::make_address(address, error);
  if (error) return core::machine_fault("{} is not an IP address, e.g. 127.0.0.1", address);
  const Tcp::endpoint end(ip, port);
  Tcp::acceptor& acceptor = socket->acceptor;
  acceptor.open(end.protocol(), error);
  if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(end, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error) {
    return core::machine_fault("cannot listen on {}: {}; choose another port", place(address, port),
                               error.message());
  }
  return TcpListener(std::move(socket));
}

std::uint16_t TcpListener::port() const {
  asio::error_code ignored;
  return socket_->acceptor.local_endpoint(ignored).port();
}

core::Result<std::unique_ptr<LineTransport>> TcpListener::accept(milliseconds time_limit) {
  // a context of its own, because the client outlives the listener
  auto io = std::make_unique<asio::io_context>();
  Tcp::socket client(*io);
  asio::error_code result;
  socket_->acceptor.async_accept(client, [&](const asio::error_code& error) { result = error; });
  (void)run_within(socket_->io, time_limit, [&] {
    asio::error_code ignored;
    socket_->acceptor.cancel(ignored);
  });
  if (result == asio::error::operation_aborted) return std::unique_ptr<LineTransport>{};
  if (result) return core::machine_fault("no client could be accepted: {}", result.message());
  return lines_of(std::move(io), std::move(client), socket_->options);
}

}  // namespace rondure::wire
