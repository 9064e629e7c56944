// Every path to a void verdict, and what stands with a value.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <type_traits>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/encodings.h"
#include "core/units.h"
#include "evaluation/defect.h"
#include "evaluation/evaluate.h"
#include "evaluation/internal/conformance.h"
#include "evaluation/interval/internal/declared.h"
#include "fixture/calibration.h"
#include "record/tasks/settings.h"
#include "record/tasks/surface.h"
#include "reports/escaping.h"
#include "reports/html/report.h"
#include "reports/terminal/summary.h"
#include "reports/verify/stored_results.h"
#include "reports/words/language.h"
#include "tests/evaluation/points_run.h"
#include "tests/reports/page_text.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

using core::printable;

using record::RunRecord;
using ::testing::AllOf;
using ::testing::HasSubstr;

// A value cannot be made without its terms, nor with one in the place of another.
static_assert(!std::is_default_constructible_v<evaluation::StatedValue>);
static_assert(!std::is_default_constructible_v<evaluation::ValueOperator>);
static_assert(!std::is_default_constructible_v<evaluation::UncertaintyStatus>);
static_assert(!std::is_constructible_v<evaluation::StatedValue, std::string, double>);
static_assert(!std::is_constructible_v<evaluation::StatedValue, std::string, double,
                                       evaluation::ValueOperator>);
static_assert(!std::is_constructible_v<evaluation::ValueOperator, evaluation::ReferenceTerm,
                                       evaluation::FilterTerm, evaluation::SamplingTerm,
                                       evaluation::TipTerm>);
static_assert(!std::is_constructible_v<evaluation::ValueOperator, evaluation::FilterTerm,
                                       evaluation::ReferenceTerm, evaluation::SamplingTerm,
                                       evaluation::TipTerm, evaluation::TemperatureTerm>);
static_assert(!std::is_constructible_v<evaluation::ValueOperator, std::string, std::string,
                                       std::string, std::string, std::string>);

/// 13 touches of a reference sphere of radius 12.5 mm with a tip of 2 mm.
void add_qualification(RunRecord& run) {
  run.artefact = {12.5, 2.0, 0.1, 0.005};
  for (int i = 0; i < 13; ++i) {
    const double up = i / 12.0;
    const double turn = 2.4 * i;
    const double across = std::sqrt(1.0 - up * up);
    record::Touch touch;
    touch.id = 1000 + i;
    touch.purpose = record::Touch::Purpose::kQualification;
    touch.tip_mm = {300.0 + 14.5 * across * std::cos(turn), 14.5 * across * std::sin(turn),
                    100.0 + 14.5 * up};
    run.touches.push_back(touch);
  }
}

/// 4 x 7 points of a part of some 10 um, touched at 20 degC, judged by `rule` against 20 um.
RunRecord touched_run(const std::string& rule) {
  RunRecord run = points_run(rough_part(3, 4, 7, 2.0 * std::numbers::pi), 4);
  run.features[0].strategy = record::Strategy::kGuided;
  run.features[0].characteristics = {
      {"CYLt", record::Form::kCylindricity, record::Reference::kMinimumZone, 20e-3, ""}};
  run.header.temperature_min_degC = 18.0;
  run.header.temperature_max_degC = 22.0;
  run.header.decision_rule = rule;
  run.settings = {{"uncertainty/coverage_percent", 95.0, ""},
                  {"uncertainty/least_trials", 2000.0, ""},
                  {"uncertainty/most_trials", 2000.0, ""},
                  {"uncertainty/budget_trials", 100.0, ""},
                  {"uncertainty/seed", 1.0, ""},
                  {"uncertainty/probe/repeatability_um", 0.5, ""},
                  {"uncertainty/declared", std::nullopt, "probe"}};
  for (record::Touch& touch : run.touches) touch.temperature_degC = 20.0;
  add_qualification(run);
  return run;
}

/// Nobody measured a temperature.
void forget_temperatures(RunRecord& run) {
  for (record::Touch& touch : run.touches) touch.temperature_degC.reset();
}

evaluation::CharacteristicResult result_of(const RunRecord& run) {
  const auto evaluation = evaluate(run);
  EXPECT_TRUE(evaluation) << evaluation.error().what;
  EXPECT_EQ(evaluation->verdict, evaluation->features[0].characteristics[0].verdict);
  return evaluation->features[0].characteristics[0];
}

TEST(Verdict, OfASoundRunFollowsTheRuleAndTheValueCarriesItsInterval) {
  for (const char* rule :
       {"simple-acceptance", "iso-14253-1", "jcgm-106", "n-to-1", "guard-band"}) {
    SCOPED_TRACE(rule);
    const evaluation::CharacteristicResult result = result_of(touched_run(rule));
    EXPECT_EQ(result.verdict, evaluation::Verdict::kConforms) << result.reason;
    ASSERT_TRUE(result.value);
    const evaluation::UncertaintyStatement* known = result.value->statement();
    ASSERT_NE(known, nullptr);
    EXPECT_LT(known->low_mm, known->estimate_mm);
    EXPECT_LT(known->estimate_mm, known->high_mm);
    EXPECT_LT(known->estimate_mm, result.value->value_mm()) << "noise inflates";
    EXPECT_NEAR(result.value->uncertainty().result()->uncorrected_mm, result.value->value_mm(),
                1e-6);
    ASSERT_TRUE(result.outcome);
    const bool simple = std::string_view(rule) == "simple-acceptance";
    EXPECT_EQ(result.outcome->conformance_1, simple ? std::nullopt : std::optional(1.0));
    EXPECT_EQ(result.value->quoted_mm(), simple ? result.value->value_mm() : known->estimate_mm);
    EXPECT_EQ(result.outcome->compared_mm, result.value->quoted_mm());
    EXPECT_THAT(result.value->sentence(), HasSubstr("(MZCY; unfiltered; 4 x 7 points; r_tip 2.0000 "
                                                    "mm; 20.0 degC; at the sampled points)"));
  }
}

