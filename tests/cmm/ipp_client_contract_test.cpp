#include "cmm/ipp_client/client.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "core/units.h"
#include "machine_contract.h"
#include "tests/cmm/served_machine.h"

namespace rondure::cmm {

/// The client, and the simulated machine behind a server, over a socket of this computer.
class IppRig {
 public:
  Machine& machine() { return *client_; }
  void place(bool inside) {
    backend_.machine().place_part({kContractRadius_mm, 40.0, inside, {}},
                                  Eigen::Isometry3d::Identity());
  }

 private:
  BareBackend backend_;
  ServedMachine server_{backend_};
  std::unique_ptr<IppMachine> client_ =
      *IppMachine::open([this] { return wire::connect_tcp("127.0.0.1", server_.port()); }, {});
};

INSTANTIATE_TYPED_TEST_SUITE_P(OverIppDme, MachineContract, IppRig);

namespace {

TEST(IppClientPoint, ALargeBallInASmallBoreMeetsNoOtherWall) {
  using ipp::NamedPoint;
  constexpr double kTip_mm = 4.0;
  constexpr double kBore_mm = 6.0;
  for (const auto meant : {NamedPoint::kSurface, NamedPoint::kCenter}) {
    for (const auto taken : {NamedPoint::kSurface, NamedPoint::kCenter}) {
      SimulatedMachineOptions world;
      world.nominal_tip_radius_mm = kTip_mm;
      BareBackend backend(world);
      backend.machine().place_part({kBore_mm, 40.0, true, {}}, Eigen::Isometry3d::Identity());
      ipp::ServerOptions options;
      options.controller.tip_radius_mm = kTip_mm;
      options.controller.point = taken;
      ServedMachine server(backend, options);
      IppMachineOptions own;
      own.point = meant;
      const auto client =
          *IppMachine::open([&] { return wire::connect_tcp("127.0.0.1", server.port()); }, own);
      ASSERT_TRUE(client->home());
      ASSERT_TRUE(client->move_to({0.5, 0.0, 300.0}));
      ASSERT_TRUE(client->move_to({0.5, 0.0, 0.0}));
      const TouchCommand touch = {0, {2.0, 0.0, 0.0}, Eigen::Vector3d::UnitX(), 1.5, 1.5};
      const auto reading = client->touch(touch);
      ASSERT_EQ(reading.has_value(), meant == taken);
      if (reading) {
        EXPECT_NEAR(reading->tip_W_mm.x(), 2.0, 1e-6);
        EXPECT_TRUE(client->touch(touch));
      } else {
        EXPECT_NE(reading.error().what.find("machine.point"), std::string::npos)
            << reading.error().what;
      }
    }
  }
}

TEST(IppClientPoint, TheFirstTouchShowsWhatTheServerMeans) {
  using ipp::NamedPoint;
  for (const auto meant : {NamedPoint::kSurface, NamedPoint::kCenter}) {
    const bool surface = meant == NamedPoint::kSurface;
    BareBackend backend;
    backend.machine().place_part({kContractRadius_mm, 40.0, false, {}},
                                 Eigen::Isometry3d::Identity());
    ipp::ServerOptions options;
    options.controller.point = surface ? NamedPoint::kCenter : NamedPoint::kSurface;
    ServedMachine server(backend, options);
    IppMachineOptions own;
    own.point = meant;
    const auto client =
        *IppMachine::open([&] { return wire::connect_tcp("127.0.0.1", server.port()); }, own);
    ASSERT_TRUE(client->home());
    const Eigen::Vector3d start(kContractRadius_mm + 5.0, 0.0, 0.0);
    ASSERT_TRUE(client->move_to({start.x(), 0.0, 300.0}));
    ASSERT_TRUE(client->move_to(start));
    const auto reading = client->touch(
        {0, start - 3.0 * Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitX(), 3.0, 3.0});
    ASSERT_FALSE(reading);
    EXPECT_EQ(reading.error().code, core::Code::kMeaning) << reading.error().what;
    EXPECT_EQ(reading.error().where, "/machine/point");
    EXPECT_NE(reading.error().what.find(surface ? "set \"point\": \"center\""
                                                : "set \"point\": \"surface\""),
              std::string::npos)
        << reading.error().what;
    EXPECT_EQ(client->position_W_mm(), start);
    EXPECT_EQ(backend.machine().position_W_mm(), start);
  }
}

/// Touches a cylinder in 4 layers of 7 points, once around each; how many touches were made.
int touch_cylinder(Machine& machine) {
  int touches = 0;
  for (int layer = 0; layer < 4; ++layer) {
    for (int point = 0; point < 7; ++point) {
      const double angle = core::kTwoPi * point / 7.0;
      const Eigen::Vector3d outward(std::cos(angle), std::sin(angle), 0.0);
      const Eigen::Vector3d height(0.0, 0.0, -30.0 + 20.0 * layer);
      TouchCommand command = {touches, 27.0 * outward + height, -outward, 3.0, 3.0};
      // Around the part on a circle that its corners keep off.
      const double before = angle - core::kTwoPi / 14.0;
      const Eigen::Vector3d corner(40.0 * std::cos(before), 40.0 * std::sin(before), height.z());
      EXPECT_TRUE(machine.move_to(corner));
      EXPECT_TRUE(machine.move_to(30.0 * outward + height));
      EXPECT_TRUE(machine.touch(command));
      ++touches;
    }
  }
  return touches;
}

TEST(IppClientSpeed, ATouchTakesLessThanAMillisecondWhereMotionsTakeNoTime) {
  IppRig rig;
  rig.place(false);
  Machine& machine = rig.machine();
  ASSERT_TRUE(machine.home());
  ASSERT_TRUE(machine.move_to({40.0, 0.0, 200.0}));
  double best_ms = 1e9;  // what else the computer does is not the matter here
  for (int round = 0; round < 8; ++round) {
    const auto start = std::chrono::steady_clock::now();
    const int touches = touch_cylinder(machine);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    best_ms = std::min(best_ms, took.count() / touches);
    ASSERT_TRUE(machine.move_to({40.0, 0.0, 200.0}));
  }
  std::printf("4 x 7 touches over a socket: %.3f ms a touch with its two moves\n", best_ms);
  EXPECT_LT(best_ms, 1.0);
}

}  // namespace
}  // namespace rondure::cmm
