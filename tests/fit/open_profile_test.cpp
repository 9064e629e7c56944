#include "fit/profiles/open_profile.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/units.h"

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
  const Values x = positions(200, 0.05);
  const Values r = values(x, [](double at) { return std::sin(3.0 * at) + 0.2 * at * at; });
  const double width = std::sqrt(std::numbers::ln2 / std::numbers::pi) * 1.5;
  double s0 = 0.0, s1 = 0.0, s2 = 0.0, t0 = 0.0, t1 = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double w = std::exp(-std::numbers::pi * std::pow(x[i] / width, 2));
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

}  // namespace
}  // namespace rondure::fit
