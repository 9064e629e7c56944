// A damaged or foreign journal is named as such: no crash, no hang, no silent change.

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
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class JournalDamage : public ::testing::Test {
 protected:
  void SetUp() override {
    run = sample_run(3, 200);
    run.failure.reset();
    ASSERT_TRUE(write_run(scratch / "run", run));
    bytes = *read_file(scratch / "run/journal.db");
  }
  void put(const std::string& damaged) const {
    std::ofstream(scratch / "run/journal.db", std::ios::binary | std::ios::trunc) << damaged;
  }
  /// Damage is told, or it did not touch anything that is read.
  void expect_told_or_intact() const {
    const auto read = read_journal(scratch / "run");
    if (!read) {
      EXPECT_THAT(read.error().code, AnyOf(core::Code::kJournal, core::Code::kFile));
      EXPECT_EQ(read.error().where, (scratch / "run/journal.db").string());
      EXPECT_FALSE(read.error().what.empty());
    } else if (read->broken.empty()) {
      EXPECT_EQ(every_bit(read->record), every_bit(run));
    }
  }

  Scratch scratch;
  RunRecord run;
  std::string bytes;
};

TEST_F(JournalDamage, OfEachTableIsFoundByItsDigest) {
  const std::vector<std::pair<std::string, std::string>> changes = {
      {"header", "update header set operator_name = 'somebody else'"},
      {"header", "update header set temperature_max_degC = 99.0"},
      {"artefact", "update artefact set radius_mm = 12.5"},
      {"feature", "update feature set nominal_diameter_mm = 25.000000000000004 where id = 0"},
      {"search_step", "update search_step set step_deg = 0.30000000000000004 where id = 1"},
      {"characteristic", "update characteristic set tolerance_mm = 0.011 where id = 1"},
      {"characteristic", "update characteristic set lower_mm = 0.011 where id = 1"},
      {"characteristic_setting", "update characteristic_setting set text = 'GX' where id = 2"},
      {"pose", "update pose set final_cloud = 1 - final_cloud where id = 2"},
      {"touch", "update touch set tip_z_mm = 1.0000000000000002 where id = 17"},
      {"decision", "update decision set arguments = '{\"reason\":\".\"}' where id = 2"},
      {"result", "update result set value = 7.42 where id = 0"},
      {"touch",
       "update seal set sha256 = '0' || substr(sha256, 2) || 'x' where table_name = 'touch'"},
  };
  for (const auto& [table, sql] : changes) {
    SCOPED_TRACE(sql);
    put(bytes);
    meddle(scratch / "run/journal.db", sql);
    const auto read = read_journal(scratch / "run");
    ASSERT_TRUE(read) << read.error().what;
    ASSERT_EQ(read->broken.size(), 1U);
    EXPECT_EQ(read->broken[0].table, table);
    EXPECT_THAT(read->broken[0].what, StartsWith("a value differs from the sealed one"));
  }
}

TEST_F(JournalDamage, MissingAndAddedRowsAreCounted) {
  meddle(scratch / "run/journal.db", "delete from touch where id = 7");
  auto read = read_journal(scratch / "run");
  ASSERT_TRUE(read);
  ASSERT_EQ(read->broken.size(), 1U);
  EXPECT_EQ(read->broken[0].table, "touch");
  EXPECT_EQ(read->broken[0].what,
            "199 rows, expected 200: touch 7 was removed after it was written");

  put(bytes);
  meddle(scratch / "run/journal.db", "delete from seal where table_name = 'pose'");
  read = read_journal(scratch / "run");
  ASSERT_TRUE(read);
  ASSERT_EQ(read->broken.size(), 1U);
  EXPECT_EQ(read->broken[0].table, "pose");
  EXPECT_EQ(read->broken[0].what, "its digest is missing in the seal");
}

