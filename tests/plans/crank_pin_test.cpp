// The twin of crank pins: pin and main journal share a part of what does not follow the axes.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/statistics.h"
#include "core/units.h"
#include "evaluation/analysis_result.h"
#include "evaluation/contour/result.h"
#include "evaluation/correction/corrections.h"
#include "evaluation/evaluate.h"
#include "fit/contour/crank_motion.h"
#include "fit/contour/error.h"
#include "fit/contour/study.h"
#include "plans/analyses/analysis.h"
#include "plans/run/runner.h"
#include "record/files.h"
#include "tests/core/full.h"
#include "tests/core/scratch.h"
#include "tests/plans/files.h"

namespace rondure::plans {
namespace {

/// The pins of example 07 without noise, of pins and mains with this rms of their own.
Plan pins_with(double own_um, std::uint64_t seed) {
  Plan out = testing::plan_of("07_crank_pin.json");
  SimulatedContourPlan& twin = *out.simulation->contour;
  twin.pin_own_um = twin.main_own_um = own_um;
  twin.rest_spread_um = 0.2;
  twin.parts = 1;
  twin.gauge_points = 360;
  twin.c_noise_mdeg = twin.x_noise_um = twin.roughness_um = 0.0;
  out.simulation->seed = seed;
  out.features.front().contour->uncertainty.reset();
  return out;
}

/// One column of the only part [um].
std::vector<double> column_of(const AnalysisData& data, const std::string& series,
                              const std::string& column) {
  for (const record::Series& one : data.series) {
    if (one.name == series) return one.column(column).value_or(std::vector<double>());
  }
  ADD_FAILURE() << series << " has no " << column;
  return {};
}

double mean_square(const std::vector<double>& curve) {
  return std::pow(core::root_mean_square(curve), 2);
}

// Machine cell 4.1: rms of the error is rms(n) sqrt(2 (1 - rho)).
TEST(CrankTwin, ErrsWithoutTracesByWhatPinAndMainDoNotShare) {
  for (const double own_um : {0.1, 0.3}) {
    double error2 = 0.0;
    double rest2 = 0.0;
    double common2 = 0.0;
    const int seeds = test::cases(25, 200);
    for (int seed = 1; seed <= seeds; ++seed) {
      const Plan plan = pins_with(own_um, static_cast<std::uint64_t>(seed));
      const auto data = analysis_data(plan, 0, plan.simulation->seed).value();
      const auto pin = column_of(data, "pin 1", "deviation_um");
      const auto main = column_of(data, "main 1", "deviation_um");
      const auto ground = column_of(data, "truth 1", "ground_um");
      const auto rest = column_of(data, "truth 1", "rest_um");
      std::vector<double> error(pin.size());
      for (std::size_t m = 0; m < pin.size(); ++m) error[m] = pin[m] - main[m] - ground[m];
      error2 += mean_square(error);
      rest2 += mean_square(rest);
      common2 += mean_square(rest) - own_um * own_um;
    }
    const double rho = common2 / rest2;
    const double expected2 = 2.0 * (1.0 - rho) * rest2;
    EXPECT_NEAR(std::sqrt(error2 / expected2), 1.0, test::full() ? 0.05 : 0.12) << own_um;
  }
}

TEST(CrankTwin, OfAnIndirectSeparationRecordsNoTraces) {
  Plan plan = pins_with(0.1, 3);
  plan.features.front().contour->separation = record::ContourTask::Separation::kIndirect;
  const auto data = analysis_data(plan, 0, 3).value();
  ASSERT_FALSE(data.series.empty());
  for (const record::Series& series : data.series) {
    EXPECT_FALSE(series.name.starts_with("axes")) << series.name;
  }
}

TEST(CrankTwin, HasAMainLikeItsPinInTheTruthOfAnIndirectSeparationOnly) {
  Plan plan = pins_with(0.3, 3);
  for (const bool indirect : {false, true}) {
    plan.features.front().contour->separation = indirect
                                                    ? record::ContourTask::Separation::kIndirect
                                                    : record::ContourTask::Separation::kDirect;
    const auto data = analysis_data(plan, 0, 3).value();
    const auto main = column_of(data, "main 1", "deviation_um");
    EXPECT_EQ(main, column_of(data, "truth 1", "main_um"));
    const auto truth = std::ranges::find_if(data.series, [](const record::Series& series) {
      return series.name == "main 1" && series.role == record::Series::Role::kTruth;
    });
    ASSERT_NE(truth, data.series.end());
    EXPECT_EQ(truth->column("deviation_um").value(),
              indirect ? column_of(data, "truth 1", "rest_um") : main);
  }
}

TEST(CrankTwin, HasMainsOfTheirOwnWhereThePlanSaysNothing) {
  Plan plan = pins_with(0.0, 3);
  const auto alike = analysis_data(plan, 0, 3).value();
  EXPECT_EQ(column_of(alike, "truth 1", "rest_um"), column_of(alike, "truth 1", "main_um"));
  plan.simulation->contour->pin_own_um.reset();
  plan.simulation->contour->main_own_um.reset();
  const auto differ = analysis_data(plan, 0, 3).value();
  EXPECT_NE(column_of(differ, "truth 1", "rest_um"), column_of(differ, "truth 1", "main_um"));
}

// ---- Files of other columns
// ------------------------------------------------------------------------

class PinFiles : public ::testing::Test {
 protected:
  /// The only pin of example 07 as a control and a gauge of other columns write it.
  Plan of_files(bool positions) {
    const Plan twin = pins_with(0.1, 5);
    const auto data = analysis_data(twin, 0, 5).value();
    const auto axes = [&](const char* column) { return column_of(data, "axes 1", column); };
    const auto c = axes("c_deg");
    const auto c_error = axes("c_error_deg");
    const auto x_error = axes("x_error_mm");
    std::string text = "t;C_CMD;X_CMD;C;X\n";
    if (!positions) text = "t,C_FOLLOW,X_FOLLOW,C_POS\n";
    for (std::size_t i = 0; i < c.size(); ++i) {
      // The twin records command minus actual.
      const double d = fit::wheel_position_mm({}, c[i] * core::kDegree);
      text += positions ? fmt::format("{},{},{:.7f},{:.7f},{:.7f}\n", i, c[i], d, c[i] - c_error[i],
                                      d - x_error[i])
                        : fmt::format("{},{:.9f},{:.9f},{:.9f}\n", i, -1e3 * c_error[i],
                                      -2e3 * x_error[i], c[i] * core::kDegree);
    }
    if (positions) text.replace(0, text.find('\n'), "t,C_CMD,X_CMD,C,X");
    write("axes.csv", text);
    for (const char* const kind : {"pin", "main"}) {
      const std::string series = std::string(kind) + " 1";
      const auto angle = column_of(data, series, "angle_deg");
      const auto deviation = column_of(data, series, "deviation_um");
      text = std::string(kind) == "pin" ? "W,DEV\n" : "W,MAIN\n";
      for (std::size_t m = 0; m < angle.size(); ++m) {
        text += fmt::format("{},{:.9f}\n", angle[m], 1e3 * deviation[m]);
      }
      write(std::string(kind) + ".csv", text);
    }
    using Column = record::ContourColumnTask;
    Plan out = twin;
    out.simulation.reset();
    out.folder = folder_.path();
    record::ContourTask& task = *out.features.front().contour;
    task.parts = {{"", "axes.csv", "pin.csv", "main.csv"}};
    task.error = record::ContourTask::Error::kActualMinusCommand;
    task.columns = {{Column::Quantity::kAngle, "W", {}, 1.0},
                    {Column::Quantity::kDeviation, "DEV", Column::Unit::kNm, 1.0},
                    {Column::Quantity::kMainDeviation, "MAIN", Column::Unit::kNm, 1.0}};
    const auto add = [&](Column::Quantity quantity, const char* name,
                         std::optional<Column::Unit> unit, double scale) {
      task.columns.push_back({quantity, name, unit, scale});
    };
    if (positions) {
      add(Column::Quantity::kCommandedC, "C_CMD", {}, 1.0);
      add(Column::Quantity::kCommandedX, "X_CMD", {}, 1.0);
      add(Column::Quantity::kActualC, "C", {}, 1.0);
      add(Column::Quantity::kActualX, "X", {}, 1.0);
    } else {
      add(Column::Quantity::kC, "C_POS", Column::Unit::kRad, 1.0);
      add(Column::Quantity::kCError, "C_FOLLOW", Column::Unit::kMilliDeg, 1.0);
      add(Column::Quantity::kXError, "X_FOLLOW", Column::Unit::kUm, 0.5);  // counts of 0.5 um
    }
    return out;
  }
  void write(const std::string& name, const std::string& text) {
    ASSERT_TRUE(record::write_file(folder_ / name, text));
  }