/// The touches of the sphere with three lobes; the probing form is then some 2.7 um.
void add_lobes(RunRecord& run) {
  const Eigen::Vector3d center(300.0, 0.0, 100.0);
  for (record::Touch& touch : run.touches) {
    if (touch.purpose != record::Touch::Purpose::kQualification) continue;
    const Eigen::Vector3d out = touch.tip_mm - center;
    touch.tip_mm += 1.4e-3 * std::cos(3.0 * std::atan2(out.y(), out.x())) * out.normalized();
  }
}

// A repeatability of 0.05 um is declared, and the probe has shown 2.7 um of lobes on the sphere.
TEST(Verdict, OfAnIntervalThatLeavesOutTheProbingFormIsUndecided) {
  for (const double limit_mm : {20e-3, 3e-3}) {
    RunRecord run = touched_run("iso-14253-1");
    run.settings[5].number = 0.05;
    run.features[0].characteristics[0].tolerance_mm = limit_mm;
    const Verdict decided = limit_mm > 10e-3 ? Verdict::kConforms : Verdict::kDoesNotConform;
    EXPECT_EQ(result_of(run).verdict, decided) << "no lobes, no doubt";
    add_lobes(run);
    const auto evaluation = evaluate(run);
    ASSERT_TRUE(evaluation && evaluation->probe);
    const CharacteristicResult& result = evaluation->features[0].characteristics[0];
    EXPECT_EQ(result.verdict, Verdict::kUndecided);
    EXPECT_FALSE(result.outcome);
    const double seen_um = 1e3 * evaluation->probe->form_mm;
    EXPECT_GT(seen_um, 2.0);
    const std::string seen = fmt::format("shows a probing form of {:.3f} um", seen_um);
    const std::string block =
        fmt::format(R"("uncertainty": {{"probe": {{"form_limit_um": {:g}}}}})",
                    std::ceil(100.0 * seen_um) / 100.0);
    EXPECT_THAT(result.reason, AllOf(HasSubstr(seen), HasSubstr(block)));
    const std::string summary = testing::one_line(write_summary(run, *evaluation));
    EXPECT_THAT(summary,
                AllOf(HasSubstr(block), HasSubstr("Not in U: probe-lobing, probing-form-limit")));
    EXPECT_THAT(write_html(run, *evaluation),
                AllOf(HasSubstr(fmt::format("shows a probing form of {:.3f} µm", seen_um)),
                      HasSubstr(fmt::format("form_limit_um&quot;: {:g}",
                                            std::ceil(100.0 * seen_um) / 100.0)),
                      HasSubstr("Not in U: <bdi>probe-lobing</bdi>, <bdi>probing-form-limit")));
    // Pasted in place of the repeatability, the block is what was asked for.
    run.settings[5] = {"uncertainty/probe/form_limit_um", std::ceil(100.0 * seen_um) / 100.0, ""};
    EXPECT_EQ(result_of(run).verdict, decided);
    // Lobes of 0.1 um are no declaration of these, lobes of 1.4 um are.
    run.settings[5] = {"uncertainty/probe/repeatability_um", 0.05, ""};
    for (const double lobes_um : {0.1, 1.4}) {
      RunRecord said = run;
      said.settings.push_back({"uncertainty/probe/lobes/order", 3, ""});
      said.settings.push_back({"uncertainty/probe/lobes/amplitude_um", lobes_um, ""});
      const bool enough = lobes_um > 1.0;
      const CharacteristicResult with_lobes = result_of(said);
      EXPECT_EQ(with_lobes.reason.english().find("shows a probing form") == std::string::npos,
                enough)
          << with_lobes.reason.english();
      EXPECT_EQ(with_lobes.verdict, enough ? decided : Verdict::kUndecided);
    }
    run.features[0].strategy = record::Strategy::kPointsFile;  // another probe touched those
    EXPECT_EQ(result_of(run).verdict, decided);
    run.features[0].strategy = record::Strategy::kGuided;
    run.header.decision_rule = "simple-acceptance";
    EXPECT_EQ(result_of(run).verdict, decided);
  }
}

// One missed touch on the last feature.
TEST(Verdict, OfARunThatDidNotFinishStandsForTheFeaturesThatAreComplete) {
  RunRecord run = touched_run("iso-14253-1");
  run.features.push_back(run.features[0]);
  run.features[1].id = "last";
  run.poses.push_back({1, 1, {}, {}, false, 0.0});
  run.ending = "failed";
  auto evaluation = evaluate(run);
  ASSERT_TRUE(evaluation);
  EXPECT_EQ(evaluation->features[0].characteristics[0].verdict, Verdict::kConforms);
  EXPECT_EQ(evaluation->features[1].characteristics[0].verdict, Verdict::kVoid);
  EXPECT_EQ(evaluation->verdict, Verdict::kVoid);
  EXPECT_THAT(write_summary(run, *evaluation),
              ::testing::StartsWith("INCOMPLETE: 1 of 2 judged\n"));
  EXPECT_THAT(write_html(run, *evaluation), HasSubstr(">INCOMPLETE: 1 of 2 judged<"));
  run.features[0].characteristics[0].tolerance_mm = 3e-3;
  evaluation = evaluate(run);
  EXPECT_EQ(evaluation->verdict, Verdict::kDoesNotConform);
  EXPECT_THAT(write_summary(run, *evaluation),
              ::testing::StartsWith("INCOMPLETE: 1 of 2 judged, does not conform\n"));
  // A stop before anything could be judged is no defect of what was measured.
  RunRecord stopped = touched_run("iso-14253-1");
  stopped.ending = "stopped";
  stopped.poses.pop_back();
  evaluation = evaluate(stopped);
  EXPECT_EQ(evaluation->verdict, Verdict::kVoid);
  EXPECT_THAT(write_summary(stopped, *evaluation),
              ::testing::StartsWith("INCOMPLETE: 0 of 1 judged\n"));
  EXPECT_THAT(write_html(stopped, *evaluation), HasSubstr(">INCOMPLETE: 0 of 1 judged<"));
  stopped.features[0].characteristics[0].tolerance_mm.reset();
  EXPECT_THAT(write_summary(stopped, *evaluate(stopped)), ::testing::StartsWith("INCOMPLETE\n"));
  // The repeats of its final cloud were not complete.
  run.poses.pop_back();
  EXPECT_EQ(evaluate(run)->features[0].characteristics[0].reason.english(),
            "the run did not finish");
}

