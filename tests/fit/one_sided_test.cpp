#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/noise.h"
#include "core/units.h"
#include "fit/least_squares/circle.h"
#include "fit/least_squares/cylinder.h"
#include "fit/profiles/roundness.h"
#include "fit/proof/certificate.h"
#include "fit/references/min_zone.h"
#include "fit/references/one_sided.h"
#include "fit/zone/fit.h"
#include "tests/core/full.h"

namespace rondure::fit {
namespace {

using PlanePoints = std::vector<Eigen::Vector2d>;
using Space = std::vector<Eigen::Vector3d>;

PlanePoints circle_points(std::uint64_t seed, int count) {
  core::KeyedNoise noise(seed, {31});
  PlanePoints out;
  for (int k = 0; k < count; ++k) {
    const double theta = core::kTwoPi * (k + 0.4 * noise.uniform()) / count;
    const double r = 25.0 + 0.01 * std::cos(3.0 * theta) + 0.003 * noise.normal();
    out.emplace_back(7.0 + r * std::cos(theta), -3.0 + r * std::sin(theta));
  }
  return out;
}

Space cylinder_points(std::uint64_t seed, int count) {
  core::KeyedNoise noise(seed, {32});
  const Eigen::Quaterniond turn(
      Eigen::AngleAxisd(noise.normal(), Eigen::Vector3d(1, 2, -1).normalized()));
  Space out;
  for (int k = 0; k < count; ++k) {
    const double theta = core::kTwoPi * 0.618034 * k;
    const double z = 60.0 * (k + noise.uniform()) / count - 30.0;
    const double r = 20.0 + 0.006 * std::cos(2.0 * theta + 0.05 * z) + 0.002 * noise.normal();
    out.push_back(turn * Eigen::Vector3d(r * std::cos(theta), r * std::sin(theta), z) +
                  Eigen::Vector3d(100.0, -40.0, 12.0));
  }
  return out;
}

Eigen::Vector3d lying(const Space& points) { return ls_cylinder(points)->axis.direction; }

TEST(MinCircumscribedCircle, IsTheSmallestOfAllPairsAndTriplesThatHoldThePoints) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    const PlanePoints points = circle_points(seed, 3 + static_cast<int>(seed % 12));
    const auto fit = min_circumscribed_circle(points);
    ASSERT_TRUE(fit.has_value()) << fit.error().what;
    double best = std::numeric_limits<double>::infinity();
    const auto offer = [&](const Eigen::Vector2d& c, double r) {
      const bool holds = std::all_of(points.begin(), points.end(), [&](const Eigen::Vector2d& p) {
        return (p - c).norm() <= r + 1e-11;
      });
      if (holds) best = std::min(best, r);
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t j = i + 1; j < points.size(); ++j) {
        offer(0.5 * (points[i] + points[j]), 0.5 * (points[i] - points[j]).norm());
        for (std::size_t k = j + 1; k < points.size(); ++k) {
          Eigen::Matrix2d m;
          m << 2.0 * (points[j] - points[i]).transpose(), 2.0 * (points[k] - points[i]).transpose();
          const Eigen::Vector2d d =
              m.inverse() * Eigen::Vector2d((points[j] - points[i]).squaredNorm(),
                                            (points[k] - points[i]).squaredNorm());
          offer(points[i] + d, d.norm());
        }
      }
    }
    EXPECT_NEAR(fit->radius_mm, best, 1e-10);
    EXPECT_EQ(fit->certificate.kind, Certificate::Kind::kGlobal) << fit->certificate.reason;
  }
}

