// Properties and oracles of measurement_uncertainty(); how often its interval holds the truth:
// coverage_test.cpp.
#include "evaluation/uncertainty/uncertainty.h"
#include "evaluation/uncertainty/internal/error_modes.h"
#include "evaluation/uncertainty/internal/sampler.h"
#include "evaluation/uncertainty/kept_draws.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <string_view>

#include <gtest/gtest.h>

#include "core/noise.h"
#include "core/units.h"
#include "fit/least_squares/cylinder.h"
#include "fit/references/one_sided.h"
#include "fit/zone/fit.h"
#include "tests/core/full.h"
#include "tests/core/processor_time.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

using Eigen::Vector3d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A shaft of 50 mm, its axis along z, with 10 um of lobes, taper and barrel and a trace of noise.
evaluation::FormCloud shaft(int layers, int points, double form_mm = 10e-3) {
  evaluation::FormCloud cloud;
  cloud.radius_mm = 25.0;
  core::KeyedNoise noise(7, {1});
  const int count = layers * points;
  for (int j = 0; j < layers; ++j) {
    for (int i = 0; i < points; ++i) {
      evaluation::FormPoint p;
      p.angle_rad = core::kTwoPi * (static_cast<double>(i) / points + 0.3 * j / points);
      p.height_mm = 70.0 * j / std::max(1, layers - 1) - 35.0;
      const double q = p.height_mm / 35.0;
      p.deviation_mm = form_mm * (0.25 * std::cos(2.0 * p.angle_rad + 0.5 * q) +
                                  0.15 * std::cos(3.0 * p.angle_rad + 1.0) + 0.1 * q + 0.1 * q * q +
                                  0.03 * noise.normal());
      p.time_1 = static_cast<double>(cloud.points.size()) / (count - 1);
      cloud.points.push_back(p);
    }
  }
  return cloud;
}

/// A cloud about its least-squares axis, as measured clouds are.
evaluation::FormCloud centred(evaluation::FormCloud cloud) {
  const Eigen::MatrixXd rigid = rigid_basis(cloud);
  Eigen::VectorXd deviations(rigid.rows());
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    deviations[static_cast<Eigen::Index>(i)] = cloud.points[i].deviation_mm;
  }
  deviations -= rigid * (rigid.transpose() * deviations);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    cloud.points[i].deviation_mm = deviations[static_cast<Eigen::Index>(i)];
  }
  return cloud;
}

evaluation::Influences repeatability(double sigma_mm) {
  evaluation::Influences out;
  out.probe = evaluation::ProbeInfluences{};
  out.probe->repeatability_mm = sigma_mm;
  return out;
}

/// All that can be declared, at the size of a good machine.
evaluation::Influences everything() {
  evaluation::Influences out = repeatability(0.8e-3);
  out.probe->lobes = {{3, 0.4e-3, 0.0}, {2, 0.1e-3, 0.0}};
  out.probe->form_limit_mm = 1e-3;
  out.probe->tip_radius_mm = 0.3e-3;
  out.machine = evaluation::MachineInfluences{};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      out.machine->terms.axes[k].translation[c] = {3e-6, 1e-9, 0.3e-3, 120.0, 0.0};
      out.machine->terms.axes[k].rotation[c] = {3e-9, 1e-12, 1e-6, 400.0, 0.0};
    }
  }
  out.machine->terms.squareness_xy_rad = out.machine->terms.squareness_xz_rad = 4e-6;
  out.machine->terms.squareness_yz_rad = 3e-6;
  out.machine->terms.tip_offset_mm = Vector3d(0.0, 0.0, -150.0);
  out.machine->length_limit_mm = 1e-3;
  out.machine->length_limit_slope = 3e-6;
  out.thermal =
      evaluation::ThermalInfluences{0.3, 11.5e-6, 1e-6, 1.0, 0.2, Vector3d::Constant(0.4e-3)};
  out.fixture = evaluation::FixtureInfluences{1e-4, 2e-3, 3e-6, Vector3d(0.0, 0.0, -80.0)};
  return out;
}

evaluation::FormSpectrum spectrum() {
  evaluation::FormSpectrum out;
  out.low_mm = -40.0;
  out.high_mm = 40.0;
  out.source = core::Phrase("declared");
  out.terms = {{0, 1, 0.8e-3}, {0, 2, 0.6e-3}, {1, 2, 0.6e-3}};
  for (int p = 2; p <= 7; ++p) {
    for (int degree = 0; degree <= 2; ++degree) {
      out.terms.push_back({p, degree, 2.0e-3 / p * std::pow(0.4, degree)});
    }
  }
  return out;
}

