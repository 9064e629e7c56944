// Three-probe separation against the worked examples of methods, roundness A.11, planted parts and
// hard input. Long counts with RONDURE_FULL=1.
#include "fit/spindle/three_probe.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <limits>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fit/profiles/periodic_spline.h"
#include "fit/spindle/axis_motion.h"
#include "tests/core/full.h"
#include "tests/fit/three_probe_cases.h"

namespace rondure::fit {
namespace {

using core::Code;
using core::kDegree;
using core::kMicrometre;
using core::kTwoPi;

using ::testing::HasSubstr;
using ::testing::IsEmpty;

ThreeProbeOptions exact_options(int samples, int highest = 50) {
  ThreeProbeOptions out;
  out.samples = samples;
  out.highest = highest;
  out.noise_mm = 0.0;
  return out;
}

/// Differences to the true profile [um].
std::vector<double> profile_errors_um(const ThreeProbeResult& r, const std::vector<Wave>& truth) {
  std::vector<double> out;
  for (std::size_t n = 0; n < r.profile.r_mm.size(); ++n)
    out.push_back(r.profile.r_mm[n] / kMicrometre - sum_of(truth, r.profile.angle_rad(n)));
  return out;
}

/// Differences of the motion before eccentricity is taken out [um].
std::vector<double> x_errors_um(const ThreeProbeResult& r) {
  std::vector<double> out;
  for (std::size_t n = 0; n < r.alpha_rad.size(); ++n)
    out.push_back(r.mean_motion_before.x_mm[n] / kMicrometre - SpindleCase::x_um(r.alpha_rad[n]));
  return out;
}
std::vector<double> y_errors_um(const ThreeProbeResult& r) {
  std::vector<double> out;
  for (std::size_t n = 0; n < r.alpha_rad.size(); ++n)
    out.push_back(r.mean_motion_before.y_mm[n] / kMicrometre - SpindleCase::y_um(r.alpha_rad[n]));
  return out;
}

double largest(const std::vector<double>& values) {
  double out = 0.0;
  for (const double v : values) out = std::max(out, std::abs(v));
  return out;
}

TEST(ThreeProbe, FollowsTheHandCheckOfTwelveSamples) {
  const auto layout = ProbeLayout::of(90 * kDegree, 120 * kDegree);
  ASSERT_TRUE(layout);
  EXPECT_NEAR(layout->weights()[1], 0.577350, 5e-7);
  EXPECT_NEAR(layout->weights()[2], 1.154701, 5e-7);
  ProbeReadings readings;
  const std::array<std::array<double, 12>, 3> h = {
      {{2.200000, 2.350000, -0.540192, -2.500000, -0.540192, 2.350000, 2.200000, 0.050000,
        -1.059808, -1.100000, -1.059808, 0.050000},
       {-2.500000, -0.750000, 1.750000, 1.500000, -0.250000, -0.750000, -0.500000, -0.750000,
        -0.250000, 1.500000, 1.750000, -0.750000},
       {-0.423205, -1.428109, -1.273205, -1.183013, -0.273205, 1.571891, 1.576795, -1.168301,
        -2.823205, -0.663397, 2.176795, 1.831699}}};
  constexpr std::array<double, 12> kSum = {0.267949,  0.267949, -1.0,     -3.0,
                                           -1.0,      3.732051, 3.732051, -1.732051,
                                           -4.464102, -1.0,     2.464102, 1.732051};
  for (int n = 0; n < 12; ++n) {
    const auto i = static_cast<std::size_t>(n);
    const double t = n * 30.0 * kDegree;
    readings.alpha_rad.push_back(t);
    double sum = 0.0;
    for (std::size_t p = 0; p < 3; ++p) {
      const double at = t + layout->angles_rad()[p];
      const double exact = 2.0 * std::cos(2 * at) + std::sin(3 * at) +
                           (0.2 + 0.3 * std::sin(t)) * std::cos(layout->angles_rad()[p]) +
                           0.5 * std::cos(2 * t) * std::sin(layout->angles_rad()[p]);
      EXPECT_NEAR(exact, h[p][i], 5.1e-7) << "the table, probe " << p + 1 << ", n " << n;
      sum += layout->weights()[p] * exact;
      readings.h_mm[p].push_back(exact * kMicrometre);
    }
    EXPECT_NEAR(sum, kSum[i], 5.1e-7) << n;
  }
  const auto r = separate_three_probe(readings, {}, *layout, exact_options(12, 4));
  ASSERT_TRUE(r) << r.error().what;
  for (std::size_t n = 0; n < 12; ++n) {
    const double t = r->profile.angle_rad(n);
    EXPECT_NEAR(r->profile.r_mm[n] / kMicrometre, 2 * std::cos(2 * t) + std::sin(3 * t), 5e-15);
    EXPECT_NEAR(r->mean_motion_before.x_mm[n] / kMicrometre, 0.5 * std::cos(2 * t), 5e-15);
    EXPECT_NEAR(r->mean_motion_before.y_mm[n] / kMicrometre, 0.2 + 0.3 * std::sin(t), 5e-15);
  }
  EXPECT_FALSE(r->interpolated);
}

TEST(ThreeProbe, FollowsTheDynamicCase) {
  struct Row {
    int n;
    double alpha_deg, beta_deg, h1, h2a, h3a, h2b, h3b, x, y;
  };
  constexpr std::array<Row, 5> kRows = {
      {{0, 0.0, 0.0, 6.913826, 1.699658, -6.620524, -0.151473, -3.603408, 2.162249, 1.273440},
       {100, 30.730041, 4.426209, 0.060926, -2.000896, -2.327178, 0.694569, 1.464921, 0.594074,
        -0.367084},
       {256, 81.411557, 8.588443, -1.473645, 1.919363, 4.867406, -0.402544, -0.656929, 0.562515,
        -1.107476},
       {400, 134.433967, 6.191033, -0.762917, 2.784899, -2.090434, 4.093613, -2.091357, 0.218400,
        -0.059833},
       {700, 254.460489, -8.366739, 2.187810, 0.811960, 2.273756, -1.955161, 3.381587, -1.593479,
        1.557573}}};
  // H2 (A) of n = 100 is -2.00089585; the method prints -2.000895, one unit of the last digit off.
  const SpindleCase c;
  for (const Row& row : kRows) {
    const double theta = kTwoPi * row.n / 1024;
    const double alpha = c.arm.alpha_of_theta_rad(theta);
    const double unwrapped = alpha < 0 ? alpha + kTwoPi : alpha;
    EXPECT_NEAR(unwrapped / kDegree, row.alpha_deg, 5.1e-7);
    EXPECT_NEAR(c.arm.beta_of_theta_rad(theta) / kDegree, row.beta_deg, 5.1e-7);
    EXPECT_NEAR(reading_um(c, published_layout_a(), 0, alpha), row.h1, 5.1e-7);
    EXPECT_NEAR(reading_um(c, published_layout_a(), 1, alpha), row.h2a, 5.1e-7);
    EXPECT_NEAR(reading_um(c, published_layout_a(), 2, alpha), row.h3a, 5.1e-7);
    EXPECT_NEAR(reading_um(c, published_layout_b(), 1, alpha), row.h2b, 5.1e-7);
    EXPECT_NEAR(reading_um(c, published_layout_b(), 2, alpha), row.h3b, 5.1e-7);
    EXPECT_NEAR(SpindleCase::x_um(alpha), row.x, 5.1e-7);
    EXPECT_NEAR(SpindleCase::y_um(alpha), row.y, 5.1e-7);
  }
  for (const ProbeLayout& layout :
       {published_layout_a(), published_layout_b(), reference_layout()}) {
    for (const int samples : {1024, 512, 300}) {
      SCOPED_TRACE(samples);
      const auto r = separate_three_probe(readings_at(c, layout, uniform_theta(c.arm, samples)),
                                          c.arm, layout, exact_options(samples));
      ASSERT_TRUE(r) << r.error().what;
      EXPECT_FALSE(r->interpolated);
      EXPECT_LT(largest(profile_errors_um(*r, c.profile)), 5e-13);
      EXPECT_LT(largest(x_errors_um(*r)), 2e-12);
      EXPECT_LT(largest(y_errors_um(*r)), 2e-12);
    }
  }
}

TEST(ThreeProbe, RecoversPlantedPartsWhateverTheMotion) {
  for (int seed = 0; seed < (test::full() ? 200 : 20); ++seed) {
    SCOPED_TRACE(seed);
    core::KeyedNoise random(7, {static_cast<std::uint64_t>(seed)});
    const auto between = [&](double low, double high) {
      return low + (high - low) * random.uniform();
    };
    SpindleCase c;
    if (seed % 2 == 0) c.arm.crank_radius_mm = 0.0;
    c.profile.clear();
    for (int k = 2; k <= 50; ++k)
      c.profile.push_back({k, between(0.01, 5.0), between(0.0, kTwoPi)});
    const auto layout = ProbeLayout::of(between(40, 80) * kDegree, between(200, 260) * kDegree);
    ASSERT_TRUE(layout);
    const auto r = separate_three_probe(readings_at(c, *layout, uniform_theta(c.arm, 512)), c.arm,
                                        *layout, exact_options(512));
    ASSERT_TRUE(r) << r.error().what;
    for (const RecoveredHarmonic& h : r->harmonics) {
      if (!h.recovered) continue;
      const Wave& truth = c.profile[static_cast<std::size_t>(h.order - 2)];
      EXPECT_NEAR(h.amplitude_mm / kMicrometre, truth.amplitude_um, 1e-9);
      ASSERT_TRUE(h.phase_rad);
      EXPECT_NEAR(std::remainder(*h.phase_rad - truth.phase_rad, kTwoPi), 0.0, 1e-9);
    }
  }
}

TEST(ThreeProbe, NoiseGainIsThatOfTheFormula) {
  const int runs = test::full() ? 5000 : 400;
  const SpindleCase c;
  const ProbeLayout layout = published_layout_b();
  constexpr int kSamples = 128;
  constexpr double kNoise_um = 0.05;
  const auto clean = readings_at(c, layout, uniform_theta(c.arm, kSamples));
  ThreeProbeOptions options = exact_options(kSamples, 20);
  options.noise_mm = kNoise_um * kMicrometre;
  SpindleCase low = c;
  while (low.profile.back().order > 20) low.profile.pop_back();
  const auto quiet = readings_at(low, layout, uniform_theta(c.arm, kSamples));
  std::vector<double> power(21, 0.0);
  double rms_error = 0.0;
  double sigma = 0.0;
  for (int run = 0; run < runs; ++run) {
    ProbeReadings noisy = quiet;
    core::KeyedNoise noise(11, {static_cast<std::uint64_t>(run)});
    for (auto& h : noisy.h_mm) {
      for (double& value : h) value += kNoise_um * kMicrometre * noise.normal();
    }
    const auto r = separate_three_probe(noisy, c.arm, layout, options);
    ASSERT_TRUE(r);
    const auto errors = profile_errors_um(*r, low.profile);
    rms_error += std::pow(rms(errors), 2) / runs;
    sigma = r->profile_sigma_mm / kMicrometre;
    for (const RecoveredHarmonic& h : r->harmonics) {
      // Error of the complex amplitude: twice the variance of a component.
      double re = 0.0;
      double im = 0.0;
      for (int n = 0; n < kSamples; ++n) {
        re += errors[static_cast<std::size_t>(n)] * std::cos(kTwoPi * n * h.order / kSamples);
        im += errors[static_cast<std::size_t>(n)] * std::sin(kTwoPi * n * h.order / kSamples);
      }
      power[static_cast<std::size_t>(h.order)] +=
          (re * re + im * im) * 4.0 / (kSamples * kSamples) / 2.0 / runs;
    }
  }
  // Standard deviation of a variance estimate from 2 * runs values: 1 / sqrt(runs), half of it for
  // its root; 4 of them where the runs are few.
  const double tolerance = test::full() ? 0.05 : 4.0 * 0.5 / std::sqrt(runs);
  for (int k = 2; k <= 20; ++k) {
    const double predicted = layout.gain(k) * kNoise_um * std::sqrt(2.0 / kSamples);
    EXPECT_NEAR(std::sqrt(power[static_cast<std::size_t>(k)]) / predicted, 1.0, tolerance)
        << "harmonic " << k;
  }
  EXPECT_NEAR(std::sqrt(rms_error) / sigma, 1.0, tolerance);
}

TEST(ThreeProbe, WithoutResamplingTheErrorIsThatOfTheMethod) {
  const SpindleCase c;
  struct Case {
    ProbeLayout layout;
    double stated_um;
    double half_digit_um;
  };
  for (const Case& layout :
       {Case{published_layout_a(), 8.9, 0.05}, Case{published_layout_b(), 2.3, 0.05}}) {
    const auto readings = readings_at(c, layout.layout, uniform_alpha(1024));
    auto still = readings;
    still.beta_rad.assign(1024, 0.0);  // uniform alpha for uniform theta
    const auto wrong = separate_three_probe(still, c.arm, layout.layout, exact_options(1024));
    ASSERT_TRUE(wrong) << wrong.error().what;
    EXPECT_NEAR(rms(profile_errors_um(*wrong, c.profile)), layout.stated_um, layout.half_digit_um);
    EXPECT_THAT(wrong->warnings.back().what, HasSubstr("the measured swing differs"));

    const auto right = separate_three_probe(readings, c.arm, layout.layout, exact_options(1024));
    ASSERT_TRUE(right);
    EXPECT_TRUE(right->interpolated);
    EXPECT_LT(largest(profile_errors_um(*right, c.profile)), 1e-3);
    EXPECT_LT(largest(x_errors_um(*right)), 1e-3);
    EXPECT_LT(largest(y_errors_um(*right)), 1e-3);
  }
}

TEST(ThreeProbe, DroppedHarmonicsAreListedAndCostWhatTheMethodStates) {
  const SpindleCase c;
  struct Case {
    ProbeLayout layout;
    std::vector<int> lost;
    double stated_um;
  };
  for (const Case& layout :
       {Case{published_layout_b(), {5, 7}, 0.70}, Case{published_layout_a(), {3, 5}, 1.52}}) {
    ThreeProbeOptions options = exact_options(1024);
    options.greatest_gain = 10.0;
    const auto r = separate_three_probe(readings_at(c, layout.layout, uniform_theta(c.arm, 1024)),
                                        c.arm, layout.layout, options);
    ASSERT_TRUE(r);
    EXPECT_EQ(r->unrecovered, layout.lost);
    EXPECT_EQ(r->warnings.front().code, Code::kHarmonicLoss);
    double power = 0.0;  // of what was dropped: its whole amplitude
    for (const Wave& w : c.profile) {
      if (w.order == layout.lost[0] || w.order == layout.lost[1])
        power += w.amplitude_um * w.amplitude_um / 2.0;
    }
    EXPECT_NEAR(rms(profile_errors_um(*r, c.profile)), std::sqrt(power), 1e-9);
    EXPECT_NEAR(std::sqrt(power), layout.stated_um, 0.01) << "two digits of the method";
  }
}

TEST(ThreeProbe, AsPublishedShowsTheWrongFormula) {
  const SpindleCase c;
  ThreeProbeOptions options = exact_options(1024);
  options.motion = ThreeProbeOptions::Motion::kAsPublished;
  const auto r =
      separate_three_probe(readings_at(c, published_layout_a(), uniform_theta(c.arm, 1024)), c.arm,
                           published_layout_a(), options);
  ASSERT_TRUE(r);
  EXPECT_LT(largest(x_errors_um(*r)), 1e-10) << "RX is right";
  EXPECT_NEAR(rms(y_errors_um(*r)), 1.18, 0.005);
}

TEST(ThreeProbe, EccentricityAndProbeZerosAreTakenOutOfTheMotion) {
  SpindleCase c;
  const ProbeLayout layout = reference_layout();
  const auto plain = separate_three_probe(readings_at(c, layout, uniform_theta(c.arm, 512)), c.arm,
                                          layout, exact_options(512));
  c.profile.push_back({1, 6.0, 35.0 * kDegree});
  auto readings = readings_at(c, layout, uniform_theta(c.arm, 512));
  const std::array<double, 3> zeros = {1.2e-3, -0.7e-3, 0.4e-3};
  for (std::size_t i = 0; i < 3; ++i) {
    for (double& h : readings.h_mm[i]) h += zeros[i];
  }
  ThreeProbeOptions options = exact_options(512);
  const auto r = separate_three_probe(readings, c.arm, layout, options);
  ASSERT_TRUE(plain && r);
  for (std::size_t n = 0; n < 512; ++n) {
    EXPECT_NEAR(r->mean_motion.x_mm[n], plain->mean_motion.x_mm[n], 1e-14);
    EXPECT_NEAR(r->mean_motion.y_mm[n], plain->mean_motion.y_mm[n], 1e-14);
    EXPECT_NEAR(r->profile.r_mm[n], plain->profile.r_mm[n], 1e-14);
  }
  // What the motion itself holds of that shape cannot be told apart: vectors add.
  const auto vector = [](const ThreeProbeResult& of) {
    return std::polar(of.eccentricity_mm, of.eccentricity_rad);
  };
  EXPECT_NEAR(std::abs(vector(*r) - vector(*plain) - std::polar(6e-3, 35.0 * kDegree)), 0.0, 1e-14);
}

TEST(ThreeProbe, SecondOrderConverges) {
  // Exact readings of a pin that moves 40 um, by bisection on the line of the probe.
  const SpindleCase c;
  const ProbeLayout layout = reference_layout();
  const double radius_um = c.arm.pin_radius_mm / kMicrometre;
  const auto alpha = uniform_theta(c.arm, 512);
  ProbeReadings readings;
  readings.alpha_rad = alpha;
  for (std::size_t i = 0; i < 3; ++i) {
    for (const double a : alpha) {
      const double direction = layout.angles_rad()[i] + c.arm.beta_rad(a);
      const double x = 20.0 * SpindleCase::x_um(a);
      const double y = 20.0 * SpindleCase::y_um(a);
      // Points of the line outside the pin have more than its radius.
      const auto outside = [&](double d) {
        const double px = d * std::sin(direction) - x;
        const double py = d * std::cos(direction) - y;
        const double clock = std::atan2(px, py);  // from Y, as the probes count
        return std::hypot(px, py) -
               (radius_um + sum_of(c.profile, a + c.arm.beta_rad(a) + layout.angles_rad()[i] +
                                                  std::remainder(clock - direction, kTwoPi)));
      };
      double low = radius_um - 200.0;
      double high = radius_um + 200.0;
      for (int pass = 0; pass < 60; ++pass) {
        const double middle = 0.5 * (low + high);
        (outside(middle) < 0.0 ? low : high) = middle;
      }
      readings.h_mm[i].push_back((low - radius_um) * kMicrometre);
    }
  }
  ThreeProbeOptions options = exact_options(512);
  options.second_order = ThreeProbeOptions::SecondOrder::kOff;
  const auto first = separate_three_probe(readings, c.arm, layout, options);
  options.second_order = ThreeProbeOptions::SecondOrder::kAuto;
  const auto second = separate_three_probe(readings, c.arm, layout, options);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->second_order_passes, 0);
  EXPECT_GT(second->second_order_passes, 1);
  const double before = rms(profile_errors_um(*first, c.profile));
  const double after = rms(profile_errors_um(*second, c.profile));
  EXPECT_GT(before, 0.01);
  EXPECT_LT(after, 2e-4);
}

TEST(ThreeProbe, RefusesReadingsWhoseMotionIsAsLargeAsThePart) {
  const SpindleCase c;
  for (const double unit : {1e3, 1e6}) {  // one column in nm, or in pm
    SCOPED_TRACE(unit);
    auto readings = readings_at(c, reference_layout(), uniform_theta(c.arm, 512));
    for (double& h : readings.h_mm[1]) h *= unit;
    const auto refused =
        separate_three_probe(readings, c.arm, reference_layout(), exact_options(512));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, core::Code::kUnits);
    EXPECT_THAT(refused.error().what, HasSubstr("part of radius 24.56 mm"));
  }
}

