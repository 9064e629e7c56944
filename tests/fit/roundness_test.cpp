#include "fit/profiles/roundness.h"

#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "fit/references/one_sided.h"
#include "tests/fit/profile_cases.h"

namespace rondure::fit {
namespace {

using core::kMicrometre;
using Values = std::vector<double>;

constexpr double kPrinted =
    0.5e-6 * kMicrometre;  // half a unit of the sixth decimal of a micrometre

RoundnessOptions with_cutoff(std::optional<double> cutoff) {
  RoundnessOptions options;
  options.filter.filter = cutoff ? ProfileFilter::kGaussian : ProfileFilter::kNone;
  if (cutoff) options.filter.cutoff_upr = *cutoff;
  options.filter.override_sampling = true;  // the spec's table goes up to 500 UPR on 1024 points
  return options;
}

RoundnessEvaluation spec_evaluation(std::optional<double> cutoff) {
  const Values theta = test::uniform_angles(1024);
  const auto out = evaluate_profile(theta, test::spec_profile(theta), with_cutoff(cutoff));
  EXPECT_TRUE(out.has_value());
  return *out;
}

struct Printed {
  std::optional<double> cutoff;
  double total, peak, valley, rms, zone;
};

TEST(Roundness, ReproducesTheTableOfTheSpecification) {
  const Printed table[] = {{std::nullopt, 13.328968, 6.083152, 7.245816, 2.719375, 11.563472},
                           {15.0, 11.250942, 4.959613, 6.291329, 2.599131, 9.242822},
                           {50.0, 12.507570, 5.681668, 6.825902, 2.684543, 10.664776},
                           {150.0, 13.048523, 5.949307, 7.099216, 2.708544, 11.271485},
                           {500.0, 13.285998, 6.061896, 7.224102, 2.717960, 11.524651}};
  for (const Printed& row : table) {
    SCOPED_TRACE(row.cutoff.value_or(0.0));
    const auto out = spec_evaluation(row.cutoff);
    EXPECT_NEAR(out.values[0].total_mm, row.total * kMicrometre, kPrinted);
    EXPECT_NEAR(out.values[0].parameters->peak_mm, row.peak * kMicrometre, kPrinted);
    EXPECT_NEAR(out.values[0].parameters->valley_mm, row.valley * kMicrometre, kPrinted);
    EXPECT_NEAR(out.values[0].parameters->rms_mm, row.rms * kMicrometre, kPrinted);
    EXPECT_NEAR(out.values[1].total_mm, row.zone * kMicrometre, kPrinted);
    EXPECT_LE(out.values[1].total_mm, out.values[0].total_mm);
    EXPECT_EQ(out.values[1].certificate.kind, Certificate::Kind::kGlobal);
    EXPECT_LT(out.values[1].certificate.gap_mm, 1e-16);
  }
}

TEST(Roundness, ReproducesCentresContactsAndHarmonicsOfTheSpecification) {
  const auto out = spec_evaluation(50.0);
  EXPECT_NEAR(out.values[0].center_mm.x(), 9.997228 * kMicrometre, kPrinted);
  EXPECT_NEAR(out.values[0].center_mm.y(), -4.998614 * kMicrometre, kPrinted);
  EXPECT_NEAR(out.values[1].center_mm.x(), 10.126291 * kMicrometre, kPrinted);
  EXPECT_NEAR(out.values[1].center_mm.y(), -3.247782 * kMicrometre, kPrinted);
  const auto degrees = [&](const std::vector<std::size_t>& rows, std::size_t i) {
    return out.theta_rad[rows.at(i)] / core::kDegree;
  };
  EXPECT_NEAR(degrees(out.values[1].outer, 0), 0.351562, 1e-6);
  EXPECT_NEAR(degrees(out.values[1].outer, 1), 204.609375, 1e-6);
  EXPECT_NEAR(degrees(out.values[1].inner, 0), 57.304687, 1e-6);
  EXPECT_NEAR(degrees(out.values[1].inner, 1), 279.843750, 1e-6);
  const auto filtered = harmonics({0.0, out.r_mm}, {.highest = 150, .override_sampling = true});
  ASSERT_TRUE(filtered.has_value());
  const std::pair<std::size_t, double> printed[] = {
      {2, 2.996675}, {16, 0.465741}, {40, 0.128343}, {60, 0.147427}, {150, 0.000586}};
  for (const auto& [k, amplitude] : printed) {
    EXPECT_NEAR(filtered->harmonics[k - 1].amplitude_mm, amplitude * kMicrometre, kPrinted) << k;
  }
}

/// The filtered profile of the spec as points about the nominal circle of 24.56 mm.
std::vector<Eigen::Vector2d> spec_points() {
  const auto out = spec_evaluation(50.0);
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < out.r_mm.size(); ++i) {
    const double r = 24.56 + out.r_mm[i];
    points.emplace_back(r * std::cos(out.theta_rad[i]), r * std::sin(out.theta_rad[i]));
  }
  return points;
}

TEST(Roundness, ReproducesTheExactPointsOfTheSpecification) {
  const auto points = spec_points();
  const auto ls = roundness_of_points(points, CircleReference::kLs);
  const auto mz = roundness_of_points(points, CircleReference::kMz);
  ASSERT_TRUE(ls && mz);
  EXPECT_NEAR(ls->total_mm, 12.505564 * kMicrometre, kPrinted);
  EXPECT_NEAR(ls->parameters->peak_mm, 5.680446 * kMicrometre, kPrinted);
  EXPECT_NEAR(ls->parameters->valley_mm, 6.825118 * kMicrometre, kPrinted);
  EXPECT_NEAR(ls->parameters->rms_mm, 2.684337 * kMicrometre, kPrinted);
  EXPECT_NEAR(mz->total_mm, 10.663316 * kMicrometre, kPrinted);
}

TEST(Roundness, ReproducesTheArcOfTheSpecification) {
  Values theta;
  for (int i = -170; i <= 170; ++i) theta.push_back(core::kTwoPi * i / 1024.0);
  const auto out = evaluate_profile(theta, test::spec_profile(theta), with_cutoff(std::nullopt));
  ASSERT_TRUE(out.has_value());
  EXPECT_NEAR(out->values[0].total_mm, 4.261628 * kMicrometre, kPrinted);
  EXPECT_NEAR(out->values[0].parameters->rms_mm, 0.812042 * kMicrometre, kPrinted);
  EXPECT_NEAR(out->values[0].center_mm.x(), 24.503 * kMicrometre, 0.5e-3 * kMicrometre);
  EXPECT_NEAR(out->values[0].center_mm.y(), -5.379 * kMicrometre, 0.5e-3 * kMicrometre);
  ASSERT_EQ(out->warnings.size(), 1U);
  EXPECT_EQ(out->warnings[0].code, core::Code::kNotFullSection);
  EXPECT_TRUE(out->harmonics.harmonics.empty());
}

/// All centres there are: a zone of the limacon model is carried by four points.
double zone_by_trial(const Values& theta, const Values& r) {
  const std::size_t n = r.size();
  double best = std::numeric_limits<double>::infinity();
  const auto try_four = [&](const std::array<std::size_t, 4>& rows, unsigned sides) {
    Eigen::Matrix4d matrix;
    Eigen::Vector4d right;
    for (Eigen::Index k = 0; k < 4; ++k) {
      const std::size_t i = rows[static_cast<std::size_t>(k)];
      matrix.row(k) << 1.0, std::cos(theta[i]), std::sin(theta[i]),
          (sides >> static_cast<unsigned>(k) & 1U) != 0U ? 1.0 : -1.0;
      right(k) = r[i];
    }
    const Eigen::FullPivLU<Eigen::Matrix4d> lu(matrix);
    if (!lu.isInvertible()) return;
    const Eigen::Vector4d x = lu.solve(right);
    double most = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      most = std::max(
          most, std::abs(r[i] - x(0) - x(1) * std::cos(theta[i]) - x(2) * std::sin(theta[i])));
    }
    best = std::min(best, 2.0 * most);
  };
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = a + 1; b < n; ++b) {
      for (std::size_t c = b + 1; c < n; ++c) {
        for (std::size_t d = c + 1; d < n; ++d) {
          for (unsigned sides = 0; sides < 8; ++sides) try_four({a, b, c, d}, sides);
        }
      }
    }
  }
  return best;
}

