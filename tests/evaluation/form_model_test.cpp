// The form model of an interval against worked numbers, and what guards the interval.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/noise.h"
#include "core/units.h"
#include "evaluation/uncertainty/internal/columns.h"
#include "evaluation/uncertainty/internal/form_value.h"
#include "evaluation/uncertainty/internal/sampler.h"
#include "evaluation/uncertainty/uncertainty.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

constexpr double kUm = 1e-3;  // in mm

/// The 4 x 7 touches of the worked numbers, of a part so large that the linear zone is the zone.
struct WorkedCloud {
  WorkedCloud() {
    cloud.radius_mm = 1e4;
    for (int l = 0; l < 4; ++l) {
      for (int i = 0; i < 7; ++i) {
        evaluation::FormPoint p;
        p.angle_rad = core::kTwoPi * i / 7 + l * core::kTwoPi / 28;
        const double q = -1.0 + 2.0 * l / 3.0;
        p.height_mm = 1e4 * q;
        const double n = 0.6180339887498949 * (7 * l + i + 1);
        form.push_back(kUm * (1.5 * std::cos(3 * p.angle_rad) + 0.8 * q * q +
                              0.4 * q * std::sin(2 * p.angle_rad)));
        errors.push_back(kUm * 0.3 * std::sqrt(12.0) * (n - std::floor(n) - 0.5));
        p.deviation_mm = form.back() + errors.back();
        cloud.points.push_back(p);
      }
    }
  }

  [[nodiscard]] double width_um(const std::vector<double>& deviations) const {
    evaluation::FormValue value(cloud, cloud.points);
    return value.of(Eigen::Map<const Eigen::VectorXd>(deviations.data(), 28)) / kUm;
  }

  evaluation::FormCloud cloud;
  std::vector<double> form;
  std::vector<double> errors;
};

evaluation::Influences noise_of(double sigma_mm) {
  evaluation::Influences out;
  out.probe = evaluation::ProbeInfluences{};
  out.probe->repeatability_mm = sigma_mm;
  return out;
}

// Four points of a layer see an oval at one phase, those of layers that are turned at both.
TEST(FormModel, HasTheAlternationOfLayersOfFewPoints) {
  for (const double turned : {0.0, 0.1}) {
    evaluation::FormCloud cloud;
    cloud.radius_mm = 10.0;
    for (int l = 0; l < 3; ++l) {
      for (int i = 0; i < 4; ++i) {
        evaluation::FormPoint p;
        p.angle_rad = core::kTwoPi * i / 4 + 0.3 + turned * l;
        p.height_mm = 10.0 * l;
        cloud.points.push_back(p);
      }
    }
    const evaluation::FormColumns columns(cloud, Eigen::VectorXd::Ones(12));
    std::map<int, std::size_t> ovals;
    for (const evaluation::FormGroup& group : columns.groups()) {
      if (group.harmonic == 2) ovals[group.degree] = group.columns.size();
    }
    const std::size_t phases = turned > 0.0 ? 2 : 1;
    EXPECT_EQ(ovals, (std::map<int, std::size_t>{{0, phases}, {1, phases}, {2, phases}}));
  }
}

// However the face is turned: its sides are found.
TEST(FormModel, HasABowAlongASideOfAGridInOneColumn) {
  for (const double turned : {0.0, 0.4, 2.0}) {
    evaluation::FormCloud cloud;
    cloud.kind = evaluation::FormKind::kFlatness;
    cloud.radius_mm = 1.0;
    Eigen::VectorXd bow(15);
    for (int i = 0; i < 15; ++i) {
      const double u = 10.0 * (i % 5 - 2);
      const double v = 8.0 * (i / 5 - 1);
      evaluation::FormPoint p;
      p.angle_rad = std::atan2(v, u) + turned;
      p.height_mm = std::hypot(u, v);
      cloud.points.push_back(p);
      bow[i] = u * u;
    }
    const evaluation::FormColumns columns(cloud, Eigen::VectorXd::Ones(15));
    const Eigen::VectorXd products = columns.products(bow.array() - bow.mean()).cwiseAbs();
    EXPECT_EQ((products.array() > 1e-9 * products.maxCoeff()).count(), 1) << turned;
    EXPECT_EQ(columns.count(), 3) << "u u, u v, v v";
  }
}

