#include "plans/cell/internal/hidden_errors.h"

#include <algorithm>
#include <optional>
#include <string>

#include "cmm/simulated/machine.h"
#include "core/units.h"
#include "fixture/axis_motion.h"

namespace rondure::plans {
namespace {

using fixture::kMicroradian;

constexpr double kMm_per_m = 1e3;
constexpr double kKeywayFlank_mm = 0.2;

void take(const std::optional<double>& given, double unit, double& value) {
  if (given) value = *given * unit;
}

/// "EYX" is component Y of axis X; for a rotation the letters A, B, C mean about x, y, z.
std::size_t component_of(const std::string& error, char first) {
  return static_cast<std::size_t>(error[1] - first);
}

std::size_t axis_of(const std::string& error) { return static_cast<std::size_t>(error[2] - 'X'); }

void take_geometry(const SimulatedMachinePlan& plan, cmm::GeometricErrors& out) {
  for (const record::TranslationError& e : plan.translations) {
    constexpr double kUm = core::kMicrometre;
    out.axes[axis_of(e.error)].translation[component_of(e.error, 'X')] = {
        e.linear_um_m * kUm / kMm_per_m, e.quadratic_um_m2 * kUm / (kMm_per_m * kMm_per_m),
        e.wave_um * kUm, e.wave_period_mm, e.wave_phase_deg * core::kDegree};
  }
  for (const record::RotationError& e : plan.rotations) {
    out.axes[axis_of(e.error)].rotation[component_of(e.error, 'A')] = {
        e.linear_urad_m * kMicroradian / kMm_per_m,
        e.quadratic_urad_m2 * kMicroradian / (kMm_per_m * kMm_per_m), e.wave_urad * kMicroradian,
        e.wave_period_mm, e.wave_phase_deg * core::kDegree};
  }
  take(plan.squareness_xy_urad, kMicroradian, out.squareness_xy_rad);
  take(plan.squareness_xz_urad, kMicroradian, out.squareness_xz_rad);
  take(plan.squareness_yz_urad, kMicroradian, out.squareness_yz_rad);
  take(plan.tip_offset_x_mm, 1.0, out.tip_offset_mm.x());
  take(plan.tip_offset_y_mm, 1.0, out.tip_offset_mm.y());
  take(plan.tip_offset_z_mm, 1.0, out.tip_offset_mm.z());
}

void take_probe(const SimulatedMachinePlan& plan, cmm::MachineErrors& out) {
  take(plan.pretravel_um, core::kMicrometre, out.pretravel_mm);
  take(plan.pretravel_z_um, core::kMicrometre, out.pretravel_z_mm);
  if (!plan.pretravel_lobes.empty()) out.pretravel_lobes.clear();
  for (const PretravelLobePlan& lobe : plan.pretravel_lobes) {
    out.pretravel_lobes.push_back(
        {lobe.order, lobe.amplitude_um * core::kMicrometre, lobe.phase_deg * core::kDegree});
  }
  take(plan.stylus_length_mm, 1.0, out.stylus.length_mm);
  take(plan.stylus_diameter_mm, 1.0, out.stylus.diameter_mm);
  take(plan.stylus_modulus_GPa, 1e3, out.stylus.modulus_MPa);
  take(plan.trigger_force_N, 1.0, out.stylus.force_N);
}

cmm::SurfaceMark mark(double at_deg, double z_mm, double width_mm, double length_mm) {
  cmm::SurfaceMark out;
  out.theta_rad = at_deg * core::kDegree;
  out.z_mm = z_mm;
  out.width_mm = width_mm;
  out.length_mm = length_mm;
  out.flank_mm = 0.5 * std::min(width_mm, length_mm);
  return out;
}

void put_marks(const SimulatedPartPlan& part, double middle_mm, cmm::PartSurface& out) {
  for (const KeywayPlan& key : part.keyways) {
    auto slot = mark(key.at_deg, key.z_mm - middle_mm, key.width_mm, key.length_mm);
    slot.height_mm = -key.depth_mm;
    slot.flank_mm = std::min(slot.flank_mm, kKeywayFlank_mm);
    out.marks.push_back(slot);
  }
  for (const BurrPlan& burr : part.burrs) {
    auto spot = mark(burr.at_deg, burr.z_mm - middle_mm, burr.width_mm, burr.length_mm);
    spot.height_mm = burr.height_um * core::kMicrometre;
    out.marks.push_back(spot);
  }
}

}  // namespace

cmm::MachineErrors machine_errors(const SimulationPlan& simulation) {
  const SimulatedMachinePlan& plan = simulation.machine;
  cmm::MachineErrors out;
  if (plan.errors == SimulatedMachinePlan::Errors::kTypical) out = cmm::typical_errors();
  out.repeatability_mm = simulation.probe.repeatability_um * core::kMicrometre;
  out.tip_radius_error_mm = simulation.probe.tip_radius_error_um * core::kMicrometre;
  take_geometry(plan, out.geometry);
  take_probe(plan, out);
  take(plan.backlash_x_um, core::kMicrometre, out.backlash_mm.x());
  take(plan.backlash_y_um, core::kMicrometre, out.backlash_mm.y());
  take(plan.backlash_z_um, core::kMicrometre, out.backlash_mm.z());
  take(plan.scale_expansion_per_K, 1.0, out.scale_expansion_1_K);
  take(plan.scale_temperature_degC, 1.0, out.scale_temperature_degC);
  take(plan.drift_x_um, core::kMicrometre, out.drift_mm.x());
  take(plan.drift_y_um, core::kMicrometre, out.drift_mm.y());
  take(plan.drift_z_um, core::kMicrometre, out.drift_mm.z());
  take(plan.drift_time_s, 1.0, out.drift_time_s);
  return out;
}

cmm::ScanScatter scan_scatter(const SimulatedMachinePlan& machine) {
  return {machine.scan_start_deg * core::kDegree, machine.scan_step_percent / 100.0,
          machine.scan_dropped_percent / 100.0};
}

cmm::PartErrors part_errors(const SimulatedPartPlan& part) {
  return {part.expansion_per_K, part.dust_share, part.dust_um * core::kMicrometre};
}

cmm::PartSurface simulated_surface(const SimulationPlan& simulation, const FeaturePlan& feature) {
  const SimulatedPartPlan& part = simulation.part;
  cmm::PartSurface out;
  out.radius_mm = 0.5 * (feature.nominal.diameter_mm + part.diameter_error_um * core::kMicrometre);
  out.half_length_mm = 0.5 * (feature.nominal.to_mm - feature.nominal.from_mm);
  out.inside = feature.side == record::Side::kInside;
  for (const LobePlan& lobe : part.lobes) {
    out.form.lobes.push_back({lobe.order, lobe.amplitude_um * core::kMicrometre,
                              lobe.phase_deg * core::kDegree, lobe.twist_deg * core::kDegree});
  }
  out.form.taper_mm = part.taper_um * core::kMicrometre;
  out.form.barrel_mm = part.barrel_um * core::kMicrometre;
  out.form.bend_mm = part.bend_um * core::kMicrometre;
  out.form.bend_phase_rad = part.bend_phase_deg * core::kDegree;
  put_marks(part, 0.5 * (feature.nominal.from_mm + feature.nominal.to_mm), out);
  return out;
}

}  // namespace rondure::plans