TEST(Roundness, ZoneOfAProfileAgreesWithAllContactSets) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    core::KeyedNoise noise(seed, {18});
    const std::size_t n = 5 + seed % 8;
    Values theta;
    Values r;
    const double arc = seed % 3 == 0 ? 1.5 : core::kTwoPi;
    for (std::size_t i = 0; i < n; ++i) {
      theta.push_back(arc * noise.uniform());
      r.push_back(25.0 + 5e-3 * noise.normal());
    }
    const auto zone = roundness_of_profile(theta, r, CircleReference::kMz);
    ASSERT_TRUE(zone.has_value());
    EXPECT_NEAR(zone->total_mm, zone_by_trial(theta, r), 1e-13);
  }
}

/// The circle of the limacon model through each three values that holds all on one side: the least
/// (sign 1) or, of the negated values, the greatest.
double one_sided_by_trial(const Values& theta, const Values& r, double sign) {
  const std::size_t n = r.size();
  double best = std::numeric_limits<double>::infinity();
  const auto try_three = [&](const std::array<std::size_t, 3>& rows) {
    Eigen::Matrix3d matrix;
    Eigen::Vector3d right;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const std::size_t i = rows[static_cast<std::size_t>(k)];
      matrix.row(k) << 1.0, std::cos(theta[i]), std::sin(theta[i]);
      right(k) = sign * r[i];
    }
    const Eigen::FullPivLU<Eigen::Matrix3d> lu(matrix);
    if (!lu.isInvertible()) return;
    const Eigen::Vector3d x = lu.solve(right);
    for (std::size_t i = 0; i < n; ++i) {
      const double level = x(0) + x(1) * std::cos(theta[i]) + x(2) * std::sin(theta[i]);
      if (sign * r[i] > level + 1e-11) return;
    }
    best = std::min(best, x(0));
  };
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = a + 1; b < n; ++b) {
      for (std::size_t c = b + 1; c < n; ++c) try_three({a, b, c});
    }
  }
  return sign * best;
}

