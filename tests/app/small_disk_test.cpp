// Runs on a file system that is really full: a tmpfs of a few hundred kilobytes. Mounting needs
// root; elsewhere the tests are skipped and say so (a file-size limit stands in for it in
// resume_test.cpp).

#include <sys/mount.h>

#include <cerrno>
#include <cstring>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "record/journal/journal.h"
#include "tests/app/files.h"
#include "tests/app/program.h"
#include "tests/record/sample_run.h"

namespace rondure::app::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AnyOf;
using ::testing::HasSubstr;

/// A disk of so many kilobytes, unmounted at the end.
class SmallDisk {
 public:
  explicit SmallDisk(int kilobytes) { mounted_ = mount_at(kilobytes, 0); }
  ~SmallDisk() {
    if (mounted_) ::umount2(folder_.path().c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  /// Why there is none, or empty.
  [[nodiscard]] std::string absent() const { return reason_; }
  [[nodiscard]] bool grow() { return mount_at(64 * 1024, MS_REMOUNT); }
  [[nodiscard]] fs::path operator/(const std::string& name) const { return folder_ / name; }

 private:
  bool mount_at(int kilobytes, unsigned long flags) {
    const std::string size = fmt::format("size={}k", kilobytes);
    if (::mount("none", folder_.path().c_str(), "tmpfs", flags, size.c_str()) == 0) return true;
    reason_ = fmt::format("a tmpfs cannot be mounted here: {}", std::strerror(errno));
    return false;
  }

  Scratch folder_;
  std::string reason_;
  bool mounted_ = false;
};

/// The same run with all the room it wants.
std::string bits_with_room(const fs::path& plan) {
  const Scratch folder;
  EXPECT_EQ(rondure({"run", plan, "--out", folder / "run", "--quiet"}).status, 0);
  return record::measured_bits(journal_of(folder / "run"));
}

TEST(SmallDisk, KeepsEveryTouchAndTheRunGoesOnWhenThereIsRoom) {
  const Scratch plans;
  const fs::path plan = plans / "plan.json";
  write_plan(plan, {});
  const std::string whole = bits_with_room(plan);
  int stopped = 0;
  // From no room for a journal to no room for the archive.
  for (int kilobytes : {24, 64, 140, 220, 300, 400, 700, 1000, 1400, 1800, 2000}) {
    SCOPED_TRACE(kilobytes);
    SmallDisk disk(kilobytes);
    if (!disk.absent().empty()) GTEST_SKIP() << disk.absent();
    const std::vector<std::string> words = {"run",        plan,       "--out",
                                            disk / "run", "--resume", "--quiet"};
    std::size_t kept = 0;
    for (int attempt = 0; attempt < 2; ++attempt) {
      const Outcome full = rondure(words);
      const auto read = record::read_journal(disk / "run");
      EXPECT_GE(read ? read->record.touches.size() : 0, kept) << "touches were lost";
      kept = read ? read->record.touches.size() : 0;
      if (full.status == 0 || (full.status == 2 && read && read->record.sealed)) break;
      EXPECT_EQ(full.status, kept > 0 ? 3 : 2) << full.err;
      EXPECT_THAT(full.err, HasSubstr("the disk is full"));
      EXPECT_THAT(full.err, HasSubstr("free space on the disk"));
      if (kept > 0) {
        EXPECT_THAT(full.err, HasSubstr("--resume"));
      }
      ++stopped;
    }
    ASSERT_TRUE(disk.grow());
    const Outcome outcome = rondure(words);
    EXPECT_THAT(outcome.status, AnyOf(0, 2)) << outcome.err;
    EXPECT_EQ(record::measured_bits(journal_of(disk / "run")), whole);
    EXPECT_EQ(rondure({"verify", disk / "run"}).status, 0);
    EXPECT_THAT(rondure({"history", disk / "archive.db"}).out, HasSubstr("conforms"));
  }
  EXPECT_GE(stopped, 8);
}

}  // namespace
}  // namespace rondure::app::testing