evaluation::UncertaintyOptions trials(int most, int budget = 0) {
  evaluation::UncertaintyOptions options;
  options.least_trials = std::max(100, most / 4);
  options.most_trials = most;
  options.budget_trials = budget;
  options.threads = 2;
  return options;
}

evaluation::UncertaintyResult found(
    const evaluation::FormCloud& cloud, const evaluation::Influences& influences,
    const evaluation::UncertaintyOptions& options,
    const std::optional<evaluation::FormSpectrum>& stated = std::nullopt) {
  const auto result = measurement_uncertainty(cloud, influences, stated, options);
  EXPECT_TRUE(result.has_value()) << (result ? "" : result.error().what);
  return result.value_or(evaluation::UncertaintyResult{});
}

const evaluation::BudgetLine& line(const evaluation::UncertaintyResult& result,
                                   const std::string& name) {
  const auto at = std::find_if(result.budget.begin(), result.budget.end(),
                               [&](const evaluation::BudgetLine& one) { return one.name == name; });
  EXPECT_NE(at, result.budget.end()) << name;
  return *at;
}

void expect_equal(const evaluation::UncertaintyStatement& a,
                  const evaluation::UncertaintyStatement& b) {
  EXPECT_EQ(a.estimate_mm, b.estimate_mm);
  EXPECT_EQ(a.low_mm, b.low_mm);
  EXPECT_EQ(a.high_mm, b.high_mm);
  EXPECT_EQ(a.standard_uncertainty_mm, b.standard_uncertainty_mm);
}

TEST(Uncertainty, WithoutInfluencesTheSampledPointsHaveTheirValueAndNoWidth) {
  evaluation::Influences zeros = repeatability(0.0);
  zeros.machine = evaluation::MachineInfluences{};
  zeros.thermal = evaluation::ThermalInfluences{};
  zeros.fixture = evaluation::FixtureInfluences{};
  constexpr double kNear_mm = 5e-8;  // 0.01 nm of noise keep the variances positive
  const auto result = found(centred(shaft(4, 7)), zeros, trials(400, 100));
  EXPECT_NEAR(result.sampled.low_mm, result.uncorrected_mm, kNear_mm);
  EXPECT_NEAR(result.sampled.high_mm, result.uncorrected_mm, kNear_mm);
  EXPECT_NEAR(result.noise_inflation_mm, 0.0, kNear_mm);
  for (const evaluation::BudgetLine& each : result.budget)
    EXPECT_EQ(each.standard_uncertainty_mm, 0.0);
}

TEST(Uncertainty, WithoutAKnownNoiseThereAreOnlyBounds) {
  evaluation::Influences unknown = repeatability(0.0);
  unknown.probe->repeatability_known = false;
  for (const evaluation::Influences& none : {evaluation::Influences{}, unknown}) {
    const auto result = measurement_uncertainty(shaft(4, 7), none, std::nullopt, trials(400));
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().code, core::Code::kMeaning);
    EXPECT_NE(result.error().what.find("without a probability"), std::string::npos)
        << result.error().what;
  }
}

TEST(Uncertainty, APerfectPartMeasuredPerfectlyIsZero) {
  const auto result = found(shaft(4, 7, 0.0), repeatability(0.0), trials(400));
  EXPECT_NEAR(result.sampled.high_mm, 0.0, 1e-7);
}

TEST(Uncertainty, GrowsWithFormAndErrorsAlike) {
  evaluation::Influences larger = repeatability(2e-3);
  larger.probe->lobes = {{3, 1e-3, 0.0}};
  evaluation::Influences smaller = repeatability(1e-3);
  smaller.probe->lobes = {{3, 0.5e-3, 0.0}};
  evaluation::FormSpectrum known = spectrum();
  known.absolute = true;
  evaluation::FormSpectrum doubled = known;
  for (evaluation::FormTerm& term : doubled.terms) term.amplitude_mm *= 2.0;
  const auto one = found(shaft(4, 7, 10e-3), smaller, trials(600), known);
  const auto two = found(shaft(4, 7, 20e-3), larger, trials(600), doubled);
  const double near = 2e-3 * two.sampled.estimate_mm;  // form / radius, of second order
  EXPECT_NEAR(two.sampled.estimate_mm, 2.0 * one.sampled.estimate_mm, near);
  EXPECT_NEAR(two.sampled.low_mm, 2.0 * one.sampled.low_mm, near);
  EXPECT_NEAR(two.sampled.high_mm, 2.0 * one.sampled.high_mm, near);
  EXPECT_NEAR(two.whole->estimate_mm, 2.0 * one.whole->estimate_mm, near);
  EXPECT_NEAR(two.whole->high_mm, 2.0 * one.whole->high_mm, near);
}

