#include "random_inspection.h"

#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "cmm/simulated/part.h"
#include "core/noise.h"
#include "core/units.h"
#include "evaluation/analysis_result.h"
#include "evaluation/evaluate.h"
#include "evaluation/handed_calibration.h"
#include "fit/references/min_zone.h"
#include "fit/zone/center_search.h"
#include "plans/cell/internal/hidden_errors.h"
#include "plans/run/runner.h"
#include "record/journal/journal.h"
#include "tests/core/scratch.h"

namespace rondure::test {
namespace {

/// Zone of the surface on a grid of 60 x 21 points, to scale the form with.
double dense_zone_mm(const plans::Plan& plan) {
  const auto surface = plans::simulated_surface(*plan.simulation, plan.features.front());
  std::vector<Eigen::Vector3d> grid;
  for (int j = 0; j < 21; ++j) {
    for (int k = 0; k < 60; ++k) {
      const double z = surface.half_length_mm * (j / 10.0 - 1.0);
      const double theta = core::kTwoPi * k / 60.0;
      const double r = surface.radius_at(theta, z);
      grid.emplace_back(r * std::cos(theta), r * std::sin(theta), z);
    }
  }
  return fit::min_zone_cylinder(grid, Eigen::Vector3d::UnitZ())->width_mm();
}

void scale_form(plans::SimulatedPartPlan& part, double factor) {
  for (auto& lobe : part.lobes) lobe.amplitude_um *= factor;
  part.taper_um *= factor;
  part.barrel_um *= factor;
  part.bend_um *= factor;
}

double zone_along(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d x = direction.unitOrthogonal();
  const Eigen::Vector3d y = direction.cross(x);
  std::vector<Eigen::Vector2d> flat;
  for (const auto& p : points) flat.emplace_back(p.dot(x), p.dot(y));
  return fit::center_search(flat)->width_mm();
}

}  // namespace

plans::Plan random_plan(std::uint64_t seed, const std::string& strategy, double resolution_deg) {
  core::KeyedNoise noise(seed, {12});
  plans::Plan plan;
  plan.plan = {"random part", "A", ""};
  plan.part.id = "R";
  plan.part.location_uncertainty_mm = 15.0;
  plan.machine.emplace();
  plan.fixture.emplace();
  plan.fixture->axis_point_mm = {0.0, 0.0, 150.0};
  plan.fixture->axis_offset_mm = {0.4, -0.3, 12.0};
  plan.fixture->resolution_deg = resolution_deg;
  plan.probe.emplace();
  plan.probe->qualification.sphere_center_mm = {400.0, 0.0, 100.0};
  plans::FeaturePlan feature;
  feature.id = "surface";
  feature.nominal = {50.0, -40.0, 40.0};
  feature.pose_search.strategy = record::value_named<record::Strategy>(strategy).value();
  feature.pose_search.repeats = 1;
  feature.characteristics.push_back(
      {"CYLt", record::Form::kCylindricity, record::Reference::kMinimumZone, 25.0, "", {}});
  plan.features.push_back(feature);

  plan.simulation.emplace();
  plan.simulation->seed = seed;
  plans::SimulatedPartPlan& part = plan.simulation->part;
  for (const int order : {2, 3, 4, 5, 7}) {
    part.lobes.push_back({order, noise.normal() / std::sqrt(order), 360.0 * noise.uniform(),
                          (2.0 * noise.uniform() - 1.0) / core::kDegree});
  }
  part.taper_um = 0.5 * noise.normal();
  part.barrel_um = 0.5 * noise.normal();
  part.bend_um = 0.5 * noise.normal();
  part.bend_phase_deg = 360.0 * noise.uniform();
  part.tilt_deg = 20.0 * noise.uniform();
  part.tilt_toward_deg = 360.0 * noise.uniform();
  const double form_um = 5.0 + 15.0 * noise.uniform();
  scale_form(part, form_um * core::kMicrometre / dense_zone_mm(plan));
  return plan;
}

plans::FoundCalibration calibrated(const record::RunRecord& so_far, int feature) {
  const auto found =
      evaluation::handed_calibration(evaluation::evaluate_calibration(so_far, feature));
  return {found.text, found.void_because ? found.void_because->english() : ""};
}

Inspection inspect(const plans::Plan& plan) {
  const Scratch directory;
  plans::RunOptions options;
  options.directory = directory / "run";
  options.run_id = "test";
  options.started_utc = "2026-11-29T10:00:00Z";
  options.calibrate = calibrated;
  Inspection out;
  {
    const auto run = plans::run_plan(plan, options);
    if (!run) ADD_FAILURE() << core::to_line(run.error());
    if (run && run->failure) ADD_FAILURE() << core::to_line(*run->failure);
    if (run) out.record = record::read_journal(options.directory)->record;
  }
  const auto evaluation = evaluation::evaluate(out.record);
  if (!evaluation) ADD_FAILURE() << core::to_line(evaluation.error());
  if (evaluation) out.evaluation = *evaluation;
  return out;
}

std::vector<Eigen::Vector3d> final_cloud(const record::RunRecord& record) {
  std::vector<Eigen::Vector3d> out;
  for (const record::Touch& touch : record.touches) {
    if (touch.pose >= 0 && record.poses[static_cast<std::size_t>(touch.pose)].final_cloud) {
      out.push_back(touch.tip_mm);
    }
  }
  return out;
}

double searched_zone_mm(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& near,
                        std::uint64_t seed) {
  core::KeyedNoise noise(seed, {13});
  const Eigen::Vector3d x = near.unitOrthogonal();
  const Eigen::Vector3d y = near.cross(x);
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  const auto zone = [&](const Eigen::Vector2d& t) {
    return zone_along(points, (near + t.x() * x + t.y() * y).normalized());
  };
  double best = zone(at);
  const auto offer = [&](const Eigen::Vector2d& t) {
    const double found = zone(t);
    if (found >= best) return false;
    best = found;
    at = t;
    return true;
  };
  for (double size = 0.02; size > 1e-11; size *= 0.6) {
    for (int k = 0; k < 24; ++k) {
      const double angle = core::kTwoPi * noise.uniform();
      while (offer(at + size * Eigen::Vector2d(std::cos(angle), std::sin(angle)))) {
      }
    }
  }
  return best;
}

}  // namespace rondure::test
