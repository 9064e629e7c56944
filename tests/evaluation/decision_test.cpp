// Decision rules: what each makes of a value, and the risks it says it has.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/noise.h"
#include "evaluation/decision/decision.h"
#include "reports/words/internal/facts.h"
#include "reports/words/language.h"
#include "tests/core/full.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

using ::testing::HasSubstr;
using Kind = evaluation::DecisionRule::Kind;

constexpr double kT = 10e-3;  // tolerance [mm]
const Limits kTolerance{.lower_mm = {}, .upper_mm = kT};

/// Errors of the compared value of one kind of inspection: skew, standard deviation 0.5 um, mean 0.
std::vector<double> error_sample(int count = 4000) {
  core::KeyedNoise noise(7, {1});
  std::vector<double> out;
  for (int i = 0; i < count; ++i) {
    const double skew = -std::log(1.0 - noise.uniform()) - 1.0;  // exponential, mean 0
    out.push_back(0.5e-3 * (0.6 * skew + 0.8 * noise.normal()));
  }
  return out;
}

/// What a measurement says that estimates `estimate_mm` with these errors: the value of the part is
/// the estimate minus an error. The measured value is inflated by 0.3 um.
evaluation::KnownValue known(double estimate_mm, const std::vector<double>& errors) {
  evaluation::UncertaintyStatement s;
  s.estimate_mm = estimate_mm;
  for (const double e : errors) s.values_mm.push_back(estimate_mm - e);
  std::sort(s.values_mm.begin(), s.values_mm.end());
  const auto at = [&](double p) {
    return s.values_mm[static_cast<std::size_t>(p * static_cast<double>(s.values_mm.size() - 1))];
  };
  s.low_mm = at(0.025);
  s.high_mm = at(0.975);
  return {estimate_mm + 0.3e-3, s};
}

evaluation::DecisionRule rule_named(Kind kind) {
  evaluation::DecisionRule rule;
  rule.kind = kind;
  return rule;
}

evaluation::Verdict verdict(const evaluation::DecisionRule& rule,
                            const evaluation::KnownValue& value) {
  const auto outcome = apply_rule(rule, value, kTolerance);
  return outcome ? outcome->verdict : evaluation::Verdict::kVoid;
}

const std::vector<Kind> kAllRules = {Kind::kSimpleAcceptance, Kind::kIso14253, Kind::kJcgm106,
                                     Kind::kNToOne, Kind::kGuardBand};

TEST(DecisionRule, FarFromTheToleranceAllRulesAgree) {
  const auto errors = error_sample();
  for (const Kind kind : kAllRules) {
    SCOPED_TRACE(std::string(name_of(kind)));
    EXPECT_EQ(verdict(rule_named(kind), known(5e-3, errors)), evaluation::Verdict::kConforms);
    EXPECT_EQ(verdict(rule_named(kind), known(15e-3, errors)),
              evaluation::Verdict::kDoesNotConform);
  }
}

TEST(DecisionRule, AGreaterValueIsNeverJudgedBetter) {
  const auto errors = error_sample(400);
  const auto rank = [](evaluation::Verdict v) {
    return v == evaluation::Verdict::kConforms ? 0 : v == evaluation::Verdict::kUndecided ? 1 : 2;
  };
  for (const Kind kind : kAllRules) {
    SCOPED_TRACE(std::string(name_of(kind)));
    evaluation::DecisionRule rule = rule_named(kind);
    if (kind == Kind::kJcgm106)
      rule.prior = evaluation::Prior{evaluation::Prior::Kind::kGamma, 6e-3, 2e-3};
    int last = 0;
    for (double y = 6e-3; y < 13e-3; y += 0.05e-3) {
      const int now = rank(verdict(rule, known(y, errors)));
      EXPECT_GE(now, last) << y;
      last = now;
    }
    EXPECT_EQ(last, 2);
  }
}

TEST(DecisionRule, NoSentenceSaysThatAValueIsAboveItsToleranceByNothing) {
  const evaluation::DecisionRule simple = rule_named(Kind::kSimpleAcceptance);
  const evaluation::KnownValue value{.measured_mm = 4.0000002e-3};
  const auto outcome = apply_rule(simple, value, {.lower_mm = {}, .upper_mm = 4e-3});
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->verdict, evaluation::Verdict::kDoesNotConform);
  EXPECT_THAT(outcome->sentence, HasSubstr("by 2e-07 um"));
}

