#include "fit/profiles/generatrix.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"
#include "fit/geometry/column_extremes.h"
#include "fit/least_squares/cylinder.h"
#include "fit/least_squares/sections.h"
#include "fit/references/min_zone_line.h"
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

}  // namespace
}  // namespace rondure::fit
