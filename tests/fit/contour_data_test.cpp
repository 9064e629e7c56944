// Traces of the control and contours of a gauge, on their way to the method.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include <gtest/gtest.h>

#include "core/noise.h"
#include "core/units.h"
#include "fit/contour/axis_trace.h"
#include "fit/contour/measured_contour.h"
#include "tests/fit/contour_cases.h"

namespace rondure::fit {
namespace {

using core::kDegree;
using core::kMicrometre;

/// @param sense  -1: the errors lie over -alpha.
double worst_x_error(const AxisTurn& turn, double sense = 1.0) {
  double out = 0.0;
  const std::size_t n = turn.errors.x_mm.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double expected = test::spec_x_um(sense * test::turn_angle(i, n)) * kMicrometre;
    out = std::max(out, std::abs(turn.errors.x_mm[i] - expected));
  }
  return out;
}

TEST(AxisTrace, HandsUniformSamplesOn) {
  const auto turn = last_turn(test::spec_trace(300), {.samples = 300}).value();
  EXPECT_LT(worst_x_error(turn), 1e-9 * kMicrometre);
  EXPECT_NEAR(turn.samples_per_turn, 300.0, 1e-9);
  EXPECT_NEAR(turn.turns, 1.0, 1e-9);
  EXPECT_TRUE(turn.warnings.empty());
}

TEST(AxisTrace, TakesOneTurnOfAnyStartAndLength) {
  for (const double turns : {1.0, 1.3, 2.0, 2.7, 4.0}) {
    for (const double start : {0.0, 0.1, 2.0, 6.2}) {
      SCOPED_TRACE(testing::Message() << turns << " turns from " << start);
      const auto turn = last_turn(test::spec_trace(300, turns, start));
      ASSERT_TRUE(turn) << turn.error().what;
      EXPECT_LT(worst_x_error(*turn), 2e-3 * kMicrometre);  // 31 undulations on 300 samples
    }
  }
}

TEST(AxisTrace, TakesTheLastTurn) {
  auto trace = test::spec_trace(300, 3.5, 0.5);
  for (std::size_t i = 0; i < 400; ++i) trace.x_error_mm[i] += 0.05;
  EXPECT_LT(worst_x_error(last_turn(trace).value()), 2e-3 * kMicrometre);
}

TEST(AxisTrace, TakesTheTurnRecordedLastInEitherDirection) {
  for (const double turns : {1.0, 2.0, 2.7, 3.0}) {
    for (const double start : {0.0, 0.1, 2.0}) {
      for (const bool falling : {false, true}) {
        for (const int direction : {1, -1}) {
          SCOPED_TRACE(testing::Message() << turns << " turns from " << start << ", direction "
                                          << direction << (falling ? ", C falls" : ""));
          auto trace = test::spec_trace(300, turns, start);
          if (falling) {
            for (double& c : trace.c_rad) c = -c;
          }
          // The last whole turn from 0 lies in these rows.
          const std::size_t last = start == 0.0 && turns == std::floor(turns) ? 300 : 600;
          for (std::size_t i = 0; i + last < trace.c_rad.size(); ++i) trace.x_error_mm[i] += 0.05;
          const auto turn = last_turn(trace, {.c_direction = direction});
          ASSERT_TRUE(turn) << turn.error().what;
          EXPECT_LT(worst_x_error(*turn, falling ? -direction : direction), 2e-3 * kMicrometre);
        }
      }
    }
  }
}

TEST(AxisTrace, ReadsATraceThatRunsBackwards) {
  auto trace = test::spec_trace(300, 1.5, 0.2);
  std::reverse(trace.c_rad.begin(), trace.c_rad.end());
  std::reverse(trace.c_error_rad.begin(), trace.c_error_rad.end());
  std::reverse(trace.x_error_mm.begin(), trace.x_error_mm.end());
  EXPECT_LT(worst_x_error(last_turn(trace).value()), 2e-3 * kMicrometre);
}

TEST(AxisTrace, RippleBeyondTheSamplesDoesNotComeBack) {
  auto trace = test::spec_trace(7200, 1.0, 0.0);
  for (std::size_t i = 0; i < trace.c_rad.size(); ++i)
    trace.x_error_mm[i] += kMicrometre * std::cos(1430.0 * test::turn_angle(i, 7200));
  EXPECT_LT(worst_x_error(last_turn(trace).value()), 1e-3 * kMicrometre);
}

TEST(AxisTrace, NamesTheRowWhereCGoesBackOrSamplesAreMissing) {
  auto trace = test::spec_trace(300);
  std::swap(trace.c_rad[100], trace.c_rad[101]);
  const auto back = last_turn(trace);
  ASSERT_FALSE(back);
  EXPECT_EQ(back.error().code, core::Code::kAngleOrder);
  EXPECT_NE(back.error().what.find("row 101,"), std::string::npos) << back.error().what;

  trace = test::spec_trace(300);
  trace.c_rad.erase(trace.c_rad.begin() + 50);
  trace.c_error_rad.erase(trace.c_error_rad.begin() + 50);
  trace.x_error_mm.erase(trace.x_error_mm.begin() + 50);
  const auto missing = last_turn(trace);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, core::Code::kSampling);
  EXPECT_NE(missing.error().what.find("at row 50 "), std::string::npos) << missing.error().what;

