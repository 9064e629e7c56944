#include "plans/run/internal/fixture_base.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/noise.h"
#include "plans/forecast/forecast.h"
#include "tests/plans/fixture_base.h"

namespace rondure::plans {
namespace {

using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::HasSubstr;

Plan plan_with_base(const Vector3d& offset_mm, const Vector3d& rotation_deg) {
  DatumPlan datum;
  datum.spheres = {{{-200.0, -150.0, 60.0}}, {{-200.0, 150.0, 60.0}}, {{200.0, -150.0, 60.0}}};
  datum.uncertainty_mm = 3.0;
  return testing::spool_on(datum, offset_mm, rotation_deg);
}

using testing::Ran;

Ran run(const Plan& plan) { return testing::ran(plan); }

TEST(FixtureBase, IsRecoveredToANanometre) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    SCOPED_TRACE(seed);
    core::KeyedNoise random(seed, {1});
    const auto draw = [&](double size) { return size * (2.0 * random.uniform() - 1.0); };
    const Vector3d offset(draw(1.0), draw(1.0), draw(1.0));
    const Vector3d rotation(draw(0.2), draw(0.2), draw(0.2));
    const Plan plan = plan_with_base(offset, rotation);
    const Ran result = run(plan);
    ASSERT_FALSE(result.failure) << result.failure->what;
    const auto found =
        fixture_base(plan, testing::base_touches(plan, result.record), testing::kSpoolTip_mm);
    ASSERT_TRUE(found) << found.error().what;
    const Eigen::Isometry3d truth = testing::base_at(offset, rotation);
    for (const Vector3d& p : {Vector3d(0.0, 0.0, 150.0), Vector3d(200.0, 150.0, 250.0)}) {
      EXPECT_LT((found->motion * p - truth * p).norm(), 1e-6);
    }
    EXPECT_LT(found->largest_residual_mm, 1e-6);
  }
}

TEST(FixtureBase, BringsThePartUprightAndWithinTheFirstSearch) {
  // 1.4 mm and 0.5 deg off, far beyond what the location of the part may make good.
  Plan plan = plan_with_base({1.2, -0.7, 0.4}, {0.3, -0.4, 0.2});
  plan.part.location_uncertainty_mm = 0.3;
  const Ran with = run(plan);
  ASSERT_FALSE(with.failure) << with.failure->what;
  EXPECT_EQ(with.record.decisions.front().message.code, core::MessageCode::kFixtureBaseFound);
  plan.fixture->datum.reset();
  const Ran without = run(plan);
  ASSERT_TRUE(without.failure);
  EXPECT_EQ(without.failure->code, core::Code::kLocation) << without.failure->what;
}

TEST(FixtureBase, RefusesSpheresThatDoNotFitOrStandTooFarOff) {
  Plan plan = plan_with_base({0.1, 0.0, 0.0}, {0.0, 0.0, 0.0});
  const auto touches = testing::base_touches(plan, run(plan).record);
  plan.fixture->datum->spheres[1].center_mm[1] += 0.1;
  const auto crooked = fixture_base(plan, touches, testing::kSpoolTip_mm);
  ASSERT_FALSE(crooked);
  EXPECT_EQ(crooked.error().code, core::Code::kCalibration);
  EXPECT_THAT(crooked.error().what, HasSubstr("the limit is 20 um (residual_limit_um)"));
  plan.fixture->datum->uncertainty_mm = 0.05;
  const auto far = fixture_base(plan, touches, testing::kSpoolTip_mm);
  ASSERT_FALSE(far);
  EXPECT_EQ(far.error().code, core::Code::kLocation);
  EXPECT_THAT(far.error().what,
              AllOf(HasSubstr("sphere 1 of the fixture stands 0.100 mm"), HasSubstr("0.05 mm")));
}

TEST(FixtureBase, ARunThatEndsAtASphereSaysAtWhich) {
  Plan plan = plan_with_base({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
  const auto touches = run(plan).record.touches;
  const auto second = std::find_if(touches.begin(), touches.end(), [](const record::Touch& touch) {
    return touch.purpose == record::Touch::Purpose::kLocate && touch.pose < 0 && touch.layer == 1;
  });
  ASSERT_NE(second, touches.end());
  plan.simulation->faults.connection_lost_at_touch = static_cast<int>(second - touches.begin()) + 1;
  const auto failure = run(plan).failure;
  ASSERT_TRUE(failure);
  EXPECT_THAT(failure->what, HasSubstr("sphere 2 of the fixture, point 1: "));
}

TEST(FixtureBase, IsTakenFromTheJournalByARunThatGoesOn) {
  testing::expect_resumed_bits(plan_with_base({0.6, -0.2, 0.3}, {0.1, 0.1, -0.1}),
                               {5, 13, 20, 34, 36, 50});
}

TEST(FixtureBase, IsForetold) {
  const Plan plan = plan_with_base(Vector3d::Zero(), Vector3d::Zero());
  const auto told = forecast(plan);
  ASSERT_TRUE(told) << told.error().what;
  ASSERT_EQ(told->stages.size(), 4U);
  EXPECT_EQ(told->stages[1].kind, ForecastStage::Kind::kBase);
  EXPECT_EQ(told->stages[1].touches, 21);
  EXPECT_EQ(run(plan).record.touches.size(), static_cast<std::size_t>(told->touches));
}

}  // namespace
}  // namespace rondure::plans
