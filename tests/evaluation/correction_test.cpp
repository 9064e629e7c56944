// Corrections that leave a run: their rows against the tables of the method and against contours
// that are ground again, their signs and senses, and the files of a run directory.
#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "core/version.h"
#include "evaluation/correction/corrections.h"
#include "evaluation/evaluate.h"
#include "record/files.h"
#include "record/journal/journal.h"
#include "record/sha256.h"
#include "record/tasks/contour.h"
#include "record/tasks/settings.h"
#include "reports/data/corrections.h"
#include "reports/formats/exports.h"
#include "reports/verify/stored_results.h"
#include "reports/verify/verify.h"
#include "tests/core/full.h"
#include "tests/fit/contour_cases.h"
#include "tests/record/sample_run.h"

namespace rondure::evaluation {
namespace {

using core::kDegree;
using core::kMicrometre;
using record::ContourTask;
using testing::HasSubstr;

constexpr std::size_t kPinPoints = 1440;
constexpr const char* kTable = "corrections/pin-x-of-c.csv";

/// Pins of the worked example, recorded by a control of either convention.
struct GroundPins {
  ContourTask task;
  std::vector<double> c_scale = {1.0};
  double rest = 1.0;

  GroundPins() {
    task.filter = ContourTask::Filter::kDoneByGauge;
    record::ContourInfluencesTask said;
    const auto declare = [](double u) { return record::DeclaredInfluence{u}; };
    said.gauge_um = declare(0.1);
    said.gauge_phase_deg = declare(0.2);
    said.c_encoder_urad = declare(4.0);
    said.x_encoder_um = declare(0.2);
    said.skew_ms = declare(0.0);
    task.uncertainty = said;
  }

  [[nodiscard]] fit::AxisErrors errors_of(std::size_t part) const {
    return test::spec_errors(kPinPoints, c_scale[part]);
  }

  [[nodiscard]] record::RunRecord record() const {
    record::RunRecord out;
    out.ending = "finished";
    out.header.run_id = "run-1";
    out.header.version = core::kVersion;
    out.header.processor = "this processor";
    out.header.plan_sha256 = record::sha256_hex("");
    out.header.started_utc = "2026-11-21T02:33:02Z";
    out.header.decision_rule = "simple-acceptance";
    out.header.seed = 5;
    record::Feature feature;
    feature.id = "pin";
    feature.shape = record::Shape::kContour;
    feature.strategy = record::Strategy::kSeries;
    record::Characteristic contour;
    contour.id = "contour";
    contour.form = record::Form::kContourDeviation;
    feature.characteristics = {contour};
    feature.settings = record::settings_of_task(task);
    out.features.push_back(feature);
    for (std::size_t i = 0; i < c_scale.size(); ++i) {
      out.series.push_back(axes(i));
      out.series.push_back(gauge(i));
    }
    return out;
  }

 private:
  [[nodiscard]] record::Series axes(std::size_t part) const {
    const fit::AxisTrace trace = test::spec_trace(300, 1.0, 0.0, c_scale[part]);
    const double sense = task.c_axis == ContourTask::CAxis::kAgainstWheel ? -1.0 : 1.0;
    const double sign = task.error == ContourTask::Error::kCommandMinusActual ? -1.0 : 1.0;
    record::Series out;
    out.name = fmt::format("axes {}", part + 1);
    out.columns = {{"c_deg", "deg"}, {"c_error_deg", "deg"}, {"x_error_mm", "mm"}};
    for (std::size_t i = 0; i < trace.c_rad.size(); ++i) {
      const double c_deg = sense * trace.c_rad[i] / kDegree;
      out.values.push_back(c_deg < 0.0 ? c_deg + 360.0 : c_deg);
      out.values.push_back(sense * sign * trace.c_error_rad[i] / kDegree);
      out.values.push_back(sign * trace.x_error_mm[i]);
    }
    return out;
  }
  [[nodiscard]] record::Series gauge(std::size_t part) const {
    const auto f = ground(errors_of(part));
    const auto n = test::spec_rest(part);
    record::Series out;
    out.name = fmt::format("pin {}", part + 1);
    out.columns = {{"angle_deg", "deg"}, {"deviation_um", "um"}};
    for (std::size_t m = 0; m < f.size(); ++m) {
      out.values.push_back(test::turn_angle(m, f.size()) / kDegree);
      out.values.push_back((f[m] + rest * n[m]) / kMicrometre);
    }
    return out;
  }

