// Conditions, bounds, intervals and frames of analyses in every writer.

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "reports/data/qif/internal/parts.h"
#include "reports/data/qif/report.h"
#include "reports/data/writers.h"
#include "reports/history/archive_entry.h"
#include "reports/html/report.h"
#include "reports/terminal/summary.h"
#include "synthetic.h"
#include "tests/reports/page_text.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// 3.1 um as read; the trials give 1.6 um within 0.1 and 3.2 um.
UncertaintyResult interval(bool at_most) {
  UncertaintyResult out;
  out.uncorrected_mm = 0.0031;
  out.sampled.estimate_mm = 0.0016;
  out.sampled.low_mm = 0.0001;
  out.sampled.high_mm = 0.0032;
  out.sampled.standard_uncertainty_mm = 0.0008;
  out.sampled.at_most = at_most;
  out.noise_inflation_mm = 0.0015;
  out.notes = {core::phrase("{} of {} passed", 1, 1)};  // any phrase with a line in the catalogue
  BudgetLine gain;
  gain.name = "gain <P2>";
  gain.standard_uncertainty_mm = 0.0007;
  gain.share_1 = 1.0;
  out.budget = {gain};
  InfluenceStatement drift;
  drift.name = "drift";
  drift.covered = false;
  drift.text = core::Phrase("no drift was declared");
  out.declaration = {drift};
  out.trials = 2000;
  return out;
}

CharacteristicResult judged(record::Form form, const char* symbol, bool at_most) {
  CharacteristicResult out;
  out.characteristic.id = "asked";
  out.characteristic.form = form;
  out.characteristic.tolerance_mm = 0.005;
  const core::Phrase said = core::as_it_is("none");
  out.value.emplace(symbol, 0.0031,
                    ValueOperator(ReferenceTerm(said), FilterTerm(said), SamplingTerm(said),
                                  TipTerm(said), TemperatureTerm(said)),
                    UncertaintyStatus::stated(interval(at_most), 0.95));
  out.verdict = Verdict::kConforms;
  out.reason = core::Phrase("As the limits say.");
  return out;
}

Gate gate(std::string code, Gate::Outcome outcome, const char* reason) {
  Gate out;
  out.code = std::move(code);
  out.condition = core::Phrase("chi2 <of> the first harmonic");
  out.found = 12.4;
  out.limit = 7.5;
  out.outcome = outcome;
  out.reason = core::Phrase(reason);
  return out;
}

/// A spindle with one characteristic and without curves.
Case spindle_case(record::Form form, const char* symbol, bool at_most = false) {
  Case made = cylinder_case(4, 7, 1);
  record::Feature asked;
  asked.id = "journal";
  asked.shape = record::Shape::kSpindle;
  asked.strategy = record::Strategy::kSeries;
  FeatureResult result;
  result.characteristics = {judged(form, symbol, at_most)};
  asked.characteristics = {result.characteristics.front().characteristic};
  result.feature = asked;
  made.record.features = {asked};
  made.evaluation.features = {result};
  return made;
}

Case with_gates() {
  Case made = spindle_case(record::Form::kMotionSynchronous, "EM sync");
  std::vector<Gate>& gates = made.evaluation.features.front().gates;
  gates = {gate("gap", Gate::Outcome::kPassed, ""),
           gate("noise-dominates", Gate::Outcome::kBounds, "noise <b>is</b> most of it"),
           gate("first-harmonic", Gate::Outcome::kVoids, "12.4 exceeds 7.5: check the gains")};
  gates.front().found = 21.25;
  gates.front().limit = std::numeric_limits<double>::infinity();
  gates.front().unit = "deg";
  return made;
}

nlohmann::json analysis_document(const Case& made) {
  return nlohmann::json::parse(write_json(made.record, made.evaluation));
}

std::string analysis_summary(const Case& made) {
  return testing::one_line(write_summary(made.record, made.evaluation));
}

TEST(Gates, JsonHoldsEveryOneWithItsNumbersAndItsOutcome) {
  const auto gates = analysis_document(with_gates())["features"][0]["gates"];
  ASSERT_EQ(gates.size(), 3U);
  EXPECT_EQ(gates[0]["code"], "gap");
  EXPECT_EQ(gates[0]["outcome"], "passed");
  EXPECT_EQ(gates[0]["found"], 21.25);
  EXPECT_TRUE(gates[0]["limit"].is_null());  // not finite: there is none
  EXPECT_EQ(gates[0]["unit"], "deg");
  EXPECT_EQ(gates[0]["reason"], "");
  EXPECT_EQ(gates[1]["outcome"], "bounds");
  EXPECT_EQ(gates[1]["reason"], "noise <b>is</b> most of it");
  EXPECT_EQ(gates[2]["outcome"], "voids");
  EXPECT_EQ(gates[2]["condition"], "chi2 <of> the first harmonic");
  EXPECT_EQ(gates[2]["limit"], 7.5);
}

