// What survives when a program dies or a disk is full.

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/noise.h"
#include "record/journal/journal.h"
#include "tests/record/sample_run.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// Runs in a child: touches without end; tells each number through the pipe once add() returned.
[[noreturn]] void write_touches_for_ever(const fs::path& directory, int pipe) {
  auto journal = Journal::create(directory, {}, {}, {});
  if (!journal) ::_exit(1);
  for (std::int64_t id = 0;; ++id) {
    if (!journal->add(touch_number(id)) || ::write(pipe, &id, sizeof id) != sizeof id) ::_exit(2);
  }
}

/// The last number that came through the pipe, -1 for none.
std::int64_t last_of(int pipe) {
  std::int64_t last = -1;
  std::int64_t id = 0;
  while (::read(pipe, &id, sizeof id) == sizeof id) last = id;
  return last;
}

TEST(JournalCrash, KeepsEveryTouchThatWasConfirmedBeforeAKill) {
  std::uint64_t state = 11;
  for (int round = 0; round < 20; ++round) {
    SCOPED_TRACE(round);
    const Scratch scratch(Scratch::Where::kDisk);
    std::array<int, 2> pipe{};
    ASSERT_EQ(::pipe(pipe.data()), 0);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) write_touches_for_ever(scratch / "run", pipe[1]);
    ::close(pipe[1]);
    std::int64_t first = 0;
    ASSERT_EQ(::read(pipe[0], &first, sizeof first), static_cast<ssize_t>(sizeof first));
    std::this_thread::sleep_for(std::chrono::microseconds(core::splitmix64(state) % 60'000));
    ::kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
    const std::int64_t confirmed = std::max(first, last_of(pipe[0]));
    ::close(pipe[0]);

    const auto read = read_journal(scratch / "run");
    ASSERT_TRUE(read) << read.error().what;
    const auto& touches = read->record.touches;
    // One more than confirmed: the child may die between the commit and its message.
    ASSERT_GE(std::ssize(touches), confirmed + 1);
    ASSERT_LE(std::ssize(touches), confirmed + 2);
    for (std::int64_t id = 0; id < std::ssize(touches); ++id) {
      const Touch& touch = touches[static_cast<std::size_t>(id)];
      ASSERT_EQ(touch.id, id);
      ASSERT_EQ(touch.tip_mm, touch_number(id).tip_mm);
    }
  }
}

/// Limits the size of files this process may write; a disk that fills up, without a disk.
void limit_file_size(rlim_t bytes) {
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit{};
  ::getrlimit(RLIMIT_FSIZE, &limit);
  limit.rlim_cur = bytes;
  ::setrlimit(RLIMIT_FSIZE, &limit);
}

/// Runs in a child, so that the limit ends with it. Exit status 0: as it should be.
int fill_the_disk(const fs::path& directory) {
  auto journal = Journal::create(directory, {}, {}, {});
  if (!journal) return 1;
  limit_file_size(200'000);
  std::int64_t id = 0;
  core::Result<void> written;
  while (id < 10'000 && (written = journal->add(touch_number(id)))) ++id;
  if (written || written.error().code != core::Code::kJournal) return 2;
  const std::string kept = "the touches up to number " + std::to_string(id - 1) + " are kept";
  if (written.error().what.find(kept) == std::string::npos) return 3;
  if (written.error().what.find("raise the limit") == std::string::npos) return 4;
  if (journal->add(touch_number(id))) return 5;
  if (journal->seal({})) return 6;
  limit_file_size(RLIM_INFINITY);  // room again: the same journal goes on
  if (!journal->add(touch_number(id))) return 7;
  if (!journal->end("finished", nullptr)) return 8;
  if (!journal->seal({})) return 9;
  return 0;
}

TEST(JournalCrash, SaysThatAnotherProgramCutTheLog) {
  for (const bool removed : {false, true}) {
    const Scratch scratch(Scratch::Where::kDisk);
    {
      auto journal = Journal::create(scratch / "run", {}, {}, {});
      ASSERT_TRUE(journal) << journal.error().what;
      for (std::int64_t id = 0; id < 20; ++id) ASSERT_TRUE(journal->add(touch_number(id)));
      const fs::path log = scratch / "run/journal.db-wal";
      removed ? (void)fs::remove(log) : fs::resize_file(log, fs::file_size(log) / 2);
      const auto refused = journal->add(touch_number(20));
      ASSERT_FALSE(refused);
      EXPECT_EQ(refused.error().code, core::Code::kJournal);
      EXPECT_THAT(refused.error().what, HasSubstr("another program cut its log, journal.db-wal, "));
      EXPECT_FALSE(journal->end("failed", nullptr));
    }
    // The holes were not moved into the journal: what stands before the cut is whole.
    const auto read = read_journal(scratch / "run");
    ASSERT_TRUE(read) << read.error().what;
    EXPECT_TRUE(read->broken.empty());
    for (std::size_t i = 0; i < read->record.touches.size(); ++i) {
      EXPECT_EQ(read->record.touches[i].tip_mm, touch_number(static_cast<std::int64_t>(i)).tip_mm);
    }
  }
}

TEST(JournalCrash, SaysThatTheDiskIsFullAndGoesOnWhenItIsNot) {
  const Scratch scratch(Scratch::Where::kDisk);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) ::_exit(fill_the_disk(scratch / "run"));
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  ASSERT_EQ(WEXITSTATUS(status), 0);
  const auto read = read_journal(scratch / "run");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_TRUE(read->broken.empty());
  EXPECT_TRUE(read->record.sealed);
  const auto& touches = read->record.touches;
  ASSERT_GT(touches.size(), 10U);
  for (std::size_t i = 0; i < touches.size(); ++i) {
    EXPECT_EQ(touches[i].id, static_cast<std::int64_t>(i));
  }
}

int create_without_room(const fs::path& directory) {
  limit_file_size(5000);
  const auto journal = Journal::create(directory, {}, {}, {});
  if (journal) return 1;
  return journal.error().code == core::Code::kJournal ? 0 : 2;
}

TEST(JournalCrash, LeavesNothingBehindWhenThereIsNoRoomForAJournal) {
  const Scratch scratch(Scratch::Where::kDisk);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) ::_exit(create_without_room(scratch / "a/b"));
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_TRUE(scratch.names().empty());
}

}  // namespace
}  // namespace rondure::record