 public:
  /// f of errors, by the path of the wheel.
  static std::vector<double> ground(const fit::AxisErrors& errors) {
    const fit::CrankGeometry crank;
    auto contour = fit::ground_contour(crank, errors).value();
    for (double& r : contour.r_mm) r -= crank.pin_radius_mm;
    return fit::contour_error(contour.r_mm, crank.pin_radius_mm).value().error_mm;
  }
};

double range_um(const std::vector<double>& curve) {
  const auto [least, most] = std::minmax_element(curve.begin(), curve.end());
  return (*most - *least) / kMicrometre;
}

/// A table as a control reads it: rows of numbers, comments apart.
struct Loaded {
  std::vector<std::string> head;
  std::vector<double> at_deg;
  std::vector<double> x_um;
  std::vector<double> u_um;

  explicit Loaded(const std::string& text) {
    std::istringstream stream(text);
    std::string line;
    while (std::getline(stream, line)) {
      if (line.starts_with("#") || line.starts_with("c_deg")) {
        head.push_back(line);
        continue;
      }
      double c = 0.0;
      double x = 0.0;
      double u = 0.0;
      char comma = ' ';
      std::istringstream row(line);
      row >> c >> comma >> x >> comma >> u;
      at_deg.push_back(c);
      x_um.push_back(x);
      u_um.push_back(u);
    }
  }
  /// At a C position of the control, linear between the rows.
  [[nodiscard]] double x_at(double c_deg) const {
    const double place = std::fmod(c_deg + 720.0, 360.0);
    const auto row = static_cast<std::size_t>(place);
    const double share = place - static_cast<double>(row);
    return (1.0 - share) * x_um[row % 360] + share * x_um[(row + 1) % 360];
  }
};

struct Evaluated {
  record::RunRecord run;
  Evaluation evaluation;
  reports::Corrections corrections;

  explicit Evaluated(record::RunRecord from)
      : run(std::move(from)),
        evaluation(evaluate(run).value()),
        corrections(reports::write_corrections(run, evaluation)) {}

