#include "record/growing_record.h"

#include <atomic>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "record/journal/journal.h"
#include "tests/record/sample_run.h"

namespace rondure::record {
namespace {

/// The head of a run: what is on record before its first touch.
RunRecord head_of(const RunRecord& run) {
  RunRecord out;
  out.header = run.header;
  out.header.version = "1.2.3";
  out.artefact = run.artefact;
  out.features = run.features;
  out.settings = run.settings;
  return out;
}

void expect_same_rows(const RunRecord& seen, const RunRecord& kept) {
  ASSERT_EQ(seen.touches.size(), kept.touches.size());
  for (std::size_t i = 0; i < seen.touches.size(); ++i) {
    EXPECT_EQ(seen.touches[i].id, kept.touches[i].id) << i;
    EXPECT_EQ(seen.touches[i].time_s, kept.touches[i].time_s) << i;
  }
  ASSERT_EQ(seen.poses.size(), kept.poses.size());
  for (std::size_t i = 0; i < seen.poses.size(); ++i) {
    EXPECT_EQ(seen.poses[i].id, kept.poses[i].id);
    EXPECT_EQ(seen.poses[i].final_cloud, kept.poses[i].final_cloud);
  }
  ASSERT_EQ(seen.decisions.size(), kept.decisions.size());
  EXPECT_EQ(seen.ending, kept.ending);
}

TEST(GrowingRecord, HoldsWhatTheJournalHolds) {
  const Scratch folder;
  const RunRecord run = sample_run(7);
  auto journal = Journal::create(folder / "run", run.header, run.artefact, run.features);
  ASSERT_TRUE(journal);
  const auto copy = std::make_shared<GrowingRecord>();
  RunRecord seen;
  EXPECT_FALSE(copy->catch_up(seen)) << "nothing began";
  copy->begin(head_of(run));
  journal->follow(copy);
  EXPECT_TRUE(copy->catch_up(seen));
  EXPECT_FALSE(copy->catch_up(seen)) << "nothing new";
  for (PoseVisit pose : run.poses) {
    pose.final_cloud = false;
    ASSERT_TRUE(journal->add(pose));
  }
  for (std::size_t i = 0; i < run.touches.size(); ++i) {
    ASSERT_TRUE(journal->add(run.touches[i]));
    if (i % 7 == 0) {
      EXPECT_TRUE(copy->catch_up(seen));
      EXPECT_EQ(seen.touches.size(), i + 1);
    }
  }
  for (const Decision& decision : run.decisions) ASSERT_TRUE(journal->add(decision));
  ASSERT_TRUE(journal->mark_final(run.poses.front().id));
  ASSERT_TRUE(journal->end("finished", nullptr));
  EXPECT_TRUE(copy->catch_up(seen));
  const auto kept = read_journal(folder / "run");
  ASSERT_TRUE(kept);
  expect_same_rows(seen, kept->record);
}

TEST(GrowingRecord, NeverShowsWhatTheJournalRefused) {
  const Scratch folder;
  const RunRecord run = sample_run(8);
  auto journal = Journal::create(folder / "run", run.header, run.artefact, run.features);
  ASSERT_TRUE(journal);
  const auto copy = std::make_shared<GrowingRecord>();
  copy->begin(head_of(run));
  journal->follow(copy);
  ASSERT_TRUE(journal->add(run.touches.front()));
  EXPECT_FALSE(journal->add(run.touches.front())) << "its number is taken";
  EXPECT_FALSE(journal->mark_final(12345)) << "there is no such pose";
  RunRecord seen;
  EXPECT_TRUE(copy->catch_up(seen));
  EXPECT_EQ(seen.touches.size(), 1U);
}

TEST(GrowingRecord, IsReadWhileItGrows) {
  GrowingRecord record;
  const RunRecord run = sample_run(9, 400);
  record.begin(head_of(run));
  std::atomic<bool> done = false;
  std::thread writer([&] {
    for (const Touch& touch : run.touches) record.add(std::span(&touch, 1));
    record.end("stopped", nullptr);
    done = true;
  });
  RunRecord seen;
  std::size_t last = 0;
  while (!done) {
    record.catch_up(seen);
    EXPECT_GE(seen.touches.size(), last);
    last = seen.touches.size();
  }
  writer.join();
  record.catch_up(seen);
  EXPECT_EQ(seen.touches.size() + seen.checks.size(), run.touches.size());
  EXPECT_EQ(seen.ending, "stopped");
}

}  // namespace
}  // namespace rondure::record
