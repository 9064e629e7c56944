// Trials of the values of a curve: its draws, the statement that they make, how often the interval
// holds the truth of curves simulated here, and what the rules make of an upper bound.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Core>

#include "core/noise.h"
#include "core/statistics.h"
#include "core/units.h"
#include "evaluation/decision/decision.h"
#include "evaluation/results/stated_value.h"
#include "evaluation/uncertainty/curve_trials.h"
#include "tests/core/full.h"

namespace rondure::evaluation {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Kind = DecisionRule::Kind;

constexpr double kMicron = core::kMicrometre;

std::vector<double> column(const CurveDraws& draws, std::size_t k, int trials) {
  std::vector<double> out;
  for (int t = 0; t < trials; ++t) out.push_back(draws.draw(t)[k]);
  return out;
}

/// 40 coefficients of 0.1 um uncertainty in two groups, all `rest_mm` but for those of `large`.
MeasuredCurve curve_with(const std::vector<std::size_t>& large, double rest_mm = 0.05 * kMicron) {
  MeasuredCurve curve;
  for (std::size_t k = 0; k < 40; ++k) {
    const bool is_large = std::find(large.begin(), large.end(), k) != large.end();
    curve.found_mm.push_back(is_large ? 5.0 * kMicron : rest_mm);
    curve.u_mm.push_back(0.1 * kMicron);
    curve.group.push_back(k < 20 ? 0 : 1);
  }
  return curve;
}

std::vector<std::size_t> core_rows(const MeasuredCurve& curve) {
  std::vector<std::size_t> out;
  const CurveDraws draws(curve, 1, "noise");
  for (std::size_t k = 0; k < draws.core_mm().size(); ++k) {
    if (draws.core_mm()[k] != 0.0) out.push_back(k);
  }
  return out;
}

// ---- Draws -------------------------------------------------------------------------------------

TEST(CurveDraws, DependOnSeedNameAndTrialAlone) {
  const MeasuredCurve curve = curve_with({3, 25});
  const CurveDraws one(curve, 7, "probe.noise");
  const CurveDraws other(curve, 7, "probe.noise");
  const auto first = one.draw(5);
  for (const int trial : {9, 0, 5, 3}) static_cast<void>(other.draw(trial));
  static_cast<void>(other.core_draw(5));
  EXPECT_EQ(other.draw(5), first);
  EXPECT_NE(one.draw(6), first);
  EXPECT_NE(CurveDraws(curve, 8, "probe.noise").draw(5), first);
  EXPECT_NE(CurveDraws(curve, 7, "probe.drift").draw(5), first);
}

TEST(CurveDraws, TheCoreIsDrawnAlikeWithThePoolAndWithoutIt) {
  const CurveDraws draws(curve_with({3, 25}), 7, "noise");
  const auto whole = draws.draw(11);
  const auto core = draws.core_draw(11);
  for (std::size_t k = 0; k < whole.size(); ++k) {
    const bool in_core = k == 3 || k == 25;
    EXPECT_EQ(core[k], in_core ? whole[k] : 0.0) << k;
  }
}

TEST(CurveDraws, WhatStandsOutOfTheNoiseIsTheCore) {
  using Rows = std::vector<std::size_t>;
  EXPECT_EQ(core_rows(curve_with({3, 25})), (Rows{3, 25}));
  // sqrt(2 ln 400) = 3.4616 uncertainties
  MeasuredCurve edge = curve_with({});
  edge.found_mm[4] = -0.3463 * kMicron;
  edge.found_mm[5] = 0.3460 * kMicron;
  EXPECT_EQ(core_rows(edge), (Rows{4}));
  // Five of twenty are a quarter, six are more: the whole group, not the other one.
  EXPECT_EQ(core_rows(curve_with({0, 1, 2, 3, 4})).size(), 5U);
  EXPECT_EQ(core_rows(curve_with({0, 1, 2, 3, 4, 5})).size(), 20U);
  MeasuredCurve badly = curve_with({});
  badly.u_mm[7] = 0.26 * kMicron;
  badly.u_mm[8] = 0.24 * kMicron;
  EXPECT_EQ(core_rows(badly), (Rows{7}));
  MeasuredCurve always = curve_with({});
  always.always_core.assign(40, false);
  always.always_core[2] = true;
  EXPECT_EQ(core_rows(always), (Rows{2}));
  MeasuredCurve field = curve_with({3, 25});
  field.field = true;
  EXPECT_EQ(core_rows(field), Rows{});
}

TEST(CurveDraws, UpToTwelveCoefficientsMakeOneGroup) {
  MeasuredCurve curve;
  for (int k = 0; k < 12; ++k) {
    curve.found_mm.push_back(k < 3 ? 5.0 * kMicron : 0.05 * kMicron);
    curve.u_mm.push_back(0.1 * kMicron);
    curve.group.push_back(k < 4 ? 0 : 1);
  }
  EXPECT_EQ(core_rows(curve).size(), 3U) << "3 of 12 are no more than a quarter";
  curve.found_mm[8] = 5.0 * kMicron;
  EXPECT_EQ(core_rows(curve).size(), 12U);
}

TEST(CurveDraws, BothPartsOfAHarmonicBelongToTheCoreTogether) {
  MeasuredCurve curve = curve_with({3});
  for (int k = 0; k < 40; ++k) curve.order.push_back(k / 2);
  EXPECT_EQ(core_rows(curve), (std::vector<std::size_t>{2, 3}));
  // Neither part is beyond sqrt(2 ln 200) = 3.2552 uncertainties, but their amplitude is.
  curve = curve_with({});
  for (int k = 0; k < 40; ++k) curve.order.push_back(k / 2);
  curve.found_mm[10] = curve.found_mm[11] = 0.24 * kMicron;
  EXPECT_EQ(core_rows(curve), (std::vector<std::size_t>{10, 11}));
}

TEST(CurveDraws, ACoreCoefficientHasItsMeasuredValueAndUncertainty) {
  const CurveDraws draws(curve_with({3}), 1, "noise");
  const auto values = column(draws, 3, 4000);
  const double mean = core::mean(values);
  EXPECT_NEAR(mean, 5.0 * kMicron, 4.0 * 0.1 * kMicron / std::sqrt(4000.0));
  EXPECT_NEAR(core::standard_deviation(values, mean), 0.1 * kMicron, 0.005 * kMicron);
}

/// Mean of w = P / (P + u^2) by a plain sum over the prior of the specification, fewer than 20.
double expected_weight(const std::vector<double>& found, double u, double zero_1) {
  double squares = 0.0;
  for (const double c : found) squares += c * c;
  const double noise = u * u;
  const double reach = 10.0 * std::max(squares / static_cast<double>(found.size()), noise);
  const auto likelihood = [&](double power) {
    return std::pow(power + noise, -0.5 * static_cast<double>(found.size())) *
           std::exp(-0.5 * squares / (power + noise));
  };
  double all = zero_1 * likelihood(0.0);
  double weighted = 0.0;
  constexpr int kSteps = 200'000;
  for (int i = 0; i < kSteps; ++i) {
    const double power = reach * (i + 0.5) / kSteps;
    const double density = (1.0 - zero_1) * (reach / kSteps) / (power + noise) /
                           std::log1p(reach / noise) * likelihood(power);
    all += density;
    weighted += density * power / (power + noise);
  }
  return weighted / all;
}

TEST(CurveDraws, ThePoolIsDrawnFromItsPosterior) {
  for (const bool field : {false, true}) {
    SCOPED_TRACE(field);
    MeasuredCurve curve;
    curve.found_mm = {1.5 * kMicron, -0.4 * kMicron, 0.9 * kMicron, 2.0 * kMicron};
    curve.u_mm.assign(4, 1.0 * kMicron);
    curve.group.assign(4, 0);
    curve.field = field;
    constexpr int kTrials = 20'000;
    const CurveDraws draws(curve, 3, "noise");
    const auto values = column(draws, 3, kTrials);
    const double w = expected_weight({1.5, -0.4, 0.9, 2.0}, 1.0, field ? 0.0 : 0.1);
    // The spread of a draw is below 1.2 um.
    EXPECT_NEAR(core::mean(values), w * 2.0 * kMicron, 4.0 * 1.2 * kMicron / std::sqrt(kTrials));
    const auto zeros = std::count(values.begin(), values.end(), 0.0);
    EXPECT_EQ(zeros == 0, field) << "a random field is never 0";
  }
}

TEST(CurveDraws, NoiseAloneIsDrawnSmallerThanItWasFound) {
  MeasuredCurve curve = curve_with({});
  core::KeyedNoise noise(5, {1});
  for (double& c : curve.found_mm) c = 0.1 * kMicron * noise.normal();
  const CurveDraws draws(curve, 1, "noise");
  std::vector<double> rms;
  for (int t = 0; t < 1000; ++t) rms.push_back(core::root_mean_square(draws.draw(t)));
  EXPECT_LT(core::mean(rms), 0.5 * core::root_mean_square(curve.found_mm));
}

TEST(CurveDraws, AFieldFarAboveItsNoiseIsTheFieldThatWasFound) {
  MeasuredCurve curve;
  core::KeyedNoise noise(5, {2});
  for (int k = 0; k < 3000; ++k) {
    curve.found_mm.push_back(10.0 * kMicron * noise.normal());
    curve.u_mm.push_back(1e-3 * kMicron);
    curve.group.push_back(0);
  }
  curve.field = true;
  const auto drawn = CurveDraws(curve, 1, "field").draw(0);
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    EXPECT_NEAR(drawn[k], curve.found_mm[k], 6e-3 * kMicron) << k;
  }
}