TEST(ThreeProbe, SeparatesRevolutionsThatDiffer) {
  SpindleCase c;
  const ProbeLayout layout = reference_layout();
  auto readings = readings_at(c, layout, uniform_alpha(1000, 5));
  for (std::size_t m = 0; m < readings.alpha_rad.size(); ++m) {
    const double a = readings.alpha_rad[m];
    const double drift = 0.4e-3 * std::sin(0.37 * a);
    for (std::size_t i = 0; i < 3; ++i)
      readings.h_mm[i][m] += drift * std::cos(layout.angles_rad()[i] + c.arm.beta_rad(a));
  }
  const auto r = separate_three_probe(readings, c.arm, layout, exact_options(1024));
  ASSERT_TRUE(r) << r.error().what;
  EXPECT_EQ(r->revolutions, 5);
  ASSERT_EQ(r->motion.size(), 5U);
  EXPECT_LT(rms(profile_errors_um(*r, c.profile)), 2e-3) << "the drift ends with a step";
  double worst = 0.0;
  for (std::size_t j = 0; j < 5; ++j) {
    for (std::size_t n = 100; n + 100 < 1024; ++n) {
      const double a = r->alpha_rad[n] + kTwoPi * static_cast<double>(j);
      const double drift = 0.4e-3 * std::sin(0.37 * a);
      // Against the mean revolution: constants of c0 e^{-j beta} are common to all.
      double mean_drift = 0.0;
      for (int t = 0; t < 5; ++t)
        mean_drift += 0.4e-3 * std::sin(0.37 * (r->alpha_rad[n] + kTwoPi * t)) / 5.0;
      worst = std::max(
          worst, std::abs(r->motion[j].y_mm[n] - r->mean_motion.y_mm[n] - (drift - mean_drift)));
    }
  }
  EXPECT_LT(worst, 2e-6);
}

