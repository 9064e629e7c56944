#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cmm/ipp_server/server.h"
#include "ideal_backend.h"

namespace rondure::cmm::ipp {

/// A client, a server and a clock in one place.
class Talk {
 public:
  explicit Talk(const ServerOptions& options = {}) : server_(backend_, with_tip(options)) {}

  /// Sends a line; returns the immediate answer of the server.
  std::vector<std::string> say(std::string_view line) {
    server_.receive({std::string(line)}, now_s);
    return server_.take_output();
  }
  /// Advances the time in steps of 10 ms; returns the lines that the server sends.
  std::vector<std::string> wait(double seconds) {
    std::vector<std::string> out;
    const double until_s = now_s + seconds;
    while (now_s < until_s) {
      now_s += 0.01;
      server_.advance(now_s);
      for (std::string& line : server_.take_output()) out.push_back(std::move(line));
    }
    return out;
  }
  /// Starts a session with a homed machine and the tool Probe1.
  void begin() {
    for (const char* line :
         {"00001 StartSession()", "00002 Home()", "00003 ChangeTool(\"Probe1\")"}) {
      say(line);
    }
    wait(1.0);
  }
  /// The answer to a command, successful or not, without & and %; lines joined by "|".
  std::string ask(std::string_view command) {
    const std::string tag = "09999";
    std::string out;
    for (const std::string& line : say(tag + " " + std::string(command))) {
      if (line == tag + " &" || line == tag + " %") continue;
      if (!out.empty()) out += "|";
      out += line.substr(6);
    }
    return out;
  }
  /// The number of the error that the command gives, or 0.
  int error(std::string_view command) {
    int number = 0;
    for (const std::string& line : say("09998 " + std::string(command))) {
      const auto response = parse_response(line);
      if (response && response->kind == Response::Kind::kError) number = response->error.number;
    }
    say("09997 ClearAllErrors()");
    return number;
  }

  IdealBackend& backend() { return backend_; }
  IdealMachine& machine() { return backend_.machine(); }
  Server& server() { return server_; }

  double now_s = 0.0;

 private:
  static ServerOptions with_tip(ServerOptions options) {
    options.controller.tip_radius_mm = IdealMachine::kTipRadius_mm;
    return options;
  }

  IdealBackend backend_;
  Server server_;
};

}  // namespace rondure::cmm::ipp
