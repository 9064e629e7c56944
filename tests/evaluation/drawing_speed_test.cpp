// Time of a drawing: 20 call-outs on two scanned journals, judged with uncertainty.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Core>

#include "core/noise.h"
#include "core/units.h"
#include "evaluation/evaluate.h"
#include "record/tasks/uncertainty.h"
#include "tests/core/full.h"
#include "tests/core/processor_time.h"
#include "tests/evaluation/points_run.h"

namespace rondure::evaluation {
namespace {

using record::Characteristic;
using record::Form;
using record::Reference;
using Indication = record::Indication;

constexpr int kLayers = 5;
constexpr int kPoints = 720;

/// A ground journal: lobes, taper, barrel and noise of some 2 um together.
std::vector<std::vector<Eigen::Vector3d>> ground_journal(std::uint64_t number, double low_mm,
                                                         double off_mm) {
  core::KeyedNoise noise(20261123, {number});
  const double turn = core::kTwoPi * noise.uniform();
  std::vector<std::vector<Eigen::Vector3d>> out(kLayers);
  for (int j = 0; j < kLayers; ++j) {
    const double q = 2.0 * j / (kLayers - 1) - 1.0;
    for (int i = 0; i < kPoints; ++i) {
      const double t = core::kTwoPi * i / kPoints;
      const double form = 0.5 * std::cos(2.0 * t + turn) + 0.3 * std::cos(3.0 * t - turn) +
                          0.2 * std::cos(15.0 * t) + 0.3 * q - 0.3 * q * q + 0.05 * noise.normal();
      const double r = 16.5 + form * core::kMicrometre;
      const double x = off_mm + 0.5e-3 * q * q;
      const double y = 0.2e-3 * std::sin(2.0 * q);
      out[static_cast<std::size_t>(j)].emplace_back(x + r * std::cos(t), y + r * std::sin(t),
                                                    low_mm + 10.0 * (q + 1.0));
    }
  }
  return out;
}

Characteristic call_out(const std::string& id, Form form, double tolerance_um) {
  return {id, form, Reference::kMinimumZone, tolerance_um * core::kMicrometre, ""};
}

/// 30h6 or, with a requirement, 30h6 E.
Characteristic diameter(const std::string& id, Indication::Size size,
                        Indication::Requirement requirement = Indication::Requirement::kNone) {
  Characteristic out{id, Form::kDiameter, Reference::kMinimumZone, 30.006, "", {}, 29.993};
  out.indication.size = size;
  out.indication.requirement = requirement;
  return out;
}

Characteristic about(const std::string& datum, Characteristic out) {
  out.indication.datum = {datum};
  return out;
}

Characteristic at_50_upr(Characteristic out) {
  out.indication.filter = Indication::Filter::kGaussian;
  out.indication.cutoff_upr = 50.0;
  return out;
}

/// Ten call-outs of one journal.
std::vector<Characteristic> call_outs(const std::string& datum) {
  Characteristic median = call_out("STRt median 2", Form::kStraightness, 2.0);
  median.indication.of = Indication::Of::kMedianLine;
  return {diameter("30h6 E", Indication::Size::kLP, Indication::Requirement::kEnvelope),
          diameter("30h6 GG", Indication::Size::kGG),
          call_out("CYLt 6", Form::kCylindricity, 6.0),
          at_50_upr(call_out("RONt 4", Form::kRoundness, 4.0)),
          call_out("STRt 4", Form::kStraightness, 4.0),
          median,
          call_out("taper 4", Form::kTaper, 4.0),
          about(datum, call_out("coaxiality 20", Form::kCoaxiality, 20.0)),
          about(datum, call_out("run-out 20", Form::kRunOut, 20.0)),
          about(datum, call_out("total run-out 20", Form::kTotalRunOut, 20.0))};
}

record::RunRecord shaft_drawing() {
  record::RunRecord run;
  run.header.run_id = "drawing";
  run.header.decision_rule = "iso-14253-1";
  reports::add_to_points_run(run, "A", record::Shape::kCylinder, ground_journal(1, 0.0, 0.0))
      .characteristics = call_outs("B");
  reports::add_to_points_run(run, "B", record::Shape::kCylinder, ground_journal(2, 80.0, 0.003))
      .characteristics = call_outs("A");
  record::UncertaintyTask declared;
  declared.probe.emplace().repeatability_um = 0.05;
  declared.probe->tip_radius_um = 0.1;
  run.settings = record::settings_of_uncertainty(declared, std::nullopt);
  return run;
}

// The figure is 2 s on two cores, 4 s of processor time; it is not reached yet. What is held is the
// time with shared surfaces and datums. RONDURE_FULL=1.
TEST(DrawingSpeed, OfTwentyCallOutsOfScannedJournalsWithUncertainty) {
  if (!test::full()) GTEST_SKIP() << "RONDURE_FULL=1 takes the time";
  const record::RunRecord run = shaft_drawing();
  const double used_s = test::processor_seconds();
  const auto start = std::chrono::steady_clock::now();
  const auto found = evaluate(run);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  const double processor_s = test::processor_seconds() - used_s;
  ASSERT_TRUE(found.has_value());
  std::size_t judged = 0;
  int trials = 0;
  int fewest = std::numeric_limits<int>::max();
  for (const FeatureResult& feature : found->features) {
    for (const CharacteristicResult& one : feature.characteristics) {
      ASSERT_TRUE(one.value) << one.reason.english();
      ASSERT_TRUE(one.value->statement()) << one.reason.english();
      trials = std::max(trials, one.value->uncertainty().result()->trials);
      fewest = std::min(fewest, one.value->uncertainty().result()->trials);
      ++judged;
    }
  }
  std::printf("%zu call-outs, %d to %d trials: %.3f s, of the processors %.3f s\n", judged, fewest,
              trials, took.count(), processor_s);
  EXPECT_EQ(judged, 20U);
#ifndef __SANITIZE_ADDRESS__
  EXPECT_LT(processor_s, 20.0);
#endif
}

/// Each turn of a regular grid on a taper is degenerate, and the circumscribed cylinder that rests
/// on its larger end may tilt in eight directions.
TEST(DrawingSpeed, OfTheEnvelopeOfATaperedSeatWithUncertainty) {
  std::vector<std::vector<Eigen::Vector3d>> layers(4);
  for (int k = 0; k < 32; ++k) {
    const double angle = core::kTwoPi * k / 8.0;
    const int layer = k / 8;
    const double r = 16.5 + 10.0 * core::kMicrometre * (2.0 * layer / 3.0 - 1.0);
    layers[static_cast<std::size_t>(layer)].emplace_back(r * std::cos(angle), r * std::sin(angle),
                                                         10.0 * layer);
  }
  record::RunRecord run;
  run.header.run_id = "seat";
  run.header.decision_rule = "iso-14253-1";
  reports::add_to_points_run(run, "A", record::Shape::kCylinder, layers).characteristics = {
      diameter("30h6 E", Indication::Size::kLP, Indication::Requirement::kEnvelope)};
  const auto seconds = [&](core::Result<Evaluation>& out) {
    const double used_s = test::processor_seconds();
    out = evaluate(run);
    return test::processor_seconds() - used_s;
  };
  core::Result<Evaluation> found = Evaluation();
  const double without_s = seconds(found);
  record::UncertaintyTask declared;
  declared.probe.emplace().repeatability_um = 0.3;
  run.settings = record::settings_of_uncertainty(declared, std::nullopt);
  const double processor_s = seconds(found) - without_s;
  ASSERT_TRUE(found.has_value());
  const CharacteristicResult& one = found->features.front().characteristics.front();
  ASSERT_TRUE(one.value && one.value->statement()) << one.reason.english();
  std::printf("%d trials, %.3f s of the processors, d GN %.6f mm\n",
              one.value->uncertainty().result()->trials, processor_s, *one.value_mm());
  EXPECT_GE(one.value->uncertainty().result()->trials, 200);
#ifndef __SANITIZE_ADDRESS__
  EXPECT_LT(processor_s, 0.3);
#endif
}

}  // namespace
}  // namespace rondure::evaluation
