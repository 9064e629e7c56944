#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>

namespace rondure::record {

/// A PostgreSQL cluster of its own for one test: socket only, trusted user "rondure", and "guarded"
/// with the password "right". It ends with the test, even when the test is killed.
class PostgresServer {
 public:
  PostgresServer();
  ~PostgresServer();
  PostgresServer(const PostgresServer&) = delete;
  PostgresServer& operator=(const PostgresServer&) = delete;

  /// Reason why the cluster cannot run here; empty when it runs.
  [[nodiscard]] const std::string& absent() const { return absent_; }
  /// URL of its database, as the user "rondure".
  [[nodiscard]] std::string url() const { return url_of("rondure"); }
  /// URL with another user part ("guarded:right") and database.
  [[nodiscard]] std::string url_of(const std::string& user,
                                   const std::string& database = "postgres") const;

  void start();
  /// Stops the server as a power cut does, without closing connections.
  void stop();
  /// Runs SQL; returns the answer, or the error message of psql.
  [[nodiscard]] std::string sql(const std::string& text, const std::string& database = "postgres");

 private:
  [[nodiscard]] bool answers() const;
  void prepare();

  std::filesystem::path folder_;
  std::string absent_;
  pid_t pid_ = -1;
};

}  // namespace rondure::record
