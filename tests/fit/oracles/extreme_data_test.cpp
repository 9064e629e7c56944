// The minimum-zone fits on extreme data: far away, tiny, huge, 4 to 1e5 points (1e7 with
// RONDURE_FULL=1), duplicates, spokes, discs, bars, optima with five contacts.
//
// Coordinates are rounded, so a planted optimum moves by some ulp. The truth is found again for the
// rounded points: moved back to the origin (exactly, differences of neighbouring doubles are
// doubles) and descended in long double from the planted place.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "descent.h"
#include "dial.h"
#include "fit/references/min_zone.h"
#include "planted.h"

namespace rondure::test {
namespace {

/// What happens to a planted set.
struct Extreme {
  std::string name;
  Plot plot;
  double far_mm = 0.0;
  bool duplicates = false;  ///< Every point twice.
  bool spokes = false;      ///< Every point with another one on its ray, inside the zone.
};

double ulp(double value) {
  return std::nextafter(value, std::numeric_limits<double>::infinity()) - value;
}

/// Not below the truth by more than 1e-12 mm or 16 ulp of the largest coordinate; not above it by
/// more than 1e-10 mm, or 16 ulp of the radius where that is more, and 8 ulp of the largest
/// coordinate: a place that is stated in doubles cannot be nearer to the optimum.
template <class Points>
void expect_zone(double width_mm, Real truth_mm, const Points& points, double radius_mm) {
  double largest = 0.0;
  for (const auto& p : points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  const auto excess = static_cast<double>(width_mm - truth_mm);
  EXPECT_GE(excess, -std::max(1e-12, 16.0 * ulp(largest)));
  const double stated = largest > 1e4 ? 8.0 * ulp(largest) : 0.0;
  EXPECT_LE(excess, std::max(1e-10, 16.0 * ulp(radius_mm)) + stated);
}

/// Duplicates and spokes, then the move; `axial` leaves what a spoke must not change.
template <class Points, class Inward>
void spoil(Points& points, const Extreme& extreme, const Inward& inward) {
  const std::size_t n = points.size();
  for (std::size_t i = 0; extreme.duplicates && i < n; ++i) points.push_back(points[i]);
  for (std::size_t i = 0; extreme.spokes && i < n; ++i) points.push_back(inward(points[i]));
  for (auto& p : points) p.array() += extreme.far_mm;
}

template <class Points>
Points back(const Points& points, double far_mm) {
  Points out = points;
  for (auto& p : out) p.array() -= far_mm;
  return out;
}

/// The points that can touch the zone: those in the outer 2.2 % of the form on either side.
template <class Points, class Distance>
Points edge(const Points& points, const Optimum& optimum, const Distance& distance) {
  const double margin = 0.022 * optimum.form_mm;
  Points out;
  for (const auto& p : points) {
    const double r = distance(p);
    if (r < optimum.inner_mm + margin || r > optimum.outer_mm - margin) out.push_back(p);
  }
  return out;
}

std::vector<Extreme> circles() {
  const Reference mz = Reference::kMinZone;
  return {{"tiny", {mz, 1e-3, 0.0, 1e-6}},
          {"huge", {mz, 1e5, 0.0, 1.0}},
          {"huge with a form of 1 um", {mz, 1e5, 0.0, 1e-3}},
          {"contacts only", {mz, 25.0, 0.0, 0.02, 0.0, 0}},
          {"duplicates", {mz, 25.0, 0.0, 0.02}, 0.0, true},
          {"spokes", {mz, 25.0, 0.0, 0.02}, 0.0, false, true},
          {"thousands", {mz, 25.0, 0.0, 0.02, 0.0, 10000}}};
}

void expect_circle(const Extreme& extreme, std::uint64_t seed) {
  SCOPED_TRACE(extreme.name + " " + std::to_string(seed));
  PlantedCircle set = plant_circle(extreme.plot, seed);
  const double middle = (set.optimum.inner_mm + set.optimum.outer_mm) / 2.0;
  spoil(set.points, extreme, [&](const Eigen::Vector2d& p) {
    return Eigen::Vector2d(p * ((0.5 * p.norm() + 0.5 * middle) / p.norm()));
  });
  const Points2 local = back(set.points, extreme.far_mm);
  const Points2 near = edge(local, set.optimum, [](const auto& p) { return p.norm(); });
  const CircleOptimum truth =
      descend(near, Vector2r::Zero(), Reference::kMinZone, set.optimum.form_mm);
  const Extremes all = extremes(local, truth.center_mm);
  ASSERT_EQ(all.value_mm(Reference::kMinZone), truth.at.value_mm(Reference::kMinZone));
  const auto zone = fit::min_zone_circle(set.points);
  ASSERT_TRUE(zone.has_value()) << zone.error().what;
  expect_zone(zone->width_mm(), truth.at.value_mm(Reference::kMinZone), set.points,
              extreme.plot.radius_mm);
}

std::vector<Extreme> far_circles() {
  const Reference mz = Reference::kMinZone;
  return {{"far", {mz, 25.0, 0.0, 0.02}, 1e6},
          {"far duplicates on spokes", {mz, 25.0, 0.0, 0.02}, 1e6, true, true}};
}

TEST(ExtremeData, MinZoneCircle) {
  for (const Extreme& extreme : circles()) {
    for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(count(40)); ++seed) {
      expect_circle(extreme, seed);
    }
  }
}

TEST(ExtremeData, MinZoneCircleFarAway) {
  for (const Extreme& extreme : far_circles()) {
    for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(count(40)); ++seed) {
      expect_circle(extreme, seed);
    }
  }
}

std::vector<Extreme> cylinders() {
  const Reference mz = Reference::kMinZone;
  return {{"far", {mz, 25.0, 35.0, 0.02}, 1e6},
          {"tiny", {mz, 1e-3, 2e-3, 1e-6}},
          {"huge", {mz, 1e5, 1e5, 1.0}},
          {"contacts and one layer pair", {mz, 25.0, 35.0, 0.02, 0.0, 0}},
          {"duplicates", {mz, 25.0, 35.0, 0.02}, 0.0, true},
          {"spokes", {mz, 25.0, 35.0, 0.02}, 0.0, false, true},
          {"far duplicates on spokes", {mz, 25.0, 35.0, 0.02}, 1e6, true, true},
          {"disc", {mz, 25.0, 0.5, 0.02}},
          {"bar", {mz, 2.0, 200.0, 0.02}},
          {"five contacts", {mz, 25.0, 35.0, 0.02, 0.0, 20, true}},
          {"five contacts far", {mz, 25.0, 35.0, 0.02, 0.0, 20, true}, 1e6},
          {"five contacts on a disc", {mz, 25.0, 3.0, 0.02, 0.0, 20, true}},
          {"thousands", {mz, 25.0, 35.0, 0.02, 0.0, 10000}}};
}

void expect_cylinder(const Extreme& extreme, std::uint64_t seed) {
  SCOPED_TRACE(extreme.name + " " + std::to_string(seed));
  PlantedCylinder set = plant_cylinder(extreme.plot, seed);
  const double middle = (set.optimum.inner_mm + set.optimum.outer_mm) / 2.0;
  const auto axial = [&](const Eigen::Vector3d& p) {
    return Eigen::Vector3d(set.direction * set.direction.dot(p));
  };
  const auto distance = [&](const Eigen::Vector3d& p) { return (p - axial(p)).norm(); };
  spoil(set.points, extreme, [&](const Eigen::Vector3d& p) {
    const double r = distance(p);
    return Eigen::Vector3d(axial(p) + (p - axial(p)) * ((0.5 * r + 0.5 * middle) / r));
  });
  const Points3 local = back(set.points, extreme.far_mm);
  const Points3 near = edge(local, set.optimum, distance);
  const AxisOptimum truth = descend(near, Vector3r::Zero(), set.direction.cast<Real>(),
                                    Reference::kMinZone, set.optimum.form_mm);
  const Extremes all = extremes(local, truth.point_mm, truth.direction);
  ASSERT_NEAR(static_cast<double>(all.value_mm(Reference::kMinZone) -
                                  truth.at.value_mm(Reference::kMinZone)),
              0.0, 1e-17 * (extreme.plot.radius_mm + extreme.plot.half_length_mm));
  const auto zone =
      fit::min_zone_cylinder(set.points, set.direction + 0.01 * set.direction.unitOrthogonal());
  ASSERT_TRUE(zone.has_value()) << zone.error().what;
  expect_zone(zone->width_mm(), truth.at.value_mm(Reference::kMinZone), set.points,
              extreme.plot.radius_mm);
}

TEST(ExtremeData, MinZoneCylinder) {
  for (const Extreme& extreme : cylinders()) {
    for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(count(40)); ++seed) {
      expect_cylinder(extreme, seed);
    }
  }
}

TEST(ExtremeData, MillionsOfPoints) {
  const int fill = cases(100000, 10000000);
  expect_circle({"circle", {Reference::kMinZone, 25.0, 0.0, 0.02, 0.0, fill}}, 1);
  expect_cylinder({"cylinder", {Reference::kMinZone, 25.0, 35.0, 0.02, 0.0, fill}}, 1);
}

TEST(ExtremeData, CocircularPointsHaveNoZoneFarAwayEither) {
  for (const double far_mm : {0.0, 1000.0, 1e6}) {  // sums of small whole numbers: exact
    Points2 points;
    for (const double a : {-24.0, -7.0, 7.0, 24.0}) {
      const double b = std::sqrt(625.0 - a * a);
      points.emplace_back(far_mm + a, far_mm + b);
      points.emplace_back(far_mm + a, far_mm - b);
    }
    const auto zone = fit::min_zone_circle(points);
    ASSERT_TRUE(zone.has_value()) << zone.error().what;
    EXPECT_GE(zone->width_mm(), 0.0);
    EXPECT_LE(zone->width_mm(), 1e-10);
  }
}

}  // namespace
}  // namespace rondure::test
