// rondure fit rotary-axes: the worked example, a two-axis fixture, refusals.
#include <array>
#include <cmath>
#include <random>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/files.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

std::string rotary_data(const char* name) {
  return (fs::path(RONDURE_SOURCE_DIR) / "tests/data/spec_rotary" / name).string();
}

json found_in(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"fit", "rotary-axes"});
  arguments.emplace_back("--json");
  const Outcome outcome = rondure(arguments);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return json::parse(outcome.out);
}

TEST(FitRotaryAxes, GivesTheWorkedExample) {
  const std::array<double, 3> t = {-11.61714, -13.50248, 0.46303};
  const std::array<double, 3> w = {-11.08, -58.20, 4.27};
  for (const char* method : {"exact", "linear", "as-published"}) {
    SCOPED_TRACE(method);
    const bool exact = std::string(method) == "exact";
    const json axis = found_in({rotary_data("c_axis.csv"), "--method", method}).at("axes").at(0);
    const json& station = axis.at("stations").at(3);
    EXPECT_EQ(station.at("station_deg"), 45.0);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(station.at("t_um").at(k), t[k], exact ? 2e-5 : 0.002);
      EXPECT_NEAR(station.at("w_urad").at(k), w[k], exact ? 0.006 : 0.012);
    }
    EXPECT_NEAR(axis.at("offset").at("d_um").at(0), 12.0, 0.005);
    EXPECT_NEAR(axis.at("offset").at("d_um").at(1), -20.0, 0.005);
    EXPECT_TRUE(axis.at("full_circle"));
    EXPECT_EQ(axis.at("curve_points").size(), 73U);
  }
}

// A plate is turned as a whole; balls that were set up one by one say less of it, and a tool that
// is set wrong looks like an error away from the reference pose.
TEST(FitRotaryAxes, HoldsRepeatabilityAndToolsWhereTheyAreStated) {
  const auto station = [](std::vector<std::string> options, std::size_t at) {
    options.insert(options.begin(), rotary_data("c_axis.csv"));
    return found_in(options).at("axes").at(0).at("stations").at(at);
  };
  const auto u = [](const json& of, const char* key, std::size_t k) {
    return of.at(key).at(k).get<double>();
  };
  const json plain = station({}, 3);
  const json plate = station({"--repeat-urad", "3"}, 3);
  EXPECT_NEAR(std::pow(u(plate, "u_w_urad", 2), 2) - std::pow(u(plain, "u_w_urad", 2), 2),
              9.0 * (1.0 + 1.0 / 3.0), 1e-6);
  EXPECT_NEAR(u(plate, "u_t_um", 2), u(plain, "u_t_um", 2), 1e-9);
  const json tools = station({"--tool-um", "0.3"}, 3);
  EXPECT_GT(u(tools, "u_t_um", 0), u(plain, "u_t_um", 0));
  EXPECT_NEAR(u(station({"--tool-um", "0.3"}, 0), "u_t_um", 0), u(station({}, 0), "u_t_um", 0),
              1e-9);
  EXPECT_EQ(tools.at("t_um"), plain.at("t_um"));
}

TEST(FitRotaryAxes, FindsThePlantedFixtureWithinItsUncertainties) {
  const json axes = found_in({rotary_data("fixture.csv"), "--origin", "250,180,320"}).at("axes");
  ASSERT_EQ(axes.size(), 2U);
  const auto wave = [](double phi, double a, double q) {
    return a * (std::cos(2.0 * phi - q) - std::cos(q));
  };
  for (std::size_t i = 0; i < 2; ++i) {
    const json& axis = axes.at(i);
    EXPECT_EQ(axis.at("axis"), i == 0 ? "phi_alpha" : "phi_beta");
    EXPECT_EQ(axis.at("direction").at(i), 1.0);
    EXPECT_NEAR(axis.at("hysteresis_um").at(2), 1.0, 0.15);
    // The component along the axis has no share of its offset: the planted motion alone.
    for (const json& station : axis.at("stations")) {
      const double phi = station.at("station_deg").get<double>() * 3.14159265358979 / 180.0;
      const auto k = static_cast<double>(i);
      EXPECT_NEAR(station.at("t_um").at(i), wave(phi, 2.5 - 0.5 * k, 0.4 + k),
                  4.0 * station.at("u_t_um").at(i).get<double>());
      EXPECT_NEAR(station.at("w_urad").at(i), wave(phi, 12.0 - 3.0 * k, 1.0 - k),
                  4.0 * station.at("u_w_urad").at(i).get<double>());
      EXPECT_TRUE(station.at("removed").empty());
    }
    EXPECT_EQ(axis.at("stations").size(), 26U);
  }
}

TEST(FitRotaryAxes, SaysWhyThereIsNoIntervalAndWhichPlanGivesIt) {
  const Outcome text = rondure({"fit", "rotary-axes", rotary_data("c_axis.csv")});
  EXPECT_THAT(text.out, HasSubstr("no interval is stated: "));
  EXPECT_THAT(found_in({rotary_data("c_axis.csv")}).at("no_interval_because").get<std::string>(),
              HasSubstr("rotary_axes.uncertainty"));
}