TEST(Uncertainty, HasTheSameNumbersAtAnyThreadCount) {
  evaluation::UncertaintyOptions options = trials(test::cases(401, 1001), 101);
  options.threads = 1;
  const auto one = found(shaft(4, 7), everything(), options, spectrum());
  for (const int threads : {2, 3, 8}) {
    SCOPED_TRACE(threads);
    options.threads = threads;
    const auto many = found(shaft(4, 7), everything(), options, spectrum());
    expect_equal(one.sampled, many.sampled);
    expect_equal(*one.whole, *many.whole);
    ASSERT_EQ(one.budget.size(), many.budget.size());
    for (std::size_t k = 0; k < one.budget.size(); ++k) {
      EXPECT_EQ(one.budget[k].name, many.budget[k].name);
      EXPECT_EQ(one.budget[k].standard_uncertainty_mm, many.budget[k].standard_uncertainty_mm);
      EXPECT_EQ(one.budget[k].shift_mm, many.budget[k].shift_mm);
    }
  }
}

TEST(Uncertainty, TakesKeptDrawsBitForBitAndRefusesThoseOfAnotherShape) {
  evaluation::UncertaintyOptions options = trials(401, 101);
  options.tolerance_mm = 1e-5;
  const auto asked = [&] { return found(shaft(4, 7), everything(), options, spectrum()); };
  KeptDraws made;
  const auto drawn = [&] {
    const UseOfDraws use(made);
    return asked();
  }();
  ASSERT_FALSE(made.bytes().empty());
  const auto expect_as_drawn = [&](std::string_view known, bool taken) {
    KeptDraws draws(known);
    const auto again = [&] {
      const UseOfDraws use(draws);
      return asked();
    }();
    EXPECT_EQ(draws.bytes().empty(), taken) << "whether nothing was drawn";
    expect_equal(drawn.sampled, again.sampled);
    expect_equal(*drawn.whole, *again.whole);
    EXPECT_EQ(drawn.sampled.values_mm, again.sampled.values_mm);
    EXPECT_EQ(drawn.noise_inflation_mm, again.noise_inflation_mm);
    EXPECT_EQ(drawn.tolerance_reached, again.tolerance_reached);
    EXPECT_EQ(drawn.finding.groups, again.finding.groups);
    EXPECT_EQ(line(drawn, "sampling").shift_mm, line(again, "sampling").shift_mm);
  };
  expect_as_drawn(made.bytes(), true);
  expect_as_drawn(std::string_view(made.bytes()).substr(0, made.bytes().size() - 1), false);
  expect_as_drawn(std::string_view(made.bytes()).substr(8), false);
  EXPECT_EQ(UseOfDraws::current(), nullptr);
}

TEST(Uncertainty, ChangesWithTheSeedByNoMoreThanItsNumericalTolerance) {
  evaluation::UncertaintyOptions options = trials(test::cases(2000, 8000));
  const auto one = found(shaft(4, 7), everything(), options);
  options.seed = 2;
  const auto two = found(shaft(4, 7), everything(), options);
  EXPECT_NE(one.sampled.low_mm, two.sampled.low_mm);
  const double near =
      2.0 * (one.sampled.numerical_tolerance_mm + two.sampled.numerical_tolerance_mm);
  EXPECT_NEAR(one.sampled.estimate_mm, two.sampled.estimate_mm, near);
  EXPECT_NEAR(one.sampled.low_mm, two.sampled.low_mm, near);
  EXPECT_NEAR(one.sampled.high_mm, two.sampled.high_mm, near);
}

TEST(Uncertainty, DoesNotDependOnTheOrderOfThePoints) {
  evaluation::FormCloud turned = shaft(4, 7);
  std::reverse(turned.points.begin(), turned.points.end());
  const auto options = trials(test::cases(600, 8000));
  const auto one = found(shaft(4, 7), everything(), options, spectrum());
  const auto two = found(turned, everything(), options, spectrum());
  EXPECT_NEAR(one.uncorrected_mm, two.uncorrected_mm, 1e-10);
  const double near =
      2.0 * (one.sampled.numerical_tolerance_mm + two.sampled.numerical_tolerance_mm);
  EXPECT_NEAR(one.sampled.estimate_mm, two.sampled.estimate_mm, near);
  EXPECT_NEAR(one.sampled.high_mm, two.sampled.high_mm, near);
  const double near_whole =
      2.0 * (one.whole->numerical_tolerance_mm + two.whole->numerical_tolerance_mm);
  EXPECT_NEAR(one.whole->estimate_mm, two.whole->estimate_mm, near_whole);
}

