#pragma once

#include <cmath>
#include <limits>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Core>

#include "cmm/grid.h"
#include "cmm/machine.h"
#include "core/units.h"

// Tests that every driver of cmm::Machine must pass (cmm/machine.h). A driver's test file has
//
//   INSTANTIATE_TYPED_TEST_SUITE_P(Simulated, MachineContract, SimulatedRig);
//
// with a rig that can be made without arguments and has
//
//   cmm::Machine& machine();  // connected, not homed; ideal: no noise, no error but its tip radius
//   void place(bool inside);  // puts the part on its table: shaft or bore
//
// The part is a perfect cylinder of radius 25 mm about z, from z = -40 to +40 mm; the tip has a
// radius of 2 mm. Nothing else stands within 200 mm of it.

namespace rondure::cmm {

inline constexpr double kContractRadius_mm = 25.0;
inline constexpr double kContractTip_mm = 2.0;
inline constexpr double kContractClose_mm = 1e-9;

template <class Rig>
class MachineContract : public ::testing::Test {
 protected:
  Rig rig;
  Machine& machine = rig.machine();

  static TouchCommand touch_from_x(std::int64_t id) {
    return {id, {27.0, 0.0, 0.0}, -Eigen::Vector3d::UnitX(), 3.0, 3.0};
  }
  /// Homes the machine, places the shaft, and moves the tip to the start of touch_from_x().
  void stand_before_shaft() {
    rig.place(false);
    ASSERT_TRUE(machine.home());
    go_to({30.0, 0.0, 0.0});
  }
  /// Moves straight up, across, and straight down.
  void go_to(const Eigen::Vector3d& tip_W_mm) {
    const Eigen::Vector3d from_W_mm = machine.position_W_mm();
    ASSERT_TRUE(machine.move_to({from_W_mm.x(), from_W_mm.y(), 200.0}));
    ASSERT_TRUE(machine.move_to({tip_W_mm.x(), tip_W_mm.y(), 200.0}));
    ASSERT_TRUE(machine.move_to(tip_W_mm));
  }
  static ScanCircleCommand scan(bool inside, double sweep_rad, int points) {
    ScanCircleCommand out;
    out.first_id = 7;
    out.center_W_mm = {0.0, 0.0, 10.0};
    out.start_tip_W_mm = {inside ? 23.0 : 27.0, 0.0, 10.0};
    out.inside = inside;
    out.sweep_rad = sweep_rad;
    out.points = points;
    return out;
  }
  void expect_at(const Eigen::Vector3d& tip_W_mm) const {
    EXPECT_LT((machine.position_W_mm() - tip_W_mm).norm(), 1e-6)
        << machine.position_W_mm().transpose();
  }
};

TYPED_TEST_SUITE_P(MachineContract);

TYPED_TEST_P(MachineContract, MovesNothingBeforeHome) {
  this->rig.place(false);
  const Eigen::Vector3d before = this->machine.position_W_mm();
  EXPECT_EQ(this->machine.move_to({30.0, 0.0, 300.0}).error().code, core::Code::kMachine);
  EXPECT_EQ(this->machine.touch(this->touch_from_x(0)).error().code, core::Code::kMachine);
  EXPECT_EQ(this->machine.scan_circle(this->scan(false, core::kTwoPi, 8)).error().code,
            core::Code::kMachine);
  EXPECT_EQ(this->machine.position_W_mm(), before);
  ASSERT_TRUE(this->machine.status());
  EXPECT_FALSE(this->machine.status()->homed);
}

TYPED_TEST_P(MachineContract, SaysWhatItIsAndHowItStands) {
  const Capabilities can = this->machine.capabilities();
  EXPECT_FALSE(can.name.empty());
  EXPECT_FALSE(this->machine.description().empty());
  EXPECT_LE(can.least.touch_mm_s, can.greatest.touch_mm_s);
  EXPECT_TRUE((can.volume_min_W_mm.array() < can.volume_max_W_mm.array()).all());
  ASSERT_TRUE(this->machine.home());
  const auto status = this->machine.status();
  ASSERT_TRUE(status);
  EXPECT_TRUE(status->homed);
  EXPECT_FALSE(status->stopped);
  EXPECT_EQ(status->fault, "");
}

TYPED_TEST_P(MachineContract, MovesToItsTarget) {
  ASSERT_TRUE(this->machine.home());
  ASSERT_TRUE(this->machine.move_to({30.0, -20.0, 210.5}));
  EXPECT_EQ(this->machine.position_W_mm(), Eigen::Vector3d(30.0, -20.0, 210.5));
  ASSERT_TRUE(this->machine.move_to({30.0 + 3e-11, -20.0, 210.5}));
  EXPECT_EQ(this->machine.position_W_mm(), Eigen::Vector3d(30.0, -20.0, 210.5)) << "the grid";
}

TYPED_TEST_P(MachineContract, TouchGivesTheTipCentreAndReturnsToItsStart) {
  this->stand_before_shaft();
  const double before_s = this->machine.time_s();
  const auto reading = this->machine.touch(this->touch_from_x(0));
  ASSERT_TRUE(reading) << reading.error().what;
  EXPECT_LT((reading->tip_W_mm - Eigen::Vector3d(27.0, 0.0, 0.0)).norm(), kContractClose_mm);
  EXPECT_EQ(reading->tip_W_mm, on_grid_mm(reading->tip_W_mm));
  EXPECT_NEAR(reading->tip_radius_mm, kContractTip_mm, 0.1);
  EXPECT_GE(reading->time_s, before_s);
  EXPECT_GE(this->machine.time_s(), reading->time_s);
  this->expect_at({30.0, 0.0, 0.0});
}

TYPED_TEST_P(MachineContract, TouchesOnASlantedLineLikeOnTheGrid) {
  this->stand_before_shaft();
  const Eigen::Vector3d d = Eigen::Vector3d(-0.8, 0.31, 0.1).normalized();
  TouchCommand command = {1, Eigen::Vector3d(27.0, 0.0, 0.0), d, 3.0, 3.0};
  const Eigen::Vector3d start = command.expected_tip_W_mm - 3.0 * d;
  ASSERT_TRUE(this->machine.move_to(start));
  const auto reading = this->machine.touch(command);
  ASSERT_TRUE(reading) << reading.error().what;
  EXPECT_NEAR(reading->tip_W_mm.template head<2>().norm(), 27.0, kContractClose_mm);
  EXPECT_LT((reading->tip_W_mm - start).cross(d).norm(), kContractClose_mm) << "on its line";
  command.expected_tip_W_mm.x() += 3e-11;
  const auto again = this->machine.touch(command);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->tip_W_mm, reading->tip_W_mm) << "same bits on the same step of the grid";
}

