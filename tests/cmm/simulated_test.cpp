#include "cmm/simulated/machine.h"

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cmm/scan_path.h"
#include "core/units.h"
#include "random_parts.h"

namespace rondure::cmm {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

PartSurface plain_shaft() {
  PartSurface part;
  part.radius_mm = 25.0;
  part.half_length_mm = 40.0;
  return part;
}

void place_shaft(SimulatedMachine& machine) {
  machine.place_part(plain_shaft(), Eigen::Isometry3d::Identity());
}

/// A touch of the plain shaft from +x at mid-length; the tip must stand at x = 30 first.
TouchCommand touch_from_x(std::int64_t id) {
  return {id, {27.0, 0.0, 0.0}, -Vector3d::UnitX(), 3.0, 3.0};
}

void go_to_x30(SimulatedMachine& machine) {
  ASSERT_TRUE(machine.home());
  ASSERT_TRUE(machine.move_to({30.0, 0.0, 500.0}));
  ASSERT_TRUE(machine.move_to({30.0, 0.0, 0.0}));
}

TEST(SimulatedMachine, TouchesTheSurfaceWhereItIs) {
  SimulatedMachine machine({});
  place_shaft(machine);
  go_to_x30(machine);
  const auto reading = machine.touch(touch_from_x(1));
  ASSERT_TRUE(reading);
  EXPECT_EQ(reading->tip_W_mm, Vector3d(27.0, 0.0, 0.0)) << "on the grid";
  EXPECT_NEAR(machine.true_tip_W_mm().x(), 27.0, 1e-12);
  EXPECT_EQ(reading->temperature_degC, 20.0);
  EXPECT_EQ(machine.position_W_mm(), Vector3d(30.0, 0.0, 0.0));
}

TEST(SimulatedMachine, TouchesATiltedPartWhereItReallyStands) {
  core::KeyedNoise random(1, {1});
  const PartSurface part = random_part(random, false);
  Eigen::Isometry3d X_WP = Eigen::Isometry3d::Identity();
  X_WP.translate(Vector3d(200, 150, 80)).rotate(Eigen::AngleAxisd(0.3, Vector3d::UnitX()));
  SimulatedMachine machine({});
  machine.place_part(part, X_WP);
  ASSERT_TRUE(machine.home());
  const double r = part.radius_mm + 2.0;
  const Vector3d expected = X_WP * Vector3d(0.0, r, 5.0);
  const Vector3d d = X_WP.linear() * -Vector3d::UnitY();
  ASSERT_TRUE(machine.move_to(X_WP * Vector3d(0.0, r + 3.0, 300.0)));
  ASSERT_TRUE(machine.move_to(expected - 3.0 * d));
  const auto reading = machine.touch({1, expected, d, 3.0, 3.0});
  ASSERT_TRUE(reading);
  const Vector3d tip_P = X_WP.inverse() * reading->tip_W_mm;
  EXPECT_NEAR(tip_P.y(), part.radius_at(M_PI / 2, 5.0) + 2.0, 1e-4);  // the wave is gentle
}

TEST(SimulatedMachine, UsesTheRealTipRadius) {
  SimulatedMachineOptions options;
  options.errors.tip_radius_error_mm = -0.0016;
  SimulatedMachine machine(options);
  place_shaft(machine);
  go_to_x30(machine);
  EXPECT_NEAR(machine.touch(touch_from_x(1))->tip_W_mm.x(), 26.9984, 1e-12);
}

TEST(SimulatedMachine, ClockAdvancesByDistanceAndSpeed) {
  SimulatedMachine machine({});
  place_shaft(machine);
  EXPECT_EQ(machine.time_s(), 0.0);
  go_to_x30(machine);
  EXPECT_NEAR(machine.time_s(), 0.3 + 5.0, 1e-12);
  const auto reading = machine.touch(touch_from_x(1));
  EXPECT_NEAR(reading->time_s, 5.3 + 3.0 / 5.0, 1e-12);
  EXPECT_NEAR(machine.time_s(), 5.3 + 3.0 / 5.0 + 3.0 / 100.0 + 0.2, 1e-12);
}

TEST(SimulatedMachine, NoiseHasTheStatedDeviationAlongTheApproachOnly) {
  SimulatedMachineOptions options;
  options.errors.repeatability_mm = 0.001;
  SimulatedMachine machine(options);
  place_shaft(machine);
  go_to_x30(machine);
  const int n = 4000;
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < n; ++i) {
    const auto reading = machine.touch(touch_from_x(i));
    ASSERT_TRUE(reading);
    const Vector3d noise = reading->tip_W_mm - machine.true_tip_W_mm();
    EXPECT_EQ(noise.y(), 0.0);
    EXPECT_EQ(noise.z(), 0.0);
    sum += noise.x();
    squares += noise.x() * noise.x();
  }
  const double four_sigma = 4.0 / std::sqrt(n);
  EXPECT_LT(std::abs(sum / n) / 0.001, four_sigma);
  EXPECT_NEAR(std::sqrt(squares / n) / 0.001, 1.0, four_sigma / std::sqrt(2.0));
}