  trace.c_error_rad.pop_back();
  EXPECT_EQ(last_turn(trace).error().code, core::Code::kMeaning);
}

TEST(AxisTrace, RefusesATurnOfTooFewSamples) {
  auto trace = test::spec_trace(300);
  for (double& c : trace.c_rad) c *= 1000.0;
  const auto few = last_turn(trace);
  ASSERT_FALSE(few);
  EXPECT_EQ(few.error().code, core::Code::kSampling);
  EXPECT_NE(few.error().what.find("C steps by 1200 deg: "), std::string::npos) << few.error().what;
}

TEST(AxisTrace, RefusesLessThanOneTurnAndSaysWhenItIsInRadians) {
  EXPECT_EQ(last_turn(test::spec_trace(300, 0.95)).error().code, core::Code::kNotFullSection);
  auto trace = test::spec_trace(300);
  for (double& c : trace.c_rad) c *= kDegree;  // radians taken for degrees
  const auto radians = last_turn(trace);
  ASSERT_FALSE(radians);
  EXPECT_EQ(radians.error().code, core::Code::kNotFullSection);
  EXPECT_NE(radians.error().what.find("radians"), std::string::npos);
}

TEST(AxisTrace, WarnsOfErrorsThatSuggestAnotherUnit) {
  auto trace = test::spec_trace(300);
  for (double& x : trace.x_error_mm) x *= 1e3;
  EXPECT_EQ(last_turn(trace).value().warnings.size(), 2U);  // size and mean
  trace = test::spec_trace(300);
  for (double& c : trace.c_error_rad) c *= 1e3;
  const auto warnings = last_turn(trace).value().warnings;
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].code, core::Code::kUnits);
}

TEST(AxisTrace, RefusesNaNAndSignsThatAreNone) {
  auto trace = test::spec_trace(300);
  trace.c_error_rad[17] = std::numeric_limits<double>::infinity();
  EXPECT_NE(last_turn(trace).error().what.find("row 17 "), std::string::npos);
  EXPECT_EQ(last_turn(test::spec_trace(300), {.error_sign = 0}).error().code, core::Code::kMeaning);
  EXPECT_EQ(last_turn(test::spec_trace(15)).error().code, core::Code::kTooFewPoints);
}

/// A ground pin with its roughness, 1440 points.
struct Gauge {
  std::vector<double> angle;
  std::vector<double> deviation;
  explicit Gauge(std::uint64_t seed = 1, double rough_um = 0.2) {
    core::KeyedNoise noise(seed, {3});
    for (std::size_t m = 0; m < 1440; ++m) {
      angle.push_back(test::turn_angle(m, 1440));
      deviation.push_back((2.0 * std::cos(2.0 * angle[m]) + rough_um * noise.normal()) *
                          kMicrometre);
    }
  }
};