// What the points do not see can only add: a partial arc conforms to nothing.
TEST(Verdict, OfAPartialArcIsVoidUnlessItFailsAlready) {
  for (const auto form : {record::Form::kCylindricity, record::Form::kRoundness}) {
    for (const double arc_deg : {60.0, 180.0, 260.0, 360.0}) {
      SCOPED_TRACE(arc_deg);
      RunRecord run = points_run(rough_part(3, 4, 40, arc_deg * core::kDegree), 4);
      run.header.decision_rule = "simple-acceptance";
      auto& asked = run.features[0].characteristics;
      asked = {{"form", form, record::Reference::kMinimumZone, 20e-3, ""}};
      const evaluation::CharacteristicResult result = result_of(run);
      EXPECT_EQ(result.verdict,
                arc_deg == 360.0 ? evaluation::Verdict::kConforms : evaluation::Verdict::kVoid);
      if (arc_deg == 360.0) continue;
      EXPECT_THAT(result.reason, HasSubstr("deg of the turn unseen"));
      asked[0].tolerance_mm = 1e-4;
      EXPECT_EQ(result_of(run).verdict, evaluation::Verdict::kDoesNotConform);
      asked[0].reference = record::Reference::kLeastSquares;
      EXPECT_EQ(result_of(run).verdict, evaluation::Verdict::kVoid)
          << "least squares proves no bound";
    }
  }
}

TEST(Verdict, OfTwoLimitsStatesTheValueNearestToIts) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 24; ++i) {
    const double t = 45.0 * (i % 8) * core::kDegree;
    const double r = i % 4 == 1 ? 24.9955 : 25.0;
    points.emplace_back(r * std::cos(t), r * std::sin(t), 10.0 * (i / 8));
  }
  RunRecord run = points_run(points, 3);
  run.header.decision_rule = "simple-acceptance";
  record::Characteristic size{"d", record::Form::kDiameter, {}, 47.1, ""};
  size.lower_mm = 46.99;
  run.features[0].characteristics = {size};
  const evaluation::CharacteristicResult least = result_of(run);
  EXPECT_EQ(least.verdict, evaluation::Verdict::kConforms) << least.reason;
  ASSERT_TRUE(least.value);
  EXPECT_NEAR(least.value->value_mm(), 46.991, 1e-4);
  run.features[0].characteristics[0].tolerance_mm = 47.001;
  EXPECT_NEAR(result_of(run).value->value_mm(), 47.0, 1e-4);
  run.features[0].characteristics[0].lower_mm = 46.9925;
  EXPECT_EQ(result_of(run).verdict, evaluation::Verdict::kDoesNotConform);
}

TEST(Verdict, OfAFileWithAThickLayerOrAnImpossibleTipIsVoid) {
  RunRecord run = points_run(rough_part(3, 4, 40, 2.0 * std::numbers::pi), 4);
  run.header.decision_rule = "simple-acceptance";
  for (const auto form : {record::Form::kCylindricity, record::Form::kRoundness}) {
    run.features[0].characteristics = {{"form", form, record::Reference::kMinimumZone, 20e-3, ""}};
    EXPECT_EQ(result_of(run).verdict, evaluation::Verdict::kConforms);
    RunRecord thick = run;
    for (std::size_t i = 0; i < 40; i += 2) {
      thick.touches[i].layer = 1;
      thick.touches[i].point += 40;
    }
    EXPECT_EQ(result_of(thick).verdict, evaluation::Verdict::kVoid);
    EXPECT_THAT(result_of(thick).reason, HasSubstr("mm thick"));
    RunRecord wrong = run;
    wrong.features[0].tip_radius_mm = 60.0;
    EXPECT_EQ(result_of(wrong).verdict, evaluation::Verdict::kVoid);
    EXPECT_THAT(result_of(wrong).reason, HasSubstr("correct the tip diameter"));
  }
}

TEST(Verdict, PrintsADeclaredTemperatureAsDeclared) {
  RunRecord run = touched_run("iso-14253-1");
  forget_temperatures(run);
  run.settings.push_back({"environment/assumed_degC", 20.5, ""});
  const evaluation::CharacteristicResult touched = result_of(run);
  EXPECT_EQ(touched.verdict, evaluation::Verdict::kConforms) << touched.reason;
  EXPECT_THAT(touched.value->sentence(), HasSubstr("20.5 degC declared, not measured"));
  run.settings.push_back({"environment/declared", std::nullopt, "limits"});
  run.features[0].strategy = record::Strategy::kPointsFile;
  const evaluation::CharacteristicResult read = result_of(run);
  EXPECT_EQ(read.verdict, evaluation::Verdict::kConforms) << read.reason;
  EXPECT_THAT(read.value->sentence(), HasSubstr("20.5 degC declared, not measured"));
}

TEST(Verdict, EveryReferenceHasItsInterval) {
  for (const auto form : {record::Form::kCylindricity, record::Form::kRoundness}) {
    for (const auto reference :
         {record::Reference::kLeastSquares, record::Reference::kMinimumCircumscribed,
          record::Reference::kMaximumInscribed}) {
      SCOPED_TRACE(static_cast<int>(reference));
      RunRecord run = touched_run("iso-14253-1");
      run.features[0].characteristics[0].form = form;
      run.features[0].characteristics[0].reference = reference;
      const evaluation::CharacteristicResult result = result_of(run);
      EXPECT_EQ(result.verdict, evaluation::Verdict::kConforms) << result.reason;
      ASSERT_TRUE(result.value && result.value->statement());
      EXPECT_NEAR(result.value->uncertainty().result()->uncorrected_mm, result.value->value_mm(),
                  1e-6);
    }
  }
}

/// Errors that are zero, at stations that hold for +-90 deg.
std::shared_ptr<const fixture::StationMotion> stations() {
  std::vector<fixture::AxisStation> out;
  for (const double angle : {-1.6, -0.6, 0.6, 1.6})
    out.push_back({angle, {}, fixture::ErrorCovariance::Zero()});
  return *fixture::StationMotion::through(std::move(out));
}