TEST(Roundness, OneSidedCirclesOfAProfileAgreeWithAllContactSets) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    core::KeyedNoise noise(seed, {19});
    const std::size_t n = 7 + seed % 8;
    Values theta;
    Values r;
    for (std::size_t i = 0; i < n; ++i) {
      theta.push_back(core::kTwoPi * (static_cast<double>(i) + 0.8 * noise.uniform()) /
                      static_cast<double>(n));
      r.push_back(25.0 + 5e-3 * noise.normal());
    }
    const auto mz = roundness_of_profile(theta, r, CircleReference::kMz);
    const auto mc = roundness_of_profile(theta, r, CircleReference::kMc);
    const auto mi = roundness_of_profile(theta, r, CircleReference::kMi);
    ASSERT_TRUE(mz && mc && mi);
    EXPECT_NEAR(mc->radius_mm, one_sided_by_trial(theta, r, 1.0), 1e-12);
    EXPECT_NEAR(mi->radius_mm, one_sided_by_trial(theta, r, -1.0), 1e-12);
    EXPECT_LE(mc->radius_mm, mz->radius_mm + 0.5 * mz->total_mm + 1e-12);
    EXPECT_GE(mi->radius_mm, mz->radius_mm - 0.5 * mz->total_mm - 1e-12);
    EXPECT_LE(mz->total_mm, std::min(mc->total_mm, mi->total_mm) + 1e-12);
    for (const auto* side : {&*mc, &*mi}) {
      EXPECT_EQ(side->certificate.kind, Certificate::Kind::kGlobal);
      EXPECT_LT(side->certificate.gap_mm, 1e-14);
    }
    EXPECT_TRUE(mc->inner.empty() && mi->outer.empty());
    EXPECT_FALSE(mc->outer.empty() || mi->inner.empty());
  }
}

TEST(Roundness, OneSidedCirclesOfAProfileAreThoseOfItsPointsForSmallForm) {
  for (const double form_mm : {1e-2, 1e-3, 1e-4}) {
    SCOPED_TRACE(form_mm);
    core::KeyedNoise noise(7, {20});
    const Values theta = test::uniform_angles(90);
    Values r;
    std::vector<Eigen::Vector2d> points;
    for (const double t : theta) {
      r.push_back(25.0 + form_mm * (std::cos(3.0 * t) + 0.3 * std::cos(2.0 * t) +
                                    0.2 * std::cos(t) + 0.1 * noise.normal()));
      points.emplace_back(r.back() * std::cos(t), r.back() * std::sin(t));
    }
    const double second_order = form_mm * form_mm / 25.0;  // what the limacon leaves out, e^2 / 2R
    const std::pair<CircleReference, core::Result<OneSidedCircle>> pairs[] = {
        {CircleReference::kMc, min_circumscribed_circle(points)},
        {CircleReference::kMi, max_inscribed_circle(points)}};
    for (const auto& [reference, circle] : pairs) {
      SCOPED_TRACE(name_of(reference));
      const auto by_profile = roundness_of_profile(theta, r, reference);
      const auto by_points = roundness_of_points(points, reference);
      ASSERT_TRUE(circle && by_profile && by_points);
      EXPECT_EQ(by_points->radius_mm, circle->radius_mm);
      EXPECT_EQ(by_points->total_mm, circle->deviation_mm);
      EXPECT_NEAR(by_profile->radius_mm, circle->radius_mm, second_order);
      EXPECT_NEAR(by_profile->total_mm, circle->deviation_mm, 2.0 * second_order);
      EXPECT_LT((by_profile->center_mm - circle->center_mm).norm(), 4.0 * second_order);
    }
  }
}

