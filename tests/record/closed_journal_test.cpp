// A journal that its run closed is read alone, whatever was laid beside it; nothing that somebody
// put into a journal is run, when it is read and when its run goes on.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "record/checksums.h"
#include "record/files.h"
#include "record/journal/journal.h"
#include "tests/record/meddle.h"
#include "tests/record/sample_run.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Two runs that were closed, the second with other touches.
class ClosedJournal : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(write_run(scratch / "run", run));
    ASSERT_TRUE(write_run(scratch / "other", sample_run(12)));
  }
  void lay_beside(const std::string& suffix, const std::string& bytes) const {
    ASSERT_FALSE(bytes.empty());
    ASSERT_TRUE(write_file(file.string() + suffix, bytes));
  }
  /// The file's own contents are read, and what lies beside it is named.
  void expect_read_alone(const std::string& beside) const {
    const auto read = read_journal(scratch / "run");
    ASSERT_TRUE(read) << read.error().what;
    EXPECT_EQ(every_bit(read->record), every_bit(run));
    EXPECT_THAT(read->broken, IsEmpty());
    EXPECT_THAT(read->beside, ElementsAre(beside));
    ASSERT_EQ(faults_of(*read).size(), 1U);
    EXPECT_THAT(faults_of(*read).front(), HasSubstr(beside + " stands beside the closed journal"));
  }

  Scratch scratch;
  RunRecord run = sample_run(11);
  fs::path file = scratch / "run/journal.db";
};

TEST_F(ClosedJournal, IsReadAloneWhateverLiesBesideIt) {
  const std::string log = log_that_replaces(file, scratch / "other/journal.db");
  lay_beside("-elsewhere", log);
  for (const bool listed : {true, false}) {
    if (!listed) fs::remove(scratch / "run/SHA256SUMS");
    SCOPED_TRACE(listed);
    lay_beside("-wal", log);
    expect_read_alone("journal.db-wal");
    lay_beside("-wal", "this is no log");
    expect_read_alone("journal.db-wal");
    fs::remove(file.string() + "-wal");
    fs::create_symlink("journal.db-elsewhere", file.string() + "-wal");
    expect_read_alone("journal.db-wal");
    fs::remove(file.string() + "-wal");
    lay_beside("-journal", rollback_to(scratch / "other/journal.db"));
    expect_read_alone("journal.db-journal");
    fs::remove(file.string() + "-journal");
  }
}

TEST_F(ClosedJournal, HasNothingBesideItWhenAKilledProgramHadOnlyBegunALog) {
  // The head of a rollback journal is zeros until its pages are on disk.
  fs::remove(scratch / "run/SHA256SUMS");
  lay_beside("-journal", std::string(512, '\0') + "pages");
  const auto read = read_journal(scratch / "run");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_THAT(faults_of(*read), IsEmpty());
  EXPECT_EQ(every_bit(read->record), every_bit(run));
  ASSERT_TRUE(Journal::finish_seal(scratch / "run"));
  EXPECT_THAT(faults_of(*read_journal(scratch / "run")), IsEmpty());
}

TEST_F(ClosedJournal, HasNothingBesideItWhenThatIsEmptyOrOnlyAnIndexOfALog) {
  ASSERT_TRUE(write_file(file.string() + "-wal", ""));
  ASSERT_TRUE(write_file(file.string() + "-shm", std::string(32768, 'x')));
  const auto read = read_journal(scratch / "run");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_THAT(faults_of(*read), IsEmpty());
  EXPECT_EQ(every_bit(read->record), every_bit(run));
}

TEST_F(ClosedJournal, ThatOnlyMissesItsListKeepsALogWithTheSameRows) {
  // A run that died between folding its log and giving it up.
  fs::remove(scratch / "run/SHA256SUMS");
  lay_beside("-wal", log_that_replaces(file, file));
  const auto read = read_journal(scratch / "run");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_THAT(faults_of(*read), IsEmpty());
  ASSERT_TRUE(Journal::finish_seal(scratch / "run"));
  EXPECT_THAT(scratch.names(), ::testing::Not(::testing::Contains("run/journal.db-wal")));
  EXPECT_EQ(every_bit(read_journal(scratch / "run")->record), every_bit(run));
}

TEST_F(ClosedJournal, IsNotReopenedByTakingItsSealBehindALog) {
  lay_beside("-wal", log_that_replaces(file, scratch / "other/journal.db"));
  const std::string bytes = *read_file(file);
  EXPECT_FALSE(reopened(scratch / "run"));
  EXPECT_EQ(*read_file(file), bytes);
}

TEST_F(ClosedJournal, IsNoUnbornRunWhateverALogSays) {
  for (const char* name : {"run/SHA256SUMS", "other/SHA256SUMS"}) fs::remove(scratch / name);
  meddle(scratch / "empty.db", "pragma user_version = 0; vacuum");
  lay_beside("-wal", log_that_replaces(file, scratch / "empty.db"));
  const auto unborn = clear_unstarted_run(scratch / "run");
  ASSERT_TRUE(unborn) << unborn.error().what;
  EXPECT_FALSE(*unborn);
  EXPECT_TRUE(fs::exists(file));
}

