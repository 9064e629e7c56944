#include "fit/profiles/open_profile.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/units.h"
#include "fit/least_squares/circle.h"
#include "fit/profiles/generatrix.h"
#include "fit/profiles/profile_filter.h"

namespace rondure::fit {
namespace {

using Values = std::vector<double>;

Values positions(std::size_t count, double step) {
  Values x(count);
  for (std::size_t i = 0; i < count; ++i) x[i] = step * static_cast<double>(i);
  return x;
}

template <class F>
Values values(const Values& x, const F& f) {
  Values out;
  for (const double at : x) out.push_back(f(at));
  return out;
}

/// Amplitude of cos(2 pi x / wavelength) in the middle of a filtered long profile.
double middle_transmission(OpenEnds ends, double wavelength) {
  const Values x = positions(2001, 0.01);
  const auto wave = [&](double at) { return std::cos(core::kTwoPi * (at - 10.0) / wavelength); };
  const auto line = filter_open(x, values(x, wave), {0.8, ends});
  EXPECT_TRUE(line.has_value());
  return line->r_mm[1000 - line->first];
}

TEST(OpenProfile, TransmitsTheGaussianInTheMiddle) {
  for (const double ratio : {0.5, 1.0, 2.0}) {
    const double expected = std::exp2(-ratio * ratio);
    EXPECT_NEAR(middle_transmission(OpenEnds::kLine, 0.8 / ratio), expected, 1e-12);
    EXPECT_NEAR(middle_transmission(OpenEnds::kDiscard, 0.8 / ratio), expected, 1e-12);
  }
  EXPECT_NEAR(middle_transmission(OpenEnds::kParabola, 0.8), 0.5, 1e-12);
}

TEST(OpenProfile, EndTreatmentKeepsItsPolynomialToTheEnds) {
  Values x = positions(300, 0.02);
  for (std::size_t i = 0; i < x.size(); i += 3) x[i] += 0.004;  // spacing need not be uniform
  const auto line = [](double at) { return 3.0 - 0.7 * at; };
  const auto parabola = [](double at) { return 1.0 + at - 0.2 * at * at; };
  const auto by_line = filter_open(x, values(x, line), {0.8, OpenEnds::kLine});
  const auto by_parabola = filter_open(x, values(x, parabola), {0.8, OpenEnds::kParabola});
  ASSERT_TRUE(by_line && by_parabola);
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(by_line->r_mm[i], line(x[i]), 1e-12);
    EXPECT_NEAR(by_parabola->r_mm[i], parabola(x[i]), 1e-11);
  }
}

TEST(OpenProfile, DiscardLosesHalfACutOffAtBothEnds) {
  const Values x = positions(101, 0.1);
  const auto line = filter_open(x, Values(x.size(), 2.0), {2.0, OpenEnds::kDiscard});
  ASSERT_TRUE(line.has_value());
  EXPECT_EQ(line->first, 10U);
  EXPECT_EQ(line->position.size(), 81U);
  for (const double r : line->r_mm) EXPECT_NEAR(r, 2.0, 1e-14);
}

TEST(OpenProfile, EndIsTheWeightedLineThroughTheEnd) {
  // Written out for the first point: a straight line by weighted least squares.
  // A point weighs as half the gaps to its neighbours, the first one as its whole gap.
  Values x = positions(200, 0.05);
  for (std::size_t i = 1; i < x.size(); ++i) x[i] += 0.03;
  const Values r = values(x, [](double at) { return std::sin(3.0 * at) + 0.2 * at * at; });
  const double width = std::sqrt(std::numbers::ln2 / std::numbers::pi) * 1.5;
  double s0 = 0.0, s1 = 0.0, s2 = 0.0, t0 = 0.0, t1 = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double cell = i == 0 ? 0.08 : i == 1 ? 0.065 : 0.05;
    const double w = cell * std::exp(-std::numbers::pi * std::pow(x[i] / width, 2));
    s0 += w, s1 += w * x[i], s2 += w * x[i] * x[i], t0 += w * r[i], t1 += w * x[i] * r[i];
  }
  const auto line = filter_open(x, r, {1.5, OpenEnds::kLine});
  ASSERT_TRUE(line.has_value());
  EXPECT_NEAR(line->r_mm[0], (t0 * s2 - t1 * s1) / (s0 * s2 - s1 * s1), 1e-11);
}

TEST(OpenProfile, RefusesGapsThatHideAnUndulationUnlessOverridden) {
  Values x = positions(100, 0.1);
  EXPECT_TRUE(filter_open(x, Values(100, 0.0), {0.7}).has_value());
  EXPECT_EQ(filter_open(x, Values(100, 0.0), {0.6}).error().code, core::Code::kSampling);
  const auto forced = filter_open(x, Values(100, 0.0), {0.6, OpenEnds::kLine, true});
  ASSERT_TRUE(forced.has_value());
  EXPECT_TRUE(forced->sampling_overridden);
  x[50] = x[49];
  const auto back = filter_open(x, Values(100, 0.0), {0.8});
  EXPECT_EQ(back.error().code, core::Code::kBadOption);
  EXPECT_NE(back.error().what.find("row 50"), std::string::npos);
  EXPECT_EQ(filter_open(Values{0, 1}, Values{0, 1}, {0.8}).error().code, core::Code::kTooFewPoints);
}

