#include "wire/wire_log.h"

#include <filesystem>
#include <fstream>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/core/scratch.h"

namespace rondure::wire {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Answers each line with what is prepared, without a socket.
class Echo final : public LineTransport {
 public:
  std::vector<Line> answers;
  core::Result<void> write_line(std::string_view) override { return {}; }
  core::Result<std::optional<Line>> read_line(std::chrono::milliseconds) override {
    if (answers.empty()) return core::fail(core::Code::kMachine, "it went away");
    const Line next = answers.front();
    answers.erase(answers.begin());
    return next;
  }
  void close() override { open_ = false; }
  bool is_open() const override { return open_; }
  std::string peer() const override { return "echo"; }

 private:
  bool open_ = true;
};

std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream stream(file);
  std::vector<std::string> out;
  for (std::string line; std::getline(stream, line);) out.push_back(line);
  return out;
}

TEST(WireLog, ReadsLikeATranscriptBehindTimeAndArrow) {
  const test::Scratch folder;
  const fs::path file = folder / "wire_log";
  auto echo = std::make_unique<Echo>();
  echo->answers = {{"00001 &", true}, {"00001 %", true}};
  {
    auto log = logged(std::move(echo), file, Side::kClient);
    ASSERT_TRUE(log);
    ASSERT_TRUE((*log)->write_line("00001 StartSession()"));
    ASSERT_TRUE((*log)->read_line({}));
    ASSERT_TRUE((*log)->read_line({}));
    ASSERT_FALSE((*log)->read_line({}));
    ASSERT_FALSE((*log)->read_line({}));  // the loss is noted once
  }
  std::vector<std::string> texts;
  for (const std::string& line : lines_of(file)) {
    EXPECT_EQ(line.find("T"), 10U) << line;
    EXPECT_EQ(line.find("Z "), 26U) << line;
    texts.push_back(line.substr(28));
  }
  EXPECT_THAT(
      texts, ElementsAre("-- #: connected with echo", "-> C: 00001 StartSession()", "<- S: 00001 &",
                         "<- S: 00001 %", "-- #: it went away", "-- #: closed"));
}

TEST(WireLog, ShowsStrangeBytesAndCutsLongLines) {
  const test::Scratch folder;
  const fs::path file = folder / "wire_log_strange";
  auto echo = std::make_unique<Echo>();
  echo->answers = {{"a\rb\xff", false}, {std::string(5000, 'a'), true}};
  auto log = logged(std::move(echo), file, Side::kServer);
  ASSERT_TRUE((*log)->read_line({}));
  ASSERT_TRUE((*log)->read_line({}));
  const auto lines = lines_of(file);
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_THAT(lines[1], HasSubstr("<- C: a\\x0Db\\xFF"));
  EXPECT_THAT(lines[2], HasSubstr("ended by LF alone"));
  EXPECT_THAT(lines[3], HasSubstr("aaa ... (5000 bytes)"));
  EXPECT_LT(lines[3].size(), 4200U);
}

TEST(WireLog, SaysThatItCannotBeOpened) {
  const auto refused = logged(std::make_unique<Echo>(), "/no/such/folder/wire.log", Side::kClient);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Code::kFile);
  EXPECT_THAT(refused.error().where, StartsWith("/no/such"));
}

}  // namespace
}  // namespace rondure::wire