/// The run uses a calibration that holds: its fixture, its time, its travel.
void add_calibration(RunRecord& run, const std::function<void(fixture::Calibration&)>& change) {
  run.header.started_utc = "2026-11-21T10:00:00Z";
  fixture::Calibration calibration;
  calibration.id = "calibration-1";
  calibration.fixture_id = "F-01";
  calibration.measured_utc = "2026-11-01T08:00:00Z";
  calibration.expires_utc = "2027-11-01T08:00:00Z";
  calibration.temperature_degC = 20.5;
  calibration.alpha = stations();
  calibration.beta = stations();
  calibration.verification = {6, 30, 0.6e-3, 1.4e-3, 9e-6, 0.5e-3, 42e-3, 90e-3};
  change(calibration);
  run.settings.push_back({"fixture/id", std::nullopt, "F-01"});
  run.settings.push_back({"fixture/max_residual_um", 5.0, ""});
  run.settings.push_back(
      {"fixture/calibration", std::nullopt, fixture::calibration_text(calibration)});
}

/// Every report names the verdict and gives the whole reason.
void expect_told(const RunRecord& run, const evaluation::Evaluation& evaluation) {
  const evaluation::CharacteristicResult& result = evaluation.features.at(0).characteristics.at(0);
  EXPECT_EQ(result.verdict, evaluation::Verdict::kVoid);
  EXPECT_FALSE(result.outcome);
  EXPECT_NE(result.reason, "");
  const std::string summary = write_summary(run, evaluation);
  EXPECT_THAT(summary, HasSubstr("\nVoid\n"));
  EXPECT_THAT(testing::one_line(summary),
              HasSubstr("because " + printable(with_signs(result.reason.english()))));
  const std::string page = write_html(run, evaluation);
  EXPECT_THAT(page, HasSubstr("is-void"));
  EXPECT_THAT(page, HasSubstr(in_sentence(core::Phrase(capitalised(result.reason.english())))));
}

struct VoidPath {
  const char* name;
  std::function<void(RunRecord&)> spoil;
  const char* reason;
};

void set_tips(RunRecord& run, double scale_mm) {
  for (record::Touch& touch : run.touches) {
    if (touch.purpose != record::Touch::Purpose::kQualification) continue;
    const Eigen::Vector3d center(300.0, 0.0, 100.0);
    touch.tip_mm = center + (touch.tip_mm - center).normalized() * (14.5 + scale_mm);
  }
}

std::vector<VoidPath> void_paths() {
  const auto setting = [](const char* name, double number) {
    return [=](RunRecord& run) { run.settings.push_back({name, number, ""}); };
  };
  return {
      {"not finished", [](RunRecord& r) { r.ending = "stopped"; }, "the run did not finish"},
      {"no qualification",
       [](RunRecord& r) {
         std::erase_if(r.touches, [](const record::Touch& t) { return t.pose < 0; });
       },
       "the probe was not qualified"},
      {"tip radius", [](RunRecord& r) { set_tips(r, 0.2); }, "the effective tip radius 2.2"},
      {"probing form",
       [](RunRecord& r) {
         for (record::Touch& t : r.touches) {
           if (t.id == 1005) t.tip_mm += Eigen::Vector3d(0.0, 0.0, 0.02);
         }
       },
       "the probing form"},
      {"too warm",
       [](RunRecord& r) {
         for (record::Touch& t : r.touches) t.temperature_degC = 22.5;
       },
       "temperature 22.50 degC is outside 18..22 degC"},
      {"temperature not measured", forget_temperatures,
       "the temperature was not measured, the limits are 18..22 degC: use a sensor that the "
       "machine reports, or declare environment.assumed_degC in the plan"},
      {"one temperature not measured", [](RunRecord& r) { r.touches[3].temperature_degC.reset(); },
       "the temperature was not measured"},
      {"temperature of a circle not measured",
       [](RunRecord& r) {
         forget_temperatures(r);
         r.features[0].shape = record::Shape::kCircle;
         r.features[0].characteristics[0].form = record::Form::kRoundness;
       },
       "the temperature was not measured"},
      {"declared temperature outside",
       [](RunRecord& r) {
         forget_temperatures(r);
         r.settings.push_back({"environment/assumed_degC", 22.5, ""});
       },
       "temperature 22.50 degC is outside 18..22 degC"},
      {"scales not measured",
       [](RunRecord& r) {
         r.features[0].settings.push_back({"scale_expansion_per_K", 8e-6, ""});
       },
       "the temperature of the scales was not measured"},
      {"points of a file under limits",
       [](RunRecord& r) {
         r.features[0].strategy = record::Strategy::kPointsFile;
         r.settings.push_back({"environment/declared", std::nullopt, "limits"});
       },
       "the temperature was not measured"},
      {"unknown rule", [](RunRecord& r) { r.header.decision_rule = "coin"; },
       "does not know the decision rule"},
      {"no final cloud",
       [](RunRecord& r) {
         r.poses[0].final_cloud = false;
         r.ending = "stopped";
       },
       "the run ended before the final cloud was measured"},
      {"no fit",
       [](RunRecord& r) {
         for (record::Touch& t : r.touches) {
           if (t.pose >= 0) t.tip_mm.z() = 0.0;
         }
       },
       "tilt"},
      {"no sections",
       [](RunRecord& r) {
         r.features[0].layers = 0;
         r.features[0].characteristics[0].form = record::Form::kRoundness;
       },
       "this feature has no sections"},
      {"three points a section",
       [](RunRecord& r) {
         std::erase_if(r.touches,
                       [](const record::Touch& t) { return t.pose >= 0 && t.point % 2 == 1; });
         std::erase_if(r.touches, [](const record::Touch& t) { return t.point == 6; });
         r.features[0].characteristics[0].form = record::Form::kRoundness;
       },
       "a section of three different points has no roundness"},
      {"no harmonics",
       [](RunRecord& r) {
         r.features[0].characteristics[0].form = record::Form::kHarmonicLimits;
         r.features[0].characteristics[0].harmonic_limits = {{2, 5, 1e-3}};
       },
       "the mask reaches to harmonic 5"},
      {"no cylinder reference",
       [](RunRecord& r) {
         r.features[0].characteristics[0].reference = record::Reference::kMaximumInscribed;
         for (record::Touch& t : r.touches) {
           if (t.pose >= 0) t.tip_mm = rough_part(3, 4, 7, 2.0)[static_cast<std::size_t>(t.id)];
         }
       },
       "there is no"},
      {"calibration expired",
       [](RunRecord& r) {
         add_calibration(r, [](auto& c) { c.expires_utc = "2026-11-20T00:00:00Z"; });
       },
       "expired on"},
      {"calibration of another fixture",
       [](RunRecord& r) { add_calibration(r, [](auto& c) { c.fixture_id = "F-07"; }); },
       "that of the fixture \"F-07\""},
      {"calibration with too much left",
       [](RunRecord& r) { add_calibration(r, [](auto& c) { c.verification.max_mm = 6e-3; }); },
       "the plan allows 5 um"},
      {"calibration made too warm",
       [](RunRecord& r) { add_calibration(r, [](auto& c) { c.temperature_degC = 35.0; }); },
       "made at 35.00 degC, the plan allows 18..22 degC"},
      {"calibration without a temperature",
       [](RunRecord& r) { add_calibration(r, [](auto& c) { c.temperature_degC.reset(); }); },
       "the temperature of the calibration was not measured"},
      {"calibration that cannot be read",
       [](RunRecord& r) {
         r.settings.push_back({"fixture/calibration", std::nullopt, "{"});
       },
       "the text is no JSON"},
      {"no interval", [](RunRecord& r) { r.settings.clear(); },
       "needs the interval at the sampled points, which was not computed: the plan declares no "
       "uncertainty"},
      {"interval of the whole surface",
       [](RunRecord& r) {
         r.settings.push_back({"decision_rule/measurand", std::nullopt, "whole-surface"});
       },
       "needs the interval of the whole surface"},
      {"interval refused", setting("uncertainty/probe/form_limit_um", -1.0),
       "which was not computed: "},
      {"no reference",
       [](RunRecord& r) {
         r.header.decision_rule = "simple-acceptance";
         r.features[0].characteristics[0].form = record::Form::kRoundness;
         r.features[0].characteristics[0].reference = record::Reference::kMaximumInscribed;
         for (record::Touch& t : r.touches) {
           if (t.pose >= 0) t.tip_mm = rough_part(3, 4, 7, 2.0)[static_cast<std::size_t>(t.id)];
         }
       },
       "layer 1: "},
      {"n:1 does not apply",
       [](RunRecord& r) {
         r.header.decision_rule = "n-to-1";
         r.settings.push_back({"decision_rule/ratio", 90.0, ""});
       },
       "the rule 90:1 does not apply"},
      {"prior of other parts",
       [](RunRecord& r) {
         r.header.decision_rule = "jcgm-106";
         r.settings.push_back({"decision_rule/prior/distribution", std::nullopt, "normal"});
         r.settings.push_back({"decision_rule/prior/mean_um", 1.0, ""});
         r.settings.push_back({"decision_rule/prior/standard_deviation_um", 0.01, ""});
       },
       "the stated prior leaves the measured value no weight"},
  };
}

