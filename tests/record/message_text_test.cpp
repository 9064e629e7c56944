#include "record/journal/message_text.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace rondure::record {
namespace {

using core::Message;
using core::MessageCode;

/// A message of a code.
Message message_of(MessageCode code) {
  Message out{code, {}};
  double number = 2.0;
  for (const core::ArgumentKind& kind : core::arguments_of(code)) {
    if (kind.type == core::ArgumentKind::Type::kNumber) {
      out.arguments.emplace_back(number / 3.0);
    } else if (kind.type == core::ArgumentKind::Type::kText) {
      out.arguments.emplace_back("2026-11-23T01:58:52Z");
    } else {
      out.arguments.emplace_back("x: 3 of \"7\"; y {}, 4 mm after");
    }
    number = -number - 1.0;
  }
  return out;
}

TEST(MessageText, GivesEveryCodeBackFromItsJson) {
  for (int i = 0; i <= static_cast<int>(core::kLastMessageCode); ++i) {
    const Message message = message_of(static_cast<MessageCode>(i));
    const std::string json = arguments_json(message);
    SCOPED_TRACE(json);
    EXPECT_EQ(read_message(core::message_name(message.code), json), message);
  }
}

TEST(MessageText, KeepsEveryBitOfANumberAndEveryByteOfAText) {
  for (const double number : {-0.0, 0.1, 1.0 / 3.0, 5e-324, 1e300, -7.0}) {
    const Message message{MessageCode::kSingleSteps, {number}};
    const auto read = read_message("single-steps", arguments_json(message));
    ASSERT_TRUE(read);
    EXPECT_EQ(read->number(0), number);
    EXPECT_EQ(std::signbit(read->number(0)), std::signbit(number));
  }
  const Message infinite{MessageCode::kSingleSteps, {std::numeric_limits<double>::infinity()}};
  EXPECT_EQ(arguments_json(infinite), R"({"travel_speed_mm_s":null})");
  EXPECT_EQ(read_message("single-steps", R"({"travel_speed_mm_s":null})"), infinite);
  const Message text{MessageCode::kLevelPoseUnreachable,
                     {std::string("\"\\ \0 \n {} \xc3\xb8", 12)}};
  EXPECT_EQ(read_message("level-pose-unreachable", arguments_json(text)), text);
}

TEST(MessageText, RefusesWhatItWouldNotWrite) {
  EXPECT_TRUE(read_message("single-steps", R"({"travel_speed_mm_s":10})"));
  EXPECT_FALSE(read_message("single-step", R"({"travel_speed_mm_s":10})"));
  for (const char* json :
       {"", "{}", "10", R"({"travel_speed_mm_s":10.0})", R"({"travel_speed_mm_s": 10})",
        R"({"travel_speed_mm_s":10)", R"({"travel_speed_mm_s":10}})", R"({"travel_speed":10})",
        R"({"travel_speed_mm_s":"10"})", R"({"travel_speed_mm_s":10,"x":1})",
        R"({"travel_speed_mm_s":nan})", R"({"travel_speed_mm_s":)"}) {
    EXPECT_FALSE(read_message("single-steps", json)) << json;
  }
  EXPECT_TRUE(read_message("level-pose-unreachable", R"({"reason":"a"})"));
  for (const char* json : {R"({"reason":"a)", R"({"reason":"a\)", R"({"reason":"\u00"})",
                           R"({"reason":"\u0041"})", R"({"reason":7})"}) {
    EXPECT_FALSE(read_message("level-pose-unreachable", json)) << json;
  }
}

}  // namespace
}  // namespace rondure::record
