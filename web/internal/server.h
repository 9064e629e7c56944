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

/// Callbacks for the answers of the program; the server calls them from its threads.
struct LiveHandlers {
  /// Returns the JSON for a page that has version `since`; `client` is the name that the page
  /// chose.
  std::function<std::string(std::uint64_t since, const std::string& client)> state;
  std::function<void()> stop;
};

/// Serves the live page at 127.0.0.1, from threads of its own that block signals and yield the
/// processor to the run. GET never changes anything.
///
///   GET /  GET /live.css  GET /live.js    the page
///   GET /live?since=VERSION&client=NAME   the changes since that version
///   POST /stop                            stops the run, unless refuse_stop() refuses
class LiveServer {
 public:
  /// @param port      0: any free one.
  /// @param gate      The server sets its port.
  /// @param page      The answer to "/": live_page().
  /// @return  kFile when the port is not available: `what` names the remedy.
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
  std::atomic<bool> left_ = false;  ///< The thread has ended.
  std::thread thread_;
};

}  // namespace rondure::web
