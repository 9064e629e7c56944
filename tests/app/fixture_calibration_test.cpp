// Calibrate the simulated fixture, then inspect with it: example 03 as a person would run it.

#include <unistd.h>

#include <iostream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "record/tasks/run.h"
#include "record/tasks/settings.h"
#include "tests/app/files.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

constexpr const char* kFile = "fixture-calibration.json";

/// Example 03, calibrated, and the plan that inspects with the result.
class CalibratedFixture : public ::testing::Test {
 protected:
  static fs::path run() { return example_runs() / "03_calibrate_fixture"; }

  /// Example 03 with the calibration `bytes`, and changes.
  static fs::path inspection(const fs::path& folder, const std::string& bytes,
                             const std::vector<Change>& changes = {}) {
    json plan = json::parse(read(example("03_inspect_calibrated.json")));
    plan["fixture"]["calibration"]["file"] = kFile;
    for (const Change& change : changes) plan[json::json_pointer(change.pointer)] = change.value;
    write(folder / kFile, bytes);
    write(folder / "plan.json", plan.dump());
    return folder / "plan.json";
  }
};

TEST_F(CalibratedFixture, LeavesAtMostNineTenthsOfAMicrometre) {
  EXPECT_EQ(example_outcome("03_calibrate_fixture").status, 0);
  const json report = json::parse(read(run() / "report.json"));
  const json& found = report.at("/features/0/rotary_axes"_json_pointer);
  std::cout << found.at("verification").dump(1) << "\n";
  EXPECT_GT(found.at("/verification/before_rms_um"_json_pointer), 10.0);
  EXPECT_LE(found.at("/verification/rms_um"_json_pointer), 0.9);
  // What this calibration leaves without the noise of the balls that show it; an exact one leaves
  // 0.01 um.
  for (const json& asked : report.at("/features/0/characteristics"_json_pointer)) {
    const json& held = asked.at("simulation").at(0);
    EXPECT_GT(held.at("truth_um"), 0.5 * held.at("found_um").get<double>());
    EXPECT_LT(held.at("truth_um"), held.at("found_um"));
  }
  // It is named as what it hands on; tables for a control need influences.
  EXPECT_EQ(report.at("/features/0/corrections/0/file"_json_pointer), kFile);
  EXPECT_THAT(report.at("/features/0/no_correction_because"_json_pointer).get<std::string>(),
              HasSubstr("no influence is declared"));
  const Outcome verified = rondure({"verify", run()});
  EXPECT_EQ(verified.status, 0) << verified.out << verified.err;
  EXPECT_THAT(verified.out, HasSubstr(kFile));
  const std::string page = read(run() / "report.html");
  for (const char* words : {"Axis alpha: shift along x", "Axis beta: tilt about z", "hidden truth",
                            "phi beta / °", "error / µrad", "uncertainty"}) {
    EXPECT_THAT(page, HasSubstr(words));
  }
}

TEST_F(CalibratedFixture, AChangedCalibrationIsFoundByVerify) {
  const Scratch folder;
  fs::copy(run(), folder / "copy", fs::copy_options::recursive);
  replace_in(folder / "copy" / kFile, "F-01", "F-09");
  const Outcome verified = rondure({"verify", folder / "copy"});
  EXPECT_EQ(verified.status, 1);
  EXPECT_THAT(verified.out + verified.err, HasSubstr(kFile));
}

TEST_F(CalibratedFixture, CarriesAnInspectionWhoseReportNamesIt) {
  const Scratch folder;
  const fs::path plan = inspection(folder.path(), read(run() / kFile));
  const Outcome ran = rondure({"run", plan, "--out", folder / "run", "--quiet"});
  EXPECT_EQ(ran.status, 0) << ran.err;
  const json report = json::parse(read(folder / "run" / "report.json"));
  const json& used = report.at("fixture_calibration");
  EXPECT_EQ(used.at("fixture"), "F-01");
  EXPECT_EQ(used.at("invalid"), nullptr);
  EXPECT_LT(used.at("age_days"), 1.0);
  EXPECT_GT(used.at("residual_max_um"), 0.0);
  EXPECT_EQ(rondure({"verify", folder / "run"}).status, 0);
  EXPECT_THAT(read(folder / "run" / "report.html"), HasSubstr("Calibration of the fixture"));
  // Evaluation needs no other file.
  const record::RunRecord journal = journal_of(folder / "run");
  const auto fixture = record::task_of<record::FixtureSettings>(journal.settings, "fixture/");
  ASSERT_TRUE(fixture);
  EXPECT_TRUE(fixture->calibration);
}

