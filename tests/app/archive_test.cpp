// Finished runs in the archive, as a shell sees it.

#include <sqlite3.h>

#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/encodings.h"
#include "reports/terminal/internal/columns.h"
#include "tests/app/files.h"
#include "tests/app/program.h"
#include "tests/record/postgres_server.h"

namespace rondure::app::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

Outcome run_axle_into(const fs::path& place, const std::vector<std::string>& more = {}) {
  std::vector<std::string> words = {"--out", place};
  words.insert(words.end(), more.begin(), more.end());
  return run_without_intervals("09_axle_points_file", words);
}

TEST(ArchiveOfRuns, StandsBesideTheRunDirectoriesAndHoldsWhatTheReportSays) {
  const Scratch folder;
  const int status = run_axle_into(folder / "one", {"--serial", "0042", "--operator", "mk",
                                                    "--order", "4711", "--customer", "ACME"})
                         .status;
  ASSERT_LE(status, 1);
  ASSERT_EQ(run_axle_into(folder / "two", {"--serial", "0043"}).status, status);
  EXPECT_THAT(names_in(folder.path()), ElementsAre("archive.db", "one", "two"));
  const auto all = history_of(folder / "archive.db");
  const auto report = nlohmann::json::parse(read(folder / "one" / "report.json"));
  EXPECT_EQ(report["header"]["order"], "4711");
  EXPECT_EQ(report["header"]["customer"], "ACME");
  const auto& asked = report["features"][0]["characteristics"];
  ASSERT_EQ(all["results"].size(), 2 * asked.size());
  EXPECT_FALSE(all["more"]);
  const auto one = history_of(folder / "archive.db", {"--serial", "0042"});
  ASSERT_EQ(one["results"].size(), asked.size());
  for (const auto& result : one["results"]) {
    EXPECT_EQ(result["run_id"], "one");
    EXPECT_EQ(result["operator"], "mk");
    EXPECT_EQ(result["version"], report["header"]["version"]);
  }
}

TEST(ArchiveOfRuns, PutsARunChartIntoThePageOfTheSecondRunAndVerifyNeedsNoArchive) {
  const Scratch folder;
  for (const char* name : {"one", "two", "three"})
    ASSERT_LE(run_axle_into(folder / name).status, 1);
  EXPECT_FALSE(fs::exists(folder / "one" / "earlier.json"));
  EXPECT_THAT(read(folder / "one" / "report.html"), Not(HasSubstr("Earlier runs")));
  const auto earlier = nlohmann::json::parse(read(folder / "three" / "earlier.json"));
  const auto report = nlohmann::json::parse(read(folder / "three" / "report.json"));
  EXPECT_EQ(earlier["results"].size(), 2 * report["features"][0]["characteristics"].size());
  const std::string page = read(folder / "three" / "report.html");
  EXPECT_THAT(page, AllOf(HasSubstr("<section id=\"history\">"), HasSubstr("Run chart of ")));
  fs::remove(folder / "archive.db");
  EXPECT_EQ(rondure({"verify", folder / "three"}).status, 0);
  EXPECT_LE(rondure({"report", folder / "three", "--format", "html"}).status, 1);
  EXPECT_EQ(read(folder / "three" / "report.html"), page);
  write(folder / "three" / "earlier.json", "{}");
  EXPECT_EQ(rondure({"verify", folder / "three"}).status, 1);
}

TEST(ArchiveOfRuns, CanBeSwitchedOffAndNamed) {
  const Scratch folder;
  ASSERT_LE(run_axle_into(folder / "one", {"--archive", "none"}).status, 1);
  EXPECT_THAT(names_in(folder.path()), ElementsAre("one"));
  ASSERT_LE(run_axle_into(folder / "two", {"--archive", folder / "mine.db"}).status, 1);
  EXPECT_THAT(names_in(folder.path()), ElementsAre("mine.db", "one", "two"));
  // As a plan says it: relative to the plan.
  fs::create_directory(folder / "plans");
  write_plan(folder / "plans" / "plan.json", {{"/reports/archive", "results.db"}});
  ASSERT_EQ(rondure({"run", folder / "plans" / "plan.json", "--out", folder / "three"}).status, 0);
  EXPECT_THAT(names_in(folder / "plans"), ElementsAre("plan.json", "results.db"));
}

