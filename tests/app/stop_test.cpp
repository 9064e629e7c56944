#include <chrono>
#include <csignal>
#include <cstdio>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/files.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// A run of 500 points in some eighty poses, which no test waits for.
class LongRun {
 public:
  explicit LongRun(const Surroundings& surroundings = {}) : program_(start(folder_), surroundings) {
    wait_for_touches();
  }

  [[nodiscard]] Program& program() { return program_; }
  [[nodiscard]] fs::path directory() const { return folder_ / "run"; }

 private:
  static std::vector<std::string> start(const Scratch& folder) {
    write_plan(folder / "plan.json", {{"/features/0/sampling/layers", 20},
                                      {"/features/0/sampling/points_per_layer", 25},
                                      {"/features/0/pose_search", {{"strategy", "as-published"}}}});
    return {"run", folder / "plan.json", "--out", folder / "run"};
  }

  /// Until the log of the journal has grown by some touches.
  void wait_for_touches() {
    constexpr std::uintmax_t kBytes = 200'000;
    std::error_code absent;
    for (int i = 0; i < 60'000 && !program_.ended(); ++i) {
      const auto bytes = fs::file_size(directory() / "journal.db-wal", absent);
      if (!absent && bytes > kBytes) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    ADD_FAILURE() << "the run made no touches: " << program_.wait().err;
  }

  Scratch folder_;
  Program program_;
};

std::size_t touches_named_in(const std::string& message) {
  std::size_t touches = 0;
  const std::size_t at = message.find("stopped by the operator after ");
  if (at != std::string::npos)
    std::sscanf(message.c_str() + at, "stopped by the operator after %zu", &touches);
  return touches;
}

class StopSignal : public ::testing::TestWithParam<int> {};

TEST_P(StopSignal, EndsTheRunAfterThePresentTouchAndKeepsEveryTouch) {
  LongRun run;
  run.program().send(GetParam());
  const Outcome outcome = run.program().wait();
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, HasSubstr("[stopped]"));
  EXPECT_THAT(outcome.out, HasSubstr("not finished"));
  EXPECT_THAT(read(run.directory() / "report.html"), HasSubstr("</html>"));
  const auto journal = journal_of(run.directory());
  EXPECT_EQ(journal.ending, "stopped");
  EXPECT_GT(journal.touches.size(), 0U);
  EXPECT_EQ(journal.touches.size(), touches_named_in(outcome.err)) << outcome.err;
  const Outcome verified = rondure({"verify", run.directory()});
  EXPECT_EQ(verified.status, 1);
  EXPECT_THAT(verified.out, HasSubstr("the run did not finish (stopped)"));
}

INSTANTIATE_TEST_SUITE_P(All, StopSignal, ::testing::Values(SIGINT, SIGTERM, SIGHUP));

TEST(StopSignals, TheSecondEndsTheProgramAtOnce) {
  LongRun run;
  // Held while both arrive: the second comes before the run can answer the first.
  run.program().send(SIGSTOP);
  run.program().send(SIGINT);
  run.program().send(SIGTERM);
  run.program().send(SIGCONT);
  const Outcome outcome = run.program().wait();
  EXPECT_TRUE(outcome.signal == SIGINT || outcome.signal == SIGTERM) << outcome.status;
  EXPECT_GT(journal_of(run.directory()).touches.size(), 0U);
}

TEST(StopSignals, InAPipeWhoseReaderEndedFirstStillEndTheRunInOrder) {
  Surroundings pipe;
  pipe.standard_output = "unread";  // rondure run ... 2>&1 | tee log: Ctrl-C ends tee as well
  LongRun run(pipe);
  run.program().send(SIGINT);
  EXPECT_EQ(run.program().wait().status, 3);
  EXPECT_EQ(journal_of(run.directory()).ending, "stopped");
  EXPECT_THAT(read(run.directory() / "report.html"), HasSubstr("</html>"));
  EXPECT_FALSE(fs::exists(run.directory() / "run.lock"));
}

TEST(StopSignals, ARunThatNobodyReadsIsArchivedLikeAnyOther) {
  const Scratch folder;
  Surroundings pipe;
  pipe.standard_output = "unread";
  const Outcome outcome =
      run_without_intervals("01_spool_simulated", {"--out", folder / "run"}, pipe);
  EXPECT_EQ(outcome.status, 2) << "what was printed is lost, and nothing else";
  EXPECT_EQ(rondure({"verify", folder / "run"}).status, 0);
  EXPECT_THAT(rondure({"history", folder / "archive.db"}).out, HasSubstr("conforms"));
}

TEST(KilledRun, KeepsItsTouchesAndSaysThatItWasInterrupted) {
  LongRun run;
  run.program().send(SIGKILL);
  EXPECT_EQ(run.program().wait().signal, SIGKILL);
  const auto journal = journal_of(run.directory());
  EXPECT_EQ(journal.ending, "");
  // A touch takes four pages of log; poses and decisions come between.
  EXPECT_GE(journal.touches.size(), 20U);  // a touch takes four pages of log
  for (std::size_t i = 0; i < journal.touches.size(); ++i) {
    ASSERT_EQ(journal.touches[i].id, static_cast<std::int64_t>(i));
  }
  const Outcome verified = rondure({"verify", run.directory()});
  EXPECT_EQ(verified.status, 1);
  EXPECT_THAT(verified.out, HasSubstr("it was interrupted"));
  EXPECT_EQ(rondure({"report", run.directory(), "--format", "html"}).status, 1);
  EXPECT_THAT(read(run.directory() / "report.html"), HasSubstr("</html>"));
}

}  // namespace
}  // namespace rondure::app::testing
