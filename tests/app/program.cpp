#include "tests/app/program.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <stdexcept>

#include "tests/app/files.h"

namespace rondure::app::testing {
namespace {

void redirect(const std::filesystem::path& file, int fd) {
  const int opened = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (opened < 0 || ::dup2(opened, fd) < 0) ::_exit(126);
  ::close(opened);
}

void limit_files(std::size_t bytes) {
  const rlimit limit{bytes, bytes};
  if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) ::_exit(126);
}

/// Both outputs into a pipe that nobody reads.
void leave_unread() {
  int ends[2] = {};
  if (::pipe(ends) != 0) ::_exit(126);
  ::close(ends[0]);
  if (::dup2(ends[1], STDOUT_FILENO) < 0 || ::dup2(ends[1], STDERR_FILENO) < 0) ::_exit(126);
  ::close(ends[1]);
}

/// In the child, between fork and exec: allocates nothing, because a thread of this process may
/// have held the allocator when it was copied.
void enter(const Surroundings& surroundings, const std::filesystem::path& out,
           const std::filesystem::path& err) {
  redirect(err, STDERR_FILENO);
  if (surroundings.standard_output == "closed") {
    ::close(STDOUT_FILENO);
  } else if (surroundings.standard_output == "unread") {
    leave_unread();
  } else {
    redirect(out, STDOUT_FILENO);
  }
  if (surroundings.largest_file_bytes) limit_files(*surroundings.largest_file_bytes);
  if (surroundings.empty_environment) ::clearenv();
  constexpr uid_t kNobody = 65534;
  if (surroundings.unprivileged && ::geteuid() == 0 && ::setuid(kNobody) != 0) ::_exit(126);
}

}  // namespace

pid_t start(const std::vector<std::string>& arguments, const std::function<void()>& enter) {
  std::vector<std::string> words = {RONDURE_BINARY};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t pid = ::fork();
  if (pid < 0) throw std::runtime_error("no process can be started");
  if (pid > 0) return pid;
  enter();
  ::execv(RONDURE_BINARY, argv.data());
  ::_exit(127);
}

Program::Program(const std::vector<std::string>& arguments, const Surroundings& surroundings)
    : pid_(start(arguments, [&surroundings,
                             out = surroundings.standard_output.empty()
                                       ? folder_ / "out"
                                       : std::filesystem::path(surroundings.standard_output),
                             err = folder_ / "err"] { enter(surroundings, out, err); })) {}

Program::~Program() {
  if (pid_ <= 0) return;
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

void Program::send(int signal) const {
  if (pid_ > 0) ::kill(pid_, signal);  // -1, of a program that was waited for, would mean everyone
}

bool Program::ended() const {
  siginfo_t info{};
  return ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         info.si_pid == pid_;
}

std::string Program::told() const { return read(folder_ / "err"); }

Outcome Program::wait() {
  int state = 0;
  ::waitpid(pid_, &state, 0);
  pid_ = -1;
  Outcome out;
  if (WIFEXITED(state)) out.status = WEXITSTATUS(state);
  if (WIFSIGNALED(state)) out.signal = WTERMSIG(state);
  out.out = read(folder_ / "out");
  out.err = read(folder_ / "err");
  return out;
}

Outcome rondure(const std::vector<std::string>& arguments, const Surroundings& surroundings) {
  return Program(arguments, surroundings).wait();
}

}  // namespace rondure::app::testing
