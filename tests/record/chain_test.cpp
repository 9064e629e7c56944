// The hash chain over the rows: what was changed behind the program's back is found and named, also
// in a journal that was never sealed; a run that goes on goes on with the chain.

#include <cstdlib>
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/noise.h"
#include "record/files.h"
#include "record/journal/journal.h"
#include "tests/record/meddle.h"
#include "tests/record/sample_run.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A run that was interrupted: file and log as a killed program leaves them.
class InterruptedRun : public ::testing::Test {
 protected:
  void SetUp() override {
    run = sample_run(5, 40);
    run.sealed = false;
    run.ending.clear();
    run.failure.reset();
    run.results.clear();
    auto journal =
        Journal::create(scratch / "first", run.header, run.artefact, run.features, run.settings);
    ASSERT_TRUE(journal);
    for (PoseVisit& pose : run.poses) {
      pose.final_cloud = pose.id == 2;
      PoseVisit unmarked = pose;
      unmarked.final_cloud = false;
      ASSERT_TRUE(journal->add(unmarked));
    }
    ASSERT_TRUE(journal->mark_final(2));
    for (const Touch& touch : run.touches) ASSERT_TRUE(journal->add(touch));
    for (const Decision& decision : run.decisions) ASSERT_TRUE(journal->add(decision));
    ASSERT_TRUE(journal->add(run.series, run.truth_values));
    fs::create_directory(scratch / "run");
    for (const char* name : {"journal.db", "journal.db-wal"}) {
      fs::copy_file(scratch / "first" / name, scratch / "run" / name);
    }
  }

  /// What is found after `sql`, as "table: what" by line.
  [[nodiscard]] std::string found_after(const std::string& sql) const {
    fs::remove_all(scratch / "meddled");
    fs::copy(scratch / "run", scratch / "meddled");
    meddle(scratch / "meddled/journal.db", sql);
    const auto read = read_journal(scratch / "meddled");
    if (!read) return read.error().what;
    std::string found;
    for (const BrokenTable& broken : read->broken) {
      found += fmt::format("{}{}: {}", found.empty() ? "" : "\n", broken.table, broken.what);
    }
    return found;
  }

  /// The journal is refused or called broken, with words, or gives the first rows of the run, each
  /// with every bit: then true.
  [[nodiscard]] bool expect_a_beginning_or_told(const fs::path& directory) const {
    const auto read = read_journal(directory);
    if (!read || !read->broken.empty()) {
      EXPECT_FALSE((read ? read->broken.front().what : read.error().what).empty());
      return false;
    }
    const RunRecord& found = read->record;
    RunRecord expected = run;
    EXPECT_LE(found.touches.size(), run.touches.size());
    expected.poses.resize(found.poses.size());
    expected.touches.resize(found.touches.size());
    expected.decisions.resize(found.decisions.size());
    if (found.series.empty() && found.truth_values.empty()) {  // one transaction: all or nothing
      expected.series.clear();
      expected.truth_values.clear();
    }
    const bool before_the_mark = found.touches.empty() && found.poses.size() > 2;
    if (before_the_mark) expected.poses[2].final_cloud = found.poses[2].final_cloud;
    EXPECT_EQ(every_bit(found), every_bit(expected));
    return true;
  }

  Scratch scratch;
  RunRecord run;
};

TEST_F(InterruptedRun, IsWhole) {
  const auto read = read_journal(scratch / "run");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_THAT(read->broken, IsEmpty());
  EXPECT_EQ(every_bit(read->record), every_bit(run));
}

TEST_F(InterruptedRun, EveryChangeOfARowIsNamed) {
  const std::vector<std::pair<std::string, std::string>> changes = {
      {"update header set serial = 'another'", "header: the header was changed after"},
      {"update header set ending = 'finished'", "header: the header was changed after"},
      {"update artefact set radius_mm = 12.5", "artefact: the artefact was changed after"},
      {"update feature set layers = layers + 1 where id = 0", "feature: feature 0 was changed"},
      {"update search_step set step_deg = 7.0 where id = 1", "search_step: search_step 1 was"},
      {"update pose set final_cloud = 0 where id = 2", "pose: pose 2 was changed after it was"},
      {"update pose set final_cloud = 1 where id = 1", "pose: pose 1 was changed after it was"},
      {"update touch set time_s = -1.0 where id = 7", "touch: touch 7 was changed after it was"},
      {"update touch set layer = 99 where id > 36",
       "touch: touch 37 was changed after it was written (and 2 more)"},
      {"update decision set arguments = '{\"reason\":\"another\"}' where id = 1",
       "decision: decision 1 was changed after"},
      {"update series_block set rows = replace(rows, '4', '3') where id = 2",
       "series_block: series_block 2 was changed after it was written"},
      {"update series_column set unit = 'mm' where id = 2", "series_column: series_column 2 was"},
      {"update series set name = 'other' where id = 1", "series: series 1 was changed"},
      {"update setting set number = 1.25 where id = 1", "setting: setting 1 was changed"},
      {"update setting set number = 4000 where feature = -1", "setting: setting 5 was changed"},
      {"update harmonic_limit set last_order = 51 where id = 1", "harmonic_limit 1 was changed"},
      {"update truth_value set value = 7.5 where id = 1", "truth_value: truth_value 1 was changed"},
  };
  for (const auto& [sql, words] : changes) {
    SCOPED_TRACE(sql);
    EXPECT_THAT(found_after(sql), HasSubstr(words));
  }
}