TEST(CurveTrials, DrawsOfInfluencesAreStandardAndSharedByName) {
  std::vector<double> normal;
  std::vector<double> uniform;
  for (int t = 0; t < 20'000; ++t) {
    normal.push_back(normal_draw(1, "probe.P2.gain", 0, t));
    uniform.push_back(uniform_draw(1, "probe.P2.gain", 0, t));
  }
  for (const auto* values : {&normal, &uniform}) {
    const double mean = core::mean(*values);
    EXPECT_NEAR(mean, 0.0, 4.0 / std::sqrt(20'000.0));
    EXPECT_NEAR(core::standard_deviation(*values, mean), 1.0, 0.03);
  }
  const auto [least, most] = std::minmax_element(uniform.begin(), uniform.end());
  EXPECT_GE(*least, -std::sqrt(3.0));
  EXPECT_LE(*most, std::sqrt(3.0));
  EXPECT_EQ(normal_draw(1, "probe.P2.gain", 0, 4), normal[4]);
  EXPECT_NE(normal_draw(1, "probe.P2.gain", 1, 4), normal[4]);
  EXPECT_NE(normal_draw(1, "probe.P3.gain", 0, 4), normal[4]);
  EXPECT_NE(normal_draw(2, "probe.P2.gain", 0, 4), normal[4]);
}

TEST(CurveTrials, ChangeForOneUncertaintyIsTheCentralDifference) {
  EXPECT_DOUBLE_EQ(per_u([](double at) { return 3.0 - 2.0 * at + 5.0 * at * at; }), -2.0);
}

// ---- The statement -----------------------------------------------------------------------------

/// A linear value of four core coefficients: weights 1, -2, 0.5, 1.
TrialValues linear_trials(int trials) {
  MeasuredCurve curve;
  curve.found_mm = {10.0 * kMicron, -4.0 * kMicron, 7.0 * kMicron, 9.0 * kMicron};
  curve.u_mm = {0.3 * kMicron, 0.2 * kMicron, 0.4 * kMicron, 0.1 * kMicron};
  curve.group.assign(4, 0);
  const CurveDraws draws(curve, 1, "noise");
  const auto value = [](const std::vector<double>& c) {
    return c[0] - 2.0 * c[1] + 0.5 * c[2] + c[3];
  };
  TrialValues out;
  out.as_measured_mm = value(curve.found_mm);
  out.signed_value = true;
  for (int t = 0; t < trials; ++t) out.values_mm.push_back(value(draws.draw(t)));
  return out;
}

TEST(CurveTrials, ALinearValueHasTheUncertaintyOfLinearPropagation) {
  const auto found = statement_of_trials(linear_trials(8000),
                                         {{"first", 0.3 * kMicron},
                                          {"second", -0.4 * kMicron},
                                          {"third", 0.2 * kMicron},
                                          {"fourth", 0.1 * kMicron}},
                                         {}, {});
  ASSERT_TRUE(found) << found.error().what;
  const double u = std::sqrt(0.09 + 0.16 + 0.04 + 0.01) * kMicron;
  const UncertaintyStatement& s = found->sampled;
  EXPECT_NEAR(s.standard_uncertainty_mm, u, 0.03 * u);
  EXPECT_NEAR(s.estimate_mm, 30.5 * kMicron, 4.0 * u / std::sqrt(8000.0));
  EXPECT_NEAR(s.low_mm, s.estimate_mm - 1.96 * u, 0.1 * u);
  EXPECT_NEAR(s.high_mm, s.estimate_mm + 1.96 * u, 0.1 * u);
  EXPECT_FALSE(s.at_most);
  EXPECT_TRUE(found->notes.empty()) << found->notes.front();
  EXPECT_EQ(found->trials, 8000);
  EXPECT_DOUBLE_EQ(found->uncorrected_mm, 30.5 * kMicron);
  EXPECT_DOUBLE_EQ(found->noise_inflation_mm, found->uncorrected_mm - s.estimate_mm);
  EXPECT_GT(s.numerical_tolerance_mm, 0.0);
  EXPECT_LT(s.numerical_tolerance_mm, 0.1 * u);
  ASSERT_EQ(found->budget.size(), 4U);
  EXPECT_EQ(found->budget[0].name, "second");
  EXPECT_DOUBLE_EQ(found->budget[0].per_u_mm.value_or(0.0), -0.4 * kMicron);
  EXPECT_DOUBLE_EQ(found->budget[0].standard_uncertainty_mm, 0.4 * kMicron);
  EXPECT_NEAR(found->budget[0].share_1, 0.16 / 0.30, 1e-12);
  EXPECT_EQ(found->budget[3].name, "fourth");
}

TEST(CurveTrials, SaysWhereTheValueIsNotLinear) {
  const double u = std::sqrt(0.30) * kMicron;
  for (const auto& [factor, differs] :
       {std::pair(1.0, false), std::pair(1.2, false), std::pair(0.7, true), std::pair(1.6, true)}) {
    SCOPED_TRACE(factor);
    const auto found = statement_of_trials(linear_trials(2000), {{"noise", u * factor}}, {}, {});
    ASSERT_TRUE(found);
    ASSERT_EQ(found->notes.empty(), !differs);
    if (differs) {
      EXPECT_THAT(found->notes.front(), HasSubstr("not linear"));
    }
  }
}

TEST(CurveTrials, AConvexValueIsTurnedAndCutAtZero) {
  TrialValues trials;
  trials.as_measured_mm = 2.0 * kMicron;
  trials.core_center_mm = 1.0 * kMicron;
  for (int t = 0; t < 200; ++t) {
    const double around = (t % 2 == 0 ? 0.1 : -0.1) * kMicron;
    trials.values_mm.push_back((t == 0 ? 0.2 : 2.2) * kMicron + around);
    trials.core_mm.push_back(1.25 * kMicron + around);
  }
  const auto turned = statement_of_trials(trials, {}, {}, {});
  ASSERT_TRUE(turned);
  EXPECT_NEAR(turned->sampled.high_mm, 1.8 * kMicron, 1e-12);  // 2.3 - 2 x 0.25
  EXPECT_EQ(turned->sampled.values_mm.front(), 0.0) << "0.3 - 0.5 is below 0";
  trials.signed_value = true;
  EXPECT_NEAR(statement_of_trials(trials, {}, {}, {})->sampled.values_mm.front(), -0.2 * kMicron,
              1e-12);
  for (double& value : trials.core_mm)
    value -= 0.5 * kMicron;  // below the centre: nothing to take off
  EXPECT_NEAR(statement_of_trials(trials, {}, {}, {})->sampled.high_mm, 2.3 * kMicron, 1e-12);
}

TEST(CurveTrials, LeavesAnUpperBoundWhereMoreThanAQuarterIsNoise) {
  TrialValues trials;
  trials.values_mm.assign(200, 1.0 * kMicron);
  trials.values_mm.front() = 1.1 * kMicron;
  trials.as_measured_mm = 1.33 * kMicron;
  EXPECT_FALSE(statement_of_trials(trials, {}, {}, {})->sampled.at_most);
  trials.as_measured_mm = 1.34 * kMicron;
  const auto found = statement_of_trials(trials, {}, {}, {});
  EXPECT_TRUE(found->sampled.at_most);
  ASSERT_EQ(found->notes.size(), 1U);
  EXPECT_THAT(found->notes.front(), HasSubstr("noise-dominates"));
  EXPECT_THAT(found->notes.front(), HasSubstr("1.340 um as measured"));
  trials.signed_value = true;
  EXPECT_FALSE(statement_of_trials(trials, {}, {}, {})->sampled.at_most);
}

// Influences that would make 100 um where 3 um were read: what is taken off leaves 0 of every
// trial, and 0 is no upper bound.
TEST(CurveTrials, InfluencesThatTakeAllOfTheValueAwayLeaveNoBoundOfZero) {
  TrialValues trials;
  trials.as_measured_mm = 3.0 * kMicron;
  trials.core_center_mm = 3.0 * kMicron;
  for (int t = 0; t < 200; ++t) {
    trials.values_mm.push_back((100.0 + 0.1 * t) * kMicron);
    trials.core_mm.push_back(110.0 * kMicron);
  }
  const auto found = statement_of_trials(trials, {}, {}, {});
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->sampled.at_most);
  EXPECT_GT(found->sampled.high_mm, 119.0 * kMicron);
  EXPECT_LE(found->sampled.high_mm, 119.9 * kMicron);
  KnownValue value;
  value.measured_mm = trials.as_measured_mm;
  value.statement = found->sampled;
  Limits limits;
  limits.upper_mm = 8.0 * kMicron;
  for (const Kind kind : {Kind::kIso14253, Kind::kJcgm106}) {
    DecisionRule rule;
    rule.kind = kind;
    EXPECT_FALSE(apply_rule(rule, value, limits)) << name_of(kind);
  }
}

// ISO 14253-1 of a mask: each amplitude with its own interval at 1 - 0.05/m.
TEST(CurveTrials, LinesOfAMaskHoldTogether) {
  EXPECT_NEAR(options_of_line({}, 5).coverage, 0.99, 1e-12);
  EXPECT_NEAR(options_of_line({}, 1).coverage, 0.95, 1e-12);
  EXPECT_NEAR(options_of_line({}, 1000).coverage, 0.999, 1e-12);
  const auto line = [](double low_mm, double high_mm) {
    UncertaintyStatement out;
    out.low_mm = low_mm;
    out.high_mm = high_mm;
    return out;
  };
  UncertaintyResult greatest;
  greatest.sampled.estimate_mm = 9e-3;
  greatest.sampled.low_mm = 8e-3;
  greatest.sampled.high_mm = 10e-3;
  const UncertaintyResult alone = greatest;
  hold_lines_together({}, greatest);
  EXPECT_EQ(greatest.sampled.high_mm, alone.sampled.high_mm);
  EXPECT_TRUE(greatest.notes.empty());
  // The widest line ends last, though another one is the greatest.
  const std::vector<UncertaintyStatement> lines = {line(8.5e-3, 9.5e-3), line(4e-3, 12e-3)};
  hold_lines_together(lines, greatest);
  EXPECT_EQ(greatest.sampled.low_mm, 8.5e-3);
  EXPECT_EQ(greatest.sampled.high_mm, 12e-3);
  EXPECT_EQ(greatest.notes.size(), 1U);
  DecisionRule rule;
  rule.kind = DecisionRule::Kind::kIso14253;
  const auto verdict = [&](double limit_mm) {
    const auto outcome = apply_rule(rule, {9e-3, greatest.sampled}, {{}, limit_mm});
    return outcome ? outcome->verdict : Verdict::kVoid;
  };
  EXPECT_EQ(verdict(11e-3), Verdict::kUndecided);
  EXPECT_EQ(verdict(12.1e-3), Verdict::kConforms);
  EXPECT_EQ(verdict(8.4e-3), Verdict::kDoesNotConform);
}

TEST(CurveTrials, SaysWhatIsWrongWithTheTrials) {
  TrialValues trials;
  trials.values_mm.assign(99, 1.0 * kMicron);
  EXPECT_EQ(statement_of_trials(trials, {}, {}, {}).error().code, core::Code::kBadOption);
  trials.values_mm.assign(100, 1.0 * kMicron);
  EXPECT_TRUE(statement_of_trials(trials, {}, {}, {}));
  trials.core_mm.assign(99, 1.0 * kMicron);
  EXPECT_EQ(statement_of_trials(trials, {}, {}, {}).error().code, core::Code::kBadOption);
  trials.core_mm.clear();
  trials.values_mm[42] = std::nan("");
  const auto lost = statement_of_trials(trials, {}, {}, {});
  EXPECT_EQ(lost.error().code, core::Code::kNotFinite);
  EXPECT_THAT(lost.error().what, HasSubstr("trial 42"));
  trials.values_mm[42] = 1.0 * kMicron;
  UncertaintyOptions options;
  options.coverage = 0.3;
  EXPECT_EQ(statement_of_trials(trials, {}, {}, options).error().code, core::Code::kBadOption);
}

// ---- Coverage ----------------------------------------------------------------------------------

int measurements() { return test::cases(40, 1000); }

/// Within 2 % of the expected coverage for 1000; for fewer, within 3.3 standard deviations of it.
void expect_covered(int inside, int count, const std::string& name, double expected_1 = 0.95) {
  const double share_1 = static_cast<double>(inside) / count;
  std::printf("%s: %.1f %% of %d\n", name.c_str(), 100.0 * share_1, count);
  const double spread_1 = std::sqrt(expected_1 * (1.0 - expected_1) / count);
  EXPECT_NEAR(share_1, expected_1, test::full() ? 0.02 : 3.3 * spread_1) << name;
}

constexpr int kMostOrder = 31;
constexpr int kSamples = 256;
constexpr int kPlaces = 8 * kMostOrder;

/// Cosine and sine of the orders 2 up at so many equal angles: a column for each.
Eigen::MatrixXd waves(int places) {
  Eigen::MatrixXd out(places, 2 * (kMostOrder - 1));
  for (int i = 0; i < places; ++i) {
    for (int k = 2; k <= kMostOrder; ++k) {
      const double angle = core::kTwoPi * i * k / places;
      out(i, 2 * (k - 2)) = std::cos(angle);
      out(i, 2 * (k - 2) + 1) = std::sin(angle);
    }
  }
  return out;
}

double peak_to_valley(const Eigen::MatrixXd& places, const std::vector<double>& c) {
  const Eigen::VectorXd curve =
      places * Eigen::Map<const Eigen::VectorXd>(c.data(), static_cast<Eigen::Index>(c.size()));
  return curve.maxCoeff() - curve.minCoeff();
}

/// A turned part: the given amplitudes of the orders 2, 3, 5 and 17 with random phases, and
/// roughness that falls with the order.
std::vector<double> lobed_form(core::KeyedNoise noise, double roughness_mm) {
  std::vector<double> out;
  for (int k = 2; k <= kMostOrder; ++k) {
    const double lobe_um = k == 2 ? 1.2 : k == 3 ? 0.8 : k == 5 ? 0.4 : k == 17 ? 0.15 : 0.0;
    const double phase = core::kTwoPi * noise.uniform();
    out.push_back(lobe_um * kMicron * std::cos(phase) + roughness_mm / k * noise.normal());
    out.push_back(lobe_um * kMicron * std::sin(phase) + roughness_mm / k * noise.normal());
  }
  return out;
}

/// The curve that samples with noise of standard deviation `noise_mm` show.
MeasuredCurve measured(const Eigen::MatrixXd& samples, const std::vector<double>& truth,
                       double noise_mm, core::KeyedNoise noise) {
  Eigen::VectorXd readings = samples * Eigen::Map<const Eigen::VectorXd>(
                                           truth.data(), static_cast<Eigen::Index>(truth.size()));
  for (double& reading : readings) reading += noise_mm * noise.normal();
  const Eigen::VectorXd found = samples.transpose() * readings * (2.0 / kSamples);
  MeasuredCurve out;
  for (Eigen::Index i = 0; i < found.size(); ++i) {
    const int order = 2 + static_cast<int>(i) / 2;
    out.found_mm.push_back(found[i]);
    out.u_mm.push_back(noise_mm * std::sqrt(2.0 / kSamples));
    out.group.push_back(order < 8 ? 0 : order < 16 ? 1 : 2);
    out.order.push_back(order);
  }
  return out;
}

struct Found {
  double truth_mm = 0.0;
  UncertaintyResult result;
};

Found inspect(const Eigen::MatrixXd& samples, const Eigen::MatrixXd& places,
              const std::vector<double>& truth, double noise_mm, std::uint64_t number) {
  const MeasuredCurve curve = measured(samples, truth, noise_mm, core::KeyedNoise(20, {2, number}));
  const CurveDraws draws(curve, number, "noise");
  TrialValues trials;
  trials.as_measured_mm = peak_to_valley(places, curve.found_mm);
  trials.core_center_mm = peak_to_valley(places, draws.core_mm());
  for (int t = 0; t < 400; ++t) {
    trials.values_mm.push_back(peak_to_valley(places, draws.draw(t)));
    trials.core_mm.push_back(peak_to_valley(places, draws.core_draw(t)));
  }
  auto result = statement_of_trials(std::move(trials), {}, {}, {});
  return {peak_to_valley(places, truth), *std::move(result)};
}

TEST(CurveCoverage, OfThePeakToValleyOfALobedCurve) {
  const Eigen::MatrixXd samples = waves(kSamples);
  const Eigen::MatrixXd places = waves(kPlaces);
  struct Case {
    double noise_um;
    double roughness_um;
    double coverage_1;
  };
  // Roughness of the size of the noise is the worst that there is: it neither stands out nor
  // vanishes, and the interval is some 3 % short.
  for (const auto& [noise_um, roughness_um, coverage_1] :
       {Case{0.1, 0.05, 0.95}, Case{0.4, 0.05, 0.95}, Case{0.4, 0.4, 0.92}}) {
    int inside = 0;
    double excess_mm = 0.0;
    double bias_mm = 0.0;
    double square_mm2 = 0.0;
    for (int m = 0; m < measurements(); ++m) {
      const auto number = static_cast<std::uint64_t>(m);
      const auto truth = lobed_form(core::KeyedNoise(20, {1, number}), roughness_um * kMicron);
      const Found found = inspect(samples, places, truth, noise_um * kMicron, number);
      const UncertaintyStatement& s = found.result.sampled;
      inside += found.truth_mm >= s.low_mm && found.truth_mm <= s.high_mm ? 1 : 0;
      excess_mm += (found.result.uncorrected_mm - found.truth_mm) / measurements();
      bias_mm += (s.estimate_mm - found.truth_mm) / measurements();
      square_mm2 += std::pow(s.estimate_mm - found.truth_mm, 2) / measurements();
      EXPECT_FALSE(s.at_most);
    }
    const std::string name = fmt::format("noise {} um, roughness {} um", noise_um, roughness_um);
    std::printf("as measured - truth %.4f um, estimate - truth %.4f um; ", excess_mm / kMicron,
                bias_mm / kMicron);
    expect_covered(inside, measurements(), name, coverage_1);
    // The mean of a few is known to 3.3 of its standard deviations only.
    const double chance_mm = test::full() ? 0.0 : 3.3 * std::sqrt(square_mm2 / measurements());
    EXPECT_LT(std::abs(bias_mm), std::max(0.3 * excess_mm, 0.01 * kMicron) + chance_mm) << name;
  }
}

TEST(CurveCoverage, OfTheRootMeanSquareOfARandomField) {
  for (const double noise_um : {0.3, 1.0}) {
    int inside = 0;
    for (int m = 0; m < measurements(); ++m) {
      core::KeyedNoise noise(21, {static_cast<std::uint64_t>(m)});
      MeasuredCurve curve;
      std::vector<double> truth;
      for (int k = 0; k < 60; ++k) {
        truth.push_back(kMicron * noise.normal());
        curve.found_mm.push_back(truth.back() + noise_um * kMicron * noise.normal());
        curve.u_mm.push_back(noise_um * kMicron);
        curve.group.push_back(0);
      }
      curve.field = true;
      const CurveDraws draws(curve, static_cast<std::uint64_t>(m), "field");
      TrialValues trials;
      trials.as_measured_mm = core::root_mean_square(curve.found_mm);
      for (int t = 0; t < 400; ++t) {
        trials.values_mm.push_back(core::root_mean_square(draws.draw(t)));
      }
      const auto found = statement_of_trials(std::move(trials), {}, {}, {});
      ASSERT_TRUE(found);
      const double truth_mm = core::root_mean_square(truth);
      inside += truth_mm >= found->sampled.low_mm && truth_mm <= found->sampled.high_mm ? 1 : 0;
    }
    expect_covered(inside, measurements(), fmt::format("field, noise {} um", noise_um));
  }
}

TEST(CurveTrials, OfAPerfectCircleOnlyAnUpperBoundIsLeft) {
  const Eigen::MatrixXd samples = waves(kSamples);
  const Eigen::MatrixXd places = waves(kPlaces);
  const std::vector<double> circle(2 * (kMostOrder - 1), 0.0);
  const Found found = inspect(samples, places, circle, 0.5 * kMicron, 3);
  EXPECT_TRUE(found.result.sampled.at_most);
  EXPECT_GE(found.result.sampled.low_mm, 0.0);
  EXPECT_GT(found.result.noise_inflation_mm, 0.25 * found.result.uncorrected_mm);
}

// ---- Upper bounds in the decision --------------------------------------------------------------

constexpr std::array kGuardedRules = {Kind::kIso14253, Kind::kJcgm106, Kind::kNToOne,
                                      Kind::kGuardBand};

/// A value that is at most `high_mm`: trials spread evenly from `low_mm`, 100 of them.
KnownValue bound(double low_mm, double high_mm, double measured_mm) {
  UncertaintyStatement s;
  for (int i = 0; i < 101; ++i) s.values_mm.push_back(low_mm + 0.01 * i * (high_mm - low_mm));
  s.low_mm = low_mm;
  s.high_mm = high_mm;
  s.estimate_mm = 0.5 * (low_mm + high_mm);
  s.at_most = true;
  return {measured_mm, s};
}

/// Rules that are as easy as their keys allow.
DecisionRule lenient(Kind kind) {
  DecisionRule rule;
  rule.kind = kind;
  rule.guard_factor = 0.1;
  rule.consumer_risk_1 = 0.4;
  rule.acceptance_guard_1 = -0.5;
  rule.rejection_guard_1 = -0.5;
  rule.ratio = 1.0;
  rule.judge_corrected = true;
  return rule;
}

TEST(UpperBound, ConformsUnderARuleOnlyBelowTheLimit) {
  const KnownValue value = bound(0.0, 3.0 * kMicron, 4.0 * kMicron);
  for (const Kind kind : kGuardedRules) {
    SCOPED_TRACE(std::string(name_of(kind)));
    const auto within =
        apply_rule(lenient(kind), value, {.lower_mm = {}, .upper_mm = 3.0 * kMicron});
    ASSERT_TRUE(within) << within.error().what;
    EXPECT_EQ(within->verdict, Verdict::kConforms);
    EXPECT_THAT(within->sentence, HasSubstr("at most 3.00 um"));
    // Without the bound the rule would accept: a guard factor of 0.1, a risk of 40 %.
    KnownValue estimated = value;
    estimated.statement->at_most = false;
    const Limits lower{.lower_mm = {}, .upper_mm = 2.7 * kMicron};
    const auto otherwise = apply_rule(lenient(kind), estimated, lower);
    if (kind != Kind::kNToOne) {
      ASSERT_TRUE(otherwise);
      EXPECT_EQ(otherwise->verdict, Verdict::kConforms);
    }
    const auto beyond = apply_rule(lenient(kind), value, lower);
    ASSERT_FALSE(beyond);
    if (kind == Kind::kNToOne) continue;  // void as it is: the interval is wider than the limit
    EXPECT_THAT(beyond.error().what, HasSubstr("at most 3.00 um"));
    EXPECT_THAT(beyond.error().what, HasSubstr("lower the noise"));
  }
}

TEST(UpperBound, DoesNotConformOnlyWhereTheWholeIntervalIsBeyondTheLimit) {
  for (const Kind kind : kGuardedRules) {
    SCOPED_TRACE(std::string(name_of(kind)));
    const Limits limit{.lower_mm = {}, .upper_mm = 1.0 * kMicron};
    const auto proven =
        apply_rule(lenient(kind), bound(1.1 * kMicron, 2.0 * kMicron, 3.0 * kMicron), limit);
    ASSERT_TRUE(proven) << proven.error().what;
    EXPECT_EQ(proven->verdict, Verdict::kDoesNotConform);
    EXPECT_THAT(proven->sentence, HasSubstr("begins at 1.100 um"));
    EXPECT_FALSE(
        apply_rule(lenient(kind), bound(0.9 * kMicron, 1.8 * kMicron, 3.0 * kMicron), limit));
  }
}

TEST(UpperBound, ReadAboveTheLimitIsUndecidedUnlessCorrectedValuesAreJudged) {
  DecisionRule rule = lenient(Kind::kIso14253);
  rule.judge_corrected = false;
  const auto outcome = apply_rule(rule, bound(0.0, 3.0 * kMicron, 4.0 * kMicron),
                                  {.lower_mm = {}, .upper_mm = 3.5 * kMicron});
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->verdict, Verdict::kUndecided);
  EXPECT_THAT(outcome->sentence, HasSubstr("at most 3.00 um"));
}