  [[nodiscard]] Loaded loaded() const {
    EXPECT_EQ(corrections.tables.size(), 1U) << corrections.summary;
    if (corrections.tables.empty()) return Loaded("");
    EXPECT_EQ(corrections.tables[0].file, kTable);
    return Loaded(corrections.tables[0].text);
  }
  [[nodiscard]] XCorrection correction() const {
    auto found = x_correction(run, evaluation.features[0]);
    EXPECT_TRUE(found) << found.error().what;
    return found.value_or(XCorrection{});
  }
};

/// f of a part ground again with the rows added `times` to the command, at C times `sense`.
std::vector<double> again(const GroundPins& pins, std::size_t part, const Loaded& rows,
                          double times = 1.0, double sense = 1.0) {
  fit::AxisErrors errors = pins.errors_of(part);
  for (std::size_t n = 0; n < kPinPoints; ++n) {
    const double alpha_deg = 360.0 * static_cast<double>(n) / kPinPoints;
    errors.x_mm[n] += times * rows.x_at(sense * alpha_deg) * kMicrometre;
  }
  return GroundPins::ground(errors);
}

/// t of the first part, ground again with the rows.
std::vector<double> again_with_rest(const GroundPins& pins, const Loaded& rows) {
  auto out = again(pins, 0, rows);
  const auto n = test::spec_rest(0);
  for (std::size_t m = 0; m < n.size(); ++m) out[m] += n[m];
  return out;
}

// Section 13, K-2: the rows at every 30 deg, with their mean; the contour that is ground again.
TEST(XCorrection, HasTheRowsOfTheWorkedExample) {
  const GroundPins pins;
  const Loaded rows = Evaluated(pins.record()).loaded();
  ASSERT_EQ(rows.x_um.size(), 360U);
  const std::vector<double> expected = {-3.25384, -1.26257, 2.65840,  0.35184, 1.08282, 0.19146,
                                        -0.67190, -2.67212, -2.64509, 3.37641, 2.81066, -0.17973};
  double mean = 0.0;
  for (const double x : rows.x_um) mean += x / 360.0;
  EXPECT_NEAR(mean, 0.0, 1e-12);
  for (std::size_t i = 1; i < expected.size(); ++i) {
    EXPECT_EQ(rows.at_deg[30 * i], 30.0 * static_cast<double>(i));
    EXPECT_NEAR(rows.x_um[30 * i] - rows.x_um[0], expected[i] - expected[0], 5e-4) << i;
  }
  EXPECT_NEAR(range_um(GroundPins::ground(pins.errors_of(0))), 7.043, 5e-4);
  // Linear between rows of 1 deg adds some hundredths to the 0.083 of the exact correction.
  EXPECT_LT(range_um(again(pins, 0, rows)), 0.15);
  EXPECT_NEAR(range_um(again(pins, 0, rows, -1.0)), 14.040, 0.05);
  EXPECT_NEAR(range_um(again(pins, 0, rows, 1.0, -1.0)), 9.775, 0.05);
}

/// cos and sin of an order of x over C, by a plain sum [um].
std::pair<double, double> order_of(const std::vector<double>& x_um, int order) {
  const auto rows = static_cast<double>(x_um.size());
  std::pair<double, double> out;
  for (std::size_t i = 0; i < x_um.size(); ++i) {
    const double c = core::kTwoPi * order * static_cast<double>(i) / rows;
    out.first += 2.0 * x_um[i] * std::cos(c) / rows;
    out.second += 2.0 * x_um[i] * std::sin(c) / rows;
  }
  return out;
}

std::vector<double> in_um(const XCorrection& found) {
  std::vector<double> out;
  for (const double x : found.x_mm) out.push_back(x / kMicrometre);
  return out;
}

TEST(XCorrection, HasTheStepOrdersAndResolutionThatAreAskedFor) {
  GroundPins pins;
  const auto plain = in_um(Evaluated(pins.record()).correction());
  const auto asked = [&](const record::ContourCorrectionTask& correction) {
    pins.task.correction = correction;
    return Evaluated(pins.record());
  };
  const Evaluated coarse = asked({.step_deg = 5.0});
  const auto every_fifth = in_um(coarse.correction());
  ASSERT_EQ(every_fifth.size(), 72U);
  // The mean that is taken off is that of the rows.
  for (std::size_t i = 0; i < 72; ++i) {
    EXPECT_NEAR(every_fifth[i] - every_fifth[0], plain[5 * i] - plain[0], 1e-9) << i;
  }
  EXPECT_THAT(coarse.corrections.tables.at(0).text, HasSubstr("\n355,"));

  constexpr int kLast = 9;
  for (const double step_deg : {1.0, 12.0}) {
    SCOPED_TRACE(step_deg);
    const auto low = in_um(asked({.step_deg = step_deg, .highest_order = kLast}).correction());
    for (int order = 1; order <= 14; ++order) {
      const auto [c, s] = order_of(low, order);
      const auto [c0, s0] = order <= kLast ? order_of(plain, order) : std::pair(0.0, 0.0);
      EXPECT_NEAR(c, c0, 2e-3) << order;
      EXPECT_NEAR(s, s0, 2e-3) << order;
    }
  }

  const Evaluated rounded = asked({.resolution_um = 0.5});
  const XCorrection found = rounded.correction();
  for (std::size_t i = 0; i < 360; ++i) {
    const double x_um = found.x_mm[i] / kMicrometre;
    EXPECT_NEAR(2.0 * x_um, std::round(2.0 * x_um), 1e-9);
    EXPECT_NEAR(x_um, plain[i], 0.25 + 1e-9);
    EXPECT_GT(found.u_mm[i] / kMicrometre, 0.5 / std::sqrt(12.0));
  }
  // The prediction is that of the rows as they are written.
  EXPECT_NEAR(found.after_mm / kMicrometre, range_um(again_with_rest(pins, rounded.loaded())),
              0.01);
}

TEST(XCorrection, DoesNotLeaveTheRunBeyondItsLimit) {
  GroundPins pins;
  pins.task.correction = record::ContourCorrectionTask{.limit_um = 3.0};
  const Evaluated none(pins.record());
  EXPECT_TRUE(none.corrections.tables.empty());
  EXPECT_THAT(none.corrections.summary, HasSubstr("beyond its limit of 3 um"));
  pins.task.correction->limit_um = 6.0;
  EXPECT_EQ(Evaluated(pins.record()).corrections.tables.size(), 1U);
}

TEST(XCorrection, ReducesTheContourByThePredictedGain) {
  GroundPins pins;
  pins.c_scale.assign(test::kSpecCScale, test::kSpecCScale + 4);
  const Evaluated made(pins.record());
  const XCorrection found = made.correction();
  const Loaded rows = made.loaded();
  double before_um = 0.0;
  double after_um = 0.0;
  for (std::size_t part = 0; part < 4; ++part) {
    const auto n = test::spec_rest(part);
    auto first = GroundPins::ground(pins.errors_of(part));
    auto second = again(pins, part, rows);
    for (std::size_t m = 0; m < n.size(); ++m) {
      first[m] += n[m];
      second[m] += n[m];
    }
    before_um = std::max(before_um, range_um(first));
    after_um = std::max(after_um, range_um(second));
  }
  EXPECT_NEAR(found.before_mm / kMicrometre, before_um, 0.01);
  EXPECT_NEAR(found.after_mm / kMicrometre, after_um, 0.01);
  EXPECT_GT(before_um - after_um, 3.0);
  EXPECT_GT(found.gain.low_mm, 0.0);
  EXPECT_LE(found.gain.low_mm / kMicrometre, before_um - after_um);
  EXPECT_GE(found.gain.high_mm / kMicrometre, before_um - after_um);
}

// Section 4.1: u of f by the encoders 0.200, 0.243, 0.278 um at beta 0, 45, 90 deg; no trace noise
// is declared here. With four parts s^2/q is added, where s follows from the scales of C.
TEST(XCorrection, StatesItsUncertainty) {
  GroundPins pins;
  const fit::CrankGeometry crank;
  const double length = crank.center_distance_mm();
  const auto u_f = [&](double beta_deg, const Loaded& rows) {
    const double beta = beta_deg * kDegree;
    const double eta = std::atan2(crank.crank_radius_mm * std::sin(beta),
                                  length + crank.crank_radius_mm * std::cos(beta));
    const double c_deg = (beta - eta) / kDegree;
    const auto row = static_cast<std::size_t>(c_deg);
    const double share = c_deg - static_cast<double>(row);
    return ((1.0 - share) * rows.u_um[row] + share * rows.u_um[row + 1]) * std::cos(eta);
  };
  const Loaded one = Evaluated(pins.record()).loaded();
  EXPECT_NEAR(u_f(0.0, one), 0.200, 5e-4);
  EXPECT_NEAR(u_f(45.0, one), 0.243, 5e-4);
  EXPECT_NEAR(u_f(90.0, one), 0.278, 5e-4);

  pins.c_scale = {0.5, 1.5};
  const Loaded two = Evaluated(pins.record()).loaded();
  const double s_scale = std::sqrt(0.5);
  for (const double beta_deg : {45.0, 90.0, 200.0, 300.0}) {
    SCOPED_TRACE(beta_deg);
    const double beta = beta_deg * kDegree;
    const double alpha =
        std::atan2(length * std::sin(beta), crank.crank_radius_mm + length * std::cos(beta));
    // The first harmonic and the mean of this effect are not in f: taken off by a plain sum.
    constexpr int kSum = 720;
    const auto effect = [&](double at) {
      const double a =
          std::atan2(length * std::sin(at), crank.crank_radius_mm + length * std::cos(at));
      return crank.crank_radius_mm * std::sin(at) * test::spec_c_mdeg(a) * 1e-3 * kDegree * 1e3;
    };
    double shape = effect(beta);
    double mean = 0.0;
    double cosine = 0.0;
    double sine = 0.0;
    for (int i = 0; i < kSum; ++i) {
      const double at = core::kTwoPi * i / kSum;
      mean += effect(at) / kSum;
      cosine += 2.0 * effect(at) * std::cos(at) / kSum;
      sine += 2.0 * effect(at) * std::sin(at) / kSum;
    }
    shape -= mean + cosine * std::cos(beta) + sine * std::sin(beta);
    const double s = s_scale * std::abs(shape);
    const double eta = beta - (alpha < 0.0 && beta > 0.0 ? alpha + core::kTwoPi : alpha);
    const double encoders =
        std::hypot(0.2 * std::cos(eta), crank.crank_radius_mm * std::sin(beta) * 4e-3);
    EXPECT_NEAR(u_f(beta_deg, two), std::sqrt(encoders * encoders + s * s / 2.0), 0.01);
  }
}

TEST(XCorrection, CountsCAsTheControlDoesAndTakesEitherSignOfTheErrors) {
  GroundPins pins;
  const Loaded with = Evaluated(pins.record()).loaded();
  pins.task.error = ContourTask::Error::kCommandMinusActual;
  const Loaded sign = Evaluated(pins.record()).loaded();
  pins.task.c_axis = ContourTask::CAxis::kAgainstWheel;
  const Loaded against = Evaluated(pins.record()).loaded();
  EXPECT_THAT(with.head, testing::Contains(HasSubstr("c_axis with-wheel")));
  EXPECT_THAT(against.head, testing::Contains(HasSubstr("c_axis against-wheel")));
  EXPECT_THAT(against.head, testing::Contains("# sign: add to command"));
  ASSERT_EQ(against.x_um.size(), 360U);
  for (std::size_t i = 0; i < 360; ++i) {
    EXPECT_NEAR(sign.x_um[i], with.x_um[i], 1e-9) << i;
    EXPECT_NEAR(against.x_um[i], with.x_um[(360 - i) % 360], 1e-9) << i;
  }
  // A control that counts C against the wheel reads the table at minus alpha.
  EXPECT_LT(range_um(again(pins, 0, against, 1.0, -1.0)), 0.15);
}

TEST(XCorrection, HasAHeadThatSaysWhatItIs) {
  const Loaded rows = Evaluated(GroundPins().record()).loaded();
  ASSERT_FALSE(rows.head.empty());
  EXPECT_EQ(rows.head.front(), "# rondure correction x-of-c");
  EXPECT_EQ(rows.head.back(), "c_deg,x_um,u_um");
  for (const char* line : {"# run: run-1", "# feature: pin", "# temperature: not recorded",
                           "# date: 2026-11-21T02:33:02Z"}) {
    EXPECT_THAT(rows.head, testing::Contains(line));
  }
  GroundPins other;
  other.rest = 0.9;
  const Loaded changed = Evaluated(other.record()).loaded();
  const auto hash = [](const Loaded& of) {
    return *std::ranges::find_if(of.head, [](auto& l) { return l.starts_with("# data: sha256 "); });
  };
  EXPECT_NE(hash(rows), hash(changed));
}

TEST(XCorrection, OfAVoidFeatureIsNotWritten) {
  GroundPins pins;
  pins.task.uncertainty->skew_ms.reset();
  const Evaluated made(pins.record());
  EXPECT_TRUE(made.corrections.tables.empty());
  EXPECT_THAT(made.corrections.summary, HasSubstr("pin: none: the time between the traces"));

  GroundPins undeclared;
  undeclared.task.uncertainty.reset();
  EXPECT_TRUE(Evaluated(undeclared.record()).corrections.tables.empty());
  GroundPins wrong_sign;
  auto run = wrong_sign.record();
  wrong_sign.task.error = ContourTask::Error::kCommandMinusActual;
  run.features[0].settings = record::settings_of_task(wrong_sign.task);
  const Evaluated negated(run);
  EXPECT_TRUE(negated.corrections.tables.empty());
  EXPECT_THAT(negated.corrections.summary, HasSubstr("the negated f fits"));
}

TEST(XCorrection, WithoutASignificantGainIsNotWritten) {
  GroundPins pins;
  // Where the contour stands on the gauge is nearly unknown: f added may fit or double it.
  pins.task.uncertainty->gauge_phase_deg = record::DeclaredInfluence{60.0};
  const Evaluated made(pins.record());
  EXPECT_TRUE(made.corrections.tables.empty());
  EXPECT_THAT(made.corrections.summary,
              HasSubstr("pin: none: the predicted gain is not significant"));
}

// ---- Files of a run directory -------------------------------------------------------------------

class CorrectionFiles : public testing::Test {
 protected:
  void write(const record::RunRecord& run) {
    auto journal =
        record::Journal::create(directory, run.header, run.artefact, run.features, run.settings);
    ASSERT_TRUE(journal) << journal.error().what;
    ASSERT_TRUE(journal->add(run.series, {}));
    ASSERT_TRUE(journal->end("finished", nullptr));
    const auto evaluation = evaluate(run);
    ASSERT_TRUE(evaluation) << evaluation.error().what;
    ASSERT_TRUE(journal->seal(reports::stored_results(*evaluation)));
    report(run);
  }
  /// The reports of a run in this directory, whatever its journal holds.
  void report(const record::RunRecord& run) const {
    const auto evaluation = evaluate(run);
    ASSERT_TRUE(evaluation) << evaluation.error().what;
    const auto written =
        reports::write_exports(directory, {"csv", "corrections"}, run, *evaluation);
    ASSERT_TRUE(written) << written.error().what;
    EXPECT_TRUE(reports::exports_are_current(directory, {"csv", "corrections"}, run, *evaluation));
  }
  [[nodiscard]] std::vector<std::string> differences() const {
    const auto out = reports::verify_run(directory, {"this processor", {}});
    EXPECT_TRUE(out) << out.error().what;
    return out ? out->differences : std::vector<std::string>();
  }

