// Whole runs against the double of an independent server: no word of its own simulation, values in
// another order, surface points, five decimals, and the same part behind it.

#include <cstdio>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "plans/cell/served_cell.h"
#include "plans/plan.h"
#include "tests/app/cutting_proxy.h"
#include "tests/app/files.h"
#include "tests/app/program.h"
#include "tests/cmm/seen_server.h"

namespace rondure::app::testing {
namespace {

using cmm::ipp::SeenProfile;
using nlohmann::json;
using ::testing::HasSubstr;

constexpr double kSame_um = 0.05;  // five decimals of a millimetre, and of directions

/// The example with a part that is measured without scatter.
json quiet_plan() {
  json plan = json::parse(read(example("02_spool_over_ippdme.json")));
  plan["simulation"]["probe"]["repeatability_um"] = 0;
  plan["simulation"]["fixture"]["repeatability_deg"] = 0;
  plan["environment"]["assumed_degC"] = plan["simulation"]["temperature_degC"];
  plan["reports"]["formats"] = {"json"};
  plan.erase("uncertainty");
  plan["decision_rule"] = {{"rule", "simple-acceptance"}};
  return plan;
}

/// The world of a plan behind the double.
class SeenWorld {
 public:
  SeenWorld(const json& plan, SeenProfile profile) : plan_(parsed(plan)), cell_(plan_, 20261121) {
    const auto like_ours = plans::server_options(plan_).controller;
    profile.defaults = like_ours.defaults;
    profile.tip_radius_mm = like_ours.tip_radius_mm;
    service_ = std::make_unique<cmm::ipp::SeenService>(cell_, profile);
  }
  [[nodiscard]] std::uint16_t port() const { return service_->port(); }

 private:
  static plans::Plan parsed(const json& plan) {
    const TemporaryFolder folder;
    write(folder / "plan.json", plan.dump());
    auto out = plans::read_plan(folder / "plan.json");
    EXPECT_TRUE(out.has_value());
    return std::move(*out);
  }