TYPED_TEST_P(MachineContract, NoTouchLeavesTheTipAtItsStart) {
  this->rig.place(false);
  ASSERT_TRUE(this->machine.home());
  this->go_to({40.0, 0.0, 0.0});
  const auto missed =
      this->machine.touch({1, {37.0, 0.0, 0.0}, -Eigen::Vector3d::UnitX(), 3.0, 3.0});
  ASSERT_FALSE(missed);
  EXPECT_EQ(missed.error().code, core::Code::kNoTouch);
  this->expect_at({40.0, 0.0, 0.0});
  ASSERT_TRUE(this->machine.recover());
  const auto found =
      this->machine.touch({2, {37.0, 0.0, 0.0}, -Eigen::Vector3d::UnitX(), 3.0, 13.0});
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_NEAR(found->tip_W_mm.x(), 27.0, kContractClose_mm);
}

TYPED_TEST_P(MachineContract, StopsAtAnUnexpectedContact) {
  this->stand_before_shaft();
  const auto crash = this->machine.move_to({-30.0, 0.0, 0.0});
  ASSERT_FALSE(crash);
  EXPECT_EQ(crash.error().code, core::Code::kCollision);
  EXPECT_NEAR(this->machine.position_W_mm().x(), 27.0, 0.01);
  ASSERT_TRUE(this->machine.recover());
  EXPECT_TRUE(this->machine.move_to({30.0, 0.0, 0.0})) << "the way back is free";
}

TYPED_TEST_P(MachineContract, TouchMustBeginWhereTheTipStands) {
  this->stand_before_shaft();
  TouchCommand command = this->touch_from_x(1);
  command.expected_tip_W_mm.y() += 1.0;
  const auto refused = this->machine.touch(command);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Code::kMachine);
  this->expect_at({30.0, 0.0, 0.0});
}

TYPED_TEST_P(MachineContract, RefusesWhatIsNotFinite) {
  this->stand_before_shaft();
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(this->machine.move_to({bad, 0.0, 0.0}).error().code, core::Code::kMachine);
    TouchCommand touch = this->touch_from_x(1);
    touch.expected_tip_W_mm.z() = bad;
    EXPECT_EQ(this->machine.touch(touch).error().code, core::Code::kMachine);
    touch = this->touch_from_x(1);
    touch.direction_W.x() = bad;
    EXPECT_EQ(this->machine.touch(touch).error().code, core::Code::kMachine);
    touch = this->touch_from_x(1);
    touch.search_mm = bad;
    EXPECT_EQ(this->machine.touch(touch).error().code, core::Code::kMachine);
    ScanCircleCommand scan = this->scan(false, bad, 8);
    EXPECT_EQ(this->machine.scan_circle(scan).error().code, core::Code::kMachine);
    Speeds speeds;
    speeds.touch_mm_s = bad;
    EXPECT_EQ(this->machine.set_speeds(speeds).error().code, core::Code::kOutOfRange);
  }
  this->expect_at({30.0, 0.0, 0.0});
  EXPECT_TRUE(this->machine.touch(this->touch_from_x(2))) << "and is ready for the next command";
}

