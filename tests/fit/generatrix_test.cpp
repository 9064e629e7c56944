#include "fit/profiles/generatrix.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/noise.h"
#include "core/units.h"
#include "fit/geometry/column_extremes.h"
#include "fit/least_squares/cylinder.h"
#include "fit/least_squares/sections.h"
#include "fit/references/min_zone.h"
#include "tests/fit/drawing_cases.h"

// Expected numbers: methods, drawing section 12 (W2).

namespace rondure::fit {
namespace {

constexpr double kDigits = 1e-10;

class TaperedJournal : public testing::Test {
 protected:
  const test::Layers layers_ = test::w2();
  const std::vector<Eigen::Vector3d> points_ = test::all_of(layers_);
  const Axis axis_ = ls_cylinder(points_)->axis;
  const double length_ = extremes_of(points_, [&](const auto& p) {
                           return (p - axis_.point_mm).dot(axis_.direction);
                         }).width();
};

TEST_F(TaperedJournal, HasStraightGeneratricesOneByOne) {
  const auto lines = generatrices(layers_, axis_);
  ASSERT_TRUE(lines.has_value()) << lines.error().what;
  const double zone[] = {0.001633333164, 0.000801411359, 0.000966666112, 0.002262698473,
                         0.003999998872, 0.005421151974, 0.004966665269, 0.003488391981};
  double worst = 0.0;
  for (std::size_t k = 0; k < 8; ++k) {
    const auto straight = generatrix_straightness((*lines)[k].heights_mm, (*lines)[k].distances_mm);
    ASSERT_TRUE(straight.has_value());
    EXPECT_NEAR(straight->zone_mm, zone[k], kDigits);
    worst = std::max(worst, straight->ls.total_mm);
  }
  EXPECT_NEAR(worst, 0.005444722141, kDigits);
}

TEST_F(TaperedJournal, HasItsTaperAndParallelismInEveryPlane) {
  EXPECT_NEAR(length_, 60.000078132506, kDigits);
  const auto planes = opposite_generatrices(*generatrices(layers_, axis_), length_);
  ASSERT_TRUE(planes.has_value());
  ASSERT_EQ(planes->size(), 4U);
  const double tapers[] = {0.008940004424, 0.008612582072, 0.009435002017, 0.008750501283};
  const double parallel[] = {0.017959994262, 0.017324123011, 0.018829992962, 0.017564611463};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR((*planes)[k].taper_mm, tapers[k], kDigits);
    EXPECT_NEAR((*planes)[k].parallelism_mm, parallel[k], kDigits);
  }
  const auto mean = taper(points_, axis_);
  ASSERT_TRUE(mean.has_value());
  EXPECT_NEAR(mean->slope, 0.00014890850633, 1e-13);
  EXPECT_NEAR(mean->diameter_mm, 0.017869044029, kDigits);
  EXPECT_NEAR(core::degrees(mean->cone_angle_rad), 0.017063657767, kDigits);
}

TEST_F(TaperedJournal, HasABentMedianLine) {
  const auto sections = sections_across(layers_, axis_);
  ASSERT_TRUE(sections.has_value());
  EXPECT_NEAR(min_zone_line(median_line(*sections))->diameter_mm, 0.002483893854, kDigits);
}

TEST_F(TaperedJournal, OmitsGeneratricesThroughAWindow) {
  auto layers = layers_;
  layers[0].erase(layers[0].begin() + 5);
  layers[2].erase(layers[2].begin() + 2);
  const auto lines = generatrices(layers, axis_);
  ASSERT_TRUE(lines.has_value()) << lines.error().what;
  ASSERT_EQ(lines->size(), 6U);
  const auto all = *generatrices(layers_, axis_);
  for (std::size_t k = 0; k < 6; ++k) {
    const Generatrix& same = all[std::vector<std::size_t>{0, 1, 3, 4, 6, 7}[k]];
    EXPECT_EQ((*lines)[k].distances_mm, same.distances_mm);
  }
}

TEST_F(TaperedJournal, HasNoGeneratricesIfItsLayersAreStaggered) {
  auto layers = layers_;
  for (auto& p : layers[2]) p = Eigen::Vector3d(p.x() - 0.2 * p.y(), p.y() + 0.2 * p.x(), p.z());
  const auto lines = generatrices(layers, axis_);
  EXPECT_EQ(lines.error().code, core::Code::kSampling);
  EXPECT_NE(lines.error().what.find("layer 2"), std::string::npos);
  auto one = *generatrices(layers_, axis_);
  one.resize(2);
  EXPECT_EQ(opposite_generatrices(one, length_).error().code, core::Code::kSampling);
}

/// A section with lobes about a centre beside the axis.
DenseSection lobed_section(double height, const Eigen::Vector2d& center, std::size_t count) {
  DenseSection out{center, height, {0.3, std::vector<double>(count)}};
  for (std::size_t i = 0; i < count; ++i) {
    const double t = out.profile.angle_rad(i);
    out.profile.r_mm[i] =
        20.0 + 0.002 * height + 0.01 * std::cos(3.0 * t - 0.4) + 0.004 * std::sin(7.0 * t);
  }
  return out;
}

TEST(DenseGeneratrices, LieAtTheirAngleAboutTheAxis) {
  for (const std::size_t count : {360U, 361U}) {
    const Eigen::Vector2d center(0.3, -0.2);
    const auto lines = dense_generatrices(std::vector{lobed_section(5.0, center, count)});
    ASSERT_TRUE(lines.has_value());
    ASSERT_EQ(lines->size(), 36U);
    for (std::size_t k = 0; k < 36; ++k) {
      const Generatrix& line = (*lines)[k];
      EXPECT_NEAR(core::degrees(line.angle_rad), 10.0 * static_cast<double>(k), 1e-12);
      const Eigen::Vector2d from_center =
          line.distances_mm[0] *
              Eigen::Vector2d(std::cos(line.angle_rad), std::sin(line.angle_rad)) -
          center;
      const double t = std::atan2(from_center.y(), from_center.x());
      EXPECT_NEAR(from_center.norm(),
                  20.01 + 0.01 * std::cos(3.0 * t - 0.4) + 0.004 * std::sin(7.0 * t), 1e-12);
    }
  }
}

TEST(DenseGeneratrices, OfATaperWithABentAxisAreStraightOnlySquareToTheBend) {
  std::vector<DenseSection> sections;
  for (const double height : {0.0, 10.0, 20.0}) {
    sections.push_back(lobed_section(height, {height == 10.0 ? 0.006 : 0.0, 0.0}, 90));
  }
  const auto lines = dense_generatrices(sections, 4);
  ASSERT_TRUE(lines.has_value());
  const auto zone = [&](std::size_t k) {
    return generatrix_straightness((*lines)[k].heights_mm, (*lines)[k].distances_mm)->zone_mm;
  };
  EXPECT_NEAR(zone(0), 0.006, 1e-7);
  EXPECT_NEAR(zone(2), 0.006, 1e-7);
  // There the surface at another angle of the lobes comes up: 0.006 / 20 rad times their slope.
  EXPECT_LT(zone(1), 2e-5);
  EXPECT_EQ(opposite_generatrices(*lines, 20.0)->size(), 2U);
}

TEST(DenseGeneratrices, NeedAScan) {
  const std::vector<DenseSection> few = {lobed_section(0.0, {0.0, 0.0}, 7)};
  EXPECT_EQ(dense_generatrices(few).error().code, core::Code::kSampling);
  EXPECT_EQ(dense_generatrices({}).error().code, core::Code::kNoPoints);
  EXPECT_EQ(dense_generatrices(std::vector{lobed_section(0.0, {0.0, 0.0}, 90)}, 0).error().code,
            core::Code::kBadOption);
}

// With its last point twice a triangle has four points, and takes the way of any set.
TEST(MinZoneLine, OfThreePointsIsTheLeastAltitudeOfTheirTriangle) {
  core::KeyedNoise noise(3, {17});
  for (int i = 0; i < 50; ++i) {
    SCOPED_TRACE(i);
    std::vector<Eigen::Vector3d> three;
    for (int k = 0; k < 3; ++k) {
      three.emplace_back(0.01 * noise.normal(), 0.01 * noise.normal(), 20.0 * k + noise.normal());
    }
    const auto line = min_zone_line(three);
    ASSERT_TRUE(line);
    double doubled_area = (three[1] - three[0]).cross(three[2] - three[0]).norm();
    EXPECT_NEAR(line->diameter_mm, doubled_area / (three[2] - three[0]).norm(), 1e-14);
    for (const Eigen::Vector3d& p : three) {
      EXPECT_NEAR(distance_mm(line->axis, p), 0.5 * line->diameter_mm, 1e-12);
    }
    three.push_back(three.back());
    const auto four = min_zone_line(three);
    ASSERT_TRUE(four);
    EXPECT_NEAR(line->diameter_mm, four->diameter_mm, 1e-10);
  }
  const std::vector<Eigen::Vector3d> straight = {{0, 0, 0}, {1, 2, 3}, {2, 4, 6}};
  EXPECT_NEAR(min_zone_line(straight)->diameter_mm, 0.0, 1e-15);
}

}  // namespace
}  // namespace rondure::fit
