#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include <httplib.h>

#include "core/result.h"

namespace rondure::web {

/// Access settings of the page of one run.
struct LiveGate {
  std::uint16_t port = 0;
  bool control = false;
  std::string token;  ///< Token of this program start; empty without control.
};

/// Headers of a request. Missing headers are empty.
struct LiveRequest {
  std::string host;
  std::string origin;
  std::string fetch_site;  ///< Sec-Fetch-Site.
  std::string content_type;
  std::string token;  ///< X-Rondure-Token.
};

/// Reason for the refusal of a request.
struct Refusal {
  int status = 403;
  std::string why;  ///< Reason, in one sentence.
};

/// 128 random bits from the system as 32 hexadecimal digits; empty when the system provides none.
[[nodiscard]] std::string random_token();

/// Whether the texts are equal, in a time that depends only on the length of `given`.
[[nodiscard]] bool same_secret(std::string_view expected, std::string_view given);

/// Refuses requests for another host name. A foreign page whose name was made to point at this
/// computer (DNS rebinding) sends that name as its host.
[[nodiscard]] std::optional<Refusal> refuse_host(const LiveGate& gate, std::string_view host);

/// Checks whether a POST may stop the run: control, host, origin, content type and token must all
/// be right. A page of another site cannot send it: its origin is different, JSON and the custom
/// header would need a permission that is never given, and it does not know the token.
[[nodiscard]] std::optional<Refusal> refuse_stop(const LiveGate& gate, const LiveRequest& request);

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

/// A connected socket for one request and its answer, with a common time limit: a client that sends
/// or reads too slowly is dropped, and so is one that sends more than 32 kB. After `ending` becomes
/// true, the stream waits for no request, and an answer may take half a second. Does not close the
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

  /// Ends the answer and reads some of what the client still sends, so that a reset of the
  /// connection does not destroy the answer.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  /// Waits until the socket is ready for `events` of poll(); false at the limit.
  [[nodiscard]] bool wait(short events) const;

  socket_t socket_;
  mutable Clock::time_point end_;
  mutable bool hurried_ = false;  ///< The end of the run was noticed.
  const std::atomic<bool>& ending_;
  std::array<char, 4096> buffer_{};
  std::size_t begin_ = 0;
  std::size_t filled_ = 0;
  std::size_t taken_ = 0;  ///< Bytes of the request received in total.
};

}  // namespace rondure::web
