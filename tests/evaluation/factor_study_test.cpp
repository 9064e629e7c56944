// Why two programs differ: the cells against fits of subsets made by hand, the shares against their
// definition, and planted cases whose cause is known. 1e5 points with RONDURE_FULL=1.
#include "evaluation/factors/study.h"
#include "reports/terminal/factors.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/noise.h"
#include "core/units.h"
#include "fit/least_squares/circle.h"
#include "fit/least_squares/cylinder.h"
#include "fit/references/min_zone.h"
#include "fit/references/one_sided.h"
#include "tests/core/full.h"
#include "tests/core/processor_time.h"
#include "tests/evaluation/points_run.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

using record::Form;
using record::Reference;
using ::testing::HasSubstr;
using Points = std::vector<Eigen::Vector3d>;
using Form3 = std::function<double(double angle_rad, int layer, int point)>;

constexpr double kRoundOffMm = 1e-9;

/// Layers of radius 25 mm plus `form`, 15 mm apart.
Points part(int layers, int points_per_layer, const Form3& form) {
  Points out;
  for (int layer = 0; layer < layers; ++layer) {
    for (int i = 0; i < points_per_layer; ++i) {
      const double t = core::kTwoPi * i / points_per_layer;
      const double r = 25.0 + form(t, layer, i);
      out.emplace_back(r * std::cos(t), r * std::sin(t), 15.0 * layer);
    }
  }
  return out;
}

/// The study of one characteristic of points of known layers.
evaluation::FactorStudy study_of(const Points& points, int layers,
                                 const std::string& id = "cylindricity mz") {
  auto run = points_run(points, layers);
  std::erase_if(run.features[0].characteristics,
                [&](const record::Characteristic& c) { return c.id != id; });
  const auto comparison = compare_run(evaluated(run));
  EXPECT_TRUE(comparison) << comparison.error().what;
  return comparison ? comparison->studies.at(0) : evaluation::FactorStudy{};
}

std::size_t level_of(const evaluation::FactorStudy& study, evaluation::Factor factor,
                     const std::string& name) {
  const auto& names = study.levels[static_cast<std::size_t>(factor)];
  const auto found = std::find(names.begin(), names.end(), name);
  EXPECT_NE(found, names.end()) << name;
  return static_cast<std::size_t>(found - names.begin());
}

using Keep = std::function<bool(int layer, int point)>;

Points where(const Points& points, int points_per_layer, const Keep& keep) {
  Points out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const int row = static_cast<int>(i);
    if (keep(row / points_per_layer, row % points_per_layer)) out.push_back(points[i]);
  }
  return out;
}

const std::vector<std::pair<std::string, Keep>>& subsets() {
  static const std::vector<std::pair<std::string, Keep>> kAll = {
      {"all points", [](int, int) { return true; }},
      {"points 1, 3, 5, ...", [](int, int point) { return point % 2 == 0; }},
      {"points 2, 4, 6, ...", [](int, int point) { return point % 2 == 1; }},
      {"layers 1, 3, 5, ...", [](int layer, int) { return layer % 2 == 0; }},
      {"layers 2, 4, 6, ...", [](int layer, int) { return layer % 2 == 1; }},
      {"first layer left out", [](int layer, int) { return layer > 0; }},
      {"last layer left out", [](int layer, int) { return layer < 3; }}};
  return kAll;
}

/// The four deviations in the order of the levels.
std::vector<double> cylinder_fits(const Points& points) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  return {fit::ls_cylinder(points, up)->deviation_mm,
          fit::min_zone_cylinder(points, up)->width_mm(),
          fit::min_circumscribed_cylinder(points, up)->deviation_mm,
          fit::max_inscribed_cylinder(points, up)->deviation_mm};
}

std::vector<double> circle_fits(const std::vector<Eigen::Vector2d>& points) {
  return {fit::ls_circle(points)->deviation_mm, fit::min_zone_circle(points)->width_mm(),
          fit::min_circumscribed_circle(points)->deviation_mm,
          fit::max_inscribed_circle(points)->deviation_mm};
}