// Expected numbers of the profiles with windows: methods, drawing section 12 (W8, W9).

Values generatrix_of_the_specification() {
  return values(positions(41, 1.0), [](double z) {
    return 0.002 * z / 40.0 + 0.003 * std::sin(core::kTwoPi * z / 25.0) +
           0.001 * std::sin(core::kTwoPi * z / 3.0 + 0.5);
  });
}

TEST(OpenProfile, FiltersAGeneratrixBeforeItsStraightnessIsTaken) {
  const Values z = positions(41, 1.0);
  const Values r = generatrix_of_the_specification();
  const auto raw = generatrix_straightness(z, r);
  ASSERT_TRUE(raw.has_value());
  EXPECT_NEAR(raw->ls.total_mm, 0.007541207042, 1e-12);
  EXPECT_NEAR(raw->zone_mm, 0.007349284296, 1e-12);
  const auto line = filter_open(z, r, {8.0});
  ASSERT_TRUE(line.has_value());
  EXPECT_NEAR(line->r_mm[0], 0.000535961571, 1e-12);
  EXPECT_NEAR(line->r_mm[20], -0.001664907839, 1e-12);
  EXPECT_NEAR(line->r_mm[40], 0.000747955645, 1e-12);
  const auto filtered = generatrix_straightness(z, line->r_mm);
  EXPECT_NEAR(filtered->ls.total_mm, 0.005765490675, 1e-12);
  EXPECT_NEAR(filtered->zone_mm, 0.005577732496, 1e-12);
  EXPECT_NEAR(filtered->ls_slope, 0.00003436447581, 1e-14);
}

TEST(OpenProfile, LetsNoPointStandForAWindow) {
  Values z = positions(41, 1.0);
  Values r = generatrix_of_the_specification();
  z.erase(z.begin() + 17, z.begin() + 24);
  r.erase(r.begin() + 17, r.begin() + 24);
  OpenFilterOptions options{8.0};
  EXPECT_EQ(filter_open(z, r, options).error().code, core::Code::kSampling);
  options.windows = true;
  const auto line = filter_open(z, r, options);
  ASSERT_TRUE(line.has_value());
  EXPECT_FALSE(line->sampling_overridden);
  EXPECT_NEAR(line->r_mm[16], -0.001012355070, 1e-12);
  EXPECT_NEAR(line->r_mm[17], 0.000966553139, 1e-12);
  const auto straight = generatrix_straightness(z, line->r_mm);
  EXPECT_NEAR(straight->ls.total_mm, 0.004853152471, 1e-12);
  EXPECT_NEAR(straight->zone_mm, 0.004604884871, 1e-12);
}

AngularProfile dense_section(std::size_t from, std::size_t to) {
  Values theta;
  Values r;
  for (std::size_t i = 0; i < 360; ++i) {
    if (i >= from && i < to) continue;
    const double t = core::kTwoPi * static_cast<double>(i) / 360.0;
    theta.push_back(t);
    r.push_back(20.0 + 0.004 * std::cos(2 * t - 0.3) + 0.003 * std::cos(3 * t - 1.1) +
                0.0015 * std::cos(7 * t + 0.4) + 0.0008 * std::cos(40 * t) +
                0.0005 * std::cos(120 * t - 0.2));
  }
  return *ordered_profile(theta, r);
}

TEST(ClosedProfileWithWindows, EqualsTheGaussianWhereThereIsNone) {
  const AngularProfile profile = dense_section(0, 0);
  const auto line = filter_with_windows(profile, 50.0);
  const auto gaussian = filter_closed(profile.r_mm, {});
  ASSERT_TRUE(line && gaussian);
  for (std::size_t i = 0; i < 360; ++i) EXPECT_NEAR((*line)[i], gaussian->r_mm[i], 1e-10);
}

TEST(ClosedProfileWithWindows, KeepsTheEndsBesideAWindow) {
  const AngularProfile profile = dense_section(100, 111);
  const auto line = filter_with_windows(profile, 50.0);
  ASSERT_TRUE(line.has_value());
  EXPECT_NEAR((*line)[99], 19.996910033426, 1e-11);
  EXPECT_NEAR((*line)[100], 19.996527621279, 1e-11);
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < line->size(); ++i) {
    points.push_back((*line)[i] * Eigen::Vector2d(std::cos(profile.theta_rad[i]),
                                                  std::sin(profile.theta_rad[i])));
  }
  EXPECT_NEAR(ls_circle(points)->deviation_mm, 0.015048350530, 1e-11);
  EXPECT_EQ(filter_with_windows(profile, 60.0).error().code, core::Code::kSampling);
}

}  // namespace
}  // namespace rondure::fit
