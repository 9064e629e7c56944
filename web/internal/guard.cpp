#include "web/internal/guard.h"

#include <sys/random.h>

#include <array>

#include <fmt/format.h>

namespace rondure::web {
namespace {

bool is_json(std::string_view content_type) {
  const std::string_view type = content_type.substr(0, content_type.find(';'));
  return type == "application/json" || type == "application/json ";
}

}  // namespace

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) return {};
  std::string out;
  for (const unsigned char byte : bytes) out += fmt::format("{:02x}", byte);
  return out;
}

bool same_secret(std::string_view expected, std::string_view given) {
  unsigned difference = expected.size() == given.size() && !expected.empty() ? 0U : 1U;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const char known = i < expected.size() ? expected[i] : '\0';
    difference |= static_cast<unsigned>(static_cast<unsigned char>(known) ^
                                        static_cast<unsigned char>(given[i]));
  }
  return difference == 0U;
}

std::optional<Refusal> refuse_host(const LiveGate& gate, std::string_view host) {
  if (host == fmt::format("127.0.0.1:{}", gate.port) ||
      host == fmt::format("localhost:{}", gate.port)) {
    return std::nullopt;
  }
  return Refusal{403, "this page answers under its own address only"};
}

std::optional<Refusal> refuse_stop(const LiveGate& gate, const LiveRequest& request) {
  if (!gate.control)
    return Refusal{403, "this page is read-only; start the run with --control to stop it here"};
  if (auto refusal = refuse_host(gate, request.host)) return refusal;
  if (request.origin != "http://" + request.host)
    return Refusal{403, "the request comes from another page"};
  if (!request.fetch_site.empty() && request.fetch_site != "same-origin")
    return Refusal{403, "the request comes from another site"};
  if (!is_json(request.content_type)) return Refusal{415, "the content type is not JSON"};
  if (!same_secret(gate.token, request.token))
    return Refusal{403, "the token is not that of this run; open the address that it printed"};
  return std::nullopt;
}

}  // namespace rondure::web