TEST(OneSidedCircle, KeepsTheOrderOfTheFourReferences) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    const PlanePoints points = circle_points(seed, 12 + static_cast<int>(7 * seed));
    const auto mc = min_circumscribed_circle(points);
    const auto mi = max_inscribed_circle(points);
    const auto mz = min_zone_circle(points);
    const auto ls = ls_circle(points);
    ASSERT_TRUE(mc && mi && mz && ls);
    for (const double other : {mc->deviation_mm, mi->deviation_mm, ls->deviation_mm}) {
      EXPECT_LE(mz->width_mm(), other + 1e-12);
    }
    EXPECT_GE(mc->radius_mm, ls->radius_mm);
    EXPECT_LE(mi->radius_mm, ls->radius_mm);
    EXPECT_LE(mc->radius_mm, mz->outer_radius_mm + 1e-12);
    EXPECT_GE(mi->radius_mm, mz->inner_radius_mm - 1e-12);
    EXPECT_GE(mc->contacts.size(), 2U);
    EXPECT_GE(mi->contacts.size(), 2U);
    EXPECT_NE(mi->certificate.kind, Certificate::Kind::kNone) << mi->certificate.reason;
  }
}

TEST(OneSidedCylinder, KeepsTheOrderOfTheFourReferences) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    const Space points = cylinder_points(seed, 20 + static_cast<int>(9 * seed));
    const auto direction = lying(points);
    const auto mc = min_circumscribed_cylinder(points, direction);
    const auto mi = max_inscribed_cylinder(points, direction);
    const auto mz = min_zone_cylinder(points, direction);
    const auto ls = ls_cylinder(points, direction);
    ASSERT_TRUE(mc && mi && mz && ls);
    for (const double other : {mc->deviation_mm, mi->deviation_mm, ls->deviation_mm}) {
      EXPECT_LE(mz->width_mm(), other + 1e-12);
    }
    EXPECT_LE(mc->radius_mm, mz->outer_radius_mm + 1e-12);
    EXPECT_GE(mi->radius_mm, mz->inner_radius_mm - 1e-12);
    EXPECT_EQ(mc->certificate.kind, Certificate::Kind::kLocal) << mc->certificate.reason;
    EXPECT_EQ(mi->certificate.kind, Certificate::Kind::kLocal) << mi->certificate.reason;
  }
}

TEST(OneSidedCylinder, TurnsAndShiftsWithThePart) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const Space points = cylinder_points(seed, 300);
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.7, Eigen::Vector3d(3, -1, 2).normalized()));
    const Eigen::Vector3d shift(1e3, -2e3, 500.0);
    Space moved;
    for (const auto& p : points) moved.push_back(turn * p + shift);
    std::reverse(moved.begin(), moved.end());
    const auto direction = lying(points);
    for (const auto fit : {min_circumscribed_cylinder, max_inscribed_cylinder}) {
      const auto before = fit(points, direction, {});
      const auto after = fit(moved, turn * direction, {});
      ASSERT_TRUE(before && after);
      EXPECT_NEAR(before->radius_mm, after->radius_mm, 1e-10);
      EXPECT_LE((turn * before->axis.direction).cross(after->axis.direction).norm(), 1e-9);
    }
  }
}

/// Four layers of the same 24 angles: points that stand opposite each other can hold a cylinder
/// alone.
Space regular_layers(std::uint64_t seed) {
  Space out;
  for (std::uint64_t layer = 0; layer < 4; ++layer) {
    core::KeyedNoise noise(4 * seed + layer, {61});
    for (int i = 0; i < 24; ++i) {
      const double angle = core::kTwoPi * i / 24.0;
      const double r = 25.0 + 4e-3 * std::cos(2.0 * angle) + 2e-3 * noise.normal();
      out.emplace_back(10.0 + r * std::cos(angle), -4.0 + r * std::sin(angle),
                       20.0 * static_cast<double>(layer));
    }
  }
  return out;
}

// The figure of docs/developer/accuracy.md.
TEST(OneSidedCylinder, SaysHowOftenRegularLayersLeaveItWithoutCertificate) {
  const std::uint64_t sets = test::full() ? 400 : 40;
  std::uint64_t without = 0;
  for (std::uint64_t seed = 1; seed <= sets; ++seed) {
    SCOPED_TRACE(seed);
    const Space points = regular_layers(seed);
    for (const auto fit : {min_circumscribed_cylinder, max_inscribed_cylinder}) {
      const auto found = fit(points, Eigen::Vector3d::UnitZ(), {});
      ASSERT_TRUE(found.has_value()) << found.error().what;
      if (found->certificate.kind != Certificate::Kind::kNone) continue;
      ++without;
      EXPECT_FALSE(found->certificate.reason.empty());
    }
  }
  std::cout << "without certificate " << without << " of " << 2 * sets << "\n";
  EXPECT_LE(without, 2 * sets / 20);
}