TEST(MeasuredContour, SeesThatTheGaugeHasFiltered) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Gauge gauge(seed);
    EXPECT_TRUE(measured_contour(gauge.angle, gauge.deviation).value().warnings.empty());
    gauge.deviation = filter_closed(gauge.deviation, {}).value().r_mm;
    const auto twice = measured_contour(gauge.angle, gauge.deviation).value();
    ASSERT_EQ(twice.warnings.size(), 1U);
    EXPECT_EQ(twice.warnings[0].code, core::Code::kFilteredTwice);
    EXPECT_NEAR(twice.filter.passed.value().cutoff_upr, 50.0, 12.0);
    MeasuredContourOptions options;
    options.error.filtered_already = true;
    EXPECT_TRUE(measured_contour(gauge.angle, gauge.deviation, options).value().warnings.empty());
  }
}

/// What a gauge of that cut-off writes of a pin with harmonics 2 to 8 and white roughness, in steps
/// of 0.001 um.
Gauge filtered_gauge(std::uint64_t seed, double rough_um, double cutoff_upr) {
  Gauge out(seed, rough_um);
  core::KeyedNoise noise(seed, {4});
  for (int k = 3; k <= 8; ++k) {
    const double amplitude_mm = kMicrometre * noise.normal() / std::pow(k, 1.5);
    const double phase = core::kTwoPi * noise.uniform();
    for (std::size_t m = 0; m < 1440; ++m) {
      out.deviation[m] += amplitude_mm * std::cos(k * out.angle[m] - phase);
    }
  }
  FilterOptions filter;
  filter.cutoff_upr = cutoff_upr;
  out.deviation = filter_closed(out.deviation, filter).value().r_mm;
  for (double& r : out.deviation) r = 1e-6 * std::round(1e6 * r);
  return out;
}

/// Of `seeds` such pins, those of which another cut-off is found than `stated_upr`.
int of_another_cutoff(int seeds, double rough_um, double cutoff_upr, double stated_upr) {
  int out = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const Gauge gauge = filtered_gauge(static_cast<std::uint64_t>(seed), rough_um, cutoff_upr);
    MeasuredContourOptions options;
    options.error.filtered_already = true;
    options.error.filter.cutoff_upr = stated_upr;
    const auto found = measured_contour(gauge.angle, gauge.deviation, options).value();
    if (!found.filter.other_than(stated_upr)) continue;
    ++out;
    EXPECT_NEAR(std::log(found.filter.passed->cutoff_upr / cutoff_upr), 0.0, std::log(1.35))
        << seed;
    EXPECT_TRUE(std::ranges::any_of(found.warnings, [](const core::Error& warning) {
      return warning.code == core::Code::kInconsistent;
    })) << seed;
  }
  return out;
}

TEST(MeasuredContour, FindsTheCutOffAtWhichTheGaugeHasFiltered) {
  constexpr int kSeeds = 40;
  const int low = of_another_cutoff(kSeeds, 0.2, 15.0, 50.0);
  const int middle = of_another_cutoff(kSeeds, 0.2, 50.0, 150.0);
  const int high = of_another_cutoff(kSeeds, 0.2, 150.0, 50.0);
  std::printf("40 pins of 0.2 um, 15 for 50 UPR found: %d, 50 for 150: %d, 150 for 50: %d\n", low,
              middle, high);
  EXPECT_GE(low, 34);
  EXPECT_GE(middle, 36);
  EXPECT_GE(high, 36);
  for (const double rough_um : {0.2, 0.05, 0.02, 0.005}) {
    SCOPED_TRACE(rough_um);
    for (const double cutoff_upr : {15.0, 50.0, 150.0}) {
      EXPECT_EQ(of_another_cutoff(kSeeds, rough_um, cutoff_upr, cutoff_upr), 0) << cutoff_upr;
    }
  }
}

TEST(MeasuredContour, DoubtsAFilterThatLeftEverything) {
  const Gauge gauge;
  MeasuredContourOptions options;
  options.error.filtered_already = true;
  const auto out = measured_contour(gauge.angle, gauge.deviation, options).value();
  ASSERT_EQ(out.warnings.size(), 1U);
  EXPECT_EQ(out.warnings[0].code, core::Code::kFilteredTwice);
}