  record::Scratch scratch;
  std::filesystem::path directory = scratch / "run";
};

TEST_F(CorrectionFiles, AreListedAndVerified) {
  write(GroundPins().record());
  EXPECT_THAT(*record::read_file(directory / "SHA256SUMS"),
              HasSubstr(fmt::format("  {}\n", kTable)));
  EXPECT_THAT(*record::read_file(directory / "corrections.txt"),
              HasSubstr(fmt::format("pin: {}: ", kTable)));
  EXPECT_THAT(differences(), testing::IsEmpty());

  const std::string good = *record::read_file(directory / kTable);
  std::string bad = good;
  const std::size_t digit = bad.find("\n37,") + 6;
  bad[digit] = bad[digit] == '1' ? '2' : '1';
  ASSERT_TRUE(record::write_file(directory / kTable, bad));
  ASSERT_EQ(differences().size(), 1U);
  EXPECT_THAT(differences()[0], testing::AllOf(testing::StartsWith(kTable), HasSubstr("x_um"),
                                               HasSubstr("was changed after it was written")));
  // It is found also where the text that names it is gone.
  std::filesystem::remove(directory / "corrections.txt");
  EXPECT_THAT(differences(), testing::Contains(testing::StartsWith(kTable)));
  // Put right, it is no difference beside the next.
  ASSERT_TRUE(record::write_file(directory / kTable, good));
  if (test::full()) {
    EXPECT_THAT(differences(), testing::IsEmpty());
  }
  ASSERT_TRUE(record::write_file(directory / "corrections/other-x-of-c.csv", good));
  EXPECT_THAT(differences(),
              testing::ElementsAre("corrections/other-x-of-c.csv: the journal gives no such "
                                   "correction"));
}

TEST_F(CorrectionFiles, OfAFeatureThatBecameVoidGoAway) {
  GroundPins pins;
  pins.task.uncertainty->skew_ms.reset();
  write(pins.record());
  report(GroundPins().record());  // as an earlier version of the program saw it
  const std::string good = *record::read_file(directory / kTable);
  report(pins.record());
  EXPECT_FALSE(std::filesystem::exists(directory / kTable));
  EXPECT_THAT(*record::read_file(directory / "SHA256SUMS"), testing::Not(HasSubstr(kTable)));
  EXPECT_THAT(differences(), testing::IsEmpty());
  // What somebody changed is his, and `verify` names it.
  report(GroundPins().record());
  ASSERT_TRUE(record::write_file(directory / kTable, good + "\n"));
  report(pins.record());
  EXPECT_EQ(*record::read_file(directory / kTable), good + "\n");
  EXPECT_THAT(differences(), testing::Contains(testing::StartsWith(kTable)));
}

TEST_F(CorrectionFiles, OfAVoidFeatureAreATextThatSaysWhy) {
  GroundPins pins;
  pins.task.uncertainty->skew_ms.reset();
  write(pins.record());
  EXPECT_FALSE(std::filesystem::exists(directory / "corrections"));
  EXPECT_THAT(*record::read_file(directory / "corrections.txt"), HasSubstr("pin: none: "));
  EXPECT_THAT(differences(), testing::IsEmpty());
}

TEST_F(CorrectionFiles, HaveNamesThatStayInTheirFolder) {
  record::RunRecord run = GroundPins().record();
  run.features[0].id = "../../pin 1";
  run.features.push_back(run.features[0]);
  run.features[1].id = "..-..-pin_1/";
  const Evaluated made(run);
  ASSERT_GE(made.corrections.tables.size(), 1U);
  EXPECT_EQ(made.corrections.tables[0].file, "corrections/.._.._pin_1-x-of-c.csv");
}

// A journal may hold what `validate` refuses by now.
TEST_F(CorrectionFiles, NeverHaveTheNameOfAnotherFeature) {
  record::RunRecord run = GroundPins().record();
  run.features.push_back(run.features[0]);
  run.features[0].id = "p_";
  run.features[1].id = "p;";
  record::Series copy;
  const std::size_t series = run.series.size();
  for (std::size_t i = 0; i < series; ++i) {
    copy = run.series[i];
    copy.feature = 1;
    run.series.push_back(copy);
  }
  const Evaluated made(run);
  ASSERT_EQ(made.corrections.tables.size(), 1U);
  EXPECT_THAT(made.corrections.summary,
              HasSubstr("p;: none: corrections/p_-x-of-c.csv is of another feature; rename one\n"));
}

TEST_F(CorrectionFiles, AreNeitherWrittenNorRemovedWhereALinkLeads) {
  write(GroundPins().record());
  const auto elsewhere = scratch / "elsewhere";
  std::filesystem::rename(directory / "corrections", elsewhere);
  std::filesystem::create_directory_symlink(elsewhere, directory / "corrections");
  const std::string kept = *record::read_file(elsewhere / "pin-x-of-c.csv");
  ASSERT_TRUE(record::write_file(elsewhere / ".rondure-0123.tmp", "x"));
  record::remove_temporaries(directory, "corrections");
  EXPECT_TRUE(std::filesystem::exists(elsewhere / ".rondure-0123.tmp"));
  GroundPins pins;
  pins.task.uncertainty->skew_ms.reset();  // its table would go, that of the other be written
  for (const record::RunRecord& run : {pins.record(), GroundPins().record()}) {
    const auto evaluation = evaluate(run);
    ASSERT_TRUE(evaluation);
    (void)reports::write_exports(directory, {"corrections"}, run, *evaluation);
    EXPECT_EQ(*record::read_file(elsewhere / "pin-x-of-c.csv"), kept);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(elsewhere), {}), 2);
  }
  const auto evaluation = evaluate(GroundPins().record());
  const auto refused =
      reports::write_exports(directory, {"corrections"}, GroundPins().record(), *evaluation);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("it is a link or a file, not a folder of this run"));
}

}  // namespace
}  // namespace rondure::evaluation
