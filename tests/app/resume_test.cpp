#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/files.h"
#include "tests/app/program.h"
#include "tests/record/sample_run.h"

namespace rondure::app::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// A run of the first example that its simulated machine interrupts.
class Interrupted {
 public:
  explicit Interrupted(const std::string& fault = "connection_lost_at_touch", int number = 60) {
    write_plan(plan(), {{"/simulation/faults", {{fault, number}}}});
    outcome_ = rondure({"run", plan(), "--out", directory()});
  }
  [[nodiscard]] fs::path plan() const { return folder_ / "plan.json"; }
  [[nodiscard]] fs::path directory() const { return folder_ / "run"; }
  [[nodiscard]] const fs::path& folder() const { return folder_.path(); }
  [[nodiscard]] const Outcome& outcome() const { return outcome_; }
  [[nodiscard]] Outcome resume(const Surroundings& surroundings = {}) const {
    return rondure({"run", plan(), "--out", directory(), "--resume"}, surroundings);
  }

 private:
  Scratch folder_;
  Outcome outcome_;
};

/// What the plan of Interrupted gives without its fault.
std::string whole_bits(const Interrupted& run) {
  const Scratch folder;
  write_plan(folder / "plan.json", {});
  EXPECT_EQ(rondure({"run", folder / "plan.json", "--out", folder / "run"}).status, 0);
  record::RunRecord record = journal_of(folder / "run");
  const record::RunRecord resumed = journal_of(run.directory());
  record.header.plan_text = resumed.header.plan_text;
  record.header.plan_sha256 = resumed.header.plan_sha256;
  return record::measured_bits(record);
}

TEST(Resume, HelpExplainsItWithAnExample) {
  const Outcome outcome = rondure({"run", "--help"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("--resume"), HasSubstr("--out runs/7 --resume"),
                    HasSubstr("20261121T023302Z --resume"), HasSubstr("resume_limit_um")));
}

TEST(Resume, ALostConnectionSaysHowToGoOnAndDoes) {
  const Interrupted run;
  EXPECT_EQ(run.outcome().status, 3);
  EXPECT_THAT(run.outcome().err,
              AllOf(HasSubstr("connection is lost"), HasSubstr("[machine]"),
                    HasSubstr("rondure run '" + run.directory().string() + "' --resume")));
  EXPECT_EQ(journal_of(run.directory()).touches.size(), 59U);
  const Outcome resumed = run.resume();
  EXPECT_EQ(resumed.status, 0) << resumed.err;
  EXPECT_THAT(resumed.out, ::testing::StartsWith("2 of 2 conform; "));
  EXPECT_EQ(record::measured_bits(journal_of(run.directory())), whole_bits(run));
  EXPECT_EQ(rondure({"verify", run.directory()}).status, 0);
}

/// How often a journal is read to its end before its run writes into it again, which makes its log.
int reads_before_it_goes_on(const Interrupted& run) {
  const int watch = inotify_init1(IN_NONBLOCK);
  EXPECT_GE(inotify_add_watch(watch, run.directory().c_str(), IN_CLOSE_NOWRITE | IN_CREATE), 0);
  EXPECT_EQ(run.resume().status, 0);
  std::array<char, 65536> bytes{};
  const ssize_t length = ::read(watch, bytes.data(), bytes.size());
  close(watch);
  int reads = 0;
  for (ssize_t at = 0; at < length;) {
    inotify_event event{};
    std::memcpy(&event, bytes.data() + at, sizeof event);
    const std::string name = bytes.data() + at + sizeof event;
    if ((event.mask & IN_CREATE) != 0 && name == "journal.db-wal") return reads;
    if ((event.mask & IN_CLOSE_NOWRITE) != 0 && name == "journal.db") ++reads;
    at += static_cast<ssize_t>(sizeof event + event.len);
  }
  ADD_FAILURE() << "the run did not go on";
  return reads;
}

TEST(Resume, ReadsTheJournalOnce) {
  const Interrupted run;
  EXPECT_EQ(reads_before_it_goes_on(run), 1);
}

TEST(Resume, AStalledFixtureSaysHowToGoOnAndDoes) {
  const Interrupted run("fixture_stalls_at_move", 2);
  EXPECT_EQ(run.outcome().status, 3);
  EXPECT_THAT(run.outcome().err, AllOf(HasSubstr("stalled"), HasSubstr("--resume")));
  EXPECT_EQ(run.resume().status, 0);
  EXPECT_EQ(record::measured_bits(journal_of(run.directory())), whole_bits(run));
}

TEST(Resume, NeedsOnlyTheRunDirectory) {
  const Interrupted run;
  fs::remove(run.plan());
  EXPECT_EQ(rondure({"run", "--resume", run.directory()}).status, 0);
  EXPECT_EQ(rondure({"verify", run.directory()}).status, 0);
}