TEST(Roundness, APerfectProfileHasAllFourCircles) {
  const Values theta = test::uniform_angles(36);
  for (const auto reference :
       {CircleReference::kLs, CircleReference::kMz, CircleReference::kMc, CircleReference::kMi}) {
    SCOPED_TRACE(name_of(reference));
    const auto out = roundness_of_profile(theta, Values(36, 25.0), reference);
    ASSERT_TRUE(out.has_value());
    EXPECT_NEAR(out->radius_mm, 25.0, 1e-12);
    EXPECT_NEAR(out->total_mm, 0.0, 1e-12);
  }
}

TEST(Roundness, OneSidedCirclesOfHalfAProfileDoNotExist) {
  Values theta;
  for (int i = 0; i <= 170; ++i) theta.push_back(i * core::kDegree);
  const Values r = test::spec_profile(theta);
  for (const auto reference : {CircleReference::kMc, CircleReference::kMi}) {
    const auto out = roundness_of_profile(theta, r, reference);
    ASSERT_FALSE(out.has_value());
    EXPECT_EQ(out.error().code, core::Code::kReferenceAbsent);
    EXPECT_NE(out.error().what.find("180 deg"), std::string::npos);
  }
}

TEST(Roundness, DoesNotDependOnStartAngleConstantOrScale) {
  const Values theta = test::uniform_angles(720);
  const Values r = test::rough_profile(3, 720);
  for (const ProfileFilter filter : {ProfileFilter::kGaussian, ProfileFilter::kRobustGaussian,
                                     ProfileFilter::kSpline, ProfileFilter::kTwoRc}) {
    SCOPED_TRACE(name_of(filter));
    RoundnessOptions options;
    options.filter.filter = filter;
    const auto plain = evaluate_profile(theta, r, options);
    Values turned;
    Values changed;
    for (std::size_t i = 0; i < r.size(); ++i) {
      turned.push_back(theta[i] + 0.7);
      changed.push_back(2.0 * r[i] + 0.3);
    }
    const auto other = evaluate_profile(turned, changed, options);
    ASSERT_TRUE(plain && other);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_NEAR(other->values[k].total_mm, 2.0 * plain->values[k].total_mm, 1e-12);
      EXPECT_NEAR(other->values[k].center_mm.norm(), 2.0 * plain->values[k].center_mm.norm(),
                  1e-12);
    }
  }
}

TEST(Roundness, OfABoreSwapsPeakAndValley) {
  const Values theta = test::uniform_angles(400);
  const Values r = test::rough_profile(5, 400);
  const auto outside = roundness_of_profile(theta, r, CircleReference::kLs);
  const auto inside = roundness_of_profile(theta, r, CircleReference::kLs, {{}, true});
  ASSERT_TRUE(outside && inside);
  EXPECT_EQ(outside->parameters->peak_mm, inside->parameters->valley_mm);
  EXPECT_EQ(outside->parameters->total_mm, inside->parameters->total_mm);
}

TEST(RoundnessEvaluation, OfPointsFarAwayIsThatOfTheirProfile) {
  const Values theta = test::uniform_angles(720);
  std::vector<Eigen::Vector2d> points;
  Values form;
  for (const double t : theta) {
    form.push_back(test::spec_form_um(t) * kMicrometre);
    points.emplace_back(400.0 + (25.0 + form.back()) * std::cos(t),
                        -300.0 + (25.0 + form.back()) * std::sin(t));
  }
  const auto by_points = evaluate_section(points, {});
  const auto by_profile = evaluate_profile(theta, form, {});
  ASSERT_TRUE(by_points && by_profile);
  EXPECT_NEAR(by_points->values[0].center_mm.x(), 400.0, 1e-6);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(by_points->values[k].total_mm, by_profile->values[k].total_mm, 3e-6);
  }
}

