// A swivel head as a plan: found against truth, the table and the run with it, readings of a file,
// what the data refuse.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "evaluation/analysis_result.h"
#include "evaluation/evaluate.h"
#include "record/sha256.h"
#include "tests/app/files.h"
#include "tests/app/on_terminal.h"
#include "tests/app/program.h"
#include "tests/core/full.h"

namespace rondure::app::testing {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;
using ::testing::HasSubstr;

constexpr std::array<const char*, 4> kSteps = {"reference", "C", "A", "verification"};

ordered_json head_plan() { return example_plan("19_five_axis_head"); }

/// The report of a run of a plan; its status is checked by the caller.
json report_of(const Scratch& folder, const ordered_json& plan, const std::string& name,
               const std::vector<std::string>& more = {}) {
  write(folder / (name + ".json"), plan.dump());
  std::vector<std::string> words = {"run", folder / (name + ".json"), "--out", folder / name};
  words.insert(words.end(), more.begin(), more.end());
  const Outcome outcome = rondure(words);
  EXPECT_NE(outcome.status, 3) << outcome.err;
  const std::string text = read(folder / name / "report.json");
  EXPECT_FALSE(text.empty()) << outcome.err;
  return text.empty() ? json() : json::parse(text);
}

const json& head_of(const json& report, std::size_t feature = 0) {
  return report.at("features").at(feature).at("five_axis");
}

/// The truth of a location error, in um or urad.
double truth_of(const evaluation::FiveAxisResult& exact, std::string_view error) {
  for (const evaluation::HeadLocation& one : locations_of(exact)) {
    if (record::name_of(one.error) == error) return core::micrometres(one.value_mm);
  }
  ADD_FAILURE() << error;
  return 0.0;
}

TEST(FiveAxis, ExampleFindsItsTruthAndItsTableTakesTheErrorsAway) {
  const auto run = example_runs() / "19_five_axis_head";
  const json report = json::parse(read(run / "report.json"));
  EXPECT_EQ(report.at("verdict"), "conforms") << report.at("verdict");
  const auto evaluated = evaluation::evaluate(journal_of(run));
  ASSERT_TRUE(evaluated && evaluated->features.at(0).exact);
  const auto& exact =
      std::get<evaluation::FiveAxisResult>(evaluated->features.front().exact->found);
  const json& head = head_of(report);
  ASSERT_EQ(head.at("locations").size(), 8U);
  for (const json& one : head.at("locations")) {
    const double off =
        one.at("found").get<double>() - truth_of(exact, one.at("error").get<std::string>());
    EXPECT_LT(std::abs(off), 3.5 * one.at("u").get<double>()) << one;
  }
  // As defined, by the fit: machine cell, 1.4.
  EXPECT_NEAR(truth_of(exact, "YOA"), -8.66542, 1e-4);
  EXPECT_NEAR(truth_of(exact, "COA"), 25.63507, 1e-3);
  EXPECT_NEAR(core::micrometres(exact.study.before.rms_mm), 41.24, 0.01);
  EXPECT_LT(core::micrometres(exact.study.left.rms_mm), 0.001);
  // What is left is that of the tables as found, with noise, not of exact ones.
  for (const std::size_t feature : {0U, 1U}) {
    const json& asked = report.at("features").at(feature).at("characteristics").at(0);
    ASSERT_EQ(asked.at("id"), "left");
    const json& held = asked.at("simulation").at(0);
    EXPECT_NEAR(held.at("truth_um"), 1.4, 0.1) << feature;
    EXPECT_LT(std::abs(held.at("difference_over_u").get<double>()), 3.0) << feature;
  }
  const json& repeat = head_of(report, 1);
  const double left = repeat.at("left").at("rms_um");
  EXPECT_LT(left, 3.0);
  EXPECT_NEAR(repeat.at("repeat").at("before").at("rms_um").get<double>() / left, 41.0 / left, 1.0);
  EXPECT_EQ(rondure({"verify", run}).status, 0);
  const std::string page = read(run / "report.html");
  EXPECT_THAT(page, HasSubstr("difference over u"));
}

TEST(FiveAxis, TableHasBothAxesInStepsAndTheLocations) {
  const Scratch folder;
  ordered_json plan = head_plan();
  plan["features"].erase(1);
  EXPECT_EQ(report_of(folder, plan, "table").at("verdict"), "conforms");
  const std::string table = read(folder / "table/corrections/head-head-table.csv");
  EXPECT_THAT(table, HasSubstr("# sign: actual minus nominal\n"));
  EXPECT_THAT(table, HasSubstr("\nc,0,0,0,0,0,0,0,0,0,0,0,0,0\n"));
  EXPECT_THAT(table, HasSubstr("\nc,360,"));
  EXPECT_THAT(table, HasSubstr("\na,90,"));
  EXPECT_THAT(table, HasSubstr("\nlocation,value,u,unit\nXOC,"));
  EXPECT_EQ(rondure({"verify", folder / "table"}).status, 0);
}

/// The rows of one axis in a table for the control: the angle as it is written, and the rest.
std::vector<std::pair<std::string, std::string>> table_rows(const std::filesystem::path& file,
                                                            char axis) {
  std::vector<std::pair<std::string, std::string>> out;
  std::istringstream lines(read(file));
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(std::string{axis, ','})) continue;
    const std::size_t comma = line.find(',', 2);
    out.emplace_back(line.substr(2, comma - 2), line.substr(comma));
  }
  return out;
}

