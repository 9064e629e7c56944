// A first run in single steps, driven through a terminal of its own.

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/files.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// The program with a terminal as its standard input and outputs.
class OnTerminal {
 public:
  explicit OnTerminal(const std::vector<std::string>& arguments) {
    master_ = ::posix_openpt(O_RDWR | O_NOCTTY);
    if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0) return;
    const std::string name = ::ptsname(master_);
    std::vector<std::string> words = {RONDURE_BINARY};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ != 0) return;
    ::setsid();
    const int slave = ::open(name.c_str(), O_RDWR);
    for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(slave, fd);
    ::close(master_);
    ::execv(RONDURE_BINARY, argv.data());
    ::_exit(127);
  }
  ~OnTerminal() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
    ::close(master_);
  }
  OnTerminal(const OnTerminal&) = delete;
  OnTerminal& operator=(const OnTerminal&) = delete;

  void type(const std::string& keys) const {
    EXPECT_EQ(::write(master_, keys.data(), keys.size()), static_cast<ssize_t>(keys.size()));
  }
  /// Reads until `text` was shown once more; false at the end of the program or after 20 s.
  bool wait_for(const std::string& text) {
    const std::size_t from = shown_.size();
    while (shown_.find(text, from) == std::string::npos) {
      if (!read_some()) return false;
    }
    return true;
  }
  /// Everything shown, and the exit status.
  int finish() {
    while (read_some()) {
    }
    int state = 0;
    ::waitpid(pid_, &state, 0);
    pid_ = -1;
    return WIFEXITED(state) ? WEXITSTATUS(state) : -1;
  }
  [[nodiscard]] const std::string& shown() const { return shown_; }

 private:
  bool read_some() {
    pollfd ready = {master_, POLLIN, 0};
    if (::poll(&ready, 1, 20'000) != 1) return false;
    char bytes[4096];
    const ssize_t got = ::read(master_, bytes, sizeof bytes);
    if (got <= 0) return false;  // EIO: the program closed its end
    shown_.append(bytes, static_cast<std::size_t>(got));
    return true;
  }

  int master_ = -1;
  pid_t pid_ = -1;
  std::string shown_;
};

std::vector<std::string> stepwise(const TemporaryFolder& folder) {
  return {"run",    example("13_pose_search_virtual.json"),
          "--out",  (folder / "run").string(),
          "--step", "--archive",
          "none"};
}

TEST(Step, AsksBeforeEachMotionAndStopsInOrderOnQ) {
  const TemporaryFolder folder;
  OnTerminal program(stepwise(folder));
  ASSERT_TRUE(program.wait_for("[q] stop: ")) << program.shown();
  EXPECT_THAT(program.shown(), HasSubstr("home machine and fixture"));
  int asked = 1;
  // Home, across, down to the pole, touch; around the sphere and so on.
  while (program.shown().find("point 2: touch") == std::string::npos && asked < 40) {
    program.type("\n");
    ASSERT_TRUE(program.wait_for("[q] stop: ")) << program.shown();
    ++asked;
  }
  EXPECT_THAT(program.shown(),
              AllOf(HasSubstr("reference sphere, point 1: move from (0.000, 0.000, 500.000) to "
                              "(300.000, 0.000, 500.000) mm, 300.000 mm"),
                    HasSubstr("reference sphere, point 1: touch from ")));
  program.type("q\n");
  EXPECT_EQ(program.finish(), 3);
  EXPECT_THAT(program.shown(), AllOf(HasSubstr("stopped by the operator before: reference sphere, "
                                               "point 2: touch"),
                                     HasSubstr("--resume")));
  const auto record = journal_of(folder / "run");
  EXPECT_EQ(record.ending, "stopped");
  EXPECT_EQ(record.touches.size(), 1U);
  ASSERT_FALSE(record.decisions.empty());
  EXPECT_THAT(record.decisions.front().text, HasSubstr("single-step mode: travel at 10 mm/s"));
}

TEST(Step, GoesOnWithoutAskingAfterCAndMeasuresTheSame) {
  const TemporaryFolder folder;
  OnTerminal program(stepwise(folder));
  ASSERT_TRUE(program.wait_for("[q] stop: ")) << program.shown();
  program.type("x\n");
  ASSERT_TRUE(program.wait_for("[q] stop: ")) << "an unknown answer is asked again";
  program.type("c\n");
  EXPECT_LE(program.finish(), 1) << program.shown();
  const TemporaryFolder plain;
  const Outcome quickly = rondure({"run", example("13_pose_search_virtual.json"), "--out",
                                   (plain / "run").string(), "--archive", "none"});
  EXPECT_LE(quickly.status, 1) << quickly.err;
  const auto slow = journal_of(folder / "run");
  const auto quick = journal_of(plain / "run");
  ASSERT_EQ(slow.touches.size(), quick.touches.size());
  for (std::size_t i = 0; i < slow.touches.size(); ++i) {
    ASSERT_EQ(slow.touches[i].tip_mm, quick.touches[i].tip_mm);
  }
  EXPECT_GT(slow.touches.back().time_s, 3.0 * quick.touches.back().time_s) << "slower";
}

TEST(Step, RefusesWithoutATerminal) {
  const TemporaryFolder folder;
  Surroundings surroundings;
  const Outcome refused = rondure(stepwise(folder), surroundings);
  if (::isatty(STDIN_FILENO) == 1) GTEST_SKIP() << "the tests themselves have a terminal";
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("standard input is no terminal"));
  EXPECT_FALSE(std::filesystem::exists(folder / "run"));
}

}  // namespace
}  // namespace rondure::app::testing
