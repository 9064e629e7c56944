#include "record/archive/place.h"

#include <fmt/format.h>

#include "record/archive/internal/server_url.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;

/// Whether a password may have been cut at an unencoded @ or /: libpq takes the text before the
/// first @ as user and password, unless a / precedes it, and the rest as the host.
bool has_stray_at(std::string_view after_scheme) {
  const std::size_t at = after_scheme.find_first_of("@/");
  if (at != std::string_view::npos && after_scheme[at] == '@') after_scheme.remove_prefix(at + 1);
  return after_scheme.substr(0, after_scheme.find('?')).find('@') != std::string_view::npos;
}

core::Result<ArchivePlace> server_at(std::string_view url, std::size_t authority_start) {
  if (has_stray_at(url.substr(authority_start))) {
    return core::fail(core::Code::kBadOption,
                      "the URL of the archive has an @ too many; write / as %2F and @ as %40 in a "
                      "user, a password or the name of a database");
  }
  TRY(const auto settings, parse_server_url(url));
  const std::string shown = shown_url(url, settings);
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
    return core::fail_with(core::Code::kBadOption, "{}; give a file, postgresql://... or none",
                           found);
  }
  // Otherwise a file of that name would be created, and its name shown in messages and in the
  // queue.
  TRY(const bool settings, is_connection_text(text));
  if (settings || text.starts_with("postgresql:") || text.starts_with("postgres:")) {
    return core::fail(core::Code::kBadOption,
                      "the archive is a server, but not given as a URL; write "
                      "postgresql://user@host:port/database");
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