TEST(Verdict, IsVoidWithItsReasonOnEveryPath) {
  for (const VoidPath& path : void_paths()) {
    SCOPED_TRACE(path.name);
    RunRecord run = touched_run("iso-14253-1");
    path.spoil(run);
    const auto evaluation = evaluate(run);
    ASSERT_TRUE(evaluation);
    EXPECT_EQ(evaluation->verdict, evaluation::Verdict::kVoid);
    EXPECT_THAT(evaluation->features[0].characteristics[0].reason, HasSubstr(path.reason));
    expect_told(run, *evaluation);
  }
}

TEST(Verdict, ACalibrationThatHoldsVoidsNothingAndOneThatDoesNotLeavesPointsOfFilesAlone) {
  RunRecord run = touched_run("iso-14253-1");
  add_calibration(run, [](auto&) {});
  EXPECT_EQ(result_of(run).verdict, evaluation::Verdict::kConforms) << result_of(run).reason;
  run = touched_run("simple-acceptance");
  add_calibration(run, [](auto& c) { c.fixture_id = "F-07"; });
  run.features[0].strategy = record::Strategy::kPointsFile;
  EXPECT_EQ(result_of(run).verdict, evaluation::Verdict::kConforms) << result_of(run).reason;
}

// No data bring this about: the check is told to find it.
TEST(Verdict, OfAFeatureThatBreaksAnInvariantIsVoidWithoutAValueAndTheOthersStay) {
  RunRecord run = touched_run("iso-14253-1");
  run.features.push_back(run.features[0]);
  run.features[1].id = "sound";
  run.poses.push_back({1, 1, {}, {}, true, 0.0});
  const std::vector<record::Touch> touches = run.touches;
  for (record::Touch touch : touches) {
    if (touch.pose < 0) continue;
    touch.pose = 1;
    touch.id += 5000;
    run.touches.push_back(touch);
  }
  const auto check =
      [](const evaluation::FeatureResult& f) -> std::optional<evaluation::BrokenInvariant> {
    if (f.feature.id == "sound") return std::nullopt;
    return evaluation::BrokenInvariant{"MZCY <= LSCY", "0.0061 mm > 0.0052 mm"};
  };
  const evaluation::CheckedEvaluation checked = evaluate_checked(run, check);
  const evaluation::FeatureResult& broken = checked.evaluation.features.at(0);
  ASSERT_EQ(checked.defects.size(), 1U);
  EXPECT_TRUE(checked.defects[0].result.mz_cylinder) << "the dump needs everything";
  EXPECT_EQ(checked.evaluation.verdict, evaluation::Verdict::kVoid);
  EXPECT_FALSE(broken.mz_cylinder || broken.ls_cylinder || broken.mc_cylinder);
  EXPECT_TRUE(broken.cloud.empty() && broken.layers.empty());
  ASSERT_EQ(broken.characteristics.size(), 1U);
  EXPECT_FALSE(broken.characteristics[0].value);
  EXPECT_THAT(
      broken.characteristics[0].reason,
      HasSubstr("invariant \"MZCY <= LSCY\" does not hold for 28 points: 0.0061 mm > 0.0052 "
                "mm; this is a defect of the program"));
  expect_told(run, checked.evaluation);
  EXPECT_THAT(write_summary(run, checked.evaluation), HasSubstr("[internal]"));
  const evaluation::CharacteristicResult& sound =
      checked.evaluation.features.at(1).characteristics.at(0);
  EXPECT_EQ(sound.verdict, evaluation::Verdict::kConforms);
  EXPECT_EQ(sound.value_mm(), evaluate(run)->features[1].characteristics[0].value_mm());
  for (const auto& stored : stored_results(checked.evaluation))
    EXPECT_THAT(stored.name, ::testing::Not(HasSubstr("/features/0/mz"))) << "no value is kept";
}

