// The largest error of an axis of a calibrated fixture: value, sign, interval.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/evaluation/rotary_bench.h"

namespace rondure::evaluation::rotary_bench {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// One error of an axis, in limits with a sign.
record::Characteristic axis_error_of(record::Indication::Axis axis,
                                     record::Indication::AxisError error, double lower_mm,
                                     double upper_mm) {
  record::Characteristic out;
  out.id = "c";
  out.form = record::Form::kAxisError;
  out.lower_mm = lower_mm;
  out.tolerance_mm = upper_mm;
  out.indication.axis = axis;
  out.indication.error = error;
  return out;
}

TEST(AxisError, TheStationFarthestFromTheMiddleDecides) {
  const std::vector<double> errors = {-3.0, 2.0, 1.0};
  const AxisExtreme about_0 = axis_extreme(errors, 0.0);
  EXPECT_EQ(about_0.station, 0U);
  EXPECT_EQ(about_0.from_middle_mm, 3.0);
  EXPECT_FALSE(about_0.above);
  const AxisExtreme about_minus_2 = axis_extreme(errors, -2.0);
  EXPECT_EQ(about_minus_2.station, 1U);
  EXPECT_EQ(about_minus_2.from_middle_mm, 4.0);
  EXPECT_TRUE(about_minus_2.above);
}

TEST(AxisError, IsTheLargestOverTheStationsOfACalibration) {
  using AxisIndication = record::Indication;
  Bench bench;
  bench.declared.emplace().ball_um = record::DeclaredInfluence{0.1};
  record::RunRecord run = calibration_run(bench);
  auto& asked = run.features[0].characteristics;
  asked.clear();
  for (const auto axis : {AxisIndication::Axis::kAlpha, AxisIndication::Axis::kBeta}) {
    for (const auto error : {AxisIndication::AxisError::kX, AxisIndication::AxisError::kY,
                             AxisIndication::AxisError::kZ, AxisIndication::AxisError::kA,
                             AxisIndication::AxisError::kB, AxisIndication::AxisError::kC}) {
      asked.push_back(axis_error_of(axis, error, -1.0, 1.0));
    }
  }
  const auto evaluation = evaluate(run);
  ASSERT_TRUE(evaluation);
  const FeatureResult& feature = evaluation->features.at(0);
  ASSERT_NE(result_of(feature), nullptr) << (feature.failure ? feature.failure->what : "");
  const fixture::SimulatedFixture hidden(fixture_options());
  for (std::size_t c = 0; c < 12; ++c) {
    SCOPED_TRACE(c);
    const CharacteristicResult& one = feature.characteristics.at(c);
    const bool angle = c % 6 >= 3;
    double truth_mm = 0.0;  // of an angle in mrad
    for (int k = -4; k <= 4; ++k) {
      const auto errors = hidden.true_errors(c >= 6, k * kStep_deg * kDegree);
      const auto i = static_cast<Eigen::Index>(c % 3);
      truth_mm =
          std::max(truth_mm, std::abs(angle ? 1e3 * errors.tilt_rad(i) : errors.shift_mm(i)));
    }
    ASSERT_TRUE(one.value && one.value->statement() != nullptr) << one.reason;
    EXPECT_EQ(one.value->unit(), angle ? core::ValueUnit::kUrad : core::ValueUnit::kUm);
    const UncertaintyStatement& said = *one.value->statement();
    const double u_mm = 0.5 * (said.high_mm - said.low_mm);
    EXPECT_GT(u_mm, 0.0);
    EXPECT_NEAR(std::abs(said.estimate_mm), truth_mm, 3.0 * u_mm);
    EXPECT_NEAR(std::abs(*one.value_mm()), truth_mm, 3.0 * u_mm);
  }
}

TEST(AxisError, TheSignOfTheErrorCounts) {
  using AxisIndication = record::Indication;
  Bench bench;
  bench.declared.emplace().ball_um = record::DeclaredInfluence{0.1};
  record::RunRecord run = calibration_run(bench);
  run.header.decision_rule = "iso-14253-1";
  for (const auto error : {AxisIndication::AxisError::kY, AxisIndication::AxisError::kB}) {
    SCOPED_TRACE(record::name_of(error));
    const auto judged = [&](double lower_mm, double upper_mm) {
      run.features[0].characteristics = {
          axis_error_of(AxisIndication::Axis::kAlpha, error, lower_mm, upper_mm)};
      const auto evaluation = evaluate(run);
      EXPECT_TRUE(evaluation);
      return evaluation->features.at(0).characteristics.at(0);
    };
    const CharacteristicResult within = judged(-1.0, 1.0);
    EXPECT_EQ(within.verdict, Verdict::kConforms) << within.reason;
    const double found_mm = within.value_mm().value();
    const double size_mm = std::abs(found_mm);
    EXPECT_EQ(judged(-2.0 * size_mm, 2.0 * size_mm).verdict, Verdict::kConforms);
    const CharacteristicResult beyond = found_mm > 0.0 ? judged(-2.0 * size_mm, 0.5 * size_mm)
                                                       : judged(-0.5 * size_mm, 2.0 * size_mm);
    EXPECT_EQ(beyond.verdict, Verdict::kDoesNotConform) << beyond.reason;
    EXPECT_EQ(beyond.value_mm().value(), found_mm);
    const std::string_view unit = record::is_angle(error) ? " urad" : " um";
    const std::string_view other = record::is_angle(error) ? " um" : " urad";
    for (const CharacteristicResult* one : {&within, &beyond}) {
      for (const std::string& text : {one->reason.english(), one->value->sentence().english()}) {
        EXPECT_THAT(text, HasSubstr(std::string(unit)));
        EXPECT_THAT(text, Not(HasSubstr(std::string(other))));
      }
    }
  }
}

/// A result of one axis with 24 stations, whose errors carry noise of standard deviation u.
RotaryResult of_stations(const std::function<double(double)>& error_mm, double u_mm,
                         std::uint64_t seed) {
  core::KeyedNoise noise(seed, {77});
  std::vector<fixture::AxisStation> stations;
  for (int k = 0; k < 24; ++k) {
    fixture::AxisStation station;
    station.angle_rad = (k * kStep_deg - 172.5) * kDegree;
    station.errors.shift_mm.x() = error_mm(station.angle_rad) + u_mm * noise.normal();
    station.covariance(0, 0) = u_mm * u_mm;
    // The same numbers in mrad as a tilt about z.
    station.errors.tilt_rad.z() = 1e-3 * station.errors.shift_mm.x();
    station.covariance(5, 5) = 1e-6 * u_mm * u_mm;
    stations.push_back(station);
  }
  auto motion = fixture::StationMotion::through(std::move(stations));
  EXPECT_TRUE(motion);
  RotaryResult out;
  out.calibration.alpha = *motion;
  out.declared.emplace();
  return out;
}

// Section 3.2: the largest of 24 stations without an error reads 2.24 u, and is turned.
TEST(AxisError, ErrorsOfNoiseAloneAreTurned) {
  constexpr double kU_mm = 0.3e-3;
  constexpr int kRuns = 20;
  record::Characteristic asked =
      axis_error_of(record::Indication::Axis::kAlpha, record::Indication::AxisError::kX, 0.0, 5e-3);
  asked.lower_mm.reset();
  double measured = 0.0;
  double estimate = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const RotaryResult found =
        of_stations([](double) { return 0.0; }, kU_mm, static_cast<std::uint64_t>(run));
    const auto value = value_of(found, asked);
    ASSERT_TRUE(value);
    measured += value->value_mm / kU_mm / kRuns;
    const auto intervals = intervals_of(found, std::vector{asked}, {});
    ASSERT_EQ(intervals.size(), 1U);
    const UncertaintyStatement* said = intervals[0].about(Measurand::kSampledPoints);
    ASSERT_NE(said, nullptr) << intervals[0].why();
    estimate += said->estimate_mm / kU_mm / kRuns;
  }
  EXPECT_NEAR(measured, 2.24, 0.35);
  EXPECT_LT(estimate, 0.8 * measured);
}

