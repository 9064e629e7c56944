#include "plans/cell/internal/thorlabs_driver.h"

#include <algorithm>
#include <utility>

#include "core/units.h"
#include "fixture/thorlabs.h"
#include "plans/path/internal/nominal_geometry.h"
#include "wire/usb.h"
#include "wire/usb_stream.h"

namespace rondure::plans {
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
