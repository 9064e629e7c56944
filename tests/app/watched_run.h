#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace rondure::app::testing {

/// Answer of a server; status 0 when there was none.
struct Answer {
  int status = 0;
  std::string type;
  std::string policy;  ///< Content-Security-Policy.
  std::string cache;
  std::string body;
};

/// One header of a request.
struct Head {
  std::string name;
  std::string value;
};

/// A run with its live page, requested as a browser does.
class WatchedRun {
 public:
  /// Waits until the program has printed the address of the page.
  explicit WatchedRun(const std::vector<std::string>& arguments,
                      const Surroundings& surroundings = {});

  [[nodiscard]] Program& program() { return program_; }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] const std::string& token() const { return token_; }  ///< Empty when read-only.
  [[nodiscard]] std::string origin() const;

  /// Headers with which the page itself asks for the stop.
  [[nodiscard]] std::vector<Head> right_heads() const;
  [[nodiscard]] Answer ask(const std::string& method, const std::string& path,
                           const std::vector<Head>& heads = {}, const std::string& body = {}) const;
  /// Changes since a version; null when the server does not answer.
  [[nodiscard]] nlohmann::json look(std::uint64_t since = 0, const std::string& client = "a") const;
  /// Requests changes until a part holds a text; returns all parts merged, null when the program
  /// has ended.
  [[nodiscard]] nlohmann::json look_until(const std::string& part, const std::string& text) const;

 private:
  Program program_;
  std::uint16_t port_ = 0;
  std::string token_;
};

/// Connects to a port of this computer; the caller closes the handle. -1 when it fails.
[[nodiscard]] int connect_to(std::uint16_t port);

}  // namespace rondure::app::testing
