#include "cmm/ipp_server/server.h"

#include <algorithm>
#include <cmath>

#include "cmm/ipp/internal/reader.h"

namespace rondure::cmm::ipp {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kEchoLength = 512;  // characters of a command in an error report

std::string echo_of(std::string_view line) { return std::string(line.substr(0, kEchoLength)); }

int severity_of(int number) {
  const ErrorEntry* entry = find_error(number);
  return entry == nullptr ? kErrorState : entry->severity;
}

double length_of(const std::vector<Vector3d>& way) {
  double length_mm = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) length_mm += (way[i] - way[i - 1]).norm();
  return length_mm;
}

/// The position after a fraction of the time on a path; all its legs take the same time.
Vector3d along(const std::vector<Vector3d>& way, double part) {
  const double at = std::clamp(part, 0.0, 1.0) * static_cast<double>(way.size() - 1);
  const auto piece = std::min(static_cast<std::size_t>(at), way.size() - 1);
  if (piece + 1 >= way.size()) return way.back();
  const double rest = at - static_cast<double>(piece);
  return way[piece] + rest * (way[piece + 1] - way[piece]);
}

}  // namespace

Server::Server(Backend& backend, const ServerOptions& options)
    : controller_(backend, options.controller), speed_(options.speed) {}

std::vector<std::string> Server::take_output() {
  std::vector<std::string> out;
  out.swap(output_);
  return out;
}

bool Server::is_in_use(const Tag& tag) const {
  const auto has_tag = [&tag](const auto& owner) { return owner.tag == tag; };
  return (running_ && running_->waiting.tag == tag) ||
         std::any_of(waiting_.begin(), waiting_.end(), has_tag);
}

void Server::receive(const RawLine& line, double now_s) {
  run(now_s);
  auto command = parse_command(line);
  if (!command) return refuse(line, command.error(), now_s);
  std::string echo = echo_of(to_line(*command, controller_.options().numbers));
  Waiting waiting{command->tag, std::move(echo), std::move(*command), std::nullopt};
  if (waiting.tag.event) return receive_event(waiting, now_s);
  if (is_in_use(waiting.tag)) {
    return refuse(line, {kIllegalTag, {}, "the tag belongs to a command in progress"}, now_s);
  }
  if (waiting_.size() >= kMaxWaiting) {
    say(error_line(kUnsolicited, error_report(0, waiting.text)));
    return;
  }
  say(ack_line(waiting.tag));
  waiting_.push_back(std::move(waiting));
  run(now_s);
}

void Server::refuse(const RawLine& line, const Refusal& refusal, double now_s) {
  const std::string text = echo_of(line.text);
  const Failure failure{refusal.number, refusal.what};
  if (!refusal.tag || is_in_use(*refusal.tag) || waiting_.size() >= kMaxWaiting) {
    say(error_line(kUnsolicited, error_report(refusal.number, text)));
    return enter_error_state(failure);
  }
  say(ack_line(*refusal.tag));
  const Waiting waiting{*refusal.tag, text, {}, failure};
  if (refusal.tag->event) return conclude(waiting, tl::unexpected(failure));
  waiting_.push_back(waiting);
  run(now_s);
}

void Server::advance(double now_s) {
  run(now_s);
  report_moves(now_s);
}

void Server::run(double now_s) {
  while (true) {
    if (running_) {
      if (now_s < running_->end_s) return;
      end_phase();
    } else if (!waiting_.empty()) {
      Waiting next = std::move(waiting_.front());
      waiting_.pop_front();
      start(std::move(next), now_s);
    } else {
      return;
    }
  }
}

std::optional<Failure> Server::gate(const Command& command) const {
  const std::string& method = command.method;
  if (!session_) {
    if (method == "StartSession" || method == "EndSession") return std::nullopt;
    return Failure{kProtocolError, "no session has been started"};
  }
  const bool takes_back =
      method == "GetErrStatusE" || method == "GetXtdErrStatus" || method == "ClearAllErrors";
  if (error_ && !takes_back) return Failure{kUseClearAllErrors, error_->what};
  if (!profile().knows(method)) {
    return Failure{kUnsupportedCommand, method + " is not supported by this server"};
  }
  return std::nullopt;
}