TEST(UpperBound, ARuleThatAsksForMoreStaysStricter) {
  DecisionRule rule;
  rule.kind = Kind::kIso14253;
  rule.guard_factor = 2.0;
  EXPECT_FALSE(apply_rule(rule, bound(0.0, 3.0 * kMicron, 2.0 * kMicron),
                          {.lower_mm = {}, .upper_mm = 3.5 * kMicron}));
}

TEST(UpperBound, ProvesNoLowerLimit) {
  const KnownValue value = bound(1.0 * kMicron, 3.0 * kMicron, 2.0 * kMicron);
  for (const Kind kind : {Kind::kIso14253, Kind::kJcgm106, Kind::kGuardBand}) {
    SCOPED_TRACE(std::string(name_of(kind)));
    EXPECT_FALSE(
        apply_rule(lenient(kind), value, {.lower_mm = 0.5 * kMicron, .upper_mm = 9.0 * kMicron}));
    const auto low =
        apply_rule(lenient(kind), value, {.lower_mm = 3.5 * kMicron, .upper_mm = 9.0 * kMicron});
    ASSERT_TRUE(low);
    EXPECT_EQ(low->verdict, Verdict::kDoesNotConform);
  }
}

TEST(UpperBound, SimpleAcceptanceComparesWhatWasReadWhereTheBoundDoesNotRefuteIt) {
  const KnownValue value = bound(0.0, 3.0 * kMicron, 2.0 * kMicron);
  const auto judged = [&](double limit_um) {
    return apply_rule(DecisionRule(), value, {.lower_mm = {}, .upper_mm = limit_um * kMicron});
  };
  EXPECT_EQ(judged(3.5)->verdict, Verdict::kConforms);
  EXPECT_EQ(judged(2.5)->verdict, Verdict::kUndecided);
  EXPECT_THAT(judged(2.5)->sentence, HasSubstr("it is at most 3.00 um: neither is proven"));
  EXPECT_EQ(judged(1.5)->verdict, Verdict::kDoesNotConform);
}