TEST_F(JournalDamage, ContradictionsAreNamed) {
  const std::vector<std::pair<std::string, std::string>> changes = {
      {"update pose set feature = 12 where id = 0", "table pose names feature 12"},
      {"update touch set purpose = 'probing'", "touch.purpose holds the unknown word \"probing\""},
      {"update feature set shape = 'cube'", "feature.shape holds the unknown word \"cube\""},
      {"update feature set side = 'above'", "feature.side holds the unknown word \"above\""},
      {"update feature set strategy = 'guide'",
       "feature.strategy holds the unknown word \"guide\""},
      {"update characteristic set form = 'round'",
       "characteristic.form holds the unknown word \"round\""},
      {"update characteristic set reference = 'mx'",
       "characteristic.reference holds the unknown word \"mx\""},
      {"update header set seed = '-1'", "header.seed"},
      {"update header set failure_code = 'tired'", "header.failure_code"},
      {"update touch set tip_x_mm = 1e155 where id = 17",
       "touch.tip_x_mm holds 1e+155, beyond the limit"},
      {"update pose set time_s = 9e999 where id = 0", "pose holds inf, beyond the limit"},
      {"update feature set nominal_diameter_mm = -1e10",
       "feature.nominal_diameter_mm holds -1e+10"},
      {"update header set temperature_max_degC = 1e100", "header.temperature_degC holds 1e+100"},
      {"update artefact set radius_mm = 1e100", "artefact holds 1e+100"},
      {"update decision set time_s = 1e100", "decision.time_s holds 1e+100"},
      {"delete from header", "table header is empty"},
      {"delete from artefact", "table artefact is empty"},
      {"drop table touch", "no table touch"},
      {"alter table touch add column z text", "columns of its table touch"},
      {"alter table touch rename to t; create view touch as select * from t", "no table touch"},
      {"update characteristic set lower_mm = 1e100 where id = 1",
       "characteristic.lower_mm holds 1e+100"},
      {"update characteristic_setting set text = 'XX' where name = 'size'", "setting \"size\""},
      {"update characteristic_setting set characteristic = 99", "names characteristic 99"},
      {"update decision set code = 'part-lost' where id = 1", "decision holds \"part-lost\""},
      {"delete from series_block where id = 1", "goes on with row 256, row 0 is expected"},
      {"delete from series_block where id = 2", "has 256 rows, 300 are stated"},
      {"update series_block set rows = rows || '1' where id = 1", "has 513 numbers, 256 rows of 2"},
      {"update series_block set rows = replace(rows, ',', ';') where id = 1", "no number up to"},
      {"update series_block set series = 9", "table series_block names series 9"},
      {"update series set feature = 77", "table series names feature 77"},
      {"update series set role = 'guess'", "series.role holds the unknown word \"guess\""},
      {"update harmonic_limit set characteristic = 99", "harmonic_limit names characteristic 99"},
      {"update truth_value set feature = -1", "table truth_value names feature -1"},
      {"update setting set feature = -2 where id = 1", "table setting names feature -2"},
      {"pragma user_version = 9",
       "its tables have version 9, this program reads version 8 alone, signed or not; read it with "
       "the program that wrote it"},
      {"pragma user_version = 0", "version 0, this program reads version 8 alone"},
      {"pragma user_version = 7",
       "its tables have version 7, this program reads version 8 alone, signed or not; Rondure "
       "0.1.0 "
       "reads versions 1 to 4, commit eac6925f of Rondure 0.2.0 versions 1 to 7"},
      {"pragma user_version = 1; drop table chain", "version 1, this program reads version 8"},
      {"drop table chain", "no table chain"},
      {"pragma application_id = 5", "no journal of Rondure"},
  };
  for (const auto& [sql, words] : changes) {
    SCOPED_TRACE(sql);
    put(bytes);
    meddle(scratch / "run/journal.db", sql);
    const auto read = read_journal(scratch / "run");
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, core::Code::kJournal);
    EXPECT_THAT(read.error().what, HasSubstr(words));
  }
}

TEST_F(JournalDamage, ByTruncationIsTold) {
  std::uint64_t state = 5;
  for (int i = 0; i < 100; ++i) {
    const std::size_t size = core::splitmix64(state) % bytes.size();
    SCOPED_TRACE(size);
    put(bytes.substr(0, size));
    const auto read = read_journal(scratch / "run");
    if (read) {  // less than a page is missing: SQLite takes zeros for it, and the chain does not
      EXPECT_LT(bytes.size() - size, 4096U);
      EXPECT_FALSE(read->broken.empty());
      continue;
    }
    EXPECT_EQ(read.error().code, core::Code::kJournal);
    EXPECT_THAT(read.error().what, AnyOf(HasSubstr("bytes, the last"), HasSubstr("no journal of"),
                                         HasSubstr("not a database")));
  }
}