void Server::start(Waiting waiting, double now_s) {
  if (auto closed = gate(waiting.command); closed && (!waiting.refusal || error_)) {
    return conclude(waiting, tl::unexpected(std::move(*closed)));
  }
  if (waiting.refusal) return conclude(waiting, tl::unexpected(*waiting.refusal));
  if (!Controller::is_motion(waiting.command.method)) {
    return conclude(waiting, execute(waiting.command));
  }
  auto motion = controller_.plan_motion(waiting.command);
  if (!motion) return conclude(waiting, tl::unexpected(std::move(motion.error())));
  running_ = Running{};
  running_->waiting = std::move(waiting);
  running_->motion = std::move(*motion);
  begin_phase(now_s);
}

void Server::begin_phase(double now_s) {
  const Phase& phase = running_->motion.phases[running_->phase];
  Machine& machine = controller_.machine();
  double duration_s = 0.0;
  running_->way.clear();
  if (phase.target_W_mm) {
    running_->way = {machine.position_W_mm(), phase.target_W_mm()};
    duration_s = length_of(running_->way) / controller_.travel_speed_mm_s();
  } else {
    const double before_s = machine.time_s();
    auto way = phase.act();
    duration_s = machine.time_s() - before_s;
    if (way) {
      running_->way = std::move(*way);
    } else {
      running_->failure = controller_.failure_of(way.error(), running_->waiting.command.method);
    }
  }
  const double waits_s = duration_s / speed_;
  running_->begin_s = now_s;
  running_->end_s = now_s + (std::isfinite(waits_s) && waits_s > 0.0 ? waits_s : 0.0);
}

void Server::end_phase() {
  Running& running = *running_;
  const Phase& phase = running.motion.phases[running.phase];
  if (phase.target_W_mm) {
    if (auto moved = controller_.machine().move_to(running.way.back()); !moved) {
      running.failure = controller_.failure_of(moved.error(), running.waiting.command.method);
    }
  }
  if (!running.failure && ++running.phase < running.motion.phases.size()) {
    return begin_phase(running.end_s);
  }
  const Running done = std::move(*running_);
  running_.reset();
  if (done.failure) return conclude(done.waiting, tl::unexpected(*done.failure));
  conclude(done.waiting, done.motion.reply());
}

void Server::conclude(const Waiting& waiting, const Outcome& outcome) {
  if (outcome) {
    for (const std::vector<Item>& line : outcome->lines) {
      say(data_line(waiting.tag, line, controller_.options().numbers));
    }
    if (outcome->report != 0) report(waiting, outcome->report);
  } else {
    report(waiting, outcome.error().number);
  }
  say(complete_line(waiting.tag));
  if (!outcome) {
    enter_error_state(outcome.error());
  } else if (outcome->report != 0) {
    enter_error_state({outcome->report, ""});
  }
}

void Server::report(const Waiting& waiting, int number) {
  const int told = profile().told(number, waiting.command.method);
  say(error_line(waiting.tag, error_report(told, waiting.text)));
}

void Server::enter_error_state(const Failure& failure) {
  if (severity_of(failure.number) < kErrorState) return;
  if (!error_) error_ = failure;
  // Waiting commands are closed; the motion in progress of an older command continues to its end.
  abort_waiting(false);
}

void Server::abort_waiting(bool silently) {
  while (!waiting_.empty()) {
    const Waiting waiting = std::move(waiting_.front());
    waiting_.pop_front();
    if (silently) continue;
    report(waiting, kAborted);
    say(complete_line(waiting.tag));
  }
}

void Server::stop_running(double now_s) {
  if (!running_) return;
  const Phase& phase = running_->motion.phases[running_->phase];
  if (phase.target_W_mm) {
    // The tip has come here on a straight line; a collision on that line stops it earlier.
    [[maybe_unused]] const auto stopped = controller_.machine().move_to(tip_now_W_mm(now_s));
  }
  running_.reset();
}

Vector3d Server::tip_now_W_mm(double now_s) const {
  if (!running_ || running_->way.empty()) {
    return controller_.position_W_mm();
  }
  const double duration_s = running_->end_s - running_->begin_s;
  return along(running_->way, duration_s > 0.0 ? (now_s - running_->begin_s) / duration_s : 1.0);
}

void Server::disconnect(double now_s) {
  stop_running(now_s);
  abort_waiting(true);
  daemons_.clear();
  output_.clear();
  error_.reset();
  session_ = false;
}

std::optional<double> Server::next_event_s() const {
  if (!running_) return std::nullopt;
  double next_s = running_->end_s;
  for (const Daemon& daemon : daemons_) next_s = std::min(next_s, daemon.last_s + 0.1);
  return next_s;
}

}  // namespace rondure::cmm::ipp