TEST(SimulatedMachine, NoiseDependsOnSeedAndTouchNotOnOrder) {
  SimulatedMachineOptions options;
  options.errors.repeatability_mm = 0.001;
  SimulatedMachine one(options);
  place_shaft(one);
  SimulatedMachine two(options);
  place_shaft(two);
  options.seed = 2;
  SimulatedMachine other(options);
  place_shaft(other);
  go_to_x30(one);
  go_to_x30(two);
  go_to_x30(other);
  ASSERT_TRUE(one.touch(touch_from_x(6)));
  const Vector3d seventh = one.touch(touch_from_x(7))->tip_W_mm;
  EXPECT_EQ(two.touch(touch_from_x(7))->tip_W_mm, seventh);
  EXPECT_NE(two.touch(touch_from_x(8))->tip_W_mm, seventh);
  EXPECT_NE(other.touch(touch_from_x(7))->tip_W_mm, seventh);
}

TEST(SimulatedMachine, StopsJustBeforeAPartInItsWay) {
  SimulatedMachine machine({});
  place_shaft(machine);
  go_to_x30(machine);
  const auto crash = machine.move_to({-30.0, 0.0, 0.0});
  ASSERT_FALSE(crash);
  EXPECT_EQ(crash.error().code, core::Code::kCollision);
  EXPECT_EQ(crash.error().what,
            "the tip met the part at (25.000, 0.000, 0.000) mm on the move to (-30.000, 0.000, "
            "0.000) mm; the machine stopped at (27.000, 0.000, 0.000) mm");
  EXPECT_NEAR(machine.position_W_mm().x(), 27.0, 3e-6);
  EXPECT_NEAR(machine.time_s(), 5.3 + 0.03, 1e-6);
  EXPECT_TRUE(machine.move_to({30.0, 0.0, 0.0})) << "the way back is free";
}

TEST(SimulatedMachine, StopsBeforeTheFlatEndOfAPart) {
  SimulatedMachine machine({});
  place_shaft(machine);
  ASSERT_TRUE(machine.home());
  const auto crash = machine.move_to({0.0, 0.0, 20.0});
  ASSERT_FALSE(crash);
  EXPECT_THAT(crash.error().what, HasSubstr("met the part at (0.000, 0.000, 40.000) mm"));
}

TEST(SimulatedMachine, MayGrazeASurfaceByAMicrometreThousandthButNotMore) {
  SimulatedMachine machine({});
  place_shaft(machine);
  go_to_x30(machine);
  EXPECT_TRUE(machine.move_to({27.0 - 0.9e-6, 0.0, 0.0}));
  EXPECT_FALSE(machine.move_to({27.0 - 1.1e-6, 0.0, 0.0}));
}

TEST(SimulatedMachine, StopsBeforeTheReferenceSphere) {
  SimulatedMachine machine({});
  machine.place_references({{{0, 0, 100}, 12.5}});
  ASSERT_TRUE(machine.home());
  const auto crash = machine.move_to({0.0, 0.0, 0.0});
  ASSERT_FALSE(crash);
  EXPECT_THAT(crash.error().what, HasSubstr("met the reference sphere at (0.000, 0.000, 112.500)"));
  ASSERT_TRUE(machine.move_to({0.0, 0.0, 117.5}));
  const auto reading = machine.touch({1, {0, 0, 114.5}, -Vector3d::UnitZ(), 3.0, 3.0});
  ASSERT_TRUE(reading);
  EXPECT_NEAR(reading->tip_W_mm.z(), 114.5, 1e-12);
}