TEST(DecisionRule, TheVerdictChangesAtTheLimitsThatAreStated) {
  const auto errors = error_sample(400);
  for (const Kind kind : kAllRules) {
    SCOPED_TRACE(std::string(name_of(kind)));
    evaluation::DecisionRule rule = rule_named(kind);
    rule.judge_corrected = true;  // else what was read decides as well
    rule.acceptance_guard_1 = 0.5;
    if (kind == Kind::kJcgm106) {
      rule.prior = evaluation::Prior{evaluation::Prior::Kind::kGamma, 6e-3, 2e-3};
      rule.producer_risk_1 = 0.1;
    }
    const auto at = apply_rule(rule, known(9e-3, errors), kTolerance);
    ASSERT_TRUE(at);
    if (kind == Kind::kJcgm106) {
      const double middle_mm = 0.5 * (*at->acceptance.upper_mm + *at->rejection.upper_mm);
      const auto between = apply_rule(rule, known(middle_mm, errors), kTolerance);
      ASSERT_TRUE(between);
      EXPECT_THAT(between->sentence.english(), HasSubstr("%, between 10 % and 95 %"));
    }
    const bool simple = kind == Kind::kSimpleAcceptance;
    const auto verdict_at = [&](double compared_mm) {
      evaluation::KnownValue value = known(compared_mm - (simple ? 0.3e-3 : 0.0), errors);
      if (simple) value.statement.reset();  // an interval that reaches beyond leaves it undecided
      return verdict(rule, value);
    };
    constexpr double kStep = 1e-6;
    EXPECT_EQ(verdict_at(*at->acceptance.upper_mm - kStep), evaluation::Verdict::kConforms);
    EXPECT_NE(verdict_at(*at->acceptance.upper_mm + kStep), evaluation::Verdict::kConforms);
    EXPECT_NE(verdict_at(*at->rejection.upper_mm - kStep), evaluation::Verdict::kDoesNotConform);
    EXPECT_EQ(verdict_at(*at->rejection.upper_mm + kStep), evaluation::Verdict::kDoesNotConform);
  }
}

// Below, a value and its limit are mirrored at 0.
evaluation::KnownValue mirrored(const evaluation::KnownValue& value) {
  evaluation::KnownValue out = value;
  out.measured_mm = -value.measured_mm;
  out.statement->estimate_mm = -value.statement->estimate_mm;
  out.statement->low_mm = -value.statement->high_mm;
  out.statement->high_mm = -value.statement->low_mm;
  std::reverse(out.statement->values_mm.begin(), out.statement->values_mm.end());
  for (double& one : out.statement->values_mm) one = -one;
  return out;
}

// An envelope of which one limit fails and the other is void does not conform.
TEST(Severity, WhatIsProvenStandsWhateverElseCouldNotBeJudged) {
  const std::vector<Verdict> rising = {Verdict::kNotToleranced, Verdict::kConforms,
                                       Verdict::kUndecided, Verdict::kVoid,
                                       Verdict::kDoesNotConform};
  for (std::size_t i = 1; i < rising.size(); ++i) {
    EXPECT_LT(severity(rising[i - 1]), severity(rising[i])) << name_of(rising[i]);
  }
}

TEST(TwoLimits, ALowerLimitJudgesAsTheMirroredUpperOne) {
  const auto errors = error_sample(400);
  for (const Kind kind : kAllRules) {
    if (kind == Kind::kNToOne) continue;
    SCOPED_TRACE(std::string(name_of(kind)));
    const evaluation::DecisionRule rule = rule_named(kind);
    for (double y = 8e-3; y < 12e-3; y += 0.1e-3) {
      const auto upper = apply_rule(rule, known(y, errors), kTolerance);
      const auto lower =
          apply_rule(rule, mirrored(known(y, errors)), {.lower_mm = -kT, .upper_mm = {}});
      ASSERT_TRUE(upper && lower);
      EXPECT_EQ(upper->verdict, lower->verdict) << y;
      EXPECT_EQ(upper->conformance_1, lower->conformance_1) << y;
      EXPECT_EQ(*upper->acceptance.upper_mm, -*lower->acceptance.lower_mm) << y;
      EXPECT_EQ(*upper->rejection.upper_mm, -*lower->rejection.lower_mm) << y;
    }
  }
  const auto ratio = apply_rule(rule_named(Kind::kNToOne), mirrored(known(5e-3, errors)),
                                {.lower_mm = -kT, .upper_mm = {}});
  ASSERT_FALSE(ratio);
  EXPECT_THAT(ratio.error().what, HasSubstr("one lower limit leaves no tolerance"));
}

