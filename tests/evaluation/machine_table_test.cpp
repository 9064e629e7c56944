// What leaves a run for a machine from three probes and from a wheel: the rows against what was
// planted and against the formulas of the method, and when nothing leaves.

#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "evaluation/analysis_result.h"
#include "evaluation/correction/corrections.h"
#include "evaluation/evaluate.h"
#include "record/tasks/settings.h"
#include "reports/data/corrections.h"
#include "tests/evaluation/points_run.h"
#include "tests/evaluation/simulated_analyses.h"

namespace rondure::reports {
namespace {

using core::kMicrometre;
using evaluation::SpindleRow;
using evaluation::SpindleTable;
using record::Form;
using record::SpindleTask;
using testing::HasSubstr;

constexpr auto kLayout = SpindleTask::Layout::kReference;

record::RunRecord probed(const SimulatedSpindle& world, std::uint64_t seed) {
  Normals draws(seed);
  SpindleTask task = spindle_task(kLayout, world);
  task.probe_noise_um = std::max(0.001, world.noise_um);
  return spindle_run(world, task, draws);
}

SpindleTable spindle_rows_of(const SimulatedSpindle& world, std::uint64_t seed = 1) {
  const auto found = evaluation::spindle_table(evaluated(probed(world, seed)).features[0]);
  if (!found) {
    ADD_FAILURE() << found.error().what;
    return {};
  }
  return *found;
}

Corrections given_by(const record::RunRecord& run) {
  return write_corrections(run, evaluated(run));
}

TEST(SpindleTable, HoldsThePlantedPartAndMotion) {
  const SimulatedSpindle world = worked_spindle(kLayout);
  const SpindleTable found = spindle_rows_of(world);
  ASSERT_EQ(found.rows.size(), SpindleTable::kRows);
  EXPECT_TRUE(found.missing.empty());
  for (const SpindleRow& row : found.rows) {
    const double beta = world.beta_rad(row.alpha_rad);
    const double theta = row.alpha_rad + beta;
    EXPECT_NEAR(std::remainder(row.theta_rad - theta, core::kTwoPi), 0.0, 1e-12);
    EXPECT_NEAR(row.profile_mm / kMicrometre, sum_um(world.profile, theta), 2e-3);
    EXPECT_NEAR(row.motion_x_mm / kMicrometre, sum_um(world.motion_x, row.alpha_rad), 2e-2);
    EXPECT_NEAR(row.motion_y_mm / kMicrometre, sum_um(world.motion_y, row.alpha_rad), 2e-2);
    // The wheel touches where the part is half a turn on.
    ASSERT_TRUE(row.command_mm);
    EXPECT_NEAR(*row.command_mm / kMicrometre,
                -sum_um(world.profile, theta + std::numbers::pi) / std::cos(beta), 2e-3);
  }
}

TEST(SpindleTable, OfAShaftOnCentresCommandsNoWheel) {
  SimulatedSpindle world = worked_spindle(kLayout);
  world.crank_mm = 0.0;
  const record::RunRecord run = probed(world, 1);
  const auto found = evaluation::spindle_table(evaluated(run).features[0]);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_FALSE(found->rows[40].command_mm);
  const Corrections made = given_by(run);
  ASSERT_EQ(made.tables.size(), 1U);
  EXPECT_EQ(made.tables[0].file, "corrections/measured-spindle-table.csv");
  EXPECT_THAT(made.tables[0].text, HasSubstr("\nalpha_deg,theta_deg,profile_um,RX_um,RY_um,"
                                             "u_profile_um,u_RX_um,u_RY_um\n0,"));
  EXPECT_THAT(made.tables[0].text,
              HasSubstr("\n# units: alpha_deg deg, theta_deg deg, others um; "));
  EXPECT_THAT(made.tables[0].text, HasSubstr("\n# sign: as found\n"));
  EXPECT_THAT(made.summary, HasSubstr("measured: corrections/measured-spindle-table.csv: "));
}

// The scatter of the rows over many runs is what they state.
TEST(SpindleTable, StatesTheScatterOfItsRows) {
  SimulatedSpindle world = worked_spindle(kLayout);
  const SpindleTable exact = spindle_rows_of(world);
  world.noise_um = 0.05;
  constexpr int kRuns = 12;
  double squares[3] = {};
  SpindleTable found;
  for (int k = 0; k < kRuns; ++k) {
    found = spindle_rows_of(world, 10 + static_cast<std::uint64_t>(k));
    for (std::size_t i = 0; i < SpindleTable::kRows; ++i) {
      squares[0] += std::pow(found.rows[i].profile_mm - exact.rows[i].profile_mm, 2);
      squares[1] += std::pow(found.rows[i].motion_x_mm - exact.rows[i].motion_x_mm, 2);
      squares[2] += std::pow(found.rows[i].motion_y_mm - exact.rows[i].motion_y_mm, 2);
    }
  }
  const double count = static_cast<double>(kRuns * SpindleTable::kRows);
  EXPECT_NEAR(std::sqrt(squares[0] / count) / found.u_profile_mm, 1.0, 0.15);
  EXPECT_NEAR(std::sqrt(squares[1] / count) / found.u_motion_x_mm, 1.0, 0.15);
  EXPECT_NEAR(std::sqrt(squares[2] / count) / found.u_motion_y_mm, 1.0, 0.15);
}

TEST(SpindleTable, OfReadingsThatContradictTheirProbesLeavesNoRun) {
  SimulatedSpindle world = worked_spindle(kLayout);
  world.gains_1[1] = 1.2;
  const Corrections made = given_by(probed(world, 1));
  EXPECT_TRUE(made.tables.empty());
  EXPECT_THAT(made.summary, HasSubstr("measured: none: "));
}

// ---- Wheel --------------------------------------------------------------------------------------

/// z = x^2 / 240.
record::WheelTask grinding() {
  record::WheelTask task;
  task.nominal_radius_mm = 50.0;
  record::GroundSurfaceTask& surface = task.surface.emplace();
  surface.coefficients = {0.0, 0.0, 1.0 / 240.0};
  surface.from_mm = -40.0;
  surface.to_mm = 40.0;
  surface.step_mm = 0.5;
  task.program.emplace().feed_mm_min = 250.0;
  return task;
}

record::RunRecord ground(const record::WheelTask& task) {
  Normals draws(4);
  return wheel_run(worked_wheel(whole_turn()), task, draws);
}

struct PathPlace {
  double x = 0.0;
  double xc = 0.0;
  double zc = 0.0;
};

std::vector<PathPlace> places_of(const std::string& csv) {
  std::vector<PathPlace> out;
  std::istringstream lines(csv.substr(csv.find("\nx_mm,") + 1));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::vector<double> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(std::stod(cell));
    out.push_back({cells.at(0), cells.at(3), cells.at(4)});
  }
  return out;
}

double radius_of(const record::RunRecord& run) {
  return std::get<evaluation::WheelResult>(evaluated(run).features[0].analysis->found)
      .evaluation.path->radius_mm;
}

TEST(WheelPathTable, IsThePathOfTheFoundRadius) {
  const record::RunRecord run = ground(grinding());
  const Corrections made = given_by(run);
  ASSERT_EQ(made.tables.size(), 2U) << made.summary;
  EXPECT_EQ(made.tables[0].file, "corrections/measured-wheel-path.csv");
  EXPECT_EQ(made.tables[1].file, "corrections/measured-wheel-path.nc");
  EXPECT_THAT(made.tables[0].text, HasSubstr("\n# sign: places of the wheel, not differences\n"));
  EXPECT_THAT(made.tables[0].text, HasSubstr("\n# units: mm, phi_deg deg, clearance_um um\n"));
  const double radius = radius_of(run);
  EXPECT_NEAR(radius, worked_wheel({}).radius_mm, 1e-3);
  const std::vector<PathPlace> places = places_of(made.tables[0].text);
  ASSERT_EQ(places.size(), 161U);
  std::istringstream program(made.tables[1].text);
  std::string line;
  while (std::getline(program, line) && !line.starts_with("G1")) {
  }
  EXPECT_THAT(line, HasSubstr("F250"));
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double slope = places[i].x / 120.0;
    const double q = std::sqrt(1.0 + slope * slope);
    EXPECT_NEAR(places[i].xc, places[i].x - radius * slope / q, 1e-9);
    EXPECT_NEAR(places[i].zc, places[i].x * places[i].x / 240.0 + radius / q, 1e-9);
    if (i == 0) continue;
    std::getline(program, line);
    double xc = 0.0;
    double zc = 0.0;
    ASSERT_EQ(std::sscanf(line.c_str(), "G1 X%lf Z%lf", &xc, &zc), 2) << line;
    EXPECT_NEAR(xc, places[i].xc, 1e-6);
    EXPECT_NEAR(zc, places[i].zc, 1e-6);
  }
  EXPECT_THAT(made.summary, HasSubstr("measured-wheel-path.nc: form "));
}