  test::Scratch folder_;
};

TEST_F(PinFiles, OfOtherColumnsUnitsSignsAndCountsAreThoseOfTheTwin) {
  const Plan twin = pins_with(0.1, 5);
  const auto wanted = analysis_data(twin, 0, 5).value();
  for (const bool positions : {false, true}) {
    const Plan plan = of_files(positions);
    const auto read = analysis_data(plan, 0, 5);
    ASSERT_TRUE(read) << read.error().what;
    for (const auto& [series, column, sign, tolerance] : {std::tuple{"axes 1", "c_deg", 1.0, 1e-6},
                                                          {"axes 1", "c_error_deg", -1.0, 2e-7},
                                                          {"axes 1", "x_error_mm", -1.0, 2e-7},
                                                          {"pin 1", "deviation_um", 1.0, 1e-9},
                                                          {"main 1", "deviation_um", 1.0, 1e-9}}) {
      const auto given = column_of(*read, series, column);
      const auto planted = column_of(wanted, series, column);
      ASSERT_EQ(given.size(), planted.size());
      for (std::size_t i = 0; i < given.size(); ++i) {
        ASSERT_NEAR(given[i], sign * planted[i], tolerance) << series << " " << column << " " << i;
      }
    }
  }
}

TEST_F(PinFiles, OfARepeatNameTheCorrectionThatWasLoaded) {
  Plan plan = of_files(false);
  record::ContourTask& task = *plan.features.front().contour;
  task.repeat.emplace().table = "loaded.csv";
  write("loaded.csv", "# rondure correction x-of-c\nc_deg,x_um\n0,1.5\n120,-2\n240,0.5\n");
  const auto data = analysis_data(plan, 0, 5);
  ASSERT_TRUE(data) << data.error().what;
  EXPECT_THAT(column_of(*data, "table", "x_um"), ::testing::ElementsAre(1.5, -2.0, 0.5));
}

TEST_F(PinFiles, OfPositionsContradictAnErrorOfTheOtherSign) {
  Plan plan = of_files(true);
  plan.features.front().contour->error = record::ContourTask::Error::kCommandMinusActual;
  EXPECT_EQ(analysis_data(plan, 0, 5).error().code, core::Code::kMeaning);
}

// ---- The next parts, ground with the correction of the first ------------------------------------

/// Example 20: pins without traces, then pins ground with their correction.
Plan corrected(bool traced, std::uint64_t seed = 20) {
  Plan out = testing::plan_of("20_crank_pin_next_part.json");
  out.simulation->seed = seed;
  out.simulation->contour->gauge_points = 720;
  if (!test::full()) out.simulation->contour->parts = 2;
  for (FeaturePlan& feature : out.features) {
    record::ContourTask& task = *feature.contour;
    if (traced) {
      const auto pins = testing::plan_of("07_crank_pin.json");
      auto uncertainty = pins.features.front().contour->uncertainty;
      // The twin has none: what it grinds would be no draw of these.
      uncertainty->c_encoder_urad = uncertainty->x_encoder_um = record::DeclaredInfluence{0.0};
      task.separation = record::ContourTask::Separation::kDirect;
      task.error = record::ContourTask::Error::kCommandMinusActual;
      task.c_axis = record::ContourTask::CAxis::kAgainstWheel;
      task.uncertainty = uncertainty;
    }
  }
  return out;
}

class NextPins : public ::testing::Test {
 protected:
  evaluation::Evaluation run(const Plan& plan) {
    std::filesystem::remove_all(directory_);
    const auto ran = run_plan(plan, testing::options_for(directory_));
    EXPECT_TRUE(ran);
    return evaluation::evaluate(testing::journal_of(directory_)).value();
  }
  test::Scratch scratch_;
  std::filesystem::path directory_ = scratch_ / "run";
};

const evaluation::ContourResult& pins_of_feature(const evaluation::Evaluation& found,
                                                 std::size_t feature) {
  return std::get<evaluation::ContourResult>(found.features[feature].analysis->found);
}

// f of every part was some 7 um. Its parts differ by 4 % in C, so 0.3 um stay at the most.
TEST_F(NextPins, KeepLittleOfWhatFollowsTheAxes) {
  const auto found = run(corrected(true));
  const evaluation::ContourResult& next = pins_of_feature(found, 1);
  ASSERT_TRUE(next.gain);
  EXPECT_EQ(next.gain->with, "pin");
  EXPECT_GT(next.gain->before_mm, 6e-3);
  EXPECT_LT(fit::peak_to_valley(fit::mean_following(next.study)), 0.4e-3);
  for (const auto& feature : found.features) {
    for (const auto& one : feature.characteristics) {
      EXPECT_NE(one.verdict, evaluation::Verdict::kVoid) << one.reason;
      ASSERT_EQ(one.truths_mm.size(), 1U);
      const auto* const stated = one.value->statement();
      ASSERT_NE(stated, nullptr) << one.value->uncertainty().why().english();
      EXPECT_NEAR(stated->estimate_mm, one.truths_mm.front(),
                  4.0 * stated->standard_uncertainty_mm);
    }
  }
}

// The table in the control is the one that left the run: its steps, its orders, its increments.
TEST_F(NextPins, AreGroundWithTheTableAsItIsWritten) {
  Plan plan = corrected(true);
  plan.features[0].contour->correction =
      record::ContourCorrectionTask{.step_deg = 5.0, .resolution_um = 0.1, .highest_order = 20};
  const auto found = run(plan);
  const record::RunRecord record = testing::journal_of(directory_);
  const auto written = evaluation::x_correction(record, found.features[0]);
  ASSERT_TRUE(written) << written.error().what;
  const auto* const loaded = record.data_of(1, "table");
  ASSERT_NE(loaded, nullptr);
  const auto x_um = loaded->column("x_um").value();
  ASSERT_EQ(x_um.size(), 72U);
  ASSERT_EQ(written->x_mm.size(), x_um.size());
  for (std::size_t i = 0; i < x_um.size(); ++i) {
    EXPECT_NEAR(10.0 * x_um[i], std::round(10.0 * x_um[i]), 1e-9);
    EXPECT_NEAR(x_um[i], written->x_mm[i] / core::kMicrometre, 1e-9) << i;
  }
  EXPECT_LT(fit::peak_to_valley(fit::mean_following(pins_of_feature(found, 1).study)), 0.8e-3);
}

// t of the next parts is f of the axes with the correction, and n: no trace says so.
TEST_F(NextPins, WithoutTracesAreAsGoodAsPinAndMainJournalAreAlike) {
  const auto found = run(corrected(false));
  const evaluation::ContourResult& next = pins_of_feature(found, 1);
  EXPECT_FALSE(next.study.traced());
  EXPECT_GT(next.gain->before_mm, 6e-3);
  EXPECT_LT(fit::peak_to_valley(fit::mean_following(next.study)), 0.8e-3);
  EXPECT_EQ(found.features[1].characteristics[1].verdict, evaluation::Verdict::kConforms)
      << found.features[1].characteristics[1].reason;
}

/// f of the contours that the simulated axes ground, mean of all parts: peak to valley [mm].
double planted_following_mm(const record::RunRecord& record, int feature, std::size_t parts,
                            const fit::ContourStudyOptions& options) {
  std::vector<double> mean;
  for (std::size_t part = 1; part <= parts; ++part) {
    const auto* const truth = record.truth_series_of(feature, fmt::format("truth {}", part));
    if (truth == nullptr) return -1.0;
    auto ground = truth->column("ground_um").value_or(std::vector<double>());
    for (double& v : ground) v *= core::kMicrometre;
    const auto f = fit::contour_error(ground, options.geometry.pin_radius_mm, options.error);
    if (!f) return -1.0;
    mean.resize(f->error_mm.size(), 0.0);
    for (std::size_t m = 0; m < mean.size(); ++m) {
      mean[m] += f->error_mm[m] / static_cast<double>(parts);
    }
  }
  return fit::peak_to_valley(mean);
}

// What pin and main journal do not share is an error of f, not a part of its truth.
TEST_F(NextPins, WithoutTracesAreHeldAgainstWhatFollowsTheAxes) {
  for (const std::uint64_t seed : {20U, 21U}) {
    const Plan plan = corrected(false, seed);
    const auto found = run(plan);
    const record::RunRecord record = testing::journal_of(directory_);
    const auto parts = static_cast<std::size_t>(plan.simulation->contour->parts);
    for (const std::size_t feature : {0U, 1U}) {
      SCOPED_TRACE(fmt::format("seed {}, feature {}", seed, feature));
      const auto& truths = found.features[feature].characteristics[1].truths_mm;
      ASSERT_EQ(truths.size(), 1U);
      const evaluation::ContourResult& pins = pins_of_feature(found, feature);
      const double planted_mm =
          planted_following_mm(record, static_cast<int>(feature), parts, pins.options);
      EXPECT_NEAR(truths.front(), planted_mm, 0.01e-3);
    }
  }
}

// Added to the traces with the other sign, the correction doubles f.
TEST_F(NextPins, WithTheCorrectionOfTheOtherSignAreVoid) {
  const Plan twin = corrected(true);
  const auto simulated = run(twin);
  record::RunRecord as_read = testing::journal_of(directory_);
  for (record::Series& series : as_read.series) {
    if (series.name != "table") continue;
    for (std::size_t i = 1; i < series.values.size(); i += 2) series.values[i] *= -1.0;
  }
  const auto wrong = evaluation::evaluate(as_read).value();
  const auto& good = pins_of_feature(simulated, 1);
  const auto& bad = pins_of_feature(wrong, 1);
  EXPECT_GT(fit::peak_to_valley(fit::mean_following(bad.study)), 1.8 * good.gain->before_mm);
  const auto& gates = wrong.features[1].gates;
  EXPECT_TRUE(std::ranges::any_of(gates, [](const evaluation::Gate& gate) {
    return gate.code == "sense" && gate.outcome == evaluation::Gate::Outcome::kVoids;
  }));
}

}  // namespace
}  // namespace rondure::plans
