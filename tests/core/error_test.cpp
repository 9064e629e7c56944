#include "core/error.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "core/result.h"

namespace rondure::core {
namespace {

TEST(Error, HasANameOfItsOwnForEveryCode) {
  std::set<std::string_view> names;
  const int count = static_cast<int>(kLastCode) + 1;
  for (int i = 0; i < count; ++i) names.insert(code_name(static_cast<Code>(i)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(count));
  EXPECT_EQ(code_name(static_cast<Code>(count)), "internal") << "kLastCode is not the last";
}

TEST(Error, PrintsPlaceSentenceAndCodeOnOneLine) {
  const Error error{Code::kPoseRange, "tilt 97 deg is outside -5..90 deg", ""};
  EXPECT_EQ(to_line(error), "tilt 97 deg is outside -5..90 deg [pose-range]");
  EXPECT_EQ(to_line(error.at("/fixture")),
            "/fixture: tilt 97 deg is outside -5..90 deg [pose-range]");
}

}  // namespace
}  // namespace rondure::core
