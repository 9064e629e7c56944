#include <sqlite3.h>

#include <array>
#include <cstdio>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/files.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// A finished run of the first example, without intervals.
class FinishedRun : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(run_without_intervals("01_spool_simulated", {"--out", run_}).status, 0);
    ASSERT_EQ(verify().status, 0);
  }

  [[nodiscard]] Outcome verify() const { return rondure({"verify", run_}); }

  /// The first difference, after checking the exit status.
  [[nodiscard]] std::string difference() const {
    const Outcome outcome = verify();
    EXPECT_EQ(outcome.status, 1);
    EXPECT_THAT(outcome.out, ::testing::StartsWith("not equal: "));
    return outcome.out;
  }

  void change_journal(const std::string& statement) const {
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open((run_ / "journal.db").c_str(), &database), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(database, statement.c_str(), nullptr, nullptr, nullptr), SQLITE_OK);
    EXPECT_EQ(sqlite3_changes(database), 1);
    sqlite3_close(database);
  }

  Scratch folder_;
  fs::path run_ = folder_ / "run";
};

TEST_F(FinishedRun, AChangedTouchBreaksItsTableAndNothingIsComputedFromIt) {
  change_journal(
      "update touch set tip_x_mm = tip_x_mm + 0.001 where id = (select max(id) from touch)");
  EXPECT_THAT(difference(),
              AllOf(HasSubstr("table touch: a value differs from the sealed one"),
                    HasSubstr("note: nothing was computed from a journal that is not as it was "),
                    Not(HasSubstr("touches.csv: "))));
}

TEST_F(FinishedRun, AChangedDigitOfTheJsonReportIsNamed) {
  const auto report = nlohmann::json::parse(read(run_ / "report.json"));
  const std::string value = report.at("/features/0/mz/deviation_um"_json_pointer).dump();
  std::string changed = value;
  // Not the last of 17 digits: two texts of those may be the same double.
  char& digit = changed.at(8);
  digit = digit == '7' ? '8' : '7';
  const std::string key = "\"deviation_um\": ";
  std::string bytes = read(run_ / "report.json");
  const std::size_t at = bytes.find(key + value);
  ASSERT_NE(at, std::string::npos);
  write(run_ / "report.json", bytes.replace(at, (key + value).size(), key + changed));
  EXPECT_THAT(difference(), AllOf(HasSubstr("report.json: /features/0/"), HasSubstr("deviation_um"),
                                  HasSubstr(value), HasSubstr(changed.substr(0, 12))));
}

TEST_F(FinishedRun, AChangedNumberOfTheHtmlReportIsNamed) {
  const auto report = nlohmann::json::parse(read(run_ / "report.json"));
  std::array<char, 32> shown{};
  std::snprintf(shown.data(), shown.size(), "%.3f",
                report.at("/features/0/mz/deviation_um"_json_pointer).get<double>());
  replace_in(run_ / "report.html", shown.data(), "1.234");
  EXPECT_THAT(difference(), AllOf(HasSubstr("report.html: "), HasSubstr("line "),
                                  HasSubstr(shown.data()), HasSubstr("1.234")));
}

TEST_F(FinishedRun, AChangedFieldOfTheTouchesIsNamed) {
  const std::string bytes = read(run_ / "touches.csv");
  // The first row: id 0 of the qualification.
  replace_in(run_ / "touches.csv", "\n0,qualification,", "\n0,measure,");
  EXPECT_THAT(difference(),
              AllOf(HasSubstr("touches.csv: "), HasSubstr("line 3"), HasSubstr("purpose"),
                    HasSubstr("qualification"), HasSubstr("measure")));
  write(run_ / "touches.csv", bytes.substr(0, bytes.size() / 2));
  EXPECT_THAT(difference(), HasSubstr("touches.csv: "));
}

TEST_F(FinishedRun, ReportsAreWrittenAgainByteForByte) {
  const std::string html = read(run_ / "report.html");
  for (const char* name : {"report.html", "report.json", "touches.csv"}) fs::remove(run_ / name);
  EXPECT_EQ(rondure({"report", run_}).status, 0);
  EXPECT_EQ(read(run_ / "report.html"), html);
  EXPECT_EQ(verify().status, 0);
}

TEST_F(FinishedRun, VerifiesInAnotherPlaceAndChangesNothing) {
  const fs::path other = folder_ / "it's called \xc3\xa9 now";
  fs::rename(run_, other);
  const std::string before = read(other / "journal.db");
  EXPECT_EQ(rondure({"verify", other}).status, 0);
  EXPECT_EQ(read(other / "journal.db"), before);
  EXPECT_EQ(names_in(other).size(), 6U);
}

TEST_F(FinishedRun, WithoutItsJournalIsUnreadable) {
  fs::remove(run_ / "journal.db");
  for (const char* verb : {"verify", "report"}) {
    const Outcome outcome = rondure({verb, run_});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("there is no journal.db"),
                                   HasSubstr("copy the run directory again")));
  }
}

}  // namespace
}  // namespace rondure::app::testing
