#include "web/internal/server.h"

#include <poll.h>
#include <sys/random.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <httplib.h>

#include "web/page.h"

namespace rondure::web {
namespace {

bool is_json(std::string_view content_type) {
  const std::string_view type = content_type.substr(0, content_type.find(';'));
  return type == "application/json" || type == "application/json ";
}

}  // namespace

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) return {};
  std::string out;
  for (const unsigned char byte : bytes) out += fmt::format("{:02x}", byte);
  return out;
}

bool same_secret(std::string_view expected, std::string_view given) {
  unsigned difference = expected.size() == given.size() && !expected.empty() ? 0U : 1U;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const char known = i < expected.size() ? expected[i] : '\0';
    difference |= static_cast<unsigned>(static_cast<unsigned char>(known) ^
                                        static_cast<unsigned char>(given[i]));
  }
  return difference == 0U;
}

std::optional<Refusal> refuse_host(const LiveGate& gate, std::string_view host) {
  if (host == fmt::format("127.0.0.1:{}", gate.port) ||
      host == fmt::format("localhost:{}", gate.port)) {
    return std::nullopt;
  }
  return Refusal{403, "this page answers under its own address only"};
}

std::optional<Refusal> refuse_stop(const LiveGate& gate, const LiveRequest& request) {
  if (!gate.control)
    return Refusal{403, "this page is read-only; start the run with --control to stop it here"};
  if (auto refusal = refuse_host(gate, request.host)) return refusal;
  if (request.origin != "http://" + request.host)
    return Refusal{403, "the request comes from another page"};
  if (!request.fetch_site.empty() && request.fetch_site != "same-origin")
    return Refusal{403, "the request comes from another site"};
  if (!is_json(request.content_type)) return Refusal{415, "the content type is not JSON"};
  if (!same_secret(gate.token, request.token))
    return Refusal{403, "the token is not that of this run; open the address that it printed"};
  return std::nullopt;
}

namespace {

constexpr std::size_t kThreads = 8;
constexpr int kWaiting = 128;      ///< Connections not accepted yet.
constexpr int kMostAccepted = 64;  ///< Connections waiting for a thread; more are closed.
constexpr std::size_t kMostBody_bytes = 1024;
/// Limit for a request and its answer.
constexpr auto kConnection = std::chrono::milliseconds(2000);
constexpr const char* kAddress = "127.0.0.1";

/// Allows one program per port; the library's default would share it between two.
void allow_reuse_after_end(socket_t socket) {
  const int yes = 1;
  ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
}

/// The header if it was sent exactly once; otherwise empty.
std::string only(const httplib::Request& request, const char* name) {
  return request.get_header_value_count(name) == 1 ? request.get_header_value(name) : std::string();
}

LiveRequest told_by(const httplib::Request& request) {
  return {only(request, "Host"), only(request, "Origin"), only(request, "Sec-Fetch-Site"),
          only(request, "Content-Type"), only(request, "X-Rondure-Token")};
}

std::uint64_t number_of(const std::string& text) {
  std::uint64_t out = 0;
  std::from_chars(text.data(), text.data() + text.size(), out);
  return out;
}

void refuse(const Refusal& refusal, httplib::Response& response) {
  response.status = refusal.status;
  response.set_content(refusal.why + "\n", "text/plain; charset=utf-8");
}

/// Blocks signals, which must reach the run, and gives the run priority.
class QuietThreads {
 public:
  QuietThreads() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~QuietThreads() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  QuietThreads(const QuietThreads&) = delete;
  QuietThreads& operator=(const QuietThreads&) = delete;

 private:
  sigset_t before_{};
};

/// In the accepting thread: the connection of the current task exceeds the limit.
thread_local bool one_too_many = false;

/// The library's threads with a limit on waiting connections: silent clients would otherwise use up
/// the files that the process may open, and the run needs some. The library does not accept a
/// refusal: a task beyond the limit runs at once, and closes its connection unread.
class BoundedQueue final : public httplib::TaskQueue {
 public:
  void enqueue(std::function<void()> task) override {
    if (waiting_ >= kMostAccepted) {
      one_too_many = true;
      task();
      one_too_many = false;
      return;
    }
    ++waiting_;
    pool_.enqueue([this, task = std::move(task)] {
      --waiting_;
      task();
    });
  }

  void shutdown() override { pool_.shutdown(); }

 private:
  std::atomic<int> waiting_ = 0;
  httplib::ThreadPool pool_{kThreads};
};

}  // namespace

