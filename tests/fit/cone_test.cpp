#include "fit/least_squares/cone.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/noise.h"
#include "core/units.h"
#include "fit/geometry/column_extremes.h"
#include "fit/references/min_zone.h"
#include "tests/fit/drawing_cases.h"

// Expected numbers: methods, drawing section 12 (W7).

namespace rondure::fit {
namespace {

using Space = std::vector<Eigen::Vector3d>;
constexpr double kDigits = 1e-10;

std::vector<std::size_t> cone_rows(const std::vector<Contact>& contacts) {
  std::vector<std::size_t> out;
  for (const Contact& c : contacts) out.push_back(c.index);
  return out;
}

/// Sections of a cone about z that opens upwards, with noise normal to the surface.
Space drawn_cone(double half_deg, double radius, std::vector<double> along, int count, double noise,
                 std::uint64_t seed = 1) {
  core::KeyedNoise errors(seed, {83});
  const double half = half_deg * core::kDegree;
  Space out;
  for (const double s : along) {
    for (int i = 0; i < count; ++i) {
      const double angle = core::kTwoPi * i / count;
      const double e = radius + s * std::sin(half);
      const double v = noise * errors.normal();
      out.emplace_back((e + v * std::cos(half)) * std::cos(angle),
                       (e + v * std::cos(half)) * std::sin(angle),
                       s * std::cos(half) - v * std::sin(half));
    }
  }
  return out;
}

Space moved_cone(Space points) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 3).normalized()));
  for (auto& p : points) p = turn * p + Eigen::Vector3d(1e3, -500.0, 200.0);
  return points;
}

TEST(LsCone, IsThatOfTheWorkedExample) {
  const auto cone = ls_cone(test::all_of(test::w7()));
  ASSERT_TRUE(cone.has_value()) << cone.error().what;
  EXPECT_NEAR(core::degrees(cone->cone.full_angle_rad), 19.999348718107, kDigits);
  EXPECT_NEAR(cone->deviation_mm, 0.006448422130, kDigits);
  EXPECT_NEAR(cone->rms_mm, 0.001772115874, kDigits);
  const Eigen::Vector3d& w = cone->cone.axis.direction;
  EXPECT_NEAR(w.x() / w.z(), 0.00019696673504, 1e-12);
  EXPECT_NEAR(w.y() / w.z(), -0.00009347580125, 1e-12);
  EXPECT_NEAR(cone->cone.diameter_mm(0.0), 35.172166985417, kDigits);
}

TEST(MinZoneCone, IsThatOfTheWorkedExampleWithSevenContacts) {
  const auto zone = min_zone_cone(test::all_of(test::w7()));
  ASSERT_TRUE(zone.has_value()) << zone.error().what;
  EXPECT_EQ(zone->ending, ZoneEnding::kConverged);
  EXPECT_NEAR(zone->width_mm, 0.005292692947, kDigits);
  EXPECT_NEAR(core::degrees(zone->cone.full_angle_rad), 19.998538403922, kDigits);
  EXPECT_EQ(cone_rows(zone->outer), (std::vector<std::size_t>{4, 8, 19}));
  EXPECT_EQ(cone_rows(zone->inner), (std::vector<std::size_t>{2, 7, 17, 22}));
  EXPECT_EQ(zone->certificate.kind, Certificate::Kind::kLocal);
  EXPECT_LT(zone->certificate.gap_mm, 1e-12);
}

TEST(MinZoneCone, LiesMidwayBetweenItsContacts) {
  for (const Space& points : {test::all_of(test::w7()), moved_cone(test::all_of(test::w7()))}) {
    const auto zone = min_zone_cone(points);
    ASSERT_TRUE(zone.has_value());
    for (const Contact& c : zone->outer) {
      EXPECT_NEAR(zone->cone.deviation_mm(points[c.index]), 0.5 * zone->width_mm, 1e-10);
    }
    for (const Contact& c : zone->inner) {
      EXPECT_NEAR(zone->cone.deviation_mm(points[c.index]), -0.5 * zone->width_mm, 1e-10);
    }
  }
}

