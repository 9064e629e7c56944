#include "record/journal/message_text.h"

#include <cmath>
#include <filesystem>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "record/journal/journal.h"
#include "tests/record/meddle.h"
#include "tests/record/sample_run.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;
using core::Message;
using core::MessageCode;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A message of a code, its numbers as old sentences round them.
Message message_of(MessageCode code) {
  Message out{code, {}};
  double number = 2.0;
  for (const core::ArgumentKind& kind : core::arguments_of(code)) {
    if (kind.type == core::ArgumentKind::Type::kNumber) {
      out.arguments.emplace_back(number + 137.0 * kind.same_within);
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
  const Message text{MessageCode::kSentence, {std::string("\"\\ \0 \n {} \xc3\xb8", 12)}};
  EXPECT_EQ(read_message("sentence", arguments_json(text)), text);
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
  for (const char* json : {R"({"sentence":"a)", R"({"sentence":"a\)", R"({"sentence":"\u00"})",
                           R"({"sentence":"\u0041"})", R"({"sentence":7})"}) {
    EXPECT_FALSE(read_message("sentence", json)) << json;
  }
}

TEST(OldSentences, AreReadBackToTheMessageTheyWereMadeOf) {
  for (int i = 0; i <= static_cast<int>(core::kLastMessageCode); ++i) {
    const Message message = message_of(static_cast<MessageCode>(i));
    const std::string sentence = old_sentence(message);
    SCOPED_TRACE(sentence);
    const Message read = read_old_sentence(sentence);
    EXPECT_EQ(read.code, message.code);
    EXPECT_TRUE(core::say_the_same(read, message));
    EXPECT_EQ(old_sentence(read), sentence);
  }
  EXPECT_EQ(read_old_sentence("pose (1.0000, x) deg: turning away").code, MessageCode::kSentence);
}

TEST(OldSentences, OfTheStoredJournalOfVersion5AreAllKnown) {
  const auto read = read_journal(fs::path(RONDURE_SOURCE_DIR) / "tests/data/journal_v5");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->version, 5);
  EXPECT_TRUE(read->record.sealed);
  EXPECT_THAT(read->broken, IsEmpty());
  const auto& decisions = read->record.decisions;
  ASSERT_EQ(decisions.size(), 4U);
  EXPECT_EQ(decisions[0].message.code, MessageCode::kFixtureBaseFound);
  EXPECT_EQ(decisions[1].message.code, MessageCode::kPartLocated);
  EXPECT_EQ(decisions[2].message,
            (Message{MessageCode::kLevellingStep, {1.41, -1.706, 4.9, 1.414, -1.7082}}));
  EXPECT_EQ(decisions[2].sentence,
            "pose (1.4100, -1.7060) deg: zone of the cloud 4.900 um; turning to (1.4140, -1.7082) "
            "deg");
  EXPECT_EQ(decisions[3].message.code, MessageCode::kLevelToScatter);
}

TEST(JournalDecisions, ThatNoRunDecidesAreRefused) {
  const Scratch scratch;
  ASSERT_TRUE(write_run(scratch / "run", sample_run(3, 3)));
  meddle(scratch / "run/journal.db", "update decision set code = 'part-lost' where id = 1");
  const auto read = read_journal(scratch / "run");
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().what, HasSubstr("decision holds \"part-lost\""));
}

}  // namespace
}  // namespace rondure::record