TEST(Gates, AnAnalysisWithoutAnyHasAnEmptyListAndATouchedFeatureNone) {
  const Case made = spindle_case(record::Form::kMotionSynchronous, "EM sync");
  EXPECT_EQ(analysis_document(made)["features"][0]["gates"].dump(), "[]");
  EXPECT_FALSE(analysis_document(cylinder_case(4, 7, 1))["features"][0].contains("gates"));
}

TEST(Gates, PageHasATableOfAllWithReasonsAsText) {
  const std::string page = page_of(with_gates());
  EXPECT_EQ(testing::first_unbalanced_tag(page), "");
  EXPECT_THAT(page, AllOf(HasSubstr("Conditions of the values"), HasSubstr("21.25 °"),
                          HasSubstr("first-harmonic"), HasSubstr("12.4 exceeds 7.5"),
                          HasSubstr("Chi2 &lt;of&gt; the first harmonic"),
                          HasSubstr("noise &lt;b&gt;is&lt;/b&gt; most of it"),
                          HasSubstr("some values are only bounds"),
                          HasSubstr("some values prove nothing")));
  EXPECT_THAT(page, Not(HasSubstr("<b>is</b>")));
  EXPECT_THAT(page_of(spindle_case(record::Form::kMotionSynchronous, "EM sync")),
              Not(HasSubstr("Conditions of the values")));
}

TEST(Gates, TerminalNamesThoseThatDidNotPass) {
  Case made = with_gates();
  EXPECT_THAT(analysis_summary(made),
              HasSubstr("gates 1 of 3 passed; noise-dominates: noise <b>is</b> most of it; "
                        "first-harmonic: 12.4 exceeds 7.5: check the gains"));
  for (Gate& one : made.evaluation.features.front().gates) one.outcome = Gate::Outcome::kPassed;
  EXPECT_THAT(analysis_summary(made), Not(HasSubstr("gates")));
}

TEST(Gates, DmisAndQifNameThem) {
  const Case made = with_gates();
  EXPECT_THAT(write_dmis(made.record, made.evaluation),
              AllOf(HasSubstr("$$ F1: gate gap, passed: chi2 <of> the first harmonic; found 21.25 "
                              "deg, limit -\n"),
                    HasSubstr("gate first-harmonic, voids: chi2 <of> the first harmonic; found "
                              "12.4, limit 7.5; 12.4 exceeds 7.5: check the gains\n")));
  const std::string qif = write_qif(made.record, made.evaluation);
  EXPECT_TRUE(check_qif(qif).empty());
  EXPECT_THAT(qif, HasSubstr("1 of 3 passed; noise-dominates: "));
}

TEST(AnalysisInterval, StandsInEveryWriter) {
  const Case made = spindle_case(record::Form::kMotionSynchronous, "EM sync");
  const auto asked = analysis_document(made)["features"][0]["characteristics"][0];
  EXPECT_NEAR(asked["quoted_um"], 1.6, 1e-9);
  const auto known = asked["uncertainty"];
  EXPECT_NEAR(known["sampled_points"]["high_um"], 3.2, 1e-9);
  EXPECT_FALSE(known["sampled_points"]["at_most"].get<bool>());
  EXPECT_EQ(known["budget"][0]["name"], "gain <P2>");
  EXPECT_FALSE(known["influences"][0]["covered"].get<bool>());
  EXPECT_TRUE(known["finding"].is_null());  // there is no cloud that could have spots
  EXPECT_THAT(write_results_csv(made.record, made.evaluation), HasSubstr(",1.6,0.1,3.2\n"));
  EXPECT_THAT(write_dmis(made.record, made.evaluation),
              HasSubstr("$$ F1T1: EM sync = 1.6 um, 95 % [0.1, 3.2]; as read 3.1 um"));
  EXPECT_THAT(write_qif(made.record, made.evaluation),
              HasSubstr("combinedUncertainty=\"0.0008\">0.0016<"));
  EXPECT_THAT(analysis_summary(made), HasSubstr("1.6 µm, 95 % within [0.1, 3.2] µm"));
  const std::string page = page_of(made);
  EXPECT_EQ(testing::first_unbalanced_tag(page), "");
  EXPECT_THAT(page, AllOf(HasSubstr("<h2>Uncertainty</h2>"), HasSubstr("1.6 [0.1, 3.2]"),
                          HasSubstr("gain &lt;P2&gt;</bdi> 100 %"), HasSubstr("not covered"),
                          HasSubstr("1 of 1 passed")));
  EXPECT_THAT(page, Not(HasSubstr("spots")));
}