TEST(FormModel, HasTheWidthsAndEnergiesOfTheWorkedCloud) {
  const WorkedCloud worked;
  EXPECT_NEAR(worked.width_um(worked.form), 3.335968898, 1e-6);
  EXPECT_NEAR(worked.width_um(worked.errors), 0.811193771, 1e-6);
  const evaluation::FormColumns columns(worked.cloud, Eigen::VectorXd::Ones(28));
  EXPECT_EQ(columns.count() + columns.rigid().cols(), 28);
  std::map<std::pair<int, int>, int> groups;
  for (const evaluation::FormGroup& group : columns.groups())
    ++groups[{group.octave, group.degree_class}];
  const std::map<std::pair<int, int>, int> expected = {
      {{0, 1}, 3}, {{0, 2}, 2}, {{1, 0}, 2}, {{1, 1}, 4}, {{1, 2}, 2}};
  EXPECT_EQ(groups, expected);
  const evaluation::ErrorModel errors(worked.cloud, noise_of(0.3 * kUm));
  const evaluation::FormModel model(worked.cloud, errors, nullptr, 0.5);
  const auto energy = [&](int harmonic, int degree) {
    for (std::size_t g = 0; g < columns.groups().size(); ++g) {
      const evaluation::FormGroup& group = columns.groups()[g];
      if (group.harmonic == harmonic && group.degree == degree) {
        return model.energy_mm2()[static_cast<Eigen::Index>(g)] / std::pow(0.3 * kUm, 2);
      }
    }
    return -1.0;
  };
  EXPECT_NEAR(energy(0, 2), 31.547957, 1e-5);
  EXPECT_NEAR(energy(2, 0), 0.618038, 1e-5);
  EXPECT_NEAR(energy(2, 1), 5.756859, 1e-5);
  EXPECT_NEAR(energy(3, 0), 183.530529, 1e-4);
}

evaluation::FormCloud even_layers(int layers, int points) {
  evaluation::FormCloud cloud;
  cloud.radius_mm = 15.0;
  for (int l = 0; l < layers; ++l) {
    for (int i = 0; i < points; ++i) {
      evaluation::FormPoint p;
      p.angle_rad = core::kTwoPi * i / points + l * core::kTwoPi / (layers * points);
      p.height_mm = 36.0 * l / (layers - 1) - 18.0;
      cloud.points.push_back(p);
    }
  }
  return cloud;
}

