// Series, settings and masks in the journal.
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "record/journal/journal.h"
#include "record/tasks/settings.h"
#include "tests/record/meddle.h"
#include "tests/record/sample_run.h"

namespace rondure::record {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
namespace fs = std::filesystem;

TEST(JournalSeries, ComeBackWithTheSameBits) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    SCOPED_TRACE(seed);
    const Scratch scratch;
    const RunRecord run = sample_run(seed, 2);
    ASSERT_TRUE(write_run(scratch / "run", run));
    const auto read = read_journal(scratch / "run");
    ASSERT_TRUE(read) << read.error().what;
    EXPECT_EQ(every_bit(read->record), every_bit(run));
    EXPECT_THAT(read->broken, IsEmpty());
    const int owner = run.series.front().feature;
    ASSERT_NE(read->record.data_of(owner, "data"), nullptr);
    EXPECT_EQ(read->record.data_of(owner, "data")->rows(), 300U);
    EXPECT_EQ(read->record.data_of(owner, "profile"), nullptr) << "that is a truth";
    EXPECT_NE(read->record.truth_series_of(owner, "profile"), nullptr);
  }
}

TEST(JournalSeries, ChangedRowsAreTold) {
  struct Case {
    const char* sql;
    const char* told;
  };
  for (const Case& c :
       {Case{"update series_block set rows = replace(rows, '4', '3') where id = 2",
             "series_block 2 was changed after it was written"},
        Case{"update series_column set unit = 'mm' where id = 2", "series_column 2 was changed"},
        Case{"update series set name = 'other' where id = 1", "series 1 was changed"},
        Case{"update setting set number = 1.25 where id = 1", "setting 1 was changed"},
        Case{"update harmonic_limit set last_order = 51 where id = 1", "harmonic_limit 1 was"},
        Case{"update truth_value set value = 7.5 where id = 1", "truth_value 1 was changed"}}) {
    SCOPED_TRACE(c.sql);
    const Scratch scratch;
    RunRecord run = sample_run(3, 2);
    run.sealed = false;
    ASSERT_TRUE(write_run(scratch / "run", run));
    meddle(scratch / "run/journal.db", c.sql);
    const auto read = read_journal(scratch / "run");
    ASSERT_TRUE(read) << read.error().what;
    ASSERT_EQ(read->broken.size(), 1U);
    EXPECT_THAT(read->broken[0].what, HasSubstr(c.told));
  }
}

TEST(JournalSeries, ThatContradictThemselvesCannotBeRead) {
  for (const char* sql :
       {"delete from series_block where id = 1", "delete from series_block where id = 2",
        "update series_block set rows = rows || '1' where id = 1",
        "update series_block set rows = replace(rows, ',', ';') where id = 1",
        "update series set feature = 77", "update series set role = 'guess'",
        "update harmonic_limit set characteristic = 99", "update series_block set series = 9",
        "update truth_value set feature = -1"}) {
    SCOPED_TRACE(sql);
    const Scratch scratch;
    ASSERT_TRUE(write_run(scratch / "run", sample_run(4, 2)));
    meddle(scratch / "run/journal.db", sql);
    const auto read = read_journal(scratch / "run");
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, core::Code::kJournal);
  }
}

TEST(JournalSeries, ThatAreNoneAreRefusedWhole) {
  const Scratch scratch;
  const RunRecord run = sample_run(5, 2);
  auto journal =
      Journal::create(scratch / "run", run.header, run.artefact, run.features, run.settings);
  ASSERT_TRUE(journal);
  Series good{0, "data", Series::Role::kData, {{"a_um", "um"}, {"b_um", "um"}}, {1.0, 2.0}};
  Series bad = good;
  bad.values = {1.0, 2.0, 3.0, std::numeric_limits<double>::quiet_NaN()};
  const std::vector<Series> pair = {good, bad};
  const auto refused = journal->add(pair, {});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what,
              HasSubstr("b_um of series data is not a finite number up to 1e9 in row 1"));
  bad.values = {1.0, 2.0, 3.0};
  EXPECT_FALSE(journal->add(std::vector<Series>{bad}, {}));
  ASSERT_TRUE(journal->add(std::vector<Series>{good}, {}));
  ASSERT_TRUE(journal->end("finished", nullptr));
  ASSERT_TRUE(journal->seal({}));
  const auto read = read_journal(scratch / "run");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->record.series.size(), 1U) << "the refused ones left nothing";
  EXPECT_THAT(read->broken, IsEmpty());
}

TEST(JournalSeries, AreAbsentInVersion2WhichIsStillReadAndChecked) {
  const auto read = read_journal(fs::path(RONDURE_SOURCE_DIR) / "tests/data/journal_v2");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->version, 2);
  EXPECT_TRUE(read->record.sealed);
  EXPECT_THAT(read->broken, IsEmpty());
  EXPECT_EQ(read->record.touches.size(), 24U);
  EXPECT_THAT(read->record.series, IsEmpty());
  const Scratch scratch;
  fs::copy_file(fs::path(RONDURE_SOURCE_DIR) / "tests/data/journal_v2/journal.db",
                scratch / "journal.db");
  meddle(scratch / "journal.db", "update touch set tip_x_mm = 1.0 where id = 3");
  const auto changed = read_journal(scratch.path());
  ASSERT_TRUE(changed);
  ASSERT_EQ(changed->broken.size(), 1U);
  EXPECT_THAT(changed->broken[0].what, HasSubstr("touch 3 was changed after it was written"));
}

