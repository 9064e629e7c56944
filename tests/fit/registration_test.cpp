#include "fit/geometry/registration.h"

#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/noise.h"
#include "core/units.h"
#include "tests/fit/spec_cases.h"

namespace rondure::fit {
namespace {

using Eigen::Vector3d;
using test::draw;

Eigen::Isometry3d random_motion(core::KeyedNoise& random) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.translate(draw(random, 500.0));
  out.rotate(Eigen::AngleAxisd(core::kTwoPi * random.uniform(), draw(random, 1.0).normalized()));
  return out;
}

TEST(RigidRegistration, FindsTheMotionOfExactPoints) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE(seed);
    core::KeyedNoise random(seed, {1});
    const Eigen::Isometry3d motion = random_motion(random);
    std::vector<Vector3d> from;
    std::vector<Vector3d> to;
    for (std::uint64_t i = 0; i < 3 + seed % 5; ++i) {
      from.push_back(draw(random, 200.0));
      to.emplace_back(motion * from.back());
    }
    const auto found = rigid_registration(from, to);
    ASSERT_TRUE(found) << found.error().what;
    EXPECT_LT((found->motion.matrix() - motion.matrix()).norm(), 1e-9);
    EXPECT_LT(found->largest_residual_mm, 1e-9);
    EXPECT_NEAR(found->motion.linear().determinant(), 1.0, 1e-12);
  }
}

TEST(RigidRegistration, NoSmallMotionImprovesTheFitOfNoisyPoints) {
  core::KeyedNoise random(7, {2});
  const Eigen::Isometry3d motion = random_motion(random);
  std::vector<Vector3d> from;
  std::vector<Vector3d> to;
  for (int i = 0; i < 6; ++i) {
    from.push_back(draw(random, 200.0));
    to.emplace_back(motion * from.back() + draw(random, 0.05));
  }
  const auto found = rigid_registration(from, to);
  ASSERT_TRUE(found);
  const auto sum = [&](const Eigen::Isometry3d& X) {
    double out = 0.0;
    for (std::size_t i = 0; i < from.size(); ++i) out += (X * from[i] - to[i]).squaredNorm();
    return out;
  };
  const double least = sum(found->motion);
  for (int i = 0; i < 200; ++i) {
    Eigen::Isometry3d other = found->motion;
    other.pretranslate(draw(random, 0.01));
    other.rotate(Eigen::AngleAxisd(1e-4 * random.uniform(), draw(random, 1.0).normalized()));
    EXPECT_GE(sum(other), least - 1e-12);
  }
}

TEST(RigidRegistration, RefusesWhatDoesNotDetermineAMotion) {
  const std::vector<Vector3d> two = {{0, 0, 0}, {1, 0, 0}};
  EXPECT_EQ(rigid_registration(two, two).error().code, core::Code::kTooFewPoints);
  std::vector<Vector3d> line = {{0, 0, 0}, {100, 0, 0}, {250, 0, 0}};
  EXPECT_EQ(rigid_registration(line, line).error().code, core::Code::kCollinear);
  EXPECT_EQ(rigid_registration(line, two).error().code, core::Code::kTooFewPoints);
  line[1].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(rigid_registration(line, line).error().code, core::Code::kNotFinite);
}

}  // namespace
}  // namespace rondure::fit
