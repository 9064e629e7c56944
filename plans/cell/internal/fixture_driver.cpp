#include "plans/cell/internal/fixture_driver.h"

#include <chrono>
#include <cmath>
#include <utility>

#include "core/units.h"
#include "fixture/fixed.h"
#include "fixture/zaber.h"
#include "fixture/zaber_link.h"
#include "plans/cell/internal/thorlabs_driver.h"
#include "plans/path/internal/nominal_geometry.h"

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

}  // namespace rondure::plans
