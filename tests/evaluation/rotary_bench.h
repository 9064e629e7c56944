#pragma once

// Simulated calibrations of a fixture with known errors by a plate of five balls.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <numbers>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/QR>

#include "core/noise.h"
#include "core/units.h"
#include "evaluation/analysis_result.h"
#include "evaluation/evaluate.h"
#include "evaluation/results/internal/fixture_use.h"
#include "evaluation/rotary/internal/axis_extreme.h"
#include "evaluation/rotary/internal/combined_field.h"
#include "evaluation/rotary/internal/gates.h"
#include "evaluation/rotary/result.h"
#include "fit/rotary/errors.h"
#include "fixture/calibration.h"
#include "fixture/simulated.h"
#include "record/tasks/rotary_axes.h"
#include "record/tasks/run.h"
#include "record/tasks/settings.h"
#include "reports/data/corrections.h"
#include "reports/formats/exports.h"
#include "tests/core/full.h"
#include "tests/fit/rotary_cases.h"

namespace rondure::evaluation::rotary_bench {

using core::kDegree;
using core::kMicrometre;
using core::kMicroradian;
using Eigen::Vector3d;

inline constexpr double kPlateBallRadius_mm = 5.0;
inline constexpr double kTip_mm = 2.0;
inline constexpr double kStep_deg = 15.0;

/// How a simulated calibration is made.
struct Bench {
  double noise_mm = 0.35e-3;     ///< Of a touch.
  double setting_rad = 0.0;      ///< Standard deviation of a reading from its command.
  double reading_rad = 0.0;      ///< Standard deviation of the truth from the reading.
  double resolution_deg = 0.05;  ///< As the driver states it.
  double setting_uncertainty_deg = 0.0;
  double temperature_degC = 20.1;
  std::optional<record::RotaryInfluencesTask> declared;
  /// Changes a visit after it was simulated, the touches following it.
  std::function<void(core::Pose& reached, int visit)> disturb;
  bool exact_tip = true;  ///< Qualified without noise.
  std::uint64_t seed = 1;
};

inline fixture::SimulatedFixtureOptions fixture_options() {
  fixture::SimulatedFixtureOptions out;
  out.kinematics.axis_point_W_mm = {0.0, 0.0, 150.0};
  out.kinematics.axis_offset_mm = {0.4, -0.3, 12.0};
  out.limits = {-1.6, 1.6, -1.6, 1.6, 0.0};
  const fixture::MotionClass size{25e-3, 120e-6, 3e-3, 15e-6, 1};
  out.errors.alpha_motion = fixture::drawn_motion(size, Vector3d::UnitX(), 1);
  out.errors.beta_motion = fixture::drawn_motion(size, Vector3d::UnitY(), 2);
  return out;
}

inline std::vector<record::BallTask> five_balls() {
  return {{"B1", {-70, 35, 20}},
          {"B2", {-35, -70, 60}},
          {"B3", {0, 0, 90}},
          {"B4", {35, 70, 40}},
          {"B5", {70, -35, 70}}};
}

inline std::vector<core::Pose> poses() {
  std::vector<core::Pose> out;
  const auto stations = [&](bool alpha) {
    for (int k = -4; k <= 4; ++k) {
      const double angle = k * kStep_deg * kDegree;
      if (k != 0) out.push_back(alpha ? core::Pose{angle, 0.0} : core::Pose{0.0, angle});
    }
  };
  out.push_back({});
  stations(false);
  out.push_back({});
  stations(true);
  for (const auto& [a, b] :
       {std::pair(30.0, -45.0), std::pair(-45.0, 30.0), std::pair(50.0, 50.0),
        std::pair(-50.0, -30.0), std::pair(20.0, 55.0), std::pair(-25.0, -55.0)}) {
    out.push_back({a * kDegree, b * kDegree});
  }
  out.push_back({});
  return out;
}

inline void touch(record::RunRecord& run, const Vector3d& center_mm, double radius_mm, int pose,
                  int layer, const Bench& bench, core::KeyedNoise& noise) {
  for (int i = 0; i < 9; ++i) {
    const double up = i == 0 ? 1.0 : i < 5 ? 0.6 : 0.05;
    const double turn = 0.5 * std::numbers::pi * i + (i < 5 ? 0.0 : 0.7);
    const double across = std::sqrt(1.0 - up * up);
    const Vector3d n(across * std::cos(turn), across * std::sin(turn), up);
    record::Touch row;
    row.id = static_cast<std::int64_t>(run.touches.size());
    row.pose = pose;
    row.layer = layer;
    row.point = i;
    row.purpose =
        pose < 0 ? record::Touch::Purpose::kQualification : record::Touch::Purpose::kMeasure;
    row.tip_mm = center_mm + (radius_mm + kTip_mm + bench.noise_mm * noise.normal()) * n;
    row.approach = -n;
    row.temperature_degC = bench.temperature_degC;
    run.touches.push_back(row);
  }
}

inline record::RunRecord calibration_run(const Bench& bench) {
  record::RunRecord run;
  run.ending = "finished";
  run.header.run_id = "calibration";
  run.header.started_utc = "2026-11-21T10:00:00Z";
  run.header.decision_rule = "simple-acceptance";
  run.header.temperature_min_degC = 18.0;
  run.header.temperature_max_degC = 22.0;
  run.artefact = {12.5, kTip_mm, 0.1, 0.01};
  record::RotaryTask task;
  task.balls = five_balls();
  task.points = 9;
  task.uncertainty = bench.declared;
  record::Feature feature;
  feature.id = "fixture F-01";
  feature.shape = record::Shape::kRotaryAxes;
  feature.strategy = record::Strategy::kStations;
  feature.characteristics = {
      {"largest", record::Form::kFixtureResidual, record::Reference::kLeastSquares, 20e-3, ""},
      {"rms", record::Form::kFixtureResidualRms, record::Reference::kLeastSquares, 10e-3, ""}};
  const fixture::SimulatedFixtureOptions hidden = fixture_options();
  record::FixtureSettings fixture;
  fixture.id = "F-01";
  for (int i = 0; i < 3; ++i) {
    fixture.axis_point_mm[static_cast<std::size_t>(i)] = hidden.kinematics.axis_point_W_mm(i);
    fixture.axis_offset_mm[static_cast<std::size_t>(i)] = hidden.kinematics.axis_offset_mm(i);
  }
  fixture.resolution_deg = bench.resolution_deg;
  fixture.setting_uncertainty_deg = bench.setting_uncertainty_deg;
  run.settings = record::settings_of_task(fixture, "fixture/");
  core::KeyedNoise noise(bench.seed, {1});
  // An error of the tip radius shifts all balls alike; it is not among the influences.
  Bench exact = bench;
  if (bench.exact_tip) exact.noise_mm = 0.0;
  touch(run, {300.0, 0.0, 100.0}, 12.5, -1, 0, exact, noise);
  fixture::Kinematics real = hidden.kinematics;
  real.alpha_motion = hidden.errors.alpha_motion;
  real.beta_motion = hidden.errors.beta_motion;
  const std::vector<core::Pose> commands = poses();
  for (std::size_t k = 0; k < commands.size(); ++k) {
    const int visit = static_cast<int>(k);
    const core::Pose& commanded = commands[k];
    // A setting beyond two standard deviations is repeated.
    const auto set = [&] { return bench.setting_rad * std::clamp(noise.normal(), -2.0, 2.0); };
    core::Pose reached{commanded.alpha_rad + set(), commanded.beta_rad + set()};
    if (bench.disturb) bench.disturb(reached, visit);
    const core::Pose truth{reached.alpha_rad + bench.reading_rad * noise.normal(),
                           reached.beta_rad + bench.reading_rad * noise.normal()};
    run.poses.push_back({visit, 0, commanded, reached, false, 0.0});
    const Eigen::Isometry3d X_WB = fixture::body_to_machine(real, truth);
    for (std::size_t b = 0; b < task.balls.size(); ++b) {
      const Vector3d center = Vector3d::Map(task.balls[b].center_mm.data());
      touch(run, X_WB * center, kPlateBallRadius_mm, visit, static_cast<int>(b), bench, noise);
    }
  }
  feature.settings = record::settings_of_task(std::move(task));
  run.features.push_back(std::move(feature));
  return run;
}

inline const RotaryResult* result_of(const FeatureResult& feature) {
  return feature.analysis ? std::get_if<RotaryResult>(&feature.analysis->found) : nullptr;
}

inline const Gate* rotary_gate(const FeatureResult& feature, std::string_view code) {
  const auto at = std::find_if(feature.gates.begin(), feature.gates.end(),
                               [&](const Gate& gate) { return gate.code == code; });
  return at == feature.gates.end() ? nullptr : &*at;
}

/// Share of the errors of both axes that lie within 1.96 u of the truth.
inline double share_inside(const RotaryResult& found) {
  const fixture::SimulatedFixture hidden(fixture_options());
  double inside = 0.0;
  double all = 0.0;
  for (const AxisFacts& axis : axes_of(found)) {
    for (const fixture::AxisStation& station : axis.motion->stations()) {
      if (std::abs(station.angle_rad) < 0.1) continue;  // zero by definition
      const auto truth =
          hidden.true_errors(std::string_view(axis.key) == "beta", station.angle_rad);
      for (Eigen::Index k = 0; k < 6; ++k) {
        const double off = k < 3 ? station.errors.shift_mm(k) - truth.shift_mm(k)
                                 : station.errors.tilt_rad(k - 3) - truth.tilt_rad(k - 3);
        inside += std::abs(off) <= 1.96 * std::sqrt(station.covariance(k, k)) ? 1.0 : 0.0;
        all += 1.0;
      }
    }
  }
  return inside / all;
}

/// The file that the run writes for others.
inline std::string written(const record::RunRecord& run, const Evaluation& evaluation) {
  for (const reports::Export& one : reports::exports()) {
    if (one.file == std::string_view("fixture-calibration.json")) {
      return reports::render(one, run, evaluation);
    }
  }
  return {};
}

}  // namespace rondure::evaluation::rotary_bench