TEST_F(CalibratedFixture, IsRefusedWhereItDoesNotHold) {
  const std::string good = read(run() / kFile);
  const auto with = [&](const std::string& key, const json& value) {
    json changed = json::parse(good);
    changed[json::json_pointer(key)] = value;
    return changed.dump();
  };
  struct Case {
    std::string bytes;
    std::vector<Change> changes;
    std::string words;
  };
  const std::vector<Case> cases = {
      {with("/expires_utc", json::parse(good).at("measured_utc")), {}, "expired on"},
      {with("/fixture", "F-07"), {}, "that of the fixture \"F-07\", the plan uses \"F-01\""},
      {good.substr(0, good.size() / 2), {}, "the text is no JSON from byte"},
      {good,
       {{"/fixture/max_alpha_deg", 75}},
       "the calibration of the fixture holds for -60..60 deg"},
      {good, {{"/fixture/calibration/max_residual_um", 0.01}}, "the plan allows 0.01 um"},
      {good, {{"/fixture/axis_point_mm", {0, 0, 151}}}, "refer to axis_point_mm"},
      {with("/temperature_degC", 35.0), {}, "made at 35.00 degC, the plan allows 18..22 degC"},
      {with("/temperature_degC", nullptr),
       {},
       "the temperature of the calibration was not measured"},
      {"", {}, "the text is no JSON"}};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.words);
    const Scratch folder;
    const fs::path plan = inspection(folder.path(), c.bytes, c.changes);
    if (c.words == "expired on") sleep(1);  // its last second is over
    const Outcome ran = rondure({"run", plan, "--out", folder / "run"});
    EXPECT_EQ(ran.status, 2);
    EXPECT_THAT(ran.err, HasSubstr(c.words));
    EXPECT_FALSE(fs::exists(folder / "run"));
  }
}

TEST_F(CalibratedFixture, IsVoidOutsideTheTemperatureLimits) {
  const Scratch folder;
  json plan = json::parse(read(example("03_calibrate_fixture.json")));
  plan["simulation"]["temperature_degC"] = 35.0;
  write(folder / "plan.json", plan.dump());
  const Outcome ran =
      rondure({"run", folder / "plan.json", "--out", folder / "run", "--format", "json"});
  EXPECT_EQ(ran.status, 1) << ran.out << ran.err;
  const json report = json::parse(read(folder / "run" / "report.json"));
  for (const json& characteristic : report.at("/features/0/characteristics"_json_pointer)) {
    EXPECT_EQ(characteristic.at("verdict"), "void");
    EXPECT_EQ(characteristic.at("reason"), "temperature 35.00 degC is outside 18..22 degC");
  }
  EXPECT_THAT(read(folder / "run" / kFile), HasSubstr("the calibration does not hold"));
  // And no inspection believes it.
  const fs::path inspects = inspection(folder.path(), read(folder / "run" / kFile));
  EXPECT_EQ(rondure({"run", inspects, "--out", folder / "inspected"}).status, 2);
  EXPECT_FALSE(fs::exists(folder / "inspected"));
}

TEST_F(CalibratedFixture, IsJudgedWithItsIntervalWhereInfluencesAreDeclared) {
  const Scratch folder;
  json plan = json::parse(read(example("03_calibrate_fixture.json")));
  plan["decision_rule"] = {{"rule", "iso-14253-1"}};
  plan["features"][0]["rotary_axes"]["uncertainty"] = {{"ball_um", {{"value", 0.05}}},
                                                       {"reading_urad", {{"value", 0.5}}}};
  write(folder / "plan.json", plan.dump());
  const Outcome ran =
      rondure({"run", folder / "plan.json", "--out", folder / "run", "--format", "json"});
  EXPECT_EQ(ran.status, 0) << ran.out << ran.err;
  const json report = json::parse(read(folder / "run" / "report.json"));
  for (const json& characteristic : report.at("/features/0/characteristics"_json_pointer)) {
    EXPECT_EQ(characteristic.at("verdict"), "conforms") << characteristic.dump(1);
  }
}

TEST_F(CalibratedFixture, IsRefusedBeforeItsFirstTouchWhereTheFixtureIsTooCoarse) {
  const Scratch folder;
  json plan = json::parse(read(example("03_calibrate_fixture.json")));
  plan["fixture"]["resolution_deg"] = 0.5;
  write(folder / "plan.json", plan.dump());
  const Outcome ran = rondure({"run", folder / "plan.json", "--out", folder / "run"});
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.err, HasSubstr("holds an angle within 0.5 deg"));
  EXPECT_FALSE(fs::exists(folder / "run"));
}

TEST_F(CalibratedFixture, IsTheSameWhenTheRunWasInterrupted) {
  const Scratch folder;
  json plan = json::parse(read(example("03_calibrate_fixture.json")));
  plan["simulation"]["faults"]["connection_lost_at_touch"] = 400;
  write(folder / "plan.json", plan.dump());
  EXPECT_EQ(rondure({"run", folder / "plan.json", "--out", folder / "run", "--quiet"}).status, 3);
  const Outcome resumed =
      rondure({"run", folder / "plan.json", "--out", folder / "run", "--resume", "--quiet"});
  EXPECT_EQ(resumed.status, 0) << resumed.err;
  const auto stations = [](const fs::path& place) {
    const json file = json::parse(read(place / kFile));
    return file.at("alpha").dump() + file.at("beta").dump() + file.at("verification").dump();
  };
  EXPECT_EQ(stations(folder / "run"), stations(run()));
}

}  // namespace
}  // namespace rondure::app::testing