TEST(Uncertainty, RepeatsAverageThatOfTheProbeAndNothingElse) {
  evaluation::FormCloud repeated = shaft(4, 7);
  for (evaluation::FormPoint& point : repeated.points) point.repeats = 4;
  const auto one = found(shaft(4, 7), repeatability(1e-3), trials(600));
  const auto four = found(repeated, repeatability(2e-3), trials(600));
  expect_equal(one.sampled, four.sampled);
  evaluation::Influences lobes = repeatability(0.0);
  lobes.probe->lobes = {{3, 1e-3, 0.0}};
  expect_equal(found(shaft(4, 7), lobes, trials(600)).sampled,
               found(repeated, lobes, trials(600)).sampled);
}

TEST(Uncertainty, WhatMovesThePartAsAWholeMovesNoForm) {
  evaluation::Influences still = repeatability(0.5e-3);
  still.probe->tip_radius_mm = 2e-3;
  still.thermal = evaluation::ThermalInfluences{};
  still.thermal->temperature_K = 1.0;
  still.thermal->expansion_1_K = 11.5e-6;
  still.fixture = evaluation::FixtureInfluences{};
  still.fixture->angle_rad = 1e-3;
  still.fixture->position_mm = 0.1;
  const auto one_pose = found(shaft(4, 7), still, trials(400, 200));
  EXPECT_NEAR(line(one_pose, "tip-qualification").standard_uncertainty_mm, 0.0, 1e-9);
  EXPECT_NEAR(line(one_pose, "fixture-calibration").standard_uncertainty_mm, 0.0, 1e-9);
  EXPECT_LT(line(one_pose, "temperature").standard_uncertainty_mm, 1e-6);
  evaluation::FormCloud two_poses = shaft(4, 7);
  for (std::size_t i = 0; i < 14; ++i) two_poses.points[i].pose = 1;
  const auto put_together = found(two_poses, still, trials(400, 200));
  EXPECT_GT(line(put_together, "fixture-calibration").standard_uncertainty_mm, 1e-3);
}

// One draw of an influence moves all surfaces of a part: its column over the points of two is that
// of each, one below the other.
TEST(Uncertainty, AnInfluenceActsOnTwoSurfacesAsOnEachAlone) {
  evaluation::FormCloud bore = shaft(2, 5);
  bore.outside = false;
  bore.radius_mm = 12.0;
  bore.axis.point_mm = {30.0, -10.0, 80.0};
  const auto first = touched_points(shaft(3, 7));
  const auto second = touched_points(bore);
  auto both = first;
  both.insert(both.end(), second.begin(), second.end());

  evaluation::Influences influences;
  influences.probe.emplace();
  influences.probe->repeatability_mm = 0.3e-3;
  influences.probe->lobes = {{3, 0.4e-3, 0.0}};
  influences.probe->tip_radius_mm = 0.2e-3;
  influences.machine.emplace();
  influences.machine->terms.squareness_xz_rad = 5e-6;
  influences.machine->terms.axes[1].translation[1].linear_1_mm = 1e-6;
  influences.thermal.emplace();
  influences.thermal->expansion_1_K = 11.5e-6;
  influences.thermal->temperature_K = 0.1;
  influences.thermal->drift_K = 0.2;

  const DeclaredModes of_both = declared_modes(both, influences);
  const DeclaredModes of_first = declared_modes(first, influences);
  const DeclaredModes of_second = declared_modes(second, influences);
  ASSERT_EQ(of_both.names, of_first.names);
  ASSERT_EQ(of_both.columns.size(), of_first.columns.size());
  ASSERT_GT(of_both.columns.size(), 5U);
  const auto n = static_cast<Eigen::Index>(first.size());
  const auto m = static_cast<Eigen::Index>(second.size());
  for (std::size_t k = 0; k < of_both.columns.size(); ++k) {
    SCOPED_TRACE(k);
    EXPECT_EQ(of_both.columns[k].head(n), of_first.columns[k]);
    EXPECT_EQ(of_both.columns[k].tail(m), of_second.columns[k]);
  }
  ASSERT_EQ(of_both.point_errors.size(), 1U);
  EXPECT_EQ(of_both.point_errors[0].sigma_mm.size(), n + m);
}

