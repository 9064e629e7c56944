#include "web/internal/server.h"

#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <charconv>
#include <chrono>
#include <csignal>
#include <utility>

#include <fmt/format.h>
#include <httplib.h>

#include "web/internal/stream.h"
#include "web/page.h"

namespace rondure::web {
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

}  // namespace rondure::web