TEST(FormModel, HasAsManyColumnsAsThePointsTellApartAndTheyAreOrthogonal) {
  for (const auto& [layers, points, count] :
       {std::tuple(5, 96, 383), std::tuple(4, 360, 1204), std::tuple(10, 500, 1222)}) {
    const evaluation::FormCloud cloud = even_layers(layers, points);
    const auto n = static_cast<Eigen::Index>(cloud.points.size());
    const evaluation::FormColumns columns(cloud, Eigen::VectorXd::Ones(n));
    EXPECT_EQ(columns.count() + columns.rigid().cols(), count);
    EXPECT_TRUE(columns.layout().regular);
  }
  const evaluation::FormCloud cloud = even_layers(4, 28);
  const evaluation::FormColumns columns(cloud, Eigen::VectorXd::Ones(112));
  std::vector<std::size_t> all(columns.groups().size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const Eigen::MatrixXd x = columns.matrix(all);
  const Eigen::MatrixXd gram = x.transpose() * x / 112.0;
  EXPECT_LT((gram - Eigen::MatrixXd::Identity(gram.rows(), gram.cols())).cwiseAbs().maxCoeff(),
            1e-9);
  EXPECT_LT((columns.rigid().transpose() * x).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(FormModel, HasTheValuesOfItsColumnsOnAGrid) {
  const evaluation::FormCloud cloud = even_layers(4, 28);
  const evaluation::FormColumns columns(cloud, Eigen::VectorXd::Ones(112));
  std::vector<std::size_t> all(columns.groups().size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const Eigen::VectorXd c = Eigen::VectorXd::LinSpaced(columns.count(), -1.0, 2.0);
  const Eigen::VectorXd at_points = columns.matrix(all) * c;
  const Eigen::VectorXd heights = Eigen::VectorXd::LinSpaced(4, -18.0, 18.0);
  const evaluation::FormGrid grid = columns.grid(13, 112, heights);
  const Eigen::MatrixXd surface = columns.on_grid(c, grid);
  for (int l = 0; l < 4; ++l) {
    for (int i = 0; i < 28; ++i) {
      EXPECT_NEAR(surface(4 * i + l, l), at_points[28 * l + i], 1e-9);
    }
  }
}

TEST(FormModel, APassOfAScanThatLostPointsIsStillAFullSection) {
  core::KeyedNoise random(7, {});
  for (const int passes : {1, 5}) {
    evaluation::FormCloud cloud;
    cloud.kind = evaluation::FormKind::kRoundness;
    cloud.radius_mm = 25.0;
    cloud.passes = passes;
    for (int pass = 0; pass < passes; ++pass) {
      for (int i = 0; i < 48; ++i) {
        // All lose the same one: where none is lost, gaps are about a step.
        if (i == 20) continue;
        evaluation::FormPoint p;
        p.angle_rad = (7.5 * (i + 0.1 * random.uniform())) * core::kDegree;
        cloud.points.push_back(p);
      }
    }
    const auto n = static_cast<Eigen::Index>(cloud.points.size());
    const evaluation::FormColumns columns(cloud, Eigen::VectorXd::Ones(n));
    EXPECT_FALSE(columns.layout().arc_rad) << passes;
    EXPECT_EQ(columns.layout().points_per_layer, 47) << passes;
    EXPECT_FALSE(columns.layout().regular);
    EXPECT_EQ(columns.most_undulations(), 23) << "what one pass resolves";
  }
}

TEST(FormModel, WeighsGroupsSpotsAndVariancesAsWorked) {
  // A group of two columns, G = n = 1440, w = 0.09, v = 0.01, pi = 0.2, least squares 0.03, -0.02.
  double odds = std::log(0.2 / 0.8);
  for (const double c : {0.03, -0.02}) odds += column_evidence(1440.0 * c, 1440.0, 0.09, 0.01);
  EXPECT_NEAR(odds, 3.867705001, 1e-8);
  for (const auto& [sds, expected] : {std::pair(3.3, 0.00925493), std::pair(4.0, 0.0810781),
                                      std::pair(5.0, 4.67098), std::pair(6.0, 793.717)}) {
    EXPECT_NEAR(std::exp(spot_log_odds(0.3 * sds, 0.09, 0.5 / 1440.0)) / expected, 1.0, 1e-5);
  }
  struct Worked {
    double count, ratio, none, mean;
  };
  for (const Worked& now :
       {Worked{1435, 1.0, 0.978989, 0.0000596}, Worked{1435, 1.1, 0.445019, 0.0050991},
        Worked{1435, 1.3, 0.000000, 0.0271503}, Worked{23, 1.0, 0.843591, 0.0046903},
        Worked{23, 2.0, 0.078680, 0.0990284}}) {
    double mean = 0.0;
    const auto all = variance_odds({0.09, 0.0, 1.0, 0.0}, now.count * now.ratio * 0.09, now.count);
    for (const evaluation::VarianceOdd& one : all) mean += one.probability_1 * one.unresolved_mm2;
    EXPECT_NEAR(all.front().probability_1, now.none, 1e-6);
    EXPECT_NEAR(mean, now.mean, 1e-7);
  }
}

/// A dense cloud: smooth form of 4 um, noise, and what a test adds.
evaluation::FormCloud dense(double sigma_mm, std::uint64_t seed, int points = 96) {
  evaluation::FormCloud cloud = even_layers(5, points);
  core::KeyedNoise noise(seed, {1});
  const double phase = core::kTwoPi * noise.uniform();
  for (evaluation::FormPoint& p : cloud.points) {
    p.deviation_mm = kUm * (1.4 * std::cos(3 * p.angle_rad + phase) +
                            0.6 * std::sin(2 * p.angle_rad) * p.height_mm / 18.0) +
                     sigma_mm * noise.normal();
  }
  return cloud;
}

evaluation::UncertaintyOptions some(int trials) {
  evaluation::UncertaintyOptions options;
  options.least_trials = options.most_trials = trials;
  options.budget_trials = 0;
  options.threads = 2;
  return options;
}

// A real spot of 10 um on 1440 points of 0.2 um noise was taken for noise: [5.74, 6.40] was stated.
TEST(FormModel, NeverShrinksASpot) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    evaluation::FormCloud cloud = dense(0.2 * kUm, seed, 288);
    evaluation::FormCloud without = cloud;
    cloud.points[333].deviation_mm += 10.0 * kUm;
    const auto result =
        measurement_uncertainty(cloud, noise_of(0.2 * kUm), std::nullopt, some(400));
    ASSERT_TRUE(result) << result.error().what;
    EXPECT_GT(result->sampled.low_mm, 9.0 * kUm);
    EXPECT_LT(result->noise_inflation_mm, 1.2 * kUm);
    ASSERT_EQ(result->finding.spot_rows.size(), 1U);
    EXPECT_EQ(result->finding.spot_rows.front(), 333U);
  }
}

TEST(FormModel, LearnsASmoothFormAndLeavesTheNoiseOut) {
  const auto result = measurement_uncertainty(dense(0.3 * kUm, 4, 288), noise_of(0.3 * kUm),
                                              std::nullopt, some(400));
  ASSERT_TRUE(result) << result.error().what;
  EXPECT_LT(result->sampled.expanded_mm(), 0.25 * kUm);
  EXPECT_GT(result->noise_inflation_mm, 0.5 * kUm);
  EXPECT_LT(result->finding.unresolved_mm, 0.05 * kUm);
}

TEST(FormModel, QuotesAnEstimateInsideItsInterval) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const auto result = measurement_uncertainty(dense(1.0 * kUm, seed, 12), noise_of(1.0 * kUm),
                                                std::nullopt, some(200));
    ASSERT_TRUE(result) << result.error().what;
    EXPECT_LE(result->sampled.low_mm, result->sampled.estimate_mm);
    EXPECT_GE(result->sampled.high_mm, result->sampled.estimate_mm);
  }
}