TEST_F(InterruptedRun, EveryRemovedOrEditedTouchIsNamed) {
  for (std::size_t id = 0; id < run.touches.size(); ++id) {
    EXPECT_EQ(found_after(fmt::format("delete from touch where id = {}", id)),
              fmt::format("touch: touch {} was removed after it was written", id));
    EXPECT_EQ(found_after(fmt::format("update touch set repeat = repeat + 1 where id = {}", id)),
              fmt::format("touch: touch {} was changed after it was written", id));
  }
}

TEST_F(InterruptedRun, ATouchThatIsRemovedWithItsLinkLeavesAHole) {
  EXPECT_THAT(found_after("delete from touch where id = 20; delete from chain where table_name = "
                          "'touch' and row_id = 20"),
              ::testing::MatchesRegex("chain: link [0-9]+ was removed"));
  // The ids moved together, as somebody would who knows of the links.
  EXPECT_THAT(found_after("delete from touch where id = 20; "
                          "create table t as select * from chain where row_id != 20 or "
                          "table_name != 'touch' order by id; delete from chain; "
                          "insert into chain select rowid - 1, table_name, row_id, row_sha256, "
                          "sha256 from t; drop table t"),
              HasSubstr("chain: link "));
}

TEST_F(InterruptedRun, AnEditedLinkDoesNotFollow) {
  for (const char* sql : {"update chain set row_sha256 = upper(row_sha256) where id = 5",
                          "update chain set sha256 = replace(sha256, substr(sha256, 1, 1), '#') "
                          "where id = 5",
                          "update chain set row_id = row_id + 100 where id = 5",
                          "update chain set table_name = 'truth' where id = 5"}) {
    SCOPED_TRACE(sql);
    EXPECT_THAT(found_after(sql), HasSubstr("does not follow from the links before it"));
  }
  EXPECT_THAT(found_after("update chain set table_name = 'coat' where id = 5"),
              HasSubstr("a link names the unknown table \"coat\""));
  EXPECT_THAT(found_after("delete from chain"), HasSubstr("the header has no link"));
}

TEST_F(InterruptedRun, CutAnywhereKeepsABeginningOrIsTold) {
  std::uint64_t state = 31;
  int kept = 0;
  int told = 0;
  for (int i = 0; i < 100; ++i) {
    fs::remove_all(scratch / "cut");
    fs::copy(scratch / "run", scratch / "cut");
    for (const char* name : {"journal.db", "journal.db-wal"}) {
      const fs::path file = scratch / "cut" / name;
      const bool cut = core::splitmix64(state) % 2 == 0;
      if (cut) fs::resize_file(file, core::splitmix64(state) % fs::file_size(file));
    }
    SCOPED_TRACE(i);
    (expect_a_beginning_or_told(scratch / "cut") ? kept : told) += 1;
  }
  EXPECT_GT(kept, 10);
  EXPECT_GT(told, 10);
}

TEST_F(InterruptedRun, WithFlippedBytesKeepsABeginningOrIsTold) {
  std::uint64_t state = 32;
  for (const std::string name : {"journal.db", "journal.db-wal"}) {
    const std::string bytes = *read_file(scratch / "run" / name);
    for (int i = 0; i < 200; ++i) {
      std::string damaged = bytes;
      const std::size_t at = core::splitmix64(state) % damaged.size();
      damaged[at] = static_cast<char>(damaged[at] ^ (1 + core::splitmix64(state) % 255));
      std::ofstream(scratch / "run" / name, std::ios::binary) << damaged;
      SCOPED_TRACE(name + " byte " + std::to_string(at));
      (void)expect_a_beginning_or_told(scratch / "run");
    }
    std::ofstream(scratch / "run" / name, std::ios::binary) << bytes;
  }
}

