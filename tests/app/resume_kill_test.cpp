// The program killed by kill -9 at random moments of a run, on a real disk, and resumed: every
// result is that of the run without interruption, no touch lost or doubled. 6 runs without
// intervals; with RONDURE_FULL=1 (./test.sh --full) 25 with them. Prints what docs/reliability.md
// says of 500 (RONDURE_FULL=all).

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include <gtest/gtest.h>

#include "core/noise.h"
#include "record/journal/journal.h"
#include "tests/app/files.h"
#include "tests/app/program.h"
#include "tests/core/full.h"
#include "tests/record/sample_run.h"

namespace rondure::app::testing {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

std::size_t runs() { return static_cast<std::size_t>(test::cases(6, 25, 500)); }

/// The first example; without intervals, which only its end would compute, where time counts.
fs::path plan_in(const Scratch& folder) {
  if (test::full()) return example("01_spool_simulated.json");
  write_plan(folder / "plan.json", {});
  return folder / "plan.json";
}

/// Where runs stood when they were killed.
struct Tally {
  std::size_t before_journal = 0;
  std::size_t qualifying = 0;
  std::size_t locating = 0;
  std::size_t measuring = 0;
  std::size_t measured = 0;  ///< Every touch made, not sealed.
  std::size_t sealed = 0;    ///< Reports missing or torn.
  std::size_t ended = 0;     ///< The kill came too late.
  std::size_t kills = 0;
};

/// Runs the program and kills it after a time, unless it ends before.
bool dies(const std::vector<std::string>& words, Seconds after) {
  Program program(words);
  std::this_thread::sleep_for(after);
  program.send(SIGKILL);
  return program.wait().signal == SIGKILL;
}

void count(const fs::path& run, std::size_t all, Tally& tally) {
  ++tally.kills;
  const auto read = record::read_journal(run);
  if (!read) {
    ++tally.before_journal;
  } else if (read->record.sealed) {
    ++tally.sealed;
  } else if (read->record.touches.size() == all) {
    ++tally.measured;
  } else if (read->record.touches.size() < 13) {
    ++tally.qualifying;
  } else if (read->record.touches.size() < 23) {
    ++tally.locating;
  } else {
    ++tally.measuring;
  }
}

void print(const Tally& tally, std::size_t equal) {
  std::printf(
      "%zu of %zu runs resumed to the same bits and archived once, %zu kills: before the journal "
      "stood %zu, qualification %zu, location %zu, clouds "
      "%zu, measured and not sealed %zu, sealed without all reports %zu; ended before its kill "
      "%zu\n",
      equal, runs(), tally.kills, tally.before_journal, tally.qualifying, tally.locating,
      tally.measuring, tally.measured, tally.sealed, tally.ended);
}

/// What an archive of one run holds: name, value and verdict of each result.
std::vector<std::string> archived_results(const fs::path& archive) {
  const auto document = history_of(archive);
  std::vector<std::string> out;
  for (const auto& result : document["results"]) {
    out.push_back(result["characteristic"].dump() + result["symbol"].dump() +
                  result["value"].dump() + result["verdict"].dump());
  }
  return out;
}

/// The run that nothing interrupts, and how long it takes.
struct Whole {
  Scratch folder{Scratch::Where::kDisk};
  record::RunRecord record;
  std::string bits;
  std::string csv;
  std::vector<std::string> names;
  std::vector<std::string> archived;
  Seconds duration{};

