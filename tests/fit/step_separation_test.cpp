// Multi-step and reversal separation, alone and against three probes.
#include "fit/spindle/step_separation.h"

#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fit/spindle/axis_motion.h"
#include "tests/fit/three_probe_cases.h"

namespace rondure::fit {
namespace {

using core::Code;
using core::kDegree;
using core::kMicrometre;
using core::kTwoPi;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr int kTurnSamples = 512;

/// Motion in the direction of the probe [um], without harmonics 0 and 1.
double motion_um(double a) {
  return 0.9 * std::cos(3 * a) + 0.5 * std::sin(4 * a + 0.7) + 0.25 * std::cos(13 * a) +
         0.1 * std::cos(8 * a);
}

std::vector<double> trace(const SpindleCase& c, double step, double sign) {
  std::vector<double> out;
  for (int n = 0; n < kTurnSamples; ++n) {
    const double a = kTwoPi * n / kTurnSamples;
    out.push_back((sum_of(c.profile, a + step) + sign * motion_um(a)) * kMicrometre);
  }
  return out;
}

double largest_part_error_um(const StepSeparation& r, const SpindleCase& c) {
  double worst = 0.0;
  for (std::size_t n = 0; n < r.part.r_mm.size(); ++n)
    worst = std::max(
        worst, std::abs(r.part.r_mm[n] / kMicrometre - sum_of(c.profile, r.part.angle_rad(n))));
  return worst;
}

double largest_motion_error_um(const StepSeparation& r) {
  double worst = 0.0;
  for (std::size_t n = 0; n < r.motion_mm.size(); ++n)
    worst = std::max(worst, std::abs(r.motion_mm[n] / kMicrometre -
                                     motion_um(kTwoPi * static_cast<double>(n) / kTurnSamples)));
  return worst;
}

TEST(Reversal, SeparatesPartAndMotion) {
  const SpindleCase c;
  const auto r = separate_reversal(trace(c, 0.0, 1.0), trace(c, 0.0, -1.0));
  ASSERT_TRUE(r) << r.error().what;
  EXPECT_LT(largest_part_error_um(*r, c), 1e-12);
  EXPECT_LT(largest_motion_error_um(*r), 1e-12);
  EXPECT_THAT(r->unrecovered, IsEmpty());
  EXPECT_NEAR(r->harmonics.front().gain, std::sqrt(0.5), 1e-15);
}

TEST(MultiStep, RecoversAllButTheMultiplesOfTheSteps) {
  SpindleCase c;
  c.profile[5].order = 17;  // 16 is a multiple of 8, and so is 40
  c.profile[7].order = 41;
  std::vector<double> steps;
  std::vector<std::vector<double>> traces;
  for (int j = 0; j < 8; ++j) {
    steps.push_back(kTwoPi * j / 8);
    traces.push_back(trace(c, steps.back(), 1.0));
  }
  const auto r = separate_multi_step(steps, traces);
  ASSERT_TRUE(r) << r.error().what;
  EXPECT_THAT(r->unrecovered, ElementsAre(8, 16, 24, 32, 40, 48));
  EXPECT_LT(largest_part_error_um(*r, c), 1e-12);
  EXPECT_LT(largest_motion_error_um(*r), 1e-12);
  c.profile.push_back({16, 0.5, 0.3});
  for (std::size_t j = 0; j < 8; ++j) traces[j] = trace(c, steps[j], 1.0);
  const auto lost = separate_multi_step(steps, traces);
  EXPECT_NEAR(largest_part_error_um(*lost, c), 0.5, 5e-3) << "harmonic 16 is not told apart";
}

TEST(MultiStep, TakesAnyAngles) {
  const SpindleCase c;
  const std::vector<double> steps = {0.0, 37.0 * kDegree, 101.0 * kDegree, 203.0 * kDegree};
  std::vector<std::vector<double>> traces;
  for (const double step : steps) traces.push_back(trace(c, step, 1.0));
  const auto r = separate_multi_step(steps, traces);
  ASSERT_TRUE(r);
  EXPECT_THAT(r->unrecovered, IsEmpty());
  EXPECT_LT(largest_part_error_um(*r, c), 1e-11);
}

TEST(MultiStep, AgreesWithReversalAndThreeProbes) {
  SpindleCase c;
  c.arm.crank_radius_mm = 0.0;
  const ProbeLayout layout = reference_layout();
  ThreeProbeOptions options;
  options.samples = kTurnSamples;
  options.noise_mm = 0.0;
  const auto three = separate_three_probe(readings_at(c, layout, uniform_alpha(kTurnSamples)),
                                          c.arm, layout, options);
  const std::vector<double> steps = {0.0, 50.0 * kDegree, 115.0 * kDegree};
  std::vector<std::vector<double>> traces;
  for (const double step : steps) traces.push_back(trace(c, step, 1.0));
  const auto stepped = separate_multi_step(steps, traces);
  const auto reversed = separate_reversal(trace(c, 0.0, 1.0), trace(c, 0.0, -1.0));
  ASSERT_TRUE(three && stepped && reversed);
  for (std::size_t n = 0; n < kTurnSamples; ++n) {
    EXPECT_NEAR(three->profile.r_mm[n], stepped->part.r_mm[n], 1e-13);
    EXPECT_NEAR(three->profile.r_mm[n], reversed->part.r_mm[n], 1e-13);
  }
}

TEST(MultiStep, RefusesWhatCannotBeSeparated) {
  const SpindleCase c;
  const auto good = trace(c, 0.0, 1.0);
  const auto code = [](const auto& result) {
    return result ? Code::kInternal : result.error().code;
  };
  const std::vector<double> alike = {0.0, kTwoPi};
  const std::vector<std::vector<double>> pair = {good, good};
  EXPECT_EQ(code(separate_multi_step(alike, pair)), Code::kRank);
  const std::vector<double> one = {0.0};
  EXPECT_EQ(code(separate_multi_step(one, pair)), Code::kSampling);
  auto shorter = good;
  shorter.pop_back();
  EXPECT_EQ(code(separate_reversal(good, shorter)), Code::kSampling);
  auto broken = good;
  broken[3] = std::nan("");
  EXPECT_EQ(code(separate_reversal(good, broken)), Code::kNotFinite);
  EXPECT_EQ(code(separate_reversal(good, good, {.highest = 400})), Code::kSampling);
  EXPECT_EQ(code(separate_reversal(good, good, {.highest = 1})), Code::kBadOption);
}

TEST(AxisMotion, GivesTheValuesOfThePolarPlot) {
  const auto alpha = uniform_alpha(360);
  std::vector<std::vector<double>> turns(3);
  for (int j = 0; j < 3; ++j) {
    for (const double a : alpha)
      turns[static_cast<std::size_t>(j)].push_back(5.0 + 2.0 * std::cos(a - 0.4) + std::cos(2 * a) +
                                                   0.1 * (j - 1));
  }
  const AxisMotion m = axis_motion(alpha, turns);
  EXPECT_NEAR(m.fundamental_mm, 2.0, 1e-12);
  EXPECT_NEAR(m.synchronous_mm, 2.0, 1e-12);
  ASSERT_TRUE(m.asynchronous_mm);
  EXPECT_NEAR(*m.asynchronous_mm, 0.2, 1e-12);
  EXPECT_NEAR(m.total_mm, 2.2, 1e-12);
  const AxisMotion single = axis_motion(alpha, std::span(turns).first(1));
  EXPECT_FALSE(single.asynchronous_mm);
  EXPECT_NEAR(single.total_mm, 2.0, 1e-12);
}

}  // namespace
}  // namespace rondure::fit
