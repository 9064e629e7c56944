#include "fit/profiles/form_parameters.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/noise.h"
#include "core/units.h"
#include "fit/datums/datum.h"
#include "fit/least_squares/cylinder.h"
#include "fit/profiles/generatrix.h"
#include "fit/references/min_zone.h"

namespace rondure::fit {
namespace {

using Points3 = std::vector<Eigen::Vector3d>;

/// A cylinder r = 25 + taper z + 3 um cos(3 theta) about a tilted axis far from the origin.
struct Part {
  Axis axis{{300.0, -200.0, 80.0}, Eigen::Vector3d(0.2, -0.1, 0.9).normalized()};

  [[nodiscard]] Eigen::Vector3d at(double theta, double z, double r) const {
    const auto u = across(axis.direction);
    return axis.point_mm + z * axis.direction +
           r * (std::cos(theta) * u.col(0) + std::sin(theta) * u.col(1));
  }
  [[nodiscard]] Points3 surface(double taper) const {
    Points3 points;
    for (int layer = -2; layer <= 2; ++layer) {
      for (int k = 0; k < 36; ++k) {
        const double theta = core::kTwoPi * k / 36.0;
        points.push_back(
            at(theta, 10.0 * layer, 25.0 + taper * 10.0 * layer + 3e-3 * std::cos(3.0 * theta)));
      }
    }
    return points;
  }
};

TEST(FormParameters, AreTotalPeakValleyAndRms) {
  const std::vector<double> d = {3.0, -1.0, -2.0, 0.0};
  const auto p = form_parameters(d);
  EXPECT_EQ(p.total_mm, 5.0);
  EXPECT_EQ(p.peak_mm, 3.0);
  EXPECT_EQ(p.valley_mm, 2.0);
  EXPECT_DOUBLE_EQ(p.rms_mm, std::sqrt(14.0 / 4.0));
  const std::vector<double> cells = {1.0, 0.0, 0.0, 3.0};
  EXPECT_DOUBLE_EQ(form_parameters(d, cells).rms_mm, 1.5);
}

TEST(FormParameters, OfACylinderAgreeWithItsFits) {
  const Points3 points = Part{}.surface(1e-5);
  const auto ls = ls_cylinder(points);
  const auto mz = min_zone_cylinder(points);
  ASSERT_TRUE(ls && mz);
  const auto p = cylindricity_parameters(points, ls->axis, ls->radius_mm);
  ASSERT_TRUE(p.has_value());
  EXPECT_NEAR(p->total_mm, ls->deviation_mm, 1e-12);
  EXPECT_NEAR(p->peak_mm + p->valley_mm, p->total_mm, 1e-15);
  EXPECT_NEAR(p->rms_mm, ls->rms_mm, 1e-12);
  EXPECT_NEAR(p->peak_mm, 3.2e-3, 1e-8);
  const auto zone =
      cylindricity_parameters(points, mz->axis, 0.5 * (mz->inner_radius_mm + mz->outer_radius_mm));
  EXPECT_NEAR(zone->total_mm, mz->width_mm(), 1e-12);
  EXPECT_LE(zone->total_mm, p->total_mm + 1e-12);
  const auto bore = cylindricity_parameters(points, ls->axis, ls->radius_mm, true);
  EXPECT_EQ(bore->peak_mm, p->valley_mm);
  EXPECT_EQ(cylindricity_parameters({}, ls->axis, 1.0).error().code, core::Code::kNoPoints);
}

TEST(Generatrix, TaperIsTheLeastSquaresSlopeOfTheRadii) {
  const Part part;
  const auto t = taper(part.surface(2e-4), part.axis);
  ASSERT_TRUE(t.has_value());
  EXPECT_NEAR(t->slope, 2e-4, 1e-12);
  EXPECT_NEAR(t->diameter_mm, 2.0 * 2e-4 * 40.0, 1e-10);
  EXPECT_NEAR(t->cone_angle_rad, 2.0 * std::atan(2e-4), 1e-12);
  Points3 section;
  for (int k = 0; k < 9; ++k) section.push_back(part.at(0.7 * k, 5.0, 25.0));
  EXPECT_EQ(taper(section, part.axis).error().code, core::Code::kRank);
}

/// Least strip of a set: one of its sides lies along two of the points.
double strip_by_trial(const std::vector<double>& z, const std::vector<double>& r) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < z.size(); ++i) {
    for (std::size_t j = i + 1; j < z.size(); ++j) {
      if (z[i] == z[j] && r[i] == r[j]) continue;
      const Eigen::Vector2d n = Eigen::Vector2d(r[i] - r[j], z[j] - z[i]).normalized();
      double low = std::numeric_limits<double>::infinity();
      double high = -low;
      for (std::size_t k = 0; k < z.size(); ++k) {
        const double at = n.dot(Eigen::Vector2d(z[k], r[k] - r[0]));
        low = std::min(low, at);
        high = std::max(high, at);
      }
      best = std::min(best, high - low);
    }
  }
  return best;
}