TEST(ThreeProbe, AWrongAngleShowsAtOneUndulation) {
  const SpindleCase c;
  const ProbeLayout layout = published_layout_b();
  const auto off = ProbeLayout::of(layout.phi2_rad() + 0.5 * kDegree, layout.phi3_rad());
  ThreeProbeOptions options = exact_options(1024);
  options.noise_mm = 0.005 * kMicrometre;
  const auto r = separate_three_probe(readings_at(c, *off, uniform_theta(c.arm, 1024)), c.arm,
                                      layout, options);
  ASSERT_TRUE(r);
  ASSERT_FALSE(r->warnings.empty());
  EXPECT_EQ(r->warnings.back().code, Code::kInconsistent);
  const auto right = separate_three_probe(readings_at(c, layout, uniform_theta(c.arm, 1024)), c.arm,
                                          layout, options);
  EXPECT_THAT(right->warnings, IsEmpty());
}

/// Adds white noise to all readings.
void add_noise(ProbeReadings& readings, double noise_um, std::uint64_t seed) {
  core::KeyedNoise noise(seed, {5});
  for (auto& h : readings.h_mm) {
    for (double& value : h) value += noise_um * kMicrometre * noise.normal();
  }
}

TEST(ThreeProbe, ChatterBeyondTheSamplesDoesNotComeBackAsALowUndulation) {
  for (const double crank : {0.0, 49.0}) {
    SpindleCase c;
    c.arm.crank_radius_mm = crank;
    c.profile = {{2, 3.0, 0.3}, {1000, 1.0, 0.4}};
    const auto r = separate_three_probe(readings_at(c, reference_layout(), uniform_alpha(7200)),
                                        c.arm, reference_layout(), exact_options(1024));
    ASSERT_TRUE(r) << r.error().what;
    for (const RecoveredHarmonic& h : r->harmonics)
      EXPECT_NEAR(h.amplitude_mm / kMicrometre, h.order == 2 ? 3.0 : 0.0, 1e-4) << h.order;
  }
}