TEST(TwoLimits, JudgeAsOneWhereTheOtherIsFar) {
  const auto errors = error_sample(400);
  for (const Kind kind : kAllRules) {
    SCOPED_TRACE(std::string(name_of(kind)));
    const evaluation::DecisionRule rule = rule_named(kind);
    for (double y = 8e-3; y < 12e-3; y += 0.1e-3) {
      const auto one = apply_rule(rule, known(y, errors), kTolerance);
      const auto two = apply_rule(rule, known(y, errors), {.lower_mm = -0.1, .upper_mm = kT});
      ASSERT_TRUE(one && two);
      EXPECT_EQ(one->verdict, two->verdict) << y;
      EXPECT_EQ(one->conformance_1, two->conformance_1) << y;
      EXPECT_NEAR(*one->acceptance.upper_mm, *two->acceptance.upper_mm, 1e-12) << y;
    }
  }
}

TEST(TwoLimits, BothMustHoldAndEitherRefuses) {
  const auto errors = error_sample(400);
  const Limits limits{.lower_mm = 24.990, .upper_mm = 25.000};
  for (const Kind kind : kAllRules) {
    SCOPED_TRACE(std::string(name_of(kind)));
    const auto verdict_at = [&](double y_mm) {
      const auto outcome = apply_rule(rule_named(kind), known(y_mm, errors), limits);
      return outcome ? outcome->verdict : evaluation::Verdict::kVoid;
    };
    EXPECT_EQ(verdict_at(24.995), evaluation::Verdict::kConforms);
    EXPECT_EQ(verdict_at(24.985), evaluation::Verdict::kDoesNotConform);
    EXPECT_EQ(verdict_at(25.005), evaluation::Verdict::kDoesNotConform);
  }
  const evaluation::DecisionRule rule;
  EXPECT_EQ(apply_rule(rule, {24.989, {}}, limits)->sentence.english(),
            "24989.000 um is beyond the lower limit of 24990.000 um by 1.000 um");
  EXPECT_EQ(apply_rule(rule, {24.9995, {}}, limits)->sentence.english(),
            "24999.500 um is within the upper limit of 25000.000 um by 0.500 um");
}

TEST(TwoLimits, TheProbabilityIsThatToLieBetweenThem) {
  evaluation::KnownValue value{50.5e-3, evaluation::UncertaintyStatement{}};
  value.statement->estimate_mm = 50.5e-3;
  for (int i = 1; i <= 100; ++i) value.statement->values_mm.push_back(i * 1e-3);
  value.statement->low_mm = 1e-3;
  value.statement->high_mm = 100e-3;
  const auto outcome =
      apply_rule(rule_named(Kind::kJcgm106), value, {.lower_mm = 20.5e-3, .upper_mm = 70.5e-3});
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->conformance_1, 0.5);
  EXPECT_EQ(outcome->verdict, evaluation::Verdict::kUndecided);
}

TEST(TwoLimits, NearerThanTheIntervalAcceptNothing) {
  const auto errors = error_sample(400);
  for (const Kind kind : {Kind::kIso14253, Kind::kGuardBand, Kind::kJcgm106}) {
    SCOPED_TRACE(std::string(name_of(kind)));
    for (double y = 8e-3; y < 12e-3; y += 0.1e-3) {
      const auto outcome =
          apply_rule(rule_named(kind), known(y, errors), {.lower_mm = 9.5e-3, .upper_mm = 10.5e-3});
      ASSERT_TRUE(outcome);
      EXPECT_NE(outcome->verdict, evaluation::Verdict::kConforms) << y;
    }
  }
}

TEST(TwoLimits, AValueReadBelowTheLowerOneConformsOnlyWhereCorrectedValuesAreAgreedUpon) {
  const auto errors = error_sample(400);
  const Limits limits{.lower_mm = 0.0, .upper_mm = 20e-3};
  for (const Kind kind : kAllRules) {
    if (kind == Kind::kSimpleAcceptance) continue;
    SCOPED_TRACE(std::string(name_of(kind)));
    evaluation::KnownValue value = known(5e-3, errors);
    value.measured_mm = -0.2e-3;
    evaluation::DecisionRule rule = rule_named(kind);
    const auto by_default = apply_rule(rule, value, limits);
    ASSERT_TRUE(by_default);
    EXPECT_EQ(by_default->verdict, evaluation::Verdict::kUndecided);
    EXPECT_THAT(by_default->sentence, HasSubstr("read beyond the lower limit"));
    rule.judge_corrected = true;
    EXPECT_EQ(apply_rule(rule, value, limits)->verdict, evaluation::Verdict::kConforms);
  }
}

