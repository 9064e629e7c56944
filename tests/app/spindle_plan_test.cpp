// Spindle plans with data from a file, and rondure design-probes.
#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/files.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

std::string data_file() {
  return (fs::path(RONDURE_SOURCE_DIR) / "tests/data/spindle_dynamic/readings.csv").string();
}

TEST(DesignProbes, NamesTheLayoutsBesideTheKnownOnes) {
  const Outcome outcome = rondure(
      {"design-probes", "--samples", "256", "--last-order", "20", "--count", "2", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json found = json::parse(outcome.out);
  ASSERT_EQ(found.at("layouts").size(), 2U);
  EXPECT_LT(found.at("layouts").at(0).at("worst_gain"),
            found.at("for_comparison").at("published-b").at("worst_gain"));
  const Outcome text =
      rondure({"design-probes", "--samples", "256", "--p2", "40,90", "--p3=-90,-40"});
  EXPECT_THAT(text.out, HasSubstr("published-a"));
  EXPECT_EQ(rondure({"design-probes", "--first-order", "1"}).status, 2);
}

/// A plan that reads the file of the dynamic case.
std::string plan_with_file(const std::string& more, const std::string& file = data_file()) {
  return R"({"plan": {"name": "Pin", "revision": "A"}, "part": {"id": "P"}, "features": [{
    "id": "pin", "type": "spindle", "spindle": {"layout": "reference", "crank_radius_mm": 49,
    "wheel_radius_mm": 299.88, "pin_radius_mm": 24.56, "probe_noise_um": 0.001},
    "source": {"file": ")" +
         file + R"("}, "characteristics": [)" + more + R"(]}]})";
}

class SpindlePlan : public ::testing::Test {
 protected:
  Outcome run(const std::string& characteristics, const std::string& file = data_file()) {
    write(folder_ / "plan.json", plan_with_file(characteristics, file));
    return rondure({"run", (folder_ / "plan.json").string(), "--out", (folder_ / "run").string(),
                    "--archive", "none"});
  }
  Scratch folder_;
};

// Lines that miss the axis by 20 um move 2 um of motion by 0.13 um, and the form by 0.07 um.
TEST_F(SpindlePlan, HoldsTheTruthWhereLinesThatMissTheAxisAreDeclared) {
  const auto found = [&](double line_um) {
    const auto wave = [](int order, double um, double deg) {
      return json{{"order", order}, {"amplitude_um", um}, {"phase_deg", deg}};
    };
    const json plan = {
        {"plan", {{"name", "Lines"}, {"revision", "A"}}},
        {"part", {{"id", "P"}}},
        {"features",
         {{{"id", "s"},
           {"type", "spindle"},
           {"spindle",
            {{"layout", "reference"},
             {"pin_radius_mm", 25},
             {"highest_order", 40},
             {"samples", 512},
             {"filter", "none"},
             {"uncertainty", {{"line_um", line_um}, {"gain_1", 1e-4}, {"angle_deg", 1e-3}}}}},
           {"characteristics",
            {{{"id", "RONt"}, {"form", "roundness"}, {"reference", "ls"}},
             {{"id", "RONq"}, {"form", "roundness-rms"}},
             {{"id", "sync"}, {"form", "motion-synchronous"}}}}}}},
        {"simulation",
         {{"seed", 5},
          {"spindle",
           {{"turns", 3},
            {"samples_per_turn", 512},
            {"probe_noise_um", 0.02},
            {"eccentricity_um", 5},
            {"line_error_um", {20, -20, 10}},
            {"profile", {wave(2, 3, 0), wave(15, 2, 40), wave(23, 1, 80)}},
            {"motion_x", {wave(2, 1, 0)}},
            {"motion_y", {wave(3, 1, 0)}}}}}}};
    write(folder_ / "lines.json", plan.dump());
    const std::string out = fmt::format("lines {}", line_um);
    const Outcome ran = rondure({"run", folder_ / "lines.json", "--out", folder_ / out, "--archive",
                                 "none", "--format", "json"});
    EXPECT_LE(ran.status, 1) << ran.err;
    return json::parse(read(folder_ / out / "report.json"))["features"][0]["characteristics"];
  };
  for (const json& one : found(20.0)) {
    EXPECT_EQ(one["verdict"], "not toleranced");
    EXPECT_LT(std::abs(one["simulation"][0]["difference_over_u"].get<double>()), 3.0) << one["id"];
  }
  for (const json& one : found(1e-6)) {
    EXPECT_EQ(one["verdict"], "void");
    EXPECT_GT(std::abs(one["simulation"][0]["difference_over_u"].get<double>()), 10.0);
  }
}