TEST(SimulatedMachine, NamesTheReferenceBodyThatItMet) {
  using Shape = ReferenceBody::Shape;
  const Vector3d center(0.0, 0.0, 100.0);
  for (const auto& [body, name] : std::vector<std::pair<ReferenceBody, std::string>>{
           {{center, 12.5, Shape::kColumn, 10.0}, "the reference column or dowel at"},
           {{center, 1.0, Shape::kHole, 10.0}, "the block of a hole at"},
           {{center, 10.0, Shape::kSpot}, "the seat at"}}) {
    SimulatedMachine machine({});
    machine.place_references({body});
    ASSERT_TRUE(machine.home());
    const auto crash = machine.move_to({0.0, 0.0, 0.0});
    ASSERT_FALSE(crash);
    EXPECT_THAT(crash.error().what, HasSubstr("met " + name));
  }
  // A wide hole lets the tip through, which touches it from inside.
  SimulatedMachine machine({});
  machine.place_references({{center, 8.0, Shape::kHole, 10.0}});
  ASSERT_TRUE(machine.home());
  ASSERT_TRUE(machine.move_to(center));
  const auto reading = machine.touch({1, {6.0, 0.0, 100.0}, Vector3d::UnitX(), 6.0, 3.0});
  ASSERT_TRUE(reading) << reading.error().what;
  EXPECT_NEAR(reading->tip_W_mm.x(), 6.0, 1e-9);
}

TEST(SimulatedMachine, TouchesWhatComesFirst) {
  SimulatedMachine machine({});
  place_shaft(machine);
  machine.place_references({{{28.0, 0.0, 0.0}, 1.0}});
  ASSERT_TRUE(machine.home());
  ASSERT_TRUE(machine.move_to({34.0, 0.0, 500.0}));
  ASSERT_TRUE(machine.move_to({34.0, 0.0, 0.0}));
  const auto reading = machine.touch({1, {29.0, 0, 0}, -Vector3d::UnitX(), 5.0, 5.0});
  ASSERT_TRUE(reading);
  EXPECT_NEAR(reading->tip_W_mm.x(), 31.0, 1e-12);
}

TEST(SimulatedMachine, SaysWhereItSearchedInVain) {
  SimulatedMachine machine({});
  place_shaft(machine);
  ASSERT_TRUE(machine.home());
  ASSERT_TRUE(machine.move_to({40.0, 0.0, 500.0}));
  ASSERT_TRUE(machine.move_to({40.0, 0.0, 0.0}));
  const double before_s = machine.time_s();
  const auto missed = machine.touch({1, {37.0, 0, 0}, -Vector3d::UnitX(), 3.0, 3.0});
  ASSERT_FALSE(missed);
  EXPECT_EQ(missed.error().code, core::Code::kNoTouch);
  EXPECT_EQ(missed.error().what,
            "no contact within 3.000 mm beyond the expected surface (search from (40.000, 0.000, "
            "0.000) mm to (34.000, 0.000, 0.000) mm)");
  EXPECT_EQ(machine.position_W_mm(), Vector3d(40.0, 0.0, 0.0));
  EXPECT_NEAR(machine.time_s() - before_s, 6.0 / 5.0 + 6.0 / 100.0, 1e-12);
}

TEST(SimulatedMachine, RefusesATouchThatStartsInContact) {
  SimulatedMachine machine({});
  ASSERT_TRUE(machine.home());
  ASSERT_TRUE(machine.move_to({26.0, 0.0, 0.0}));
  machine.place_part(plain_shaft(), Eigen::Isometry3d::Identity());
  const auto touch = machine.touch({1, {23.0, 0, 0}, -Vector3d::UnitX(), 3.0, 3.0});
  ASSERT_FALSE(touch);
  EXPECT_EQ(touch.error().code, core::Code::kCollision);
  const auto move = machine.move_to({40.0, 0.0, 0.0});
  ASSERT_FALSE(move);
  EXPECT_EQ(move.error().code, core::Code::kCollision);
  EXPECT_THAT(move.error().what, HasSubstr("did not move"));
}

