#pragma once

#include <cstdint>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "cmm/ipp_client/survey.h"

namespace rondure::app {

/// Address of a server.
struct ServerPlace {
  std::string host;
  std::uint16_t port = 0;
};

/// The survey of a server as JSON: what it offers, what it lacks and the consequences for a plan,
/// and the resulting keys of `machine`, ready for a plan.
[[nodiscard]] nlohmann::ordered_json survey_json(const cmm::ipp::client::Survey& survey,
                                                 const ServerPlace& place);
/// The survey as text, in lines of at most 80 characters unless a text of the server is longer.
[[nodiscard]] std::string survey_text(const nlohmann::ordered_json& found);

}  // namespace rondure::app
