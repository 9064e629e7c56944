// Minimum circumscribed and maximum inscribed circles and cylinders against every oracle:
// enumeration, CGAL, planted sets, the independent descent, and bad input.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "brute_circle.h"
#include "cgal_circle.h"
#include "core/noise.h"
#include "core/units.h"
#include "cylinder_sets.h"
#include "descent.h"
#include "dial.h"
#include "fit/least_squares/cylinder.h"
#include "fit/references/one_sided.h"
#include "planted.h"

namespace rondure::test {
namespace {

constexpr int kCurved = 200;  // drawing them takes longer than fitting them

core::Result<fit::OneSidedCircle> fit_circle(const Points2& points, Reference reference) {
  return reference == Reference::kCircumscribed ? fit::min_circumscribed_circle(points)
                                                : fit::max_inscribed_circle(points);
}

core::Result<fit::OneSidedCylinder> fit_cylinder(const Points3& points, Reference reference,
                                                 const Eigen::Vector3d& near) {
  return reference == Reference::kCircumscribed ? fit::min_circumscribed_cylinder(points, near)
                                                : fit::max_inscribed_cylinder(points, near);
}

double stated_radius(const Optimum& optimum, Reference reference) {
  return reference == Reference::kCircumscribed ? optimum.outer_mm : optimum.inner_mm;
}

std::vector<std::size_t> sorted_rows(const std::vector<fit::Contact>& contacts) {
  std::vector<std::size_t> out;
  for (const auto& c : contacts) out.push_back(c.index);
  std::sort(out.begin(), out.end());
  return out;
}

TEST(OneSided, CircumscribedCircleEqualsTheEnumeration) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(count(500)); ++seed) {
    SCOPED_TRACE(name_of(kind_of(seed)) + " " + std::to_string(seed));
    const Points2 points = hard_set(seed, 4, 12);
    const auto circle = fit::min_circumscribed_circle(points);
    ASSERT_TRUE(circle.has_value()) << circle.error().what;
    EXPECT_NEAR(circle->radius_mm, static_cast<double>(brute_circumscribed(points).value_mm),
                1e-12);
    const Reach at = reach_from(points, circle->center_mm.cast<Real>());
    EXPECT_NEAR(circle->radius_mm, static_cast<double>(at.high_mm), 1e-12);
    EXPECT_NEAR(circle->deviation_mm, static_cast<double>(at.high_mm - at.low_mm), 1e-12);
  }
}

TEST(OneSided, InscribedCircleIsAnEnumeratedOne) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(count(500)); ++seed) {
    SCOPED_TRACE(name_of(kind_of(seed)) + " " + std::to_string(seed));
    const Points2 points = hard_set(seed, 4, 12);
    const auto maxima = brute_inscribed(points);
    const auto circle = fit::max_inscribed_circle(points);
    if (!circle) {
      EXPECT_EQ(core::code_name(circle.error().code), "reference-absent") << circle.error().what;
      // A cloud may hold empty circles that are not next to its least-squares circle.
      EXPECT_TRUE(maxima.empty() || kind_of(seed) == Hard::kCloud);
      continue;
    }
    EXPECT_TRUE(std::any_of(maxima.begin(), maxima.end(),
                            [&](const CirclePlace& m) {
                              return std::abs(m.value_mm - circle->radius_mm) < 1e-12L &&
                                     (m.center_mm - circle->center_mm.cast<Real>()).norm() < 1e-9L;
                            }))
        << circle->radius_mm << " at " << circle->center_mm.transpose();
  }
}

TEST(OneSided, InscribedCircleIsTheLargestOfTheEnumeratedOnes) {
  int proven = 0;
  const auto sets = static_cast<std::uint64_t>(count(500));
  for (std::uint64_t seed = 0; seed < sets; ++seed) {
    SCOPED_TRACE(name_of(kind_of(seed)) + " " + std::to_string(seed));
    const Points2 points = hard_set(seed, 4, 12);
    const auto circle = fit::max_inscribed_circle(points);
    if (!circle || circle->certificate.kind != fit::Certificate::Kind::kGlobal) continue;
    ++proven;
    for (const CirclePlace& m : brute_inscribed(points))
      EXPECT_LE(static_cast<double>(m.value_mm), circle->radius_mm + 2e-9);
  }
  EXPECT_GT(proven, static_cast<int>(sets) / 2);
}

