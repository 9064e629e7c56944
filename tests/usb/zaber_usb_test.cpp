#include <memory>
#include <stdexcept>

#include <gtest/gtest.h>

#include "fixture/zaber_link.h"
#include "tests/fixture/fixture_contract.h"
#include "tests/fixture/zaber_rig.h"
#include "tests/usb/usb_testbed.h"
#include "tests/usb/zaber_usb.h"

namespace rondure::fixture {
namespace {

using rondure::testing::UsbTestbed;
using rondure::testing::ZaberRig;
using rondure::testing::ZaberUsb;

/// The emulated bus with one controller.
class UsbLine final : public ZaberRig::Keeper {
 public:
  UsbLine(rondure::testing::ZaberEmulator& controller, std::mutex& lock)
      : device_(controller, "67890"), bed_(lock) {
    bed_.plug_in(device_);
  }

 private:
  ZaberUsb device_;
  UsbTestbed bed_;
};

std::unique_ptr<FixtureRig> usb_rig() {
  auto rig = std::make_unique<ZaberRig>();
  auto line = std::make_unique<UsbLine>(rig->controller(), rig->lock());
  auto lines =
      connect_zaber({.device = {}, .usb_serial = "67890", .baud = 115'200, .wire_log = {}});
  if (!lines) throw std::runtime_error(lines.error().what);
  rig->connect(*std::move(lines), std::move(line));
  return rig;
}

INSTANTIATE_TEST_SUITE_P(Usb, FixtureContract,
                         ::testing::Values(FixtureMaker{"zaber_on_usb", usb_rig}), name_of_maker);

}  // namespace
}  // namespace rondure::fixture
