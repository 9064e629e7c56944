#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "record/files.h"
#include "record/journal/journal.h"
#include "tests/record/sample_run.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;

TEST(JournalReopen, KeepsChecksApartAndInTheirOrder) {
  const Scratch scratch;
  {
    auto journal = Journal::create(scratch / "run", {}, {}, {});
    ASSERT_TRUE(journal);
    for (int id = 0; id < 3; ++id) ASSERT_TRUE(journal->add(touch_number(id)));
    for (int id = -1; id >= -3; --id) {
      Touch check = touch_number(id);
      check.purpose = Touch::Purpose::kCheck;
      ASSERT_TRUE(journal->add(check));
    }
  }
  const auto read = read_journal(scratch / "run");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->record.touches.size(), 3U);
  ASSERT_EQ(read->record.checks.size(), 3U);
  EXPECT_EQ(read->record.checks.front().id, -1);
  EXPECT_EQ(read->record.checks.back().id, -3);
}

TEST(JournalReopen, FinishSealFoldsTheLogOfARunThatDiedBehindItsSeal) {
  const Scratch scratch;
  const RunRecord run = sample_run(3);
  {
    RunRecord open = run;
    open.sealed = false;
    ASSERT_TRUE(write_run(scratch / "run", open));
    auto journal = reopened(scratch / "run");
    ASSERT_TRUE(journal);
    ASSERT_TRUE(journal->end(run.ending, run.failure ? &*run.failure : nullptr));
    // The list cannot be written while a folder has its name: the seal is there, its rest is not.
    fs::create_directory(scratch / "run/SHA256SUMS");
    ASSERT_FALSE(journal->seal(run.results));
  }
  EXPECT_TRUE(read_journal(scratch / "run")->record.sealed);
  EXPECT_FALSE(Journal::finish_seal(scratch / "run"));
  fs::remove(scratch / "run/SHA256SUMS");
  // What a death while the log was given up may leave.
  ASSERT_TRUE(write_file(scratch / "run/journal.db-journal", std::string(512, '\0')));
  ASSERT_TRUE(Journal::finish_seal(scratch / "run"));
  EXPECT_THAT(scratch.names(), ::testing::ElementsAre("run", "run/SHA256SUMS", "run/journal.db"));
  const std::string sums = read_file(scratch / "run/SHA256SUMS").value();
  EXPECT_EQ(every_bit(read_journal(scratch / "run")->record), every_bit(run));
  ASSERT_TRUE(Journal::finish_seal(scratch / "run"));
  EXPECT_EQ(read_file(scratch / "run/SHA256SUMS").value(), sums);
}

TEST(JournalReopen, RemovesWhatAKilledWriterOfReportsLeft) {
  const Scratch scratch;
  { ASSERT_TRUE(Journal::create(scratch / "run", {}, {}, {})); }
  ASSERT_TRUE(write_file(scratch / "run/.rondure-77-1.tmp", "<html"));
  ASSERT_TRUE(write_file(scratch / "run/note.tmp", "mine"));
  { ASSERT_TRUE(reopened(scratch / "run")); }
  EXPECT_FALSE(fs::exists(scratch / "run/.rondure-77-1.tmp"));
  EXPECT_TRUE(fs::exists(scratch / "run/note.tmp"));
}

}  // namespace
}  // namespace rondure::record