/// The readings of a run as a file, and the plan that reads it.
ordered_json plan_of_file(const Scratch& folder, const record::RunRecord& run,
                          const std::function<void(std::vector<double>&)>& change = {}) {
  const record::Series& data = *run.data_of(0, "data");
  std::string text = "step,c_deg,a_deg,setup,dx_um,dy_um,dz_um\n";
  for (std::size_t i = 0; i < data.rows(); ++i) {
    std::vector<double> row(data.values.begin() + static_cast<std::ptrdiff_t>(7 * i),
                            data.values.begin() + static_cast<std::ptrdiff_t>(7 * i + 7));
    if (change) change(row);
    if (row.empty()) continue;
    text += kSteps[static_cast<std::size_t>(row[0])];
    for (std::size_t k = 1; k < 7; ++k) text += fmt::format(",{}", row[k]);
    text += "\n";
  }
  write(folder / "nest.csv", text);
  ordered_json plan = head_plan();
  plan.erase("simulation");
  plan["features"].erase(1);
  ordered_json& feature = plan["features"][0];
  for (const char* key : {"c_stations_deg", "a_stations_deg", "verification", "references"}) {
    feature["five_axis"].erase(key);
  }
  feature["source"] = {{"file", "nest.csv"}};
  return plan;
}

TEST(FiveAxis, ReadingsOfAFileGiveWhatTheTwinGave) {
  const Scratch folder;
  const auto run = example_runs() / "19_five_axis_head";
  const json report = report_of(folder, plan_of_file(folder, journal_of(run)), "file");
  const json before = json::parse(read(run / "report.json"));
  EXPECT_EQ(head_of(report).at("locations"), head_of(before).at("locations"));
  EXPECT_EQ(head_of(report).at("left"), head_of(before).at("left"));
}

TEST(FiveAxis, ReversedAngleGivesTheSameAxisAndATableAsTheControlCounts) {
  const Scratch folder;
  const auto run = example_runs() / "19_five_axis_head";
  ordered_json plan =
      plan_of_file(folder, journal_of(run), [](std::vector<double>& row) { row[1] = -row[1]; });
  plan["features"][0]["five_axis"]["c_sense"] = "reversed";
  const json report = report_of(folder, plan, "reversed");
  const json before = json::parse(read(run / "report.json"));
  EXPECT_EQ(head_of(report).at("locations"), head_of(before).at("locations"));
  const auto rows = table_rows(folder / "reversed/corrections/head-head-table.csv", 'c');
  report_of(folder, plan_of_file(folder, journal_of(run)), "counted");
  const auto as_counted = table_rows(folder / "counted/corrections/head-head-table.csv", 'c');
  ASSERT_EQ(as_counted.size(), 73U);
  ASSERT_EQ(rows.size(), 73U);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].first, std::to_string(5 * i));
    EXPECT_EQ(rows[i].second, as_counted[72 - i].second) << rows[i].first;
  }
}

