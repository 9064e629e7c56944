#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/files.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr std::size_t kSphereTouches = 13;

/// A run of the first example with changes.
struct ChangedRun {
  Scratch folder;
  Outcome outcome;

  explicit ChangedRun(const std::vector<Change>& changes) {
    write_plan(folder / "plan.json", changes);
    outcome = rondure({"run", folder / "plan.json", "--out", folder / "run"});
  }
  [[nodiscard]] record::RunRecord journal() const { return journal_of(folder / "run"); }
  [[nodiscard]] Outcome verify() const { return rondure({"verify", folder / "run"}); }
};

void expect_unfinished(const ChangedRun& run) {
  EXPECT_EQ(run.outcome.status, 3);
  EXPECT_THAT(run.outcome.out,
              ::testing::StartsWith(
                  "INCOMPLETE: 0 of 2 judged\n0 of 2 conform; CYLt of running surface: void;"));
  EXPECT_THAT(run.outcome.out, HasSubstr("not finished"));
  EXPECT_THAT(read(run.folder / "run" / "report.html"), HasSubstr("</html>"));
  const Outcome verified = run.verify();
  EXPECT_EQ(verified.status, 1);
  EXPECT_THAT(verified.out, HasSubstr("the run did not finish"));
}

TEST(SimulatedFault, AMissedTouchIsNamedAndEarlierTouchesAreKept) {
  // 2 mm: more than location_uncertainty_mm + search_mm, less than what would be in the way of the
  // approach (3 mm). The side toward the shift is touched first, the other is missed.
  const ChangedRun run({{"/part/location_uncertainty_mm", 0.1},
                        {"/machine/search_mm", 0.5},
                        {"/simulation/part/tilt_deg", 0},
                        {"/simulation/part/offset_x_mm", 2}});
  expect_unfinished(run);
  EXPECT_THAT(run.outcome.err,
              AllOf(HasSubstr("feature running surface, layer "), HasSubstr(", point "),
                    HasSubstr(" mm"), HasSubstr("check that the part"), HasSubstr("[no-touch]")));
  const auto journal = run.journal();
  EXPECT_GT(journal.touches.size(), kSphereTouches);
  ASSERT_TRUE(journal.failure);
  EXPECT_EQ(journal.failure->code, core::Code::kNoTouch);
}

TEST(SimulatedFault, ACollisionIsNamedAndEarlierTouchesAreKept) {
  const ChangedRun run({{"/simulation/part/tilt_deg", 20}});
  expect_unfinished(run);
  EXPECT_THAT(run.outcome.err,
              AllOf(HasSubstr("feature running surface, layer "), HasSubstr(", point "),
                    HasSubstr(" mm"), HasSubstr("by hand"), HasSubstr("[collision]")));
  const auto journal = run.journal();
  EXPECT_EQ(journal.touches.size(), kSphereTouches);
  ASSERT_TRUE(journal.failure);
  EXPECT_EQ(journal.failure->code, core::Code::kCollision);
}

TEST(SimulatedFault, ATipOfAnotherRadiusIsNotUsed) {
  const ChangedRun run({{"/simulation/probe/tip_radius_error_um", 250}});
  expect_unfinished(run);
  EXPECT_THAT(run.outcome.err, AllOf(HasSubstr("effective tip radius 2.2"), HasSubstr("100 um"),
                                     HasSubstr("[calibration]")));
  EXPECT_EQ(run.journal().touches.size(), kSphereTouches);
}

TEST(SimulatedFault, AProbeThatScattersIsNotUsed) {
  const ChangedRun run({{"/simulation/probe/repeatability_um", 20}});
  expect_unfinished(run);
  EXPECT_THAT(run.outcome.err, AllOf(HasSubstr("probing form"), HasSubstr("limit of 5 um"),
                                     HasSubstr("clean"), HasSubstr("[calibration]")));
  EXPECT_EQ(run.journal().touches.size(), kSphereTouches);
}

TEST(SimulatedFault, ATemperatureOutsideItsLimitsVoidsTheResult) {
  const ChangedRun run({{"/simulation/temperature_degC", 25}});
  EXPECT_EQ(run.outcome.status, 1);
  EXPECT_THAT(run.outcome.out, AllOf(::testing::StartsWith("0 of 2 conform; "),
                                     HasSubstr("temperature 25.00 °C is outside 18..22 °C")));
  EXPECT_EQ(run.verify().status, 0);
}

TEST(Verdict, AToleranceThatIsExceededDoesNotConform) {
  const ChangedRun run({{"/features/0/characteristics/0/tolerance_um", 2}});
  EXPECT_EQ(run.outcome.status, 1);
  EXPECT_THAT(run.outcome.out,
              AllOf(::testing::StartsWith("1 of 2 conforms; CYLt of running surface is "),
                    HasSubstr("over its limit of 2 µm"), HasSubstr("CYLt: does not conform")));
  EXPECT_EQ(run.verify().status, 0);
}

}  // namespace
}  // namespace rondure::app::testing
