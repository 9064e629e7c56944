// What can be in the way of an archive, and what its queue makes of it.

#include <csignal>
#include <cstdlib>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "record/archive/queue.h"
#include "record/files.h"
#include "record/journal/journal.h"
#include "tests/record/archive_samples.h"
#include "tests/record/meddle.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

core::Error refused(const std::string& place, Archive::Access access = Archive::Access::kWrite) {
  const auto archive = Archive::open(place_of(place), access);
  if (archive) ADD_FAILURE() << place << " was opened";
  return archive ? core::Error{} : archive.error();
}

TEST(ArchiveServer, ThatIsGoneInTheMiddleOfAPushHoldsNothingOfIt) {
  PostgresServer server;
  if (!server.absent().empty()) GTEST_SKIP() << server.absent();
  const Scratch scratch;
  const ArchivePlace place = place_of(server.url());
  (void)open_archive(place);
  constexpr int kResults = 20'000;  // about a second of pushing
  const ArchiveRun run = archive_run(1, kResults);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  const auto queue_file = scratch / "queue.db";
  if (child == 0) {
    const Delivery delivery = deliver(place, queue_file, &run, {.attempts = 1});
    ::_exit(delivery.failure && !delivery.queue_failure && delivery.waiting == 1 ? 0 : 1);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  server.stop();
  int status = -1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0) << "the push was not interrupted, or is not in the queue";

  server.start();
  Archive archive = open_archive(place);
  EXPECT_EQ(all_of(archive).size(), 0U);
  const ArchiveRun next = archive_run(2);
  const Delivery delivery = deliver(place, queue_file, &next, {.give_up_after_s = 60.0});
  EXPECT_FALSE(delivery.failure);
  EXPECT_EQ(delivery.sent, 2U);
  EXPECT_EQ(delivery.waiting, 0U);
  EXPECT_EQ(all_of(archive).size(), kResults + 2U);
}

TEST(ArchiveServer, SaysWhyItCannotBeUsed) {
  PostgresServer server;
  if (!server.absent().empty()) GTEST_SKIP() << server.absent();
  const core::Error wrong = refused(server.url_of("guarded:wrong"));
  EXPECT_EQ(wrong.code, core::Code::kArchive);
  EXPECT_THAT(wrong.what, AllOf(HasSubstr("password authentication failed"), HasSubstr("~/.pgpass"),
                                Not(HasSubstr("wrong"))));
  EXPECT_THAT(refused(server.url_of("rondure", "absent")).what, HasSubstr("does not exist"));
  EXPECT_THAT(refused(server.url(), Archive::Access::kRead).what,
              HasSubstr("holds no archive yet"));
  ASSERT_EQ(server.sql("create database old encoding 'LATIN1' template template0"), "");
  EXPECT_THAT(refused(server.url_of("rondure", "old")).what,
              AllOf(HasSubstr("LATIN1"), HasSubstr("encoding UTF8")));
  // A user who may not make tables.
  const core::Error poor = refused(server.url_of("guarded:right"));
  EXPECT_THAT(poor.what, AllOf(HasSubstr("permission denied"), HasSubstr("grant")));
  EXPECT_THAT(refused("postgresql://rondure@127.0.0.1:1/archive").what,
              AllOf(HasSubstr("Connection refused"), HasSubstr("start the server")));
}

TEST(ArchiveServer, TakesRunsFromAUserWhoMayOnlyAdd) {
  PostgresServer server;
  if (!server.absent().empty()) GTEST_SKIP() << server.absent();
  (void)open_archive(place_of(server.url()));
  ASSERT_EQ(server.sql("grant select, insert on all tables in schema public to guarded"), "");
  Archive archive = open_archive(place_of(server.url_of("guarded:right")));
  EXPECT_EQ(archive.push(archive_run(1)), true);
  EXPECT_EQ(archive.push(archive_run(1)), false);
}