TEST(Verdict, OfARunIsVoidWhenAFeatureFailedThatHasNoTolerance) {
  evaluation::FeatureResult failed;
  failed.failure = core::Error{core::Code::kNoPoints, "nothing was touched", {}};
  EXPECT_EQ(overall({failed}), evaluation::Verdict::kVoid);
  EXPECT_EQ(overall({evaluation::FeatureResult{}}), evaluation::Verdict::kNotToleranced);
}

/// A feature with these verdicts on toleranced characteristics.
evaluation::FeatureResult judged_feature(const std::vector<evaluation::Verdict>& verdicts) {
  evaluation::FeatureResult out;
  for (const evaluation::Verdict verdict : verdicts) {
    evaluation::CharacteristicResult c;
    c.characteristic.tolerance_mm = 1e-3;
    c.verdict = verdict;
    out.characteristics.push_back(std::move(c));
  }
  return out;
}

TEST(Verdict, OfARunDoesNotConformWhateverElseCouldNotBeJudged) {
  using V = evaluation::Verdict;
  const auto good = judged_feature({V::kConforms});
  const auto open = judged_feature({V::kConforms, V::kUndecided});
  const auto missing = judged_feature({V::kVoid, V::kConforms});
  const auto bad = judged_feature({V::kUndecided, V::kDoesNotConform, V::kVoid});
  evaluation::FeatureResult failed;
  failed.failure = core::Error{core::Code::kNoPoints, "nothing was touched", {}};
  EXPECT_EQ(overall({good}), V::kConforms);
  EXPECT_EQ(overall({good, open}), V::kUndecided);
  EXPECT_EQ(overall({good, open, missing}), V::kVoid);
  EXPECT_EQ(overall({good, open, failed}), V::kVoid);
  EXPECT_EQ(overall({good, missing, bad, failed}), V::kDoesNotConform);
  EXPECT_EQ(overall({failed, judged_feature({V::kNotToleranced})}), V::kVoid);
  // A value that is only reported has no say.
  evaluation::FeatureResult reported = judged_feature({V::kDoesNotConform});
  reported.characteristics[0].characteristic.tolerance_mm.reset();
  EXPECT_EQ(overall({good, reported}), V::kConforms);
}

/// A wheel of radius 50 mm, 16 points with some form, after the features of a run.
void add_wheel(RunRecord& run) {
  record::Feature wheel;
  wheel.id = "wheel";
  wheel.shape = record::Shape::kWheel;
  wheel.strategy = record::Strategy::kSeries;
  wheel.settings = {{"mode", std::nullopt, "indexed"}, {"nominal_radius_mm", 50.0, ""}};
  const record::Characteristic radius{"R", record::Form::kRadius, record::Reference::kLeastSquares,
                                      0.05, ""};
  wheel.characteristics = {radius, radius};
  wheel.characteristics[0].id = "R by the rule of the plan";
  wheel.characteristics[1].id = "R by its own rule";
  auto& own = wheel.characteristics[1].indication.decision_rule.emplace();
  own.rule = record::DecisionRuleTask::Rule::kSimpleAcceptance;
  record::Series data;
  data.feature = static_cast<int>(run.features.size());
  data.columns = {{"x", "mm"}, {"z", "mm"}};
  for (int i = 0; i < 16; ++i) {
    const double t = 2.0 * std::numbers::pi * i / 16;
    const double r = 50.0 + 1e-3 * std::cos(2.0 * t) + 4e-4 * std::cos(5.0 * t + 1.0);
    data.values.insert(data.values.end(), {r * std::cos(t), r * std::sin(t)});
  }
  run.features.push_back(wheel);
  run.series.push_back(data);
}

TEST(Verdict, OfACharacteristicWithoutIntervalIsVoidAndTheOthersStand) {
  RunRecord run = touched_run("iso-14253-1");
  add_wheel(run);
  const auto evaluation = evaluate(run);
  ASSERT_TRUE(evaluation) << evaluation.error().what;
  EXPECT_EQ(evaluation->features[0].characteristics[0].verdict, evaluation::Verdict::kConforms);
  const auto& wheel = evaluation->features[1].characteristics;
  ASSERT_EQ(wheel.size(), 2U);
  EXPECT_EQ(wheel[0].verdict, evaluation::Verdict::kVoid);
  EXPECT_THAT(wheel[0].reason, HasSubstr("needs the interval"));
  ASSERT_TRUE(wheel[0].value) << "the value is printed";
  EXPECT_EQ(wheel[1].verdict, evaluation::Verdict::kConforms) << wheel[1].reason;
  EXPECT_EQ(evaluation->verdict, evaluation::Verdict::kVoid);
  run.features[0].characteristics[0].tolerance_mm = 1e-3;
  const auto bad = evaluate(run);
  ASSERT_TRUE(bad) << bad.error().what;
  EXPECT_EQ(bad->verdict, evaluation::Verdict::kDoesNotConform);
}