TEST(Resume, BeginsWhereThereIsNoRunYet) {
  const Scratch folder;
  write_plan(folder / "plan.json", {});
  const Outcome outcome =
      rondure({"run", folder / "plan.json", "--out", folder / "run", "--resume"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, HasSubstr("holds no run yet; it begins"));
  EXPECT_TRUE(journal_of(folder / "run").checks.empty());
}

TEST(Resume, WithoutADirectorySaysWhatIsMissing) {
  const Outcome outcome = rondure({"run", example("01_spool_simulated.json"), "--resume"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--out DIR"));
  const Scratch folder;
  EXPECT_EQ(rondure({"run", "--resume", folder.path()}).status, 2) << "an empty directory, no plan";
}

TEST(Resume, ShowsWhatChangedInThePlanAndGoesOnWhenItIsUndone) {
  const Interrupted run;
  const std::string good = read(run.plan());
  replace_in(run.plan(), "\"layers\": 4", "\"layers\": 5");
  const Outcome refused = run.resume();
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err,
              AllOf(HasSubstr("cannot go on"),
                    HasSubstr("/features/0/sampling/layers: the run began with 4, the plan now "
                              "says 5 [meaning]")));
  write(run.plan(), good);
  EXPECT_EQ(run.resume().status, 0);
}

TEST(Resume, OfAFinishedRunSaysSoAndChangesNothing) {
  const Interrupted run;
  ASSERT_EQ(run.resume().status, 0);
  const std::string journal = read(run.directory() / "journal.db");
  const auto names = names_in(run.directory());
  const Outcome again = run.resume();
  EXPECT_EQ(again.status, 0) << "the verdict's";
  EXPECT_THAT(again.err, HasSubstr("finished and sealed, there is nothing to resume: conforms;"));
  EXPECT_EQ(read(run.directory() / "journal.db"), journal);
  EXPECT_EQ(names_in(run.directory()), names);
  fs::remove(run.directory() / "report.json");
  const Outcome reports = run.resume();
  EXPECT_EQ(reports.status, 0);
  EXPECT_THAT(reports.err, HasSubstr("only its reports are written"));
  EXPECT_EQ(names_in(run.directory()), names);
}

TEST(Resume, OfAFinishedRunEndsWithTheStatusOfItsVerdict) {
  const Scratch folder;
  write_plan(folder / "plan.json", {{"/features/0/characteristics/0/tolerance_um", 1}});
  const std::vector<std::string> words = {"run", folder / "plan.json", "--out", folder / "run",
                                          "--resume"};
  ASSERT_EQ(rondure(words).status, 1);
  const Outcome again = rondure(words);
  EXPECT_EQ(again.status, 1);
  EXPECT_THAT(again.err, HasSubstr("nothing to resume: does not conform;"));
}

TEST(Resume, OfAFinishedRunIsRefusedForAnotherPartPlanSeedOrOperator) {
  const Scratch folder;
  write_plan(folder / "plan.json", {});
  ASSERT_EQ(rondure({"run", folder / "plan.json", "--out", folder / "run", "--serial", "A",
                     "--operator", "mk", "--order", "4711"})
                .status,
            0);
  const std::string journal = read(folder / "run" / "journal.db");
  write_plan(folder / "other.json", {{"/features/0/sampling/layers", 5}});
  const Outcome other = rondure({"run", folder / "other.json", "--out", folder / "run", "--serial",
                                 "B", "--operator", "ab", "--seed", "7", "--resume"});
  EXPECT_EQ(other.status, 2) << "part B was not measured";
  EXPECT_EQ(other.out, "");
  EXPECT_THAT(
      other.err,
      AllOf(HasSubstr("is finished, and began with something else"),
            HasSubstr("/features/0/sampling/layers: the run began with 4, the plan now "
                      "says 5 [meaning]\n"),
            HasSubstr("the seed "), HasSubstr("the serial number \"A\", now it would be \"B\""),
            HasSubstr("the operator \"mk\"")));
  const Outcome serial =
      rondure({"run", folder / "run", "--serial", "B", "--resume", "--format", "json"});
  EXPECT_EQ(serial.status, 2);
  EXPECT_THAT(serial.err, HasSubstr("the serial number \"A\""));
  EXPECT_THAT(rondure({"run", folder / "run", "--order", "4712", "--resume"}).err,
              HasSubstr("the order \"4711\", now it would be \"4712\""));
  EXPECT_EQ(read(folder / "run" / "journal.db"), journal);
  EXPECT_EQ(
      rondure({"run", folder / "plan.json", "--out", folder / "run", "--serial", "A", "--resume"})
          .status,
      0);
}

TEST(Resume, APartThatMovedEndsTheRunWithNumberAndLimit) {
  const Scratch folder;
  write_plan(folder / "plan.json",
             {{"/simulation/faults", {{"connection_lost_at_touch", 60}, {"part_moved_um", 40}}}});
  const std::vector<std::string> words = {"run", folder / "plan.json", "--out", folder / "run",
                                          "--resume"};
  ASSERT_EQ(rondure(words).status, 3);
  const Outcome outcome = rondure(words);
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr(" um, the plan allows 5 um (resume_limit_um)"),
                                 HasSubstr("start a new run"), HasSubstr("[location]"),
                                 Not(HasSubstr("to go on"))));
  EXPECT_THAT(outcome.out, ::testing::StartsWith("INCOMPLETE: 0 of 2 judged\n0 of 2 conform; "));
}

