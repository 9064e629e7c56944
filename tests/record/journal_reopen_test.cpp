#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "record/files.h"
#include "record/journal/journal.h"
#include "tests/record/sample_run.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

TEST(JournalReopen, GoesOnBehindTheLastRow) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    SCOPED_TRACE(seed);
    const Scratch scratch;
    RunRecord whole = sample_run(seed);
    ASSERT_TRUE(write_run(scratch / "whole", whole));
    RunRecord first = whole;
    first.sealed = false;
    first.touches.resize(20);
    first.ending = "failed";
    ASSERT_TRUE(write_run(scratch / "run", first));
    {
      auto journal = reopened(scratch / "run");
      ASSERT_TRUE(journal) << journal.error().what;
      const auto between = read_journal(scratch / "run");
      EXPECT_EQ(between->record.ending, "");
      EXPECT_FALSE(between->record.failure);
      for (std::size_t i = 20; i < whole.touches.size(); ++i) {
        ASSERT_TRUE(journal->add(whole.touches[i]));
      }
      ASSERT_TRUE(journal->end(whole.ending, whole.failure ? &*whole.failure : nullptr));
      ASSERT_TRUE(journal->seal(whole.results));
    }
    EXPECT_EQ(every_bit(read_journal(scratch / "run")->record), every_bit(whole));
    EXPECT_TRUE(read_journal(scratch / "run")->broken.empty());
  }
}

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

TEST(JournalReopen, RefusesASealedRunAndADirectoryWithoutOne) {
  const Scratch scratch;
  ASSERT_TRUE(write_run(scratch / "run", sample_run(1)));
  const std::string bytes = read_file(scratch / "run/journal.db").value();
  const auto sealed = reopened(scratch / "run");
  ASSERT_FALSE(sealed);
  EXPECT_EQ(sealed.error().code, core::Code::kJournal);
  EXPECT_THAT(sealed.error().what, HasSubstr("sealed"));
  EXPECT_EQ(read_file(scratch / "run/journal.db").value(), bytes);
  EXPECT_THAT(scratch.names(), ::testing::ElementsAre("run", "run/SHA256SUMS", "run/journal.db"));
  EXPECT_FALSE(reopened(scratch / "absent"));
  fs::create_directory(scratch / "empty");
  EXPECT_FALSE(reopened(scratch / "empty"));
}

TEST(JournalReopen, RefusesAJournalThatIsOpen) {
  const Scratch scratch;
  const auto open = Journal::create(scratch / "run", {}, {}, {});
  ASSERT_TRUE(open);
  const auto second = reopened(scratch / "run");
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error().what, HasSubstr("is in use by process "));
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