TEST(FactorStudy, CellsOfACylinderAreFitsOfTheSubsetsMadeByHand) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    SCOPED_TRACE(seed);
    const Points points = rough_part(seed, 4, 15, core::kTwoPi);
    const evaluation::FactorStudy study = study_of(points, 4);
    for (const auto& [name, keep] : subsets()) {
      SCOPED_TRACE(name);
      const Points subset = where(points, 15, keep);
      const auto expected = cylinder_fits(subset);
      const std::size_t s = level_of(study, evaluation::Factor::kSampling, name);
      for (std::size_t r = 0; r < 4; ++r) {
        const evaluation::FactorCell& cell = study.cell({r, 0, 0, s});
        ASSERT_TRUE(cell.value_mm) << cell.why;
        EXPECT_NEAR(*cell.value_mm, expected[r], kRoundOffMm) << r;
        EXPECT_EQ(cell.points, subset.size());
      }
    }
  }
}

TEST(FactorStudy, CellsOfSectionsAreTheWorstOfTheLayersMadeByHand) {
  const Points points = rough_part(7, 4, 15, core::kTwoPi);
  const evaluation::FactorStudy study = study_of(points, 4, "roundness mz");
  const fit::Axis axis = evaluated(points_run(points, 4)).features.at(0).mz_cylinder.value().axis;
  const auto frame = fit::across(axis.direction);
  for (const auto& [name, keep] : subsets()) {
    SCOPED_TRACE(name);
    std::vector<double> worst(4, 0.0);
    for (int layer = 0; layer < 4; ++layer) {
      std::vector<Eigen::Vector2d> section;
      for (const Eigen::Vector3d& p :
           where(points, 15, [&](int l, int i) { return l == layer && keep(l, i); }))
        section.emplace_back(frame.transpose() * (p - axis.point_mm));
      if (section.empty()) continue;
      const auto fits = circle_fits(section);
      for (std::size_t r = 0; r < 4; ++r) worst[r] = std::max(worst[r], fits[r]);
    }
    const std::size_t s = level_of(study, evaluation::Factor::kSampling, name);
    for (std::size_t r = 0; r < 4; ++r) {
      const evaluation::FactorCell& cell = study.cell({r, 0, 0, s});
      ASSERT_TRUE(cell.value_mm) << cell.why;
      EXPECT_NEAR(*cell.value_mm, worst[r], kRoundOffMm) << r;
    }
  }
}

TEST(FactorStudy, OutlierRulesLeaveOutThePlantedPointsAndNoOthers) {
  Points points = rough_part(11, 4, 24, core::kTwoPi);
  const Eigen::Vector3d axis_at = Eigen::Vector3d(10.0, -4.0, 0.0);
  for (const std::size_t row : {5U, 60U}) {
    Eigen::Vector3d out = points[row] - axis_at;
    out.z() = 0.0;
    points[row] += 40e-3 * out.normalized();
  }
  const evaluation::FactorStudy study = study_of(points, 4);
  const Points clean = where(points, 24, [](int layer, int point) {
    return 24 * layer + point != 5 && 24 * layer + point != 60;
  });
  const auto expected = cylinder_fits(clean);
  for (const char* rule : {"3 sigma", "5 medians"}) {
    SCOPED_TRACE(rule);
    const std::size_t o = level_of(study, evaluation::Factor::kOutliers, rule);
    for (std::size_t r = 0; r < 4; ++r) {
      const evaluation::FactorCell& cell = study.cell({r, 0, o, 0});
      EXPECT_EQ(cell.left_out, 2U);
      ASSERT_TRUE(cell.value_mm);
      EXPECT_NEAR(*cell.value_mm, expected[r], kRoundOffMm);
    }
  }
}