TEST(Resume, AnOrdinaryRunIntoTheDirectoryPointsToIt) {
  const Interrupted run;
  const Outcome outcome = rondure({"run", run.plan(), "--out", run.directory()});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("is not empty"), HasSubstr("--resume")));
}

/// Until the log of the journal has grown by some touches.
void wait_for_log(const Program& program, const fs::path& run) {
  std::error_code absent;
  while (!program.ended() && (fs::file_size(run / "journal.db-wal", absent) < 100'000 || absent)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

/// A run that takes most of a minute, past its first touches.
struct Busy {
  Scratch folder;
  std::vector<std::string> words;
  Program program;

  Busy() : words(prepare(folder)), program(words) { wait_for_log(program, folder / "run"); }
  static std::vector<std::string> prepare(const Scratch& folder) {
    write_plan(folder / "plan.json", {{"/features/0/sampling/layers", 40},
                                      {"/features/0/sampling/points_per_layer", 100}});
    return {"run", folder / "plan.json", "--out", folder / "run"};
  }
};

TEST(TwoProcesses, TheSecondIsRefusedWithPidAndHostOfTheFirst) {
  Busy busy;
  std::array<char, 256> host{};
  ::gethostname(host.data(), host.size() - 1);
  auto words = busy.words;
  for (int i = 0; i < 2; ++i) {
    const Outcome second = rondure(words);
    EXPECT_EQ(second.status, 2);
    EXPECT_THAT(second.err, AllOf(HasSubstr("in use by process "),
                                  HasSubstr(std::string(" on host ") + host.data())));
    words.emplace_back("--resume");
  }
  busy.program.send(SIGINT);
  EXPECT_EQ(busy.program.wait().status, 3) << "the first goes on undisturbed until it is stopped";
}

TEST(Stop, AndResumeGiveEveryTouchOnce) {
  Busy busy;
  busy.program.send(SIGINT);
  const Outcome stopped = busy.program.wait();
  EXPECT_EQ(stopped.status, 3);
  EXPECT_THAT(stopped.err, AllOf(HasSubstr("[stopped]"), HasSubstr("to resume it after its "
                                                                   "last touch: rondure run ")));
  const auto before = journal_of(busy.folder / "run");
  Program resumed({"run", busy.folder / "run", "--resume"});
  wait_for_log(resumed, busy.folder / "run");
  resumed.send(SIGTERM);
  EXPECT_EQ(resumed.wait().status, 3);
  const auto after = journal_of(busy.folder / "run");
  ASSERT_GE(after.touches.size(), before.touches.size());
  for (std::size_t i = 0; i < after.touches.size(); ++i) {
    ASSERT_EQ(after.touches[i].id, static_cast<std::int64_t>(i));
  }
}

TEST(FullDisk, IsResumedOnceThereIsRoom) {
  const Scratch reference;
  write_plan(reference / "plan.json", {});
  ASSERT_EQ(rondure({"run", reference / "plan.json", "--out", reference / "run"}).status, 0);
  const std::string whole = record::measured_bits(journal_of(reference / "run"));
  int resumed = 0;
  for (const std::size_t bytes : {60'000U, 100'000U, 160'000U, 300'000U}) {
    SCOPED_TRACE(bytes);
    const Scratch folder;
    Surroundings full;
    full.largest_file_bytes = bytes;
    const std::vector<std::string> words = {"run", reference / "plan.json", "--out", folder / "run",
                                            "--resume"};
    if (rondure(words, full).status == 0) continue;
    const Outcome still_full = rondure(words, full);
    if (still_full.status == 0) continue;  // what is left to write is less than the whole
    EXPECT_TRUE(still_full.status == 2 || still_full.status == 3) << still_full.status;
    EXPECT_THAT(still_full.err, HasSubstr("raise the limit"));
    const Outcome outcome = rondure(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(record::measured_bits(journal_of(folder / "run")), whole);
    ++resumed;
  }
  EXPECT_GE(resumed, 2);
}

TEST(ReadOnlyDirectory, IsNamedAndTheRunGoesOnWhenItIsWritable) {
  const Interrupted run;
  Surroundings plain_user;
  plain_user.unprivileged = true;
  fs::permissions(run.folder(), fs::perms::all);
  fs::permissions(run.directory(), fs::perms(0555));
  const Outcome refused = run.resume(plain_user);
  if (refused.status == 126 || refused.status == 127) GTEST_SKIP() << "user nobody cannot start it";
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, AllOf(HasSubstr(run.directory().string()), HasSubstr("not allowed"),
                                 HasSubstr("change the permissions")));
  fs::permissions(run.directory(), fs::perms::all);
  EXPECT_EQ(run.resume().status, 0);
}

}  // namespace
}  // namespace rondure::app::testing