  explicit Whole(const fs::path& plan) {
    const auto start = Clock::now();
    EXPECT_EQ(rondure({"run", plan, "--out", folder / "run", "--quiet"}).status, 0);
    duration = Clock::now() - start;
    record = journal_of(folder / "run");
    bits = record::measured_bits(record);
    csv = read(folder / "run" / "touches.csv");
    names = names_in(folder / "run");
    archived = archived_results(folder / "archive.db");
    EXPECT_FALSE(archived.empty());
  }
};

void expect_equal(const fs::path& run, const Whole& whole) {
  const record::RunRecord record = journal_of(run);
  EXPECT_TRUE(record.sealed);
  EXPECT_EQ(record.touches.size(), whole.record.touches.size());
  for (std::size_t i = 0; i < record.touches.size(); ++i) {
    ASSERT_EQ(record.touches[i].id, static_cast<std::int64_t>(i));
  }
  EXPECT_EQ(record::measured_bits(record), whole.bits);
  EXPECT_EQ(read(run / "touches.csv"), whole.csv);
  EXPECT_EQ(names_in(run), whole.names);
  EXPECT_EQ(rondure({"verify", run}).status, 0);
  EXPECT_EQ(archived_results(run.parent_path() / "archive.db"), whole.archived);
  EXPECT_TRUE(read(run / "report.html").ends_with("</html>\n"));
  EXPECT_TRUE(read(run / "report.json").ends_with("}\n"));
}

TEST(KilledByChance, EveryRunIsResumedToTheSameResult) {
  const Scratch plans(Scratch::Where::kDisk);
  const fs::path plan = plan_in(plans);
  const Whole whole(plan);
  std::uint64_t state = 20261121;
  Tally tally;
  // The first run may have shared the processor; a run that ends before its kill shows that.
  Seconds duration = whole.duration;
  std::size_t equal = 0;  // until the first that is not
  for (std::size_t i = 0; i < runs(); ++i) {
    SCOPED_TRACE(i);
    const Scratch folder(Scratch::Where::kDisk);
    const fs::path run = folder / "run";
    const std::vector<std::string> words = {"run", plan, "--out", run, "--resume", "--quiet"};
    // A stratum of the run each, its end among them; every third run dies twice, some oftener.
    const auto chance = static_cast<double>(core::splitmix64(state) % 1000) / 1000.0;
    Seconds after =
        duration * (static_cast<double>(i) + chance) * 1.02 / static_cast<double>(runs());
    const int kills = i % 3 == 0 ? 2 + static_cast<int>(i % 2) : 1;
    for (int k = 0; k < kills; ++k) {
      if (!dies(words, after)) {
        ++tally.ended;
        duration = std::min(duration, after);
        break;
      }
      count(run, whole.record.touches.size(), tally);
      after *= 0.4;
    }
    const Outcome outcome = rondure(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    expect_equal(run, whole);
    equal += HasFailure() ? 0 : 1;
  }
  print(tally, equal);
  EXPECT_GT(tally.kills, runs() / 2);
}

/// Kills the run when a file appears or is gone: moments too short for chance.
void expect_survives_kill_when(const Whole& whole, const fs::path& plan, const std::string& name,
                               bool appears, std::chrono::microseconds later) {
  SCOPED_TRACE(name + (appears ? " appears, " : " is gone, ") + std::to_string(later.count()));
  const Scratch folder(Scratch::Where::kDisk);
  const fs::path run = folder / "run";
  const std::vector<std::string> words = {"run", plan, "--out", run, "--resume", "--quiet"};
  {
    Program program(words);
    std::error_code ignored;
    bool seen = false;
    while (!program.ended()) {
      const bool there = fs::exists(run / name, ignored);
      seen = seen || there;
      if (appears ? there : (seen && !there)) break;
      std::this_thread::sleep_for(std::chrono::microseconds(20));
    }
    std::this_thread::sleep_for(later);
    program.send(SIGKILL);
    (void)program.wait();
  }
  EXPECT_EQ(rondure(words).status, 0);
  expect_equal(run, whole);
  for (const std::string& left : names_in(run)) EXPECT_FALSE(left.ends_with(".tmp")) << left;
}

TEST(KilledWhile, ItBeginsSealsWritesReportsOrArchives) {
  const Scratch plans(Scratch::Where::kDisk);
  const fs::path plan = plan_in(plans);
  const Whole whole(plan);
  const int rounds = test::cases(1, 2, 20);
  for (int i = 0; i < rounds; ++i) {
    const auto later = std::chrono::microseconds(i * 150);
    expect_survives_kill_when(whole, plan, "journal.db", true, later);       // head
    expect_survives_kill_when(whole, plan, "journal.db-wal", false, later);  // sealed
    expect_survives_kill_when(whole, plan, "report.html", true, later);      // the first report
    expect_survives_kill_when(whole, plan, "touches.csv", true, later);      // the last
    expect_survives_kill_when(whole, plan, "../archive.db", true, later);    // the archive
  }
}

}  // namespace
}  // namespace rondure::app::testing
