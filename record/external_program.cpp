#include "record/external_program.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <thread>

#include <fmt/format.h>

#include "record/files.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

std::string search_path() {
  if (const char* path = std::getenv("PATH")) return path;
  std::string path(::confstr(_CS_PATH, nullptr, 0), '\0');
  ::confstr(_CS_PATH, path.data(), path.size());
  path.resize(std::strlen(path.c_str()));
  return path;
}

std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> out;
  for (std::string& word : words) out.push_back(word.data());
  out.push_back(nullptr);
  return out;
}

/// The arguments of posix_spawn(), released at the end.
struct SpawnSettings {
  SpawnSettings() {
    ::posix_spawn_file_actions_init(&files);
    ::posix_spawnattr_init(&attributes);
  }
  ~SpawnSettings() {
    ::posix_spawnattr_destroy(&attributes);
    ::posix_spawn_file_actions_destroy(&files);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;

  posix_spawn_file_actions_t files{};
  posix_spawnattr_t attributes{};
};

/// @return  0 and the process, or the error number.
int spawn(const ProgramCall& call, pid_t& pid) {
  SpawnSettings settings;
  ::posix_spawn_file_actions_addopen(&settings.files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&settings.files, STDOUT_FILENO, call.said.c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, 0600);
  ::posix_spawn_file_actions_adddup2(&settings.files, STDOUT_FILENO, STDERR_FILENO);
  // The child gets its own process group, so that its children end with it and Ctrl-C reaches only
  // this program, and default signals, because this program ignores some.
  sigset_t usual;
  ::sigemptyset(&usual);
  ::posix_spawnattr_setsigmask(&settings.attributes, &usual);
  for (const int signal : {SIGPIPE, SIGXFSZ, SIGINT, SIGTERM, SIGHUP}) ::sigaddset(&usual, signal);
  ::posix_spawnattr_setsigdefault(&settings.attributes, &usual);
  ::posix_spawnattr_setpgroup(&settings.attributes, 0);
  ::posix_spawnattr_setflags(
      &settings.attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  std::vector<std::string> words = {call.program.string()};
  words.insert(words.end(), call.arguments.begin(), call.arguments.end());
  std::vector<std::string> environment = call.environment;
  return ::posix_spawn(&pid, call.program.c_str(), &settings.files, &settings.attributes,
                       pointers_to(words).data(), pointers_to(environment).data());
}

/// Whether a child ended before the time; the caller still has to wait for it.
bool ended_by(pid_t pid, Clock::time_point time) {
  while (true) {
    siginfo_t info{};
    ::waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOHANG | WNOWAIT);
    if (info.si_pid == pid) return true;
    if (Clock::now() >= time) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

/// ": " and the last line of a file; empty for an empty file.
std::string last_words(const fs::path& file) {
  constexpr std::size_t kMost = 300;
  std::string text = read_file(file).value_or("");
  text.resize(text.find_last_not_of(" \r\n") + 1);
  text.erase(0, text.rfind('\n') + 1);
  return text.empty() ? text : ": " + text.substr(0, kMost);
}

}  // namespace

fs::path find_program(const std::vector<std::string>& names) {
  const std::string path = search_path();
  for (const std::string& name : names) {
    for (std::size_t from = 0; from <= path.size();) {
      const std::size_t end = std::min(path.find(':', from), path.size());
      const fs::path file = fs::path(path.substr(from, end - from)) / name;
      std::error_code unknown;
      if (file.is_absolute() && fs::is_regular_file(file, unknown) &&
          ::access(file.c_str(), X_OK) == 0) {
        return file;
      }
      from = end + 1;
    }
  }
  return {};
}

core::Result<void> run_program(const ProgramCall& call) {
  const std::string name = call.program.string();
  pid_t pid = -1;
  if (const int error = spawn(call, pid); error != 0) {
    return core::fail_with(core::Code::kFile, "{} cannot be started: {}", name,
                           system_reason(error));
  }
  const bool in_time = ended_by(pid, Clock::now() + call.time_limit);
  ::kill(-pid, SIGKILL);  // before waitpid(): until then no other process has this number
  int state = 0;
  while (::waitpid(pid, &state, 0) < 0 && errno == EINTR) {
  }
  if (in_time && WIFEXITED(state) && WEXITSTATUS(state) == 0) return {};
  std::string why;
  if (!in_time) {
    why = fmt::format("did not end within {:g} s and was killed",
                      std::chrono::duration<double>(call.time_limit).count());
  } else if (WIFSIGNALED(state)) {
    why = fmt::format("was ended by signal {} ({})", WTERMSIG(state), ::strsignal(WTERMSIG(state)));
  } else {
    why = fmt::format("ended with status {}", WEXITSTATUS(state));
  }
  return core::fail_with(core::Code::kFile, "{} {}{}", name, why, last_words(call.said));
}

}  // namespace rondure::record