TEST(SimulatedMachine, RefusesCommandsThatMakeNoSense) {
  SimulatedMachine machine({});
  place_shaft(machine);
  go_to_x30(machine);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(machine.move_to({nan, 0, 0}).error().code, core::Code::kMachine);
  TouchCommand command = touch_from_x(1);
  command.expected_tip_W_mm.z() = nan;
  EXPECT_EQ(machine.touch(command).error().code, core::Code::kMachine);
  command = touch_from_x(1);
  command.direction_W *= 1.1;
  EXPECT_THAT(machine.touch(command).error().what, HasSubstr("length 1.1, not 1"));
  command = touch_from_x(1);
  command.expected_tip_W_mm.y() += 2e-6;
  EXPECT_THAT(machine.touch(command).error().what, HasSubstr("move there first"));
  command = touch_from_x(1);
  command.search_mm = -4.0;
  EXPECT_EQ(machine.touch(command).error().code, core::Code::kMachine);
  EXPECT_EQ(machine.position_W_mm(), Vector3d(30.0, 0.0, 0.0));
}

TEST(SimulatedMachine, HomeLeavesUpwardsAndParks) {
  SimulatedMachine machine({});
  place_shaft(machine);
  go_to_x30(machine);
  ASSERT_TRUE(machine.home());
  EXPECT_EQ(machine.position_W_mm(), Vector3d(0.0, 0.0, 500.0));
  EXPECT_NEAR(machine.time_s(), 0.3 + 5.0 + 5.0 + 0.3, 1e-12);
}

TEST(SimulatedMachine, ContinuesAfterAReadingAsIfItHadMadeTheTouch) {
  SimulatedMachineOptions options;
  options.errors.repeatability_mm = 0.001;
  for (std::int64_t id = 0; id < 50; ++id) {
    SimulatedMachine touched(options);
    place_shaft(touched);
    go_to_x30(touched);
    const auto reading = touched.touch(touch_from_x(id));
    ASSERT_TRUE(reading);
    SimulatedMachine resumed(options);
    place_shaft(resumed);
    go_to_x30(resumed);
    ASSERT_TRUE(resumed.home());  // its clock has gone another way
    ASSERT_TRUE(resumed.continue_after(touch_from_x(id), *reading));
    EXPECT_EQ(resumed.time_s(), touched.time_s());
    EXPECT_EQ(resumed.true_tip_W_mm(), touched.true_tip_W_mm());
    EXPECT_EQ(resumed.position_W_mm(), options.park_W_mm) << "nothing has moved";
  }
}

TEST(SimulatedMachine, DoesNotContinueAfterATouchOfNothing) {
  SimulatedMachine machine({});
  const auto on = machine.continue_after(touch_from_x(1), {});
  ASSERT_FALSE(on);
  EXPECT_EQ(on.error().code, core::Code::kNoTouch);
}

TEST(SimulatedMachine, AnswersNothingOnceTheLineIsLost) {
  SimulatedMachineOptions options;
  options.lost_at_touch = 3;
  SimulatedMachine machine(options);
  place_shaft(machine);
  go_to_x30(machine);
  EXPECT_TRUE(machine.touch(touch_from_x(0)));
  EXPECT_TRUE(machine.touch(touch_from_x(1)));
  EXPECT_EQ(machine.touch(touch_from_x(2)).error().code, core::Code::kMachine);
  EXPECT_EQ(machine.move_to({40.0, 0.0, 0.0}).error().code, core::Code::kMachine);
  EXPECT_THAT(machine.home().error().what, HasSubstr("connection is lost"));
  EXPECT_EQ(machine.position_W_mm(), Vector3d(30.0, 0.0, 0.0));
}

TEST(SimulatedMachine, ContinuesAfterAScanAsIfItHadMadeIt) {
  SimulatedMachineOptions options;
  options.errors.repeatability_mm = 0.001;
  options.scan_scatter = {1.0 * core::kDegree, 0.03, 0.02};
  ScanCircleCommand command;
  command.start_tip_W_mm = {27.0, 0.0, 0.0};
  command.sweep_rad = core::kTwoPi;
  command.points = 100;
  SimulatedMachine scanned(options);
  place_shaft(scanned);
  go_to_x30(scanned);
  const auto readings = scanned.scan_circle(command);
  ASSERT_TRUE(readings);
  SimulatedMachine resumed(options);
  place_shaft(resumed);
  ASSERT_TRUE(resumed.home());
  ASSERT_TRUE(resumed.continue_after(command, readings->back()));
  EXPECT_EQ(resumed.time_s(), scanned.time_s());
  EXPECT_EQ(resumed.true_tips_W_mm(), scanned.true_tips_W_mm());
  EXPECT_EQ(scanned.true_tips_W_mm().size(), readings->size());
}

