#include "plans/cell/internal/fixture_driver.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/units.h"
#include "fixture/manual.h"
#include "fixture/thorlabs.h"
#include "fixture/zaber.h"
#include "fixture/zaber_link.h"
#include "plans/path/internal/nominal_geometry.h"
#include "wire/usb.h"
#include "wire/usb_stream.h"

namespace rondure::plans {
namespace {

using core::kDegree;

fixture::ZaberAxisOptions axis_options(const ZaberAxisPlan& plan, int usual_axis) {
  fixture::ZaberAxisOptions out;
  out.axis = plan.axis == 0 ? usual_axis : plan.axis;
  out.microstep_rad = plan.microstep_deg * kDegree;
  out.reversed = plan.sense == StageSense::kReversed;
  out.zero_rad = plan.zero_deg * kDegree;
  out.max_speed_rad_s = plan.max_speed_deg_s * kDegree;
  return out;
}

core::Result<std::unique_ptr<fixture::Fixture>> open_zaber(const FixturePlan& fixture,
                                                           const CellOptions& cell) {
  const ZaberPlan plan = fixture.zaber.value_or(ZaberPlan{});
  fixture::ZaberConnection connection;
  if (plan.connection == ZaberPlan::Connection::kSerial) connection.device = plan.device;
  connection.usb_serial = plan.usb_serial;
  connection.baud = plan.baud;
  connection.wire_log = cell.wire_log;
  auto lines = fixture::connect_zaber(connection);
  if (!lines) return core::fail(lines.error().at("/fixture"));
  fixture::ZaberOptions options;
  options.device = plan.address;
  options.alpha = axis_options(plan.alpha, 1);
  options.beta = axis_options(plan.beta, 2);
  options.limits = limits_of(fixture);
  options.tolerance_rad = plan.pose_tolerance_deg * kDegree;
  options.motion_limit = std::chrono::milliseconds(std::llround(1000.0 * plan.motion_limit_s));
  options.stop_requested = cell.stop_requested;
  auto opened = fixture::ZaberFixture::open(*std::move(lines), options);
  if (!opened) return core::fail(opened.error().at("/fixture"));
  return *std::move(opened);
}

core::Result<std::unique_ptr<fixture::Fixture>> open_manual(const FixturePlan& plan,
                                                            const CellOptions& cell) {
  if (cell.set_by_hand) {
    return std::make_unique<fixture::ManualFixture>(limits_of(plan), cell.set_by_hand);
  }
  return core::fail(core::Code::kBadOption,
                    "the fixture is set by hand, and there is nobody to ask; run it from a "
                    "terminal",
                    "/fixture/driver");
}

}  // namespace

bool drives_fixture(const Plan& plan) {
  switch (plan.fixture->driver) {
    case FixturePlan::Driver::kManual:
      return plan.machine->driver != MachinePlan::Driver::kSimulated;
    case FixturePlan::Driver::kZaber:
    case FixturePlan::Driver::kThorlabs:
    case FixturePlan::Driver::kFixed:
      return true;
    case FixturePlan::Driver::kSimulated:
    case FixturePlan::Driver::kIppdme:
      break;
  }
  return false;
}

core::Result<std::unique_ptr<fixture::Fixture>> open_fixture(const FixturePlan& plan,
                                                             const CellOptions& options) {
  if (plan.driver == FixturePlan::Driver::kFixed) return std::make_unique<fixture::FixedFixture>();
  if (plan.driver == FixturePlan::Driver::kThorlabs) return open_thorlabs(plan);
  if (plan.driver == FixturePlan::Driver::kManual) return open_manual(plan, options);
  return open_zaber(plan, options);
}

namespace {

constexpr std::uint16_t kVendor = 0x0403;
constexpr std::uint16_t kProduct = 0xfaf0;

fixture::ThorlabsAxis axis_of(const ThorlabsAxisPlan& plan) {
  fixture::ThorlabsAxis out;
  out.serial = plan.serial;
  out.stage = fixture::thorlabs_stage(name_of(plan.stage)).value_or(fixture::ThorlabsStage{});
  if (out.stage.name.empty()) {
    out.stage.name = name_of(plan.stage);
    out.stage.dc_servo = plan.motor == ThorlabsAxisPlan::Motor::kDcServo;
  }
  out.stage.counts_per_deg = plan.counts_per_deg.value_or(out.stage.counts_per_deg);
  out.stage.velocity_per_deg_s = plan.velocity_per_deg_s.value_or(out.stage.velocity_per_deg_s);
  out.stage.acceleration_per_deg_s2 =
      plan.acceleration_per_deg_s2.value_or(out.stage.acceleration_per_deg_s2);
  out.zero_rad = plan.zero_deg * core::kDegree;
  out.direction = plan.sense == StageSense::kReversed ? -1 : 1;
  out.speed_rad_s = plan.speed_deg_s * core::kDegree;
  out.acceleration_rad_s2 = plan.acceleration_deg_s2 * core::kDegree;
  out.tolerance_rad = plan.tolerance_deg * core::kDegree;
  return out;
}

core::Result<std::unique_ptr<wire::ByteStream>> open_unit(const std::string& serial,
                                                          const char* where) {
  auto device = wire::open_usb({kVendor, {kProduct}, serial, "Thorlabs APT unit"});
  if (!device) return core::fail(device.error().error().at(where));
  auto stream = wire::open_ftdi(std::move(*device));
  if (!stream) return core::fail(stream.error().at(where));
  return stream;
}

}  // namespace

core::Result<std::unique_ptr<fixture::Fixture>> open_thorlabs(const FixturePlan& plan) {
  fixture::ThorlabsOptions options;
  options.alpha = axis_of(plan.thorlabs->alpha);
  options.beta = axis_of(plan.thorlabs->beta);
  options.limits = limits_of(plan);
  // Two readings of one pose may differ by the tolerance of the stages.
  options.limits.resolution_rad = std::max(
      {options.limits.resolution_rad, options.alpha.tolerance_rad, options.beta.tolerance_rad});
  TRY(auto alpha, open_unit(options.alpha.serial, "/fixture/thorlabs/alpha"));
  TRY(auto beta, open_unit(options.beta.serial, "/fixture/thorlabs/beta"));
  auto opened = fixture::ThorlabsFixture::open(std::move(alpha), std::move(beta), options);
  if (!opened) return core::fail(opened.error().at("/fixture/thorlabs"));
  return opened;
}

}  // namespace rondure::plans
