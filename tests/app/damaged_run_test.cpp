// Damaged, half-written and foreign run directories: verify ends in a clear sentence and the right
// exit status, and never calls equal what is not. 200 flipped bytes a file of a run with intervals
// and 100 cuts with RONDURE_FULL=all, a third of them with ./test.sh --full; else a tenth, without
// intervals.

#include <unistd.h>

#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/noise.h"
#include "record/journal/journal.h"
#include "tests/app/files.h"
#include "tests/app/program.h"
#include "tests/core/full.h"

namespace rondure::app::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

int count(int all) { return test::cases(all / 10, all / 3, all); }

/// A finished run of 24 points from a file.
class DamagedRun : public ::testing::Test {
 protected:
  void SetUp() override {
    const Outcome ran =
        test::full()
            ? rondure({"run", example("09_axle_points_file.json"), "--out", run_, "--quiet"})
            : run_without_intervals("09_axle_points_file", {"--out", run_, "--quiet"});
    ASSERT_EQ(ran.status, 0);
    ASSERT_EQ(verify().status, 0);
  }
  [[nodiscard]] Outcome verify() const { return rondure({"verify", run_}); }

  /// Not equal or unreadable, in a sentence that is no defect of the program.
  static void expect_told(const Outcome& outcome) {
    EXPECT_EQ(outcome.signal, 0);
    EXPECT_THAT(outcome.status, AnyOf(1, 2));
    if (outcome.status == 1) {
      EXPECT_THAT(outcome.out, StartsWith("not equal: "));
      EXPECT_EQ(outcome.err, "");
    } else {
      EXPECT_EQ(outcome.out, "");
      EXPECT_THAT(outcome.err, StartsWith("rondure: "));
      EXPECT_THAT(outcome.err, Not(HasSubstr("[internal]")));
    }
  }

  /// A run that was killed after `touches` of this run's touches, in a directory of its own.
  [[nodiscard]] fs::path killed_after(std::size_t touches) const {
    const record::RunRecord whole = journal_of(run_);
    auto journal = record::Journal::create(folder_ / "open", whole.header, whole.artefact,
                                           whole.features, whole.settings);
    EXPECT_TRUE(journal);
    for (const record::PoseVisit& pose : whole.poses) EXPECT_TRUE(journal->add(pose));
    for (std::size_t i = 0; i < touches; ++i) EXPECT_TRUE(journal->add(whole.touches[i]));
    fs::create_directory(folder_ / "killed");
    for (const char* name : {"journal.db", "journal.db-wal"}) {
      fs::copy_file(folder_ / "open" / name, folder_ / "killed" / name);
    }
    return folder_ / "killed";
  }

  Scratch folder_;
  fs::path run_ = folder_ / "run";
};

TEST_F(DamagedRun, EveryFlippedByteIsTold) {
  std::uint64_t state = 21;
  for (const std::string file : {"journal.db", "report.json", "report.html", "touches.csv"}) {
    const std::string bytes = read(run_ / file);
    for (int i = 0; i < count(200); ++i) {
      std::string damaged = bytes;
      const std::size_t at = core::splitmix64(state) % damaged.size();
      damaged[at] = static_cast<char>(damaged[at] ^ (1 + core::splitmix64(state) % 255));
      SCOPED_TRACE(file + " byte " + std::to_string(at));
      write(run_ / file, damaged);
      const Outcome outcome = verify();
      expect_told(outcome);
      EXPECT_THAT(outcome.out + outcome.err,
                  HasSubstr(file == "journal.db" ? std::string("journal") : file + ": "));
    }
    write(run_ / file, bytes);
  }
  EXPECT_EQ(verify().status, 0);
}

TEST_F(DamagedRun, EveryCutOfTheJournalIsTold) {
  const std::string bytes = read(run_ / "journal.db");
  std::uint64_t state = 22;
  for (int i = 0; i < count(100); ++i) {
    const std::size_t size = core::splitmix64(state) % bytes.size();
    SCOPED_TRACE(size);
    write(run_ / "journal.db", bytes.substr(0, size));
    expect_told(verify());
  }
}

TEST_F(DamagedRun, WithoutItsLastPageSaysWhatIsMissing) {
  const std::string bytes = read(run_ / "journal.db");
  write(run_ / "journal.db", bytes.substr(0, bytes.size() - 4096));
  const Outcome outcome = verify();
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(
      outcome.err,
      AllOf(HasSubstr("the journal cannot be read: it is damaged"),
            HasSubstr("the file ends after " + std::to_string(bytes.size() - 4096) + " of " +
                      std::to_string(bytes.size()) + " bytes, the last 4096 are missing; "),
            HasSubstr(" rows can be read"),
            HasSubstr("copy the run directory again from where it was measured")));
}

TEST_F(DamagedRun, CopiedWithoutItsLogKeepsToWhatIsThere) {
  const fs::path killed = killed_after(10);
  const std::string log = read(killed / "journal.db-wal");
  std::uint64_t state = 23;
  for (int i = 0; i < count(100); ++i) {
    const std::size_t size = i == 0 ? 0 : core::splitmix64(state) % log.size();
    SCOPED_TRACE(size);
    write(killed / "journal.db-wal", log.substr(0, size));
    const Outcome outcome = rondure({"verify", killed});
    EXPECT_EQ(outcome.status, 1) << outcome.err;
    EXPECT_THAT(outcome.out, AllOf(StartsWith("not equal: the run did not finish (it was "
                                              "interrupted); it has no results to verify"),
                                   Not(HasSubstr("table"))));
  }
}