TEST(Uncertainty, RanksTheInfluencesAndNamesWhatIsNotCovered) {
  evaluation::Influences noisy = repeatability(2e-3);
  noisy.probe->lobes = {{3, 0.3e-3, 0.0}};
  const auto result = found(shaft(4, 7), noisy, trials(2000, 1000), spectrum());
  const auto& first = result.budget.front();
  EXPECT_TRUE(first.name == "probe-repeatability" || first.name == "sampling") << first.name;
  double shares = 0.0;
  for (std::size_t k = 0; k < result.budget.size(); ++k) {
    const evaluation::BudgetLine& each = result.budget[k];
    if (each.measurand == evaluation::Measurand::kSampledPoints) shares += each.share_1;
    if (k > 0) {
      EXPECT_LE(each.standard_uncertainty_mm, result.budget[k - 1].standard_uncertainty_mm);
    }
  }
  EXPECT_NEAR(shares, 1.0, 1e-12);
  EXPECT_GT(line(result, "probe-repeatability").shift_mm, 0.5e-3);  // noise makes it look worse
  EXPECT_GT(result.noise_inflation_mm, 0.0);
  EXPECT_LT(line(result, "sampling").shift_mm, 0.0);  // sparse points make it look better
  EXPECT_LT(*result.sampling_loss_mm, 0.0);
  EXPECT_DOUBLE_EQ(result.uncorrected_mm, result.whole->estimate_mm + result.noise_inflation_mm +
                                              *result.sampling_loss_mm);
  for (const evaluation::InfluenceStatement& each : result.declaration) {
    EXPECT_EQ(each.covered, each.name.starts_with("probe-") || each.name == "tip-qualification" ||
                                each.name == "probing-form-limit")
        << each.name;
    EXPECT_FALSE(each.text.empty());
  }
}

// Small errors on a large form: the zone follows its contacts, W = sum of multiplier times
// deviation, so u = sigma sqrt(sum of multipliers squared).
TEST(Uncertainty, AgreesWithTheMultipliersOfTheContactsWhereErrorsAreSmall) {
  const double sigma = 1e-6;
  const evaluation::FormCloud cloud = shaft(4, 7);
  std::vector<Vector3d> points;
  for (const evaluation::FormPoint& p : cloud.points) points.push_back(position_mm(cloud, p));
  fit::CylinderZoneFitter fitter;
  const auto zone = fitter.fit_from(points, fit::Axis{});
  double square = 0.0;
  for (const auto* side : {&zone.outer, &zone.inner}) {
    for (const fit::Contact& contact : *side) square += contact.multiplier * contact.multiplier;
  }
  // Of fewer trials 3.3 standard deviations of a standard deviation.
  const int count = test::cases(4000, 20000);
  const auto result = found(cloud, repeatability(sigma), trials(count));
  const double near = test::full() ? 0.02 : 3.3 * std::sqrt(square / (2.0 * count));
  EXPECT_NEAR(result.sampled.standard_uncertainty_mm, sigma * std::sqrt(square), near * sigma);
  EXPECT_NEAR(result.sampled.estimate_mm, zone.width_mm(), 0.05 * sigma);
}

/// Radial peak to valley about a reference, by the fits that report it.
double reported_mm(const evaluation::FormCloud& cloud) {
  std::vector<Vector3d> points;
  for (const evaluation::FormPoint& p : cloud.points) points.push_back(position_mm(cloud, p));
  if (cloud.reference == record::Reference::kLeastSquares) {
    return fit::ls_cylinder(points, Vector3d::UnitZ())->deviation_mm;
  }
  const auto fit = cloud.reference == record::Reference::kMinimumCircumscribed
                       ? fit::min_circumscribed_cylinder(points, Vector3d::UnitZ())
                       : fit::max_inscribed_cylinder(points, Vector3d::UnitZ());
  return fit->deviation_mm;
}

TEST(Uncertainty, AgreesWithTheSlopesOfEveryReferenceWhereErrorsAreSmall) {
  const double sigma = 1e-6;
  for (const auto reference :
       {record::Reference::kLeastSquares, record::Reference::kMinimumCircumscribed,
        record::Reference::kMaximumInscribed}) {
    SCOPED_TRACE(static_cast<int>(reference));
    evaluation::FormCloud cloud = shaft(4, 7);
    cloud.reference = reference;
    double square = 0.0;
    for (evaluation::FormPoint& point : cloud.points) {
      const double middle = point.deviation_mm;
      point.deviation_mm = middle + sigma;
      const double above = reported_mm(cloud);
      point.deviation_mm = middle - sigma;
      square += std::pow((above - reported_mm(cloud)) / (2.0 * sigma), 2);
      point.deviation_mm = middle;
    }
    constexpr int kTrials = 4000;
    const auto result = found(cloud, repeatability(sigma), trials(kTrials));
    const double spread = sigma * std::sqrt(square);
    EXPECT_NEAR(result.uncorrected_mm, reported_mm(cloud), 1e-9);
    // 3.3 standard deviations of a standard deviation and of a mean of so many trials.
    EXPECT_NEAR(result.sampled.standard_uncertainty_mm, spread,
                3.3 * spread / std::sqrt(2.0 * kTrials));
    EXPECT_NEAR(result.sampled.estimate_mm, result.uncorrected_mm,
                3.3 * spread / std::sqrt(1.0 * kTrials));
  }
}

