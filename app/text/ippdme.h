#pragma once

#include <cstdint>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "cmm/ipp_client/survey.h"

namespace rondure::app {

/// Where a server was reached.
struct ServerPlace {
  std::string host;
  std::uint16_t port = 0;
};

/// What was found at a server, what it lacks and what that means for a plan, and the keys of
/// `machine` that follow, which a plan takes as they are.
[[nodiscard]] nlohmann::ordered_json survey_json(const cmm::ipp::client::Survey& survey,
                                                 const ServerPlace& place);
/// The same for a person, in lines of at most 80 characters as far as the server's own words allow.
[[nodiscard]] std::string survey_text(const nlohmann::ordered_json& found);

}  // namespace rondure::app
