#include "fit/profiles/closed_profile.h"

#include <cmath>
#include <complex>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "fit/profiles/harmonics.h"
#include "fit/profiles/internal/dft.h"
#include "fit/profiles/profile_filter.h"
#include "tests/fit/profile_cases.h"

namespace rondure::fit {
namespace {

using Values = std::vector<double>;

/// Uniform angles, each moved by up to 35 % of a step.
Values jittered_angles(std::uint64_t seed, std::size_t count) {
  core::KeyedNoise noise(seed, {17});
  Values theta = test::uniform_angles(count);
  for (double& t : theta) {
    t += 0.35 * (2.0 * noise.uniform() - 1.0) * core::kTwoPi / static_cast<double>(count);
  }
  return theta;
}

/// The undulations of A.11: up to 40 UPR, about 6 um.
double smooth_um(double theta) {
  double sum = 0.0;
  for (const auto& u : test::spec_undulations()) {
    if (u.number <= 40) {
      sum += u.amplitude_um * std::cos(u.number * theta - u.phase_deg * core::kDegree);
    }
  }
  return sum;
}

AngularProfile smooth_profile(const Values& theta) {
  Values r;
  for (const double t : theta) r.push_back(smooth_um(t) * core::kMicrometre);
  return *ordered_profile(theta, r);
}

TEST(Spectrum, AgreesWithTheDirectSumForEveryLength) {
  for (const std::size_t n : {1, 2, 3, 4, 7, 12, 97, 128, 211, 509, 1018, 1024}) {
    SCOPED_TRACE(n);
    const Values x = test::rough_profile(n, n);
    const auto f = spectrum(x);
    ASSERT_EQ(f.size(), n / 2 + 1);
    for (std::size_t k = 0; k < f.size(); ++k) {
      std::complex<double> sum = 0.0;
      for (std::size_t i = 0; i < n; ++i) {
        sum += x[i] * std::polar(1.0, -core::kTwoPi * static_cast<double>(k * i % n) /
                                          static_cast<double>(n));
      }
      EXPECT_LT(std::abs(f[k] - sum), 1e-13) << k;
    }
    const Values back = series_of(f, n);
    for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(back[i], x[i], 1e-15);
  }
}

TEST(ClosedProfile, IsSortedAndMergedWithTheRowsKept) {
  const Values theta = {0.0, 3.0, 1.0, 2.0, 4.0, core::kTwoPi, 1.0};
  const Values r = {1.0, 4.0, 2.0, 3.0, 5.0, 3.0, 6.0};
  const auto profile = ordered_profile(theta, r);
  ASSERT_TRUE(profile.has_value());
  EXPECT_EQ(profile->theta_rad, (Values{0.0, 1.0, 2.0, 3.0, 4.0}));
  EXPECT_EQ(profile->r_mm, (Values{2.0, 4.0, 3.0, 4.0, 5.0}));
  EXPECT_EQ(profile->rows, (std::vector<std::size_t>{0, 2, 3, 1, 4}));
  EXPECT_EQ(profile->merged, 2U);
  EXPECT_GT(profile->reversals, 0U);
  EXPECT_NEAR(profile->largest_gap_rad, core::kTwoPi - 4.0, 1e-15);
}

TEST(ClosedProfile, CountsTurnsAndTakesEitherSense) {
  Values theta;
  for (int i = 0; i < 720; ++i) theta.push_back(-core::kDegree * i - 0.001 * (i / 360));
  const auto profile = ordered_profile(theta, Values(theta.size(), 1.0));
  ASSERT_TRUE(profile.has_value());
  EXPECT_EQ(profile->reversals, 0U);
  EXPECT_NEAR(profile->turns, 719.0 / 360.0, 1e-3);
  EXPECT_EQ(profile->merged, 0U);
}

TEST(ClosedProfile, RefusesTooFewAnglesAndNamesBadRows) {
  EXPECT_EQ(ordered_profile(Values{}, Values{}).error().code, core::Code::kNoPoints);
  EXPECT_EQ(ordered_profile(Values{0, 1, 2, 0, 1, 2}, Values(6, 0.0)).error().code,
            core::Code::kTooFewPoints);
  const double inf = std::numeric_limits<double>::infinity();
  const auto bad = ordered_profile(Values{0, 1, 2, inf, 4}, Values(5, 0.0));
  EXPECT_EQ(bad.error().code, core::Code::kNotFinite);
  EXPECT_NE(bad.error().what.find("row 3 is (angle inf rad, radius 0 mm)"), std::string::npos);
}

TEST(ClosedProfile, CellsFillTheCircleAndLeaveAnArcsGapOut) {
  const Values theta = jittered_angles(1, 50);
  auto sorted = theta;
  std::sort(sorted.begin(), sorted.end());
  const Values cells = angular_cells(sorted);
  EXPECT_NEAR(std::accumulate(cells.begin(), cells.end(), 0.0), core::kTwoPi, 1e-14);
  Values arc;
  for (int i = 0; i <= 100; ++i) arc.push_back(0.01 * i);
  for (const double cell : angular_cells(arc)) EXPECT_NEAR(cell, 0.01, 1e-15);
}

TEST(ClosedProfile, HandsUniformAnglesOnUnchanged) {
  Values theta = test::uniform_angles(360);
  for (double& t : theta) t += 0.123;
  const auto out = resampled(*ordered_profile(theta, test::rough_profile(2, 360)));
  ASSERT_TRUE(out.has_value());
  EXPECT_FALSE(out->interpolated);
  EXPECT_EQ(out->error_mm, 0.0);
  EXPECT_EQ(out->profile.r_mm.size(), 360U);
}

TEST(ClosedProfile, SplineErrorAfterTheFilterIsBelowTheSpecifications) {
  // B.1: 720 points with 35 % jitter, fc = 50: 1.7e-4 um.
  const auto even = resampled(smooth_profile(jittered_angles(5, 720)));
  ASSERT_TRUE(even.has_value());
  const auto line = filter_closed(even->profile.r_mm, {});
  ASSERT_TRUE(line.has_value());
  double most = 0.0;
  for (std::size_t i = 0; i < line->r_mm.size(); ++i) {
    double exact = 0.0;
    for (const auto& u : test::spec_undulations()) {
      if (u.number > 40) continue;
      exact += gaussian_transmission(u.number, 50.0) * u.amplitude_um *
               std::cos(u.number * even->profile.angle_rad(i) - u.phase_deg * core::kDegree);
    }
    most = std::max(most, std::abs(line->r_mm[i] / core::kMicrometre - exact));
  }
  RecordProperty("error_um", std::to_string(most));
  EXPECT_LT(most, 1.7e-4);
}

TEST(ClosedProfile, StatedSplineErrorHoldsTheTrueOne) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const auto even = resampled(smooth_profile(jittered_angles(seed, 400 + 40 * seed)));
    ASSERT_TRUE(even.has_value() && even->interpolated);
    double most = 0.0;
    for (std::size_t i = 0; i < even->profile.r_mm.size(); ++i) {
      most = std::max(most, std::abs(even->profile.r_mm[i] -
                                     smooth_um(even->profile.angle_rad(i)) * core::kMicrometre));
    }
    EXPECT_LT(most, even->error_mm);
    EXPECT_GT(most, 0.3 * even->error_mm);
  }
}

