#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cmm/ipp/internal/reader.h"
#include "cmm/ipp_server/internal/arguments.h"
#include "cmm/ipp_server/server.h"

// Commands that the server answers itself: session, errors, daemons, abort.

namespace rondure::cmm::ipp {
namespace {

constexpr double kLeastInterval_s = 0.1;  // at most ten lines a second

std::optional<Tag> tag_argument(const Command& command) {
  if (command.arguments.size() != 1 || command.arguments[0].kind != Item::Kind::kName) {
    return std::nullopt;
  }
  const auto tag = read_tag(command.arguments[0].text);
  return tag && tag->event ? tag : std::nullopt;
}

}  // namespace

Server::Outcome Server::execute(const Command& command) {
  struct Entry {
    std::string_view method;
    Outcome (Server::*handler)();
  };
  static constexpr Entry kEntries[] = {{"StartSession", &Server::start_session},
                                       {"EndSession", &Server::end_session},
                                       {"ClearAllErrors", &Server::clear_all_errors},
                                       {"GetXtdErrStatus", &Server::extended_status},
                                       {"StopAllDaemons", &Server::stop_all_daemons}};
  for (const Entry& entry : kEntries) {
    if (entry.method != command.method) continue;
    if (!command.arguments.empty()) return wrong_arguments("()");
    return (this->*entry.handler)();
  }
  return command.method == "StopDaemon" ? stop_daemon(command) : controller_.execute(command);
}

Server::Outcome Server::start_session() {
  if (session_) {
    return refusal(kProtocolError, "a session is open already");
  }
  session_ = true;
  error_.reset();
  controller_.begin_session();
  // A machine that keeps its fault reports it at the first motion.
  [[maybe_unused]] const auto recovered = controller_.machine().recover();
  return Reply{};
}

Server::Outcome Server::end_session() {
  session_ = false;
  daemons_.clear();
  return Reply{};
}

Server::Outcome Server::clear_all_errors() {
  if (auto recovered = controller_.machine().recover(); !recovered) {
    return refusal(kMachineInErrorState, recovered.error().what);
  }
  error_.reset();
  return Reply{};
}

Server::Outcome Server::extended_status() {
  Reply out;
  out.lines.push_back({flag_item("IsHomed", controller_.is_homed())});
  out.lines.push_back({flag_item("IsUserEnabled", controller_.is_user_enabled())});
  if (error_) {
    const std::string text = fmt::format("{:04} {}", error_->number, error_->what);
    out.lines.push_back({string_item(std::string_view(text).substr(0, 1000))});
  }
  return out;
}

Server::Outcome Server::stop_daemon(const Command& command) {
  const auto tag = tag_argument(command);
  if (!tag) return refusal(kIncorrectArguments, "the argument is not the tag of a daemon");
  const auto found = std::find_if(daemons_.begin(), daemons_.end(),
                                  [&](const Daemon& daemon) { return daemon.tag == *tag; });
  if (found == daemons_.end()) {
    return refusal(kNoSuchDaemon, fmt::format("there is no daemon {}", to_text(*tag)));
  }
  daemons_.erase(found);
  return Reply{};
}

Server::Outcome Server::stop_all_daemons() {
  Reply out;
  if (daemons_.empty()) out.report = kNoDaemons;
  daemons_.clear();
  return out;
}

void Server::receive_event(const Waiting& waiting, double now_s) {
  const Command& command = waiting.command;
  say(ack_line(waiting.tag));
  const auto closed = gate(command);
  // A stop must get through, regardless of earlier errors.
  const bool stops = command.method == "AbortE" && session_;
  if (closed && !stops) return conclude(waiting, tl::unexpected(*closed));
  if (command.method == "GetPropE") return conclude(waiting, controller_.execute(command));
  if (command.method == "OnMoveReportE") return conclude(waiting, add_daemon(command, now_s));
  if (!command.arguments.empty()) {
    return conclude(waiting, wrong_arguments("()"));
  }
  if (command.method == "AbortE") return abort_all(waiting, now_s);
  if (command.method == "GetErrStatusE") {
    return conclude(waiting, one_line(flag_item("ErrStatus", error_.has_value())));
  }
  conclude(waiting, refusal(kUnsupportedCommand, command.method + " is not supported"));
}

void Server::abort_all(const Waiting& waiting, double now_s) {
  if (running_) {
    const Waiting stopped = running_->waiting;
    stop_running(now_s);
    report(stopped, kAborted);
    say(complete_line(stopped.tag));
  }
  abort_waiting(profile().abort_is_silent);
  if (profile().abort_is_silent) daemons_.clear();
  if (!error_) error_ = Failure{kAborted, "stopped by AbortE"};
  say(complete_line(waiting.tag));
}

Server::Outcome Server::add_daemon(const Command& command, double now_s) {
  Daemon daemon;
  daemon.tag = command.tag;
  Reply out;
  for (const Item& item : command.arguments) {
    const auto value = single_number(item);
    if (value && item.text == "Time") {
      daemon.interval_s = std::max(*value, kLeastInterval_s);
      if (*value < kLeastInterval_s) out.report = kOutOfRange;
    } else if (value && item.text == "Dis") {
      daemon.distance_mm = std::max(*value, 0.0);
    } else if (item.kind == Item::Kind::kCall && item.arguments.empty()) {
      daemon.names.push_back(item.text);
    } else {
      return refusal(kIncorrectArguments, to_text(item) + " is no argument of OnMoveReportE");
    }
  }
  if (std::isinf(daemon.interval_s) && std::isinf(daemon.distance_mm)) {
    daemon.interval_s = kLeastInterval_s;
  }
  daemon.last_s = now_s;
  daemon.last_W_mm = tip_now_W_mm(now_s);
  TRY_DO(controller_.position_report(daemon.names, daemon.last_W_mm));
  if (daemon.names.empty()) return refusal(kIncorrectArguments, "nothing is to be reported");
  const bool exists = std::any_of(daemons_.begin(), daemons_.end(),
                                  [&](const Daemon& other) { return other.tag == daemon.tag; });
  if (exists) return refusal(kDaemonExists, to_text(daemon.tag) + " is a daemon already");
  if (daemons_.size() >= kMaxDaemons) {
    return refusal(kNotSupported, fmt::format("there are {} daemons already", kMaxDaemons));
  }
  daemons_.push_back(std::move(daemon));
  return out;
}

void Server::report_moves(double now_s) {
  const Eigen::Vector3d tip_W_mm = tip_now_W_mm(now_s);
  for (Daemon& daemon : daemons_) {
    const double since_s = now_s - daemon.last_s;
    const double moved_mm = (tip_W_mm - daemon.last_W_mm).norm();
    if (!(moved_mm > 0.0) || since_s < kLeastInterval_s) continue;
    if (since_s < daemon.interval_s && moved_mm < daemon.distance_mm) continue;
    const auto values = controller_.position_report(daemon.names, tip_W_mm);
    if (values) say(data_line(daemon.tag, *values, controller_.options().numbers));
    daemon.last_s = now_s;
    daemon.last_W_mm = tip_W_mm;
  }
}

}  // namespace rondure::cmm::ipp