TEST(SimulatedMachine, AScanLiesWhereItsScatterPutsIt) {
  SimulatedMachineOptions options;
  options.scan_scatter = {1.0 * core::kDegree, 0.03, 0.02};
  SimulatedMachine machine(options);
  place_shaft(machine);
  go_to_x30(machine);
  ScanCircleCommand command;
  command.start_tip_W_mm = {27.0, 0.0, 0.0};
  command.sweep_rad = core::kTwoPi;
  command.points = 360;
  std::size_t points = 0;
  double farthest_start_deg = 0.0;
  std::vector<Vector3d> first;
  for (int scan = 0; scan < 100; ++scan) {
    command.first_id = 1000 * scan;
    const auto readings = machine.scan_circle(command);
    ASSERT_TRUE(readings) << readings.error().what;
    points += readings->size();
    double before_deg = scan_angle(command, readings->front().tip_W_mm) / core::kDegree;
    // A first point that is missing leaves the second one first.
    if (before_deg < 0.9) farthest_start_deg = std::max(farthest_start_deg, std::abs(before_deg));
    EXPECT_LT(std::abs(before_deg), 4.0);
    for (std::size_t i = 1; i < readings->size(); ++i) {
      const double angle_deg = scan_angle(command, (*readings)[i].tip_W_mm) / core::kDegree;
      const double step_deg = std::remainder(angle_deg - before_deg, 360.0);
      before_deg = angle_deg;
      const double missing = std::round(step_deg) - 1.0;  // points between these two
      ASSERT_NEAR(step_deg, missing + 1.0, 0.03 * (missing + 1.0) + 1e-9);
      ASSERT_NEAR((*readings)[i].tip_W_mm.norm(), 27.0, 1e-9);
    }
    if (scan == 0) {
      for (const TouchReading& reading : *readings) first.push_back(reading.tip_W_mm);
    }
  }
  EXPECT_NEAR(static_cast<double>(points), 0.98 * 36'000.0, 4.0 * std::sqrt(0.02 * 36'000.0));
  EXPECT_GT(farthest_start_deg, 0.8);
  command.first_id = 0;
  const auto again = machine.scan_circle(command);
  ASSERT_TRUE(again);
  ASSERT_EQ(again->size(), first.size()) << "the places are those of the number of the scan";
  EXPECT_EQ(again->back().tip_W_mm, first.back());
}

TEST(SimulatedMachine, ScansAtTheScanSpeed) {
  SimulatedMachineOptions options;
  options.speeds.scan_mm_s = 20.0;
  SimulatedMachine machine(options);
  place_shaft(machine);
  go_to_x30(machine);
  ScanCircleCommand command;
  command.start_tip_W_mm = {27.0, 0.0, 0.0};
  command.sweep_rad = core::kTwoPi;
  command.points = 54;
  const double before_s = machine.time_s();
  const auto readings = machine.scan_circle(command);
  ASSERT_TRUE(readings);
  EXPECT_NEAR(readings->front().time_s, before_s + 3.0 / 5.0, 1e-9);
  EXPECT_NEAR(readings->back().time_s - readings->front().time_s,
              53.0 / 54.0 * core::kTwoPi * 27.0 / 20.0, 1e-8);
  EXPECT_NEAR(machine.time_s() - readings->front().time_s,
              core::kTwoPi * 27.0 / 20.0 + 3.0 / 100.0 + 0.2, 1e-8);
}

TEST(SimulatedMachine, NoiseOfAScanIsThatOfItsPoints) {
  SimulatedMachineOptions options;
  options.errors.repeatability_mm = 0.001;
  SimulatedMachine machine(options);
  place_shaft(machine);
  go_to_x30(machine);
  ScanCircleCommand command;
  command.first_id = 5;
  command.start_tip_W_mm = {27.0, 0.0, 0.0};
  command.sweep_rad = core::kTwoPi;
  command.points = 10;
  const auto readings = machine.scan_circle(command);
  ASSERT_TRUE(readings);
  EXPECT_EQ(readings->front().tip_W_mm, machine.touch(touch_from_x(5))->tip_W_mm);
  command.first_id = 15;
  EXPECT_NE(machine.scan_circle(command)->front().tip_W_mm, readings->front().tip_W_mm);
}

TEST(SimulatedMachine, DescribesItself) {
  EXPECT_EQ(SimulatedMachine({}).description(),
            "simulated machine, tip diameter 4 mm, touch speed 5 mm/s");
}

}  // namespace
}  // namespace rondure::cmm
