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

/// Settings of a server.
struct ServerOptions {
  ControllerOptions controller;
  /// Simulated seconds per second of the clock; infinity: motions take no time.
  double speed = std::numeric_limits<double>::infinity();
};

/// The server side of an I++ DME connection as a state machine without sockets and clock: lines and
/// times go in, lines come out. One client at a time.
///
/// A command is acknowledged at once and waits for the commands before it; event commands are
/// executed at once. A straight move is made at the end of its time and can be stopped on its path
/// (AbortE); a touch or scan is made when it starts, and its result is reported at the end of its
/// time. An error of severity 2 or more ends the waiting commands with 0006.
///
/// Any input is accepted: only bad_alloc is thrown, and at most kMaxWaiting commands and
/// kMaxDaemons daemons are stored.
class Server {
 public:
  static constexpr std::size_t kMaxWaiting = 256;
  static constexpr std::size_t kMaxDaemons = 16;

  Server(Backend& backend, const ServerOptions& options);

  /// Takes a line from the client. `now_s` is the time of any monotonic clock.
  void receive(const RawLine& line, double now_s);
  /// Advances the motions; call it at the time of next_event_s().
  void advance(double now_s);
  /// Call when the client has disconnected: motions are stopped, the session ends, no responses are
  /// sent.
  void disconnect(double now_s);

  /// Lines to send, in order.
  [[nodiscard]] std::vector<std::string> take_output();
  /// Time of the next call of advance(); nothing: only after a line.
  [[nodiscard]] std::optional<double> next_event_s() const;

 private:
  /// A command that was acknowledged and waits.
  struct Waiting {
    Tag tag;
    std::string text;  ///< The line, for errors.
    Command command;   ///< Empty for a refusal.
    std::optional<Failure> refusal;
  };

  /// A motion in progress.
  struct Running {
    Waiting waiting;
    Motion motion;
    std::size_t phase = 0;
    double begin_s = 0.0;
    double end_s = 0.0;
    std::vector<Eigen::Vector3d> way;  ///< Path of the tip in this phase.
    std::optional<Failure> failure;    ///< Reported at the end of the time.
  };

  /// A daemon started by OnMoveReportE.
  struct Daemon {
    Tag tag;
    double interval_s = std::numeric_limits<double>::infinity();
    double distance_mm = std::numeric_limits<double>::infinity();
    std::vector<std::string> names;
    double last_s = 0.0;
    Eigen::Vector3d last_W_mm = Eigen::Vector3d::Zero();
  };

  using Outcome = tl::expected<Reply, Failure>;

  // The queue: server.cpp.
  void refuse(const RawLine& line, const Refusal& refusal, double now_s);
  [[nodiscard]] bool is_in_use(const Tag& tag) const;
  void run(double now_s);
  void start(Waiting waiting, double now_s);
  void begin_phase(double now_s);
  void end_phase();
  [[nodiscard]] std::optional<Failure> gate(const Command& command) const;
  [[nodiscard]] const Profile& profile() const { return controller_.options().profile; }
  void conclude(const Waiting& waiting, const Outcome& outcome);
  void report(const Waiting& waiting, int number);
  void enter_error_state(const Failure& failure);
  void abort_waiting(bool silently);
  void stop_running(double now_s);
  [[nodiscard]] Eigen::Vector3d tip_now_W_mm(double now_s) const;
  void say(std::string line) { output_.push_back(std::move(line)); }

  // Commands of the server itself: commands.cpp.
  [[nodiscard]] Outcome execute(const Command& command);
  [[nodiscard]] Outcome start_session();
  [[nodiscard]] Outcome end_session();
  [[nodiscard]] Outcome clear_all_errors();
  [[nodiscard]] Outcome extended_status();
  [[nodiscard]] Outcome stop_daemon(const Command& command);
  [[nodiscard]] Outcome stop_all_daemons();
  void receive_event(const Waiting& waiting, double now_s);
  void abort_all(const Waiting& waiting, double now_s);
  [[nodiscard]] Outcome add_daemon(const Command& command, double now_s);
  void report_moves(double now_s);

  Controller controller_;
  double speed_;
  bool session_ = false;
  std::optional<Failure> error_;  ///< Set in the error state.
  std::deque<Waiting> waiting_;
  std::optional<Running> running_;
  std::vector<Daemon> daemons_;
  std::vector<std::string> output_;
};

}  // namespace rondure::cmm::ipp
