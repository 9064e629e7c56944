#include "record/journal/internal/private_copy.h"

#include <array>
#include <csignal>
#include <cstdlib>
#include <optional>
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
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::SizeIs;

/// A folder that holds the temporary folders of this program meanwhile.
class TemporaryPlace {
 public:
  TemporaryPlace() {
    if (const char* before = std::getenv("TMPDIR")) before_ = before;
    ::setenv("TMPDIR", scratch_.path().c_str(), 1);
  }
  ~TemporaryPlace() {
    if (before_) {
      ::setenv("TMPDIR", before_->c_str(), 1);
    } else {
      ::unsetenv("TMPDIR");
    }
  }
  TemporaryPlace(const TemporaryPlace&) = delete;
  TemporaryPlace& operator=(const TemporaryPlace&) = delete;

  [[nodiscard]] const Scratch& scratch() const { return scratch_; }

 private:
  std::optional<std::string> before_;
  Scratch scratch_;
};

/// A process that copies a journal and is killed before it can tidy up.
void copy_and_die(const fs::path& journal) {
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe(pipe.data()), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const auto copy = PrivateCopy::of(journal);
    const char answer = copy ? 'y' : 'n';
    if (::write(pipe[1], &answer, 1) != 1) ::_exit(1);
    while (true) ::pause();
  }
  char answer = 0;
  EXPECT_EQ(::read(pipe[0], &answer, 1), 1);
  EXPECT_EQ(answer, 'y');
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  ::close(pipe[0]);
  ::close(pipe[1]);
}

TEST(PrivateCopy, OfAKilledProgramIsRemovedByTheNextOneAndNoOther) {
  const Scratch run;
  ASSERT_TRUE(write_run(run / "run", sample_run(1)));
  const fs::path journal = run / "run/journal.db";
  const TemporaryPlace place;
  ASSERT_TRUE(write_file(place.scratch() / "rondure-journal-of-mine", "keep"));
  copy_and_die(journal);
  EXPECT_THAT(place.scratch().names(), Contains(::testing::EndsWith("journal.db")));
  const auto one = PrivateCopy::of(journal);
  const auto two = PrivateCopy::of(journal);
  ASSERT_TRUE(one && two);
  EXPECT_TRUE(fs::exists(one->file()) && fs::exists(two->file())) << "both are in use";
  EXPECT_THAT(place.scratch().names(), SizeIs(5)) << "two folders, two copies and a file of ours";
}

TEST(PrivateCopy, LeavesNothingWhenItIsDone) {
  const Scratch run;
  ASSERT_TRUE(write_run(run / "run", sample_run(1)));
  const TemporaryPlace place;
  EXPECT_TRUE(read_journal(run / "run"));
  EXPECT_THAT(place.scratch().names(), ::testing::IsEmpty());
}

TEST(PrivateCopy, OfAPipeIsRefusedAndNotWaitedFor) {
  const Scratch run;
  ASSERT_TRUE(write_run(run / "run", sample_run(1)));
  ASSERT_EQ(::mkfifo((run / "run/journal.db-wal").c_str(), 0600), 0);
  const auto copy = PrivateCopy::of(run / "run/journal.db");
  ASSERT_FALSE(copy);
  EXPECT_THAT(copy.error().what, AllOf(HasSubstr("journal.db-wal"), HasSubstr("a pipe")));
}

}  // namespace
}  // namespace rondure::record