TEST(ClosedProfile, DoesNotBridgeAnArc) {
  Values theta;
  for (int i = 0; i < 200; ++i) theta.push_back(0.01 * i);
  EXPECT_EQ(resampled(*ordered_profile(theta, Values(200, 0.0))).error().code,
            core::Code::kNotFullSection);
}

TEST(Harmonics, ReturnAmplitudeAndPhaseOfEveryUndulation) {
  const Values theta = test::uniform_angles(1200);
  const UniformProfile profile{0.0, test::spec_profile(theta)};
  const auto table = harmonics(profile, {.highest = 150});
  ASSERT_TRUE(table.has_value());
  for (const auto& u : test::spec_undulations()) {
    const Harmonic& h = table->harmonics[static_cast<std::size_t>(u.number - 1)];
    EXPECT_EQ(h.number, u.number);
    EXPECT_NEAR(h.amplitude_mm, u.amplitude_um * 1e-3, 1e-17);
    EXPECT_NEAR(*h.phase_rad, u.phase_deg * core::kDegree, 1e-12);
    EXPECT_NEAR(*h.crest_rad(), u.phase_deg * core::kDegree / u.number, 1e-12);
  }
  EXPECT_NEAR(table->harmonics[0].amplitude_mm, std::hypot(10e-3, 5e-3), 1e-16);
}