TEST(FactorStudy, TheThreeSigmaRuleCountsWithTheFreedomsOfTheFit) {
  // One bad point of a circle of n others at +-1 um: on either side of its own limit.
  for (const double spike_mm : {6e-3, 30e-3}) {
    SCOPED_TRACE(spike_mm);
    const Points points = part(
        1, 40, [&](double, int, int i) { return i == 7 ? spike_mm : (i % 2 == 0 ? 1e-3 : -1e-3); });
    const evaluation::FactorStudy study = study_of(points, 1, "roundness ls");
    std::vector<Eigen::Vector2d> plane;
    for (const auto& p : points) plane.emplace_back(p.head<2>());
    const auto circle = fit::ls_circle(plane);
    double squares = 0.0;
    for (const auto& p : plane)
      squares += std::pow((p - circle->center_mm).norm() - circle->radius_mm, 2);
    const double limit = 3.0 * std::sqrt(squares / 37.0);
    std::size_t beyond = 0;
    for (const auto& p : plane) {
      if (std::abs((p - circle->center_mm).norm() - circle->radius_mm) > limit) ++beyond;
    }
    EXPECT_EQ(beyond, 1U);
    EXPECT_EQ(study.changed(evaluation::Factor::kOutliers, 1).left_out, beyond);
  }
}

TEST(FactorStudy, FilteredCellsAreTheValuesOfAReportThatAsksForTheFilter) {
  core::KeyedNoise noise(5, {1});
  const Points points = part(2, 400, [&](double t, int, int) {
    return 4e-3 * std::cos(2.0 * t) + 2e-3 * std::cos(30.0 * t) + 1e-3 * noise.normal();
  });
  auto run = points_run(points, 2);
  // One-sided cylinders of two sections have several optima, of which the cells hold the near one.
  std::erase_if(run.features[0].characteristics, [](const record::Characteristic& c) {
    return c.id == "cylindricity mc" || c.id == "cylindricity mi";
  });
  const auto plain = compare_run(evaluated(run));
  ASSERT_TRUE(plain);
  for (const double cutoff : {15.0, 50.0}) {
    for (record::Characteristic& asked : run.features[0].characteristics) {
      asked.indication.filter = record::Indication::Filter::kGaussian;
      asked.indication.cutoff_upr = cutoff;
    }
    const auto filtered = compare_run(evaluated(run));
    ASSERT_TRUE(filtered);
    for (std::size_t i = 0; i < plain->studies.size(); ++i) {
      const evaluation::FactorStudy& study = plain->studies[i];
      SCOPED_TRACE(study.characteristic.id);
      const std::size_t f =
          level_of(study, evaluation::Factor::kFilter, fmt::format("Gaussian {:g} UPR", cutoff));
      EXPECT_EQ(filtered->studies[i].reported[1], f);
      EXPECT_NEAR(study.changed(evaluation::Factor::kFilter, f).value_mm.value_or(0.0),
                  filtered->studies[i].reported_mm, 1e-6);
    }
  }
  EXPECT_THAT(plain->studies[0].changed(evaluation::Factor::kFilter, 3).why,
              HasSubstr("400 points in a turn are 2.67 per undulation at 150 UPR"));
}

TEST(FactorStudy, AFilteredCylinderKeepsWhatTheFilterPasses) {
  const double lobes_mm = 4e-3;
  const Points points = part(3, 400, [&](double t, int, int) {
    return lobes_mm * std::cos(5.0 * t) + 3e-3 * std::cos(40.0 * t);
  });
  const evaluation::FactorStudy study = study_of(points, 3, "cylindricity ls");
  const auto passed = [](double n, double fc) { return std::exp2(-(n / fc) * (n / fc)); };
  // Both crest together at angle 0; 5 lobes make an odd form: its crests and troughs differ.
  for (const auto& [level, cutoff] :
       std::vector<std::pair<std::size_t, double>>{{1, 15.0}, {2, 50.0}}) {
    SCOPED_TRACE(cutoff);
    double high = 0.0;
    double low = 0.0;
    for (int i = 0; i < 400; ++i) {
      const double t = core::kTwoPi * i / 400.0;
      const double r = lobes_mm * passed(5.0, cutoff) * std::cos(5.0 * t) +
                       3e-3 * passed(40.0, cutoff) * std::cos(40.0 * t);
      high = std::max(high, r);
      low = std::min(low, r);
    }
    ASSERT_TRUE(study.changed(evaluation::Factor::kFilter, level).value_mm);
    EXPECT_NEAR(*study.changed(evaluation::Factor::kFilter, level).value_mm, high - low, 2e-6);
  }
}