TYPED_TEST_P(MachineContract, RefusesADirectionThatIsNoUnitVector) {
  this->stand_before_shaft();
  TouchCommand command = this->touch_from_x(1);
  command.direction_W *= 1.1;
  EXPECT_EQ(this->machine.touch(command).error().code, core::Code::kMachine);
  command.direction_W.setZero();
  EXPECT_EQ(this->machine.touch(command).error().code, core::Code::kMachine);
}

TYPED_TEST_P(MachineContract, RefusesTargetsOutsideItsVolume) {
  ASSERT_TRUE(this->machine.home());
  const Eigen::Vector3d before = this->machine.position_W_mm();
  const double end_mm = this->machine.capabilities().volume_max_W_mm.z();
  if (!std::isfinite(end_mm)) GTEST_SKIP() << "the machine does not say its volume";
  const auto refused = this->machine.move_to({0.0, 0.0, end_mm + 1.0});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Code::kUnreachable);
  EXPECT_EQ(this->machine.position_W_mm(), before);
}

TYPED_TEST_P(MachineContract, TakesSpeedsWithinItsLimitsOnly) {
  this->stand_before_shaft();
  const Capabilities can = this->machine.capabilities();
  EXPECT_TRUE(this->machine.set_speeds({10.0, 2.0, 4.0}));
  for (double Speeds::*speed : {&Speeds::travel_mm_s, &Speeds::touch_mm_s, &Speeds::scan_mm_s}) {
    for (const double bad : {0.0, -1.0, 2.0 * can.greatest.*speed}) {
      Speeds speeds = {10.0, 2.0, 4.0};
      speeds.*speed = bad;
      const auto refused = this->machine.set_speeds(speeds);
      ASSERT_FALSE(refused);
      EXPECT_EQ(refused.error().code, core::Code::kOutOfRange);
    }
  }
  EXPECT_TRUE(this->machine.touch(this->touch_from_x(1)));
}

TYPED_TEST_P(MachineContract, TakesTheToolsItNamesAndNoOther) {
  ASSERT_TRUE(this->machine.home());
  const Capabilities can = this->machine.capabilities();
  ASSERT_FALSE(can.tools.empty());
  for (const std::string& tool : can.tools) {
    const auto taken = this->machine.select_tool(tool);
    ASSERT_TRUE(taken) << taken.error().what;
    EXPECT_EQ(this->machine.status()->tool, tool);
  }
  const auto refused = this->machine.select_tool("no such tool");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Code::kMachine);
  EXPECT_THAT(refused.error().what, ::testing::HasSubstr("no such tool"));
  EXPECT_EQ(this->machine.status()->tool, can.tools.back());
}

TYPED_TEST_P(MachineContract, MovesNothingAfterAStopUntilItRecovers) {
  this->stand_before_shaft();
  this->machine.stop();
  const auto move = this->machine.move_to({30.0, 0.0, 100.0});
  ASSERT_FALSE(move);
  EXPECT_EQ(move.error().code, core::Code::kStopped);
  EXPECT_EQ(this->machine.touch(this->touch_from_x(1)).error().code, core::Code::kStopped);
  EXPECT_TRUE(this->machine.status()->stopped);
  this->expect_at({30.0, 0.0, 0.0});
  ASSERT_TRUE(this->machine.recover());
  EXPECT_FALSE(this->machine.status()->stopped);
  EXPECT_TRUE(this->machine.touch(this->touch_from_x(1)));
}

TYPED_TEST_P(MachineContract, MayBeStoppedFromAnotherThread) {
  this->stand_before_shaft();
  std::thread other([this] { this->machine.stop(); });
  core::Code code = core::Code::kInternal;
  for (int i = 0; i < 100'000 && code != core::Code::kStopped; ++i) {
    const auto reading = this->machine.touch(this->touch_from_x(i));
    if (!reading) code = reading.error().code;
  }
  other.join();
  EXPECT_EQ(code, core::Code::kStopped);
  ASSERT_TRUE(this->machine.recover());
  EXPECT_TRUE(this->machine.move_to({30.0, 0.0, 100.0}));
}

