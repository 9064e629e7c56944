#include "tests/fuzz/ipp_entries.h"

#include <map>

#include "cmm/ipp/grammar.h"
#include "cmm/ipp_server/server.h"
#include "tests/cmm/ideal_backend.h"

namespace rondure::fuzz {
namespace {

using cmm::ipp::parse_command;
using cmm::ipp::parse_response;
using cmm::ipp::RawLine;
using cmm::ipp::Response;
using cmm::ipp::Server;
using cmm::ipp::ServerOptions;

/// Keeps account of what the server says.
class Account {
 public:
  /// "" or what is wrong with the line.
  std::string take(const std::string& line) {
    const auto response = parse_response(line);
    if (!response) return "the server said what is no response: " + line.substr(0, 200);
    const std::string tag = to_text(response->tag);
    switch (response->kind) {
      case Response::Kind::kAck:
        ++open_[tag];
        break;
      case Response::Kind::kComplete:
        if (--open_[tag] < 0) return "the server completed twice: " + line;
        break;
      case Response::Kind::kData:
        if (response->data.empty()) return "data out of form: " + line.substr(0, 200);
        break;
      case Response::Kind::kError:
        break;
    }
    return {};
  }
  [[nodiscard]] std::string balance() const {
    for (const auto& [tag, count] : open_) {
      if (count != 0) return "the server never completed " + tag;
    }
    return {};
  }

 private:
  std::map<std::string, int> open_;
};

std::string drain(Server& server, Account& account) {
  for (const std::string& line : server.take_output()) {
    if (auto problem = account.take(line); !problem.empty()) return problem;
  }
  return {};
}

}  // namespace

std::string try_ipp_grammar(std::string_view bytes) {
  if (const auto command = parse_command(bytes)) {
    const auto again = parse_command(to_line(*command));
    if (!again || *again != *command) return "not read back: " + to_line(*command);
  }
  if (const auto response = parse_response(bytes)) {
    if (response->kind == Response::Kind::kError) {
      const std::string line = error_line(response->tag, response->error);
      if (!parse_response(line)) return "error not read back: " + line;
    }
  }
  return {};
}

std::string try_ipp_server(std::string_view bytes) {
  if (bytes.empty()) return {};
  const auto choice = static_cast<unsigned char>(bytes[0]);
  ServerOptions options;
  if ((choice & 2U) != 0) options.speed = 10.0;
  const auto& profiles = cmm::ipp::profiles();
  const cmm::ipp::Profile& profile = profiles[choice / 4U % profiles.size()];
  options.controller.profile = profile;
  cmm::IdealBackend backend;
  Server server(backend, options);
  Account account;
  double now_s = 0.0;
  for (bytes.remove_prefix(1); !bytes.empty();) {
    const std::size_t end = bytes.find('\n');
    if (end == std::string_view::npos) break;
    RawLine line{std::string(bytes.substr(0, end)), false};
    bytes.remove_prefix(end + 1);
    if (line.text.ends_with('\r')) {
      line.text.pop_back();
      line.crlf = true;
    }
    now_s += 0.02 * static_cast<double>(line.text.size() % 16);
    server.receive(line, now_s);
    server.advance(now_s);
    if (auto problem = drain(server, account); !problem.empty()) return problem;
  }
  for (int i = 0; i < 1000 && server.next_event_s(); ++i) {
    now_s = *server.next_event_s();
    server.advance(now_s);
  }
  const bool still_moves = server.next_event_s().has_value();
  if (auto problem = drain(server, account); !problem.empty()) return problem;
  return still_moves || profile.abort_is_silent ? std::string() : account.balance();
}

}  // namespace rondure::fuzz
