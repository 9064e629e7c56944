// The examples of wheel and crank pin find what their simulation hides.

#include <cmath>
#include <filesystem>
#include <map>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/files.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

using ::testing::HasSubstr;

std::map<std::string, double> truth_of(const std::filesystem::path& run) {
  std::map<std::string, double> out;
  for (const auto& value : journal_of(run).truth_values) out[value.name] = value.value;
  return out;
}

// One command from one plan: found, truth, difference over u, and the path that leaves the run.
TEST(WheelFeature, FindsTheHiddenTruthOfTheExampleAndHandsOutItsPath) {
  const Scratch folder;
  const auto run = folder / "run";
  const Outcome outcome =
      rondure({"run", example("06_wheel.json"), "--out", run, "--archive", "none"});
  ASSERT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  const auto feature = nlohmann::json::parse(read(run / "report.json"))["features"][0];
  const auto& wheel = feature["wheel"];
  auto truth = truth_of(run);
  const double u_um = wheel["radius_uncertainty_um"];
  EXPECT_NEAR(u_um, 0.4 / 6.0, 0.001);  // 36 points of 0.4 um
  EXPECT_NEAR(wheel["radius_mm"], truth.at("radius_mm"), 3e-3 * u_um);
  EXPECT_NEAR(wheel["center_mm"][0], truth.at("center_x_mm"), 5e-3 * u_um);
  EXPECT_NEAR(wheel["center_mm"][1], truth.at("center_z_mm"), 5e-3 * u_um);
  EXPECT_TRUE(wheel["dropped"].empty());
  EXPECT_GT(wheel["forecast"]["improvement"], 5.0);
  const std::map<std::string, double> hidden_um = {
      {"radius", 1000.0 * (50.0 - truth.at("radius_mm"))}, {"run-out", truth.at("runout_um")}};
  const std::string page = read(run / "report.html");
  EXPECT_THAT(page, HasSubstr("<h3>Held against the truth of the simulation</h3>"));
  for (const auto& asked : feature["characteristics"]) {
    SCOPED_TRACE(asked["id"]);
    EXPECT_EQ(asked["verdict"], "conforms");
    ASSERT_EQ(asked["simulation"].size(), 1U);
    const auto& beside = asked["simulation"][0];
    EXPECT_LT(std::abs(beside["difference_over_u"].get<double>()), 3.0);
    const auto hidden = hidden_um.find(asked["id"]);
    // The thirty-six places of the run-out may lie between its extremes.
    if (hidden != hidden_um.end()) {
      EXPECT_NEAR(beside["truth_um"], hidden->second, 0.1);
    }
  }
  ASSERT_EQ(feature["corrections"].size(), 2U);
  for (const auto& file : feature["corrections"]) {
    EXPECT_TRUE(std::filesystem::is_regular_file(run / file["file"].get<std::string>()));
    EXPECT_THAT(page, HasSubstr(file["file"].get<std::string>()));
  }
  EXPECT_EQ(rondure({"verify", run}).status, 0);
}

TEST(WheelFeature, LeavesAProudGrainOutOfCentreAndRadiusAlone) {
  const Scratch folder;
  write(folder / "plan.json", wheel_with_a_grain().dump());
  const auto run = folder / "run";
  ASSERT_EQ(rondure({"run", folder / "plan.json", "--out", run, "--archive", "none"}).status, 1);
  const auto feature = nlohmann::json::parse(read(run / "report.json"))["features"][0];
  EXPECT_EQ(feature["characteristics"][0]["verdict"], "conforms");
  EXPECT_EQ(feature["characteristics"][1]["verdict"], "does not conform");
  EXPECT_EQ(feature["characteristics"][2]["verdict"], "does not conform");
  EXPECT_TRUE(feature["corrections"].empty());
  const auto& wheel = feature["wheel"];
  auto truth = truth_of(run);
  const double u_um = wheel["radius_uncertainty_um"];
  EXPECT_NEAR(u_um, 0.104, 0.001);  // 0.4 um of a point, 15 points
  EXPECT_NEAR(wheel["radius_mm"], truth.at("radius_mm"), 3e-3 * u_um);
  EXPECT_NEAR(wheel["center_mm"][0], truth.at("center_x_mm"), 5e-3 * u_um);
  EXPECT_NEAR(wheel["center_mm"][1], truth.at("center_z_mm"), 5e-3 * u_um);
  // Sixteen points miss the extremes of the form by a share of it; the noise is 0.4 um.
  EXPECT_NEAR(wheel["runout"]["fim_at_least_um"], truth.at("runout_um"), 2.0);
  EXPECT_TRUE(wheel["effective_radius_mm"].is_null());
  ASSERT_EQ(wheel["dropped"].size(), 1U);
  EXPECT_EQ(wheel["dropped"][0]["row"], 4);
}

TEST(ContourFeature, FindsTheHiddenRestOfEverySimulatedPin) {
  const Scratch folder;
  // The seed of the plan, and another one.
  const auto other = rondure({"run", example("07_crank_pin.json"), "--out", folder / "run",
                              "--format", "json", "--archive", "none", "--seed", "8"});
  ASSERT_LE(other.status, 1) << other.err;
  for (const auto& run : {example_runs() / "07_crank_pin", folder / "run"}) {
    SCOPED_TRACE(run);
    const auto report = nlohmann::json::parse(read(run / "report.json"));
    const auto& feature = report["features"][0];
    for (const auto& warning : feature["warnings"]) EXPECT_EQ(warning["code"], "alignment");
    EXPECT_EQ(feature["contour"]["stability"]["following"]["word"], "stable");
    const auto journal = journal_of(run);
    for (int part = 0; part < 4; ++part) {
      const auto* truth = journal.truth_series_of(0, fmt::format("truth {}", part + 1));
      ASSERT_NE(truth, nullptr);
      const auto hidden = truth->column("rest_um").value();
      const auto& found = feature["contour"]["curves"][static_cast<std::size_t>(part)]["rest_um"];
      ASSERT_EQ(found.size(), hidden.size());
      double squares = 0.0;
      for (std::size_t m = 0; m < hidden.size(); ++m) {
        squares += std::pow(found[m].get<double>() - hidden[m], 2);
      }
      // Roughness 0.1 um behind 50 UPR leaves 0.03 um, the noise of the traces about as much.
      EXPECT_LT(std::sqrt(squares / static_cast<double>(hidden.size())), 0.1);
    }
  }
}

}  // namespace
}  // namespace rondure::app::testing
