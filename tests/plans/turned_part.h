#pragma once

#include "core/units.h"
#include "tests/plans/files.h"

namespace rondure::plans::testing {

/// A turned part with two journals, the face of a flange between them, a cone and a ball above, all
/// measured in one pose on an ideal machine. The face and journal A have the form and place of part
/// V1 (drawing, section 10).
inline Plan turned_part() {
  using record::Shape;
  Plan plan = plan_of("08_shaft_scanned.json");
  plan.part.location_uncertainty_mm = 0.0;
  plan.part.expansion_per_K.reset();
  plan.part.sections = {{-10.0, 0.0, 60.0, 0.0}};
  plan.machine->scale_expansion_per_K.reset();
  plan.simulation = SimulationPlan();
  plan.simulation->seed = 20261121;
  plan.features.clear();
  const auto add = [&](const char* id, Shape type, const NominalPlan& nominal, double margin_mm) {
    FeaturePlan& out = plan.features.emplace_back();
    out.id = id;
    out.type = type;
    out.nominal = nominal;
    out.sampling.layers = 2;
    out.sampling.points_per_layer = 6;
    out.sampling.margin_mm = margin_mm;
    out.pose_search.strategy = record::Strategy::kStartPose;
    out.pose_search.repeats = 1;
  };
  add("journal B", Shape::kCylinder, {30.0, -40.0, -10.0}, 8.0);
  add("journal A", Shape::kCylinder, {30.0, 0.0, 30.0}, 8.0);
  NominalPlan face;
  face.from_diameter_mm = 30.0;
  face.to_diameter_mm = 60.0;
  face.faces = record::Faces::kUp;
  add("face", Shape::kPlane, face, 5.0);
  NominalPlan cone = {30.0, 30.0, 50.0};
  cone.half_angle_deg = -10.0;
  add("cone", Shape::kCone, cone, 6.0);
  NominalPlan ball = {30.0, 58.0, 76.0};
  ball.center_mm = {0.0, 0.0, 62.0};
  add("ball", Shape::kSphere, ball, 4.0);

  SimulatedFeaturePlan own;
  own.id = "journal A";
  own.offset_x_um = 4.8;
  own.offset_y_um = 3.1;
  own.slope_x_urad = 20.0;
  own.slope_y_urad = -40.0;
  own.lobes = {{2, 1.6, -0.2 / core::kDegree, 0.0}};
  own.taper_um = 3.0;
  plan.simulation->features.push_back(own);
  own = {};
  own.id = "face";
  own.tilt_urad = 70.0;
  own.tilt_toward_deg = 0.9 / core::kDegree;
  own.saucer_um = -4.2;
  own.wave_um = 1.2;
  plan.simulation->features.push_back(own);
  return plan;
}

}  // namespace rondure::plans::testing