TEST(ArchiveOfRuns, IsMadeAgainFromTheRunDirectories) {
  const Scratch folder;
  ASSERT_LE(run_axle_into(folder / "one").status, 1);
  const auto before = history_of(folder / "archive.db");
  const std::vector<std::string> add = {"history", folder / "again.db", "--add", folder / "one"};
  EXPECT_THAT(rondure(add).out, HasSubstr("added"));
  const auto after = history_of(folder / "again.db");
  EXPECT_EQ(after["results"], before["results"]);
  EXPECT_THAT(rondure(add).out, HasSubstr("was in the archive already"));
  EXPECT_EQ(history_of(folder / "again.db")["results"].size(), before["results"].size());
  const Outcome absent = rondure({"history", folder / "again.db", "--add", folder / "none"});
  EXPECT_EQ(absent.status, 2);
}

TEST(ArchiveOfRuns, ThatFailsChangesNothingOfTheRunAndIsCaughtUp) {
  const Scratch folder;
  const int status = run_axle_into(folder / "zero", {"--archive", "none"}).status;
  const fs::path archive = folder / "absent" / "archive.db";
  for (const char* name : {"one", "two"}) {
    const Outcome outcome = run_axle_into(folder / name, {"--archive", archive});
    EXPECT_EQ(outcome.status, status);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("no such file or folder"), HasSubstr("wait"),
                                   HasSubstr("--push --queue")));
  }
  EXPECT_EQ(rondure({"history", "--push", "--queue", folder / "archive-queue.db"}).status, 2);
  fs::create_directory(folder / "absent");
  const Outcome pushed = rondure({"history", "--push", "--queue", folder / "archive-queue.db"});
  EXPECT_EQ(pushed.status, 0) << pushed.err;
  EXPECT_THAT(pushed.out, AllOf(HasSubstr("2 runs sent"), HasSubstr("0 wait")));
  EXPECT_EQ(history_of(archive)["results"].size() % 2, 0U);
  EXPECT_THAT(rondure({"history", archive}).out,
              AllOf(::testing::StartsWith("started (UTC)"), HasSubstr(" conforms\n")));
  // What stands in the way may be anything.
  write(folder / "text", "not a database at all");
  const Outcome outcome = run_axle_into(folder / "three", {"--archive", folder / "text"});
  EXPECT_EQ(outcome.status, status);
  EXPECT_THAT(outcome.err, HasSubstr("is not a database"));
  EXPECT_EQ(read(folder / "text"), "not a database at all");
}

TEST(ArchiveOfRuns, OnAServerThatIsAwayWaits) {
  record::PostgresServer server;
  if (!server.absent().empty()) GTEST_SKIP() << server.absent();
  const Scratch folder;
  ASSERT_LE(run_axle_into(folder / "one", {"--archive", server.url()}).status, 1);
  server.stop();
  const Outcome away =
      run_axle_into(folder / "two", {"--archive", server.url_of("rondure:secret")});
  EXPECT_LE(away.status, 1);
  EXPECT_THAT(away.err, AllOf(HasSubstr("1 run waits"), Not(HasSubstr("secret"))));
  EXPECT_THAT(read(folder / "archive-queue.db"), Not(HasSubstr("secret")));
  server.start();
  ASSERT_LE(run_axle_into(folder / "three", {"--archive", server.url()}).status, 1);
  const auto all = history_of(server.url());
  std::set<std::string> runs;
  for (const auto& result : all["results"]) runs.insert(result["run_id"]);
  EXPECT_THAT(runs, ElementsAre("one", "three", "two"));
}

TEST(ArchiveOfRuns, ThatCannotBeIsRefusedBeforeAnythingMoves) {
  const Scratch folder;
  for (const char* wrong : {"mysql://h/d", "postgresql://u:p/w@h/d"}) {
    const Outcome outcome = run_axle_into(folder / "run", {"--archive", wrong});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_FALSE(fs::exists(folder / "run"));
  }
  write_plan(folder / "plan.json", {{"/reports/archive", "postgresql://u:secret@h/d"}});
  const Outcome outcome = rondure({"validate", folder / "plan.json"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("/reports/archive"), HasSubstr("~/.pgpass"),
                                 Not(HasSubstr("secret"))));
}

TEST(History, OfHostileNamesIsPlainText) {
  const Scratch folder;
  const std::vector<std::string> names = {"<script>alert(1)</script>", "a\nb",
                                          "\xe5\x9c\x86\xe6\x9f\xb1", std::string(10'000, 'x'),
                                          "o'; drop table rondure_run"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Outcome outcome =
        run_axle_into(folder / std::to_string(i), {"--serial", names[i], "--operator", names[i]});
    EXPECT_LE(outcome.status, 1);
    EXPECT_EQ(outcome.err, "");
  }
  const fs::path archive = folder / "archive.db";
  const std::size_t each = history_of(archive, {"--serial", names[0]})["results"].size();
  EXPECT_GT(each, 0U);
  EXPECT_EQ(history_of(archive)["results"].size(), each * names.size());
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"history", archive}, {"history", archive, "--chart"}}) {
    const Outcome outcome = rondure(words);
    EXPECT_EQ(outcome.status, 0);
    std::istringstream lines(outcome.out);
    for (std::string line; std::getline(lines, line);) {
      EXPECT_LE(reports::columns(line), 80U);
      EXPECT_EQ(core::printable(line), line);
    }
  }
  const Outcome svg = rondure({"history", archive, "--svg", folder / "chart.svg"});
  EXPECT_EQ(svg.status, 0);
  EXPECT_THAT(read(folder / "chart.svg"), Not(HasSubstr("<script")));
}