/// A ring with dents at 0 and 180 deg that hold an inscribed circle between them, and a bump at 90
/// deg: the circle is free to slide across until the points at 90 or 270 deg stop it.
PlanePoints dented_ring(double radius) {
  PlanePoints out;
  for (int k = 0; k < 360; ++k) {
    const double angle = k * core::kDegree;
    const double r = radius + (k % 180 == 0 ? -0.010 : k == 90 ? 0.008 : 0.0);
    out.emplace_back(r * std::cos(angle), r * std::sin(angle));
  }
  return out;
}

TEST(MaxInscribedCircle, SaysTheRangeWhereSeveralAreAsLarge) {
  // Slid by y, RONt is 10 um + max(8 - y, |y|): 28 um at -10 um, 20 um at 10 um. The ends are the
  // largest circles; at |y| = s the radius is (10^2 - s^2) / 2 R smaller, 1 nm at 7.07 um.
  const auto circle = max_inscribed_circle(dented_ring(25.0));
  ASSERT_TRUE(circle.has_value()) << circle.error().what;
  EXPECT_EQ(circle->certificate.kind, Certificate::Kind::kGlobal) << circle->certificate.reason;
  EXPECT_EQ(circle->certificate.scope, "all centres inside the hull of the points");
  ASSERT_TRUE(circle->range.has_value());
  EXPECT_NEAR(circle->range->high_mm, 0.028, 1e-4);
  EXPECT_NEAR(circle->range->low_mm, 0.01707, 3e-4);
  // In a small ring curvature leaves the ends only: 9.5 um off, 0.1 + 0.0095 - (0.1 - 0.0095).
  const auto small = max_inscribed_circle(dented_ring(0.1));
  ASSERT_TRUE(small && small->range);
  EXPECT_NEAR(small->range->low_mm, 0.019, 1e-4);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto ordinary = max_inscribed_circle(circle_points(seed, 90));
    ASSERT_TRUE(ordinary.has_value());
    EXPECT_EQ(ordinary->certificate.kind, Certificate::Kind::kGlobal);
    EXPECT_FALSE(ordinary->range.has_value()) << seed;
  }
}

TEST(MaxInscribedCircle, OfAProfileSaysTheRangeWhereItIsFreeToSlide) {
  std::vector<double> theta;
  std::vector<double> r;
  for (int k = 0; k < 360; ++k) {
    theta.push_back(k * core::kDegree);
    r.push_back(k % 180 == 0 ? -0.010 : k == 90 ? 0.008 : 0.0);
  }
  const auto inscribed = roundness_of_profile(theta, r, CircleReference::kMi);
  ASSERT_TRUE(inscribed && inscribed->range);
  EXPECT_NEAR(inscribed->range->low_mm, 0.014, 2e-5);
  EXPECT_NEAR(inscribed->range->high_mm, 0.028, 2e-5);
  for (double& value : r) value = -value;
  const auto circumscribed = roundness_of_profile(theta, r, CircleReference::kMc);
  ASSERT_TRUE(circumscribed && circumscribed->range);
  EXPECT_NEAR(circumscribed->range->low_mm, 0.014, 2e-5);
  EXPECT_NEAR(circumscribed->range->high_mm, 0.028, 2e-5);
}

