#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

// Private to the room: the URL of a PostgreSQL server, parsed by libpq. No other parser decides
// which part is a password.

namespace rondure::record {

/// One setting of a URL, decoded: "host", "user", "sslmode" ...
struct ServerSetting {
  std::string keyword;
  std::string value;
  bool secret = false;  ///< libpq hides it where it shows settings: password, sslpassword.
};

/// The settings that a URL gives, in the order of libpq. kBadOption when libpq cannot read it, with
/// the reason of libpq but without the part of the URL that the reason quotes. kFile without libpq.
[[nodiscard]] core::Result<std::vector<ServerSetting>> parse_server_url(std::string_view url);

/// Whether a text gives connection settings without being a URL ("host=h password=p"). kFile
/// without libpq.
[[nodiscard]] core::Result<bool> is_connection_text(std::string_view text);

/// "postgresql://?host=h&...": everything but letters, digits and -._~ percent-encoded.
[[nodiscard]] std::string server_url(const std::vector<ServerSetting>& settings);

/// The URL for messages: without secrets; unchanged when it holds none.
[[nodiscard]] std::string shown_url(std::string_view url,
                                    const std::vector<ServerSetting>& settings);

/// A message of libpq without the secrets of `url` and without the URL.
[[nodiscard]] std::string without_secrets(std::string sentence, std::string_view url);

}  // namespace rondure::record
