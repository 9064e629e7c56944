#include "tests/record/postgres_server.h"

#include <fcntl.h>
#include <grp.h>
#include <pwd.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>
#include <vector>

namespace rondure::record {
namespace {

namespace fs = std::filesystem;

/// The newest installed version, as Debian lays it out; empty when there is none.
fs::path binaries() {
  fs::path newest;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator("/usr/lib/postgresql", none)) {
    if (fs::exists(entry.path() / "bin" / "initdb", none) && entry.path() > newest) {
      newest = entry.path();
    }
  }
  return newest.empty() ? newest : newest / "bin";
}

/// The server refuses root; then it runs as the user of its package.
const passwd* other_user() { return ::getuid() == 0 ? ::getpwnam("postgres") : nullptr; }

/// Starts a program as that user; its output goes to `log`. It ends with this process.
pid_t start_program(const std::vector<std::string>& words, const fs::path& log) {
  std::vector<std::string> copies = words;
  std::vector<char*> argv;
  for (std::string& word : copies) argv.push_back(word.data());
  argv.push_back(nullptr);
  const passwd* const user = other_user();
  const pid_t pid = ::fork();
  if (pid != 0) return pid;
  const int output = ::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0666);
  if (output < 0 || ::dup2(output, 1) < 0 || ::dup2(output, 2) < 0) ::_exit(126);
  if (user != nullptr && (::setgroups(0, nullptr) != 0 || ::setgid(user->pw_gid) != 0 ||
                          ::setuid(user->pw_uid) != 0)) {
    ::_exit(126);
  }
  ::prctl(PR_SET_PDEATHSIG, SIGQUIT);
  ::execv(argv[0], argv.data());
  ::_exit(127);
}

int run_program(const std::vector<std::string>& words, const fs::path& log) {
  int status = -1;
  const pid_t pid = start_program(words, log);
  if (pid < 0 || ::waitpid(pid, &status, 0) != pid) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string contents(const fs::path& file) {
  std::ostringstream bytes;
  bytes << std::ifstream(file).rdbuf();
  return bytes.str();
}

}  // namespace

PostgresServer::PostgresServer() {
  if (binaries().empty()) {
    absent_ = "PostgreSQL is not installed (package postgresql)";
    return;
  }
  if (::getuid() == 0 && other_user() == nullptr) {
    absent_ = "PostgreSQL does not run as root and there is no user postgres";
    return;
  }
  std::string name = (fs::temp_directory_path() / "rondure-pg-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    absent_ = "no temporary folder " + name;
    return;
  }
  folder_ = name;
  prepare();
  if (absent_.empty()) start();
}

void PostgresServer::prepare() {
  if (const passwd* user = other_user();
      user != nullptr && ::chown(folder_.c_str(), user->pw_uid, user->pw_gid) != 0) {
    absent_ = "the folder of the cluster cannot be given to postgres";
    return;
  }
  const int made = run_program({binaries() / "initdb", "-D", folder_ / "data", "-A", "trust", "-U",
                                "rondure", "--no-sync", "-E", "UTF8", "--locale=C"},
                               "/dev/null");
  if (made != 0) {
    absent_ = "initdb failed with status " + std::to_string(made);
    return;
  }
  std::ofstream(folder_ / "data" / "pg_hba.conf")
      << "local all guarded scram-sha-256\nlocal all all trust\n";
}

PostgresServer::~PostgresServer() {
  stop();
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

std::string PostgresServer::url_of(const std::string& user, const std::string& database) const {
  std::string host = folder_.string();
  for (std::size_t at = host.find('/'); at != std::string::npos; at = host.find('/', at + 3)) {
    host.replace(at, 1, "%2F");
  }
  return "postgresql://" + user + "@" + host + "/" + database;
}

bool PostgresServer::answers() const {
  return run_program({binaries() / "pg_isready", "-q", "-h", folder_, "-U", "rondure"},
                     "/dev/null") == 0;
}

void PostgresServer::start() {
  if (!absent_.empty() || pid_ > 0) return;
  pid_ = start_program({binaries() / "postgres", "-D", folder_ / "data", "-k", folder_, "-c",
                        "listen_addresses=", "-c", "fsync=off"},
                       "/dev/null");
  for (int i = 0; i < 300 && !answers(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  if (!answers()) absent_ = "PostgreSQL did not start within 15 s";
  (void)sql("create role guarded login password 'right'");
}

void PostgresServer::stop() {
  if (pid_ <= 0) return;
  ::kill(pid_, SIGQUIT);
  ::waitpid(pid_, nullptr, 0);
  pid_ = -1;
}

std::string PostgresServer::sql(const std::string& text, const std::string& database) {
  const fs::path out = folder_ / "psql-output";
  std::error_code absent;
  fs::remove(out, absent);
  std::ofstream(out).close();
  fs::permissions(out, fs::perms::all, absent);
  (void)run_program({binaries() / "psql", "-X", "-q", "-A", "-t", "-h", folder_, "-U", "rondure",
                     "-d", database, "-c", text},
                    out);
  return contents(out);
}

}  // namespace rondure::record