// An angle, held in mrad: 3.1 urad as read, limits of 5 urad to both sides.
Case angle_case(std::optional<double> lower) {
  Case made = spindle_case(record::Form::kMotionSynchronous, "EM sync");
  CharacteristicResult& one = made.evaluation.features.front().characteristics.front();
  one.characteristic.form = record::Form::kAxisError;
  one.characteristic.indication.axis = record::Indication::Axis::kAlpha;
  one.characteristic.indication.error = record::Indication::AxisError::kC;
  one.characteristic.lower_mm = lower;
  const core::Phrase said = core::as_it_is("none");
  one.value.emplace("EC \u03b1", 0.0031,
                    ValueOperator(ReferenceTerm(said), FilterTerm(said), SamplingTerm(said),
                                  TipTerm(said), TemperatureTerm(said)),
                    UncertaintyStatus::stated(interval(false), 0.95), Measurand::kSampledPoints,
                    core::ValueUnit::kUrad);
  return made;
}

TEST(AnalysisInterval, OfAnAngleIsInMicroradiansInEveryWriter) {
  const Case made = angle_case(-0.005);
  const auto asked = analysis_document(made)["features"][0]["characteristics"][0];
  EXPECT_EQ(asked["unit"], "urad");
  EXPECT_NEAR(asked["value_urad"], 3.1, 1e-9);
  EXPECT_NEAR(asked["quoted_urad"], 1.6, 1e-9);
  EXPECT_EQ(asked["lower_limit_urad"], -5.0);
  EXPECT_EQ(asked["upper_limit_urad"], 5.0);
  EXPECT_NEAR(asked["uncertainty"]["sampled_points"]["high_urad"], 3.2, 1e-9);
  EXPECT_NEAR(asked["uncertainty"]["budget"][0]["standard_uncertainty_urad"], 0.7, 1e-9);
  EXPECT_THAT(asked.dump(), Not(HasSubstr("_um\"")));
  const std::string csv = write_results_csv(made.record, made.evaluation);
  EXPECT_THAT(csv, AllOf(HasSubstr(",high_um,value_urad,quoted_urad,low_urad,high_urad,"
                                   "lower_limit_urad,upper_limit_urad\n"),
                         HasSubstr(",,,,3.09"), HasSubstr(",1.6,0.1,3.2,-5,5\n")));
  EXPECT_THAT(write_dmis(made.record, made.evaluation), HasSubstr("= 1.6 urad, 95 % [0.1, 3.2]"));
  const std::string qif = write_qif(made.record, made.evaluation);
  EXPECT_TRUE(check_qif(qif).empty());
  // 5 urad are 0.000286479 degrees, 1.6 urad 0.0000916732 degrees.
  EXPECT_THAT(qif, AllOf(HasSubstr("<UserDefinedAngularCharacteristicMeasurement"),
                         HasSubstr("<MaxValue>0.000286478"), HasSubstr("<MinValue>-0.000286478"),
                         HasSubstr(">0.0000916732"), Not(HasSubstr("UserDefinedLinear"))));
  EXPECT_THAT(analysis_summary(made),
              AllOf(HasSubstr("1.6 urad"), HasSubstr("µrad -5 … 5 "), HasSubstr("[0.1, 3.2] urad"),
                    HasSubstr("noise +1.500 urad")));
  const std::string page = page_of(made);
  EXPECT_EQ(testing::first_unbalanced_tag(page), "");
  EXPECT_THAT(page, AllOf(HasSubstr("<b class=\"value\">1.6</b>"), HasSubstr(">-5 … 5</td>"),
                          HasSubstr("\u2264 5 \u00b5rad"), HasSubstr("\u2265 -5 \u00b5rad")));
  const record::ArchiveResult kept =
      archive_entry(made.record, made.evaluation, "").results.front();
  EXPECT_EQ(kept.unit, "mrad");
  EXPECT_EQ(kept.value, 0.0016);
}

TEST(AnalysisInterval, OfAnAngleWithOneLimitNamesItInMicroradians) {
  const Case made = angle_case(std::nullopt);
  const auto asked = analysis_document(made)["features"][0]["characteristics"][0];
  EXPECT_NEAR(asked["tolerance_urad"], 5.0, 1e-9);
  EXPECT_THAT(write_results_csv(made.record, made.evaluation),
              AllOf(HasSubstr(",,,,3.09"), HasSubstr(",1.6,0.1,3.2,,5\n")));
  EXPECT_THAT(analysis_summary(made), HasSubstr("µrad 5 "));
  EXPECT_THAT(page_of(made), HasSubstr("\u2264 5 \u00b5rad"));
}

