// A wheel feature from its series to the reports.

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/encodings.h"
#include "evaluation/analysis_result.h"
#include "evaluation/evaluate.h"
#include "evaluation/wheel/result.h"
#include "record/run_record.h"
#include "reports/data/writers.h"
#include "reports/escaping.h"
#include "reports/html/report.h"
#include "reports/terminal/summary.h"
#include "reports/verify/stored_results.h"
#include "reports/words/language.h"
#include "tests/fit/wheel_cases.h"
#include "tests/reports/page_text.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

using core::printable;

using ::testing::HasSubstr;
using ::testing::Not;

record::Setting word(std::string name, std::string text) {
  return {std::move(name), std::nullopt, std::move(text)};
}
record::Setting number(std::string name, double value) { return {std::move(name), value, {}}; }

record::Characteristic asked(std::string id, record::Form form, double tolerance_mm) {
  record::Characteristic out;
  out.id = std::move(id);
  out.form = form;
  out.tolerance_mm = tolerance_mm;
  return out;
}

/// Worked example 1 with its axis, grinding a parabola of vertex radius 80 mm.
record::RunRecord wheel_run() {
  record::RunRecord run;
  run.header.run_id = "wheel";
  run.ending = "finished";
  record::Feature feature;
  feature.id = "wheel";
  feature.shape = record::Shape::kWheel;
  feature.strategy = record::Strategy::kSeries;
  feature.settings = {word("mode", "indexed"),
                      number("nominal_radius_mm", 50.01),
                      number("axis_x_mm", 12.02),
                      number("axis_z_mm", -7.0),
                      word("center", "as-published"),
                      word("surface/form", "polynomial"),
                      number("surface/coefficients", 0.0),
                      number("surface/coefficients", 0.0),
                      number("surface/coefficients", 0.5 / 80.0),
                      number("surface/from_mm", -20.0),
                      number("surface/to_mm", 20.0),
                      number("surface/step_mm", 1.0)};
  feature.characteristics = {asked("R", record::Form::kRadius, 0.020),
                             asked("FIM", record::Form::kRunOut, 0.030),
                             asked("edge", record::Form::kRoundness, 0.005)};
  run.features = {feature};
  record::Series data;
  data.columns = {{"x", "mm"}, {"z", "mm"}};
  for (const auto& p : test::example_1()) data.values.insert(data.values.end(), {p.x(), p.y()});
  run.series = {data};
  return run;
}

TEST(WheelReport, JudgesRadiusRunOutAndRoundnessOfWorkedExample1) {
  const auto evaluation = evaluate(wheel_run());
  ASSERT_TRUE(evaluation) << evaluation.error().what;
  const auto& results = evaluation->features.at(0).characteristics;
  ASSERT_EQ(results.size(), 3U);
  EXPECT_NEAR(results[0].value_mm().value() * 1e3, 10.0, 1.1e-3);
  EXPECT_EQ(results[0].verdict, evaluation::Verdict::kConforms);
  EXPECT_NEAR(results[1].value_mm().value() * 1e3, 35.393, 1.6e-3);
  EXPECT_EQ(results[1].verdict, evaluation::Verdict::kDoesNotConform);
  EXPECT_LT(results[2].value_mm().value() * 1e3, 4.535);
  // Eight points hold no lobes above order 3.
  EXPECT_EQ(results[2].verdict, evaluation::Verdict::kVoid);
  EXPECT_THAT(results[2].reason, HasSubstr("a lower bound"));
  auto wide = wheel_run();
  wide.features.front().characteristics[2].tolerance_mm = 0.030;
  EXPECT_EQ(evaluate(wide)->features.at(0).characteristics[2].verdict, evaluation::Verdict::kVoid);
}

/// The wheel of wheel_run() with other points.
record::RunRecord run_of(const test::Points2& points) {
  auto run = wheel_run();
  run.series.front().values.clear();
  for (const auto& p : points) {
    run.series.front().values.insert(run.series.front().values.end(), {p.x(), p.y()});
  }
  return run;
}

