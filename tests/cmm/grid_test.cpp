#include "cmm/grid.h"

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/noise.h"
#include "core/numbers.h"
#include "core/units.h"

namespace rondure::cmm {
namespace {

using Eigen::Vector3d;

TEST(Grid, KeepsWhatLiesOnIt) {
  core::KeyedNoise random(1, {1});
  for (int i = 0; i < 5000; ++i) {
    SCOPED_TRACE(i);
    TouchCommand command;
    command.expected_tip_W_mm =
        3000.0 * Vector3d(random.normal(), random.normal(), random.normal());
    command.direction_W = Vector3d(random.normal(), random.normal(), random.normal()).normalized();
    const TouchCommand once = on_grid(command);
    const TouchCommand twice = on_grid(once);
    EXPECT_EQ(once.expected_tip_W_mm, twice.expected_tip_W_mm);
    EXPECT_EQ(once.direction_W, twice.direction_W);
    EXPECT_LT((once.expected_tip_W_mm - command.expected_tip_W_mm).cwiseAbs().maxCoeff(), 0.51e-10);
    EXPECT_LT(std::abs(once.direction_W.norm() - 1.0), 2e-15);
    const double angle = angle_on_grid(40.0 * random.normal());
    EXPECT_EQ(angle_on_grid(angle), angle);
  }
}

TEST(Grid, DirectionsAndSweepsSurviveALineOfSixteenDigits) {
  core::KeyedNoise random(2, {1});
  for (int i = 0; i < 5000; ++i) {
    SCOPED_TRACE(i);
    const Vector3d d =
        direction_on_grid(Vector3d(random.normal(), random.normal(), random.normal()));
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(core::parse_number(fmt::format("{:.15f}", d[k])), d[k]);
    }
    const double sweep = angle_on_grid(20.0 * random.normal());
    const auto degrees = core::parse_number(fmt::format("{:.10f}", sweep / core::kDegree));
    ASSERT_TRUE(degrees);
    EXPECT_EQ(angle_on_grid(*degrees * core::kDegree), sweep);
  }
}

TEST(Grid, ScalesADirectionThatIsNoUnitVector) {
  EXPECT_EQ(direction_on_grid({0.0, 0.0, -7.0}), Vector3d(0.0, 0.0, -1.0));
}

}  // namespace
}  // namespace rondure::cmm