TEST(ThreeProbe, StatesTheUncertaintyOfEveryReadingUsed) {
  constexpr double kNoise_um = 0.05;
  const ProbeLayout layout = reference_layout();
  SpindleCase c;
  while (c.profile.back().order > 16) c.profile.pop_back();
  for (const int rows : {150, 256, 512, 1024, 1500, 7200}) {
    for (const int turns : {1, 3}) {
      SCOPED_TRACE(::testing::Message() << rows << " readings, " << turns << " revolutions");
      const auto clean = readings_at(c, layout, uniform_alpha(rows, turns));
      const auto truth = separate_three_probe(clean, c.arm, layout, exact_options(1024));
      double error = 0.0;
      double stated = 0.0;
      constexpr int kRuns = 20;
      for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
        ProbeReadings readings = clean;
        add_noise(readings, kNoise_um, seed);
        const auto r = separate_three_probe(readings, c.arm, layout);
        ASSERT_TRUE(r && truth);
        EXPECT_TRUE(r->noise_estimated);
        std::vector<double> apart;
        for (std::size_t n = 0; n < r->profile.r_mm.size(); ++n)
          apart.push_back((r->profile.r_mm[n] - truth->profile.r_mm[n]) / kMicrometre);
        error += std::pow(rms(apart), 2) / kRuns;
        stated += std::pow(r->profile_sigma_mm / kMicrometre, 2) / kRuns;
      }
      double power = 0.0;
      for (int k = 2; k <= 50; ++k) power += 2.0 * std::pow(layout.gain(k) * kNoise_um, 2);
      const double least = std::sqrt(power / (rows * turns));
      std::printf("%5d readings, %d revolutions: error %.3f of the least, %.3f of that stated\n",
                  rows, turns, std::sqrt(error) / least, std::sqrt(error / stated));
      EXPECT_NEAR(std::sqrt(error) / least, 1.0, 0.1);
      EXPECT_NEAR(std::sqrt(error / stated), 1.0, 0.1);
    }
  }
}