/// The library's server with connections of limited duration.
class LiveServer::Http final : public httplib::Server {
 public:
  Http(LiveGate gate, std::string page, LiveHandlers handlers)
      : gate_(std::move(gate)), page_(std::move(page)), handlers_(std::move(handlers)) {
    new_task_queue = [] { return new BoundedQueue; };
    set_socket_options(allow_reuse_after_end);
    set_payload_max_length(kMostBody_bytes);
    set_tcp_nodelay(true);
    set_default_headers(
        {{"Cache-Control", "no-store"},
         {"Content-Security-Policy",
          "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
          "img-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
         {"Cross-Origin-Opener-Policy", "same-origin"},
         {"Cross-Origin-Resource-Policy", "same-origin"},
         {"Referrer-Policy", "no-referrer"},
         {"X-Content-Type-Options", "nosniff"},
         {"X-Frame-Options", "DENY"}});
    set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      auto refusal = refuse_host(gate_, only(request, "Host"));
      // The library accepts a chunked body without a limit. Browsers state the length of their
      // bodies.
      if (!refusal && request.has_header("Transfer-Encoding"))
        refusal = Refusal{411, "the length of the body is not stated"};
      if (!refusal) return HandlerResponse::Unhandled;
      refuse(*refusal, response);
      return HandlerResponse::Handled;
    });
    serve_page();
    Get("/live", [this](const httplib::Request& request, httplib::Response& response) {
      response.set_content(handlers_.state(number_of(request.get_param_value("since")),
                                           request.get_param_value("client")),
                           "application/json");
    });
    serve_stop();
  }

  [[nodiscard]] const LiveGate& gate() const { return gate_; }

  /// The port that was opened, or none.
  [[nodiscard]] bool take_port(std::uint16_t port) {
    const int had = port == 0                      ? bind_to_any_port(kAddress)
                    : bind_to_port(kAddress, port) ? port
                                                   : -1;
    if (had <= 0) return false;
    gate_.port = static_cast<std::uint16_t>(had);
    // the library's backlog of five makes a sixth browser wait a second
    ::listen(svr_sock_, kWaiting);
    return true;
  }

  void end() {
    ending_ = true;
    stop();
  }

 private:
  void serve_page() {
    Get("/", [this](const httplib::Request&, httplib::Response& response) {
      response.set_content(page_, "text/html; charset=utf-8");
    });
    Get("/live.css", [](const httplib::Request&, httplib::Response& response) {
      response.set_content(live_style(), "text/css; charset=utf-8");
    });
    Get("/live.js", [](const httplib::Request&, httplib::Response& response) {
      response.set_content(std::string(kLiveScript), "text/javascript; charset=utf-8");
    });
  }

  void serve_stop() {
    Post("/stop", [this](const httplib::Request& request, httplib::Response& response) {
      if (const auto refusal = refuse_stop(gate_, told_by(request)))
        return refuse(*refusal, response);
      handlers_.stop();
      response.set_content("{\"stopping\": true}\n", "application/json");
    });
    Get("/stop", [](const httplib::Request&, httplib::Response& response) {
      response.set_header("Allow", "POST");
      refuse({405, "only POST stops a run"}, response);
    });
  }

  bool process_and_close_socket(socket_t socket) override {
    if (one_too_many) return ::close(socket) == 0;
    LiveStream stream(socket, kConnection, ending_);
    bool closed = false;
    // Compression costs more than a transfer within a computer. Ranges are not needed either: a
    // header of 8 kB could request the whole page a thousand times, and the library would copy it.
    const bool well = process_request(stream, true, closed, [](httplib::Request& request) {
      request.headers.erase("Accept-Encoding");
      request.headers.erase("Range");
      request.ranges.clear();
    });
    stream.finish();
    ::close(socket);
    return well;
  }

  LiveGate gate_;
  const std::string page_;
  LiveHandlers handlers_;
  std::atomic<bool> ending_ = false;
};

LiveServer::LiveServer(std::unique_ptr<Http> http) : http_(std::move(http)) {
  const QuietThreads quiet;
  thread_ = std::thread([this] {
    constexpr int kYield = 10;
    ::setpriority(PRIO_PROCESS, 0, kYield);  // for this thread and those that it starts
    http_->listen_after_bind();
    left_ = true;
  });
  // The library ignores a stop that arrives before it listens.
  while (!http_->is_running() && !left_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

LiveServer::~LiveServer() {
  http_->end();
  thread_.join();
}

const LiveGate& LiveServer::gate() const { return http_->gate(); }

core::Result<std::unique_ptr<LiveServer>> LiveServer::start(std::uint16_t port, LiveGate gate,
                                                            std::string page,
                                                            LiveHandlers handlers) {
  auto http = std::make_unique<Http>(std::move(gate), std::move(page), std::move(handlers));
  if (!http->take_port(port)) {
    return core::fail(
        core::Code::kFile,
        port == 0 ? std::string("no port of 127.0.0.1 is free for the live page")
                  : fmt::format("port {} of 127.0.0.1 is in use or not allowed; choose another one "
                                "(--watch=PORT), or let the program choose (--watch)",
                                port));
  }
  return std::unique_ptr<LiveServer>(new LiveServer(std::move(http)));
}

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