TEST(Generatrix, ZoneAgreesWithAllStripsThroughTwoPoints) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    core::KeyedNoise noise(seed, {19});
    std::vector<double> z;
    std::vector<double> r;
    for (std::size_t i = 0; i < 3 + seed % 20; ++i) {
      z.push_back(300.0 + 40.0 * noise.uniform());
      r.push_back(25.0 + 0.02 * z.back() + 4e-3 * noise.normal());
    }
    const auto s = generatrix_straightness(z, r);
    ASSERT_TRUE(s.has_value()) << s.error().what;
    EXPECT_NEAR(s->zone_mm, strip_by_trial(z, r), 1e-12);
    EXPECT_LE(s->zone_mm, s->ls.total_mm + 1e-13);
  }
}

TEST(Generatrix, ZoneIsTheNarrowestStripInAnyDirection) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    core::KeyedNoise noise(seed, {20});
    std::vector<double> z;
    std::vector<double> r;
    for (std::size_t i = 0; i < 3 + seed % 9; ++i) {  // as wide as long, with repeated points
      z.push_back(i % 5 == 4 ? z.front() : 10.0 * noise.uniform());
      r.push_back(i % 5 == 4 ? r.front() : 10.0 * noise.uniform());
    }
    const auto s = generatrix_straightness(z, r);
    ASSERT_TRUE(s.has_value()) << s.error().what;
    EXPECT_NEAR(s->zone_mm, strip_by_trial(z, r), 1e-12);
  }
}

TEST(Generatrix, StraightnessOfAKnownLine) {
  const std::vector<double> z = {0.0, 10.0, 20.0, 30.0};
  const std::vector<double> r = {25.0, 25.003, 25.003, 25.0};
  const auto s = generatrix_straightness(z, r);
  ASSERT_TRUE(s.has_value());
  EXPECT_NEAR(s->ls_slope, 0.0, 1e-15);
  EXPECT_NEAR(s->ls.peak_mm, 1.5e-3, 1e-13);
  EXPECT_NEAR(s->ls.rms_mm, 1.5e-3, 1e-13);
  EXPECT_NEAR(s->zone_mm, 3e-3, 1e-13);
}

TEST(Generatrix, RefusesWhatHasNoLength) {
  const std::vector<double> one(3, 5.0);
  EXPECT_EQ(generatrix_straightness(one, one).error().code, core::Code::kRank);
  const std::vector<double> two = {1.0, 2.0};
  EXPECT_EQ(generatrix_straightness(two, two).error().code, core::Code::kTooFewPoints);
  EXPECT_EQ(generatrix_straightness(two, one).error().code, core::Code::kNoPoints);
  const std::vector<double> nan = {1.0, 2.0, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_EQ(generatrix_straightness(nan, one).error().code, core::Code::kNotFinite);
}

TEST(Datum, CoaxialityIsTwiceTheGreatestDistance) {
  const Part part;
  const Points3 median = {part.at(0.3, -20.0, 4e-3), part.at(2.0, 0.0, 1e-3),
                          part.at(5.0, 20.0, 6e-3)};
  EXPECT_NEAR(*coaxiality_mm(median, part.axis), 12e-3, 1e-12);
  EXPECT_EQ(coaxiality_mm({}, part.axis).error().code, core::Code::kNoPoints);
}

}  // namespace
}  // namespace rondure::fit