// The stations of C stand at 0 to 345 deg of the control, those of the machine at 0 to -345.
TEST(FiveAxis, TableOfAReversedCircleIsThatOfTheWholeCircleOfTheControl) {
  const Scratch folder;
  ordered_json plan = head_plan();
  plan["features"].erase(1);
  plan["features"][0]["five_axis"]["c_sense"] = "reversed";
  plan["features"][0]["five_axis"]["a_sense"] = "reversed";
  EXPECT_NE(report_of(folder, plan, "reversed").at("verdict"), "void");
  const std::filesystem::path table = folder / "reversed/corrections/head-head-table.csv";
  const auto c = table_rows(table, 'c');
  ASSERT_EQ(c.size(), 73U);
  for (std::size_t i = 0; i < c.size(); ++i) EXPECT_EQ(c[i].first, std::to_string(5 * i));
  EXPECT_EQ(c.back().second, c.front().second);
  const auto a = table_rows(table, 'a');
  ASSERT_EQ(a.size(), 19U);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].first, std::to_string(5 * i));
}

/// Runs plan.json, whose second feature is measured with the table loaded: without anybody to ask,
/// then resumed by somebody who forgets the file, then by one who has measured it.
json report_after_loading(const Scratch& folder) {
  const std::vector<std::string> run = {"run", folder / "plan.json", "--out", folder / "run"};
  const Outcome stopped = rondure(run);
  EXPECT_EQ(stopped.status, 3) << stopped.err;
  EXPECT_THAT(stopped.err, HasSubstr("nobody can answer; resume the run from one: load the "
                                     "correction that feature \"head\" gave into the control, "
                                     "measure feature \"loaded\" and save loaded.csv"));
  EXPECT_THAT(read(folder / "run/corrections/head-head-table.csv"), HasSubstr("\nc,"))
      << "what is to be loaded";
  EXPECT_EQ(journal_of(folder / "run").data_of(1, "data"), nullptr);
  std::vector<std::string> resumed = run;
  resumed.emplace_back("--resume");
  {
    OnTerminal early(resumed);
    EXPECT_TRUE(early.wait_for("save loaded.csv")) << early.shown();
    early.type("\n");
    EXPECT_EQ(early.finish(), 3);
    EXPECT_THAT(early.shown(), HasSubstr("a file is missing"));
  }
  std::filesystem::rename(folder / "measured.csv", folder / "loaded.csv");
  OnTerminal there(resumed);
  EXPECT_TRUE(there.wait_for("save loaded.csv")) << there.shown();
  there.type("\n");
  EXPECT_NE(there.finish(), 3) << there.shown();
  const auto record = journal_of(folder / "run");
  EXPECT_EQ(record.decisions.size(), 1U);
  const core::Message& answer = record.decisions.back().message;
  EXPECT_EQ(answer.code, core::MessageCode::kCorrectionLoaded);
  EXPECT_THAT(answer.text(0), ::testing::EndsWith("Z"));
  EXPECT_EQ(record.features.at(1).points_sha256, answer.text(1));
  EXPECT_EQ(answer.text(1), record::sha256_hex(read(folder / "loaded.csv")));
  EXPECT_EQ(rondure({"verify", folder / "run"}).status, 0);
  write(folder / "loaded.csv", read(folder / "loaded.csv") + "# later\n");
  EXPECT_THAT(rondure(resumed).err, HasSubstr("the points of loaded.csv changed"));
  return json::parse(read(folder / "run/report.json"));
}

