#include "record/archive/internal/session.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>

#include <fmt/format.h>
#include <soci/sqlite3/soci-sqlite3.h>

#include "record/archive/internal/postgresql.h"
#include "record/archive/internal/rows.h"
#include "record/archive/internal/server_url.h"
#include "record/files.h"
#include "record/internal/database.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;
using core::Code;

/// The message of libpq in one line, without the sentence that SOCI adds in front.
std::string words_of_server(const std::string& message) {
  constexpr std::string_view kOfSoci = "Cannot establish connection to the database.";
  std::string words;
  for (std::string_view rest = message; !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    if (line.empty() || line == kOfSoci) continue;
    words += fmt::format("{}{}", words.empty() ? "" : "; ", line);
  }
  return words.empty() ? "the server gave no reason" : words;
}

std::string reason_of_server(const ArchivePlace& place, const std::exception& exception) {
  const auto* error = dynamic_cast<const soci::soci_error*>(&exception);
  std::string words =
      words_of_server(error == nullptr ? exception.what() : error->get_error_message());
  const auto has = [&](std::string_view part) { return words.find(part) != std::string::npos; };
  const bool of_password = has("password");
  words = without_secrets(std::move(words), place.address);
  if (of_password) {
    words += "; check the user, and the password in ~/.pgpass";
  } else if (has("Connection refused") || has("timeout expired") || has("could not translate")) {
    words += "; check host and port, and start the server";
  } else if (has("permission denied")) {
    words += "; let the database's owner grant it";
  }
  return words;
}

/// SQLite reports only "unable to open"; the reason comes from the system.
std::string reason_of_file(const fs::path& file, const std::exception& exception,
                           soci::session* session) {
  const auto* error = dynamic_cast<const soci::sqlite3_soci_error*>(&exception);
  if (error == nullptr || (error->result() & 0xff) != SQLITE_CANTOPEN) {
    return reason_of(exception, session);
  }
  std::error_code unknown;
  if (fs::is_directory(file, unknown)) return "it is a folder; name a file";
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const fs::path looked_at = fs::exists(file, unknown) ? file : folder;
  if (::access(looked_at.c_str(), R_OK | W_OK) == 0) return reason_of(exception, session);
  return fmt::format("{}: {}", looked_at.string(), system_reason(errno));
}

tl::unexpected<core::Error> not_ours(const ArchivePlace& place, std::string_view what) {
  return core::fail(Code::kFile, fmt::format("{} {}", place.shown, what), place.shown);
}

/// Checks a file before SQLite opens it.
core::Result<void> check_file(const ArchivePlace& place, Archive::Access access) {
  std::error_code unknown;
  const fs::file_status status = fs::status(place.address, unknown);
  if (!fs::exists(status)) {
    if (access == Archive::Access::kWrite) return {};
    return not_ours(place, "does not exist; rondure run makes it, or name another archive");
  }
  if (!fs::is_regular_file(status)) return not_ours(place, "is no file; name an archive");
  return {};
}

/// Decides by SQLite's own error, because SQLite reads under its lock: another program may be
/// writing the first page.
bool is_no_database(const std::exception& exception) {
  const auto* error = dynamic_cast<const soci::sqlite3_soci_error*>(&exception);
  return error != nullptr && (error->result() & 0xff) == SQLITE_NOTADB;
}

/// Adds time limits to a URL: 5 s for an answer, 15 s for a broken connection. The URL is rebuilt,
/// since SOCI cuts it at spaces and quotes.
std::string with_limits(const std::string& url) {
  auto settings = parse_server_url(url).value_or(std::vector<ServerSetting>{});
  for (const ServerSetting& limit :
       {ServerSetting{"connect_timeout", "5"}, ServerSetting{"tcp_user_timeout", "15000"},
        ServerSetting{"application_name", "rondure"}}) {
    const bool given = std::any_of(settings.begin(), settings.end(), [&](const ServerSetting& s) {
      return s.keyword == limit.keyword;
    });
    if (!given) settings.push_back(limit);
  }
  return server_url(settings);
}

