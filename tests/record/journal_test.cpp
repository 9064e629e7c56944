#include "record/journal/journal.h"

#include <fstream>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "record/files.h"
#include "record/journal/internal/schema.h"
#include "record/sha256.h"
#include "tests/record/sample_run.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A journal with nothing but a head.
Journal open_journal(const fs::path& directory) {
  const RunRecord run = sample_run(1);
  auto journal = Journal::create(directory, run.header, run.artefact, run.features, run.settings);
  EXPECT_TRUE(journal) << journal.error().what;
  return *std::move(journal);
}

TEST(Journal, GivesBackEveryBitOfARunSealedOrNot) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    const Scratch scratch;
    RunRecord run = sample_run(seed);
    run.sealed = seed % 4 != 3;
    if (!run.sealed) run.results.clear();
    const auto written = write_run(scratch / "run", run);
    ASSERT_TRUE(written) << written.error().what;
    const auto read = read_journal(scratch / "run");
    ASSERT_TRUE(read) << read.error().what;
    EXPECT_THAT(read->broken, IsEmpty());
    EXPECT_EQ(every_bit(read->record), every_bit(run));
    const int owner = run.series.front().feature;
    ASSERT_NE(read->record.data_of(owner, "data"), nullptr);
    EXPECT_EQ(read->record.data_of(owner, "data")->rows(), 300U);
    EXPECT_EQ(read->record.data_of(owner, "profile"), nullptr) << "that is a truth";
    EXPECT_NE(read->record.truth_series_of(owner, "profile"), nullptr);
  }
}

TEST(Journal, TheSealedJournalIsOneFileWithItsDigestBeside) {
  const Scratch scratch;
  {
    auto journal = open_journal(scratch / "run");
    ASSERT_TRUE(journal.seal({}));
  }
  EXPECT_THAT(scratch.names(), ElementsAre("run", "run/SHA256SUMS", "run/journal.db"));
  EXPECT_EQ(*read_file(scratch / "run/SHA256SUMS"),
            sha256_hex(*read_file(scratch / "run/journal.db")) + "  journal.db\n");
}

TEST(Journal, ReadingChangesNothingOnDisk) {
  for (const bool sealed : {true, false}) {
    const Scratch scratch;
    auto journal = open_journal(scratch / "run");
    ASSERT_TRUE(journal.add(touch_number(0)));
    if (sealed) {
      ASSERT_TRUE(journal.seal({}));
    }
    const auto names = scratch.names();
    const auto bytes = read_file(scratch / "run/journal.db");
    const auto time = fs::last_write_time(scratch / "run");
    ASSERT_TRUE(read_journal(scratch / "run"));
    EXPECT_EQ(scratch.names(), names);
    EXPECT_EQ(read_file(scratch / "run/journal.db"), bytes);
    EXPECT_EQ(fs::last_write_time(scratch / "run"), time);
  }
}

TEST(Journal, CanBeReadWhileTheRunGoesOn) {
  const Scratch scratch;
  auto journal = open_journal(scratch / "run");
  for (std::int64_t id = 0; id < 5; ++id) {
    ASSERT_TRUE(journal.add(touch_number(id)));
    const auto read = read_journal(scratch / "run");
    ASSERT_TRUE(read) << read.error().what;
    EXPECT_EQ(read->record.touches.size(), static_cast<std::size_t>(id + 1));
  }
}

TEST(Journal, TwoRunsInTwoDirectoriesDoNotMix) {
  const Scratch scratch;
  auto first = open_journal(scratch / "1");
  auto second = open_journal(scratch / "2");
  ASSERT_TRUE(first.add(touch_number(1)));
  ASSERT_TRUE(second.add(touch_number(2)));
  first = std::move(second);  // closes the first
  ASSERT_TRUE(first.add(touch_number(3)));
  EXPECT_EQ(read_journal(scratch / "1")->record.touches.size(), 1U);
  EXPECT_EQ(read_journal(scratch / "2")->record.touches.size(), 2U);
}