TEST(FactorStudy, TheReportedCombinationCarriesTheReportedValueOfEveryCharacteristic) {
  const auto run = points_run(rough_part(3, 4, 15, core::kTwoPi), 4);
  const evaluation::Evaluation evaluation = evaluated(run);
  const auto comparison = compare_run(evaluation);
  ASSERT_TRUE(comparison);
  ASSERT_EQ(comparison->studies.size(), 8U);
  for (std::size_t i = 0; i < 8; ++i) {
    const evaluation::FactorStudy& study = comparison->studies[i];
    SCOPED_TRACE(study.characteristic.id);
    EXPECT_EQ(study.cell(study.reported).value_mm,
              evaluation.features[0].characteristics[i].value_mm());
    ASSERT_TRUE(study.shares);
    double sum = study.shares->together_1;
    for (const double share : study.shares->share_1) sum += share;
    EXPECT_NEAR(sum, 1.0, 1e-12);
    // The minimum zone is never wider than the others, whatever else is changed.
    for (std::size_t o = 0; o < 3; ++o) {
      for (std::size_t s = 0; s < study.levels[3].size(); ++s) {
        for (const std::size_t other : {0U, 2U, 3U}) {
          const auto& mz = study.cell({1, 0, o, s}).value_mm;
          const auto& more = study.cell({other, 0, o, s}).value_mm;
          if (mz && more) {
            EXPECT_LE(*mz, *more + kRoundOffMm);
          }
        }
      }
    }
  }
}

/// The factor with the greatest share, and that share.
std::pair<evaluation::Factor, double> greatest(const evaluation::FactorStudy& study) {
  EXPECT_TRUE(study.shares);
  const auto& shares = study.shares->share_1;
  const auto at = std::max_element(shares.begin(), shares.end());
  return {static_cast<evaluation::Factor>(at - shares.begin()), *at};
}

TEST(FactorStudy, ASpikeMakesTheOutliersTheGreatestShare) {
  const evaluation::FactorStudy study =
      study_of(part(4, 16,
                    [](double t, int layer, int i) {
                      return 0.5e-3 * std::cos(2.0 * t) + (layer == 1 && i == 5 ? 40e-3 : 0.0);
                    }),
               4);
  const auto [factor, share] = greatest(study);
  EXPECT_EQ(factor, evaluation::Factor::kOutliers);
  EXPECT_GT(share, 0.5);
  EXPECT_EQ(study.effects[2].strongest, 1U);
  EXPECT_LT(study.effects[2].least_change_mm, -30e-3);
  EXPECT_EQ(study.effects[2].greatest_change_mm, 0.0);
}

TEST(FactorStudy, FineWavinessMakesTheFilterTheGreatestShare) {
  const evaluation::FactorStudy study = study_of(
      part(3, 420,
           [](double t, int, int) { return 1e-3 * std::cos(2.0 * t) + 6e-3 * std::cos(97.0 * t); }),
      3);
  const auto [factor, share] = greatest(study);
  EXPECT_EQ(factor, evaluation::Factor::kFilter);
  EXPECT_GT(share, 0.8);
  EXPECT_LT(study.effects[1].least_change_mm, -9e-3);
}

TEST(FactorStudy, TooFewPointsMakeTheSamplingTheGreatestShare) {
  // Four lobes seen by eight points: every second of them sees crests or troughs only.
  const evaluation::FactorStudy study =
      study_of(part(4, 8, [](double t, int, int) { return 5e-3 * std::cos(4.0 * t); }), 4);
  const auto [factor, share] = greatest(study);
  EXPECT_EQ(factor, evaluation::Factor::kSampling);
  EXPECT_GT(share, 0.8);
  EXPECT_NEAR(study.effects[3].least_change_mm, -10e-3, 1e-6);
}

TEST(FactorStudy, APerfectPartHasNoDifferencesToShare) {
  const evaluation::FactorStudy study =
      study_of(part(4, 8, [](double, int, int) { return 0.0; }), 4);
  EXPECT_FALSE(study.shares);
  EXPECT_THAT(comparison_text("r", {{study}, {}}, false), HasSubstr("No combination"));
}