// The rule is data: its words are made in the language of the report, not recognised in English.
TEST(DecisionRule, IsInChineseWithItsNumbers) {
  evaluation::DecisionRule rule = rule_named(Kind::kIso14253);
  rule.guard_factor = 0.5;
  rule.prior = evaluation::Prior{evaluation::Prior::Kind::kGamma, 6e-3, 2e-3};
  const LanguageScope chinese(Language::kChinese);
  EXPECT_EQ(in_words(rule),
            "ISO 14253-1 (GB/T 18779.1)：y + f (hi - y) <= T 时合格，y - f (y - lo) > T "
            "时不合格，否则待定；f = 0.5；y：值，lo 至 "
            "hi：其区间，T：极限值；测得值超出极限时不判为合格；先验分布：伽马分布，均值 6 "
            "um，标准差 2 um");
  for (const Kind kind : kAllRules) {
    const std::string words = in_words(rule_named(kind));
    EXPECT_EQ(words.find("conforms"), std::string::npos) << words;
  }
}

// 10.2 um were read, 8 um are left of them after a correction for noise that the supplier declared.
TEST(DecisionRule, AValueReadAboveTheToleranceConformsOnlyWhereCorrectedValuesAreAgreedUpon) {
  const auto errors = error_sample(400);
  for (const Kind kind : kAllRules) {
    if (kind == Kind::kSimpleAcceptance) continue;
    SCOPED_TRACE(std::string(name_of(kind)));
    evaluation::KnownValue value = known(5e-3, errors);
    value.measured_mm = 10.2e-3;
    evaluation::DecisionRule rule = rule_named(kind);
    const auto by_default = apply_rule(rule, value, kTolerance);
    ASSERT_TRUE(by_default);
    EXPECT_EQ(by_default->verdict, evaluation::Verdict::kUndecided);
    EXPECT_THAT(by_default->sentence, HasSubstr("read above the limit"));
    EXPECT_THAT(in_words(rule), HasSubstr("a value read beyond the limit never conforms"));
    rule.judge_corrected = true;
    const auto agreed = apply_rule(rule, value, kTolerance);
    ASSERT_TRUE(agreed);
    EXPECT_EQ(agreed->verdict, evaluation::Verdict::kConforms);
    EXPECT_THAT(agreed->sentence, HasSubstr("corrected values are judged"));
    EXPECT_THAT(in_words(rule), HasSubstr("corrected values are judged"));
  }
}

TEST(DecisionRule, Iso14253TakesTheGuardBandFromTheSideOfTheIntervalThatMatters) {
  evaluation::KnownValue value{9.4e-3, evaluation::UncertaintyStatement{}};
  value.statement->estimate_mm = 9.0e-3;
  value.statement->low_mm = 8.0e-3;
  value.statement->high_mm = 9.5e-3;
  value.statement->values_mm = {8.0e-3, 9.0e-3, 9.5e-3};
  evaluation::DecisionRule rule = rule_named(Kind::kIso14253);
  auto outcome = apply_rule(rule, value, kTolerance);
  ASSERT_TRUE(outcome);
  EXPECT_NEAR(*outcome->acceptance.upper_mm, 9.5e-3, 1e-15);
  EXPECT_NEAR(*outcome->rejection.upper_mm, 11.0e-3, 1e-15);
  EXPECT_EQ(outcome->verdict, evaluation::Verdict::kConforms);
  EXPECT_THAT(outcome->sentence, HasSubstr("9.000 um is within the acceptance limit of 9.500 um"));
  rule.guard_factor = 3.0;
  outcome = apply_rule(rule, value, kTolerance);
  EXPECT_NEAR(*outcome->acceptance.upper_mm, 8.5e-3, 1e-15);
  EXPECT_EQ(outcome->verdict, evaluation::Verdict::kUndecided);
  EXPECT_THAT(outcome->sentence, HasSubstr("neither is proven"));
  EXPECT_FALSE(outcome->specific_risk_1());
}

TEST(DecisionRule, SimpleAcceptanceComparesTheMeasuredValueAndNeedsNoInterval) {
  const evaluation::DecisionRule rule;
  EXPECT_EQ(verdict(rule, {kT, {}}), evaluation::Verdict::kConforms);
  EXPECT_EQ(verdict(rule, {std::nextafter(kT, 1.0), {}}), evaluation::Verdict::kDoesNotConform);
  const auto errors = error_sample();
  EXPECT_EQ(verdict(rule, known(9.9e-3, errors)), evaluation::Verdict::kDoesNotConform)
      << "10.2 um measured";
  EXPECT_FALSE(apply_rule(rule, {kT, {}}, kTolerance)->conformance_1);
}

