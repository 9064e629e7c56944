#include "benchmarks/sample_sets.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace rondure::benchmarks {
namespace {

double radius_mm(const CylinderSet& set, const Eigen::Vector3d& p) {
  return set.axis_direction.cross(p - set.axis_point_mm).norm();
}

/// Largest deviation a variant may have from the ideal shape [mm].
double largest_deviation_mm(Variant variant) {
  switch (variant) {
    case Variant::kSmallForm:
      return kLargestDeviation_mm / 20.0;
    case Variant::kSpikes:
      return kLargestDeviation_mm + 0.012;
    case Variant::kRounded100nm:
    case Variant::kRounded1um:
      return kLargestDeviation_mm + 0.001;
    default:
      return kLargestDeviation_mm;
  }
}

double degrees_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) / core::kDegree;
}

std::tuple<double, double, double> as_tuple(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

TEST(SampleSets, StayWithinTheStatedDeviationAndAreNotIdeal) {
  for (const Variant variant : kVariants) {
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      SCOPED_TRACE(std::string(name_of(variant)) + " " + std::to_string(seed));
      const double limit_mm = largest_deviation_mm(variant);
      double worst_mm = 0.0;
      const auto cylinder = make_cylinder({variant, 2000, seed});
      for (const auto& p : cylinder.points_mm) {
        worst_mm = std::max(worst_mm, std::abs(radius_mm(cylinder, p) - kRadius_mm));
      }
      const auto circle = make_circle({variant, 2000, seed});
      for (const auto& p : circle.points_mm) {
        worst_mm = std::max(worst_mm, std::abs((p - circle.center_mm).norm() - kRadius_mm));
      }
      EXPECT_LE(worst_mm, limit_mm);
      EXPECT_GT(worst_mm, limit_mm / 20.0);
    }
  }
}

TEST(SampleSets, HaveTheSizeAskedForAndEqualKeysGiveEqualPoints) {
  for (const std::size_t points : {9, 12, 20, 24, 1001}) {
    const SetKey key{Variant::kScanOrder, points, 3};
    EXPECT_EQ(make_cylinder(key).points_mm.size(), points);
    EXPECT_EQ(make_circle(key).points_mm.size(), points);
    EXPECT_EQ(make_cylinder(key).points_mm, make_cylinder(key).points_mm);
    EXPECT_EQ(make_circle(key).points_mm, make_circle(key).points_mm);
    EXPECT_NE(make_circle(key).points_mm, make_circle({Variant::kScanOrder, points, 4}).points_mm);
  }
}

TEST(SampleSets, ShuffledHoldsThePointsOfTheScanInAnotherOrder) {
  const auto scan = make_cylinder({Variant::kScanOrder, 500, 1}).points_mm;
  const auto shuffled = make_cylinder({Variant::kShuffled, 500, 1}).points_mm;
  EXPECT_NE(scan, shuffled);
  std::multiset<std::tuple<double, double, double>> a;
  std::multiset<std::tuple<double, double, double>> b;
  for (const auto& p : scan) a.insert(as_tuple(p));
  for (const auto& p : shuffled) b.insert(as_tuple(p));
  EXPECT_EQ(a, b);
}

TEST(SampleSets, StartDirectionIsAsFarOffAsTheVariantSays) {
  for (const auto& [variant, deg] :
       {std::pair(Variant::kScanOrder, 1.0), std::pair(Variant::kStart5, 5.0),
        std::pair(Variant::kStart25, 25.0), std::pair(Variant::kStart45, 45.0)}) {
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      const auto set = make_cylinder({variant, 24, seed});
      EXPECT_NEAR(degrees_between(set.start_direction, set.axis_direction), deg, 1e-9);
      EXPECT_LE(degrees_between(set.axis_direction, Eigen::Vector3d::UnitZ()), 5.0);
    }
  }
}

TEST(SampleSets, RoundedCoordinatesLieOnTheirGrid) {
  for (const auto& [variant, grid_mm] :
       {std::pair(Variant::kRounded100nm, 1e-4), std::pair(Variant::kRounded1um, 1e-3)}) {
    for (const auto& p : make_cylinder({variant, 200, 2}).points_mm) {
      for (const double x : p) EXPECT_NEAR(x / grid_mm, std::round(x / grid_mm), 1e-6);
    }
  }
}

TEST(SampleSets, SpikesAreHalfAPercentInAndOut) {
  const auto plain = make_circle({Variant::kScanOrder, 20000, 5});
  const auto spiked = make_circle({Variant::kSpikes, 20000, 5});
  int in = 0;
  int out = 0;
  for (std::size_t i = 0; i < plain.points_mm.size(); ++i) {
    const double moved_mm = (spiked.points_mm[i] - spiked.center_mm).norm() -
                            (plain.points_mm[i] - plain.center_mm).norm();
    if (std::abs(moved_mm) < 1e-9) continue;
    EXPECT_NEAR(std::abs(moved_mm), 0.012, 1e-9);
    in += moved_mm < 0.0 ? 1 : 0;
    out += moved_mm > 0.0 ? 1 : 0;
  }
  EXPECT_NEAR(in, 50, 25);  // 3.5 sigma of the count
  EXPECT_NEAR(out, 50, 25);
}

TEST(SampleSets, AnArcHoldsPointsOnItsPartOfTheCircumferenceOnly) {
  for (const double arc_deg : {60.0, 180.0}) {
    const auto set = make_circle({Variant::kScanOrder, 50, 6, arc_deg * core::kDegree});
    double largest_deg = 0.0;
    for (const auto& p : set.points_mm) {
      const Eigen::Vector2d from_center = p - set.center_mm;
      const double deg = std::atan2(from_center.y(), from_center.x()) / core::kDegree;
      EXPECT_GE(deg, -1e-9);
      largest_deg = std::max(largest_deg, deg);
    }
    EXPECT_LT(largest_deg, arc_deg);
    EXPECT_GT(largest_deg, 0.9 * arc_deg);
  }
}

}  // namespace
}  // namespace rondure::benchmarks