TEST(MinZoneCone, IsTheLeastOfAllConesNearIt) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const double half = 4.0 * static_cast<double>(seed);  // 4 to 80 deg
    const Space points = drawn_cone(half, 12.0, {0.0, 9.0, 20.0}, 9, 0.003, seed);
    const auto zone = min_zone_cone(points);
    const auto ls = ls_cone(points);
    ASSERT_TRUE(zone && ls);
    ASSERT_EQ(zone->ending, ZoneEnding::kConverged);
    EXPECT_LE(zone->width_mm, ls->deviation_mm);
    const bool proven = zone->certificate.kind == Certificate::Kind::kLocal;
    core::KeyedNoise moves(seed, {84});
    for (int i = 0; i < 300; ++i) {
      const double reach = std::pow(10.0, -3.0 - i % 5);
      Cone other = zone->cone;
      other.axis.point_mm += reach * Eigen::Vector3d(moves.normal(), moves.normal(), 0.0);
      other.axis.direction = (other.axis.direction +
                              0.1 * reach * Eigen::Vector3d(moves.normal(), moves.normal(), 0.0))
                                 .normalized();
      other.full_angle_rad += 0.1 * reach * moves.normal();
      const auto width = extremes_of(points, [&](const auto& p) { return other.deviation_mm(p); });
      EXPECT_GE(width.width(), zone->width_mm - (proven ? 1e-12 : 1e-9));
    }
  }
}

TEST(MinZoneCone, HeldByOneGeneratrixHasItsWidthButNoCertificate) {
  // Rows 8, 17 and 26 lie on one generatrix: its straightness is the width.
  const auto zone = min_zone_cone(drawn_cone(10.0, 12.0, {0.0, 9.0, 20.0}, 9, 0.003, 18));
  ASSERT_TRUE(zone.has_value());
  EXPECT_EQ(zone->ending, ZoneEnding::kConverged);
  EXPECT_NEAR(zone->width_mm, 0.009592730142, 1e-9);
  EXPECT_EQ(zone->certificate.kind, Certificate::Kind::kNone);
  EXPECT_EQ(zone->certificate.reason, "the contacts hold the zone to first order only");
  EXPECT_LT(zone->certificate.gap_mm, 1e-9);
}

TEST(MinZoneCone, DoesNotDependOnOrderPlaceDirectionOrRepeatedPoints) {
  const Space drawn = test::all_of(test::w7());
  const auto before = min_zone_cone(drawn);
  Space points = moved_cone(drawn);
  std::ranges::reverse(points);
  points.insert(points.end(), points.begin(), points.begin() + 2);
  const auto after = min_zone_cone(points);
  ASSERT_TRUE(before && after);
  EXPECT_NEAR(after->width_mm, before->width_mm, 1e-9);
  EXPECT_NEAR(std::abs(after->cone.full_angle_rad), before->cone.full_angle_rad, 1e-10);
  // The unrepeated points have the same zone, with a start direction of either sign, too.
  const Eigen::Vector3d down(0.05, 0.0, -1.0);
  EXPECT_NEAR(min_zone_cone(drawn, down)->width_mm, before->width_mm, 1e-12);
}

TEST(LsCone, SignsItsAngleByTheDirectionOfItsAxis) {
  Space points = drawn_cone(20.0, 15.0, {0.0, 10.0, 20.0}, 12, 0.0);
  const auto opens = ls_cone(points);
  ASSERT_TRUE(opens.has_value());
  EXPECT_NEAR(core::degrees(opens->cone.full_angle_rad), 40.0, 1e-9);
  for (auto& p : points) p.z() = -p.z();
  const auto closes = ls_cone(points);
  ASSERT_TRUE(closes.has_value());
  EXPECT_NEAR(core::degrees(closes->cone.full_angle_rad), -40.0, 1e-9);
  // Heights count along the axis from its point.
  const double at_origin = -closes->cone.axis.point_mm.z();
  EXPECT_NEAR(closes->cone.diameter_mm(at_origin), 30.0, 1e-9);
  EXPECT_NEAR(opens->cone.diameter_mm(-opens->cone.axis.point_mm.z()), 30.0, 1e-9);
}

