#include "tests/app/on_terminal.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>

#include <gtest/gtest.h>

#include "tests/app/program.h"

namespace rondure::app::testing {

OnTerminal::OnTerminal(const std::vector<std::string>& arguments, const std::string& locale) {
  master_ = ::posix_openpt(O_RDWR | O_NOCTTY);
  if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0) return;
  const std::string name = ::ptsname(master_);
  pid_ = start(arguments, [&] {
    ::setsid();
    const int slave = ::open(name.c_str(), O_RDWR);
    for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(slave, fd);
    ::close(master_);
    if (!locale.empty()) ::setenv("LC_ALL", locale.c_str(), 1);
  });
}

OnTerminal::~OnTerminal() {
  if (pid_ > 0) {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  ::close(master_);
}

void OnTerminal::type(const std::string& keys) const {
  EXPECT_EQ(::write(master_, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
}

bool OnTerminal::wait_for(const std::string& text) {
  std::size_t at = 0;
  while ((at = shown_.find(text, waited_)) == std::string::npos) {
    if (!read_some()) return false;
  }
  waited_ = at + text.size();
  return true;
}

int OnTerminal::finish() {
  while (read_some()) {
  }
  int state = 0;
  ::waitpid(pid_, &state, 0);
  pid_ = -1;
  return WIFEXITED(state) ? WEXITSTATUS(state) : -1;
}

bool OnTerminal::read_some() {
  pollfd ready = {master_, POLLIN, 0};
  if (::poll(&ready, 1, 120'000) != 1) return false;
  char bytes[4096];
  const ssize_t got = ::read(master_, bytes, sizeof bytes);
  if (got <= 0) return false;  // EIO: the program closed its end
  shown_.append(bytes, static_cast<std::size_t>(got));
  return true;
}

}  // namespace rondure::app::testing
