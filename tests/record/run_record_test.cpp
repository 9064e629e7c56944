#include "record/run_record.h"

#include <gtest/gtest.h>

namespace rondure::record {
namespace {

TEST(RunRecord, SpellsWordsAsPlansDo) {
  EXPECT_EQ(name_of(Shape::kCylinder), "cylinder");
  EXPECT_EQ(name_of(Shape::kCircle), "circle");
  EXPECT_EQ(name_of(Side::kOutside), "outside");
  EXPECT_EQ(name_of(Side::kInside), "inside");
  EXPECT_EQ(name_of(Form::kCylindricity), "cylindricity");
  EXPECT_EQ(name_of(Form::kRoundness), "roundness");
  EXPECT_EQ(name_of(Reference::kLeastSquares), "ls");
  EXPECT_EQ(name_of(Reference::kMinimumZone), "mz");
  EXPECT_EQ(name_of(Reference::kMinimumCircumscribed), "mc");
  EXPECT_EQ(name_of(Reference::kMaximumInscribed), "mi");
  EXPECT_EQ(name_of(Strategy::kGuided), "guided");
  EXPECT_EQ(name_of(Strategy::kRefined), "refined");
  EXPECT_EQ(name_of(Strategy::kAsPublished), "as-published");
  EXPECT_EQ(name_of(Strategy::kVirtual), "virtual");
  EXPECT_EQ(name_of(Strategy::kPointsFile), "points-file");
}

}  // namespace
}  // namespace rondure::record