TEST_F(JournalDamage, NamesTheTablesThatAreNotWhole) {
  // Pages of a large journal from the middle on hold touches and links.
  run = sample_run(4, 400);
  ASSERT_TRUE(write_run(scratch / "large", run));
  const fs::path file = scratch / "large/journal.db";
  const std::uintmax_t length = fs::file_size(file);
  fs::resize_file(file, length / 4096 / 2 * 4096);
  const auto cut = read_journal(scratch / "large");
  ASSERT_FALSE(cut);
  EXPECT_THAT(cut.error().what,
              AllOf(HasSubstr(fmt::format("the file ends after {} of {} bytes, the last {} are "
                                          "missing; ",
                                          length / 4096 / 2 * 4096, length,
                                          length - length / 4096 / 2 * 4096)),
                    HasSubstr("touch: "), HasSubstr(" of 400 rows can be read"),
                    HasSubstr("; copy the run directory again from where it was measured")));
}

TEST_F(JournalDamage, OfBitsOfTheHeadAndOfBlocksIsToldOrHarmless) {
  std::uint64_t state = 6;
  const auto expect_after = [&](std::size_t at, const std::string& changed) {
    SCOPED_TRACE(fmt::format("{} bytes at {}", changed.size(), at));
    std::string damaged = bytes;
    put(damaged.replace(at, std::min(changed.size(), bytes.size() - at), changed));
    expect_told_or_intact();
  };
  const auto flipped = [&](std::size_t at, int bits) {
    return std::string(1, static_cast<char>(bytes[at] ^ static_cast<char>(bits)));
  };
  for (int i = 0; i < 300; ++i) {
    const std::size_t at = core::splitmix64(state) % bytes.size();
    expect_after(at, flipped(at, 1 << (i % 8)));
  }
  for (std::size_t at = 0; at < 200; ++at) expect_after(at, flipped(at, 0x55));
  for (int i = 0; i < 100; ++i) {
    std::string block(300, '\0');
    for (char& byte : block) byte = static_cast<char>(core::splitmix64(state));
    expect_after(core::splitmix64(state) % bytes.size(), block);
  }
}

TEST_F(JournalDamage, ForeignFilesAreNamed) {
  const auto expect = [&](core::Code code, const std::string& words) {
    const auto read = read_journal(scratch / "run");
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, code);
    EXPECT_THAT(read.error().what, HasSubstr(words));
    EXPECT_EQ(read.error().where, (scratch / "run/journal.db").string());
  };
  put("");
  expect(core::Code::kJournal, "it is empty");
  put(std::string(5000, 'x') + "\n");
  expect(core::Code::kJournal, "file is not a database");
  fs::remove(scratch / "run/journal.db");
  expect(core::Code::kFile, "there is no journal.db in " + (scratch / "run").string());
  meddle(scratch / "run/journal.db", "create table touch (id integer primary key)");
  expect(core::Code::kJournal, "it is no journal of Rondure");
  fs::remove(scratch / "run/journal.db");
  fs::create_directory(scratch / "run/journal.db");
  expect(core::Code::kFile, "the journal is not a file");
}

TEST_F(JournalDamage, AJournalThatWasLostBesideItsDigestIsMissed) {
  ASSERT_TRUE(write_file(scratch / "run/SHA256SUMS", ""));
  fs::remove(scratch / "run/journal.db");
  const auto read = read_journal(scratch / "run");
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().what, AllOf(HasSubstr("but a SHA256SUMS: the journal of a run was lost"),
                                       HasSubstr("from a backup")));
}

TEST_F(JournalDamage, OfTheLogCostsTheTouchesBehindItAndNothingElse) {
  auto journal =
      Journal::create(scratch / "open", run.header, run.artefact, run.features, run.settings);
  ASSERT_TRUE(journal);
  for (std::int64_t id = 0; id < 50; ++id) ASSERT_TRUE(journal->add(touch_number(id)));
  const std::string log = *read_file(scratch / "open/journal.db-wal");
  fs::create_directory(scratch / "copy");
  fs::copy_file(scratch / "open/journal.db", scratch / "copy/journal.db");
  std::uint64_t state = 8;
  for (int i = 0; i < 50; ++i) {
    std::string damaged = log;
    damaged[core::splitmix64(state) % log.size()] ^= 0x10;
    std::ofstream(scratch / "copy/journal.db-wal", std::ios::binary | std::ios::trunc) << damaged;
    const auto read = read_journal(scratch / "copy");
    ASSERT_TRUE(read) << read.error().what;
    for (std::size_t k = 0; k < read->record.touches.size(); ++k) {
      EXPECT_EQ(read->record.touches[k].tip_mm, touch_number(static_cast<std::int64_t>(k)).tip_mm);
    }
  }
}

}  // namespace
}  // namespace rondure::record