TEST(RoundnessEvaluation, WithoutAFilterSeesEveryPoint) {
  std::vector<Eigen::Vector2d> points;
  for (const double t : test::uniform_angles(12)) {
    points.emplace_back(10.0 * std::cos(t), 10.0 * std::sin(t));
  }
  points.emplace_back(10.01, 0.0);  // a second point on the ray of the first
  RoundnessOptions options;
  options.filter.filter = ProfileFilter::kNone;
  const auto out = evaluate_section(points, options);
  ASSERT_TRUE(out.has_value());
  EXPECT_EQ(out->samples, 13U);
  EXPECT_GT(out->values[1].total_mm, 0.009);
}

TEST(RoundnessEvaluation, BringsAnglesInOrderAndSaysSo) {
  Values theta = test::uniform_angles(720);
  Values r = test::spec_profile(theta);
  const auto plain = evaluate_profile(theta, r, {});
  std::swap(theta[10], theta[20]);
  std::swap(r[10], r[20]);
  theta.push_back(core::kTwoPi);
  r.push_back(r[0]);
  const auto out = evaluate_profile(theta, r, {});
  ASSERT_TRUE(plain && out);
  EXPECT_NEAR(out->values[0].total_mm, plain->values[0].total_mm, 1e-15);
  ASSERT_GE(out->warnings.size(), 2U);
  for (const auto& w : out->warnings) EXPECT_EQ(w.code, core::Code::kAngleOrder);
}

TEST(RoundnessEvaluation, RefusesMissingAnglesUnlessOverridden) {
  Values theta = test::uniform_angles(720);
  theta.erase(theta.begin() + 100, theta.begin() + 104);  // a gap of 2.5 deg; 50 UPR allow 1.8
  const Values r = test::spec_profile(theta);
  RoundnessOptions options;
  const auto refused = evaluate_profile(theta, r, options);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, core::Code::kSampling);
  EXPECT_NE(refused.error().what.find("2.5 deg"), std::string::npos) << refused.error().what;
  options.filter.override_sampling = true;
  const auto taken = evaluate_profile(theta, r, options);
  ASSERT_TRUE(taken.has_value());
  EXPECT_TRUE(taken->sampling.overridden && taken->interpolated);
  ASSERT_EQ(taken->warnings.size(), 1U);
  EXPECT_EQ(taken->warnings[0].code, core::Code::kUndersampled);
  options.filter.override_sampling = false;
  options.filter.cutoff_upr = 15.0;
  EXPECT_TRUE(evaluate_profile(theta, r, options).has_value());
}

TEST(RoundnessEvaluation, SaysInAWarningThatAReferenceDoesNotExist) {
  Values theta;
  for (int i = 0; i <= 150; ++i) theta.push_back(i * core::kDegree);
  RoundnessOptions options;
  options.filter.filter = ProfileFilter::kNone;
  options.references = {CircleReference::kLs, CircleReference::kMi, CircleReference::kMz};
  const auto out = evaluate_profile(theta, test::spec_profile(theta), options);
  ASSERT_TRUE(out.has_value());
  ASSERT_EQ(out->values.size(), 2U);
  EXPECT_EQ(out->values[1].reference, CircleReference::kMz);
  EXPECT_EQ(out->absent, std::vector{CircleReference::kMi});
  EXPECT_EQ(out->warnings.back().code, core::Code::kReferenceAbsent);
}

TEST(RoundnessEvaluation, RefusesArcsAFilterOrACircleCannotHold) {
  Values theta;
  for (int i = 0; i < 1000; ++i) theta.push_back(0.002 * i);
  RoundnessOptions options;
  options.filter.override_sampling = true;
  EXPECT_EQ(evaluate_profile(theta, Values(1000, 0.0), options).error().code,
            core::Code::kNotFullSection);
  options.filter.filter = ProfileFilter::kNone;
  EXPECT_TRUE(evaluate_profile(theta, test::spec_profile(theta), options).has_value());
  theta.resize(150);  // 17 deg
  EXPECT_EQ(evaluate_profile(theta, Values(150, 0.0), options).error().code,
            core::Code::kNotFullSection);
}

}  // namespace
}  // namespace rondure::fit
