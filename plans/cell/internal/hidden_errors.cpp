#include "plans/cell/internal/hidden_errors.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "cmm/simulated/machine.h"
#include "core/shortest_turn.h"
#include "core/units.h"
#include "fixture/axis_motion.h"
#include "plans/analyses/features.h"
#include "plans/path/internal/nominal_geometry.h"

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

/// The entry of a feature, if it has one.
const SimulatedFeaturePlan* entry_of(const SimulationPlan& simulation, const FeaturePlan& feature) {
  const auto own =
      std::find_if(simulation.features.begin(), simulation.features.end(),
                   [&](const SimulatedFeaturePlan& entry) { return entry.id == feature.id; });
  return own == simulation.features.end() ? nullptr : &*own;
}

const SimulatedFormPlan& form_of(const SimulationPlan& simulation, const FeaturePlan& feature) {
  if (const SimulatedFeaturePlan* own = entry_of(simulation, feature)) return *own;
  return simulation.part;
}

void put_marks(const SimulationPlan& simulation, const FeaturePlan& feature, double middle_mm,
               cmm::PartSurface& out) {
  for (const KeywayPlan& key : form_of(simulation, feature).keyways) {
    auto slot = mark(key.at_deg, key.z_mm - middle_mm, key.width_mm, key.length_mm);
    slot.height_mm = -key.depth_mm;
    slot.flank_mm = std::min(slot.flank_mm, kKeywayFlank_mm);
    out.marks.push_back(slot);
  }
  if (const SimulatedFeaturePlan* own = entry_of(simulation, feature)) {
    for (const FlatPlan& flat : own->flats) {
      auto spot = mark(flat.at_deg, flat.z_mm - middle_mm, flat.width_mm, flat.length_mm);
      spot.height_mm = -flat.depth_um * core::kMicrometre;
      out.marks.push_back(spot);
    }
    return;
  }
  for (const BurrPlan& burr : simulation.part.burrs) {
    auto spot = mark(burr.at_deg, burr.z_mm - middle_mm, burr.width_mm, burr.length_mm);
    spot.height_mm = burr.height_um * core::kMicrometre;
    out.marks.push_back(spot);
  }
}

std::vector<cmm::Lobe> lobes_of(const SimulatedFormPlan& form) {
  std::vector<cmm::Lobe> out;
  for (const LobePlan& lobe : form.lobes) {
    out.push_back({lobe.order, lobe.amplitude_um * core::kMicrometre,
                   lobe.phase_deg * core::kDegree, lobe.twist_deg * core::kDegree});
  }
  return out;
}

cmm::SimulatedPart::Placed placed_face(const SimulationPlan& simulation,
                                       const FeaturePlan& feature) {
  const NominalPlan& n = feature.nominal;
  cmm::FaceSurface face;
  face.inner_mm = 0.5 * n.from_diameter_mm;
  face.outer_mm = 0.5 * n.to_diameter_mm;
  face.mirrored = n.faces == record::Faces::kDown;
  if (const SimulatedFeaturePlan* own = entry_of(simulation, feature)) {
    face.tilt_rad = own->tilt_urad * kMicroradian;
    face.toward_rad = own->tilt_toward_deg * core::kDegree;
    face.saucer_mm = own->saucer_um * core::kMicrometre;
    face.wave_mm = own->wave_um * core::kMicrometre;
    face.wave_order = own->wave_order;
  }
  Eigen::Isometry3d X_PS = Eigen::Isometry3d::Identity();
  X_PS.translation().z() = n.z_mm;
  if (face.mirrored) X_PS.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  return {face, X_PS};
}

