// The examples of wheel and crank pin find what their simulation hides.

#include <cmath>
#include <map>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/files.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

TEST(WheelFeature, FindsTheHiddenTruthOfTheExample) {
  const auto run = example_runs() / "06_wheel";
  // The proud grain was left out of centre and radius alone: it is run-out and form.
  ASSERT_EQ(example_outcome("06_wheel").status, 1);
  const auto feature = nlohmann::json::parse(read(run / "report.json"))["features"][0];
  EXPECT_EQ(feature["characteristics"][0]["verdict"], "conforms");
  EXPECT_EQ(feature["characteristics"][1]["verdict"], "does not conform");
  EXPECT_EQ(feature["characteristics"][2]["verdict"], "does not conform");
  const auto& wheel = feature["wheel"];
  std::map<std::string, double> truth;
  for (const auto& value : journal_of(run).truth_values) truth[value.name] = value.value;
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
  EXPECT_GT(wheel["forecast"]["improvement"], 5.0);
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
