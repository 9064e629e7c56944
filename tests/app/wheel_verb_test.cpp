// `rondure fit wheel`, as a shell sees it.

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/files.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string kExample1 =
    std::string(RONDURE_SOURCE_DIR) + "/tests/data/spec_wheel/example1.csv";
const std::string kExample2 =
    std::string(RONDURE_SOURCE_DIR) + "/tests/data/spec_wheel/example2.csv";

Outcome fit_wheel(std::vector<std::string> more) {
  std::vector<std::string> arguments = {"fit", "wheel"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return rondure(arguments);
}

TEST(WheelVerb, GivesTheNumbersOfTheWorkedExamplesAsJson) {
  const auto one = fit_wheel({kExample1, "--mode", "indexed", "--axis-mm", "12.02,-7", "--center",
                              "as-published", "--json"});
  ASSERT_EQ(one.status, 0) << one.err;
  const auto document = nlohmann::json::parse(one.out);
  EXPECT_NEAR(document["center_mm"][0], 12.000438, 1.1e-6);
  EXPECT_NEAR(document["center_mm"][1], -6.998759, 1.1e-6);
  EXPECT_NEAR(document["radius_mm"], 50.0, 1.1e-6);
  EXPECT_NEAR(document["runout"]["fim_um"], 35.393, 1.6e-3);
  EXPECT_NEAR(document["effective_radius_mm"], 50.017696, 1.1e-6);
  EXPECT_EQ(document["quadruples"]["accepted"], 70);
  EXPECT_EQ(document["curves"]["deviations_um"].size(), 8U);
  EXPECT_FALSE(document.contains("path"));
  const auto two = fit_wheel({kExample2, "--mode", "indexed", "--robust", "--json"});
  ASSERT_EQ(two.status, 0) << two.err;
  const auto robust = nlohmann::json::parse(two.out);
  EXPECT_EQ(robust["center_by"], "least-squares");
  EXPECT_NEAR(robust["center_mm"][0], 0.500655, 1.1e-6);
  EXPECT_NEAR(robust["radius_mm"], 75.012471, 1.1e-6);
  EXPECT_EQ(robust["dropped"][0]["row"], 4);
  EXPECT_TRUE(robust["runout"].is_null());
  EXPECT_NE(robust["runout_absent"], "");
}

TEST(WheelVerb, WritesThePathAsTableAndAsGcode) {
  TemporaryFolder folder;
  const auto csv = folder / "path.csv";
  const auto gcode = folder / "path.nc";
  const auto out = fit_wheel({kExample1, "--mode", "indexed", "--nominal-radius-mm", "50.01",
                              "--surface", "asphere:R=120,K=-1,A4=2e-8", "--range-mm", "-40,40",
                              "--step-mm", "10", "--path", csv, "--gcode", gcode});
  ASSERT_EQ(out.status, 0) << out.err;
  EXPECT_THAT(out.out, HasSubstr("9 places for the mean radius 50.000000 mm"));
  EXPECT_THAT(out.out, HasSubstr("improvement"));
  const std::string table = read(csv);
  EXPECT_THAT(table, HasSubstr("x_mm,f_mm,slope,xc_mm,zc_mm,phi_deg,R_ks,clearance_um\n"));
  EXPECT_THAT(table, HasSubstr("\n-40,6.717866666666666,"));
  const std::string program = read(gcode);
  EXPECT_THAT(program, StartsWith("%\n"));
  EXPECT_THAT(program, HasSubstr("G21 G90 G94 G18\nG0 Z59.078783\nG0 X-23.970540\n"));
  EXPECT_THAT(program, HasSubstr("\nG1 X0.000000 Z50.000000\n"));
  EXPECT_THAT(program, HasSubstr("\nG0 Z59.078783\nM30\n%\n"));
}

TEST(WheelVerb, MeasuresTheWheelButGivesNoPathThatGouges) {
  TemporaryFolder folder;
  const auto csv = folder / "path.csv";
  const auto out = fit_wheel({kExample1, "--mode", "indexed", "--surface", "polynomial:0,0,0.0125",
                              "--range-mm", "-20,20", "--path", csv});
  EXPECT_EQ(out.status, 2);
  EXPECT_THAT(out.out, HasSubstr("R 50.000000 mm"));
  EXPECT_THAT(out.err,
              HasSubstr("50 mm exceeds the concave radius of curvature 40 mm at x = 0 mm"));
  EXPECT_EQ(read(csv), "");
}

TEST(WheelVerb, ReadsSurfaceAndRemovalTables) {
  TemporaryFolder folder;
  std::string surface = "x,z\n";
  std::string removal = "x,depth_um\n";
  for (int x = -30; x <= 30; ++x) {
    surface += std::to_string(x) + "," + std::to_string(x * x / 400.0) + "\n";
    removal += std::to_string(x) + ",2\n";
  }
  write(folder / "surface.csv", surface);
  write(folder / "removal.csv", removal);
  const auto out = fit_wheel({kExample1, "--mode", "indexed", "--surface",
                              "table:" + (folder / "surface.csv").string(), "--removal",
                              folder / "removal.csv", "--step-mm", "1", "--json"});
  ASSERT_EQ(out.status, 0) << out.err;
  const auto document = nlohmann::json::parse(out.out);
  EXPECT_EQ(document["path"]["places"], 61);
  EXPECT_NEAR(document["curves"]["path"]["f_mm"][30], -0.002, 1e-9);
  EXPECT_NEAR(document["path"]["greatest_R_ks"]["value"], 50.0 / 200.0, 1e-3);
}

TEST(WheelVerb, NamesWhatIsWrongWithTheInput) {
  TemporaryFolder folder;
  const auto file = folder / "wheel.csv";
  const auto said = [&](std::string_view text, std::vector<std::string> more = {}) {
    write(file, text);
    more.insert(more.begin(), {file.string(), "--mode", "indexed"});
    const auto out = fit_wheel(more);
    EXPECT_EQ(out.status, 2);
    EXPECT_EQ(out.out, "");
    return out.err;
  };
  EXPECT_THAT(said("x,z\n1,2\n3,4\n"), HasSubstr("there are 2 points, a wheel needs at least 8"));
  EXPECT_THAT(said("x,z\n1,2\nnan,4\n"), HasSubstr("wheel.csv:3"));
  EXPECT_THAT(said("x,q\n1,2\n"), HasSubstr("[syntax]"));
  EXPECT_THAT(said("x\n1\n"), HasSubstr("x,z or x,y"));
  std::string line = "x,z\n";
  for (int i = 0; i < 9; ++i) line += std::to_string(i) + "," + std::to_string(2 * i) + "\n";
  EXPECT_THAT(said(line), HasSubstr("[collinear]"));
  std::string um = "x,z\n";
  for (const auto* p : {"50000,0", "35355,35355", "0,50000", "-35355,35355", "-50000,0",
                        "-35355,-35355", "0,-50000", "35355,-35355"}) {
    um += std::string(p) + "\n";
  }
  EXPECT_THAT(said(um), HasSubstr("are the coordinates in um?"));
  const std::string good = read(kExample1);
  EXPECT_THAT(said(good, {"--nominal-radius-mm", "60"}), HasSubstr("[out-of-range]"));
  EXPECT_THAT(said(good, {"--path", "p.csv"}), HasSubstr("need --surface"));
  EXPECT_THAT(said(good, {"--surface", "asphere:R=abc"}), HasSubstr("R is \"abc\""));
  EXPECT_THAT(said(good, {"--surface", "asphere:Q=3"}), HasSubstr("there is \"Q=3\""));
  EXPECT_THAT(said(good, {"--surface", "sphere:3"}), HasSubstr("are known"));
  EXPECT_THAT(said(good, {"--surface", "polynomial:0,0,0.001"}),
              HasSubstr("--range-mm is missing"));
  const auto mode = rondure({"fit", "wheel", kExample1});
  EXPECT_EQ(mode.status, 2);
  EXPECT_THAT(mode.err, HasSubstr("--mode"));
  for (const char* axis : {"nan,0", "0,inf", "1e155,0"}) {
    const auto axis_mm =
        rondure({"fit", "wheel", kExample1, "--mode", "indexed", "--axis-mm", axis});
    EXPECT_EQ(axis_mm.status, 2);
    EXPECT_THAT(axis_mm.err, HasSubstr("is no number up to 1e+09"));
  }
  const auto envelope =
      rondure({"fit", "wheel", kExample1, "--mode", "envelope", "--axis-mm", "0,0"});
  EXPECT_EQ(envelope.status, 2);
  EXPECT_THAT(envelope.err, HasSubstr("run-out cannot be stated in envelope mode"));
}

TEST(WheelVerb, TheExamplePlanFindsItsHiddenTruth) {
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

}  // namespace
}  // namespace rondure::app::testing