TEST(OneSidedCylinder, IsProvenOverAllAxesOfTheScope) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    const Space points = cylinder_points(seed, 20 + static_cast<int>(9 * seed));
    const auto direction = lying(points);
    const CylinderProofOptions options{.scopes = {AxisScope{AxisScope::Kind::kCone, direction}},
                                       .search = {}};
    const auto mc = min_circumscribed_cylinder(points, direction, options);
    const auto mi = max_inscribed_cylinder(points, direction, options);
    ASSERT_TRUE(mc && mi);
    EXPECT_EQ(mc->certificate.kind, Certificate::Kind::kGlobal) << mc->certificate.reason;
    EXPECT_EQ(mi->certificate.kind, Certificate::Kind::kGlobal) << mi->certificate.reason;
    EXPECT_LE(mc->certificate.gap_mm, 2e-9);
    EXPECT_LE(mi->certificate.gap_mm, 2e-9);
    EXPECT_LE(mc->radius_mm, min_circumscribed_cylinder(points, direction)->radius_mm + 1e-12);
    EXPECT_GE(mi->radius_mm, max_inscribed_cylinder(points, direction)->radius_mm - 1e-12);
  }
}

TEST(OneSidedCylinder, SaysWhatASearchAtItsLimitLeaves) {
  const Space points = cylinder_points(3, 60);
  const auto direction = lying(points);
  const CylinderProofOptions few{.scopes = {AxisScope{AxisScope::Kind::kCone, direction}},
                                 .search = {.max_boxes = 5}};
  for (const auto fit : {min_circumscribed_cylinder, max_inscribed_cylinder}) {
    const auto found = fit(points, direction, few);
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(found->certificate.kind, Certificate::Kind::kLocal);
    EXPECT_NE(found->certificate.reason.english().find("were left after"), std::string::npos)
        << found->certificate.reason;
    EXPECT_NE(found->certificate.reason.english().find("from the value found"), std::string::npos);
  }
}

// The cylinder across the chord of a short arc is far smaller than the one about the arc's axis.
TEST(OneSidedCylinder, SaysThatACylinderAcrossAnArcIsSmaller) {
  Space arc;
  for (int k = 0; k < 33; ++k) {
    const double angle = (8.0 * (k / 3) - 40.0) * core::kDegree;
    const double r = 30.0 + 0.01 * std::cos(3.0 * angle);
    arc.emplace_back(r * std::cos(angle), r * std::sin(angle), 12.0 * (k % 3));
  }
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const CylinderProofOptions options{
      .scopes = {AxisScope{AxisScope::Kind::kHalfSphere}, AxisScope{AxisScope::Kind::kCone, up}},
      .search = {}};
  const auto found = min_circumscribed_cylinder(arc, up, options);
  ASSERT_TRUE(found.has_value()) << found.error().what;
  EXPECT_EQ(found->certificate.kind, Certificate::Kind::kGlobal) << found->certificate.reason;
  EXPECT_EQ(found->certificate.scope, "within 10 deg of nominal");
  ASSERT_TRUE(found->other.has_value());
  EXPECT_LT(found->other->radius_mm, found->radius_mm - 1.0);
  EXPECT_GT(found->other->lean_rad, 10.0 * core::kDegree);
}

TEST(OneSided, HasNoInscribedReferenceWhereThePointsDoNotSurroundIt) {
  PlanePoints half;
  Space gutter;
  for (int k = 0; k <= 24; ++k) {
    const double theta = 170.0 * core::kDegree * k / 24.0;
    half.emplace_back(25.0 * std::cos(theta), 25.0 * std::sin(theta));
    for (const double z : {0.0, 20.0, 40.0}) {
      gutter.emplace_back(25.0 * std::cos(theta), 25.0 * std::sin(theta), z);
    }
  }
  const auto circle = max_inscribed_circle(half);
  ASSERT_FALSE(circle.has_value());
  EXPECT_EQ(circle.error().code, core::Code::kReferenceAbsent);
  const auto cylinder = max_inscribed_cylinder(gutter, Eigen::Vector3d::UnitZ());
  ASSERT_FALSE(cylinder.has_value());
  EXPECT_EQ(cylinder.error().code, core::Code::kReferenceAbsent);
}