TEST(ArchiveFile, SaysWhatStandsInItsPlace) {
  const Scratch scratch;
  ASSERT_TRUE(write_file(scratch / "text", "this is not a database at all"));
  EXPECT_THAT(refused(scratch / "text").what, HasSubstr("is not a database"));
  EXPECT_THAT(refused(scratch.path()).what, HasSubstr("is no file"));
  EXPECT_THAT(refused(scratch / "absent" / "archive.db").what, HasSubstr("no such file or folder"));
  ASSERT_TRUE(write_run(scratch / "run", sample_run(1)));
  EXPECT_THAT(refused(scratch / "run" / "journal.db").what,
              HasSubstr("holds the tables of another program"));
  ASSERT_TRUE(write_file(scratch / "cut", std::string("SQLite format 3\0", 16) + "no more"));
  EXPECT_THAT(refused(scratch / "cut").what, HasSubstr((scratch / "cut").string()));
  const core::Error absent = refused(scratch / "none.db", Archive::Access::kRead);
  EXPECT_THAT(absent.what, HasSubstr("does not exist"));
}

/// Runs `work` in a child, so that what it does to itself ends with it.
int in_child(const std::function<int()>& work) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(work());
  int status = -1;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

void limit_files(rlim_t bytes) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{bytes, bytes};
  ::setrlimit(RLIMIT_FSIZE, &limit);
}

TEST(ArchiveFile, WithANumberThatNobodyMeasuredIsNotRead) {
  const Scratch scratch;
  const fs::path file = scratch / "archive.db";
  {
    Archive archive = open_archive(place_of(file.string()));
    ASSERT_TRUE(archive.push(archive_run(1)));
  }
  for (const char* number : {"9e999", "1e308"}) {
    meddle(file, std::string("update rondure_result set value = ") + number);
    const auto read = open_archive(place_of(file.string())).newest({}, 10);
    ASSERT_FALSE(read) << number;
    EXPECT_EQ(read.error().code, core::Code::kArchive);
    EXPECT_THAT(read.error().what, HasSubstr("beyond 1e+09 mm"));
  }
}

// SQLite keeps an infinite time, below every integer, and reads it as one: each page would end
// where it began.
// Such a row would be found on every page, or be the last one that is found.
TEST(ArchiveFile, WithATimeOrANumberThatIsNoneEndsInASentence) {
  for (const char* const change : {"time_s = -9e999", "time_s = 'yesterday'", "number = 'first'"}) {
    SCOPED_TRACE(change);
    const Scratch scratch;
    const fs::path file = scratch / "archive.db";
    {
      Archive archive = open_archive(place_of(file.string()));
      ASSERT_TRUE(archive.push(archive_run(1)));
      ASSERT_TRUE(archive.push(archive_run(2)));
    }
    meddle(file,
           std::string("update rondure_result set ") + change + " where run = 2 and number = 0");
    const auto results = open_archive(place_of(file.string())).newest({}, 100);
    ASSERT_FALSE(results);
    EXPECT_THAT(results.error().what, HasSubstr("of run 2"));
    EXPECT_THAT(results.error().what, HasSubstr("no whole numbers"));
  }
}