TEST(FactorStudy, PointsOfUnknownLayersAreNotCutByLayer) {
  auto run = points_run(rough_part(2, 4, 30, core::kTwoPi), 4);
  run.features[0].layers = 0;
  std::erase_if(run.features[0].characteristics, [](const record::Characteristic& c) {
    return c.reference != Reference::kMinimumZone;
  });
  const auto comparison = compare_run(evaluated(run));
  ASSERT_TRUE(comparison);
  const evaluation::FactorStudy& study = comparison->studies.at(0);
  EXPECT_EQ(study.levels[3].size(), 3U);
  EXPECT_THAT(study.changed(evaluation::Factor::kFilter, 1).why,
              HasSubstr("layer 1: 30 points in a turn are 2.00 per undulation"));
  ASSERT_EQ(comparison->without.size(), 1U);
  EXPECT_EQ(comparison->without[0].where, "land / roundness mz");
}

TEST(FactorStudy, CombinationsThatCannotBeEvaluatedSayWhy) {
  const evaluation::FactorStudy few =
      study_of(part(2, 6, [](double t, int, int) { return 1e-3 * std::cos(2.0 * t); }), 2);
  EXPECT_FALSE(few.changed(evaluation::Factor::kSampling, 3).value_mm) << "one layer shows no tilt";
  EXPECT_NE(few.changed(evaluation::Factor::kSampling, 3).why, "");
  const evaluation::FactorStudy section = study_of(
      part(1, 7, [](double t, int, int) { return 1e-3 * std::cos(2.0 * t); }), 1, "roundness mz");
  EXPECT_EQ(section.changed(evaluation::Factor::kSampling, 2).why,
            "layer 1: a section of three different points has no roundness");
}

TEST(FactorStudy, AmplitudesOfHarmonicsAreNotCompared) {
  auto run =
      points_run(part(3, 50, [](double t, int, int) { return 1e-3 * std::cos(3.0 * t); }), 3);
  run.features[0].characteristics.resize(2);
  run.features[0].characteristics[1].form = Form::kHarmonicLimits;
  run.features[0].characteristics[1].harmonic_limits = {{2, 5, 2e-3}};
  const auto comparison = compare_run(evaluated(run));
  ASSERT_TRUE(comparison);
  EXPECT_EQ(comparison->studies.size(), 1U);
  ASSERT_EQ(comparison->without.size(), 1U);
  EXPECT_THAT(comparison->without[0].what, HasSubstr("has no reference to exchange"));
}

TEST(FactorStudy, ARunWithoutAValueIsRefusedWithTheReason) {
  auto run = points_run(rough_part(2, 4, 7, core::kTwoPi), 4);
  run.poses[0].final_cloud = false;
  run.ending = "stopped";
  const auto refused = compare_run(evaluated(run));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("the run ended before the final cloud was measured"));
  // A cloud that is whole is compared although the verdict is void.
  run.poses[0].final_cloud = true;
  EXPECT_TRUE(compare_run(evaluated(run)));
}

TEST(FactorStudy, TextKeepsToEightyColumnsAndOpensWithTheAnswer) {
  const auto comparison = compare_run(evaluated(points_run(rough_part(4, 4, 15, core::kTwoPi), 4)));
  ASSERT_TRUE(comparison);
  const std::string text = comparison_text("run 7", *comparison, true);
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80U) << line;
  EXPECT_THAT(text, ::testing::StartsWith("Why do they differ? Run run 7\n"));
  const std::string answer = answer_of(comparison->studies[1]);
  EXPECT_THAT(answer, HasSubstr(" um as reported; the reference changes it by up to +"));
  EXPECT_THAT(
      answer,
      HasSubstr(
          "the filter cannot be tried (layer 1: 15 points in a turn are 1.00 per undulation"));
  EXPECT_THAT(text, HasSubstr("no value: layer 1: 15 points in a turn are"));
}