// Every path to void of an analysis of series (analysis.cpp), in the evaluation and in the reports.
TEST(WheelReport, IsVoidWithItsReasonOnEveryPath) {
  struct Path {
    const char* reason;
    std::function<void(record::RunRecord&)> spoil;
  };
  const std::vector<Path> paths = {
      {"the run ended before its data were kept", [](auto& r) { r.series.clear(); }},
      {"the run ended before its data were kept", [](auto& r) { r.series[0].name = "other"; }},
      {"the run did not finish", [](auto& r) { r.ending = "stopped"; }},
      {"does not know the decision rule", [](auto& r) { r.header.decision_rule = "coin"; }},
      {"the plan declares no influences of this feature: wheel/uncertainty",
       [](auto& r) { r.header.decision_rule = "iso-14253-1"; }}};
  for (const Path& path : paths) {
    SCOPED_TRACE(path.reason);
    auto run = run_of(test::arc_points(16, 360.0, 50.0, 2e-4, 3, {12.02, -7.0}));
    run.features.front().settings[4].text = "least-squares";
    // So wide that what 16 points may miss is below a tenth of it.
    for (auto& asked : run.features.front().characteristics) asked.tolerance_mm = 0.3;
    path.spoil(run);
    const auto evaluation = evaluate(run);
    ASSERT_TRUE(evaluation);
    EXPECT_EQ(evaluation->verdict, evaluation::Verdict::kVoid);
    for (const evaluation::CharacteristicResult& result :
         evaluation->features.at(0).characteristics) {
      EXPECT_EQ(result.verdict, evaluation::Verdict::kVoid);
      EXPECT_FALSE(result.outcome);
      EXPECT_THAT(result.reason, HasSubstr(path.reason));
      EXPECT_THAT(testing::one_line(write_summary(run, *evaluation)),
                  HasSubstr("because " + printable(with_signs(result.reason.english()))));
      EXPECT_THAT(write_html(run, *evaluation),
                  HasSubstr(in_sentence(core::Phrase(capitalised(result.reason.english())))));
    }
  }
}

// 8 points on 60 deg show 5.6 um of 11.7: within 10 um they prove nothing, above 5 um they do.
TEST(WheelReport, APartialArcConformsToNothing) {
  auto run = run_of(test::arc_points(8, 60.0, 50.0, 0.0, 1, {12.02, -6.99415}));
  auto& asked = run.features.front().characteristics;
  asked[1].tolerance_mm = 0.010;
  asked[2].tolerance_mm = 0.010;
  const auto evaluation = evaluate(run);
  ASSERT_TRUE(evaluation) << evaluation.error().what;
  const auto& results = evaluation->features.at(0).characteristics;
  for (const std::size_t i : {1, 2}) {
    SCOPED_TRACE(i);
    EXPECT_EQ(results[i].verdict, evaluation::Verdict::kVoid);
    EXPECT_THAT(results[i].reason, HasSubstr("300 deg of the turn unseen"));
  }
  EXPECT_LT(results[1].value_mm().value(), 0.0117);
  EXPECT_THAT(write_html(run, *evaluation), HasSubstr("≥ "));
  asked[1].tolerance_mm = 0.002;
  EXPECT_EQ(evaluate(run)->features.at(0).characteristics[1].verdict,
            evaluation::Verdict::kDoesNotConform);
}

TEST(WheelReport, ARobustRuleTakesNothingFromRunOutAndRoundness) {
  auto points = test::arc_points(16, 360.0, 50.0, 2e-4, 3, {12.02, -7.0});
  points[5] += 0.046 * (points[5] - Eigen::Vector2d(12.02, -7.0)).normalized();
  auto run = run_of(points);
  run.features.front().settings.push_back(word("robust", "on"));
  auto evaluation = evaluate(run);
  ASSERT_TRUE(evaluation) << evaluation.error().what;
  for (const std::size_t i : {1, 2}) {
    SCOPED_TRACE(i);
    const auto& result = evaluation->features.at(0).characteristics[i];
    EXPECT_EQ(result.verdict, evaluation::Verdict::kDoesNotConform);
    EXPECT_GT(result.value_mm().value(), 0.040);
  }
  // A point that stands out so far may stand out farther beside it.
  run.features.front().characteristics[1].tolerance_mm = 0.060;
  evaluation = evaluate(run);
  const auto& near = evaluation->features.at(0).characteristics[1];
  EXPECT_EQ(near.verdict, evaluation::Verdict::kVoid);
  EXPECT_NEAR(near.value_mm().value(), 0.046, 1e-3);
  run.features.front().characteristics[1].tolerance_mm = 0.300;
  evaluation = evaluate(run);
  EXPECT_EQ(evaluation->features.at(0).characteristics[1].verdict, evaluation::Verdict::kConforms);
}

