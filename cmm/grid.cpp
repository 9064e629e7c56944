#include "cmm/grid.h"

#include <cmath>

#include "core/numbers.h"
#include "core/units.h"

namespace rondure::cmm {
namespace {

using Eigen::Vector3d;

Vector3d rounded(const Vector3d& v, double steps_per_unit) {
  return {core::on_grid(v.x(), steps_per_unit), core::on_grid(v.y(), steps_per_unit),
          core::on_grid(v.z(), steps_per_unit)};
}

std::optional<double> on_grid_degC(const std::optional<double>& degC) {
  return degC ? std::optional(core::on_grid(*degC, kStepsPerKelvin)) : std::nullopt;
}

}  // namespace

Vector3d on_grid_mm(const Vector3d& p_mm) { return rounded(p_mm, kStepsPerMm); }

Vector3d direction_on_grid(const Vector3d& direction) {
  const double length = direction.norm();
  const bool unit = std::abs(length - 1.0) <= 1e-9;
  return rounded(unit ? direction : Vector3d(direction / length), kStepsPerUnit);
}

double angle_on_grid(double angle_rad) {
  return core::on_grid(angle_rad / core::kDegree, kStepsPerDegree) * core::kDegree;
}

TouchCommand on_grid(const TouchCommand& command) {
  TouchCommand out = command;
  out.expected_tip_W_mm = on_grid_mm(command.expected_tip_W_mm);
  out.direction_W = direction_on_grid(command.direction_W);
  out.approach_mm = core::on_grid(command.approach_mm, kStepsPerMm);
  out.search_mm = core::on_grid(command.search_mm, kStepsPerMm);
  return out;
}

ScanCircleCommand on_grid(const ScanCircleCommand& command) {
  ScanCircleCommand out = command;
  out.center_W_mm = on_grid_mm(command.center_W_mm);
  out.axis_W = direction_on_grid(command.axis_W);
  out.start_tip_W_mm = on_grid_mm(command.start_tip_W_mm);
  out.sweep_rad = angle_on_grid(command.sweep_rad);
  out.approach_mm = core::on_grid(command.approach_mm, kStepsPerMm);
  out.search_mm = core::on_grid(command.search_mm, kStepsPerMm);
  return out;
}

TouchReading on_grid(const TouchReading& reading) {
  TouchReading out = reading;
  out.tip_W_mm = on_grid_mm(reading.tip_W_mm);
  out.temperature_degC = on_grid_degC(reading.temperature_degC);
  out.time_s = core::on_grid(reading.time_s, kStepsPerSecond);
  out.tip_radius_mm = core::on_grid(reading.tip_radius_mm, kStepsPerMm);
  out.scale_temperature_degC = on_grid_degC(reading.scale_temperature_degC);
  return out;
}

}  // namespace rondure::cmm