TEST(UpperBound, IsStatedAsOne) {
  UncertaintyResult result;
  result.uncorrected_mm = 4.352 * kMicron;
  result.sampled = *bound(0.4 * kMicron, 3.2144 * kMicron, 0.0).statement;
  const ValueOperator how(ReferenceTerm(core::phrase("LSCI")), FilterTerm({}), SamplingTerm({}),
                          TipTerm({}), TemperatureTerm({}));
  const StatedValue stated("RONt", result.uncorrected_mm, how,
                           UncertaintyStatus::stated(result, 0.95));
  EXPECT_EQ(stated.value_text().english(), "at most 3.2 um");
  EXPECT_THAT(stated.sentence().english(),
              HasSubstr("RONt is at most 3.2 um (95 %); as read 4.4 um (LSCI; "));
  EXPECT_EQ(stated.quoted_mm(), result.sampled.high_mm);
}

// The number that is compared is the one that is quoted.
TEST(Quoted, IsTheValueAsReadWhereTheRuleJudgesThatAndABoundHasItsSign) {
  UncertaintyResult result;
  result.sampled = *bound(8.0 * kMicron, 9.0 * kMicron, 0.0).statement;
  result.sampled.at_most = false;
  const ValueOperator how(ReferenceTerm(core::phrase("LSCI")), FilterTerm({}), SamplingTerm({}),
                          TipTerm({}), TemperatureTerm({}));
  const auto stated = [&](Quoting quoting) {
    return StatedValue("RONt", 9.2 * kMicron, how, UncertaintyStatus::stated(result, 0.95), {},
                       core::ValueUnit::kUm, quoting);
  };
  const StatedValue read = stated({.as_read = true});
  EXPECT_EQ(read.quoted_mm(), 9.2 * kMicron);
  EXPECT_EQ(read.value_text().english(), "9.20 um, corrected 8.50 [8.00, 9.00]");
  EXPECT_THAT(read.sentence().english(),
              HasSubstr("RONt = 9.20 um as read; corrected 8.50 um, 95 % [8.00, 9.00] (LSCI; "));
  const StatedValue least = stated({.at_least = true});
  EXPECT_EQ(least.quoted_mm(), 8.0 * kMicron);
  EXPECT_EQ(least.value_text().english(), "at least 8.00 um");
  EXPECT_THAT(least.sentence().english(),
              HasSubstr("RONt is at least 8.00 um (95 %); as read 9.20 um (LSCI; "));
  const StatedValue read_least = stated({.as_read = true, .at_least = true});
  EXPECT_EQ(read_least.value_text().english(), "at least 9.20 um");
  EXPECT_THAT(read_least.sentence().english(), Not(HasSubstr("[")));
}