void open_server(ArchiveSession& session) {
  session.dialect = &postgresql_dialect();
  session.sql.open(*postgresql()->factory(), with_limits(session.place.address));
  session.sql << "set client_min_messages = warning";
  session.sql << "set client_encoding = 'UTF8'";
  session.sql << "set lock_timeout = '10s'";
  std::string encoding;
  session.sql << "select current_setting('server_encoding')", soci::into(encoding);
  if (encoding != "UTF8") {
    throw std::runtime_error(fmt::format(
        "the database keeps text as {}; make one with encoding UTF8 for the archive", encoding));
  }
}

void open_file(ArchiveSession& session, const std::string& connection) {
  session.dialect = &sqlite_dialect();
  session.sql.open(soci::sqlite3, connection);
  session.sql << "pragma synchronous = full";
  session.sql << "pragma foreign_keys = on";
}

bool has_archive(ArchiveSession& session) {
  int found = 0;
  session.sql << std::string(session.dialect->has_archive), soci::into(found);
  return found > 0;
}

/// Whether there is any table. All tables of an archive appear in one transaction.
bool has_tables(ArchiveSession& session) {
  if (session.place.kind != ArchivePlace::Kind::kFile) return false;  // a server serves many
  int tables = 0;
  session.sql << "select count(*) from sqlite_master", soci::into(tables);
  return tables > 0;
}

void make_tables(ArchiveSession& session) {
  if (!session.dialect->lock.empty()) {
    int ignored = 0;
    session.sql << std::string(session.dialect->lock), soci::into(ignored);
  }
  if (has_archive(session)) return;  // another program created them in the meantime
  for (const std::string& statement : archive_statements(*session.dialect)) {
    session.sql << statement;
  }
}

core::Result<void> check_tables(ArchiveSession& session, Archive::Access access) {
  // Queried first: tables that another program creates between the two queries belong to an
  // archive.
  const bool holds_tables = has_tables(session);
  if (!has_archive(session)) {
    if (holds_tables) {
      return not_ours(session.place, "holds the tables of another program; name another file");
    }
    if (access == Archive::Access::kRead) {
      return not_ours(session.place, "holds no archive yet; rondure run makes it");
    }
    if (auto made = write_in_one(session, [&] { make_tables(session); }); !made) return made;
  }
  const int version = archive_version(session.sql);
  if (version == kArchiveVersion) return {};
  return not_ours(session.place,
                  fmt::format("is an archive of version {}, this program knows version {}; {}",
                              version, kArchiveVersion,
                              version == 1 ? "docs/archive.md has the two statements that make it "
                                             "one of version 2"
                                           : "use the program that made it, or another archive"));
}

}  // namespace

core::Result<std::unique_ptr<ArchiveSession>> open_archive_session(const ArchivePlace& place,
                                                                   Archive::Access access) {
  auto session = std::make_unique<ArchiveSession>();
  session->place = place;
  try {
    if (place.kind == ArchivePlace::Kind::kServer) {
      TRY_DO(postgresql());
      open_server(*session);
    } else {
      TRY_DO(check_file(place, access));
      TRY(const auto connection, connection_string(place.address));
      open_file(*session, connection);
    }
    TRY_DO(check_tables(*session, access));
    return session;
  } catch (const std::exception& exception) {
    if (is_no_database(exception)) {
      return not_ours(place, "is not a database; name an archive, or another file for a new one");
    }
    return archive_failure(place, "opened", exception, &session->sql);
  }
}

core::Result<void> write_in_one(ArchiveSession& session, const std::function<void()>& work) {
  bool begun = false;
  try {
    session.sql << std::string(session.dialect->begin);
    begun = true;
    work();
    session.sql << "commit";
    return {};
  } catch (const std::exception& exception) {
    auto failure = archive_failure(session.place, "written", exception, &session.sql);
    try {
      if (begun) session.sql << "rollback";
    } catch (const std::exception&) {  // a server that is gone has already rolled back
    }
    return failure;
  }
}

tl::unexpected<core::Error> archive_failure(const ArchivePlace& place, std::string_view participle,
                                            const std::exception& exception,
                                            soci::session* session) {
  const std::string reason = place.kind == ArchivePlace::Kind::kServer
                                 ? reason_of_server(place, exception)
                                 : reason_of_file(place.address, exception, session);
  return core::fail_with(Code::kArchive, "the archive {} cannot be {}: {}", place.shown, participle,
                         reason);
}

}  // namespace rondure::record