TEST(Journal, TakesAnEmptyDirectoryAndMakesParentDirectories) {
  const Scratch scratch;
  EXPECT_TRUE(Journal::create(scratch.path(), {}, {}, {}));
  const Scratch other;
  EXPECT_TRUE(Journal::create(other / "a/b 'c'/d/", {}, {}, {}));
  EXPECT_TRUE(read_journal(other / "a/b 'c'/d"));
}

TEST(Journal, LeavesNothingBehindWhenItCannotBeMade) {
  const Scratch scratch;
  std::ofstream(scratch / "file") << "x";
  RunRecord bad = sample_run(1);
  bad.artefact.radius_mm = std::numeric_limits<double>::quiet_NaN();
  const auto before = scratch.names();
  const auto not_a_number =
      Journal::create(scratch / "a/b", bad.header, bad.artefact, bad.features);
  ASSERT_FALSE(not_a_number);
  EXPECT_EQ(not_a_number.error().code, core::Code::kJournal);
  EXPECT_THAT(not_a_number.error().what, HasSubstr("artefact.radius_mm is not a number"));
  bad.artefact.radius_mm = 12.5;
  bad.features[0].characteristics[0].tolerance_mm = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(Journal::create(scratch / "a/b", bad.header, bad.artefact, bad.features));
  EXPECT_EQ(scratch.names(), before);

  const std::vector<std::string> names = {"file", "file/run", "with \" quote",
                                          "long/" + std::string(300, 'n')};
  for (const std::string& name : names) {
    SCOPED_TRACE(name);
    const auto refused = Journal::create(scratch / name, {}, {}, {});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, core::Code::kFile) << refused.error().what;
    EXPECT_THAT(refused.error().what, HasSubstr(scratch.path().string()));
    EXPECT_EQ(scratch.names(), before);
  }
}

TEST(Journal, TakesNoTouchThatItWouldNotReadAgain) {
  const Scratch scratch;
  auto journal = open_journal(scratch / "run");
  Touch touch = touch_number(1);
  touch.tip_mm.y() = 1e155;
  const auto added = journal.add(touch);
  ASSERT_FALSE(added);
  EXPECT_THAT(added.error().what,
              HasSubstr("touch.tip_y_mm holds 1e+155, beyond the limit of 1e+09"));
  EXPECT_TRUE(journal.add(touch_number(1)));
}

TEST(Journal, RefusesAPlaceWhereNothingCanBeMade) {
  // The superuser may write in any directory: below a device nobody can.
  const auto refused = Journal::create("/dev/null/run", {}, {}, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Code::kFile);
  EXPECT_THAT(refused.error().what, HasSubstr("/dev/null/run cannot be made: a part of its path"));
}

TEST(Journal, RefusesATouchTwiceAndGoesOn) {
  const Scratch scratch;
  auto journal = open_journal(scratch / "run");
  ASSERT_TRUE(journal.add(touch_number(41)));
  const auto refused = journal.add(touch_number(41));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Code::kJournal);
  EXPECT_EQ(refused.error().what,
            "touch 41 cannot be written to " + (scratch / "run/journal.db").string() +
                ": this touch.id is in the journal already; the touches up to "
                "number 41 are kept");
  EXPECT_TRUE(journal.add(touch_number(42)));
}

TEST(Journal, ManyTouchesAreKeptTogetherOrNotAtAll) {
  const Scratch scratch;
  auto journal = open_journal(scratch / "run");
  std::vector<Touch> touches = {touch_number(0), touch_number(1), touch_number(2)};
  touches[2].tip_mm.y() = std::numeric_limits<double>::quiet_NaN();
  const auto refused = journal.add(touches);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("touches 0 to 2 cannot be written"));
  EXPECT_THAT(refused.error().what, EndsWith("touch.tip_y_mm is not a number (NaN)"));
  EXPECT_TRUE(read_journal(scratch / "run")->record.touches.empty());
  touches.pop_back();
  EXPECT_TRUE(journal.add(touches));
  EXPECT_EQ(read_journal(scratch / "run")->record.touches.size(), 2U);
}

