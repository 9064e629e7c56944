#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "cmm/ipp/grammar.h"
#include "wire/transport.h"

namespace rondure::cmm::ipp::client {

/// Result of a successful transaction.
struct Reply {
  std::vector<Response> data;         ///< The # lines, in order.
  std::vector<ErrorReport> warnings;  ///< Reports of severity 0 and 1.
};

/// Why a transaction failed.
struct Failure {
  enum class Kind {
    kLine,    ///< The connection is lost, silent, or uses another protocol: every later call fails.
    kServer,  ///< The server reported an error of severity 2 or more (`report`).
    kStopped,  ///< Stopped by this client with AbortE: ClearAllErrors() must follow.
  };

  Kind kind = Kind::kLine;
  std::string what;    ///< For the user; includes the message of the machine.
  ErrorReport report;  ///< For kServer, the first such report.
};

template <class T>
using Outcome = tl::expected<T, Failure>;

/// Settings of a session.
struct SessionOptions {
  std::chrono::milliseconds answer_limit{5000};  ///< For & after a command, and for AbortE.
  bool abort_works = true;  ///< false: a server whose AbortE is broken; motions run to their end.
  NumberForm numbers = NumberForm::kSixteenDigits;  ///< Form of numbers in commands.
};

/// The client side of an I++ DME connection: commands with their tags, answers sorted by tag.
///
/// One command is in flight at a time (begin() and finish() allow more). Lines of daemons, of
/// unsolicited events (E0000) and with tags of old commands are never taken for an answer. An
/// unsolicited error of severity 2 or more fails the command in progress, or the next one, whatever
/// its answer; a motion is ended by AbortE. The end of AbortE ends every older command, even if the
/// server does not report that. A line that is not an I++ DME answer, a late answer and a lost
/// connection end the session: motions are stopped by AbortE if the connection still works, and
/// every later call gives the same failure. Source: I++ DME 1.4.3, transactions; docs/ipp-dme.md
/// describes the behaviour of real servers.
///
/// Not for use by two threads at once.
class Session {
 public:
  using Milliseconds = std::chrono::milliseconds;
  /// Whether a stop request ends the command; for motions only.
  enum class Watch { kNothing, kStop };

  explicit Session(std::unique_ptr<wire::LineTransport> line, const SessionOptions& options = {});

  /// Polled about 50 times a second until a motion ends; true sends AbortE.
  void ask_for_stop(std::function<bool()> stop) { stop_ = std::move(stop); }

  /// Sends a command and waits for its end.
  /// @param limit  Time limit for the whole transaction.
  [[nodiscard]] Outcome<Reply> call(std::string_view method, std::vector<Item> arguments,
                                    Milliseconds limit, Watch watch = Watch::kNothing);
  /// As call(), on the fast queue with an event tag: GetErrStatusE, OnMoveReportE.
  [[nodiscard]] Outcome<Reply> call_event(std::string_view method, std::vector<Item> arguments,
                                          Milliseconds limit);

  /// Sends a command and waits only for its &.
  [[nodiscard]] Outcome<Tag> begin(std::string_view method, std::vector<Item> arguments);
  /// Waits for the end of a command sent by begin().
  [[nodiscard]] Outcome<Reply> finish(const Tag& tag, Milliseconds limit,
                                      Watch watch = Watch::kNothing);
  /// Stops all motion: sends AbortE and waits for its end. Older commands end as kStopped.
  [[nodiscard]] Outcome<void> abort();

  [[nodiscard]] bool usable() const { return broken_.empty() && line_->is_open(); }
  [[nodiscard]] std::string peer() const { return line_->peer(); }
  /// The last unsolicited error (E0000) since the previous call, or "".
  [[nodiscard]] std::string take_unsolicited();

 private:
  using Clock = std::chrono::steady_clock;

  /// A command that was sent and has not ended.
  struct Running {
    std::string text;
    bool acknowledged = false;
    bool complete = false;
    bool aborted = false;
    std::size_t bytes = 0;
    Reply reply;
    std::optional<ErrorReport> error;
  };

  [[nodiscard]] Tag next_tag(bool event);
  [[nodiscard]] Outcome<Tag> send(const Command& command);
  /// Reads and sorts lines until `done` or the deadline; false at the deadline.
  [[nodiscard]] Outcome<bool> wait(const std::function<bool()>& done, Clock::time_point deadline,
                                   Watch watch);
  [[nodiscard]] Outcome<void> take(const wire::Line& line);
  void take_unsolicited_line(const Response& response);
  [[nodiscard]] Outcome<Reply> result_of(const Tag& tag);
  /// Ends the session; sends a stop to anything that may move.
  [[nodiscard]] tl::unexpected<Failure> break_off(std::string what);
  [[nodiscard]] std::string with_unsolicited(std::string what);

  std::unique_ptr<wire::LineTransport> line_;
  SessionOptions options_;
  std::function<bool()> stop_;
  std::map<std::string, Running> running_;  ///< By tag.
  int last_tag_ = 0;
  int last_event_tag_ = 0;
  std::string broken_;       ///< Why the session ended; "" while it is open.
  std::string unsolicited_;  ///< The last E0000 error.
  /// The first error of severity 2 or more that has not failed a command.
  std::optional<ErrorReport> severe_;
  std::string heard_;  ///< Start of the last valid I++ DME line.
};

}  // namespace rondure::cmm::ipp::client