// Four points a quarter apart have one degree of freedom beside place and size, z = (d1 - d2 + d3 -
// d4)/2, with the standard deviation of a point, and the zone |z|. One number cannot show how large
// form is: the true z is z +- sigma. A prior for it made 21 % of parts above their limit conform.
double four_points_below(double v, double z, double sigma) {
  const auto normal_below = [](double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); };
  return normal_below((v - z) / sigma) - normal_below((-v - z) / sigma);
}

TEST(Uncertainty, AgreesWithTheClosedFormOfFourPoints) {
  const double sigma = 1e-3;
  for (const double z : {0.2e-3, 1e-3, 2e-3}) {
    SCOPED_TRACE(z);
    evaluation::FormCloud cloud;
    cloud.kind = evaluation::FormKind::kRoundness;
    cloud.radius_mm = 25.0;
    for (int i = 0; i < 4; ++i) {
      evaluation::FormPoint p;
      p.angle_rad = 0.25 * core::kTwoPi * i + 0.1;
      p.deviation_mm = 0.5 * z * (i % 2 == 0 ? 1.0 : -1.0);
      cloud.points.push_back(p);
    }
    const auto result = found(cloud, repeatability(sigma), trials(40000));
    EXPECT_NEAR(result.uncorrected_mm, z, 1e-9);
    EXPECT_NEAR(four_points_below(result.sampled.high_mm, z, sigma), 0.975, 0.005);
    const auto& values = result.sampled.values_mm;
    for (const double v : {1e-9, 0.5 * sigma, sigma, 2.0 * sigma}) {
      const auto below = std::lower_bound(values.begin(), values.end(), v) - values.begin();
      EXPECT_NEAR(static_cast<double>(below) / static_cast<double>(values.size()),
                  four_points_below(v, z, sigma), 0.015)
          << v;
    }
  }
}

TEST(Uncertainty, OfDensePointsTheWholeSurfaceIsNearlyWhatWasMeasured) {
  const auto sparse = found(shaft(4, 7), repeatability(0.1e-3), trials(400), spectrum());
  const auto dense = found(shaft(8, 24), repeatability(0.1e-3), trials(400), spectrum());
  EXPECT_LT(dense.whole->expanded_mm(), 0.5 * sparse.whole->expanded_mm());
  EXPECT_LT(std::abs(*dense.sampling_loss_mm), std::abs(*sparse.sampling_loss_mm));
}

TEST(Uncertainty, TakesTheSpectrumFromThePartItselfWhereLayersAreDense) {
  const evaluation::FormSpectrum own;
  const auto result = found(shaft(6, 60), repeatability(0.3e-3), trials(400), own);
  EXPECT_LT(std::abs(*result.sampling_loss_mm), 1e-3);
  for (const evaluation::FormCloud& sparse : {shaft(4, 7), shaft(2, 60), shaft(3, 13)}) {
    const auto none = measurement_uncertainty(sparse, repeatability(0.3e-3), own, trials(200));
    ASSERT_FALSE(none.has_value());
    EXPECT_EQ(none.error().code, core::Code::kSampling) << none.error().what;
  }
}

TEST(Uncertainty, StopsWhenTheNumericalToleranceIsReached) {
  evaluation::UncertaintyOptions options = trials(20000);
  options.least_trials = 400;
  options.tolerance_mm = 0.1e-3;
  const auto coarse = found(shaft(4, 7), repeatability(1e-3), options);
  EXPECT_TRUE(coarse.tolerance_reached);
  EXPECT_LE(coarse.sampled.numerical_tolerance_mm, options.tolerance_mm);
  options.tolerance_mm = 0.06e-3;
  const auto fine = found(shaft(4, 7), repeatability(1e-3), options);
  EXPECT_TRUE(fine.tolerance_reached);
  EXPECT_GT(fine.trials, coarse.trials);
  options.tolerance_mm = 1e-9;
  options.most_trials = 1000;
  const auto never = found(shaft(4, 7), repeatability(1e-3), options);
  EXPECT_FALSE(never.tolerance_reached);
  EXPECT_EQ(never.trials, 1000);
}