TEST(MeasuredContour, ChatterBeyondTheSamplesDoesNotComeBackAsALowUndulation) {
  std::vector<double> angle;
  std::vector<double> deviation;
  for (std::size_t i = 0; i < 7200; ++i) {
    angle.push_back(test::turn_angle(i, 7200));
    deviation.push_back(kMicrometre *
                        (3.0 * std::cos(2.0 * angle.back()) + std::cos(1430.0 * angle.back())));
  }
  MeasuredContourOptions options;
  const auto filtered = measured_contour(angle, deviation, options).value();
  EXPECT_NEAR(filtered.contour.peak_to_valley_mm, 6.0 * std::exp2(-0.0016) * kMicrometre,
              2e-3 * kMicrometre);
  EXPECT_TRUE(filtered.warnings.empty());
  options.error.filter.filter = ProfileFilter::kNone;
  const auto bare = measured_contour(angle, deviation, options).value();
  ASSERT_EQ(bare.warnings.size(), 1U);
  EXPECT_EQ(bare.warnings.front().code, core::Code::kUndersampled);
}

TEST(MeasuredContour, FollowsOffsetAndDirection) {
  const Gauge straight(1, 0.2);
  Gauge turned = straight;
  for (double& a : turned.angle) a = 0.7 - a;
  MeasuredContourOptions options;
  options.phase_offset_rad = 0.7;
  options.direction = -1;
  const auto a = measured_contour(straight.angle, straight.deviation).value().contour.error_mm;
  const auto b = measured_contour(turned.angle, turned.deviation, options).value().contour.error_mm;
  for (std::size_t m = 0; m < a.size(); ++m) EXPECT_NEAR(a[m], b[m], 1e-12);
}

TEST(MeasuredContour, RefusesGapsWrongOrderAndWrongUnits) {
  Gauge gauge;
  std::swap(gauge.angle[20], gauge.angle[21]);
  const auto order = measured_contour(gauge.angle, gauge.deviation);
  EXPECT_EQ(order.error().code, core::Code::kAngleOrder);
  EXPECT_NE(order.error().what.find("row 21,"), std::string::npos) << order.error().what;

  // Two pins in one file, as two turns one after the other.
  Gauge two;
  const std::size_t rows = two.angle.size();
  for (std::size_t i = 0; i < rows; ++i) {
    two.angle.push_back(two.angle[i]);
    two.deviation.push_back(-two.deviation[i]);
  }
  const auto turns = measured_contour(two.angle, two.deviation);
  ASSERT_FALSE(turns);
  EXPECT_EQ(turns.error().code, core::Code::kAngleOrder);
  EXPECT_NE(turns.error().what.find("one turn of one part"), std::string::npos);

  Gauge gap;
  gap.angle.erase(gap.angle.begin() + 100, gap.angle.begin() + 104);
  gap.deviation.erase(gap.deviation.begin() + 100, gap.deviation.begin() + 104);
  EXPECT_EQ(measured_contour(gap.angle, gap.deviation).error().code, core::Code::kNotFullSection);

  Gauge one;
  one.angle.erase(one.angle.begin() + 100);
  one.deviation.erase(one.deviation.begin() + 100);
  const auto sparse = measured_contour(one.angle, one.deviation).value();
  ASSERT_EQ(sparse.warnings.size(), 1U);
  EXPECT_EQ(sparse.warnings[0].code, core::Code::kSparse);

  Gauge radians;
  for (double& a : radians.angle) a *= kDegree;
  EXPECT_NE(measured_contour(radians.angle, radians.deviation).error().what.find("in radians"),
            std::string::npos);

  Gauge mm;
  for (double& d : mm.deviation) d *= 1e-3;
  EXPECT_EQ(measured_contour(mm.angle, mm.deviation).value().warnings.back().code,
            core::Code::kUnits);
}

TEST(MeasuredContour, RefusesDifferentLengthsAndTooFewRows) {
  Gauge gauge;
  gauge.deviation.pop_back();
  EXPECT_EQ(measured_contour(gauge.angle, gauge.deviation).error().code, core::Code::kMeaning);
  EXPECT_EQ(measured_contour(std::vector<double>(4, 0.0), std::vector<double>(4, 0.0)).error().code,
            core::Code::kTooFewPoints);
}

}  // namespace
}  // namespace rondure::fit