/// The journal of a run that was interrupted, closed without a seal.
class OpenJournal : public ::testing::Test {
 protected:
  void SetUp() override {
    run.sealed = false;
    run.ending = "stopped";
    ASSERT_TRUE(write_run(scratch / "run", run));
    bytes = *read_file(file);
  }
  [[nodiscard]] std::string refusal_of_reading() const {
    const auto read = read_journal(scratch / "run");
    return read ? std::string("it was read") : read.error().what;
  }
  [[nodiscard]] std::string refusal_of_reopening() const {
    const auto journal = reopened(scratch / "run");
    return journal ? std::string("it was opened") : journal.error().what;
  }

  Scratch scratch;
  RunRecord run = sample_run(13);
  fs::path file = scratch / "run/journal.db";
  std::string bytes;
};

TEST_F(OpenJournal, WithAnythingThatNoJournalHasIsRefusedByName) {
  const std::vector<std::pair<std::string, std::string>> additions = {
      {"create trigger lift after insert on touch begin update touch set tip_x_mm = tip_x_mm * "
       "0.99 "
       "where id = new.id; end",
       "it holds the trigger \"lift\" on table \"touch\", which no journal of version 8 has"},
      {"create view seen as select * from touch", "it holds the view \"seen\""},
      {"create index fast on touch (time_s)", "it holds the index \"fast\" on table \"touch\""},
      {"create table note (id integer primary key)", "it holds the table \"note\""},
      {"create virtual table v using fts5(x)", "it holds the table \"v"},
      {"analyze", "it holds the table \"sqlite_stat"},
      {"alter table touch add column more any", "the columns of its table touch are not those"},
      {"alter table pose add column twice any generated always as (time_s * 2)",
       "the columns of its table pose are not those"},
      {"pragma writable_schema = on; update sqlite_schema set sql = replace(sql, 'ending text not "
       "null default ''''', 'ending text not null default ''finished''') where name = 'header'",
       "the columns of its table header are not those"},
      {"pragma writable_schema = on; update sqlite_schema set sql = replace(sql, 'time_s any not "
       "null', 'time_s any not null check (abs(time_s) >= 0)') where name = 'decision'",
       "the columns of its table decision are not those"},
  };
  for (const auto& [sql, words] : additions) {
    SCOPED_TRACE(sql);
    ASSERT_TRUE(write_file(file, bytes));
    meddle(file, sql);
    EXPECT_THAT(refusal_of_reading(), HasSubstr(words));
    EXPECT_THAT(refusal_of_reopening(), HasSubstr(words));
  }
}

TEST_F(OpenJournal, WithALogThatNamesASuperJournalIsRefused) {
  // SQLite would read the file of that name, and could delete it.
  const fs::path target = scratch / "precious";
  ASSERT_TRUE(write_file(target, "mine"));
  std::string rollback = rollback_to(file);
  const std::string name = target.string();
  unsigned sum = 0;
  for (const char c : name) sum += static_cast<unsigned char>(c);
  const auto add = [&](unsigned number) {
    for (int shift = 24; shift >= 0; shift -= 8) {
      rollback += static_cast<char>((number >> static_cast<unsigned>(shift)) & 0xffU);
    }
  };
  add(262145);  // the page of the lock
  rollback += name;
  add(static_cast<unsigned>(name.size()));
  add(sum);
  rollback += "\xd9\xd5\x05\xf9\x20\xa1\x63\xd7";
  ASSERT_TRUE(write_file(file.string() + "-journal", rollback));
  EXPECT_THAT(refusal_of_reading(), HasSubstr("journal.db-journal names other files"));
  EXPECT_THAT(refusal_of_reopening(), HasSubstr("journal.db-journal names other files"));
  EXPECT_EQ(read_file(target).value_or(""), "mine");
}

TEST_F(OpenJournal, IsNotReopenedThroughALinkOrWhenAListNamesIt) {
  fs::rename(file, scratch / "elsewhere.db");
  fs::create_symlink(scratch / "elsewhere.db", file);
  EXPECT_THAT(refusal_of_reading(), HasSubstr("the journal is a link, not a file of this run"));
  EXPECT_THAT(refusal_of_reopening(), HasSubstr("is a link"));
  fs::remove(file);
  fs::rename(scratch / "elsewhere.db", file);
  ASSERT_TRUE(update_checksums(scratch / "run", {{kJournalName, std::string(64, '0')}}));
  EXPECT_THAT(refusal_of_reopening(), HasSubstr("SHA256SUMS names journal.db"));
  fs::remove(scratch / "run/SHA256SUMS");
  EXPECT_EQ(refusal_of_reopening(), "it was opened");
}

TEST_F(OpenJournal, LinksTheValuesThatWereGiven) {
  // Marks and endings change rows that were written before the interruption.
  auto journal = reopened(scratch / "run");
  ASSERT_TRUE(journal) << journal.error().what;
  for (const PoseVisit& pose : run.poses) ASSERT_TRUE(journal->mark_final(pose.id));
  for (std::int64_t id = 50; id < 60; ++id) ASSERT_TRUE(journal->add(touch_number(id)));
  const core::Error why{core::Code::kNoTouch, "nothing there", "/features/0"};
  ASSERT_TRUE(journal->end("failed", &why));
  const std::vector<StoredResult> results = {{"/a", -0.0}, {"/b", 1e300}};
  ASSERT_TRUE(journal->seal(results));
  const auto read = read_journal(scratch / "run");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_THAT(read->broken, IsEmpty());
  EXPECT_EQ(read->record.failure, why);
}

}  // namespace
}  // namespace rondure::record