TEST(OneSided, NamesTheRowThatIsNotANumber) {
  for (const int count : {9, 500}) {
    PlanePoints points = circle_points(1, count);
    points[7].y() = std::numeric_limits<double>::quiet_NaN();
    Space space = cylinder_points(1, count);
    space[8].z() = std::numeric_limits<double>::infinity();
    const auto circle = min_circumscribed_circle(points);
    ASSERT_FALSE(circle.has_value());
    EXPECT_EQ(circle.error().code, core::Code::kNotFinite);
    EXPECT_NE(circle.error().what.find(" 7 "), std::string::npos) << circle.error().what;
    const auto cylinder = min_circumscribed_cylinder(space, Eigen::Vector3d::UnitZ());
    ASSERT_FALSE(cylinder.has_value());
    EXPECT_EQ(cylinder.error().code, core::Code::kNotFinite);
    EXPECT_NE(cylinder.error().what.find(" 8 "), std::string::npos) << cylinder.error().what;
  }
}

TEST(ZoneFitters, LookAtEveryRowForNumbers) {
  CircleZoneFitter fitter;
  for (const int count : {20, 100, 128, 300}) {
    for (int row = 0; row < count; ++row) {
      SCOPED_TRACE(fmt::format("row {} of {}", row, count));
      PlanePoints points = circle_points(2, count);
      points[static_cast<std::size_t>(row)].x() = std::numeric_limits<double>::quiet_NaN();
      for (const ZoneWeights& weights : {kMinimumZone, kMinimumCircumscribed, kMaximumInscribed}) {
        const auto zone = fitter.fit(points, weights);
        ASSERT_FALSE(zone.has_value());
        EXPECT_EQ(zone.error().code, core::Code::kNotFinite);
        EXPECT_NE(zone.error().what.find(fmt::format(" {} ", row)), std::string::npos)
            << zone.error().what;
      }
    }
  }
}

TEST(MinCircumscribedCircle, RefusesLinesThoughTheyHaveASmallestCircle) {
  for (const std::size_t count : {3U, 60U, 200U}) {
    PlanePoints line;
    for (std::size_t i = 0; i < count; ++i) {
      line.emplace_back(static_cast<double>(i), 2.0 * static_cast<double>(i));
    }
    const auto circle = min_circumscribed_circle(line);
    ASSERT_FALSE(circle.has_value());
    EXPECT_EQ(circle.error().code, core::Code::kCollinear);
  }
  const auto circle = min_circumscribed_circle(PlanePoints{{1, 2}, {3, 4}, {1, 2}, {3, 4}});
  ASSERT_FALSE(circle.has_value());
  EXPECT_EQ(circle.error().code, core::Code::kTooFewPoints);
}

// Two points opposite each other and two that hardly push: of a contact that pulled, or of a point
// that stuck out, Newton's method gave up, some pm short of the optimum.
TEST(OneSidedCylinder, OfAPlainShaftRestsOnContactsThatProveIt) {
  for (const std::uint64_t seed : {13, 116, 136}) {
    SCOPED_TRACE(seed);
    core::KeyedNoise noise(20261128, {seed});
    const int layers = 2 + static_cast<int>(3 * noise.uniform());
    const int points = 6 + static_cast<int>(40 * noise.uniform());
    const double radius = 8.0 + 30.0 * noise.uniform();
    const double length = 10.0 + 60.0 * noise.uniform();
    Space shaft;
    for (int j = 0; j < layers; ++j) {
      for (int i = 0; i < points; ++i) {
        const double t = core::kTwoPi * i / points;
        const double r = radius + 1e-3 * noise.normal();
        shaft.emplace_back(r * std::cos(t), r * std::sin(t), length * j / (layers - 1));
      }
    }
    for (const auto& fit : {min_circumscribed_cylinder, max_inscribed_cylinder}) {
      const auto found = fit(shaft, Eigen::Vector3d::UnitZ(), {});
      ASSERT_TRUE(found);
      EXPECT_EQ(found->certificate.kind, Certificate::Kind::kLocal) << found->certificate.gap_mm;
    }
  }
}

}  // namespace
}  // namespace rondure::fit