TEST(WheelReport, ShowsEdgePathMarginAndResidual) {
  const auto run = wheel_run();
  const auto evaluation = evaluate(run);
  ASSERT_TRUE(evaluation);
  const std::string html = write_html(run, *evaluation);
  EXPECT_THAT(html, HasSubstr("Edge of the wheel"));
  EXPECT_THAT(html, HasSubstr("Way of the wheel's centre"));
  EXPECT_THAT(html, HasSubstr("x / mm"));
  EXPECT_THAT(html, HasSubstr("z / mm"));
  EXPECT_THAT(html, HasSubstr("Form left after touch-off"));
  EXPECT_FALSE(testing::shows_nan(html));
  const auto written = nlohmann::json::parse(write_json(run, *evaluation));
  const auto& wheel = written["features"][0]["wheel"];
  EXPECT_NEAR(wheel["radius_mm"], 50.0, 1.1e-6);
  EXPECT_EQ(wheel["path"]["places"], 41);
  EXPECT_NEAR(wheel["path"]["greatest_R_ks"]["value"], 50.0 / 80.0, 1e-6);
  EXPECT_EQ(wheel["curves"]["path"]["xc_mm"].size(), 41U);
  EXPECT_NEAR(wheel["forecast"]["nominal"]["delta_um"], 10.0, 1.1e-3);
  EXPECT_THAT(write_summary(run, *evaluation), HasSubstr("R 50.000000 mm"));
  for (const auto& stored : stored_results(*evaluation)) {
    EXPECT_THAT(stored.name, Not(HasSubstr("curves")));
  }
}

// Title, verdict, the picture of the edge, then numbers and their words.
TEST(WheelReport, ShowsTheEdgeBeforeTheNumbers) {
  const auto run = wheel_run();
  const auto evaluation = evaluate(run);
  ASSERT_TRUE(evaluation);
  const std::string html = write_html(run, *evaluation);
  EXPECT_EQ(testing::first_unbalanced_tag(html), "");
  EXPECT_THAT(html, HasSubstr("Grinding-wheel report"));
  std::size_t at = 0;
  for (const char* next : {"class=\"verdict\"", "radius, run-out and edge</h2>",
                           "Edge of the wheel</h3>", "class=\"keys\"", "<b>Effective radius</b>"}) {
    at = html.find(next, at);
    ASSERT_NE(at, std::string::npos) << next;
  }
}

// u(R) is that of the declared errors where the plan declares them.
TEST(WheelReport, SaysWhatTheUncertaintyOfTheRadiusIsMadeOf) {
  auto run = wheel_run();
  run.features[0].settings.push_back(number("uncertainty/point_um/value", 2.0));
  const auto evaluation = evaluate(run);
  ASSERT_TRUE(evaluation);
  const auto& m = std::get<WheelResult>(evaluation->features[0].analysis->found).evaluation.wheel;
  EXPECT_NEAR(m.radius_uncertainty_mm, 2e-3 * m.factors.radius, 1e-9);
  const std::string html = write_html(run, *evaluation);
  EXPECT_THAT(html, HasSubstr("from the declared errors of point, scale, threshold and wear"));
  EXPECT_THAT(html, Not(HasSubstr("uncertainty from the scatter of the points alone")));
}

/// 16 points about the whole turn of a wheel of 50 mm that runs out by 5 um about (12.02, -7).
record::RunRecord whole_wheel(double tolerance_mm) {
  test::Points2 points;
  for (int i = 0; i < 16; ++i) {
    const double angle = core::kTwoPi * i / 16.0;
    points.emplace_back(12.025 + 50.0 * std::cos(angle), -7.0 + 50.0 * std::sin(angle));
  }
  record::RunRecord run = run_of(points);
  run.features.front().characteristics = {asked("FIM", record::Form::kRunOut, tolerance_mm)};
  for (const char* name : {"point_um", "axis_um"}) {
    run.features.front().settings.push_back(
        number("uncertainty/" + std::string(name) + "/value", 0.3));
  }
  return run;
}

// Greatest distance from the axis: 50.005 mm.
TEST(WheelReport, StatesTheEffectiveRadiusWithItsIntervalOnPageAndTerminal) {
  const auto run = whole_wheel(0.030);
  const auto evaluation = evaluate(run);
  ASSERT_TRUE(evaluation);
  const auto written = nlohmann::json::parse(write_json(run, *evaluation));
  const auto& stated = written["features"][0]["wheel"]["effective_radius_interval"];
  ASSERT_TRUE(stated.is_object()) << written["features"][0]["wheel"].dump();
  EXPECT_LT(stated["low_mm"], 50.005);
  EXPECT_GT(stated["high_mm"], 50.005);
  EXPECT_FALSE(stated["at_least"].get<bool>());
  const std::string page = write_html(run, *evaluation);
  EXPECT_EQ(testing::first_unbalanced_tag(page), "");
  EXPECT_THAT(page, HasSubstr("50.00500 mm, 95 % within [50.00"));
  const std::string summary = testing::one_line(write_summary(run, *evaluation));
  EXPECT_THAT(summary, HasSubstr("eff. radius 50.005"));
  EXPECT_THAT(summary, HasSubstr(" mm, 95 % within [50.00"));
}