// The best of many descents from axes about the least-squares one, closer than 10 deg.
TEST(OneSided, CylindersAreTheBestOfManyDescents) {
  for (const Reference reference : {Reference::kCircumscribed, Reference::kInscribed}) {
    int better = 0;
    int open = 0;
    const auto sets = static_cast<std::uint64_t>(count(60));
    for (std::uint64_t seed = 0; seed < sets; ++seed) {
      SCOPED_TRACE(seed);
      const Measured set = part(seed, core::kTwoPi);
      const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
      const auto start = fit::ls_cylinder(set.points, up);
      ASSERT_TRUE(start.has_value());
      const fit::CylinderProofOptions options{
          .scopes = {fit::AxisScope{fit::AxisScope::Kind::kCone, start->axis.direction}},
          .search = {}};
      const auto outside = reference == Reference::kCircumscribed;
      const auto local = outside ? fit::min_circumscribed_cylinder(set.points, up)
                                 : fit::max_inscribed_cylinder(set.points, up);
      const auto global = outside ? fit::min_circumscribed_cylinder(set.points, up, options)
                                  : fit::max_inscribed_cylinder(set.points, up, options);
      if (!global) continue;
      if (global->certificate.kind == fit::Certificate::Kind::kNone) continue;
      if (global->certificate.kind != fit::Certificate::Kind::kGlobal) {
        // Very short discs may end at the limit; they say what is left.
        EXPECT_NE(global->certificate.reason.english().find("from the value found"),
                  std::string::npos)
            << global->certificate.reason;
        ++open;
        continue;
      }
      const double sign = outside ? 1.0 : -1.0;
      better += sign * (local->radius_mm - global->radius_mm) > 1e-9 ? 1 : 0;
      core::KeyedNoise noise(seed, {77});
      for (int k = 0; k < 12; ++k) {
        const double size = 0.02 * std::pow(10.0, -2.0 * noise.uniform());
        const auto point =
            (start->axis.point_mm + size * Eigen::Vector3d(noise.normal(), noise.normal(), 0.0))
                .cast<Real>()
                .eval();
        const auto direction =
            (start->axis.direction +
             size / set.half_length_mm * Eigen::Vector3d(noise.normal(), noise.normal(), 0.0))
                .normalized()
                .cast<Real>()
                .eval();
        const AxisOptimum found = descend(set.points, point, direction, reference, 0.01L);
        if (found.direction.cast<double>().dot(start->axis.direction) < std::cos(0.17)) continue;
        EXPECT_LE(sign * global->radius_mm,
                  static_cast<double>(found.at.value_mm(reference)) + 1.1e-9);
      }
    }
    std::cout << (reference == Reference::kCircumscribed ? "circumscribed" : "inscribed")
              << ": the local optimum is not the best in " << better << " of " << sets << ", "
              << open << " at the limit of the search\n";
    EXPECT_LE(open, std::max(1, static_cast<int>(sets) / 10));
  }
}

TEST(OneSided, CirclesOfUpTo200PointsEqualCgal) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(count(200)); ++seed) {
    SCOPED_TRACE(name_of(kind_of(seed)) + " " + std::to_string(seed));
    const Points2 points = hard_set(kind_of(seed), 13 + static_cast<int>(seed * 37 % 188), seed);
    const auto outer = fit::min_circumscribed_circle(points);
    ASSERT_TRUE(outer.has_value()) << outer.error().what;
    EXPECT_NEAR(outer->radius_mm, static_cast<double>(cgal_circumscribed(points).value_mm), 1e-12);
    const auto inner = fit::max_inscribed_circle(points);
    if (!inner) continue;  // existence: InscribedCircleIsAnEnumeratedOne
    const auto maxima = cgal_inscribed(points);
    EXPECT_TRUE(std::any_of(maxima.begin(), maxima.end(), [&](const CirclePlace& m) {
      return std::abs(m.value_mm - inner->radius_mm) < 1e-12L;
    })) << inner->radius_mm;
  }
}