TEST(ThreeProbe, DoesNotInventANoise) {
  const SpindleCase c;
  const ProbeLayout layout = reference_layout();
  ThreeProbeOptions options = exact_options(102);
  options.noise_mm.reset();
  const auto readings = readings_at(c, layout, uniform_theta(c.arm, 102));
  EXPECT_EQ(separate_three_probe(readings, c.arm, layout, options).error().code, Code::kSampling);
  auto twice = readings_at(c, layout, uniform_alpha(1024, 2));
  add_noise(twice, 0.05, 1);
  options = exact_options(1024);
  options.noise_mm = 0.02 * kMicrometre;
  EXPECT_THAT(separate_three_probe(twice, c.arm, layout, options)->warnings.back().what,
              HasSubstr("0.02 um are stated"));
  options.noise_mm = 0.05 * kMicrometre;
  EXPECT_THAT(separate_three_probe(twice, c.arm, layout, options)->warnings, IsEmpty());
}

TEST(ThreeProbe, ProbeZerosDisplaceNothingInTheSecondOrder) {
  for (const ProbeLayout& layout : {published_layout_a(), reference_layout()}) {
    SpindleCase c;
    c.profile.push_back({1, 12.0, 0.6});  // above 10 um: the correction is on
    const auto readings = readings_at(c, layout, uniform_alpha(1024));
    auto unmastered = readings;
    const std::array<double, 3> zeros = {0.4, -0.25, 0.3};
    for (std::size_t i = 0; i < 3; ++i) {
      for (double& h : unmastered.h_mm[i]) h += zeros[i];
    }
    const auto a = separate_three_probe(readings, c.arm, layout, exact_options(1024));
    const auto b = separate_three_probe(unmastered, c.arm, layout, exact_options(1024));
    ASSERT_TRUE(a && b);
    EXPECT_GT(a->second_order_passes, 0);
    EXPECT_EQ(a->second_order_passes, b->second_order_passes);
    for (std::size_t n = 0; n < 1024; ++n) {
      ASSERT_NEAR(a->profile.r_mm[n], b->profile.r_mm[n], 1e-3 * kMicrometre);
      ASSERT_NEAR(a->mean_motion.x_mm[n], b->mean_motion.x_mm[n], 1e-3 * kMicrometre);
      ASSERT_NEAR(a->mean_motion.y_mm[n], b->mean_motion.y_mm[n], 1e-3 * kMicrometre);
    }
  }
}

