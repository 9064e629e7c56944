#include "cmm/ipp_client/client.h"

#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "cmm/grid.h"

#include "cmm/scan_path.h"
#include "cmm/touch_check.h"
#include "core/numbers.h"
#include "core/units.h"

// Circle scans and the rotary tables of a machine reached over I++ DME.

namespace rondure::cmm {
namespace {

using Eigen::Vector3d;
using ipp::Item;
using ipp::number_item;
using ipp::client::Reply;

/// Servers retract from the end of a scan by a distance of their own choice.
constexpr double kAfterScan_mm = 50.0;

void append(std::vector<Item>& items, const Vector3d& v) {
  for (const double value : {v.x(), v.y(), v.z()}) items.push_back(number_item(value));
}

/// Centre, start, axis, sweep, side of the surface and step of ScanOnCircle.
std::vector<Item> scan_arguments(const ScanCircleCommand& command, const Vector3d& start_W_mm) {
  std::vector<Item> out;
  append(out, command.center_W_mm);
  append(out, start_W_mm);
  append(out, command.axis_W);
  const double sweep_deg = core::on_grid(command.sweep_rad / core::kDegree, kStepsPerDegree);
  out.push_back(number_item(sweep_deg));
  out.push_back(number_item(command.inside ? 180.0 : 0.0));
  out.push_back(number_item(std::abs(sweep_deg) / command.points));
  return out;
}

}  // namespace

core::Result<std::vector<TouchReading>> IppMachine::scan_circle(const ScanCircleCommand& given) {
  TRY_DO(check_ready());
  TRY_DO(check_scan(given));
  if (const Capabilities can = capabilities(); !can.scans_circles) {
    return core::machine_fault("the machine does not scan circles: {}", can.no_scans);
  }
  const ScanCircleCommand command = on_grid(given);
  const TouchCommand first = scan_point(command, 0);
  TRY_DO(check_touch(first, position_W_mm_));
  TRY_DO(slow_down(is_cautious()));
  TRY_DO(set_touch_distances(first));
  const std::array<std::pair<std::string_view, double>, 1> retract = {
      {{"Tool.ScanPar.Retract", command.approach_mm}}};
  TRY_DO(dialogue_->set(retract));
  TRY_DO(number_touch(command.first_id));
  const Vector3d start = position_W_mm_;
  const Vector3d named = named_point(command.start_tip_W_mm, first.direction_W);
  const auto reply = run("ScanOnCircle", scan_arguments(command, named), scan_length_mm(command),
                         fmt::format("the scan about {}", in_words(command.center_W_mm)));
  const bool goes_back = !reply && reply.error().code == core::Code::kNoTouch;
  if (goes_back) {
    TRY_DO(go_to(start));
  }
  if (reply || goes_back) {
    TRY_DO(slow_down(false));
  }
  if (!reply) return core::fail(with_point_advice(reply.error()));
  return readings_of(*reply, command);
}

core::Result<std::vector<TouchReading>> IppMachine::readings_of(const Reply& reply,
                                                                const ScanCircleCommand& command) {
  TRY(const auto tips, ipp::client::scan_points(reply));
  next_touch_ = command.first_id + static_cast<std::int64_t>(tips.size());
  if (auto sane = check_scanned(command, tips); !sane) return core::fail(distrust(sane.error()));
  TRY(const auto stands, dialogue_->position_W_mm());
  const TouchCommand end = scan_point(command, command.points);
  if (auto there = check_stands("the scan", start_of(end), stands, kAfterScan_mm); !there) {
    return core::fail(distrust(there.error()));
  }
  position_W_mm_ = on_grid_mm(stands);
  // The points have no temperatures, and the last touch may be many circles ago.
  TRY_DO(read_part_temperature());
  std::vector<TouchReading> out;
  out.reserve(tips.size());
  TouchReading reading;
  reading.temperature_degC = temperature_degC_;
  reading.scale_temperature_degC = scale_temperature_degC_;
  reading.time_s = time_s();
  for (const Vector3d& tip : tips) {
    reading.tip_W_mm = tip;
    out.push_back(on_grid(reading));
  }
  return out;
}

core::Result<IppMachine::Alignment> IppMachine::align_part(const Alignment& target) {
  TRY_DO(check_ready());
  std::vector<Item> items;
  append(items, Vector3d::UnitZ());
  append(items, target.first_W);
  append(items, Vector3d::UnitY());
  append(items, target.second_W);
  items.push_back(number_item(0.0));  // no limit for the residual error: the pose is read back
  items.push_back(number_item(0.0));
  TRY(const auto reply, run("AlignPart", std::move(items), 0.0, "turning the part"));
  const std::vector<Vector3d> reached = ipp::client::find_vectors(reply);
  if (reached.size() != 2) {
    return core::machine_fault(
        "turning the part: the machine answered with {} vectors instead of 2; it needs two rotary "
        "axes (AlignPart with 14 numbers)",
        reached.size());
  }
  if (auto sane = check_turned({target.first_W, target.second_W}, {reached[0], reached[1]});
      !sane) {
    return core::fail(distrust(sane.error()));
  }
  return Alignment{reached[0], reached[1]};
}

}  // namespace rondure::cmm