// Three probes on an arm that is off by 0.1 mm: 10.45 um were read, the part has 12.31 um.
TEST(DecisionRule, SimpleAcceptanceIsUndecidedWhereTheIntervalRefutesWhatWasRead) {
  const auto judged = [](double read_um, double low_um, double high_um, const Limits& limits) {
    evaluation::UncertaintyStatement s;
    s.low_mm = 1e-3 * low_um;
    s.high_mm = 1e-3 * high_um;
    s.estimate_mm = 0.5 * (s.low_mm + s.high_mm);
    s.values_mm = {s.low_mm, s.estimate_mm, s.high_mm};
    return apply_rule(evaluation::DecisionRule(), {1e-3 * read_um, s}, limits);
  };
  const Limits eleven{.lower_mm = {}, .upper_mm = 11e-3};
  const auto beyond = judged(10.45, 12.01, 12.31, eleven);
  ASSERT_TRUE(beyond);
  EXPECT_EQ(beyond->verdict, Verdict::kUndecided);
  EXPECT_EQ(beyond->sentence.english(),
            "read within the limit of 11.000 um: 10.450 um; its interval, 12.010 um to 12.310 um, "
            "lies beyond it: neither is proven");
  EXPECT_FALSE(beyond->conformance_1) << "no risk under a rule that takes none into account";
  const auto reaching = judged(10.45, 10.2, 11.1, eleven);
  EXPECT_EQ(reaching->verdict, Verdict::kUndecided);
  EXPECT_THAT(reaching->sentence, HasSubstr("reaches beyond it"));
  const auto below = judged(-10.45, -11.1, -10.2, {.lower_mm = -11e-3, .upper_mm = {}});
  EXPECT_EQ(below->verdict, Verdict::kUndecided);
  // Noise adds to a form: a reading above its interval is ordinary.
  EXPECT_EQ(judged(10.45, 9.1, 9.9, eleven)->verdict, Verdict::kConforms);
  EXPECT_EQ(judged(11.45, 9.1, 9.9, eleven)->verdict, Verdict::kDoesNotConform);
}

TEST(DecisionRule, WithoutAnIntervalEveryOtherRuleIsVoid) {
  for (const Kind kind : kAllRules) {
    if (kind == Kind::kSimpleAcceptance) continue;
    const auto outcome = apply_rule(rule_named(kind), {5e-3, {}}, kTolerance);
    ASSERT_FALSE(outcome);
    EXPECT_THAT(outcome.error().what, HasSubstr("needs the interval at the sampled points"));
  }
}

TEST(DecisionRule, NToOneIsVoidWhereTheIntervalIsTooWide) {
  const auto errors = error_sample();  // the interval is some 1.95 um wide: 5.1 : 1
  evaluation::DecisionRule rule = rule_named(Kind::kNToOne);
  EXPECT_EQ(verdict(rule, known(9.6e-3, errors)), evaluation::Verdict::kConforms);
  rule.ratio = 10.0;
  const auto outcome = apply_rule(rule, known(9.9e-3, errors), kTolerance);
  ASSERT_FALSE(outcome);
  EXPECT_THAT(outcome.error().what, HasSubstr("the rule 10:1 does not apply"));
}

TEST(DecisionRule, NToOneComparesWithBothLimitsOfASizeOrNotAtAll) {
  evaluation::DecisionRule rule = rule_named(Kind::kNToOne);
  rule.ratio = 4.0;
  evaluation::KnownValue size = known(29.999, error_sample());  // the interval is 1.95 um wide
  size.unit = core::ValueUnit::kMm;
  const Limits upper{.lower_mm = {}, .upper_mm = 30.0};
  const Limits lower{.lower_mm = 29.98, .upper_mm = {}};
  for (const Limits& one : {upper, lower}) {
    const auto alone = apply_rule(rule, size, one);
    ASSERT_FALSE(alone);
    EXPECT_THAT(alone.error().what, HasSubstr("leaves no tolerance to compare with"));
  }
  size.tolerance_mm = 20e-3;
  for (const Limits& one : {upper, lower}) EXPECT_TRUE(apply_rule(rule, size, one));
  size.tolerance_mm = 7e-3;
  for (const Limits& one : {upper, lower}) EXPECT_FALSE(apply_rule(rule, size, one));
}

