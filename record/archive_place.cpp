#include "record/archive_place.h"

#include <algorithm>

#include <fmt/format.h>

namespace rondure::record {
namespace {

namespace fs = std::filesystem;

/// "user:secret@host" without ":secret".
std::string without_secret(std::string_view authority) {
  const std::size_t at = authority.rfind('@');
  if (at == std::string_view::npos) return std::string(authority);
  const std::size_t colon = authority.substr(0, at).find(':');
  if (colon == std::string_view::npos) return std::string(authority);
  return fmt::format("{}{}", authority.substr(0, colon), authority.substr(at));
}

bool is_secret(std::string_view parameter) {
  return parameter.starts_with("password=") || parameter.starts_with("sslpassword=");
}

/// "?a=1&password=secret&b=2" without the secret.
std::string without_secrets(std::string_view query) {
  std::string kept;
  while (!query.empty()) {
    const std::size_t end = std::min(query.find('&', 1), query.size());
    const std::string_view parameter = query.substr(1, end - 1);
    if (!is_secret(parameter)) kept += fmt::format("{}{}", kept.empty() ? '?' : '&', parameter);
    query.remove_prefix(end);
  }
  return kept;
}

core::Result<ArchivePlace> server_at(std::string_view url, std::size_t authority_start) {
  const std::size_t path = std::min(url.find_first_of("/?", authority_start), url.size());
  const std::size_t query = std::min(url.find('?', authority_start), url.size());
  const std::string_view database = url.substr(path, query - path);
  if (database.find('@') != std::string_view::npos) {
    return core::fail(core::Code::kBadOption,
                      "the URL of the archive has an @ behind its first /; write / as %2F and @ as "
                      "%40 in a user, a password or the name of a database");
  }
  const std::string_view authority = url.substr(authority_start, path - authority_start);
  const std::string shown =
      fmt::format("{}{}{}{}", url.substr(0, authority_start), without_secret(authority), database,
                  without_secrets(url.substr(query)));
  return ArchivePlace{ArchivePlace::Kind::kServer, std::string(url), shown, shown};
}

}  // namespace

core::Result<ArchivePlace> parse_archive_place(std::string_view text, const fs::path& folder) {
  if (text == "none") return ArchivePlace{ArchivePlace::Kind::kNone, "none", "none", "none"};
  for (const std::string_view scheme : {"postgresql://", "postgres://"}) {
    if (text.starts_with(scheme)) return server_at(text, scheme.size());
  }
  const std::size_t scheme = text.find("://");
  if (text.empty() || scheme != std::string_view::npos) {
    const std::string found =
        text.empty() ? "the archive has no name"
                     : fmt::format("an archive at {}:// is unknown", text.substr(0, scheme));
    return core::fail(core::Code::kBadOption,
                      fmt::format("{}; give a file, postgresql://... or none", found));
  }
  const std::string path = (folder / text).string();
  return ArchivePlace{ArchivePlace::Kind::kFile, path, path,
                      fs::absolute(path).lexically_normal().string()};
}

fs::path folder_beside(const fs::path& run_directory) {
  const fs::path name = run_directory.filename();
  if (!name.empty() && name != "." && name != "..") return run_directory.parent_path();
  const fs::path whole = fs::absolute(run_directory).lexically_normal();
  return (whole.has_filename() ? whole : whole.parent_path()).parent_path();
}

}  // namespace rondure::record