TEST(AnalysisInterval, ThePageSaysWhyThereIsNone) {
  Case made = spindle_case(record::Form::kMotionSynchronous, "EM sync");
  CharacteristicResult& first = made.evaluation.features.front().characteristics.front();
  const core::Phrase said = core::as_it_is("none");
  first.value.emplace("EM sync", 0.0031,
                      ValueOperator(ReferenceTerm(said), FilterTerm(said), SamplingTerm(said),
                                    TipTerm(said), TemperatureTerm(said)),
                      UncertaintyStatus::none(core::Phrase("declare gain_1")));
  const CharacteristicResult same = first;  // a reason is written once for all that it concerns
  made.evaluation.features.front().characteristics.push_back(same);
  const std::string page = page_of(made);
  const std::string line =
      "No interval of <bdi>asked</bdi>, <bdi>asked</bdi>: <bdi>declare gain_1</bdi>.";
  EXPECT_THAT(page, HasSubstr(line));
  EXPECT_THAT(page, Not(HasSubstr("Monte Carlo")));
  EXPECT_THAT(analysis_summary(made), HasSubstr("no interval asked, asked: declare gain_1"));
  EXPECT_THAT(write_dmis(made.record, made.evaluation),
              HasSubstr("$$ F1T1: no interval: declare gain_1"));
  EXPECT_THAT(write_qif(made.record, made.evaluation), HasSubstr("none: declare gain_1"));
}

// A line with a rule of its own says so wherever its verdict stands.
TEST(AnalysisInterval, ARuleOfALineStandsInEveryWriter) {
  Case made = spindle_case(record::Form::kMotionSynchronous, "EM sync");
  auto& results = made.evaluation.features.front().characteristics;
  results.push_back(results.front());
  results.back().characteristic.id = "strict";
  record::DecisionRuleTask rule;
  rule.rule = record::DecisionRuleTask::Rule::kIso14253;
  results.back().characteristic.indication.decision_rule = rule;
  const std::string said = "ISO 14253-1: conforms where the whole";
  const std::string dmis = write_dmis(made.record, made.evaluation);
  EXPECT_THAT(dmis, HasSubstr("$$ F1T2: decision rule of this line: " + said));
  EXPECT_THAT(dmis, Not(HasSubstr("$$ F1T1: decision rule of this line")));
  EXPECT_THAT(write_qif(made.record, made.evaluation), HasSubstr("name=\"decision_rule\""));
  EXPECT_THAT(analysis_summary(made), HasSubstr("rule " + said));
  EXPECT_THAT(page_of(made), HasSubstr("Decision rule of this line: " + said));
  const std::string csv = write_results_csv(made.record, made.evaluation);
  EXPECT_THAT(csv, AllOf(HasSubstr(",high_um,decision_rule\n"), HasSubstr(",3.2,iso-14253-1\n")));
  results.pop_back();
  EXPECT_THAT(write_results_csv(made.record, made.evaluation), Not(HasSubstr("decision_rule")));
}

TEST(AnalysisInterval, AnUpperBoundIsNowhereAValue) {
  const Case made = spindle_case(record::Form::kMotionSynchronous, "EM sync", true);
  const auto asked = analysis_document(made)["features"][0]["characteristics"][0];
  EXPECT_TRUE(asked["quoted_um"].is_null());
  EXPECT_TRUE(asked["uncertainty"]["sampled_points"]["at_most"].get<bool>());
  EXPECT_THAT(write_results_csv(made.record, made.evaluation), HasSubstr(",,,3.2\n"));
  const std::string qif = write_qif(made.record, made.evaluation);
  EXPECT_THAT(qif, AllOf(HasSubstr(">0.0032<"), Not(HasSubstr("combinedUncertainty=")),
                         HasSubstr("none: the value is the upper bound, 97.5 % lie below")));
  EXPECT_TRUE(check_qif(qif).empty());
  EXPECT_THAT(analysis_summary(made),
              AllOf(HasSubstr("≤ 3.2 µm"), HasSubstr("at most 3.2 µm at the "),
                    Not(HasSubstr("within ["))));
  const std::string page = page_of(made);
  EXPECT_EQ(testing::first_unbalanced_tag(page), "");
  EXPECT_THAT(page, AllOf(HasSubstr("<b class=\"value\">≤ 3.2</b>"), HasSubstr("Bounds:"),
                          HasSubstr("<td class=\"n\">3.1</td>")));
  EXPECT_FALSE(archive_entry(made.record, made.evaluation, "").results.front().value);
  const Case value = spindle_case(record::Form::kMotionSynchronous, "EM sync");
  EXPECT_TRUE(archive_entry(value.record, value.evaluation, "").results.front().value);
}