// An angle is held in mrad: its numbers are those of a length in mm, and its unit is urad.
TEST(DecisionRule, OfAnAngleSpeaksOfMicroradians) {
  const auto errors = error_sample();
  const Limits both{.lower_mm = -10e-3, .upper_mm = 10e-3};
  for (const Kind kind : kAllRules) {
    for (const Limits& limits : {kTolerance, both}) {
      for (const double sign : {1.0, -1.0}) {
        for (const double size_mm : {2e-3, 9.9e-3, 15e-3}) {
          SCOPED_TRACE(fmt::format("{} {}", name_of(kind), sign * size_mm));
          const KnownValue length = known(sign * size_mm, errors);
          KnownValue angle = length;
          angle.unit = core::ValueUnit::kUrad;
          const auto of_length = apply_rule(rule_named(kind), length, limits);
          const auto of_angle = apply_rule(rule_named(kind), angle, limits);
          ASSERT_EQ(of_length.has_value(), of_angle.has_value());
          if (of_length) {
            EXPECT_EQ(of_length->verdict, of_angle->verdict);
          }
          std::string said = of_length ? of_length->sentence.english() : of_length.error().what;
          for (std::size_t at = said.find(" um"); at != std::string::npos; at = said.find(" um")) {
            said.replace(at, 3, " urad");
          }
          EXPECT_EQ(of_angle ? of_angle->sentence.english() : of_angle.error().what, said);
        }
      }
    }
  }
  KnownValue angle{.measured_mm = 7.5e-3};
  angle.unit = core::ValueUnit::kUrad;
  const auto outcome = apply_rule(rule_named(Kind::kSimpleAcceptance), angle, both);
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->sentence.english(),
            "7.500 urad is within the upper limit of 10.000 urad by 2.500 urad");
}

TEST(DecisionRule, APriorThatContradictsTheMeasurementIsVoid) {
  const auto errors = error_sample();
  evaluation::DecisionRule rule = rule_named(Kind::kJcgm106);
  rule.prior = evaluation::Prior{evaluation::Prior::Kind::kNormal, 1e-3, 0.02e-3};
  const auto outcome = apply_rule(rule, known(9e-3, errors), kTolerance);
  ASSERT_FALSE(outcome);
  EXPECT_THAT(outcome.error().what, HasSubstr("prior leaves the measured value no weight"));
}

TEST(Prior, HasTheMeanAndSpreadItStates) {
  for (const evaluation::Prior& prior :
       {evaluation::Prior{evaluation::Prior::Kind::kGamma, 6e-3, 2e-3},
        evaluation::Prior{evaluation::Prior::Kind::kGamma, 6e-3, 6e-3},
        evaluation::Prior{evaluation::Prior::Kind::kNormal, 6e-3, 1e-3}}) {
    double sum = 0.0;
    double first = 0.0;
    double second = 0.0;
    for (double x = 0.5e-6; x < 0.2; x += 1e-6) {
      const double weight = prior.density(x);
      sum += weight;
      first += weight * x;
      second += weight * x * x;
    }
    EXPECT_NEAR(first / sum, prior.mean_mm, 1e-5 * prior.mean_mm);
    EXPECT_NEAR(std::sqrt(second / sum - std::pow(first / sum, 2)), prior.standard_deviation_mm,
                1e-4 * prior.standard_deviation_mm);
    EXPECT_EQ(prior.density(-1e-9), 0.0);
  }
}

/// A form deviation drawn from a prior, by rejection under its density.
double drawn_from(const evaluation::Prior& prior, core::KeyedNoise& noise) {
  const double end = prior.mean_mm + 12.0 * prior.standard_deviation_mm;
  const double mode =
      prior.kind == evaluation::Prior::Kind::kNormal
          ? prior.mean_mm
          : prior.mean_mm - std::pow(prior.standard_deviation_mm, 2) / prior.mean_mm;
  const double top = prior.density(mode);
  while (true) {
    const double y = end * noise.uniform();
    if (noise.uniform() * top < prior.density(y)) return y;
  }
}

/// What happened to a lot.
struct Lot {
  int parts = 0;
  int accepted = 0;
  int rejected = 0;
  int false_accepted = 0;
  int false_rejected = 0;
  double stated_false_accepted = 0.0;  ///< Sums of the specific risks, where the rule states one.
  double stated_false_rejected = 0.0;
};

