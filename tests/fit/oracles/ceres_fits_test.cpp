// The least-squares fits against Ceres: 200 sets each with RONDURE_FULL=1 (dial.h), everything to
// 1e-9 mm.
#include "ceres_fits.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/noise.h"
#include "core/units.h"
#include "dial.h"
#include "fit/least_squares/circle.h"
#include "fit/least_squares/cylinder.h"

namespace rondure::test {
namespace {

constexpr int kSolverSets = 200;
constexpr double kNear = 1e-9;

/// What is measured: full turns and arcs of 90 deg and more, form up to 10 um.
struct Part {
  double radius_mm = 25.0;
  double half_length_mm = 30.0;
  double form_mm = 0.01;
  double turn_rad = core::kTwoPi;
  int points = 12;
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
};

Part draw_part(std::uint64_t seed, core::KeyedNoise& noise) {
  Part part;
  part.radius_mm = 2.0 + 98.0 * noise.uniform();
  part.half_length_mm = part.radius_mm * (0.3 + 3.0 * noise.uniform());
  part.form_mm = std::pow(10.0, -4.0 + 2.0 * noise.uniform());
  if (seed % 3 == 1) part.turn_rad = (90.0 + 200.0 * noise.uniform()) * core::kDegree;
  part.points = 8 + static_cast<int>(60.0 * noise.uniform());
  part.X.rotate(Eigen::Quaterniond(noise.normal(), noise.normal(), noise.normal(), noise.normal())
                    .normalized());
  part.X.pretranslate(200.0 * Eigen::Vector3d(noise.uniform(), noise.uniform(), noise.uniform()));
  return part;
}

TEST(CeresFits, LsCircle) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(count(kSolverSets)); ++seed) {
    SCOPED_TRACE(seed);
    core::KeyedNoise noise(seed, {111});
    const Part part = draw_part(seed, noise);
    const Eigen::Vector2d center = part.X.translation().head<2>();
    std::vector<Eigen::Vector2d> points;
    for (int k = 0; k < part.points; ++k) {
      const double angle = part.turn_rad * (k + 0.5 * noise.uniform()) / part.points;
      const double r = part.radius_mm + part.form_mm * noise.normal();
      points.emplace_back(center + r * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    const auto own = fit::ls_circle(points);
    ASSERT_TRUE(own.has_value()) << own.error().what;
    const CeresCircle other = ceres_circle(points, {center, part.radius_mm});
    EXPECT_LT((own->center_mm - other.center_mm).norm(), kNear);
    EXPECT_NEAR(own->radius_mm, other.radius_mm, kNear);
  }
}

TEST(CeresFits, LsCylinder) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(count(kSolverSets)); ++seed) {
    SCOPED_TRACE(seed);
    core::KeyedNoise noise(seed, {112});
    const Part part = draw_part(seed, noise);
    const int layers = 2 + static_cast<int>(seed % 4);
    std::vector<Eigen::Vector3d> points;
    for (int k = 0; k < layers * part.points; ++k) {
      const double angle = part.turn_rad * (k / layers + 0.5 * noise.uniform()) / part.points;
      const double z = part.half_length_mm * (2.0 * (k % layers) / (layers - 1) - 1.0);
      const double r = part.radius_mm + part.form_mm * noise.normal();
      points.emplace_back(part.X * Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), z));
    }
    const Eigen::Vector3d axis = part.X.rotation().col(2);
    const auto own = fit::ls_cylinder(points, axis + 0.02 * axis.unitOrthogonal());
    ASSERT_TRUE(own.has_value()) << own.error().what;
    const CeresCylinder other =
        ceres_cylinder(points, {part.X.translation(), axis, part.radius_mm});
    EXPECT_LT(fit::distance_mm({other.point_mm, other.direction}, own->axis.point_mm), kNear);
    EXPECT_LT(own->axis.direction.cross(other.direction).norm() * part.half_length_mm, kNear);
    EXPECT_NEAR(own->radius_mm, other.radius_mm, kNear);
  }
}

}  // namespace
}  // namespace rondure::test