TEST(JournalSettings, OfTheWholeRunStandBesideThoseOfItsFeatures) {
  const Scratch scratch;
  RunRecord run;
  run.features.resize(2);
  run.features[1].settings = {{"trials", 7.0, ""}};
  run.settings = {{"trials", 400.0, ""}, {"rule", std::nullopt, "jcgm-106"}, {"trials", 2.0, ""}};
  run.ending = "finished";
  ASSERT_TRUE(write_run(scratch / "run", run));
  const auto read = read_journal(scratch / "run");
  ASSERT_TRUE(read) << read.error().what;
  ASSERT_EQ(read->record.settings.size(), 3U);
  EXPECT_EQ(read->record.settings[0].number, 400.0);
  EXPECT_EQ(read->record.settings[1].text, "jcgm-106");
  EXPECT_EQ(read->record.settings[1].number, std::nullopt);
  EXPECT_EQ(read->record.settings[2].number, 2.0);
  EXPECT_THAT(read->record.features[0].settings, IsEmpty());
  ASSERT_EQ(read->record.features[1].settings.size(), 1U);
  EXPECT_EQ(read->record.features[1].settings[0].number, 7.0);
  meddle(scratch / "run/journal.db", "update setting set number = 4000 where feature = -1");
  const auto changed = read_journal(scratch / "run");
  ASSERT_TRUE(changed);
  ASSERT_EQ(changed->broken.size(), 1U);
  EXPECT_THAT(changed->broken[0].what, HasSubstr("was changed after it was written"));
}

TEST(JournalSettings, OfTheWholeRunAreAbsentInVersion3WhichIsStillReadAndChecked) {
  const fs::path stored = fs::path(RONDURE_SOURCE_DIR) / "tests/data/journal_v3";
  const auto read = read_journal(stored);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->version, 3);
  EXPECT_TRUE(read->record.sealed);
  EXPECT_THAT(read->broken, IsEmpty());
  EXPECT_THAT(read->record.settings, IsEmpty());
  ASSERT_EQ(read->record.features.size(), 1U);
  EXPECT_EQ(read->record.features[0].settings.size(), 22U);
  const Scratch scratch;
  fs::copy_file(stored / "journal.db", scratch / "journal.db");
  meddle(scratch / "journal.db", "update setting set feature = -1 where id = 3");
  const auto changed = read_journal(scratch.path());
  ASSERT_FALSE(changed);
  EXPECT_THAT(changed.error().what, HasSubstr("table setting names feature -1"));
}

TEST(JournalTouches, AllHaveATemperatureInVersion4WhichIsStillReadAndChecked) {
  const auto read = read_journal(fs::path(RONDURE_SOURCE_DIR) / "tests/data/journal_v4");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->version, 4);
  EXPECT_TRUE(read->record.sealed);
  EXPECT_THAT(read->broken, IsEmpty());
  ASSERT_FALSE(read->record.touches.empty());
  for (const Touch& touch : read->record.touches) {
    EXPECT_EQ(touch.temperature_degC, 20.0);
    EXPECT_EQ(touch.scale_temperature_degC, 20.0);
  }
}

TEST(JournalCharacteristics, OfVersion6HaveTheirToleranceAsUpperLimitAndIndicateNothingElse) {
  const auto read =
      read_journal(fs::path(RONDURE_SOURCE_DIR) / "tests/data/journal_v6_interrupted");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->version, 6);
  EXPECT_THAT(read->broken, IsEmpty());
  const auto& asked = read->record.features.front().characteristics;
  ASSERT_EQ(asked.size(), 2U);
  EXPECT_EQ(asked[0].tolerance_mm, 0.012);
  EXPECT_FALSE(asked[1].toleranced());
  for (const Characteristic& characteristic : asked) {
    EXPECT_FALSE(characteristic.lower_mm);
    const Indication& indication = characteristic.indication;
    EXPECT_EQ(settings_of_task(indication).size(), settings_of_task(Indication()).size());
    EXPECT_EQ(indication.section, Indication::Section::kAll);
    EXPECT_FALSE(indication.filter);
  }
}

TEST(JournalTouches, KeepThatNobodyMeasuredATemperature) {
  const Scratch scratch;
  RunRecord run = sample_run(3, 3);
  run.touches[0].temperature_degC.reset();
  run.touches[1].temperature_degC = 20.5;
  run.touches[1].scale_temperature_degC.reset();
  ASSERT_TRUE(write_run(scratch / "run", run));
  const auto read = read_journal(scratch / "run");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_THAT(read->broken, IsEmpty());
  EXPECT_FALSE(read->record.touches[0].temperature_degC);
  EXPECT_EQ(read->record.touches[1].temperature_degC, 20.5);
  EXPECT_FALSE(read->record.touches[1].scale_temperature_degC);
}

}  // namespace
}  // namespace rondure::record
