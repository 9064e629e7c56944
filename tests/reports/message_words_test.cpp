#include "reports/words/internal/messages.h"

#include <array>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "reports/words/internal/facts.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::Message;
using core::MessageCode;

/// One message of each code.
std::vector<Message> all_messages() {
  std::vector<Message> out;
  for (int i = 0; i <= static_cast<int>(core::kLastMessageCode); ++i) {
    Message message{static_cast<MessageCode>(i), {}};
    double number = 12.0;
    for (const core::ArgumentKind& kind : core::arguments_of(message.code)) {
      if (kind.type == core::ArgumentKind::Type::kNumber) {
        message.arguments.emplace_back(number++);
      } else {
        message.arguments.emplace_back("not declared");  // words that are known in Chinese
      }
    }
    out.push_back(std::move(message));
  }
  return out;
}

/// Their English sentences.
constexpr std::array<std::string_view, 16> kEnglish = {
    "part located in pose (12.0000, 13.0000) deg: its axis is level at (14.0000, "
    "15.0000) deg",
    "pose (12.0000, 13.0000) deg: zone of the cloud 14.000 um; turning to (15.0000, "
    "16.0000) deg",
    "pose (12.0000, 13.0000) deg: zone of the cloud 14.000 um; as level as the fixture "
    "can be set: 15.000000 deg is left, its resolution is 16.000000 deg",
    "pose (12.0000, 13.0000) deg: zone of the cloud 14.000 um; as level as probe and "
    "fixture scatter: the step of 15.000000 deg is not below half the last one",
    "pose (12.0000, 13.0000) deg: zone of the cloud 14.000 um; not level: the "
    "levelling pose (15.0000, 16.0000) deg is beyond the limits of the fixture",
    "not level: not declared",
    "pose (12.0000, 13.0000) deg: zone of the cloud 14.000 um; not level after 15 "
    "poses: a step of 16.0000 deg is left",
    "pose search ended at (12.0000, 13.0000) deg after 14 poses with f = 15.000 um, a "
    "search value; that pose is measured anew",
    "pose (12.0000, 13.0000) deg: 14 of 15 targets can be reached",
    "base of the fixture, or of a part without one: shifted by (12.0000, 13.0000, 14.0000) mm, "
    "turned by (15.00000, 16.00000, 17.00000) deg, largest residual 18.000 um",
    "single-step mode: travel at 12 mm/s at most, moves confirmed by the operator",
    "resumed on not declared after 12 touches; the last 13 repeated, largest "
    "difference 14.000 um, limit 15 um",
    "part located again behind 12 touches: not declared",
    "not declared is clamped after 12 touches, confirmed on not declared",
    "the features that follow are void, the fixture is taken as nominal: not declared",
    "the correction is loaded into the control, confirmed on not declared"};

TEST(MessageWords, AreTheEnglishSentenceOfEveryCode) {
  const std::vector<Message> messages = all_messages();
  ASSERT_EQ(messages.size(), kEnglish.size());
  for (std::size_t i = 0; i < messages.size(); ++i) {
    EXPECT_EQ(in_words(messages[i]), kEnglish.at(i));
    EXPECT_EQ(english_sentence(messages[i]), kEnglish.at(i));
  }
}

TEST(MessageWords, AreChineseForEveryCode) {
  const LanguageScope chinese(Language::kChinese);
  for (const Message& message : all_messages()) {
    const auto words = in_words(message);
    ASSERT_TRUE(words) << core::message_name(message.code);
    for (const char* english : {"pose", "touches", "the ", "level"}) {
      EXPECT_EQ(words->find(english), std::string::npos) << *words;
    }
    EXPECT_EQ(english_sentence(message), kEnglish.at(static_cast<std::size_t>(message.code)));
  }
  EXPECT_EQ(in_words({MessageCode::kTargetsReachable, {0.5, -1.0, 20.0, 28.0}}),
            "位姿 (0.5000, -1.0000) deg：28 个测点中可达 20 个");
}

TEST(MessageWords, AreNoneWhereAReasonIsNotKnownInTheLanguage) {
  const Message again{MessageCode::kPartLocatedAgain, {60.0, "something that nobody translated"}};
  EXPECT_TRUE(in_words(again));
  const LanguageScope chinese(Language::kChinese);
  EXPECT_FALSE(in_words(again));
}

TEST(MessageWords, SayInChineseHowMuchTheFixtureAdds) {
  evaluation::MergedPoses merged;
  merged.solved.emplace();
  merged.solved->u_naive_mm = 1.5e-3;
  const LanguageScope chinese(Language::kChinese);
  EXPECT_TRUE(
      in_words(share_in_words(merged))
          ->starts_with("各位姿仅按运动学合并：其声明的不确定度使 CYLt 变化 1.500 um（均方根）"))
      << share_in_words(merged).english();
  merged.joint = true;
  merged.solved->naive_mm = 8.25e-3;
  EXPECT_TRUE(in_words(share_in_words(merged))->starts_with("仅按夹具运动学将得到 CYLt 8.250 um："))
      << share_in_words(merged).english();
}

}  // namespace
}  // namespace rondure::reports