TEST(Uncertainty, ASimulatedInspectionHasTheFormAndTheErrorsThatWereStated) {
  evaluation::FormSpectrum oval = spectrum();
  oval.terms = {{2, 0, 3e-3}};
  const evaluation::ErrorModel errors(shaft(4, 7), repeatability(1e-3));
  double square = 0.0;
  const int parts = 400;
  for (int seed = 0; seed < parts; ++seed) {
    const auto deviations_mm =
        simulated_deviations(shaft(4, 7), errors, oval, static_cast<std::uint64_t>(seed));
    ASSERT_TRUE(deviations_mm.has_value());
    square += deviations_mm->squaredNorm();
  }
  // The oval in 28 points, the noise in 23 dimensions beside place and size.
  const double expected = 28.0 * 9e-6 + 23.0 * 1e-6;
  EXPECT_NEAR(square / parts, expected, 0.15 * expected);
  EXPECT_EQ(simulated_deviations(evaluation::FormCloud{}, errors, oval, 1).error().code,
            core::Code::kBadOption);
}

TEST(Uncertainty, FindsTheCloudOfPointsInSpace) {
  const evaluation::FormCloud made = shaft(4, 7);
  std::vector<Vector3d> points;
  for (const evaluation::FormPoint& p : made.points) points.push_back(position_mm(made, p));
  const auto cloud = form_cloud(evaluation::FormKind::kCylindricity, points, Vector3d::UnitZ());
  ASSERT_TRUE(cloud.has_value());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_LT((position_mm(*cloud, cloud->points[i]) - points[i]).norm(), 1e-12);
  }
  EXPECT_NEAR(found(*cloud, repeatability(0.0), trials(200)).uncorrected_mm,
              found(made, repeatability(0.0), trials(200)).uncorrected_mm, 1e-8);
}

/// What a test spoils before it asks.
struct Question {
  evaluation::FormCloud cloud = shaft(4, 7);
  evaluation::Influences influences = everything();
  evaluation::FormSpectrum form = spectrum();
  evaluation::UncertaintyOptions options = trials(200);

  evaluation::ProbeInfluences& probe() { return *influences.probe; }
  cmm::GeometricErrors& terms() { return influences.machine->terms; }
};

struct Refusal {
  const char* what;
  core::Code code;
  std::function<void(Question&)> spoil;
};

TEST(Uncertainty, RefusesWhatItCannotUse) {
  using core::Code;
  const std::vector<Refusal> refusals = {
      {"nothing", Code::kTooFewPoints, [](Question& now) { now.cloud.points.clear(); }},
      {"5 points", Code::kTooFewPoints, [](Question& now) { now.cloud.points.resize(5); }},
      {"one layer", Code::kRank, [](Question& now) { now.cloud.points.resize(7); }},
      {"nan", Code::kNotFinite, [](Question& now) { now.cloud.points[3].deviation_mm = kNan; }},
      {"no touch", Code::kBadOption, [](Question& now) { now.cloud.points[3].repeats = 0; }},
      {"time", Code::kBadOption, [](Question& now) { now.cloud.points[3].time_1 = 1.5; }},
      {"radius", Code::kBadOption, [](Question& now) { now.cloud.radius_mm = 0.0; }},
      {"negative", Code::kBadOption, [](Question& now) { now.probe().repeatability_mm = -1e-3; }},
      {"u nan", Code::kBadOption, [](Question& now) { now.probe().tip_radius_mm = kNan; }},
      {"lobe", Code::kBadOption, [](Question& now) { now.probe().lobes[0].amplitude_mm = -1.0; }},
      {"period", Code::kBadOption,
       [](Question& now) { now.terms().axes[0].translation[0].period_mm = 0.0; }},
      {"squareness", Code::kBadOption, [](Question& now) { now.terms().squareness_xy_rad = kNan; }},
      {"limit", Code::kBadOption,
       [](Question& now) { now.influences.machine->length_limit_mm = -1.0; }},
      {"drift", Code::kBadOption, [](Question& now) { now.influences.thermal->drift_K = -0.1; }},
      {"creep", Code::kBadOption, [](Question& now) { now.influences.fixture->creep_rad = -1e-6; }},
      {"pivot", Code::kBadOption,
       [](Question& now) { now.influences.fixture->pivot_mm = Vector3d(kNan, 0.0, 0.0); }},
      {"no terms", Code::kSampling, [](Question& now) { now.form.terms.clear(); }},
      {"tilt", Code::kBadOption,
       [](Question& now) {
         now.form.terms.push_back({1, 1, 1e-3});
       }},
      {"term", Code::kBadOption,
       [](Question& now) {
         now.form.terms.push_back({2, 0, -1e-3});
       }},
      {"lobes", Code::kBadOption,
       [](Question& now) {
         now.form.terms.push_back({2000, 0, 1e-3});
       }},
      {"grid", Code::kBadOption,
       [](Question& now) {
         now.form.terms.push_back({200, 20, 1e-3});
       }},
      {"coefficients", Code::kBadOption,
       [](Question& now) {
         now.form.terms.resize(210, {2, 0, 1e-3});
       }},
      {"ends", Code::kBadOption, [](Question& now) { now.form.high_mm = now.form.low_mm; }},
      {"zero trials", Code::kBadOption, [](Question& now) { now.options.most_trials = 0; }},
      {"chains", Code::kBadOption, [](Question& now) { now.options.chains = 0; }},
      {"few trials", Code::kBadOption, [](Question& now) { now.options.least_trials = 99; }},
      {"spots", Code::kBadOption, [](Question& now) { now.options.expected_spots = 0.0; }},
      {"freedom", Code::kBadOption, [](Question& now) { now.probe().degrees_of_freedom = -1.0; }},
      {"budget", Code::kBadOption, [](Question& now) { now.options.budget_trials = 1; }},
      {"tolerance", Code::kBadOption, [](Question& now) { now.options.tolerance_mm = -1.0; }},
      {"coverage", Code::kBadOption, [](Question& now) { now.options.coverage = 95.0; }},
      {"threads", Code::kBadOption, [](Question& now) { now.options.threads = -1; }},
  };
  Question good;
  EXPECT_TRUE(measurement_uncertainty(good.cloud, good.influences, good.form, good.options));
  for (const Refusal& refusal : refusals) {
    SCOPED_TRACE(refusal.what);
    Question now;
    if (test::full()) {
      EXPECT_TRUE(measurement_uncertainty(now.cloud, now.influences, now.form, now.options));
    }
    refusal.spoil(now);
    const auto result = measurement_uncertainty(now.cloud, now.influences, now.form, now.options);
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().code, refusal.code) << result.error().what;
    EXPECT_FALSE(result.error().what.empty());
  }
}