TEST(Harmonics, CountPhasesFromAngleZeroWhateverTheStart) {
  Values theta = test::uniform_angles(700);
  for (double& t : theta) t += 0.004;
  const UniformProfile profile{0.004, test::spec_profile(theta)};
  const auto table = harmonics(profile, {.highest = 40});
  ASSERT_TRUE(table.has_value());
  EXPECT_NEAR(*table->harmonics[22].phase_rad, 33.0 * core::kDegree, 1e-12);
}

TEST(Harmonics, LeastSquaresOfJitteredAnglesIsExactBelowItsHighest) {
  const auto profile = smooth_profile(jittered_angles(9, 720));
  const auto table = harmonic_fit(profile, {.highest = 60});
  ASSERT_TRUE(table.has_value());
  EXPECT_NEAR(table->harmonics[15].amplitude_mm, 0.5e-3, 1e-16);
  EXPECT_NEAR(*table->harmonics[39].phase_rad, -60.0 * core::kDegree, 1e-11);
  const UniformProfile again = profile_of(*table, 400);
  for (std::size_t i = 0; i < again.r_mm.size(); ++i) {
    EXPECT_NEAR(again.r_mm[i], smooth_um(again.angle_rad(i)) * 1e-3, 1e-16 * 100);
  }
}

TEST(Harmonics, HideAPhaseThatIsNoise) {
  const UniformProfile profile{0.0, test::rough_profile(4, 1000)};
  const auto table = harmonics(profile, {.highest = 60, .noise_mm = 1e-3});
  ASSERT_TRUE(table.has_value());
  EXPECT_NEAR(table->amplitude_sigma_mm, 1e-3 * std::sqrt(2.0 / 1000.0), 1e-18);
  EXPECT_TRUE(table->harmonics[1].phase_rad.has_value());
  std::size_t hidden = 0;
  for (const Harmonic& h : table->harmonics) hidden += h.phase_rad ? 0U : 1U;
  EXPECT_GT(hidden, 40U);
}

TEST(Harmonics, RefuseWhatThePointsDoNotCarry) {
  const UniformProfile profile{0.0, test::rough_profile(4, 100)};
  EXPECT_EQ(harmonics(profile, {.highest = 15}).error().code, core::Code::kSampling);
  EXPECT_TRUE(harmonics(profile, {.highest = 14}).has_value());
  EXPECT_TRUE(harmonics(profile, {.highest = 49, .override_sampling = true}).has_value());
  EXPECT_EQ(harmonics(profile, {.highest = 50, .override_sampling = true}).error().code,
            core::Code::kBadOption);
  EXPECT_EQ(harmonics(profile, {.highest = 0}).error().code, core::Code::kBadOption);
  Values theta = test::uniform_angles(360);
  theta.erase(theta.begin() + 10, theta.begin() + 20);
  const auto gap = *ordered_profile(theta, Values(350, 1.0));
  EXPECT_EQ(harmonic_fit(gap, {.highest = 20}).error().code, core::Code::kSampling);
  EXPECT_TRUE(harmonic_fit(gap, {.highest = 15}).has_value());
}

}  // namespace
}  // namespace rondure::fit