TEST(ThreeProbe, NamesAGrossReadingButNotAScratch) {
  const SpindleCase c;
  const ProbeLayout layout = reference_layout();
  for (const int turns : {1, 3}) {
    auto readings = readings_at(c, layout, uniform_alpha(1024, turns));
    add_noise(readings, 0.02, 3);
    EXPECT_THAT(separate_three_probe(readings, c.arm, layout)->contradictions, IsEmpty());

    const std::size_t last = readings.alpha_rad.size() - 1;
    for (const std::size_t row : {std::size_t{0}, std::size_t{1}, std::size_t{517}, last}) {
      auto gross = readings;
      // At the ends the neighbours of one side have to do.
      gross.h_mm[1][row] += (row == 0 || row == last ? 2.0 : 0.5) * kMicrometre;
      const auto found = separate_three_probe(gross, c.arm, layout)->contradictions;
      ASSERT_EQ(found.size(), 1U) << row;
      EXPECT_EQ(found.front().code, Code::kOutliers);
      EXPECT_THAT(found.front().what,
                  HasSubstr("1 reading is more than 8 standard deviations off"));
      const std::size_t named = std::clamp(row, std::size_t{2}, last - 2);
      EXPECT_THAT(found.front().what, HasSubstr(fmt::format("probe 2 row {} (", named)));
    }

    auto scratched = readings;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t m = 0; m < scratched.alpha_rad.size(); ++m) {
        const double a = scratched.alpha_rad[m];
        const double at =
            std::remainder(a + c.arm.beta_rad(a) + layout.angles_rad()[i] - 2.0, kTwoPi);
        if (std::abs(at) < 0.006) scratched.h_mm[i][m] -= 5.0 * kMicrometre;
      }
    }
    const auto seen = separate_three_probe(scratched, c.arm, layout)->contradictions;
    for (const core::Error& one : seen) EXPECT_NE(one.code, Code::kOutliers) << one.what;
  }
}

