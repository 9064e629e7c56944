#pragma once

#include <cstddef>
#include <deque>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "cmm/ipp/grammar.h"
#include "cmm/ipp_server/backend.h"
#include "cmm/ipp_server/controller.h"

namespace rondure::cmm::ipp {

/// What a server is told to be.
struct ServerOptions {
  ControllerOptions controller;
  /// Simulated seconds in a second of the clock; infinity: motions take no time.
  double speed = std::numeric_limits<double>::infinity();
};

/// The server's half of an I++ DME connection as a machine without sockets and clock: lines and the
/// time go in, lines come out. One client at a time.
///
/// A command is acknowledged at once and waits for the commands before it; event commands are
/// carried out at once. A straight move is made when its time is over and can be stopped on its way
/// (AbortE); a touch or scan is made when it begins, and what it gave is told when its time is
/// over. An error of severity 2 or more closes the commands that wait with 0006.
///
/// Anything may come in: nothing throws but bad_alloc, and no more than kMaxWaiting commands and
/// kMaxDaemons daemons are kept.
class Server {
 public:
  static constexpr std::size_t kMaxWaiting = 256;
  static constexpr std::size_t kMaxDaemons = 16;

  Server(Backend& backend, const ServerOptions& options);

  /// Takes a line from the client. `now_s` is any clock that does not go back.
  void receive(const RawLine& line, double now_s);
  /// Goes on with what moves; call it when next_event_s() is over.
  void advance(double now_s);
  /// The client has gone: what moves is stopped, the session is over, nothing is told.
  void disconnect(double now_s);

  /// Lines to send, in order.
  [[nodiscard]] std::vector<std::string> take_output();
  /// When advance() has to be called next; nothing: only after a line.
  [[nodiscard]] std::optional<double> next_event_s() const;

 private:
  /// A command that was acknowledged.
  struct Waiting {
    Tag tag;
    std::string text;  ///< The line, for errors.
    Command command;   ///< Not of a refusal.
    std::optional<Failure> refusal;
  };

  /// A motion in progress.
  struct Running {
    Waiting waiting;
    Motion motion;
    std::size_t phase = 0;
    double begin_s = 0.0;
    double end_s = 0.0;
    std::vector<Eigen::Vector3d> way;  ///< Of the tip in this phase.
    std::optional<Failure> failure;    ///< Told when the time is over.
  };

  /// OnMoveReportE.
  struct Daemon {
    Tag tag;
    double interval_s = std::numeric_limits<double>::infinity();
    double distance_mm = std::numeric_limits<double>::infinity();
    std::vector<std::string> names;
    double last_s = 0.0;
    Eigen::Vector3d last_W_mm = Eigen::Vector3d::Zero();
  };

  using Outcome = tl::expected<Reply, Failure>;

  // The queue: ipp_server.cpp.
  void refuse(const RawLine& line, const Refusal& refusal, double now_s);
  [[nodiscard]] bool is_in_use(const Tag& tag) const;
  void run(double now_s);
  void start(Waiting waiting, double now_s);
  void begin_phase(double now_s);
  void end_phase();
  [[nodiscard]] std::optional<Failure> gate(const Command& command) const;
  void conclude(const Waiting& waiting, const Outcome& outcome);
  void report(const Waiting& waiting, int number);
  void enter_error_state(const Failure& failure);
  void abort_waiting(bool silently);
  void stop_running(double now_s);
  [[nodiscard]] Eigen::Vector3d tip_now_W_mm(double now_s) const;
  void say(std::string line) { output_.push_back(std::move(line)); }

  // Commands of the server itself: ipp_server_commands.cpp.
  [[nodiscard]] Outcome execute(const Command& command);
  [[nodiscard]] Outcome start_session(const Command& command);
  [[nodiscard]] Outcome end_session(const Command& command);
  [[nodiscard]] Outcome clear_all_errors(const Command& command);
  [[nodiscard]] Outcome extended_status(const Command& command);
  [[nodiscard]] Outcome stop_daemon(const Command& command);
  [[nodiscard]] Outcome stop_all_daemons(const Command& command);
  void receive_event(const Waiting& waiting, double now_s);
  void abort_all(const Waiting& waiting, double now_s);
  [[nodiscard]] Outcome add_daemon(const Command& command, double now_s);
  void report_moves(double now_s);

  Controller controller_;
  double speed_;
  bool session_ = false;
  std::optional<Failure> error_;  ///< Of the error state.
  std::deque<Waiting> waiting_;
  std::optional<Running> running_;
  std::vector<Daemon> daemons_;
  std::vector<std::string> output_;
};

}  // namespace rondure::cmm::ipp