TEST(ArchiveOfRuns, KeepsNoPasswordOfAnyUrlThatTheServerAccepts) {
  const Scratch folder;
  // libpq takes what stands before the @ for user and password, a ? as well.
  const Outcome outcome = run_axle_into(
      folder / "run", {"--archive", "postgresql://u:sec?ret@127.0.0.1:1/d?connect_timeout=1"});
  EXPECT_LE(outcome.status, 1);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("postgresql://u@127.0.0.1:1/d"),
                                 HasSubstr("1 run waits"), Not(HasSubstr("sec?ret"))));
  for (const fs::path& file : {folder / "archive-queue.db", folder / "run" / "journal.db"}) {
    EXPECT_THAT(read(file), AllOf(Not(::testing::IsEmpty()), Not(HasSubstr("sec?ret")))) << file;
  }
  // As an older program kept it: the run is still found, and the password still not shown.
  sqlite3* queue = nullptr;
  ASSERT_EQ(sqlite3_open((folder / "archive-queue.db").c_str(), &queue), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(queue,
                         "update rondure_queue set target = "
                         "'postgresql://u:sec?ret@127.0.0.1:1/d?connect_timeout=1'",
                         nullptr, nullptr, nullptr),
            SQLITE_OK);
  sqlite3_close(queue);
  const Outcome push = rondure({"history", "--push", "--queue", folder / "archive-queue.db"});
  EXPECT_THAT(push.out, AllOf(HasSubstr("1 waits"), Not(HasSubstr("sec?ret"))));
  EXPECT_THAT(push.err, Not(HasSubstr("sec?ret")));
  write_plan(folder / "plan.json", {{"/reports/archive", "postgresql://u:sec?ret@h/d"}});
  EXPECT_THAT(rondure({"validate", folder / "plan.json"}).err,
              AllOf(HasSubstr("~/.pgpass"), Not(HasSubstr("sec?ret"))));
}

TEST(History, SaysWhatItCannotRead) {
  const Scratch folder;
  write(folder / "text", "not a database at all");
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{folder / "absent.db"}, "does not exist"},
      {{folder / "text"}, "is not a database"},
      {{folder.path()}, "is no file"},
      {{"none"}, "none is no archive"},
      {{"postgresql://u@127.0.0.1:1/d"}, "start the server"}};
  for (const auto& [words, why] : cases) {
    std::vector<std::string> command = {"history"};
    command.insert(command.end(), words.begin(), words.end());
    const Outcome outcome = rondure(command);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, HasSubstr(why));
    EXPECT_EQ(outcome.out, "");
  }
  ASSERT_LE(run_axle_into(folder / "run").status, 1);
  const std::string archive = folder / "archive.db";
  for (const std::vector<std::string>& words : {std::vector<std::string>{"--since", "yesterday"},
                                                {"--until", "2026-02-30"},
                                                {"--verdict", "good"},
                                                {"--last", "0"},
                                                {"--last", "-1"}}) {
    std::vector<std::string> command = {"history", archive};
    command.insert(command.end(), words.begin(), words.end());
    const Outcome outcome = rondure(command);
    EXPECT_EQ(outcome.status, 2) << words[0];
    EXPECT_THAT(outcome.err, HasSubstr(words[0]));
  }
  EXPECT_EQ(rondure({"history", archive, "--since", "2999-01-01"}).out, "no results\n");
  EXPECT_EQ(rondure({"history", archive, "--part", "nobody", "--svg", folder / "x.svg"}).status, 2);
}

TEST(History, GivesCsvToAFileAndToStandardOutput) {
  const Scratch folder;
  ASSERT_LE(run_axle_into(folder / "run").status, 1);
  const std::string archive = folder / "archive.db";
  ASSERT_EQ(rondure({"history", archive, "--csv", folder / "all.csv"}).status, 0);
  EXPECT_EQ(rondure({"history", archive, "--csv", "-"}).out, read(folder / "all.csv"));
  EXPECT_THAT(read(folder / "all.csv"), HasSubstr("\nrun,"));
}

}  // namespace
}  // namespace rondure::app::testing
