#include "cmm/ipp_client/session.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "cmm/ipp/internal/reader.h"

namespace rondure::cmm::ipp::client {
namespace {

constexpr int kLastTag = 99'999;
constexpr int kLastEventTag = 9'999;
constexpr std::chrono::milliseconds kLook(20);       // between two polls for a stop
constexpr std::chrono::milliseconds kGoodbye(1000);  // for AbortE on a connection that is given up
constexpr std::size_t kMaxReply_bytes = std::size_t{64} << 20;  // a scan of 100 000 points has 6 MB
constexpr std::size_t kShown = 80;                              // characters of a line, in messages

}  // namespace

Session::Session(std::unique_ptr<wire::LineTransport> line, const SessionOptions& options)
    : line_(std::move(line)), options_(options) {}

Tag Session::next_tag(bool event) {
  int& last = event ? last_event_tag_ : last_tag_;
  const int end = event ? kLastEventTag : kLastTag;
  for (;;) {  // at most a handful are in use
    last = last == end ? 1 : last + 1;
    const Tag tag{event, last};
    if (running_.count(to_text(tag)) == 0) return tag;
  }
}

Outcome<Tag> Session::send(const Command& command) {
  if (!usable()) {
    return tl::unexpected(Failure{Failure::Kind::kLine, broken_.empty() ? "closed" : broken_, {}});
  }
  const std::string text = method_text(command);
  if (auto sent = line_->write_line(to_line(command, options_.numbers)); !sent) {
    return break_off(sent.error().what);
  }
  running_[to_text(command.tag)].text = text;
  return command.tag;
}

Outcome<Tag> Session::begin(std::string_view method, std::vector<Item> arguments) {
  const auto tag = send({next_tag(false), std::string(method), std::move(arguments)});
  if (!tag) return tag;
  Running& running = running_[to_text(*tag)];
  TRY(const auto acknowledged, wait([&] { return running.acknowledged || running.complete; },
                                    Clock::now() + options_.answer_limit, Watch::kNothing));
  if (acknowledged) return tag;
  return break_off(
      fmt::format("{} did not acknowledge {} within {:g} s; is another client "
                  "connected to it?",
                  peer(), excerpt(running.text, kShown),
                  static_cast<double>(options_.answer_limit.count()) / 1000.0));
}

Outcome<Reply> Session::finish(const Tag& tag, Milliseconds limit, Watch watch) {
  const auto found = running_.find(to_text(tag));
  if (found == running_.end()) {
    return tl::unexpected(Failure{Failure::Kind::kLine, "there is no such command", {}});
  }
  Running& running = found->second;
  TRY(const auto ended, wait([&] { return running.complete; }, Clock::now() + limit, watch));
  if (ended) return result_of(tag);
  return break_off(fmt::format("{} did not finish {} within {:g} s", peer(),
                               excerpt(running.text, kShown),
                               static_cast<double>(limit.count()) / 1000.0));
}

Outcome<Reply> Session::result_of(const Tag& tag) {
  const auto node = running_.extract(to_text(tag));
  Running& running = node.mapped();
  if (severe_ && !tag.event) {
    const ErrorReport report = *std::exchange(severe_, std::nullopt);
    (void)take_unsolicited();
    std::string what = in_words(report) + ", without having been asked";
    if (running.error) what += fmt::format("; and to the command {}", in_words(*running.error));
    return tl::unexpected(Failure{Failure::Kind::kServer, std::move(what), report});
  }
  if (running.aborted) {
    return tl::unexpected(Failure{
        Failure::Kind::kStopped, fmt::format("{} was stopped", excerpt(running.text, kShown)), {}});
  }
  if (!running.error) return std::move(running.reply);
  return tl::unexpected(
      Failure{Failure::Kind::kServer, with_unsolicited(in_words(*running.error)), *running.error});
}

Outcome<Reply> Session::call(std::string_view method, std::vector<Item> arguments,
                             Milliseconds limit, Watch watch) {
  TRY(const auto tag, begin(method, std::move(arguments)));
  return finish(tag, limit, watch);
}

Outcome<Reply> Session::call_event(std::string_view method, std::vector<Item> arguments,
                                   Milliseconds limit) {
  TRY(const auto tag, send({next_tag(true), std::string(method), std::move(arguments)}));
  return finish(tag, limit);
}

Outcome<void> Session::abort() {
  TRY_DO(call_event("AbortE", {}, options_.answer_limit));
  for (auto& [tag, running] : running_) {
    if (tag.front() == 'E') continue;
    running.complete = true;
    running.aborted = true;
  }
  return {};
}

Outcome<bool> Session::wait(const std::function<bool()>& done, Clock::time_point deadline,
                            Watch watch) {
  const bool watches = watch == Watch::kStop && options_.abort_works;
  while (!done()) {
    if (watches && (severe_ || (stop_ && stop_()))) {
      TRY_DO(abort());
      continue;
    }
    const auto left = std::chrono::duration_cast<Milliseconds>(deadline - Clock::now());
    if (left.count() <= 0) return false;
    const auto line = line_->read_line(watches ? std::min(left, kLook) : left);
    if (!line) return break_off(line.error().what);
    if (!*line) continue;
    TRY_DO(take(**line));
  }
  return true;
}

Outcome<void> Session::take(const wire::Line& line) {
  const auto response = parse_response(line.text);
  if (!response) {
    heard_.clear();  // the message shows the line itself
    return break_off(fmt::format("{} does not speak I++ DME: {}", peer(), response.error().what));
  }
  heard_ = excerpt(line.text, kShown);
  if (response->tag == kUnsolicited) {
    take_unsolicited_line(*response);
    return {};
  }
  const auto found = running_.find(to_text(response->tag));
  if (found == running_.end()) return {};  // from a daemon, or from a command that AbortE ended
  Running& running = found->second;
  running.bytes += line.text.size();
  if (running.bytes > kMaxReply_bytes) {
    return break_off(fmt::format("{} sent more than {} bytes in answer to {}", peer(),
                                 kMaxReply_bytes, excerpt(running.text, kShown)));
  }
  switch (response->kind) {
    case Response::Kind::kAck:
      running.acknowledged = true;
      break;
    case Response::Kind::kData:
      running.reply.data.push_back(*response);
      break;
    case Response::Kind::kError:
      if (response->error.severity < kErrorState) {
        running.reply.warnings.push_back(response->error);
      } else if (!running.error) {
        running.error = response->error;
      }
      break;
    case Response::Kind::kComplete:
      running.complete = true;
      break;
  }
  return {};
}

void Session::take_unsolicited_line(const Response& response) {
  if (response.kind != Response::Kind::kError) return;  // key presses, manual points
  unsolicited_ = in_words(response.error);
  if (response.error.severity >= kErrorState && !severe_) severe_ = response.error;
}

std::string Session::take_unsolicited() { return std::exchange(unsolicited_, {}); }

std::string Session::with_unsolicited(std::string what) {
  const std::string more = take_unsolicited();
  return more.empty() ? what : fmt::format("{}; the machine also reported {}", what, more);
}

tl::unexpected<Failure> Session::break_off(std::string what) {
  if (broken_.empty()) {
    const std::string half = excerpt(line_->unfinished(), kShown);
    if (!half.empty()) {
      what += fmt::format("; half a line came: \"{}\"", half);
    } else if (!heard_.empty()) {
      what += fmt::format("; the last line from there: \"{}\"", heard_);
    }
    broken_ = with_unsolicited(std::move(what));
    const bool may_move = std::any_of(running_.begin(), running_.end(), [](const auto& entry) {
      return entry.first.front() != 'E' && !entry.second.complete;
    });
    if (may_move && options_.abort_works && line_->is_open() &&
        line_->write_line(to_line({next_tag(true), "AbortE", {}}))) {
      // the server reads it before the connection closes
      const auto deadline = Clock::now() + kGoodbye;
      const std::string end = complete_line({true, last_event_tag_});
      for (;;) {
        const auto left = std::chrono::duration_cast<Milliseconds>(deadline - Clock::now());
        if (left.count() <= 0) break;
        const auto line = line_->read_line(left);
        if (!line || !*line || (*line)->text == end) break;
      }
    }
    line_->close();
  }
  return tl::unexpected(Failure{Failure::Kind::kLine, broken_, {}});
}

}  // namespace rondure::cmm::ipp::client