TEST(FitRotaryAxes, WarnsWhereTheBallsAgreeBetterThanTheirUncertaintyAllows) {
  const Scratch folder;
  // The centres of the worked example are exact: with noise of their u, in mm and in inches.
  const auto warnings_of = [&](double mm_per_unit) {
    std::istringstream lines(read(rotary_data("c_axis.csv")));
    std::string out;
    std::mt19937 bits(3);
    for (std::string line; std::getline(lines, line); out += line + "\n") {
      if (!line.starts_with("C,")) continue;
      std::vector<std::string> cells;
      std::istringstream row(line);
      for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
      for (std::size_t i = 3; i < 6; ++i) {
        const double uniform = 2.0 * static_cast<double>(bits()) / 4294967296.0 - 1.0;
        const double read_mm = std::stod(cells[i]) + 0.5e-3 * std::sqrt(3.0) * uniform;
        cells[i] = fmt::format("{}", read_mm / mm_per_unit);
      }
      line = fmt::format("{}", fmt::join(cells, ","));
    }
    write(folder / "in.csv", out);
    return found_in({(folder / "in.csv").string()}).at("axes").at(0).at("warnings").dump();
  };
  EXPECT_THAT(warnings_of(25.4), HasSubstr("are the centres in mm"));
  EXPECT_THAT(warnings_of(1.0), Not(HasSubstr("are the centres in mm")));
}

TEST(FitRotaryAxes, TableFitsATerminal) {
  const Outcome outcome = rondure({"fit", "rotary-axes", rotary_data("fixture.csv"), "--origin",
                                   "250,180,320", "--at", "250,180,380"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  std::size_t start = 0;
  while (start < outcome.out.size()) {
    const std::size_t end = outcome.out.find('\n', start);
    EXPECT_LE(end - start, 80U) << outcome.out.substr(start, end - start);
    start = end + 1;
  }
  EXPECT_THAT(outcome.out, HasSubstr("Axis phi_beta along (0, 1, 0): 26 stations, 5 balls, arc"));
  EXPECT_THAT(outcome.out, HasSubstr("at (250, 180, 380) mm a point is known to"));
}

TEST(FitRotaryAxes, RefusesBadInput) {
  const Scratch folder;
  const std::string good = read(rotary_data("c_axis.csv"));
  const auto refusal = [&](const std::string& text, std::vector<std::string> more = {}) {
    write(folder / "in.csv", text);
    more.insert(more.begin(), {"fit", "rotary-axes", (folder / "in.csv").string()});
    const Outcome outcome = rondure(more);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.out, IsEmpty());
    return outcome.err;
  };
  const auto without = [&](std::string_view part) {
    std::string out;
    std::size_t start = 0;
    while (start < good.size()) {
      const std::size_t end = good.find('\n', start) + 1;
      const std::string line = good.substr(start, end - start);
      if (line.find(part) == std::string::npos) out += line;
      start = end;
    }
    return out;
  };
  EXPECT_THAT(refusal(without(",C,")),
              HasSubstr("add a ball off the line through A and B, at least"));
  EXPECT_THAT(refusal(without("reference")), HasSubstr("reference pose is missing"));
  EXPECT_THAT(refusal(good + "C,345,A,0,0,0,0.5\n"), HasSubstr("ball A stands twice at 345 deg"));
  EXPECT_THAT(refusal(good + "C,400,D,0,0,0,0.5\n"), HasSubstr("not measured in the reference"));
  EXPECT_THAT(refusal(good, {"--axis", "0,0,-1"}), HasSubstr("opposite sense"));
  EXPECT_THAT(refusal(good, {"--axis", "up"}), HasSubstr("--axis up"));
  EXPECT_THAT(refusal(good, {"--axis", "0,0,0"}), HasSubstr("no direction"));
  EXPECT_THAT(refusal(good, {"--range-deg", "0,90"}), HasSubstr("outside the range of the axis"));
  EXPECT_THAT(refusal(good, {"--curve", "polynomial"}), HasSubstr("full circle"));
  EXPECT_THAT(refusal(good, {"--origin", "1,2"}), HasSubstr("three numbers"));
  EXPECT_THAT(refusal("axis,station_deg,ball,x_mm,y_mm,z_inch,u_um\n"), HasSubstr("not in mm"));
  EXPECT_THAT(refusal("axis,station_deg,ball,x_mm,y_mm,z_mm,u_um\nturn,0,a,1,2,3,1\n"),
              HasSubstr("give --axis"));
  const Outcome fixture =
      rondure({"fit", "rotary-axes", rotary_data("fixture.csv"), "--axis", "x"});
  EXPECT_EQ(fixture.status, 2);
  EXPECT_THAT(fixture.err, HasSubstr("phi_alpha and phi_beta"));
  const Outcome help = rondure({"fit", "rotary-axes", "--help"});
  EXPECT_EQ(help.status, 0);
  EXPECT_THAT(help.out, HasSubstr("Example: rondure fit rotary-axes"));
}

}  // namespace
}  // namespace rondure::app::testing