TEST(OneSided, PlantedCircles) {
  for (const Reference reference : {Reference::kCircumscribed, Reference::kInscribed}) {
    for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(count(kPlanted)); ++seed) {
      SCOPED_TRACE(seed);
      const PlantedCircle set = plant_circle(draw_plot(reference, seed), seed);
      const auto circle = fit_circle(set.points, reference);
      ASSERT_TRUE(circle.has_value()) << circle.error().what;
      EXPECT_NEAR(circle->radius_mm, stated_radius(set.optimum, reference), kPlace);
      EXPECT_LT((circle->center_mm - set.center_mm).norm(), kPlace);
      EXPECT_EQ(sorted_rows(circle->contacts), sorted(set.optimum.contacts));
    }
  }
}

void expect_planted_cylinders(Reference reference, bool curved) {
  for (std::uint64_t seed = 0;
       seed < static_cast<std::uint64_t>(count(curved ? kCurved : kPlanted)); ++seed) {
    SCOPED_TRACE(seed);
    Plot plot = draw_plot(reference, seed);
    plot.curved = curved;
    if (curved && reference == Reference::kInscribed) plot.half_length_mm *= 0.2;
    const PlantedCylinder set = plant_cylinder(plot, seed);
    const Eigen::Vector3d near = set.direction + 0.02 * set.direction.unitOrthogonal();
    const auto cylinder = fit_cylinder(set.points, reference, near);
    ASSERT_TRUE(cylinder.has_value()) << cylinder.error().what;
    EXPECT_NEAR(cylinder->radius_mm, stated_radius(set.optimum, reference), kPlace);
    EXPECT_LT(fit::distance_mm({set.center_mm, set.direction}, cylinder->axis.point_mm), kPlace);
    EXPECT_LT(cylinder->axis.direction.cross(set.direction).norm(), kDirection);
    EXPECT_EQ(sorted_rows(cylinder->contacts), sorted(set.optimum.contacts));
    EXPECT_NE(cylinder->certificate.kind, fit::Certificate::Kind::kNone)
        << cylinder->certificate.reason;
  }
}

TEST(OneSided, PlantedCircumscribedCylinders) {
  expect_planted_cylinders(Reference::kCircumscribed, false);
}
TEST(OneSided, PlantedCircumscribedCylindersHeldByCurvature) {
  expect_planted_cylinders(Reference::kCircumscribed, true);
}
TEST(OneSided, PlantedInscribedCylinders) {
  expect_planted_cylinders(Reference::kInscribed, false);
}
TEST(OneSided, PlantedInscribedCylindersHeldByCurvature) {
  expect_planted_cylinders(Reference::kInscribed, true);
}

TEST(OneSided, CylindersAreLocalOptimaOfTheDescent) {
  for (const Reference reference : {Reference::kCircumscribed, Reference::kInscribed}) {
    for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(count(100)); ++seed) {
      SCOPED_TRACE(seed);
      const Points3 points = part(seed, core::kTwoPi).points;
      const auto cylinder = fit_cylinder(points, reference, Eigen::Vector3d::UnitZ());
      if (!cylinder) {
        EXPECT_EQ(core::code_name(cylinder.error().code), "reference-absent")
            << cylinder.error().what;
        EXPECT_LT(part(seed, core::kTwoPi).half_length_mm, 10.0);
        continue;
      }
      const auto point = cylinder->axis.point_mm.cast<Real>().eval();
      const auto direction = cylinder->axis.direction.cast<Real>().eval();
      const Extremes at = extremes(points, point, direction);
      EXPECT_NEAR(cylinder->deviation_mm, static_cast<double>(at.high_mm - at.low_mm), 1e-12);
      const double radius = static_cast<double>(std::abs(at.value_mm(reference)));
      EXPECT_NEAR(cylinder->radius_mm, radius, 1e-12);
      const AxisOptimum below = descend(points, point, direction, reference, 1e-4L);
      EXPECT_NEAR(static_cast<double>(below.at.value_mm(reference) - at.value_mm(reference)), 0.0,
                  1e-12);
    }
  }
}