TEST(ThreeProbe, ProbesThatDriftFromTurnToTurnLeaveTheProfile) {
  SpindleCase c;
  const ProbeLayout layout = reference_layout();
  auto readings = readings_at(c, layout, uniform_alpha(1024, 4));
  add_noise(readings, 0.02, 5);
  const auto still = separate_three_probe(readings, c.arm, layout);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t m = 0; m < readings.alpha_rad.size(); ++m) {
      readings.h_mm[i][m] +=
          0.1 * kMicrometre * static_cast<double>(i) * readings.alpha_rad[m] / kTwoPi;
    }
  }
  const auto drifting = separate_three_probe(readings, c.arm, layout);
  EXPECT_THAT(drifting->contradictions, IsEmpty());
  for (std::size_t n = 0; n < 1024; ++n)
    ASSERT_NEAR(drifting->profile.r_mm[n], still->profile.r_mm[n], 0.01 * kMicrometre);
}

TEST(ThreeProbe, AWrongGainShowsBesideChatter) {
  SpindleCase c;
  c.profile.push_back({1, 6.0, 0.6});
  c.profile.push_back({90, 0.5, 0.6});
  const ProbeLayout layout = reference_layout();
  for (const int turns : {1, 4}) {
    auto readings = readings_at(c, layout, uniform_alpha(1024, turns));
    auto wrong = readings;
    for (double& h : wrong.h_mm[1]) h *= 1.01;
    add_noise(readings, 0.02, 8);
    add_noise(wrong, 0.02, 8);
    const auto right = separate_three_probe(readings, c.arm, layout);
    EXPECT_THAT(right->contradictions, IsEmpty());
    EXPECT_LT(right->least_error_shown, 0.01);
    EXPECT_GT(right->least_error_shown, 5e-4);
    const auto found = separate_three_probe(wrong, c.arm, layout)->contradictions;
    ASSERT_EQ(found.size(), 1U) << turns;
    EXPECT_THAT(found.front().what, HasSubstr("a probe gain"));
  }
}