TEST(FormModel, VoidsANoiseDeclaredTooLarge) {
  const auto result = measurement_uncertainty(dense(0.15 * kUm, 1, 288), noise_of(0.3 * kUm),
                                              std::nullopt, some(200));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, core::Code::kInconsistent);
  EXPECT_NE(result.error().what.find("declared were 0.3"), std::string::npos)
      << result.error().what;
}

TEST(FormModel, VoidsPointsWithoutASmoothForm) {
  evaluation::FormCloud cloud = dense(0.1 * kUm, 1);
  core::KeyedNoise noise(7, {2});
  for (evaluation::FormPoint& p : cloud.points) {
    if (noise.uniform() < 0.28) p.deviation_mm += kUm * 100.0 * (noise.uniform() - 0.5);
  }
  const auto result = measurement_uncertainty(cloud, noise_of(0.1 * kUm), std::nullopt, some(200));
  ASSERT_FALSE(result) << result->finding.spots << " spots";
  EXPECT_EQ(result.error().code, core::Code::kOutliers) << result.error().what;
}

// Half of the real noise, from five touches: taken as known, the other half counts as form.
TEST(FormModel, TakesNoiseOfFewRepeatsForLessWellKnown) {
  const evaluation::FormCloud cloud = dense(0.3 * kUm, 1);
  evaluation::Influences few = noise_of(0.15 * kUm);
  few.probe->degrees_of_freedom = 4.0;
  const auto known = measurement_uncertainty(cloud, noise_of(0.15 * kUm), std::nullopt, some(800));
  const auto guessed = measurement_uncertainty(cloud, few, std::nullopt, some(800));
  ASSERT_TRUE(known && guessed);
  const evaluation::FormCloud clean = dense(0.0, 1);
  Eigen::VectorXd form(480);
  for (Eigen::Index i = 0; i < 480; ++i) {
    form[i] = clean.points[static_cast<std::size_t>(i)].deviation_mm;
  }
  const double truth_mm = evaluation::FormValue(clean, clean.points).of(form);
  EXPECT_GT(known->sampled.low_mm, truth_mm);
  EXPECT_LT(guessed->sampled.low_mm, truth_mm);
  EXPECT_GT(guessed->sampled.high_mm, truth_mm);
}

TEST(FormModel, TheWholeSurfaceIsNeverBetterThanItsPoints) {
  for (const int points : {14, 24, 96}) {
    for (const double sigma_mm : {0.1 * kUm, 0.5 * kUm}) {
      const auto result = measurement_uncertainty(dense(sigma_mm, 1, points), noise_of(sigma_mm),
                                                  evaluation::FormSpectrum{}, some(400));
      ASSERT_TRUE(result) << result.error().what;
      EXPECT_LE(result->sampled.low_mm, result->whole->low_mm);
      EXPECT_LE(result->sampled.estimate_mm, result->whole->estimate_mm);
      EXPECT_LE(result->sampled.high_mm, result->whole->high_mm);
    }
  }
}

TEST(FormModel, StaysTheSameWhenThePartIsShiftedAndTurned) {
  const evaluation::FormCloud cloud = dense(0.3 * kUm, 2, 24);
  evaluation::FormCloud moved = cloud;
  for (evaluation::FormPoint& p : moved.points) {
    p.angle_rad += core::kTwoPi / 5.0;
    p.deviation_mm +=
        kUm * (3.0 + 2.0 * std::cos(p.angle_rad) + 0.1 * p.height_mm * std::sin(p.angle_rad));
  }
  const auto one = measurement_uncertainty(cloud, noise_of(0.3 * kUm), std::nullopt, some(1600));
  const auto two = measurement_uncertainty(moved, noise_of(0.3 * kUm), std::nullopt, some(1600));
  ASSERT_TRUE(one && two);
  const double near =
      2.0 * (one->sampled.numerical_tolerance_mm + two->sampled.numerical_tolerance_mm);
  EXPECT_NEAR(one->sampled.estimate_mm, two->sampled.estimate_mm, near);
  EXPECT_NEAR(one->sampled.high_mm, two->sampled.high_mm, near);
}

}  // namespace
}  // namespace rondure::reports