// Of a wheel of few points: on the first page as on the second, and in every file.
TEST(AnalysisInterval, ALowerBoundIsNowhereWithinTwoEnds) {
  Case made = spindle_case(record::Form::kRunOut, "Run-out");
  auto& value = made.evaluation.features.front().characteristics.front().value;
  const StatedValue was = *value;
  value.emplace("Run-out", 0.0031, was.value_operator(), was.uncertainty(),
                Measurand::kSampledPoints, core::ValueUnit::kUm, Quoting{.at_least = true});
  const auto asked = analysis_document(made)["features"][0]["characteristics"][0];
  EXPECT_TRUE(asked["quoted_um"].is_null());
  EXPECT_THAT(std::string(asked["stated"]), HasSubstr("Run-out is at least 0.1 um (95 %)"));
  EXPECT_THAT(write_results_csv(made.record, made.evaluation), HasSubstr(",,0.1,\n"));
  EXPECT_THAT(write_qif(made.record, made.evaluation),
              HasSubstr("none: the value is the lower bound, 97.5 % lie above"));
  EXPECT_THAT(analysis_summary(made), AllOf(HasSubstr("≥ 0.1 µm"), Not(HasSubstr("within ["))));
  EXPECT_THAT(page_of(made), AllOf(HasSubstr("<b class=\"value\">≥ 0.1</b>"), HasSubstr("Bounds:"),
                                   HasSubstr("<td class=\"n\">3.1</td>"), Not(HasSubstr("[0.1"))));
}

TEST(AnalysisPage, DrawsNoFrameForWhatIso1101DoesNotKnow) {
  const std::vector<std::pair<record::Form, const char*>> plain = {
      {record::Form::kMotionSynchronous, "EM sync"},
      {record::Form::kContourSpread, "Spread"},
      {record::Form::kRadius, "dR"},
      {record::Form::kFixtureResidual, "Left max"},
      {record::Form::kHarmonicLimits, "A(k)"}};
  for (const auto& [form, symbol] : plain) {
    SCOPED_TRACE(symbol);
    const std::string page = page_of(spindle_case(form, symbol));
    EXPECT_THAT(page, Not(HasSubstr("class=\"frame-box")));
    EXPECT_THAT(page, HasSubstr("<span class=\"plain\">" + std::string(symbol) + " ≤ 5 µm</span>"));
  }
  for (const record::Form form : {record::Form::kRoundness, record::Form::kRunOut}) {
    EXPECT_THAT(page_of(spindle_case(form, "RONt")),
                HasSubstr("class=\"frame-box\"><span><svg class=\"symbol\""));
  }
}

TEST(AnalysisPage, HasATitleOfItsOwnAndSaysTheVerdictFirst) {
  const std::string page = page_of(with_gates());
  EXPECT_THAT(page, AllOf(HasSubstr("Spindle report"), Not(HasSubstr("Cylindricity report")),
                          HasSubstr("form of the part and motion of the axis</h2>")));
  const std::size_t title = page.find("motion of the axis</h2>");
  const std::size_t verdict = page.find("class=\"verdict\"");
  const std::size_t conditions = page.find("Conditions of the values");
  ASSERT_NE(verdict, std::string::npos);
  EXPECT_LT(verdict, title);
  EXPECT_LT(title, conditions);
}

TEST(AnalysisPage, OfAnalysisAndSurfaceIsAnInspection) {
  Case made = spindle_case(record::Form::kMotionSynchronous, "EM sync");
  const Case surface = cylinder_case(4, 7, 1);
  made.record.features.push_back(surface.record.features.front());
  made.evaluation.features.push_back(surface.evaluation.features.front());
  EXPECT_THAT(page_of(made), HasSubstr("Inspection report"));
}

TEST(AnalysisPage, SpeaksChinese) {
  const Case made = with_gates();
  const std::string page = write_html(made.record, made.evaluation, Language::kChinese);
  EXPECT_EQ(testing::first_unbalanced_tag(page), "");
  EXPECT_THAT(page, AllOf(HasSubstr("主轴检测报告"), HasSubstr("各值的条件"),
                          HasSubstr("未通过；部分值不能证明任何结论")));
}

}  // namespace
}  // namespace rondure::reports