TEST(ThreeProbe, SeparatesAHundredThousandSamples) {
  SpindleCase c;
  c.arm.crank_radius_mm = 0.0;
  const ProbeLayout layout = reference_layout();
  const auto readings = readings_at(c, layout, uniform_alpha(100'000));
  double best_ms = 1e9;
  for (int run = 0; run < 5; ++run) {
    const auto start = std::chrono::steady_clock::now();
    const auto r = separate_three_probe(readings, c.arm, layout, exact_options(0));
    best_ms = std::min(
        best_ms, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
                     .count());
    ASSERT_TRUE(r);
    EXPECT_FALSE(r->interpolated);
    EXPECT_LT(largest(profile_errors_um(*r, c.profile)), 1e-9);
  }
  std::printf("three probes, 1e5 samples: %.1f ms\n", best_ms);
}

TEST(ThreeProbe, RefusesWhatCannotBeSeparated) {
  const SpindleCase c;
  const ProbeLayout layout = reference_layout();
  const auto good = readings_at(c, layout, uniform_alpha(512));
  const auto code = [&](const ProbeReadings& readings, const SwingArm& arm,
                        const ThreeProbeOptions& options = exact_options(512)) {
    const auto r = separate_three_probe(readings, arm, layout, options);
    return r ? Code::kInternal : r.error().code;
  };
  EXPECT_EQ(ProbeLayout::of(90 * kDegree, 180 * kDegree).error().code, Code::kRank);
  EXPECT_EQ(ProbeLayout::of(0.0, 120 * kDegree).error().code, Code::kRank);
  EXPECT_EQ(ProbeLayout::of(60 * kDegree, 120 * kDegree).error().code, Code::kRank);
  EXPECT_FALSE(ProbeLayout::of(std::nan(""), 1.0));
  ProbeReadings bad = good;
  bad.h_mm[2].pop_back();
  EXPECT_EQ(code(bad, c.arm), Code::kSampling);
  bad = good;
  bad.h_mm[1][77] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(code(bad, c.arm), Code::kNotFinite);
  bad = good;
  std::swap(bad.alpha_rad[5], bad.alpha_rad[6]);
  EXPECT_EQ(code(bad, c.arm), Code::kAngleOrder);
  bad = good;
  for (double& a : bad.alpha_rad) a *= 0.9;
  EXPECT_EQ(code(bad, c.arm), Code::kNotFullSection);
  bad = good;
  bad.h_mm[0][3] = 1e155;
  EXPECT_EQ(code(bad, c.arm), Code::kNotFinite) << "finite, and of no use";
  // Angles in a wrong unit, as thousands of turns: memory for them is not asked for.
  bad = good;
  for (double& a : bad.alpha_rad) a *= 1e5;
  EXPECT_EQ(code(bad, SwingArm{}), Code::kSampling);
  ThreeProbeOptions many = exact_options(512);
  many.samples = 2'000'000'000;
  EXPECT_EQ(code(good, c.arm, many), Code::kBadOption);
  many = exact_options(512);
  many.highest = 2'000'000'000;
  EXPECT_EQ(code(good, c.arm, many), Code::kSampling);
  EXPECT_EQ(code(good, {400.0, 299.88, 24.56}), Code::kOutOfRange) << "R >= Lc";
  EXPECT_EQ(code(good, {49.0, 0.0, 24.56}), Code::kOutOfRange);
  EXPECT_EQ(code(good, {49.0, 299880.0, 24560.0}), Code::kUnits) << "um for mm";
  EXPECT_EQ(code(good, {-1.0, 300.0, 25.0}), Code::kOutOfRange);
  EXPECT_EQ(code(good, c.arm, exact_options(100)), Code::kSampling) << "N < 2 kmax + 2";
  EXPECT_EQ(code(good, c.arm, exact_options(512, 1)), Code::kBadOption);
  bad = good;
  bad.beta_rad.assign(3, 0.0);
  EXPECT_EQ(code(bad, c.arm), Code::kSampling);
}

TEST(ThreeProbe, WarnsOfThinSamplingGapsAndAForeignSwing) {
  const SpindleCase c;
  const ProbeLayout layout = reference_layout();
  auto codes = [&](const ProbeReadings& readings) {
    std::vector<Code> out;
    const auto r = separate_three_probe(readings, c.arm, layout, exact_options(512));
    for (const auto& warning : r->warnings) out.push_back(warning.code);
    return out;
  };
  EXPECT_THAT(codes(readings_at(c, layout, uniform_alpha(300))),
              ::testing::Contains(Code::kSampling));
  std::vector<double> gap = uniform_alpha(512);
  gap.erase(gap.begin() + 100, gap.begin() + 110);
  EXPECT_THAT(codes(readings_at(c, layout, gap)), ::testing::Contains(Code::kSampling));
  auto swung = readings_at(c, layout, uniform_alpha(512));
  for (const double a : swung.alpha_rad) swung.beta_rad.push_back(c.arm.beta_rad(a) + 0.002);
  EXPECT_THAT(codes(swung), ::testing::Contains(Code::kInconsistent));
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

// Angles of the other sign have the same weights: the weighted sum says nothing of the sense.
TEST(ThreeProbe, NamesProbeAnglesCountedInTheWrongSense) {
  for (const bool tracked : {false, true}) {
    SCOPED_TRACE(tracked);
    SpindleCase part;
    if (!tracked) part.arm.crank_radius_mm = 0.0;
    part.profile.push_back({1, 12.0, 35.0 * core::kDegree});  // eccentricity
    const ProbeReadings readings = readings_at(part, reference_layout(), uniform_alpha(1024));
    ThreeProbeOptions options;
    options.samples = 512;
    options.noise_mm = 2e-5;
    const auto right = separate_three_probe(readings, part.arm, reference_layout(), options);
    ASSERT_TRUE(right) << right.error().what;
    EXPECT_FALSE(right->turns_against_work());
    EXPECT_TRUE(right->contradictions.empty());
    const ProbeLayout turned =
        ProbeLayout::of(-reference_layout().phi2_rad(), -reference_layout().phi3_rad()).value();
    const auto wrong = separate_three_probe(readings, part.arm, turned, options);
    ASSERT_TRUE(wrong) << wrong.error().what;
    EXPECT_TRUE(wrong->turns_against_work());
    ASSERT_FALSE(wrong->contradictions.empty());
    EXPECT_THAT(wrong->contradictions.back().what, ::testing::HasSubstr("with the other sign"));
  }
}

}  // namespace
}  // namespace rondure::fit