TEST_F(DamagedRun, WithoutReportsIsEqualAndSaysSo) {
  for (const char* name : {"report.html", "report.json", "touches.csv", "results.csv"}) {
    fs::remove(run_ / name);
  }
  const Outcome outcome = verify();
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, HasSubstr("exports compared: none; not there: report.html, "
                                     "report.json, touches.csv, results.csv"));
  fs::remove(run_ / "SHA256SUMS");
  const Outcome bare = verify();
  EXPECT_EQ(bare.status, 0);
  EXPECT_THAT(bare.out, HasSubstr("note: there is no SHA256SUMS, which the run wrote"));
}

TEST_F(DamagedRun, AChangedListOfDigestsIsTold) {
  const std::string list = read(run_ / "SHA256SUMS");
  write(run_ / "SHA256SUMS", "nothing\n");
  EXPECT_THAT(verify().out, HasSubstr("not equal: SHA256SUMS:1: this is no line of sha256sum"));
  write(run_ / "SHA256SUMS", list.substr(list.find('\n') + 1));
  EXPECT_THAT(verify().out, HasSubstr("SHA256SUMS: its line for journal.db is missing"));
  write(run_ / "SHA256SUMS", list + std::string(64, '0') + "  photo.jpg\n");
  EXPECT_THAT(verify().out, HasSubstr("photo.jpg: it is not there, and SHA256SUMS names it"));
  write(run_ / "photo.jpg", "a picture of the part");
  EXPECT_THAT(verify().out, HasSubstr("photo.jpg: its bytes were changed after it was written"));
  EXPECT_EQ(verify().status, 1);
}

TEST_F(DamagedRun, AChangeBesideTheValuesOfTheJournalIsTold) {
  std::string bytes = read(run_ / "journal.db");
  char& version_of_sqlite = bytes[99];  // the number of the library that wrote last
  version_of_sqlite = static_cast<char>(version_of_sqlite + 1);
  write(run_ / "journal.db", bytes);
  EXPECT_THAT(verify().out, HasSubstr("journal.db: its bytes were changed after it was written "
                                      "(SHA256SUMS); no value in it differs"));
}

TEST_F(DamagedRun, IsVerifiedWhereverItIsCopiedOrLinkedTo) {
  const fs::path copy = folder_ / "a copy of it";
  fs::copy(run_, copy);
  fs::create_directory_symlink(copy, folder_ / "link");
  for (const fs::path& place : {copy, folder_ / "link", folder_ / "link/"}) {
    EXPECT_EQ(rondure({"verify", place}).status, 0) << place;
  }
}

// A link could lead to a file that changes after it was verified.
TEST_F(DamagedRun, WithALinkInPlaceOfAFileIsRefusedByName) {
  std::vector<std::string> files = names_in(run_);
  ASSERT_THAT(files, ::testing::IsSupersetOf({"journal.db", "SHA256SUMS", "report.html"}));
  write(run_ / "earlier.json", "{\"results\": []}");
  files.emplace_back("earlier.json");
  for (const std::string& file : files) {
    fs::rename(run_ / file, folder_ / "elsewhere");
    fs::create_symlink(folder_ / "elsewhere", run_ / file);
    const Outcome outcome = verify();
    EXPECT_NE(outcome.status, 0) << file;
    EXPECT_THAT(outcome.out + outcome.err, AllOf(HasSubstr((run_ / file).string()),
                                                 HasSubstr("is a link, not a file of this run")));
    fs::remove(run_ / file);
    fs::rename(folder_ / "elsewhere", run_ / file);
  }
  EXPECT_EQ(verify().status, 0);
}

TEST_F(DamagedRun, AmongTenThousandFilesIsVerified) {
  for (int i = 0; i < 10'000; ++i) write(run_ / ("note" + std::to_string(i)), "");
  EXPECT_EQ(verify().status, 0);
}

TEST_F(DamagedRun, PlacesThatAreNoRunAreUnreadable) {
  fs::create_directory(folder_ / "empty");
  fs::create_directory(folder_ / "foreign");
  write(folder_ / "foreign/readme.txt", "not a run");
  write(folder_ / "foreign/report.json", "{}");
  fs::create_symlink("loop", folder_ / "loop");
  for (const fs::path& place : {folder_ / "empty", folder_ / "foreign", folder_ / "absent",
                                run_ / "report.json", fs::path("/dev/null"), folder_ / "loop"}) {
    SCOPED_TRACE(place);
    const Outcome outcome = rondure({"verify", place});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, AnyOf(HasSubstr("name the directory of a run"),
                                   HasSubstr("Too many levels of symbolic links")));
  }
}

TEST_F(DamagedRun, FilesThatCannotBeReadAreUnreadable) {
  const auto expect_unreadable = [&](const std::string& file) {
    const Outcome outcome = verify();
    EXPECT_EQ(outcome.status, 2) << outcome.out;
    EXPECT_THAT(outcome.err, HasSubstr("cannot read " + (run_ / file).string()));
  };
  for (const std::string file : {"report.html", "SHA256SUMS"}) {
    const std::string bytes = read(run_ / file);
    fs::remove(run_ / file);
    fs::create_symlink(file, run_ / file);
    expect_unreadable(file);
    fs::remove(run_ / file);
    fs::create_directory(run_ / file);
    expect_unreadable(file);
    fs::remove(run_ / file);
    write(run_ / file, bytes);
    if (::geteuid() == 0) continue;  // the superuser may read everything
    fs::permissions(run_ / file, fs::perms::none);
    expect_unreadable(file);
    fs::permissions(run_ / file, fs::perms::owner_all);
  }
  if (::geteuid() == 0) return;
  fs::permissions(run_ / "journal.db", fs::perms::none);
  EXPECT_EQ(verify().status, 2);
  EXPECT_THAT(verify().err, HasSubstr("this user is not allowed to"));
}

}  // namespace
}  // namespace rondure::app::testing