  plans::Plan plan_;
  plans::ServedCell cell_;
  std::unique_ptr<cmm::ipp::SeenService> service_;
};

/// CYLt of a run that must end well [um].
double cylindricity_um(json plan, const std::string& driver, std::uint16_t port) {
  const TemporaryFolder folder;
  plan["machine"]["driver"] = driver;
  plan["fixture"]["driver"] = driver;
  if (driver == "ippdme") {
    plan["machine"]["port"] = port;
    plan.erase("simulation");  // the other side knows it
  }
  write(folder / "plan.json", plan.dump());
  const Outcome ran = rondure({"run", folder / "plan.json", "--out", folder / "run", "--archive",
                               "none", "--wire-log", folder / "wire.log"});
  EXPECT_EQ(ran.status, 0) << ran.err << ran.out;
  if (ran.status != 0) return -1.0;
  if (driver == "ippdme") {
    EXPECT_EQ(rondure({"verify", folder / "run"}).status, 0);
    EXPECT_FALSE(journal_of(folder / "run").header.simulated);
  }
  return json::parse(read(folder / "run" / "report.json"))
      .at("/features/0/mz/deviation_um"_json_pointer);
}

void expect_the_same_cylindricity(const json& plan, const SeenProfile& profile) {
  const SeenWorld world(plan, profile);
  const double seen_um = cylindricity_um(plan, "ippdme", world.port());
  const double own_um = cylindricity_um(plan, "simulated", 0);
  EXPECT_NEAR(seen_um, own_um, kSame_um);
  std::printf("CYLt %.3f um over the double, %.3f um in one process\n", seen_um, own_um);
}

TEST(SeenServer, AWholeRunGivesTheCylindricityOfTheSimulatedDriver) {
  expect_the_same_cylindricity(quiet_plan(), {});
}

TEST(SeenServer, AServerThatCanOnlyTouchIsEnough) {
  json plan = quiet_plan();
  plan["machine"]["retract"] = "by-distance";
  SeenProfile profile;
  profile.tells_version = profile.scans = profile.has_scan_parameters = false;
  profile.takes_negative_retract = false;
  expect_the_same_cylindricity(plan, profile);
}

TEST(SeenServer, WithoutScanParametersTouchesGoOnAndScansAreRefusedBeforeAnythingMoves) {
  json plan = quiet_plan();
  SeenProfile profile;
  profile.has_scan_parameters = false;
  const SeenWorld world(plan, profile);
  EXPECT_NEAR(cylindricity_um(plan, "ippdme", world.port()), cylindricity_um(plan, "simulated", 0),
              kSame_um);  // the tool stays in the head
  plan["features"][0]["sampling"] = {
      {"method", "scan"}, {"layers", 4}, {"points_per_layer", 120}, {"margin_mm", 5}};
  plan["features"][0]["pose_search"]["repeats"] = 1;
  plan["machine"]["port"] = world.port();
  plan.erase("simulation");
  const TemporaryFolder folder;
  write(folder / "plan.json", plan.dump());
  const Outcome refused = rondure({"run", folder / "plan.json", "--out", folder / "run",
                                   "--archive", "none", "--wire-log", folder / "wire.log"});
  EXPECT_NE(refused.status, 0);
  EXPECT_THAT(refused.err, HasSubstr("Tool.ScanPar"));
  EXPECT_THAT(read(folder / "wire.log"), ::testing::Not(HasSubstr("GoTo(")));
}

TEST(SeenServer, ScansOfIrregularStepsGiveTheSameCylindricity) {
  json plan = quiet_plan();
  plan["features"][0]["sampling"] = {
      {"method", "scan"}, {"layers", 4}, {"points_per_layer", 120}, {"margin_mm", 5}};
  plan["features"][0]["pose_search"]["repeats"] = 1;
  SeenProfile profile;
  profile.irregular_scans = true;
  expect_the_same_cylindricity(plan, profile);
}

TEST(SeenServer, ARunThatWasCutGoesOnInANewSessionAndGivesTheSameCylindricity) {
  json plan = quiet_plan();
  const SeenWorld world(plan, {});
  CuttingProxy proxy(world.port());
  plan["machine"]["port"] = proxy.port();
  plan.erase("simulation");
  const TemporaryFolder folder;
  write(folder / "plan.json", plan.dump());
  const std::vector<std::string> whole = {"run",   folder / "plan.json", "--archive", "none",
                                          "--out", folder / "whole"};
  ASSERT_EQ(rondure(whole).status, 0);
  const std::uint64_t bytes = proxy.take_count();
  const auto result_um = [&](const char* name) -> double {
    return json::parse(read(folder / name / "report.json"))
        .at("/features/0/mz/deviation_um"_json_pointer);
  };
  for (const char* name : {"2", "3", "5"}) {  // cut at this part of the run
    auto arguments = whole;
    arguments.back() = folder / name;
    proxy.cut_after(bytes / static_cast<std::uint64_t>(name[0] - '0'));
    const Outcome stopped = rondure(arguments);
    EXPECT_EQ(stopped.status, 3) << stopped.err;
    arguments.emplace_back("--resume");
    const Outcome ended = rondure(arguments);
    ASSERT_EQ(ended.status, 0) << ended.err;
    EXPECT_NEAR(result_um(name), result_um("whole"), kSame_um);
  }
}

TEST(SeenServer, WhatItLacksIsSaidWithTheKeysThatFollow) {
  SeenProfile profile;
  profile.tells_version = profile.scans = profile.has_scan_parameters = false;
  const SeenWorld world(quiet_plan(), profile);
  const Outcome told = rondure({"devices", "ippdme", "127.0.0.1:" + std::to_string(world.port())});
  ASSERT_EQ(told.status, 0) << told.err;
  EXPECT_THAT(told.out, HasSubstr("I++ DME of unknown version, CartCMMWithRotaryTable\n"));
  EXPECT_THAT(told.out, HasSubstr("rotary axes         yes (AlignPart)"));
  EXPECT_THAT(told.out, HasSubstr("part temperature    results are void unless the plan says"));
  EXPECT_THAT(told.out, HasSubstr("circle scans        a plan with sampling.method \"scan\""));
  EXPECT_THAT(told.out, HasSubstr("GetDMEVersion(): error 0507"));
  std::istringstream lines(told.out);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80U) << line;
}

}  // namespace
}  // namespace rondure::app::testing
