#include "cmm/ipp_client.h"

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