/// Processor time of one minimum zone of 28 points, in which the speed of a machine is told.
double zone_s() {
  constexpr int kZones = 20'000;
  std::vector<Vector3d> points;
  for (int i = 0; i < 28; ++i) {
    const double angle = core::kTwoPi * (i % 7) / 7.0;
    const double r = 25.0 + 3e-3 * std::cos(3.0 * angle + i);
    points.emplace_back(r * std::cos(angle), r * std::sin(angle), 20.0 * (i / 7));
  }
  fit::CylinderZoneFitter fitter;
  const double before_s = test::processor_seconds();
  for (int i = 0; i < kZones; ++i) {
    points.front().x() += 1e-9;
    EXPECT_TRUE(fitter.fit(points, Vector3d::UnitZ()));
  }
  return (test::processor_seconds() - before_s) / kZones;
}

// The figure: 10 000 trials of 28 points with all influences in under 1 s on two cores, 2 s of
// processor time, on a machine that finds a zone in 5.2 us. With the whole surface too it is not
// met (docs/developer/accuracy.md): that may take as much again, and no more.
TEST(Uncertainty, DoesTenThousandTrialsOfTwentyEightPointsInASecondOfTwoCores) {
  const auto timed = [&](int threads, const std::optional<evaluation::FormSpectrum>& stated) {
    evaluation::UncertaintyOptions options =
        trials(test::cases(1000, 10000), test::cases(100, 1000));
    options.threads = threads;
    const double used_s = test::processor_seconds();
    const auto start = std::chrono::steady_clock::now();
    const auto result = found(shaft(4, 7), everything(), options, stated);
    const double took =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const double processor = test::processor_seconds() - used_s;
    std::printf("%d trials%s, %d thread(s), budget included: %.3f s, of the processors %.3f s\n",
                result.trials, stated ? ", whole surface too" : "", threads, took, processor);
    return processor;
  };
  // The least of three: what else runs on the machine can only add to it.
  const double zone = std::min({zone_s(), zone_s(), zone_s()});
  const auto least = [&](const std::optional<evaluation::FormSpectrum>& stated) {
    return std::min({timed(2, stated), timed(2, stated), timed(2, stated)});
  };
  timed(1, std::nullopt);
  const double sampled = least(std::nullopt);
  timed(1, spectrum());
  const double both = least(spectrum());
#ifndef __SANITIZE_ADDRESS__
  std::printf("a zone %.2f us, a trial %.1f zones\n", 1e6 * zone,
              sampled / test::cases(1000, 10000) / zone);
  EXPECT_LT(sampled, 2.0 * zone / 5.2e-6);
  EXPECT_LT(both, 2.0 * sampled);
#else
  EXPECT_GT(sampled + both + zone, 0.0);
#endif
}

}  // namespace
}  // namespace rondure::reports