TEST(Journal, SeriesThatAreNoneAreRefusedWhole) {
  const Scratch scratch;
  auto journal = open_journal(scratch / "run");
  const Series good{0, "data", Series::Role::kData, {{"a_um", "um"}, {"b_um", "um"}}, {1.0, 2.0}};
  Series bad = good;
  bad.values = {1.0, 2.0, 3.0, std::numeric_limits<double>::quiet_NaN()};
  const auto refused = journal.add(std::vector<Series>{good, bad}, {});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what,
              HasSubstr("b_um of series data is not a finite number up to 1e9 in row 1"));
  bad.values = {1.0, 2.0, 3.0};
  EXPECT_FALSE(journal.add(std::vector<Series>{bad}, {}));
  ASSERT_TRUE(journal.add(std::vector<Series>{good}, {}));
  const auto read = read_journal(scratch / "run");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->record.series.size(), 1U) << "the refused ones left nothing";
  EXPECT_THAT(read->broken, IsEmpty());
}

TEST(Journal, MarksOnlyAPoseThatExists) {
  const Scratch scratch;
  auto journal = open_journal(scratch / "run");
  const auto refused = journal.mark_final(7);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("final pose 7"));
  EXPECT_THAT(refused.error().what, HasSubstr("there is no such pose"));
}

TEST(Journal, EndsOnceAndTakesNothingAfterTheSeal) {
  const Scratch scratch;
  auto journal = open_journal(scratch / "run");
  ASSERT_TRUE(journal.end("finished", nullptr));
  const auto again = journal.end("stopped", nullptr);
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, core::Code::kJournal);
  ASSERT_TRUE(journal.seal({}));
  for (const auto& late :
       {journal.add(touch_number(1)), journal.add(PoseVisit{}), journal.add(Decision{}),
        journal.mark_final(0), journal.end("", nullptr), journal.seal({})}) {
    ASSERT_FALSE(late);
    EXPECT_EQ(late.error().code, core::Code::kJournal);
  }
  const auto read = read_journal(scratch / "run");
  EXPECT_EQ(read->record.ending, "finished");
  EXPECT_THAT(read->broken, IsEmpty());
}

TEST(Journal, ReadsAJournalInAPlaceWithoutWriting) {
  const Scratch scratch;
  {
    auto journal = open_journal(scratch / "run");
    ASSERT_TRUE(journal.add(touch_number(0)));
    // As a killed run leaves it: file and log, no owner.
    fs::create_directory(scratch / "killed");
    for (const char* name : {"journal.db", "journal.db-wal"}) {
      fs::copy_file(scratch / "run" / name, scratch / "killed" / name);
      fs::permissions(scratch / "killed" / name, fs::perms::owner_read);
    }
  }
  fs::permissions(scratch / "killed", fs::perms::owner_read | fs::perms::owner_exec);
  const auto read = read_journal(scratch / "killed");
  fs::permissions(scratch / "killed", fs::perms::owner_all);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->record.touches.size(), 1U);
  EXPECT_THAT(scratch.names(), ElementsAre("killed", "killed/journal.db", "killed/journal.db-wal",
                                           "run", "run/journal.db"));
}

TEST(Journal, TheDocumentShowsTheTablesAsTheyAre) {
  const auto document = read_file(fs::path(RONDURE_SOURCE_DIR) / "docs/developer/journal.md");
  ASSERT_TRUE(document) << document.error().what;
  EXPECT_EQ(all_tables().size(), 18U);
  for (const Table& table : all_tables()) EXPECT_THAT(*document, HasSubstr(table.sql));
  std::size_t shown = 0;  // no other table among them
  for (std::size_t at = document->find("\ncreate table"); at != std::string::npos;
       at = document->find("\ncreate table", at + 1)) {
    ++shown;
  }
  EXPECT_EQ(shown, all_tables().size());
}

}  // namespace
}  // namespace rondure::record