// A control that expects the other sign doubles the errors.
TEST(FiveAxis, TableLoadedWithTheOtherSignIsVoidAndSaysWhatToDo) {
  const auto record = journal_of(example_runs() / "19_five_axis_head");
  for (const double times : {0.1, 2.0}) {
    SCOPED_TRACE(times);
    const Scratch folder;
    ordered_json plan = plan_of_file(folder, record, [times](std::vector<double>& row) {
      for (std::size_t k = 4; k < 7; ++k) row[k] *= times;
    });
    std::filesystem::rename(folder / "nest.csv", folder / "measured.csv");
    ordered_json loaded = plan["features"][0];
    plan = plan_of_file(folder, record);
    loaded["id"] = "loaded";
    loaded["source"]["file"] = "loaded.csv";
    loaded["five_axis"]["repeat"]["with"]["feature"] = plan["features"][0]["id"];
    plan["features"].push_back(loaded);
    write(folder / "plan.json", plan.dump());
    const json report = report_after_loading(folder);
    const json& gates = report.at("features").at(1).at("gates");
    const auto gate =
        std::ranges::find_if(gates, [](const json& one) { return one.at("code") == "sense"; });
    ASSERT_NE(gate, gates.end());
    EXPECT_NEAR(gate->at("found"), times, 0.01);
    EXPECT_EQ(gate->at("outcome"), times > 1.5 ? "voids" : "passed");
    const json& left = report.at("features").at(1).at("characteristics").at(0);
    EXPECT_EQ(left.at("verdict") == "void", times > 1.5) << left.at("reason");
    if (times <= 1.5) continue;
    EXPECT_THAT(left.at("reason").get<std::string>(),
                HasSubstr("2.0 times the 41.244 um without it: the control takes it with the other "
                          "sign; negate its errors, load it and read again"));
  }
}

/// The first feature of the example, its poses in a file of these rows.
ordered_json plan_of_poses(const Scratch& folder, const std::string& rows) {
  ordered_json plan = head_plan();
  plan["features"].erase(1);
  ordered_json& head = plan["features"][0]["five_axis"];
  for (const char* key : {"c_stations_deg", "a_stations_deg", "verification"}) head.erase(key);
  head["poses"] = "poses.csv";
  write(folder / "poses.csv", "# by hand\nstep,c_deg,a_deg\n" + rows);
  write(folder / "poses.json", plan.dump());
  return plan;
}

/// The rows of a file with the poses of the example.
std::string poses_of_example() {
  const ordered_json head = head_plan()["features"][0]["five_axis"];
  std::string out;
  for (const auto& deg : head["c_stations_deg"]) out += fmt::format("C,{},0\n", deg.dump());
  for (const auto& deg : head["a_stations_deg"]) out += fmt::format("A,0,{}\n", deg.dump());
  for (const auto& pose : head["verification"]) {
    out += fmt::format("verification,{},{}\n", pose["c_deg"].dump(), pose["a_deg"].dump());
  }
  return out;
}

TEST(FiveAxis, PosesOfAFileAreThoseOfThePlanAndStayThoseOfTheRun) {
  const Scratch folder;
  const json report = report_of(folder, plan_of_poses(folder, poses_of_example()), "poses");
  const json before = json::parse(read(example_runs() / "19_five_axis_head/report.json"));
  EXPECT_EQ(head_of(report).at("locations"), head_of(before).at("locations"));
  EXPECT_EQ(head_of(report).at("left"), head_of(before).at("left"));
  EXPECT_EQ(rondure({"verify", folder / "poses"}).status, 0);
  write(folder / "poses.csv", read(folder / "poses.csv") + "verification,41.5,33.5\n");
  const Outcome other =
      rondure({"run", folder / "poses.json", "--out", folder / "poses", "--resume"});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("poses.csv does not hold the poses that the run began with"));
}