TEST(Capability, AnIntervalWiderThanTheLimitsAreApartLeavesTheValueUndecided) {
  KnownValue value = bound(0.0, 3.0 * kMicron, 1.5 * kMicron);
  value.statement->at_most = false;
  const Limits near{.lower_mm = 0.2 * kMicron, .upper_mm = 2.8 * kMicron};
  for (const Kind kind : {Kind::kIso14253, Kind::kJcgm106, Kind::kGuardBand}) {
    SCOPED_TRACE(std::string(name_of(kind)));
    const auto outcome = apply_rule(lenient(kind), value, near);
    ASSERT_TRUE(outcome);
    EXPECT_EQ(outcome->verdict, Verdict::kUndecided);
    EXPECT_THAT(outcome->sentence, HasSubstr("capability: the interval is 3.000 um wide"));
    const auto wider =
        apply_rule(lenient(kind), value, {.lower_mm = -0.1 * kMicron, .upper_mm = 3.0 * kMicron});
    EXPECT_EQ(wider->verdict, Verdict::kConforms);
    // All of the interval is beyond: that much it does prove.
    const auto beyond =
        apply_rule(lenient(kind), value, {.lower_mm = -2.6 * kMicron, .upper_mm = -0.1 * kMicron});
    EXPECT_EQ(beyond->verdict, Verdict::kDoesNotConform);
  }
  EXPECT_FALSE(apply_rule(lenient(Kind::kNToOne), value, near)) << "void, as ever";
  EXPECT_EQ(apply_rule(DecisionRule(), value, near)->verdict, Verdict::kUndecided);
}

}  // namespace
}  // namespace rondure::evaluation