TYPED_TEST_P(MachineContract, ScansCirclesOutsideAndInside) {
  if (!this->machine.capabilities().scans_circles) GTEST_SKIP() << "the machine scans no circles";
  ASSERT_TRUE(this->machine.home());
  for (const bool inside : {false, true}) {
    SCOPED_TRACE(inside);
    this->rig.place(inside);
    ScanCircleCommand command = this->scan(inside, core::kTwoPi, 360);
    const Eigen::Vector3d start(inside ? 20.0 : 30.0, 0.0, 10.0);
    this->go_to(start);
    const auto readings = this->machine.scan_circle(command);
    ASSERT_TRUE(readings) << readings.error().what;
    ASSERT_EQ(readings->size(), 360U);
    for (std::size_t i = 0; i < readings->size(); ++i) {
      const TouchReading& reading = (*readings)[i];
      const double angle = core::kTwoPi * static_cast<double>(i) / 360.0;
      const Eigen::Vector3d expected(command.start_tip_W_mm.x() * std::cos(angle),
                                     command.start_tip_W_mm.x() * std::sin(angle), 10.0);
      ASSERT_LT((reading.tip_W_mm - expected).norm(), kContractClose_mm) << i;
      ASSERT_EQ(reading.tip_W_mm, on_grid_mm(reading.tip_W_mm));
      ASSERT_GE(reading.time_s, (*readings)[i == 0 ? 0 : i - 1].time_s);
    }
    this->expect_at(start);
    ASSERT_TRUE(this->machine.move_to({start.x(), 0.0, 200.0}));
  }
}

TYPED_TEST_P(MachineContract, ScansMoreThanOneTurnEitherWay) {
  if (!this->machine.capabilities().scans_circles) GTEST_SKIP() << "the machine scans no circles";
  this->stand_before_shaft();
  ASSERT_TRUE(this->machine.move_to({30.0, 0.0, 10.0}));
  const auto on = this->machine.scan_circle(this->scan(false, 2.5 * core::kTwoPi, 250));
  ASSERT_TRUE(on) << on.error().what;
  EXPECT_NEAR((*on)[25].tip_W_mm.y(), 27.0, kContractClose_mm) << "a quarter turn";
  EXPECT_LT(((*on)[100].tip_W_mm - (*on)[0].tip_W_mm).norm(), kContractClose_mm);
  this->expect_at({-30.0, 0.0, 10.0});
  this->go_to({30.0, 0.0, 10.0});
  const auto back = this->machine.scan_circle(this->scan(false, -core::kTwoPi, 100));
  ASSERT_TRUE(back) << back.error().what;
  EXPECT_NEAR((*back)[25].tip_W_mm.y(), -27.0, kContractClose_mm);
}

TYPED_TEST_P(MachineContract, AScanWithoutASurfaceLeavesTheTipAtItsStart) {
  if (!this->machine.capabilities().scans_circles) GTEST_SKIP() << "the machine scans no circles";
  this->rig.place(false);
  ASSERT_TRUE(this->machine.home());
  ScanCircleCommand command = this->scan(false, core::kTwoPi, 36);
  command.start_tip_W_mm.x() = 37.0;
  this->go_to({40.0, 0.0, 10.0});
  const auto missed = this->machine.scan_circle(command);
  ASSERT_FALSE(missed);
  EXPECT_EQ(missed.error().code, core::Code::kNoTouch);
  this->expect_at({40.0, 0.0, 10.0});
}

TYPED_TEST_P(MachineContract, RefusesScansThatMakeNoSense) {
  this->stand_before_shaft();
  const ScanCircleCommand good = this->scan(false, core::kTwoPi, 36);
  std::vector<ScanCircleCommand> bad(5, good);
  bad[0].points = 2;
  bad[1].points = kMaxScanPoints + 1;
  bad[2].sweep_rad = 0.0;
  bad[3].start_tip_W_mm = bad[3].center_W_mm;
  bad[4].axis_W = Eigen::Vector3d::UnitX();
  for (std::size_t i = 0; i < bad.size(); ++i) {
    SCOPED_TRACE(i);
    const auto refused = this->machine.scan_circle(bad[i]);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, core::Code::kMachine);
  }
  this->expect_at({30.0, 0.0, 0.0});
}

REGISTER_TYPED_TEST_SUITE_P(MachineContract, MovesNothingBeforeHome, SaysWhatItIsAndHowItStands,
                            MovesToItsTarget, TouchGivesTheTipCentreAndReturnsToItsStart,
                            TouchesOnASlantedLineLikeOnTheGrid, NoTouchLeavesTheTipAtItsStart,
                            StopsAtAnUnexpectedContact, TouchMustBeginWhereTheTipStands,
                            RefusesWhatIsNotFinite, RefusesADirectionThatIsNoUnitVector,
                            RefusesTargetsOutsideItsVolume, TakesSpeedsWithinItsLimitsOnly,
                            TakesTheToolsItNamesAndNoOther, MovesNothingAfterAStopUntilItRecovers,
                            MayBeStoppedFromAnotherThread, ScansCirclesOutsideAndInside,
                            ScansMoreThanOneTurnEitherWay,
                            AScanWithoutASurfaceLeavesTheTipAtItsStart,
                            RefusesScansThatMakeNoSense);

}  // namespace rondure::cmm