TEST(WheelReport, AnEffectiveRadiusBesideAGapIsOnlyItsLowerEnd) {
  auto run = whole_wheel(0.030);
  auto& values = run.series.front().values;
  values.resize(values.size() - 10);  // five points: a gap of 135 deg
  const auto evaluation = evaluate(run);
  ASSERT_TRUE(evaluation);
  const auto written = nlohmann::json::parse(write_json(run, *evaluation));
  EXPECT_TRUE(written["features"][0]["wheel"]["effective_radius_interval"]["at_least"]);
  EXPECT_THAT(write_html(run, *evaluation), HasSubstr(" mm, the lower end of its 95 % interval"));
}

// The budget of an analysis is linear propagation, which knows a sign, but no shift.
TEST(WheelReport, BudgetHasTheChangeForOneStandardUncertaintyAndNoShift) {
  auto run = wheel_run();
  auto& settings = run.features[0].settings;
  settings.push_back(number("uncertainty/point_um/value", 0.5));
  settings.push_back(number("uncertainty/threshold_um/value", 1.0));
  const auto evaluation = evaluate(run);
  ASSERT_TRUE(evaluation);
  const std::string html = write_html(run, *evaluation);
  EXPECT_THAT(html, HasSubstr("Largest influences"));
  const auto written = nlohmann::json::parse(write_json(run, *evaluation));
  const auto& radius = written["features"][0]["characteristics"][0];
  ASSERT_FALSE(radius["uncertainty"].is_null()) << radius.dump();
  int lines = 0;
  for (const auto& line : radius["uncertainty"]["budget"]) {
    EXPECT_TRUE(line["shift_um"].is_null());
    EXPECT_NEAR(std::abs(line["per_u_um"].get<double>()),
                line["standard_uncertainty_um"].get<double>(), 1e-9);
    ++lines;
  }
  EXPECT_GE(lines, 2);
}

TEST(WheelReport, SaysWhyThereIsNoPathAndStillJudgesTheWheel) {
  auto run = wheel_run();
  run.features[0].settings[8].number = 0.5 / 40.0;
  const auto evaluation = evaluate(run);
  ASSERT_TRUE(evaluation);
  EXPECT_EQ(evaluation->features[0].characteristics[0].verdict, evaluation::Verdict::kConforms);
  const std::string html = write_html(run, *evaluation);
  EXPECT_THAT(html, HasSubstr("No path:"));
  EXPECT_THAT(html, HasSubstr("exceeds the concave radius of curvature 40 mm"));
  const auto written = nlohmann::json::parse(write_json(run, *evaluation));
  EXPECT_TRUE(written["features"][0]["wheel"]["path"].is_null());
  EXPECT_EQ(written["features"][0]["wheel"]["path_refused"]["code"], "gouge");
}

TEST(WheelReport, LeavesRunOutVoidWithoutTheAxis) {
  auto run = wheel_run();
  run.features[0].settings.erase(run.features[0].settings.begin() + 2,
                                 run.features[0].settings.begin() + 4);
  const auto evaluation = evaluate(run);
  ASSERT_TRUE(evaluation);
  EXPECT_EQ(evaluation->features[0].characteristics[1].verdict, evaluation::Verdict::kVoid);
  EXPECT_THAT(evaluation->features[0].characteristics[1].reason, HasSubstr("axis is not given"));
}

TEST(WheelReport, LeavesEverythingVoidForPointsThatAreNoWheel) {
  auto run = wheel_run();
  for (double& value : run.series[0].values) value *= 1000.0;
  const auto evaluation = evaluate(run);
  ASSERT_TRUE(evaluation);
  ASSERT_TRUE(evaluation->features[0].failure);
  EXPECT_EQ(evaluation->features[0].failure->code, core::Code::kUnits);
  for (const auto& result : evaluation->features[0].characteristics) {
    EXPECT_EQ(result.verdict, evaluation::Verdict::kVoid);
  }
}

}  // namespace
}  // namespace rondure::reports
