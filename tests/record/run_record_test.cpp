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
  EXPECT_EQ(name_of(Strategy::kAsPublished), "as-published");
  EXPECT_EQ(name_of(Strategy::kVirtual), "virtual");
  EXPECT_EQ(name_of(Strategy::kPointsFile), "points-file");
}

template <Worded Enum>
void read_back(std::size_t count) {
  const auto words = words_of(Enum{});
  ASSERT_EQ(words.size(), count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto value = static_cast<Enum>(i);
    SCOPED_TRACE(name_of(value));
    EXPECT_FALSE(name_of(value).empty());
    EXPECT_EQ(value_named<Enum>(name_of(value)), value);
  }
  EXPECT_FALSE(value_named<Enum>("").has_value());
  EXPECT_FALSE(value_named<Enum>("Mz").has_value());
}

TEST(RunRecord, ReadsEachWordBackAndNoOther) {
  read_back<Shape>(10);
  read_back<Side>(2);
  read_back<Form>(29);
  read_back<Reference>(4);
  read_back<Strategy>(8);
  read_back<Merge>(2);
  read_back<SamplingMethod>(2);
  read_back<Touch::Purpose>(4);
  read_back<Series::Role>(2);
}

}  // namespace
}  // namespace rondure::record