TEST(FactorStudy, AHundredThousandPointsTakeBoundedTime) {
  const int of_layer = test::cases(1'100, 10'000);
  core::KeyedNoise noise(9, {2});
  const Points points = part(10, of_layer, [&](double t, int layer, int) {
    return 3e-3 * std::cos(2.0 * t + layer) + 0.5e-3 * noise.normal();
  });
  const double begin_s = test::processor_seconds();
  const evaluation::FactorStudy study = study_of(points, 10);
  const double seconds = test::processor_seconds() - begin_s;
  fmt::print("{} points: evaluated and compared in {:.2f} s\n", points.size(), seconds);
  EXPECT_TRUE(study.changed(evaluation::Factor::kFilter, 3).value_mm);
  EXPECT_LT(seconds, 120.0);
}

/// Var(E[y | level]) / Var(y) over the block, by its definition.
double share_by_definition(const evaluation::FactorTable& table,
                           const evaluation::FactorShares& shares, std::size_t factor) {
  std::vector<double> all;
  std::vector<std::vector<double>> by_level(table.levels[factor]);
  for (std::size_t i = 0; i < table.values.size(); ++i) {
    const auto c = table.combination(i);
    bool inside = true;
    for (std::size_t f = 0; f < c.size(); ++f) {
      const auto& used = shares.used[f];
      inside = inside && std::find(used.begin(), used.end(), c[f]) != used.end();
    }
    if (!inside) continue;
    EXPECT_TRUE(table.values[i]) << "the block has a hole";
    all.push_back(*table.values[i]);
    by_level[c[factor]].push_back(*table.values[i]);
  }
  const auto mean = [](const std::vector<double>& v) {
    double sum = 0.0;
    for (const double x : v) sum += x;
    return sum / static_cast<double>(v.size());
  };
  const auto variance = [&](const std::vector<double>& v) {
    double sum = 0.0;
    for (const double x : v) sum += std::pow(x - mean(v), 2);
    return sum / static_cast<double>(v.size());
  };
  std::vector<double> means;
  for (const auto& level : by_level) {
    if (!level.empty()) means.push_back(mean(level));
  }
  return variance(means) / variance(all);
}

TEST(FactorShares, OfAdditiveAndOfJointEffectsAreKnown) {
  const std::vector<std::size_t> reported = {0, 0};
  const auto additive = factor_shares({{2, 2}, {0.0, 1.0, 2.0, 3.0}}, reported);
  ASSERT_TRUE(additive);
  EXPECT_NEAR(additive->share_1[0], 0.8, 1e-15);
  EXPECT_NEAR(additive->share_1[1], 0.2, 1e-15);
  EXPECT_NEAR(additive->together_1, 0.0, 1e-15);
  const auto joint = factor_shares({{2, 2}, {0.0, 1.0, 1.0, 0.0}}, reported);
  ASSERT_TRUE(joint);
  EXPECT_NEAR(joint->together_1, 1.0, 1e-15);
  EXPECT_FALSE(factor_shares({{2, 2}, {7.0, 7.0, 7.0, 7.0}}, reported));
}

TEST(FactorShares, SumToOneOverAFullBlockThatHoldsTheReportedOne) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    core::KeyedNoise noise(seed, {3});
    evaluation::FactorTable table{{4, 1 + seed % 4, 3, 7}, {}};
    std::size_t cells = 1;
    for (const std::size_t levels : table.levels) cells *= levels;
    const double missing = noise.uniform();
    for (std::size_t i = 0; i < cells; ++i) {
      table.values.emplace_back(noise.normal());
      if (noise.uniform() < missing * 0.3) table.values.back().reset();
    }
    const std::vector<std::size_t> reported =
        table.combination(static_cast<std::size_t>(noise.uniform() * static_cast<double>(cells)));
    EXPECT_EQ(table.combination(table.index(reported)), reported);
    table.values[table.index(reported)] = 0.25;
    const auto shares = factor_shares(table, reported);
    if (!shares) continue;  // one cell was left
    double sum = shares->together_1;
    std::size_t block = 1;
    for (std::size_t f = 0; f < 4; ++f) {
      sum += shares->share_1[f];
      block *= shares->used[f].size();
      EXPECT_NE(std::find(shares->used[f].begin(), shares->used[f].end(), reported[f]),
                shares->used[f].end());
      EXPECT_NEAR(shares->share_1[f], share_by_definition(table, *shares, f), 1e-12);
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
    EXPECT_EQ(shares->values, block);
  }
}

}  // namespace
}  // namespace rondure::reports