TEST(LsCone, OfTipCentresIsTheConeOfTheSurfaceOnceTheOffsetLosesTheTip) {
  const double half = 15.0 * core::kDegree;
  Space points = drawn_cone(15.0, 10.0, {0.0, 8.0, 16.0}, 8, 0.0);
  for (auto& p : points) {
    const Eigen::Vector3d out(p.x(), p.y(), 0.0);
    p += 2.0 * (std::cos(half) * out.normalized() - std::sin(half) * Eigen::Vector3d::UnitZ());
  }
  const auto cone = ls_cone(points);
  ASSERT_TRUE(cone.has_value());
  Cone surface = cone->cone;
  surface.offset_mm -= 2.0;
  EXPECT_NEAR(surface.diameter_mm(-surface.axis.point_mm.z()), 20.0, 1e-9);
}

TEST(LsCone, FindsConesFromNearlyFlatToNearlyCylindrical) {
  for (const double half : {0.06, 1.0, 30.0, 60.0, 85.0, 89.0}) {
    SCOPED_TRACE(half);
    const Space points = moved_cone(drawn_cone(half, 12.0, {0.0, 5.0, 20.0}, 10, 0.001));
    const auto ls = ls_cone(points);
    ASSERT_TRUE(ls.has_value()) << ls.error().what;
    EXPECT_NEAR(core::degrees(std::abs(ls->cone.full_angle_rad)), 2.0 * half, 0.02);
    EXPECT_LT(ls->deviation_mm, 0.008);
    EXPECT_EQ(min_zone_cone(points)->ending, ZoneEnding::kConverged);
  }
}

TEST(LsCone, TakesTwoSections) {
  const auto cone = ls_cone(moved_cone(drawn_cone(10.0, 12.0, {0.0, 20.0}, 8, 0.0)));
  ASSERT_TRUE(cone.has_value()) << cone.error().what;
  EXPECT_NEAR(core::degrees(std::abs(cone->cone.full_angle_rad)), 20.0, 1e-8);
  EXPECT_LT(cone->deviation_mm, 1e-9);
}

TEST(LsCone, RefusesWhatIsNoCone) {
  const auto code = [](const Space& points) { return ls_cone(points).error().code; };
  EXPECT_EQ(code(drawn_cone(0.01, 12.0, {0.0, 10.0, 20.0}, 8, 0.0)), core::Code::kOutOfRange);
  EXPECT_NE(
      ls_cone(drawn_cone(0.01, 12.0, {0.0, 10.0, 20.0}, 8, 0.0)).error().what.find("cylinder"),
      std::string::npos);
  EXPECT_EQ(code(drawn_cone(30.0, 12.0, {0.0}, 12, 0.0)), core::Code::kRank);
  EXPECT_EQ(code(drawn_cone(30.0, 12.0, {0.0}, 12, 0.003)), core::Code::kRank);
  EXPECT_EQ(code(Space{}), core::Code::kNoPoints);
  Space points = drawn_cone(30.0, 12.0, {0.0, 9.0}, 3, 0.0);
  points[5] = points[0];
  EXPECT_EQ(code(points), core::Code::kTooFewPoints);
  points = drawn_cone(30.0, 12.0, {0.0, 9.0}, 8, 0.0);
  points[3].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(code(points), core::Code::kNotFinite);
  EXPECT_EQ(min_zone_cone(points).error().code, core::Code::kNotFinite);
}

}  // namespace
}  // namespace rondure::fit