TEST(FiveAxis, PosesOfAFileThatDoNotFitAreNamedByRowAndColumn) {
  const auto refusal = [](const std::string& rows) {
    const Scratch folder;
    plan_of_poses(folder, rows);
    const Outcome out = rondure({"validate", folder / "poses.json"});
    EXPECT_EQ(out.status, 2);
    return out.out + out.err;
  };
  const std::string fine = poses_of_example();
  const auto rows = static_cast<std::size_t>(std::ranges::count(fine, '\n'));
  const auto says = [&](const std::string& row, const std::string& words) {
    EXPECT_THAT(refusal(fine + row), HasSubstr(words)) << row;
  };
  const std::string last = fmt::format("poses.csv, row {}, ", rows + 1);
  says("C,361,0\n", last + "c_deg: 361 deg is outside");
  says("A,0,-181\n", last + "a_deg: -181 deg is outside");
  says("C,7,5\n", last + "a_deg: 5 deg at a station of C");
  says("A,5,7\n", last + "c_deg: 5 deg at a station of A");
  says("C,15,0\n", last + "c_deg: the station 15 deg of C stands in an earlier row");
  says("verification,2,33\n", last + "c_deg, a_deg: (2, 33) deg: one axis stands near 0");
  says("verification,15,33\n", last + "c_deg, a_deg: (15, 33) deg: an angle is a station");
  says("verification,33,179\n", last + "c_deg, a_deg: A = 179 deg lies beyond");
  says("both,33,20\n", "both");
  says("C,x,0\n", "poses.csv:");
  EXPECT_THAT(refusal("C,15,0\n"), HasSubstr("/features/0/five_axis/poses"));
  const Scratch folder;
  ordered_json plan = plan_of_poses(folder, fine);
  plan["features"][0]["five_axis"]["a_stations_deg"] = {10, 20, 30};
  write(folder / "both.json", plan.dump());
  EXPECT_THAT(rondure({"validate", folder / "both.json"}).err,
              HasSubstr("the file \"poses\" says where the ball is read"));
}

/// The code and the sentence of a feature without a result.
void expect_refused(const std::function<void(std::vector<double>&)>& change, const char* code,
                    const char* words) {
  SCOPED_TRACE(words);
  const Scratch folder;
  const auto run = example_runs() / "19_five_axis_head";
  const json report = report_of(folder, plan_of_file(folder, journal_of(run), change), "refused");
  const json& feature = report.at("features").at(0);
  std::string said = feature.at("failure").is_null()
                         ? std::string()
                         : feature.at("failure").at("what").get<std::string>();
  if (!said.empty()) {
    EXPECT_EQ(feature.at("failure").at("code"), code) << said;
  }
  for (const json& gate : feature.at("gates")) {
    if (gate.at("outcome") == "voids" && gate.at("code") == code) said = gate.at("reason");
  }
  EXPECT_THAT(said, HasSubstr(words));
  EXPECT_EQ(report.at("verdict"), "void");
  EXPECT_THAT(read(folder / "refused/corrections.txt"), HasSubstr("none: "));
}

TEST(FiveAxis, DataThatProveNothingSayWhy) {
  using Row = std::vector<double>;
  expect_refused(
      [](Row& r) {
        if (r[1] == 0.0 && r[2] == 0.0 && r[3] == 2.0) r.clear();
      },
      "missing-key", "ball B2 has 0 readings of the reference pose");
  int number = 0;
  expect_refused(
      [&](Row& r) {
        if (++number == 1) r[4] += 5.0;
      },
      "references", "read the step between them again");
  expect_refused(
      [](Row& r) {
        if (r[0] == 3.0 && r[1] < 200.0) r.clear();
      },
      "combined-poses", "do not verify both axes");
  expect_refused([](Row& r) { std::swap(r[1], r[2]); }, "meaning", "exchanged");
  expect_refused(
      [](Row& r) {
        for (int k = 4; k < 7; ++k) r[static_cast<std::size_t>(k)] *= 1000.0;
      },
      "units", "give dx_um, dy_um, dz_um in um");
  expect_refused(
      [](Row& r) {
        for (int k = 4; k < 7; ++k) r[static_cast<std::size_t>(k)] *= 0.001;
      },
      "units", "less than the 0.500 um that one reading is uncertain by");
  expect_refused([](Row& r) { r[3] += 1.0; }, "unknown-key", "set-up 5 is none of the 4 balls");
  // The nest was set to zero at every ball, and the tool data of one are wrong by 20 um.
  expect_refused(
      [](Row& r) {
        if (r[3] != 2.0 || r[0] == 0.0) return;
        const double a = r[2] * 3.14159265358979 / 180.0;
        r[5] += 20.0 * std::sin(a);
        r[6] += 20.0 * (1.0 - std::cos(a));
      },
      "inconsistent", "off that of the reference pose");
}

