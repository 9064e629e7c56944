// The program itself with an emulated controller on an emulated bus: a real fixture, a part and a
// machine in software.

#include <sys/stat.h>

#include <chrono>
#include <cstdlib>
#include <functional>
#include <mutex>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/files.h"
#include "tests/app/program.h"
#include "tests/usb/usb_testbed.h"
#include "tests/usb/zaber_usb.h"

namespace rondure::app::testing {
namespace {

using rondure::testing::UsbRefusals;
using rondure::testing::UsbTestbed;
using rondure::testing::ZaberEmulator;
using rondure::testing::ZaberUsb;
using std::chrono::milliseconds;
using ::testing::HasSubstr;

/// The preload library for the program; this one is linked with it.
void preload_for_children() {
  ::setenv("LD_PRELOAD", "libumockdev-preload.so.0", 1);
  ::setenv("ASAN_OPTIONS", "verify_asan_link_order=0:detect_leaks=0", 1);
}

/// A bus with a controller, and the plan of a short inspection on its stages.
class ProgramOnUsb : public ::testing::Test {
 protected:
  ProgramOnUsb() {
    preload_for_children();
    write_plan(folder / "plan.json", {{"/fixture/driver", "zaber"},
                                      {"/fixture/zaber", {{"usb_serial", "67890"}}},
                                      {"/fixture/resolution_deg", 0.001},
                                      {"/features/0/pose_search/repeats", 1},
                                      {"/reports/formats", {"json"}},
                                      {"/reports/archive", "none"}});
    ::chmod(folder.path().c_str(), 0777);
  }

  [[nodiscard]] std::vector<std::string> command(const std::string& more = "") const {
    std::vector<std::string> out = {"run", folder / "plan.json", "--out", folder / "run"};
    if (!more.empty()) out.push_back(more);
    return out;
  }
  /// Waits until the emulated world is so; false when the program ended before.
  bool wait_for(const Program& program, const std::function<bool()>& so) {
    while (!program.ended()) {
      {
        const std::lock_guard guard(lock);
        if (so()) return true;
      }
      std::this_thread::sleep_for(milliseconds(1));
    }
    return false;
  }

  Scratch folder;
  std::mutex lock;
  ZaberEmulator controller{wire::system_clock(), {.steps_s = 1e6}};
  ZaberUsb device{controller, "67890"};
  UsbTestbed bed{lock};
};

TEST_F(ProgramOnUsb, InspectsAPartOnRealStages) {
  bed.plug_in(device);
  const Outcome ran = rondure(command());
  EXPECT_EQ(ran.status, 0) << ran.err;
  const std::string report = read(folder / "run" / "report.json");
  EXPECT_THAT(report, HasSubstr("Zaber controller, device id 30342, serial number 67890"));
  EXPECT_GT(controller.moves(), 4);
  EXPECT_EQ(rondure({"verify", folder / "run"}).status, 0);
}

TEST_F(ProgramOnUsb, IsNotMisledByABadLine) {
  controller.faults.alert = 0.2;
  controller.faults.split = 0.2;
  controller.faults.late_reply = 0.01;  // each costs half a second
  controller.faults.wrong_checksum = 0.01;
  controller.faults.wrong_id = 0.01;
  device.packet_bytes = 5;
  bed.plug_in(device);
  const Outcome ran = rondure(command());
  EXPECT_EQ(ran.status, 0) << ran.err;
}

TEST_F(ProgramOnUsb, StopsAtAStallAndGoesOnWhenItIsCleared) {
  bed.plug_in(device);
  Program program(command());
  ASSERT_TRUE(wait_for(program, [&] { return controller.moves() >= 4; }));
  {
    const std::lock_guard guard(lock);
    controller.stall_next(1);
  }
  const Outcome ran = program.wait();
  EXPECT_EQ(ran.status, 3);
  EXPECT_THAT(ran.err, HasSubstr("stalled"));
  EXPECT_FALSE(controller.is_moving());
  const Outcome resumed = rondure(command("--resume"));
  EXPECT_EQ(resumed.status, 0) << resumed.err;
}

TEST_F(ProgramOnUsb, SaysSoWhenItIsUnpluggedInMotion) {
  controller.receive("/1 1 set maxspeed 32768\n/1 2 set maxspeed 32768\n");  // slow
  const int address = bed.plug_in(device);
  Program program(command());
  ASSERT_TRUE(wait_for(program, [&] { return controller.moves() >= 5 && controller.is_moving(); }));
  bed.unplug(address);
  const Outcome ran = program.wait();
  EXPECT_EQ(ran.status, 3);
  EXPECT_THAT(ran.err, HasSubstr("was unplugged"));
  EXPECT_THAT(ran.err, HasSubstr("emergency stop"));
}

TEST_F(ProgramOnUsb, NamesARefusedTransfer) {
  bed.plug_in(device);
  Program program(command());
  ASSERT_TRUE(wait_for(program, [&] { return controller.moves() >= 3; }));
  {
    const std::lock_guard guard(lock);
    device.stalled = true;
  }
  const Outcome ran = program.wait();
  EXPECT_EQ(ran.status, 3);
  EXPECT_THAT(ran.err, HasSubstr("stall"));
}

TEST_F(ProgramOnUsb, NamesTheUdevRulesWhenItMayNotOpenTheDevice) {
  bed.plug_in(device, UsbRefusals{.open = true, .claim = false, .kernel_driver = ""});
  Surroundings anyone;
  anyone.unprivileged = true;
  const Outcome ran = rondure(command(), anyone);
  EXPECT_EQ(ran.status, 3);
  EXPECT_THAT(ran.err, HasSubstr("60-rondure.rules"));
}

TEST_F(ProgramOnUsb, SaysThatAnotherProgramHasTheDevice) {
  bed.plug_in(device, UsbRefusals{.open = false, .claim = true, .kernel_driver = ""});
  const Outcome ran = rondure(command());
  EXPECT_EQ(ran.status, 3);
  EXPECT_THAT(ran.err, HasSubstr("is in use by"));
}

TEST_F(ProgramOnUsb, SaysWhatIsPluggedInWhenTheNumberIsAnother) {
  ZaberUsb other(controller, "11111");
  bed.plug_in(other);
  const Outcome ran = rondure(command());
  EXPECT_EQ(ran.status, 3);
  EXPECT_THAT(ran.err, HasSubstr("11111"));
}

}  // namespace
}  // namespace rondure::app::testing
