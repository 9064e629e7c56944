// Runs reported in Chinese: no English that does not say so, verified, and resumed in Chinese.

#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/files.h"
#include "tests/app/program.h"
#include "tests/reports/english_left.h"
#include "tests/reports/page_text.h"

namespace rondure::app::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

/// Texts of the user in a plan: names, and statements in words.
void add_names(const nlohmann::json& value, const std::string& key, std::vector<std::string>& out) {
  static const std::set<std::string> kNames = {"id",      "name",     "drawing", "drawing_zone",
                                               "file",    "revision", "zones",   "outcomes",
                                               "repeats", "outliers"};
  if (value.is_structured()) {
    for (const auto& [below, inner] : value.items()) {
      add_names(inner, value.is_array() ? key : below, out);
    }
  } else if (value.is_string() && kNames.count(key) == 1) {
    out.push_back(value.get<std::string>());
  }
}

std::vector<std::string> names_of(const std::filesystem::path& plan) {
  std::vector<std::string> out = {plan.filename().string(), "fixcal_run"};
  add_names(nlohmann::json::parse(read(plan)), "", out);
  return out;
}

TEST(Language, ChineseRunsOfEveryKindSayWhatIsEnglish) {
  const Scratch folder;
  for (const char* name :
       {"01_spool_simulated", "03_calibrate_fixture", "04_part_in_two_poses",
        "05_spindle_three_probe", "06_wheel", "07_crank_pin", "09_axle_points_file"}) {
    SCOPED_TRACE(name);
    const auto plan = folder / (std::string(name) + ".json");
    const bool pins = std::string_view(name) == "07_crank_pin";
    const bool chipped = std::string_view(name) == "06_wheel";
    write(plan, (pins      ? two_crank_pins()
                 : chipped ? wheel_with_a_grain()
                           : example_plan(name))
                    .dump(2));
    const auto run = folder / name;
    const Outcome outcome = rondure({"run", plan, "--out", run, "--archive", "none", "--lang", "zh",
                                     "--format", "html,csv,json", "--serial", "4"});
    EXPECT_EQ(outcome.status, chipped ? 1 : 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr(chipped ? "\n不合格\n" : "\n合格\n"));
    EXPECT_EQ(outcome.out.find("\n不合格\n") != std::string::npos, chipped);
    const std::string page = read(run / "report.html");
    auto names = names_of(plan);
    names.emplace_back(name);
    EXPECT_EQ(reports::testing::english_left(page, names), "");
    EXPECT_EQ(reports::testing::first_unbalanced_tag(page), "");
    const Outcome verified = rondure({"verify", run});
    EXPECT_EQ(verified.status, 0) << verified.out;
  }
}

TEST(Language, ReportsAreWrittenAgainInEither) {
  constexpr const char* kFormats = "html,json,csv,qif,dmis";
  const Scratch folder;
  const auto run = folder / "run";
  ASSERT_EQ(run_without_intervals("09_axle_points_file",
                                  {"--out", run, "--archive", "none", "--format", kFormats})
                .status,
            0);
  const std::vector<std::string> machines = {"report.json", "results.csv", "report.qif",
                                             "report.dmo", "touches.csv"};
  std::vector<std::string> english;
  for (const std::string& file : machines) english.push_back(read(run / file));
  const std::string page = read(run / "report.html");
  EXPECT_THAT(page, HasSubstr("<html lang=\"en\">"));

  EXPECT_EQ(rondure({"report", run, "--lang", "zh", "--format", kFormats}).status, 0);
  EXPECT_THAT(read(run / "report.html"), HasSubstr("<html lang=\"zh-Hans\">"));
  for (std::size_t i = 0; i < machines.size(); ++i) {
    EXPECT_EQ(read(run / machines[i]), english[i]) << machines[i];
  }
  EXPECT_EQ(rondure({"verify", run}).status, 0);
  replace_in(run / "report.html", "合格", "不合格");
  EXPECT_EQ(rondure({"verify", run}).status, 1);

  EXPECT_EQ(rondure({"report", run, "--lang", "en", "--format", kFormats}).status, 0);
  EXPECT_EQ(read(run / "report.html"), page);
}

TEST(Language, OneThatIsNotKnownIsRefusedWithTheList) {
  for (const char* verb : {"run", "report"}) {
    const Outcome outcome = rondure({verb, example("09_axle_points_file.json"), "--lang", "fr"});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("fr"), HasSubstr("en"), HasSubstr("zh")));
    EXPECT_THAT(outcome.out, IsEmpty());
  }
}

TEST(Language, ARunThatStoppedGoesOnInItsLanguage) {
  const Scratch folder;
  const auto plan = folder / "plan.json";
  write_plan(plan, {{"/simulation/faults", {{"connection_lost_at_touch", 60}}}});
  const Outcome stopped = rondure({"run", plan, "--out", folder / "run", "--archive", "none",
                                   "--lang", "zh", "--format", "html"});
  EXPECT_EQ(stopped.status, 3);
  EXPECT_THAT(stopped.out, HasSubstr("\n无效\n"));
  EXPECT_THAT(stopped.err, HasSubstr(" --lang zh"));
  const std::string page = read(folder / "run" / "report.html");
  EXPECT_THAT(page, AllOf(HasSubstr("本次检测未完成。"), HasSubstr("设备故障：<bdi lang=\"en\">")));
  auto names = names_of(plan);
  names.emplace_back("run");
  EXPECT_EQ(reports::testing::english_left(page, names), "");

  const Outcome finished = rondure(
      {"run", folder / "run", "--resume", "--archive", "none", "--lang", "zh", "--format", "html"});
  EXPECT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(read(folder / "run" / "report.html"), Not(HasSubstr("本次检测未完成。")));
  EXPECT_EQ(rondure({"verify", folder / "run"}).status, 0);
}

}  // namespace
}  // namespace rondure::app::testing