/// @param measured  What a measurement says whose estimate it is given.
Lot simulate(const evaluation::DecisionRule& rule, const Limits& limits,
             const evaluation::Prior& prior, const std::vector<double>& errors,
             const std::function<KnownValue(double)>& measured, int parts) {
  Lot lot;
  lot.parts = parts;
  for (int i = 0; i < parts; ++i) {
    core::KeyedNoise noise(11, {static_cast<std::uint64_t>(i)});
    const double y = drawn_from(prior, noise);
    const double error =
        errors[static_cast<std::size_t>(noise.uniform() * static_cast<double>(errors.size()))];
    const auto outcome = apply_rule(rule, measured(y + error), limits);
    if (!outcome) continue;  // n:1 that does not apply, prior without weight: counted by the caller
    const bool good = limits.hold(y);
    if (outcome->verdict == evaluation::Verdict::kConforms) {
      ++lot.accepted;
      if (!good) ++lot.false_accepted;
      lot.stated_false_accepted += outcome->specific_risk_1().value_or(0.0);
    } else if (outcome->verdict == evaluation::Verdict::kDoesNotConform) {
      ++lot.rejected;
      if (good) ++lot.false_rejected;
      lot.stated_false_rejected += outcome->specific_risk_1().value_or(0.0);
    }
  }
  return lot;
}

/// That a count fits a stated probability: within 3.3 of its binomial standard deviations, one in a
/// thousand fails by chance. Prints what was compared.
void expect_rate(const char* what, std::string_view rule, int count, double stated, int parts) {
  const double expected = stated * parts;
  const double sd = std::sqrt(std::max(expected * (1.0 - stated), 1.0));
  fmt::print("{:<18} {:<16} {:5d} of {} ({:.4f} %), stated {:.4f} %, bounds {:.4f} .. {:.4f} %\n",
             rule, what, count, parts, 100.0 * count / parts, 100.0 * stated,
             100.0 * std::max(expected - 3.3 * sd, 0.0) / parts,
             100.0 * (expected + 3.3 * sd) / parts);
  EXPECT_NEAR(count, expected, 3.3 * sd) << what;
}