// Errors of the same numbers in mrad and in mm: value and interval are the same numbers.
TEST(AxisError, OfAnAngleIsThatOfALengthOfTheSameNumbers) {
  const RotaryResult found =
      of_stations([](double rad) { return -10e-3 * std::cos(rad) - 2e-3; }, 0.3e-3, 3);
  record::Characteristic asked = axis_error_of(record::Indication::Axis::kAlpha,
                                               record::Indication::AxisError::kX, -20e-3, 20e-3);
  const auto shift = value_of(found, asked);
  const auto of_shift = intervals_of(found, std::vector{asked}, {});
  asked.indication.error = record::Indication::AxisError::kC;
  const auto tilt = value_of(found, asked);
  const auto of_tilt = intervals_of(found, std::vector{asked}, {});
  ASSERT_TRUE(shift && tilt);
  EXPECT_NEAR(tilt->value_mm, shift->value_mm, 1e-12);
  const UncertaintyStatement* length = of_shift.at(0).about(Measurand::kSampledPoints);
  const UncertaintyStatement* angle = of_tilt.at(0).about(Measurand::kSampledPoints);
  ASSERT_TRUE(length != nullptr && angle != nullptr);
  // Draws of their own: the widths agree within the scatter of 2000 trials.
  EXPECT_NEAR(angle->estimate_mm, length->estimate_mm, 0.1e-3);
  EXPECT_NEAR(angle->expanded_mm(), length->expanded_mm(), 0.15 * length->expanded_mm());
}

TEST(AxisError, IntervalsHoldTheLargestError) {
  constexpr double kU_mm = 0.3e-3;
  constexpr int kRuns = 60;
  const record::Characteristic asked = axis_error_of(
      record::Indication::Axis::kAlpha, record::Indication::AxisError::kX, -20e-3, 20e-3);
  const auto error = [](double rad) { return -10e-3 * std::cos(rad - 37.5 * kDegree); };
  int inside = 0;
  for (int run = 0; run < kRuns; ++run) {
    // -12 um at 37.5 deg, 8 um at -142.5 deg.
    const RotaryResult found = of_stations([&](double rad) { return error(rad) - 2e-3; }, kU_mm,
                                           static_cast<std::uint64_t>(run));
    const auto intervals = intervals_of(found, std::vector{asked}, {});
    const UncertaintyStatement* said = intervals.at(0).about(Measurand::kSampledPoints);
    ASSERT_NE(said, nullptr) << intervals[0].why();
    EXPECT_LT(said->high_mm, 0.0);
    if (said->low_mm <= -12e-3 && said->high_mm >= -12e-3) ++inside;
  }
  EXPECT_GE(inside, 50);  // of 95 %: fewer once in 10 000
}

}  // namespace
}  // namespace rondure::evaluation::rotary_bench