TEST_F(SpindlePlan, JudgesVerifiesAndTellsEveryChange) {
  const Outcome ran = run(
      R"({"id": "RONt", "form": "roundness", "reference": "ls", "tolerance_um": 1},
         {"id": "mask", "form": "harmonic-limits", "harmonic_limits":
           [{"from": 2, "to": 4, "amplitude_um": 3.5}, {"from": 5, "to": 50, "amplitude_um": 0.9}]},
         {"id": "async", "form": "motion-asynchronous"})");
  EXPECT_EQ(ran.status, 1) << ran.err;
  const json report = json::parse(read(folder_ / "run" / "report.json"));
  const json& found = report.at("features").at(0).at("characteristics");
  EXPECT_EQ(found.at(0).at("verdict"), "does not conform");
  EXPECT_EQ(found.at(1).at("verdict"), "conforms");
  EXPECT_THAT(found.at(1).at("reason"), HasSubstr("harmonic 5 is nearest to its limit"));
  EXPECT_NEAR(found.at(1).at("value_um"), 0.8, 1e-4);
  EXPECT_EQ(found.at(2).at("verdict"), "void");
  EXPECT_THAT(found.at(2).at("reason"), HasSubstr("one revolution"));
  EXPECT_THAT(read(folder_ / "run" / "report.html"),
              ::testing::ContainsRegex("<tr><td class=\"n\">5</td><td class=\"n\">0\\.(799|800)"));
  const auto verify = [&] { return rondure({"verify", (folder_ / "run").string()}); };
  EXPECT_EQ(verify().status, 0);
  EXPECT_THAT(verify().out, HasSubstr("1024 rows of series"));

  const std::string csv = read(folder_ / "run" / "series.csv");
  replace_in(folder_ / "run" / "series.csv", "pin,data,7,H2_um,", "pin,data,7,H2_um,9");
  EXPECT_EQ(verify().status, 1);
  write(folder_ / "run" / "series.csv", csv);
  EXPECT_EQ(verify().status, 0);
  std::string bytes = read(folder_ / "run" / "journal.db");
  const std::size_t at = bytes.find("\n0.351562,");
  ASSERT_NE(at, std::string::npos);
  bytes[at + 1] = '8';
  write(folder_ / "run" / "journal.db", bytes);
  const Outcome changed = verify();
  EXPECT_EQ(changed.status, 1);
  EXPECT_THAT(changed.out + changed.err, HasSubstr("series_block"));
}

/// The file with the reading H1 of every row through a function of row and value.
template <class Change>
std::string changed_readings(const Change& change) {
  std::istringstream lines(read(data_file()));
  std::string out;
  std::size_t row = 0;
  std::size_t column = 0;
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> cells;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
    const auto header = std::find(cells.begin(), cells.end(), "H1_um");
    if (header != cells.end()) {
      column = static_cast<std::size_t>(header - cells.begin());
    } else if (!cells.empty() && line.front() != '#') {
      cells.at(column) = std::to_string(change(row++, std::stod(cells.at(column))));
    }
    std::string joined;
    for (const std::string& cell : cells) joined += (joined.empty() ? "" : ",") + cell;
    out += joined + "\n";
  }
  return out;
}

