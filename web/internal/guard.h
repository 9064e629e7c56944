#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace rondure::web {

/// Settings that guard the page of one run.
struct LiveGate {
  std::uint16_t port = 0;
  bool control = false;
  std::string token;  ///< Of this start of the program; empty without control.
};

/// Headers of a request. Those that the browser did not send are empty.
struct LiveRequest {
  std::string host;
  std::string origin;
  std::string fetch_site;  ///< Sec-Fetch-Site.
  std::string content_type;
  std::string token;  ///< X-Rondure-Token.
};

/// Why a request is refused.
struct Refusal {
  int status = 403;
  std::string why;  ///< One sentence.
};

/// 128 random bits of the system as 32 hexadecimal digits; empty when the system has none.
[[nodiscard]] std::string random_token();

/// Whether the texts are equal, in a time that depends on the length of `given` only.
[[nodiscard]] bool same_secret(std::string_view expected, std::string_view given);

/// A page under another name that was made to point at this computer (DNS rebinding) comes with
/// that name as its host: refused, whatever it asks for.
[[nodiscard]] std::optional<Refusal> refuse_host(const LiveGate& gate, std::string_view host);

/// Whether a POST may stop the run: control, host, origin, content type and token must all be
/// right. A page of another site cannot send it: its origin is another, JSON and the header of its
/// own would need a permission that is never given, and it does not know the token.
[[nodiscard]] std::optional<Refusal> refuse_stop(const LiveGate& gate, const LiveRequest& request);

}  // namespace rondure::web
