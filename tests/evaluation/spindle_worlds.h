#pragma once

// Simulated measurements by three probes, right and wrong ones: the worked cases S-1, S-2 and S-4
// of the method, analyses_uncertainty 13.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/noise.h"
#include "core/units.h"
#include "evaluation/evaluate.h"
#include "evaluation/results/evaluation.h"
#include "evaluation/spindle/result.h"
#include "fit/profiles/profile_filter.h"
#include "fit/spindle/axis_motion.h"
#include "fit/spindle/first_harmonic.h"
#include "fit/spindle/separation_model.h"
#include "record/run_record.h"
#include "record/tasks/settings.h"
#include "record/tasks/spindle.h"
#include "tests/fit/specified_normals.h"
#include "tests/fit/three_probe_cases.h"

namespace rondure::evaluation::spindle_worlds {

using core::kDegree;
using core::kMicrometre;

inline const fit::SwingArm kArm = {49.0, 299.88, 24.56};

/// What is wrong with the probes of a simulated measurement.
struct World {
  fit::ProbeLayout layout = fit::published_layout_a();
  std::array<double, 3> gain = {0.0, 0.0, 0.0};
  std::array<double, 3> angle_deg = {0.0, 0.0, 0.0};
  std::array<double, 3> zero_um = {1.2, -0.7, 0.4};
  double eccentricity_um = 6.0;
  double noise_um = 0.0;
  int turns = 1;
  int samples = 1024;
  std::uint64_t seed = 2;
  std::vector<fit::Wave> chatter;  ///< Of the part, beside the profile of the worked cases.
  double tip_mm = 0.0;             ///< Diameter of the spot of each probe.
  bool specified = false;          ///< Noise as the specification draws it: turn, probe, sample.
};

inline double x_um(double a) {
  return 0.7 * std::cos(2 * a + 1) + 0.4 * std::cos(5 * a - 0.5) + 0.3 * std::sin(9 * a);
}
inline double y_um(double a) {
  return 0.9 * std::cos(3 * a) + 0.5 * std::sin(4 * a + 0.7) + 0.25 * std::cos(13 * a);
}

/// The mean of cos(k s / R) over a disc of this diameter, by its series; 2 J1(x)/x.
inline double mean_over_disc(int order, double diameter_mm) {
  const double half = 0.25 * order * diameter_mm / kArm.pin_radius_mm;
  double term = 1.0;
  double sum = 1.0;
  for (int m = 1; m < 30; ++m) sum += term *= -half * half / (m * (m + 1.0));
  return sum;
}

inline double seen(std::vector<fit::Wave> waves, double theta, double tip_mm) {
  for (fit::Wave& wave : waves) wave.amplitude_um *= mean_over_disc(wave.order, tip_mm);
  return fit::sum_of(waves, theta);
}

/// The exact distance along the line of probe i.
inline double exact_um(const World& world, std::size_t i, double alpha) {
  const fit::SpindleCase part;
  const double beta = kArm.beta_rad(alpha);
  const double place = world.layout.angles_rad()[i] + world.angle_deg[i] * kDegree;
  const double direction = place + beta;
  const double along = y_um(alpha) * std::cos(direction) + x_um(alpha) * std::sin(direction);
  const double across = x_um(alpha) * std::cos(direction) - y_um(alpha) * std::sin(direction);
  const auto profile = [&](double theta) {
    return seen(part.profile, theta, world.tip_mm) + seen(world.chatter, theta, world.tip_mm) +
           world.eccentricity_um * std::cos(theta - 35.0 * kDegree);
  };
  const double radius_um = kArm.pin_radius_mm / kMicrometre;
  double reading = profile(alpha + beta + place) + along;
  for (int pass = 0; pass < 5; ++pass) {
    const double shift = std::atan2(across, radius_um + reading - along);
    const double rho = radius_um + profile(alpha + beta + place - shift);
    reading = along + std::sqrt(rho * rho - across * across) - radius_um;
  }
  return reading * (1.0 + world.gain[i]) + world.zero_um[i];
}

inline void add_specified_noise(const World& world, fit::ProbeReadings& readings) {
  test::SpecifiedNormals normals(world.seed);
  const auto samples = static_cast<std::size_t>(world.samples);
  for (std::size_t turn = 0; turn < static_cast<std::size_t>(world.turns); ++turn) {
    for (auto& h : readings.h_mm) {
      for (std::size_t m = 0; m < samples; ++m) {
        h[turn * samples + m] += world.noise_um * normals.next() * kMicrometre;
      }
    }
  }
}

inline fit::ProbeReadings readings_of(const World& world) {
  fit::ProbeReadings out;
  core::KeyedNoise noise(world.seed, {1});
  for (int m = 0; m < world.turns * world.samples; ++m) {
    const double alpha = core::kTwoPi * m / world.samples;
    out.alpha_rad.push_back(alpha);
    for (std::size_t i = 0; i < 3; ++i) {
      const bool here = world.noise_um > 0.0 && !world.specified;
      const double drawn = here ? world.noise_um * noise.normal() : 0.0;
      out.h_mm[i].push_back((exact_um(world, i, alpha) + drawn) * kMicrometre);
    }
  }
  if (world.specified) add_specified_noise(world, out);
  return out;
}

inline fit::ThreeProbeResult separation_of(const World& world, double stated_noise_um) {
  fit::ThreeProbeOptions options;
  options.samples = 512;
  options.noise_mm = stated_noise_um * kMicrometre;
  options.second_order = fit::ThreeProbeOptions::SecondOrder::kOff;
  return fit::separate_three_probe(readings_of(world), kArm, world.layout, options).value();
}

inline fit::ProbeErrorCovariance prior_of(double gain, double angle_deg) {
  fit::ProbeErrorCovariance out = fit::ProbeErrorCovariance::Zero();
  for (int i = 0; i < 3; ++i) {
    out(fit::kFirstGain + i, fit::kFirstGain + i) = gain * gain;
    out(fit::kFirstAngle + i, fit::kFirstAngle + i) = std::pow(angle_deg * kDegree, 2.0);
  }
  return out;
}

/// RONt about LSCI at 50 UPR, RONq, and synchronous motion [um].
struct SpindleFound {
  double ront_um = 0.0;
  double ronq_um = 0.0;
  double sync_um = 0.0;
};

inline SpindleFound found_at(const fit::SeparationModel& model, const fit::ProbeErrors& q) {
  fit::SpindleCurves curves = model.at(q);
  for (int k = 2; k <= 50; ++k)
    curves.profile_mm.segment(2 * (k - 2), 2) *= std::exp2(-std::pow(k / 50.0, 2.0));
  const Eigen::VectorXd r = model.profile_waves() * curves.profile_mm;
  const Eigen::VectorXd x = model.motion_waves() * curves.x_mm;
  const Eigen::VectorXd y = model.motion_waves() * curves.y_mm;
  return {(r.maxCoeff() - r.minCoeff()) / kMicrometre,
          std::sqrt(0.5) * curves.profile_mm.norm() / kMicrometre,
          std::max(x.maxCoeff() - x.minCoeff(), y.maxCoeff() - y.minCoeff()) / kMicrometre};
}

inline record::DeclaredInfluence declared_probe(double value) { return {.value = value}; }

inline record::Characteristic asked(const std::string& id, record::Form form,
                                    std::optional<double> tolerance_um) {
  record::Characteristic out;
  out.id = id;
  out.form = form;
  out.reference = record::Reference::kLeastSquares;
  if (tolerance_um) out.tolerance_mm = *tolerance_um * kMicrometre;
  return out;
}

/// A finished run of one spindle that asks for everything with wide limits.
inline record::RunRecord run_of(const World& world,
                                std::optional<record::SpindleInfluencesTask> influences,
                                const std::function<void(fit::ProbeReadings&)>& spoil = nullptr) {
  record::SpindleTask task;
  const auto angles = world.layout.angles_rad();
  task.p1_to_p2_deg = angles[1] / kDegree;
  task.p1_to_p3_deg = angles[2] / kDegree;
  task.crank_radius_mm = kArm.crank_radius_mm;
  task.wheel_radius_mm = kArm.wheel_radius_mm;
  task.pin_radius_mm = kArm.pin_radius_mm;
  task.samples = 512;
  task.second_order = record::SpindleTask::SecondOrder::kOff;
  if (world.noise_um > 0.0) task.probe_noise_um = world.noise_um;
  task.uncertainty = influences;
  record::RunRecord run;
  run.header.run_id = "spindle";
  run.ending = "finished";
  record::Feature feature;
  feature.id = "pin";
  feature.shape = record::Shape::kSpindle;
  feature.strategy = record::Strategy::kSeries;
  feature.settings = record::settings_of_task(task);
  feature.characteristics = {asked("RONt", record::Form::kRoundness, 100.0),
                             asked("RONq", record::Form::kRoundnessRms, 100.0),
                             asked("sync", record::Form::kMotionSynchronous, 100.0)};
  run.features = {feature};
  fit::ProbeReadings readings = readings_of(world);
  if (spoil) spoil(readings);
  record::Series data;
  data.columns = {{"alpha_deg", "deg"}, {"H1_um", "um"}, {"H2_um", "um"}, {"H3_um", "um"}};
  for (std::size_t m = 0; m < readings.alpha_rad.size(); ++m) {
    data.values.push_back(readings.alpha_rad[m] / kDegree);
    for (const auto& h : readings.h_mm) data.values.push_back(h[m] / kMicrometre);
  }
  run.series = {data};
  return run;
}

inline FeatureResult result_of(const record::RunRecord& run) {
  const auto found = evaluate(run);
  EXPECT_TRUE(found) << (found ? "" : found.error().what);
  return found->features.at(0);
}

inline const Gate& gate(const FeatureResult& result, const std::string& code) {
  const auto found = std::find_if(result.gates.begin(), result.gates.end(),
                                  [&](const Gate& one) { return one.code == code; });
  EXPECT_NE(found, result.gates.end()) << code;
  return *found;
}

inline record::SpindleInfluencesTask probes(double gain, double angle_deg) {
  record::SpindleInfluencesTask out;
  out.gain_1 = declared_probe(gain);
  out.angle_deg = declared_probe(angle_deg);
  return out;
}

/// Four turns of 1024 readings of the reference layout, s = 0.02 um, P2's gain 1 % off.
inline World readings_of_a_wrong_gain() {
  World world;
  world.layout = fit::reference_layout();
  world.gain = {0.0, 0.01, 0.0};
  world.noise_um = 0.02;
  world.turns = 4;
  return world;
}

}  // namespace rondure::evaluation::spindle_worlds