TEST_F(SpindlePlan, VoidsWhatReadingsContradict) {
  const std::string file = (folder_ / "readings.csv").string();
  const std::string asked =
      R"({"id": "RONt", "form": "roundness", "reference": "ls", "tolerance_um": 100},
         {"id": "sync", "form": "motion-synchronous", "tolerance_um": 100},
         {"id": "mask", "form": "harmonic-limits", "harmonic_limits":
           [{"from": 2, "to": 50, "amplitude_um": 100}]})";
  const auto verdicts = [&](const std::string& reason) {
    fs::remove_all(folder_ / "run");
    EXPECT_EQ(run(asked, file).status, 1);
    const json report = json::parse(read(folder_ / "run" / "report.json"));
    for (const json& one : report.at("features").at(0).at("characteristics")) {
      EXPECT_EQ(one.at("verdict"), "void") << one;
      EXPECT_THAT(one.at("reason"), HasSubstr(reason));
    }
  };
  write(file,
        changed_readings([](std::size_t row, double h) { return row == 517 ? h + 30.0 : h; }));
  verdicts("probe 1 row 517");
  write(file, changed_readings([](std::size_t, double h) { return 1.01 * h; }));
  verdicts("calibrate gains and angles of the probes");
}

TEST_F(SpindlePlan, IsRefusedWhenItGuesses) {
  const auto problems = [&](const std::string& from, const std::string& to) {
    std::string plan = plan_with_file(R"({"id": "RONt", "form": "roundness"})");
    const std::size_t at = plan.find(from);
    EXPECT_NE(at, std::string::npos);
    plan.replace(at, from.size(), to);
    write(folder_ / "bad.json", plan);
    const Outcome outcome = rondure({"validate", (folder_ / "bad.json").string()});
    EXPECT_EQ(outcome.status, 2);
    return outcome.out + outcome.err;
  };
  const std::string layout = R"("layout": "reference")";
  EXPECT_THAT(problems(layout, R"("samples": 1024)"),
              HasSubstr("/features/0/spindle/p1_to_p2_deg"));
  EXPECT_THAT(problems(layout, R"("p1_to_p2_deg": 60)"), HasSubstr("p2_to_p3_deg"));
  EXPECT_THAT(problems(layout, R"("p1_to_p2_deg": 60, "p2_to_p3_deg": 240, "p1_to_p3_deg": 300)"),
              HasSubstr("given twice"));
  EXPECT_THAT(problems(layout, R"("p1_to_p2_deg": 60, "p2_to_p3_deg": 180)"), HasSubstr("in line"));
  EXPECT_THAT(problems(layout, R"("layout": "reference", "p1_to_p2_deg": 60)"),
              HasSubstr("has no effect"));
  EXPECT_THAT(problems("\"crank_radius_mm\": 49", "\"crank_radius_mm\": 500"),
              HasSubstr("not below wheel radius"));
  EXPECT_THAT(problems("\"wheel_radius_mm\": 299.88", "\"wheel_radius_mm\": 299880"),
              HasSubstr("micrometres"));
  EXPECT_THAT(problems(layout, R"("layout": "reference", "samples": 90)"),
              HasSubstr("at least 102"));
  EXPECT_THAT(problems(R"("form": "roundness")", R"("form": "cylindricity")"),
              HasSubstr("a spindle has no cylindricity"));
  EXPECT_THAT(problems(R"("form": "roundness")", R"("form": "harmonic-limits")"),
              HasSubstr("/characteristics/0/harmonic_limits"));
  EXPECT_THAT(problems(R"("type": "spindle", "spindle": {)",
                       R"("type": "spindle", "sampling": {}, "spindle": {)"),
              HasSubstr("is not touched"));
  EXPECT_THAT(problems("readings.csv", "SOURCE.md"), HasSubstr("SOURCE.md"));
}

}  // namespace
}  // namespace rondure::app::testing
