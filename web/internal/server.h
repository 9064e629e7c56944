#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "core/result.h"
#include "web/internal/guard.h"

namespace rondure::web {

/// Answers of the program to the server, which calls them from its threads.
struct LiveHandlers {
  /// JSON for a page that has seen a version; `client` is the page's name for itself.
  std::function<std::string(std::uint64_t since, const std::string& client)> state;
  std::function<void()> stop;
};

/// Serves the live page at 127.0.0.1, from threads of its own that take no signals and yield the
/// processor to the run. GET never changes anything.
///
///   GET /  GET /live.css  GET /live.js    the page
///   GET /live?since=VERSION&client=NAME   what changed since
///   POST /stop                            stops the run, where refuse_stop() has no objection
class LiveServer {
 public:
  /// @param port      0: any free one.
  /// @param gate      Its port is filled in.
  /// @param page      The answer to "/": live_page().
  /// @return  kFile when the port cannot be had: `what` says what to do.
  [[nodiscard]] static core::Result<std::unique_ptr<LiveServer>> start(std::uint16_t port,
                                                                       LiveGate gate,
                                                                       std::string page,
                                                                       LiveHandlers handlers);
  ~LiveServer();
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  [[nodiscard]] const LiveGate& gate() const;

 private:
  class Http;
  explicit LiveServer(std::unique_ptr<Http> http);
  std::unique_ptr<Http> http_;
  std::atomic<bool> left_ = false;  ///< The thread is done.
  std::thread thread_;
};

}  // namespace rondure::web