TEST(FiveAxis, SagOfBothAnglesVoidsTheTable) {
  const Scratch folder;
  ordered_json plan = head_plan();
  plan["features"].erase(1);
  plan["simulation"]["five_axis"]["sag_urad"] = 150.0;
  const json report = report_of(folder, plan, "sag");
  EXPECT_EQ(report.at("verdict"), "void");
  bool voided = false;
  for (const json& gate : report.at("features").at(0).at("gates")) {
    voided = voided || (gate.at("code") == "depends-on-both" && gate.at("outcome") == "voids");
  }
  EXPECT_TRUE(voided);
  EXPECT_THAT(read(folder / "sag/corrections.txt"), HasSubstr("errors depend on both angles"));
}

TEST(FiveAxis, ShortArcHasATableAndNoLocation) {
  const Scratch folder;
  ordered_json plan = head_plan();
  plan["features"].erase(1);
  ordered_json& head = plan["features"][0]["five_axis"];
  head["a_stations_deg"] = {0, 10, 20, 30, 40};
  for (ordered_json& pose : head["verification"]) {
    pose["a_deg"] = 0.4 * pose["a_deg"].get<double>() + 5.5;
  }
  const json report = report_of(folder, plan, "short");
  EXPECT_EQ(head_of(report).at("locations").size(), 4U);
  for (const json& one : report.at("features").at(0).at("characteristics")) {
    if (one.at("id") != "YOA") continue;
    EXPECT_EQ(one.at("verdict"), "void");
    EXPECT_THAT(one.at("reason").get<std::string>(), HasSubstr("less than 45 deg"));
  }
  EXPECT_THAT(read(folder / "short/corrections/head-head-table.csv"), HasSubstr("\na,40,"));
}

TEST(FiveAxis, WithoutTheSlidesThereIsNoInterval) {
  const Scratch folder;
  ordered_json plan = head_plan();
  plan["features"].erase(1);
  plan["features"][0]["five_axis"]["uncertainty"].erase("slides_urad");
  const json report = report_of(folder, plan, "slides");
  EXPECT_THAT(report.dump(), HasSubstr("the errors of the slides look like those of the head"));
}

// 300 twins with RONDURE_FULL=1, 1000 with RONDURE_FULL=all.
TEST(FiveAxis, StatedIntervalsHoldTheTruthAndTheTableDoesWhatWasForecast) {
  const int twins = test::cases(12, 120, 1000);
  const Scratch folder;
  ordered_json plan = head_plan();
  plan["reports"]["formats"] = {"json"};
  ordered_json& asked = plan["features"][0]["characteristics"];
  asked.clear();
  const std::array<const char*, 8> names = {"XOC", "YOC", "AOC", "BOC", "YOA", "ZOA", "BOA", "COA"};
  for (const char* name : names) {
    asked.push_back({{"id", name}, {"form", "location"}, {"error", name}});
  }
  int held = 0;
  int all = 0;
  double left = 0.0;
  double forecast = 0.0;
  for (int twin = 1; twin <= twins; ++twin) {
    const std::string name = fmt::format("twin{}", twin);
    const json report = report_of(folder, plan, name, {"--seed", std::to_string(twin)});
    for (const json& one : report.at("features").at(0).at("characteristics")) {
      const std::string id = one.at("id");
      const bool angle = id == "AOC" || id == "BOC" || id == "BOA" || id == "COA";
      const json& stated = one.at("uncertainty").at("sampled_points");
      const char* const unit = angle ? "_urad" : "_um";
      const double truth = one.at("simulation").at(0).at(std::string("truth") + unit);
      held += stated.at(std::string("low") + unit).get<double>() <= truth &&
                      truth <= stated.at(std::string("high") + unit).get<double>()
                  ? 1
                  : 0;
      ++all;
    }
    const json& repeat = head_of(report, 1);
    left += repeat.at("left").at("rms_um").get<double>() / twins;
    forecast += repeat.at("repeat").at("forecast_rms_um").get<double>() / twins;
    std::filesystem::remove_all(folder / name);
  }
  const double share = static_cast<double>(held) / all;
  EXPECT_GE(share, test::full() ? 0.93 : 0.88);
  EXPECT_LE(share, test::full() ? 0.97 : 1.0);
  EXPECT_NEAR(left / forecast, 1.0, 0.15);
}

}  // namespace
}  // namespace rondure::app::testing
