#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace rondure::web {

/// Access settings of the page of one run.
struct LiveGate {
  std::uint16_t port = 0;
  bool control = false;
  std::string token;  ///< Token of this program start; empty without control.
};

/// Headers of a request. Missing headers are empty.
struct LiveRequest {
  std::string host;
  std::string origin;
  std::string fetch_site;  ///< Sec-Fetch-Site.
  std::string content_type;
  std::string token;  ///< X-Rondure-Token.
};

/// Reason for the refusal of a request.
struct Refusal {
  int status = 403;
  std::string why;  ///< Reason, in one sentence.
};

/// 128 random bits from the system as 32 hexadecimal digits; empty when the system provides none.
[[nodiscard]] std::string random_token();

/// Whether the texts are equal, in a time that depends only on the length of `given`.
[[nodiscard]] bool same_secret(std::string_view expected, std::string_view given);

/// Refuses requests for another host name. A foreign page whose name was made to point at this
/// computer (DNS rebinding) sends that name as its host.
[[nodiscard]] std::optional<Refusal> refuse_host(const LiveGate& gate, std::string_view host);

/// Checks whether a POST may stop the run: control, host, origin, content type and token must all
/// be right. A page of another site cannot send it: its origin is different, JSON and the custom
/// header would need a permission that is never given, and it does not know the token.
[[nodiscard]] std::optional<Refusal> refuse_stop(const LiveGate& gate, const LiveRequest& request);

}  // namespace rondure::web
