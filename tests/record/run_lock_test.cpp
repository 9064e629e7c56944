#include "record/run_lock.h"

#include <array>
#include <csignal>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "record/files.h"
#include "record/journal/journal.h"
#include "tests/record/sample_run.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A process that holds the lock until it is killed.
class Holder {
 public:
  explicit Holder(const fs::path& directory) {
    std::array<int, 2> pipe{};
    if (::pipe(pipe.data()) != 0) std::abort();
    pid_ = ::fork();
    if (pid_ == 0) {
      const auto lock = RunLock::take(directory);
      const char answer = lock ? 'y' : 'n';
      if (::write(pipe[1], &answer, 1) != 1) ::_exit(1);
      while (true) ::pause();
    }
    char answer = 0;
    EXPECT_EQ(::read(pipe[0], &answer, 1), 1);
    EXPECT_EQ(answer, 'y');
    ::close(pipe[0]);
    ::close(pipe[1]);
  }
  ~Holder() { kill(); }
  Holder(const Holder&) = delete;
  Holder& operator=(const Holder&) = delete;

  void kill() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
    pid_ = -1;
  }
  [[nodiscard]] pid_t pid() const { return pid_; }

 private:
  pid_t pid_ = -1;
};

TEST(RunLock, RefusesASecondProcessAndNamesTheFirst) {
  const Scratch scratch(Scratch::Where::kDisk);
  const Holder holder(scratch.path());
  const auto second = RunLock::take(scratch.path());
  ASSERT_FALSE(second);
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  EXPECT_EQ(second.error().code, core::Code::kFile);
  EXPECT_THAT(second.error().what,
              AllOf(HasSubstr("is in use by process " + std::to_string(holder.pid()) + " on host " +
                              host.data()),
                    HasSubstr(scratch.path().string())));
  EXPECT_FALSE(Journal::create(scratch.path(), {}, {}, {}));
}

TEST(RunLock, DiesWithItsProcessAndLeavesAFileThatLocksNothing) {
  const Scratch scratch(Scratch::Where::kDisk);
  Holder holder(scratch.path());
  holder.kill();
  EXPECT_THAT(scratch.names(), ::testing::ElementsAre("run.lock"));
  EXPECT_TRUE(RunLock::take(scratch.path()));
  EXPECT_THAT(scratch.names(), IsEmpty());
  EXPECT_TRUE(Journal::create(scratch / "run", {}, {}, {}));
}

TEST(RunLock, OfOneProcessIsTakenOnceAsWell) {
  const Scratch scratch(Scratch::Where::kDisk);
  {
    const auto first = RunLock::take(scratch.path());
    ASSERT_TRUE(first);
    EXPECT_FALSE(RunLock::take(scratch.path()));
  }
  EXPECT_TRUE(RunLock::take(scratch.path()));
}

TEST(RunLock, SaysWhenItCannotBeMade) {
  const auto lock = RunLock::take("/proc/self");
  ASSERT_FALSE(lock);
  EXPECT_THAT(lock.error().what, HasSubstr("cannot be taken"));
}

TEST(RunLock, NeitherFollowsALinkNorEmptiesWhatIsNoLock) {
  const Scratch scratch(Scratch::Where::kDisk);
  const fs::path lock = scratch / "run/run.lock";
  fs::create_directory(scratch / "run");
  ASSERT_TRUE(write_file(scratch / "thesis.txt", "years of work"));
  const auto refused = [&](const std::string& why) {
    const auto taken = RunLock::take(scratch / "run");
    ASSERT_FALSE(taken) << why;
    EXPECT_THAT(taken.error().what, AllOf(HasSubstr(lock.string()), HasSubstr(why)));
    EXPECT_EQ(read_file(scratch / "thesis.txt").value(), "years of work");
    EXPECT_TRUE(fs::remove(lock)) << "it was left where it stood";
  };
  fs::create_symlink(scratch / "thesis.txt", lock);
  refused("a link");
  fs::create_symlink(scratch / "absent", lock);
  refused("a link");
  EXPECT_FALSE(fs::exists(scratch / "absent"));
  fs::create_hard_link(scratch / "thesis.txt", lock);
  refused("a second name of another file");
  fs::copy_file(scratch / "thesis.txt", lock);
  refused("a file of something else");
  ASSERT_EQ(::mkfifo(lock.c_str(), 0600), 0);
  refused("a pipe, a device or a folder");
  EXPECT_TRUE(RunLock::take(scratch / "run"));
}

TEST(RunLock, WhoseBytesAPowerCutLostLocksNothing) {
  for (const std::string& bytes : {std::string(), std::string(30, '\0')}) {
    const Scratch scratch(Scratch::Where::kDisk);
    ASSERT_TRUE(write_file(scratch / "run.lock", bytes));
    EXPECT_TRUE(RunLock::take(scratch.path()));
  }
}

TEST(UnbornRun, IsAnAbsentOrEmptyDirectory) {
  const Scratch scratch(Scratch::Where::kDisk);
  EXPECT_TRUE(clear_unstarted_run(scratch / "run").value());
  fs::create_directory(scratch / "run");
  EXPECT_TRUE(clear_unstarted_run(scratch / "run").value());
  ASSERT_TRUE(write_file(scratch / "run/run.lock", "process 1 on host gone\n"));
  EXPECT_TRUE(clear_unstarted_run(scratch / "run").value());
}

TEST(UnbornRun, IsAJournalWhoseHeadNeverReachedTheDisk) {
  const Scratch scratch(Scratch::Where::kDisk);
  fs::create_directory(scratch / "run");
  ASSERT_TRUE(write_file(scratch / "run/journal.db", ""));
  EXPECT_TRUE(clear_unstarted_run(scratch / "run").value());
  EXPECT_THAT(scratch.names(), ::testing::ElementsAre("run"));
}

TEST(UnbornRun, IsNothingThatHoldsAnything) {
  const Scratch scratch(Scratch::Where::kDisk);
  ASSERT_TRUE(Journal::create(scratch / "run", {}, {}, {}));
  EXPECT_FALSE(clear_unstarted_run(scratch / "run").value());
  EXPECT_TRUE(read_journal(scratch / "run"));
  fs::create_directory(scratch / "text");
  ASSERT_TRUE(write_file(scratch / "text/journal.db", "my journal"));
  EXPECT_FALSE(clear_unstarted_run(scratch / "text").value());
  EXPECT_EQ(read_file(scratch / "text/journal.db").value(), "my journal");
  fs::create_directory(scratch / "mine");
  ASSERT_TRUE(write_file(scratch / "mine/mine.txt", "keep"));
  EXPECT_FALSE(clear_unstarted_run(scratch / "mine").value());
  EXPECT_FALSE(fs::exists(scratch / "mine/run.lock"));
  // A journal that lost its contents beside its reports is no beginning.
  fs::create_directory(scratch / "lost");
  ASSERT_TRUE(write_file(scratch / "lost/journal.db", ""));
  ASSERT_TRUE(write_file(scratch / "lost/SHA256SUMS", ""));
  EXPECT_FALSE(clear_unstarted_run(scratch / "lost").value());
  EXPECT_TRUE(fs::exists(scratch / "lost/journal.db"));
}

}  // namespace
}  // namespace rondure::record
