#include "core/message.h"

#include <cctype>
#include <limits>
#include <set>

#include <gtest/gtest.h>

namespace rondure::core {
namespace {

TEST(Message, HasANameOfItsOwnForEveryCode) {
  std::set<std::string_view> names;
  for (int i = 0; i <= static_cast<int>(kLastMessageCode); ++i) {
    const auto code = static_cast<MessageCode>(i);
    const std::string_view name = message_name(code);
    EXPECT_TRUE(names.insert(name).second) << name;
    EXPECT_EQ(message_named(name), code);
    for (const char c : name) EXPECT_TRUE(c == '-' || std::islower(c) != 0) << name;
  }
  EXPECT_FALSE(message_named("Part-Located"));
}

TEST(Message, NamesEachArgumentOnce) {
  for (int i = 0; i <= static_cast<int>(kLastMessageCode); ++i) {
    const auto code = static_cast<MessageCode>(i);
    std::set<std::string_view> names;
    for (const ArgumentKind& kind : arguments_of(code)) {
      EXPECT_TRUE(names.insert(kind.name).second) << message_name(code) << ' ' << kind.name;
    }
    EXPECT_FALSE(names.empty()) << message_name(code);
  }
}

TEST(Message, SaysTheSameWithinOneUnitOfTheLastDigitShown) {
  const auto ended = [](double f_um) {
    return Message{MessageCode::kPoseSearchEnded, {0.0, 0.0, 9.0, f_um}};
  };
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(say_the_same(ended(4.7684), ended(4.768)));
  EXPECT_FALSE(say_the_same(ended(4.7704), ended(4.769)));
  EXPECT_TRUE(say_the_same(ended(kInfinity), ended(kInfinity)));
  EXPECT_FALSE(say_the_same(ended(kInfinity), ended(4.7)));
  const auto located = [](double touches, const char* reason) {
    return Message{MessageCode::kPartLocatedAgain, {touches, reason}};
  };
  EXPECT_TRUE(say_the_same(located(60, "it moved"), located(60, "in other words")));
  EXPECT_FALSE(say_the_same(located(60, "it moved"), located(61, "it moved")));
  const auto resumed = [](const char* utc) {
    return Message{MessageCode::kRunResumed, {utc, 60.0, 3.0, 0.1, 5.0}};
  };
  EXPECT_FALSE(say_the_same(resumed("2026-11-23T01:58:52Z"), resumed("2026-11-23T01:58:53Z")));
}

}  // namespace
}  // namespace rondure::core