TEST(OneSided, ShaftsHaveNoWorseOptimumThanTheOneBelowTheLeastSquaresAxis) {
  for (const Reference reference : {Reference::kCircumscribed, Reference::kInscribed}) {
    for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(count(300)); ++seed) {
      SCOPED_TRACE(seed);
      const Measured shaft = part(seed, core::kTwoPi);
      if (shaft.half_length_mm < 15.0) continue;
      const auto start = fit::ls_cylinder(shaft.points, Eigen::Vector3d::UnitZ());
      const auto cylinder = fit_cylinder(shaft.points, reference, Eigen::Vector3d::UnitZ());
      ASSERT_TRUE(cylinder.has_value()) << cylinder.error().what;
      const AxisOptimum truth = descend(shaft.points, start->axis.point_mm.cast<Real>(),
                                        start->axis.direction.cast<Real>(), reference, 0.01L);
      // Several optima may lie close together: the fit's is the best of them or as good.
      const double sign = reference == Reference::kCircumscribed ? 1.0 : -1.0;
      EXPECT_LE(sign * cylinder->radius_mm,
                static_cast<double>(truth.at.value_mm(reference)) + 1e-9);
    }
  }
}

TEST(OneSided, ReferencesThatDoNotExistAreRefused) {
  Points2 arc;
  Points3 gutter;
  for (int k = 0; k < 20; ++k) {
    const double angle = 170.0 * core::kDegree * k / 19.0;
    arc.emplace_back(25.0 * std::cos(angle), 25.0 * std::sin(angle) + 0.001 * (k % 3));
    for (const double z : {-20.0, 0.0, 20.0})
      gutter.emplace_back(arc.back().x(), arc.back().y(), z);
  }
  const auto circle = fit::max_inscribed_circle(arc);
  ASSERT_FALSE(circle.has_value());
  EXPECT_EQ(core::code_name(circle.error().code), "reference-absent");
  const auto cylinder = fit::max_inscribed_cylinder(gutter, Eigen::Vector3d::UnitZ());
  ASSERT_FALSE(cylinder.has_value());
  EXPECT_EQ(core::code_name(cylinder.error().code), "reference-absent");
}

template <class Points>
void expect_code(const Points& points, const std::string& code) {
  for (const Reference reference : {Reference::kCircumscribed, Reference::kInscribed}) {
    if constexpr (std::is_same_v<Points, Points2>) {
      const auto result = fit_circle(points, reference);
      ASSERT_FALSE(result.has_value());
      EXPECT_EQ(core::code_name(result.error().code), code) << result.error().what;
    } else {
      const auto result = fit_cylinder(points, reference, Eigen::Vector3d::UnitZ());
      ASSERT_FALSE(result.has_value());
      EXPECT_EQ(core::code_name(result.error().code), code) << result.error().what;
    }
  }
}

TEST(OneSided, BadInputIsRefused) {
  expect_code(Points2{}, "no-points");
  expect_code(Points3{}, "no-points");
  expect_code(Points2{{1, 0}, {0, 1}, {1, std::nan("")}, {0, -1}}, "not-finite");
  expect_code(Points3{{1, 0, 0}, {0, 1, 0}, {1, 1, HUGE_VAL}, {0, -1, 5}, {-1, 0, 5}},
              "not-finite");
  expect_code(Points2{{1, 0}, {0, 1}, {1, 0}, {0, 1}}, "too-few-points");
  expect_code(Points3{{1, 0, 0}, {0, 1, 0}, {-1, 0, 5}, {0, -1, 5}, {1, 0, 0}}, "too-few-points");
  expect_code(Points2{{0, 0}, {1, 2}, {2, 4}, {3, 6}}, "collinear");
  expect_code(Points3{{0, 0, 0}, {1, 2, 3}, {2, 4, 6}, {3, 6, 9}, {4, 8, 12}, {5, 10, 15}},
              "collinear");
  Points3 layer;
  for (int k = 0; k < 24; ++k) {
    const double angle = core::kTwoPi * k / 24.0;
    layer.emplace_back(25.0 * std::cos(angle), 25.0 * std::sin(angle), 3.0);
  }
  expect_code(layer, "rank");
}

}  // namespace
}  // namespace rondure::test