int lot_size() { return test::cases(1'000, 15'000, 50'000); }

/// How far a value as read exceeds the compared one, and what else its rule is told.
struct Reading {
  double inflation_mm = 0.3e-3;
  bool at_most = false;
  bool judge_corrected = false;
};

/// That lots are judged with the global risks that are stated of one part.
void expect_stated_risks(const Limits& limits, double ratio, const Reading& reading = {}) {
  const auto errors = error_sample(200);
  const auto measured = [&](double estimate_mm) {
    KnownValue value = known(estimate_mm, errors);
    value.measured_mm = estimate_mm + reading.inflation_mm;
    value.statement->at_most = reading.at_most;
    return value;
  };
  const evaluation::Prior prior{evaluation::Prior::Kind::kGamma, 8e-3, 2.5e-3};
  for (const Kind kind : kAllRules) {
    evaluation::DecisionRule rule = rule_named(kind);
    rule.prior = prior;
    rule.ratio = ratio;
    rule.judge_corrected = reading.judge_corrected;
    rule.rejection_guard_1 = -1.0;  // of guard-band: stringent acceptance, relaxed rejection
    const auto stated = apply_rule(rule, measured(8e-3), limits);
    ASSERT_TRUE(stated) << stated.error().what;
    const auto global = global_risks(rule, measured(8e-3), *stated, limits);
    ASSERT_EQ(global.has_value(), rule.needs_interval());
    if (!global) continue;
    const Lot lot = simulate(rule, limits, prior, errors, measured, lot_size());
    SCOPED_TRACE(std::string(name_of(kind)));
    expect_rate("false acceptance", name_of(kind), lot.false_accepted, global->false_acceptance_1,
                lot.parts);
    expect_rate("false rejection", name_of(kind), lot.false_rejected, global->false_rejection_1,
                lot.parts);
  }
}

// The figure "false acceptance and rejection rates". Error sample, prior and rules as a plan states
// them; every part has its own true value and its own error.
TEST(DecisionRisks, RatesOnSimulatedLotsMatchTheStatedGlobalRisks) {
  expect_stated_risks(kTolerance, 4.0);
}

TEST(DecisionRisks, RatesBetweenTwoLimitsMatchTheStatedGlobalRisks) {
  expect_stated_risks({.lower_mm = 5e-3, .upper_mm = 11e-3}, 2.0);
}

// Conditions beside the rule leave parts undecided or void, which are then neither accepted nor
// rejected falsely.
TEST(DecisionRisks, RatesMatchWhereTheReadingOrABoundDecides) {
  expect_stated_risks(kTolerance, 4.0, {.inflation_mm = 1.5e-3});
  expect_stated_risks({.lower_mm = 5e-3, .upper_mm = 11e-3}, 2.0, {.inflation_mm = -1.2e-3});
  expect_stated_risks(kTolerance, 4.0, {.judge_corrected = true});
  expect_stated_risks(kTolerance, 4.0, {.at_most = true});
}

TEST(DecisionRisks, RatesMatchWhereTheLimitsAreNearerThanTheInterval) {
  expect_stated_risks({.lower_mm = 7.5e-3, .upper_mm = 8.5e-3}, 0.1);
}

// With the true prior the specific risk of a part is right for the parts of which it is said.
TEST(DecisionRisks, StatedSpecificRisksAreMetOnAverage) {
  const auto errors = error_sample(200);
  for (const evaluation::Prior& prior :
       {evaluation::Prior{evaluation::Prior::Kind::kGamma, 8e-3, 2.5e-3},
        evaluation::Prior{evaluation::Prior::Kind::kNormal, 9.5e-3, 0.8e-3}}) {
    evaluation::DecisionRule rule = rule_named(Kind::kJcgm106);
    rule.prior = prior;
    const auto measured = [&](double estimate_mm) { return known(estimate_mm, errors); };
    const Lot lot = simulate(rule, kTolerance, prior, errors, measured, lot_size());
    EXPECT_GT(lot.accepted, lot.parts / 10);
    EXPECT_GT(lot.rejected, lot.parts / 50);
    expect_rate("of accepted", name_of(prior.kind), lot.false_accepted,
                lot.stated_false_accepted / lot.accepted, lot.accepted);
    expect_rate("of rejected", name_of(prior.kind), lot.false_rejected,
                lot.stated_false_rejected / lot.rejected, lot.rejected);
    EXPECT_LE(lot.stated_false_accepted, rule.consumer_risk_1 * lot.accepted);
    EXPECT_LE(lot.stated_false_rejected, rule.producer_risk_1 * lot.rejected);
  }
}

// Without a prior: parts whose true value is the tolerance or worse by nothing, the worst case.
TEST(DecisionRisks, APartAtTheToleranceIsAcceptedNoMoreOftenThanTheRuleSays) {
  const auto errors = error_sample();
  evaluation::DecisionRule iso = rule_named(Kind::kIso14253);
  evaluation::DecisionRule jcgm = rule_named(Kind::kJcgm106);
  for (const auto& [rule, stated] : {std::pair(iso, 0.025), std::pair(jcgm, 0.05)}) {
    int accepted = 0;
    for (const double error : errors) {
      if (verdict(rule, known(kT + error, errors)) == evaluation::Verdict::kConforms) ++accepted;
    }
    expect_rate("at T accepted", name_of(rule.kind), accepted, stated,
                static_cast<int>(errors.size()));
  }
}

TEST(DecisionRule, IsReadFromTheSettingsOfTheRun) {
  record::RunRecord record;
  EXPECT_EQ(rule_of(record)->kind, Kind::kSimpleAcceptance);
  record.header.decision_rule = "jcgm-106";
  record.settings = {{"decision_rule/consumer_risk_percent", 2.0, ""},
                     {"decision_rule/measurand", std::nullopt, "whole-surface"},
                     {"decision_rule/judge", std::nullopt, "as-read"},
                     {"decision_rule/prior/distribution", std::nullopt, "gamma"},
                     {"decision_rule/prior/mean_um", 6.0, ""},
                     {"decision_rule/prior/standard_deviation_um", 2.0, ""}};
  const auto rule = rule_of(record);
  ASSERT_TRUE(rule);
  EXPECT_EQ(rule->consumer_risk_1, 0.02);
  EXPECT_EQ(rule->measurand, evaluation::Measurand::kWholeSurface);
  EXPECT_EQ(rule->prior->mean_mm, 6e-3);
  EXPECT_THAT(in_words(*rule), HasSubstr("P >= 98 %"));
  EXPECT_THAT(in_words(*rule), HasSubstr("prior: gamma with mean 6 um"));
  for (record::Setting& setting : record.settings) {
    if (setting.number) continue;
    SCOPED_TRACE(setting.name);
    const std::string word = std::exchange(setting.text, "coin");
    ASSERT_FALSE(rule_of(record)) << "an unknown word is no other word";
    EXPECT_EQ(rule_of(record).error().code, core::Code::kMeaning);
    EXPECT_THAT(rule_of(record).error().what, HasSubstr("\"coin\""));
    setting.text = word;
  }
  record.header.decision_rule = "coin";
  ASSERT_FALSE(rule_of(record));
  EXPECT_THAT(rule_of(record).error().what, HasSubstr("does not know the decision rule \"coin\""));
}

}  // namespace
}  // namespace rondure::reports