TEST(WheelPathTable, MayBeOfTheLowestPointOfTheWheel) {
  record::WheelTask task = grinding();
  task.program->lowest_point = record::Switch::kOn;
  const record::RunRecord run = ground(task);
  const std::vector<PathPlace> lowest = places_of(given_by(run).tables.at(0).text);
  const std::vector<PathPlace> centre = places_of(given_by(ground(grinding())).tables.at(0).text);
  EXPECT_NEAR(centre[7].zc - lowest[7].zc, radius_of(run), 1e-9);
  task.program.reset();
  EXPECT_EQ(given_by(ground(task)).tables.size(), 1U) << "no program was asked for";
}

TEST(WheelPathTable, LeavesNoRunThatDoesNotConformOrHasNoPath) {
  record::RunRecord eccentric = ground(grinding());
  eccentric.features[0].characteristics = {asked(Form::kRunOut, 1.0)};
  EXPECT_THAT(given_by(eccentric).summary, HasSubstr("none: run-out does not conform"));
  EXPECT_TRUE(given_by(eccentric).tables.empty());

  record::WheelTask hollow = grinding();
  hollow.surface->coefficients = {0.0, 0.0, 1.0 / 60.0};  // radius 30 mm, the wheel has 50
  EXPECT_THAT(given_by(ground(hollow)).summary, HasSubstr("none: "));
  EXPECT_TRUE(given_by(ground(hollow)).tables.empty());

  record::WheelTask nothing = grinding();
  nothing.surface.reset();
  nothing.program.reset();
  EXPECT_THAT(given_by(ground(nothing)).summary, HasSubstr("none: no surface is to be ground"));
}

}  // namespace
}  // namespace rondure::reports