// What data alone do not bring about: the parts of an evaluation are taken away.
TEST(Verdict, IsVoidWithoutCertificateOrTemperatureOrWithoutTheIntervalOfWhatWasEvaluated) {
  const RunRecord run = touched_run("iso-14253-1");
  const auto sound = evaluate(run);
  ASSERT_TRUE(sound);
  struct Path {
    const char* reason;
    std::function<void(evaluation::FeatureResult&)> spoil;
  };
  const std::vector<Path> paths = {
      {"no certificate stands behind the minimum zone",
       [](evaluation::FeatureResult& f) {
         f.mz_cylinder->certificate.kind = fit::Certificate::Kind::kNone;
       }},
      {"the temperature was not measured",
       [](evaluation::FeatureResult& f) { f.temperatures.reset(); }},
      {"nothing was touched",
       [](evaluation::FeatureResult& f) {
         f.failure = core::Error{core::Code::kNoPoints, "nothing was touched", {}};
       }},
      {"it was not fitted", [](evaluation::FeatureResult& f) { f.ls_cylinder.reset(); }},
      {"the cloud is merged from several poses whose errors were solved for: no interval",
       [](evaluation::FeatureResult& f) {
         evaluation::MergedPoses merged;
         merged.joint = true;
         f.feature.strategy = record::Strategy::kMerged;
         f.merged = std::make_shared<const evaluation::MergedPoses>(merged);
       }},
      {"merged from several poses and nothing is known of their errors",
       [](evaluation::FeatureResult& f) {
         f.feature.strategy = record::Strategy::kMerged;
         f.merged = std::make_shared<const evaluation::MergedPoses>();
       }},
      {"20001 points are more than 20000, the limit of the trials",
       [](evaluation::FeatureResult& f) { f.cloud.resize(20'001, f.cloud.front()); }},
  };
  for (const Path& path : paths) {
    SCOPED_TRACE(path.reason);
    evaluation::FeatureResult feature = sound->features[0];
    feature.characteristics.clear();
    path.spoil(feature);
    std::vector<std::optional<FoundCharacteristic>> found(feature.feature.characteristics.size());
    decide(run, sound->rule, sound->probe, found, feature);
    const evaluation::CharacteristicResult& result = feature.characteristics.at(0);
    EXPECT_EQ(result.verdict, evaluation::Verdict::kVoid);
    EXPECT_THAT(result.reason, HasSubstr(path.reason));
    // The reports of the sound feature with this verdict: they print what the evaluation says.
    evaluation::Evaluation told = *sound;
    told.features[0].characteristics = feature.characteristics;
    told.verdict = overall(told.features);
    expect_told(run, told);
  }
}

TEST(StatedValue, SaysWhatItIsAboutWithTheDigitsThatItsIntervalAllows) {
  const evaluation::ValueOperator how(
      evaluation::ReferenceTerm(core::as_it_is("MZCY")),
      evaluation::FilterTerm(core::phrase("unfiltered")),
      evaluation::SamplingTerm(core::Phrase("4 x 7 layers")),
      evaluation::TipTerm(core::Phrase("r_tip 1.998")),
      evaluation::TemperatureTerm(core::phrase("{:.1f} degC", 20.3)));
  evaluation::UncertaintyResult result;
  result.sampled.estimate_mm = 8.1e-3;
  result.sampled.low_mm = 7.6e-3;
  result.sampled.high_mm = 9.4e-3;
  const evaluation::StatedValue value("CYLt", 8.31e-3, how,
                                      evaluation::UncertaintyStatus::stated(result, 0.95));
  EXPECT_EQ(value.sentence(),
            "CYLt = 8.10 um, 95 % [7.60, 9.40]; as read 8.31 um (MZCY; unfiltered; 4 x 7 layers; "
            "r_tip 1.998; 20.3 degC; at the sampled points)");
  EXPECT_EQ(value.value_text(), "8.10 um [7.60, 9.40]");
  result.whole = result.sampled;
  result.whole->high_mm = 12.0e-3;
  const evaluation::StatedValue whole("CYLt", 8.31e-3, how,
                                      evaluation::UncertaintyStatus::stated(result, 0.95),
                                      evaluation::Measurand::kWholeSurface);
  EXPECT_THAT(whole.sentence(), HasSubstr("8.1 um, 95 % [7.6, 12.0]; as read 8.3 um"));
  EXPECT_THAT(whole.sentence(), HasSubstr("; of the whole surface)"));
  const evaluation::StatedValue bare(
      "CYLt", 8.31e-3, how, evaluation::UncertaintyStatus::none(core::Phrase("none declared")));
  EXPECT_THAT(bare.sentence(), HasSubstr("CYLt = 8.310 um (MZCY"));
  EXPECT_THAT(bare.sentence(), HasSubstr("at the sampled points; no uncertainty stated)"));
  EXPECT_EQ(evaluation::TipTerm(core::Phrase()).words(), "not known");
}

/// What the environment says of the temperature is in U, whether or not drifts are declared.
TEST(Declared, TheStatedTemperatureCountsWithoutDeclaredDrifts) {
  RunRecord run = touched_run("iso-14253-1");
  for (const bool stated : {false, true}) {
    record::ExpansionSettings expansion;
    if (stated) {
      expansion.part_expansion_per_K = 11.5e-6;
      expansion.temperature_uncertainty_K = 0.2;
    }
    evaluation::FeatureResult feature;
    feature.feature.settings = record::settings_of_task(expansion);
    const auto said = declared_for(run, feature, std::nullopt);
    ASSERT_TRUE(said);
    std::map<std::string, bool> covered;
    for (const auto& line : influence_statements(said->influences))
      covered[line.name] = line.covered;
    EXPECT_EQ(covered.at("temperature"), stated);
    EXPECT_FALSE(covered.at("temperature-drift"));
    EXPECT_FALSE(covered.at("machine-drift"));
  }
}

TEST(Declared, InfluencesComeFromThePlanAndFromTheRunItself) {
  RunRecord run = touched_run("simple-acceptance");
  std::erase_if(run.settings, [](const record::Setting& s) {
    return s.name == "uncertainty/probe/repeatability_um";
  });
  for (const auto& [key, number] :
       std::vector<std::pair<const char*, double>>{{"probe/lobes/order", 3.0},
                                                   {"probe/lobes/amplitude_um", 0.4},
                                                   {"machine/length_limit_um", 1.5},
                                                   {"machine/length_limit_um_m", 3.0},
                                                   {"machine/squareness_xz_urad", 4.0},
                                                   {"machine/translations/linear_um_m", 2.0},
                                                   {"machine/translations/wave_um", 0.3},
                                                   {"machine/translations/wave_period_mm", 40.0},
                                                   {"machine/rotations/linear_urad_m", 5.0},
                                                   {"thermal/drift_K", 0.2},
                                                   {"fixture/creep_deg", 0.001},
                                                   {"form_spectrum/terms/undulations", 2.0},
                                                   {"form_spectrum/terms/degree", 1.0},
                                                   {"form_spectrum/terms/amplitude_um", 1.25}}) {
    run.settings.push_back({std::string("uncertainty/") + key, number, ""});
  }
  run.settings.push_back({"uncertainty/machine/translations/error", std::nullopt, "EYX"});
  run.settings.push_back({"uncertainty/machine/rotations/error", std::nullopt, "ECZ"});
  for (const char* group : {"machine", "thermal", "fixture", "form_spectrum"})
    run.settings.push_back({"uncertainty/declared", std::nullopt, group});
  const auto evaluation = evaluate(run);
  ASSERT_TRUE(evaluation);
  evaluation::FeatureResult feature = evaluation->features[0];
  feature.repeat_sigma_mm = 0.7e-3;
  const auto said = declared_for(run, feature, evaluation->probe);
  ASSERT_TRUE(said);
  const evaluation::Influences& in = said->influences;
  EXPECT_EQ(in.probe->repeatability_mm, 0.7e-3);
  EXPECT_EQ(in.probe->tip_radius_mm, evaluation->probe->radius_sigma_mm);
  ASSERT_EQ(in.probe->lobes.size(), 1U);
  EXPECT_NEAR(in.probe->lobes[0].amplitude_mm, 0.4e-3, 1e-15);
  EXPECT_NEAR(in.machine->length_limit_mm, 1.5e-3, 1e-15);
  EXPECT_NEAR(in.machine->length_limit_slope, 3e-6, 1e-18);
  EXPECT_NEAR(in.machine->terms.squareness_xz_rad, 4e-6, 1e-18);
  const cmm::ErrorCurve& eyx = in.machine->terms.axes[0].translation[1];
  EXPECT_NEAR(eyx.linear_1_mm, 2e-6, 1e-18);
  EXPECT_NEAR(eyx.wave, 0.3e-3, 1e-15);
  EXPECT_EQ(eyx.period_mm, 40.0);
  EXPECT_NEAR(in.machine->terms.axes[2].rotation[2].linear_1_mm, 5e-9, 1e-20);
  EXPECT_EQ(in.thermal->drift_K, 0.2);
  EXPECT_NEAR(in.fixture->creep_rad, 0.001 * std::numbers::pi / 180.0, 1e-15);
  ASSERT_TRUE(said->spectrum);
  ASSERT_EQ(said->spectrum->terms.size(), 1U);
  EXPECT_EQ(said->spectrum->terms[0].degree, 1);
  EXPECT_NEAR(said->spectrum->terms[0].amplitude_mm, 1.25e-3, 1e-15);
  // The statement says of a limit what it is, or that there is none.
  evaluation::Influences limitless = in;
  limitless.machine->length_limit_mm = limitless.machine->length_limit_slope = 0.0;
  for (const auto& [influences, text] : {std::pair(in, "ISO 10360-2 1.5 um + 3 um/m, rectangular"),
                                         std::pair(limitless, "not declared")}) {
    const auto lines = influence_statements(influences);
    const auto limit = std::find_if(lines.begin(), lines.end(), [](const auto& line) {
      return line.name == "machine-length-limit";
    });
    ASSERT_NE(limit, lines.end());
    EXPECT_EQ(limit->text.english(), text);
    EXPECT_EQ(limit->covered, influences.machine->length_limit_mm > 0.0);
  }
  // A limit contains the repeatability that the repeats show.
  run.settings.push_back({"uncertainty/probe/form_limit_um", 2.0, ""});
  const auto limited = declared_for(run, feature, evaluation->probe);
  EXPECT_EQ(limited->influences.probe->repeatability_mm, 0.0);
  EXPECT_NEAR(limited->influences.probe->form_limit_mm, 2e-3, 1e-15);
  EXPECT_FALSE(declared_for(points_run(rough_part(3, 4, 7, 6.0), 4), feature, std::nullopt));
}

// The limit of a form and its two parts say the same: neither is missing beside the other.
TEST(Declared, APartedProbingFormNeedsNoLimit) {
  evaluation::Influences influences;
  influences.probe.emplace().repeatability_mm = 0.3e-3;
  influences.probe->repeatability_known = true;
  const auto covered = [&](std::string_view name) {
    const auto lines = evaluation::influence_statements(influences);
    const auto line = std::ranges::find(lines, name, &evaluation::InfluenceStatement::name);
    return line != lines.end() && line->covered;
  };
  EXPECT_FALSE(covered("probing-form-limit")) << "without its lobes";
  influences.probe->lobes = {{3, 0.4e-3, 0.0}};
  EXPECT_TRUE(covered("probing-form-limit"));
  EXPECT_TRUE(covered("probe-lobing"));
}

TEST(Verdict, IsVoidWhereAWordOfTheJournalIsUnknown) {
  RunRecord run = touched_run("simple-acceptance");
  run.settings.push_back({"decision_rule/measurand", std::nullopt, "every-surface"});
  evaluation::CharacteristicResult result = result_of(run);
  EXPECT_EQ(result.verdict, evaluation::Verdict::kVoid);
  EXPECT_THAT(result.reason, ::testing::HasSubstr("\"every-surface\", which is not known"));
  run.settings.pop_back();
  run.features[0].settings.push_back({"sampling_method", std::nullopt, "scanned"});
  result = result_of(run);
  EXPECT_EQ(result.verdict, evaluation::Verdict::kVoid);
  EXPECT_THAT(result.reason, ::testing::HasSubstr("\"scanned\", which is not known"));
  run.features[0].settings.pop_back();
  run.features[0].strategy = record::Strategy::kMerged;
  run.features[0].settings.push_back({"merge", std::nullopt, "by-guess"});
  result = result_of(run);
  EXPECT_EQ(result.verdict, evaluation::Verdict::kVoid);
  EXPECT_THAT(result.reason, ::testing::HasSubstr("\"by-guess\", which is not known"));
}

}  // namespace
}  // namespace rondure::reports