/// Whether a face takes the place of a flat end at this height.
bool is_faced(const std::vector<FeaturePlan>& features, double z_mm, record::Faces faces) {
  constexpr double kOnePlane_mm = 0.5;
  return std::any_of(features.begin(), features.end(), [&](const FeaturePlan& f) {
    return f.type == record::Shape::kPlane && is_touched(f) &&
           f.nominal.faces.value_or(record::Faces::kUp) == faces &&
           std::abs(f.nominal.z_mm - z_mm) < kOnePlane_mm;
  });
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
  const SimulatedFormPlan& form = form_of(simulation, feature);
  cmm::PartSurface out;
  out.radius_mm = 0.5 * (feature.nominal.diameter_mm + form.diameter_error_um * core::kMicrometre);
  out.half_length_mm = 0.5 * (feature.nominal.to_mm - feature.nominal.from_mm);
  out.inside = feature.side == record::Side::kInside;
  out.form.lobes = lobes_of(form);
  out.form.taper_mm = form.taper_um * core::kMicrometre;
  out.form.barrel_mm = form.barrel_um * core::kMicrometre;
  out.form.bend_mm = form.bend_um * core::kMicrometre;
  out.form.bend_phase_rad = form.bend_phase_deg * core::kDegree;
  if (feature.type == record::Shape::kCone) {
    // The nominal diameter is at the lower end, the frame at mid-length.
    const double widens_mm =
        out.half_length_mm * std::tan(feature.nominal.half_angle_deg * core::kDegree);
    out.radius_mm += widens_mm;
    out.form.taper_mm += widens_mm;
  }
  put_marks(simulation, feature, 0.5 * (feature.nominal.from_mm + feature.nominal.to_mm), out);
  return out;
}

bool has_whole_part(const Plan& plan) {
  if (!plan.simulation->features.empty()) return true;
  return std::any_of(plan.features.begin(), plan.features.end(), [](const FeaturePlan& f) {
    return is_touched(f) && f.type != record::Shape::kCylinder && f.type != record::Shape::kCircle;
  });
}

cmm::SimulatedPart::Placed placed_surface(const SimulationPlan& simulation,
                                          const FeaturePlan& feature) {
  if (feature.type == record::Shape::kPlane) return placed_face(simulation, feature);
  const NominalPlan& n = feature.nominal;
  const bool ball = feature.type == record::Shape::kSphere;
  cmm::SimulatedPart::Placed out;
  out.X_PS.translation() =
      ball ? vector3(n.center_mm) : Eigen::Vector3d(0.0, 0.0, 0.5 * (n.from_mm + n.to_mm));
  if (const SimulatedFeaturePlan* own = entry_of(simulation, feature)) {
    out.X_PS.translation().head<2>() +=
        Eigen::Vector2d(own->offset_x_um, own->offset_y_um) * core::kMicrometre;
    const Eigen::Vector3d axis(own->slope_x_urad * kMicroradian, own->slope_y_urad * kMicroradian,
                               1.0);
    out.X_PS.linear() = core::shortest_turn(Eigen::Vector3d::UnitZ(), axis);
  }
  if (!ball) {
    out.surface = simulated_surface(simulation, feature);
    return out;
  }
  const SimulatedFormPlan& form = form_of(simulation, feature);
  out.surface = cmm::BallSurface{0.5 * (n.diameter_mm + form.diameter_error_um * core::kMicrometre),
                                 lobes_of(form)};
  return out;
}

cmm::SimulatedPart simulated_part(const std::vector<FeaturePlan>& features,
                                  const SimulationPlan& simulation, const FeaturePlan& mounted) {
  cmm::SimulatedPart out;
  const bool bore = mounted.side == record::Side::kInside;
  for (const FeaturePlan& feature : features) {
    const bool own = feature.id == mounted.id;
    if (!is_touched(feature) || (!own && (bore || feature.side == record::Side::kInside))) continue;
    cmm::SimulatedPart::Placed placed = placed_surface(simulation, feature);
    if (auto* round = std::get_if<cmm::PartSurface>(&placed.surface)) {
      round->upper_end = !is_faced(features, feature.nominal.to_mm, record::Faces::kUp);
      round->lower_end = !is_faced(features, feature.nominal.from_mm, record::Faces::kDown);
    }
    out.surfaces.push_back(std::move(placed));
  }
  return out;
}

}  // namespace rondure::plans
