#include "reports/words/internal/messages.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "record/journal/journal.h"
#include "record/journal/message_text.h"
#include "reports/words/internal/facts.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

using core::Message;
using core::MessageCode;

/// One message of each code with a sentence of its own.
std::vector<Message> all_messages() {
  std::vector<Message> out;
  for (int i = 0; i <= static_cast<int>(core::kLastMessageCode); ++i) {
    Message message{static_cast<MessageCode>(i), {}};
    double number = 12.0;
    for (const core::ArgumentKind& kind : core::arguments_of(message.code)) {
      if (kind.type == core::ArgumentKind::Type::kNumber) {
        message.arguments.emplace_back(number++ + 0.3 * kind.same_within);
      } else {
        message.arguments.emplace_back("not declared");  // words that are known in Chinese
      }
    }
    out.push_back(std::move(message));
  }
  return out;
}

TEST(MessageWords, AreInEnglishThoseOfJournalsBeforeVersion6) {
  for (const Message& message : all_messages()) {
    EXPECT_EQ(in_words(message), record::old_sentence(message));
    EXPECT_EQ(english_sentence({0, 0.0, message}), record::old_sentence(message));
  }
}

TEST(MessageWords, AreChineseForEveryCode) {
  const LanguageScope chinese(Language::kChinese);
  for (const Message& message : all_messages()) {
    const auto words = in_words(message);
    ASSERT_TRUE(words) << core::message_name(message.code);
    EXPECT_NE(*words, record::old_sentence(message));
    for (const char* english : {"pose", "touches", "the ", "level"}) {
      EXPECT_EQ(words->find(english), std::string::npos) << *words;
    }
    EXPECT_EQ(english_sentence({0, 0.0, message}), record::old_sentence(message));
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

TEST(MessageWords, OfAnOldJournalAreItsOwnSentences) {
  const auto read = record::read_journal(std::filesystem::path(RONDURE_SOURCE_DIR) /
                                         "tests/data/journal_v5_interrupted");
  ASSERT_TRUE(read) << read.error().what;
  for (const record::Decision& decision : read->record.decisions) {
    EXPECT_EQ(english_sentence(decision), decision.sentence);
    EXPECT_EQ(in_words(decision.message), decision.sentence);
    const LanguageScope chinese(Language::kChinese);
    EXPECT_NE(in_words(decision.message), decision.sentence);
  }
}

}  // namespace
}  // namespace rondure::reports