TEST(ArchiveFile, OnAFullDiskHoldsWholeRunsOnly) {
  const Scratch scratch;
  const ArchivePlace place = place_of(scratch / "archive.db");
  (void)open_archive(place);
  const int status = in_child([&] {
    limit_files(200'000);
    Archive archive = open_archive(place);
    for (int number = 0;; ++number) {
      const auto pushed = archive.push(archive_run(number, 50));
      if (pushed) continue;
      const bool told = pushed.error().what.find("raise the limit") != std::string::npos ||
                        pushed.error().what.find("disk") != std::string::npos;
      return told && number > 2 ? 0 : 1;
    }
  });
  EXPECT_EQ(status, 0);
  Archive archive = open_archive(place);
  const auto results = all_of(archive);
  EXPECT_GT(results.size(), 100U);
  EXPECT_EQ(results.size() % 50U, 0U);
  EXPECT_EQ(archive.push(archive_run(1'000)), true) << "goes on when there is space";
}

TEST(ArchiveFile, ThatIsReadOnlyIsReadAndNotWritten) {
  const Scratch scratch;
  const ArchivePlace place = place_of(scratch / "archive.db");
  ASSERT_TRUE(open_archive(place).push(archive_run(1)));
  if (::getuid() == 0) {  // whom no file keeps out: an ordinary user then
    fs::permissions(scratch.path(), fs::perms(0755));
  }
  fs::permissions(place.address, fs::perms(0444));
  EXPECT_EQ(in_child([&] {
              if (::getuid() == 0 && ::setuid(65534) != 0) return 9;
              Archive archive = open_archive(place);
              if (all_of(archive).size() != 2) return 1;
              const auto pushed = archive.push(archive_run(2));
              if (pushed) return 2;
              return pushed.error().what.find("is read-only") != std::string::npos ? 0 : 3;
            }),
            0);
}

TEST(ArchiveDelivery, KeepsInTheQueueWhatTheArchiveDoesNotTakeAndSendsItWithTheNextRun) {
  const Scratch scratch;
  const fs::path queue = scratch / "queue.db";
  const ArchivePlace place = place_of(scratch / "later" / "archive.db");
  for (int number = 0; number < 3; ++number) {
    const ArchiveRun run = archive_run(number);
    const Delivery delivery = deliver(place, queue, &run, {.pause_s = 0.0});
    ASSERT_TRUE(delivery.failure);
    EXPECT_FALSE(delivery.queue_failure);
    EXPECT_EQ(delivery.sent, 0U);
    EXPECT_EQ(delivery.waiting, static_cast<std::size_t>(number) + 1);
  }
  fs::create_directory(scratch / "later");
  const ArchiveRun run = archive_run(3);
  const Delivery delivery = deliver(place, queue, &run, {});
  EXPECT_FALSE(delivery.failure);
  EXPECT_EQ(delivery.sent, 4U);
  EXPECT_EQ(delivery.waiting, 0U);
  Archive archive = open_archive(place);
  const auto results = all_of(archive);
  ASSERT_EQ(results.size(), 8U);
  for (std::size_t i = 0; i < results.size(); ++i) {
    const ArchiveRun pushed = archive_run(3 - static_cast<std::int64_t>(i / 2));
    EXPECT_EQ(every_value(results[i].head), every_value(pushed.head));
    EXPECT_EQ(every_value(results[i].result), every_value(pushed.results[1 - i % 2]));
  }
}

TEST(ArchiveDelivery, MakesNoQueueWhenAllGoesWell) {
  const Scratch scratch;
  const ArchiveRun run = archive_run(1);
  const Delivery delivery =
      deliver(place_of(scratch / "archive.db"), scratch / "queue.db", &run, {});
  EXPECT_EQ(delivery.sent, 1U);
  EXPECT_THAT(scratch.names(), ::testing::ElementsAre("archive.db"));
}

TEST(ArchiveDelivery, KeepsRunsOfTwoArchivesApart) {
  const Scratch scratch;
  const fs::path file = scratch / "queue.db";
  const ArchivePlace one = place_of(scratch / "a" / "archive.db");
  const ArchivePlace two = place_of(scratch / "b" / "archive.db");
  const ArchiveRun run = archive_run(1);
  for (const ArchivePlace* place : {&one, &two, &two}) {
    (void)deliver(*place, file, &run, {.attempts = 1});
  }
  fs::create_directory(scratch / "b");
  EXPECT_EQ(deliver(two, file, nullptr, {}).sent, 1U);
  auto queue = ArchiveQueue::open(file);
  ASSERT_TRUE(queue);
  EXPECT_EQ(*queue->targets(), std::vector<std::string>{one.shown});
  fs::create_directory(scratch / "a");
  EXPECT_EQ(deliver(one, file, nullptr, {}).results, 2U);
  EXPECT_THAT(*queue->targets(), IsEmpty());
}

TEST(ArchiveDelivery, SaysWhenTheQueueFailsToo) {
  const Scratch scratch;
  ASSERT_TRUE(write_file(scratch / "queue.db", "not a database, surely"));
  const ArchiveRun run = archive_run(1);
  const Delivery delivery = deliver(place_of(scratch / "absent" / "archive.db"),
                                    scratch / "queue.db", &run, {.attempts = 1});
  EXPECT_TRUE(delivery.failure);
  ASSERT_TRUE(delivery.queue_failure);
  EXPECT_THAT(delivery.queue_failure->what, HasSubstr("is not a database"));
}

TEST(ArchiveDelivery, DoesNotTryForEver) {
  const Scratch scratch;
  const ArchiveRun run = archive_run(1);
  const auto start = std::chrono::steady_clock::now();
  const Delivery delivery =
      deliver(place_of("postgresql://rondure@127.0.0.1:1/archive"), scratch / "queue.db", &run,
              {.attempts = 1'000'000, .pause_s = 0.01, .give_up_after_s = 0.5});
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(delivery.waiting, 1U);
  EXPECT_LT(passed.count(), 5.0);
}

}  // namespace
}  // namespace rondure::record