TEST_F(InterruptedRun, GoesOnAsIfItHadNotBeenInterrupted) {
  auto journal = reopened(scratch / "run");
  ASSERT_TRUE(journal) << journal.error().what;
  const auto twice = journal->add(run.touches.back());
  ASSERT_FALSE(twice);
  EXPECT_THAT(twice.error().what, HasSubstr("the touches up to number 39 are kept"));
  for (std::int64_t id = 40; id < 60; ++id) {
    run.touches.push_back(touch_number(id));
    ASSERT_TRUE(journal->add(run.touches.back()));
  }
  run.decisions.push_back({-1, 3.5, {core::MessageCode::kSingleSteps, {12.5}}});
  ASSERT_TRUE(journal->add(run.decisions.back()));
  ASSERT_TRUE(journal->end("finished", nullptr));
  ASSERT_TRUE(journal->seal({}));
  run.ending = "finished";
  run.sealed = true;
  const auto read = read_journal(scratch / "run");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_THAT(read->broken, IsEmpty());
  EXPECT_EQ(every_bit(read->record), every_bit(run));
}

TEST_F(InterruptedRun, GoesOnAfterEachOfManyInterruptions) {
  for (std::int64_t id = 40; id < 60; ++id) {
    SCOPED_TRACE(id);
    auto journal = reopened(scratch / "run");
    ASSERT_TRUE(journal) << journal.error().what;
    ASSERT_TRUE(journal->add(touch_number(id)));
    const core::Error reason{core::Code::kStopped, "stopped", ""};
    ASSERT_TRUE(journal->end("stopped", &reason));
  }
  auto journal = reopened(scratch / "run");
  ASSERT_TRUE(journal);
  auto read = read_journal(scratch / "run");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->record.ending, "");
  EXPECT_FALSE(read->record.failure);
  EXPECT_EQ(read->record.touches.size(), 60U);
  EXPECT_THAT(read->broken, IsEmpty());
}

TEST_F(InterruptedRun, DoesNotGoOnWhenItWasChangedOrSealedOrIsHeldOpen) {
  const auto refusal = [&](const fs::path& directory) {
    const auto journal = reopened(directory);
    return journal ? std::string("it was opened") : journal.error().what;
  };
  const Scratch other;
  ASSERT_TRUE(write_run(other / "sealed", sample_run(6)));
  const auto names = other.names();
  const std::string bytes = *read_file(other / "sealed/journal.db");
  EXPECT_THAT(refusal(other / "sealed"), HasSubstr("finished and its journal is sealed"));
  EXPECT_EQ(*read_file(other / "sealed/journal.db"), bytes);
  EXPECT_EQ(other.names(), names);
  fs::copy(scratch / "run", other / "changed");
  meddle(other / "changed/journal.db", "delete from touch where id = 3");
  EXPECT_THAT(refusal(other / "changed"), HasSubstr("touch 3 was removed after it was written"));
  EXPECT_THAT(refusal(other / "absent"), HasSubstr("there is no journal.db"));
  EXPECT_THAT(refusal(other.path()), HasSubstr("there is no journal.db"));

  const auto first = reopened(scratch / "run");
  ASSERT_TRUE(first) << first.error().what;
  EXPECT_THAT(refusal(scratch / "run"), HasSubstr("is in use by process "));
}

TEST(Chain, OfASealedRunCannotBeCutAtItsEnd) {
  const Scratch scratch;
  ASSERT_TRUE(write_run(scratch / "run", sample_run(8)));
  meddle(scratch / "run/journal.db", "delete from chain where id = (select max(id) from chain)");
  const auto read = read_journal(scratch / "run");
  ASSERT_TRUE(read);
  ASSERT_EQ(read->broken.size(), 2U);
  EXPECT_EQ(read->broken[0].table, "result");
  EXPECT_EQ(read->broken[1].table, "chain");
  EXPECT_THAT(read->broken[1].what, HasSubstr(" rows, expected "));
}

/// Runs the checker of docs/developer/journal.md; its exit status.
int checked_by_the_document(const fs::path& journal) {
  const auto document = read_file(fs::path(RONDURE_SOURCE_DIR) / "docs/developer/journal.md");
  const std::size_t begin = document->find("```python\n") + 10;
  const Scratch scratch;
  std::ofstream(scratch / "check.py")
      << document->substr(begin, document->find("```", begin) - begin);
  const std::string command =
      fmt::format("/usr/bin/python3 '{}' '{}' > '{}' 2>&1", (scratch / "check.py").string(),
                  journal.string(), (scratch / "out").string());
  return std::system(command.c_str());
}

TEST(Chain, IsTheOneThatTheDocumentDescribes) {
  const Scratch scratch;
  ASSERT_TRUE(write_run(scratch / "run", sample_run(9)));
  const fs::path file = scratch / "run/journal.db";
  EXPECT_EQ(checked_by_the_document(file), 0);
  const std::string bytes = *read_file(file);
  for (const char* sql : {"update touch set repeat = repeat + 1 where id = 3",
                          "update chain set sha256 = '' where id = 3", "delete from chain",
                          "update seal set sha256 = ''"}) {
    SCOPED_TRACE(sql);
    std::ofstream(file, std::ios::binary) << bytes;
    meddle(file, sql);
    EXPECT_NE(checked_by_the_document(file), 0);
  }
}

}  // namespace
}  // namespace rondure::record
