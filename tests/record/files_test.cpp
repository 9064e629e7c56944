#include "record/files.h"

#include <csignal>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "record/sha256.h"
#include "tests/record/sample_run.h"

namespace rondure::record {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Files, GiveBackTheBytesThatWereWritten) {
  const Scratch scratch(Scratch::Where::kDisk);
  std::string bytes(300'000, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 7);
  for (const std::string& content : {std::string(), std::string("x"), bytes}) {
    ASSERT_TRUE(write_file(scratch / "a file", content));
    const auto read = read_file(scratch / "a file");
    ASSERT_TRUE(read) << read.error().what;
    EXPECT_EQ(*read, content);
  }
  EXPECT_THAT(scratch.names(), ElementsAre("a file"));
}

TEST(Files, AreReadableForOthersAsTheUserWants) {
  const Scratch scratch(Scratch::Where::kDisk);
  const mode_t before = ::umask(027);
  ASSERT_TRUE(write_file(scratch / "file", "x"));
  ::umask(before);
  struct stat status = {};
  ASSERT_EQ(::stat((scratch / "file").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0640U);
}

TEST(Files, ThatCannotBeReadAreNamedWithTheReason) {
  const Scratch scratch(Scratch::Where::kDisk);
  const auto missing = read_file(scratch / "missing.csv");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, core::Code::kFile);
  EXPECT_EQ(missing.error().what, "cannot read " + (scratch / "missing.csv").string() +
                                      ": there is no such file or folder");
  EXPECT_EQ(missing.error().where, (scratch / "missing.csv").string());
  EXPECT_THAT(read_file(scratch.path()).error().what, HasSubstr("it is a folder"));
  EXPECT_THAT(read_file("/dev/null/x").error().what, HasSubstr("a part of its path is a file"));
}

TEST(Files, ThatAreNoneAreRefusedAndNotWaitedFor) {
  const Scratch scratch(Scratch::Where::kDisk);
  ASSERT_EQ(::mkfifo((scratch / "pipe").c_str(), 0600), 0);
  for (const std::string& name : {(scratch / "pipe").string(), std::string("/dev/zero")}) {
    const auto read = read_file(name);
    ASSERT_FALSE(read) << name;
    EXPECT_EQ(read.error().what, "cannot read " + name + ": it is a device or a pipe; name a file");
  }
}

TEST(Files, AreWrittenThoughAProcessOfTheSameNumberLeftItsOwnBehind) {
  const Scratch scratch(Scratch::Where::kDisk);
  // As a killed program of this number leaves them, in a container for one: each is number 1 there.
  for (int i = 0; i < 200; ++i) {
    const std::string name = ".rondure-" + std::to_string(::getpid()) + "-" + std::to_string(i);
    ::close(::open((scratch / (name + ".tmp")).c_str(), O_WRONLY | O_CREAT, 0600));
  }
  EXPECT_TRUE(write_file(scratch / "report.html", "x"));
  remove_temporaries(scratch.path());
  EXPECT_THAT(scratch.names(), ElementsAre("report.html"));
}

TEST(Files, BelowADirectoryAreReachedThroughNoLink) {
  const Scratch scratch(Scratch::Where::kDisk);
  const Scratch elsewhere(Scratch::Where::kDisk);
  ASSERT_TRUE(write_inside(scratch.path(), "tables/a.csv", "x"));
  EXPECT_EQ(*read_inside(scratch.path(), "tables/a.csv"), "x");
  EXPECT_EQ(*sha256_inside(scratch.path(), "tables/a.csv"), sha256_hex("x"));
  EXPECT_EQ(*sha256_file(scratch / "tables/a.csv"), sha256_hex("x"));
  ASSERT_TRUE(remove_inside(scratch.path(), "tables/a.csv"));
  EXPECT_FALSE(remove_inside(scratch.path(), "tables/a.csv"));
  ASSERT_TRUE(write_file(elsewhere / "a.csv", "other"));
  std::filesystem::create_directory_symlink(elsewhere.path(), scratch / "link");
  for (const char* name : {"link/a.csv", "../a.csv", "tables/../link/a.csv"}) {
    EXPECT_FALSE(read_inside(scratch.path(), name)) << name;
    EXPECT_FALSE(sha256_inside(scratch.path(), name)) << name;
    EXPECT_FALSE(write_inside(scratch.path(), name, "mine")) << name;
    EXPECT_FALSE(remove_inside(scratch.path(), name)) << name;
  }
  EXPECT_THAT(write_inside(scratch.path(), "link/a.csv", "mine").error().what,
              HasSubstr("it is a link or a file, not a folder of this run; move it away"));
  EXPECT_EQ(*read_file(elsewhere / "a.csv"), "other");
  EXPECT_THAT(elsewhere.names(), ElementsAre("a.csv"));
  std::filesystem::create_symlink(elsewhere / "a.csv", scratch / "b.csv");
  EXPECT_THAT(read_inside(scratch.path(), "b.csv").error().what,
              HasSubstr("b.csv: it is a link, not a file of this run; put the file itself there"));
  EXPECT_FALSE(sha256_inside(scratch.path(), "b.csv"));
  // The directory itself may be a link: a user names it.
  EXPECT_EQ(*read_inside(scratch / "link", "a.csv"), "other");
}

TEST(Files, LongerThanTheirLimitAreRefusedUnread) {
  const Scratch scratch(Scratch::Where::kDisk);
  ASSERT_TRUE(write_file(scratch / "long", ""));
  std::filesystem::resize_file(scratch / "long", kMostDocumentBytes + 1);  // takes no disk
  const auto refused = read_file(scratch / "long");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what,
              HasSubstr("it has 67108865 bytes, the limit for such a file is 67108864"));
  EXPECT_TRUE(read_file(scratch / "long", kMostDocumentBytes + 1));
  std::filesystem::resize_file(scratch / "long", kMostJournalBytes + 1);
  EXPECT_THAT(sha256_inside(scratch.path(), "long").error().what, HasSubstr("is 17179869184"));
  EXPECT_THAT(sha256_file(scratch / "long").error().what, HasSubstr("is 17179869184"));
  EXPECT_THAT(sha256_file(scratch.path()).error().what, HasSubstr("it is a folder"));
}

TEST(Files, ThatCannotBeWrittenAreNamedWithTheReason) {
  const Scratch scratch(Scratch::Where::kDisk);
  const auto missing = write_file(scratch / "no/report.html", "x");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, core::Code::kFile);
  EXPECT_THAT(missing.error().what, HasSubstr((scratch / "no/report.html").string()));
  EXPECT_THAT(missing.error().what, HasSubstr("there is no such file or folder"));
  EXPECT_THAT(write_file(scratch.path(), "x").error().what, HasSubstr("it is a folder"));
  EXPECT_THAT(write_file("/dev/null/x", "x").error().what, HasSubstr("is a file, not a folder"));
  EXPECT_TRUE(scratch.names().empty());
}

TEST(Files, OfAForeignUserAreNamedWithTheReason) {
  const Scratch scratch(Scratch::Where::kDisk);
  ASSERT_TRUE(write_file(scratch / "secret", "x"));
  ASSERT_EQ(::chmod((scratch / "secret").c_str(), 0), 0);
  ASSERT_EQ(::chmod(scratch.path().c_str(), 0555), 0);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    constexpr uid_t kNobody = 65534;
    if (::geteuid() == 0 && ::setuid(kNobody) != 0) ::_exit(1);  // permissions do not bind root
    const auto read = read_file(scratch / "secret");
    const auto written = write_file(scratch / "new", "x");
    const auto says_so = [](const core::Error& error) {
      return error.code == core::Code::kFile &&
             error.what.find("this user is not allowed to") != std::string::npos;
    };
    ::_exit(!read && says_so(read.error()) && !written && says_so(written.error()) ? 0 : 2);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_EQ(::chmod(scratch.path().c_str(), 0755), 0);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(Files, KeepTheOldContentWhenTheNewOneDoesNotFit) {
  const Scratch scratch(Scratch::Where::kDisk);
  ASSERT_TRUE(write_file(scratch / "report.html", "old"));
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit = {1000, 1000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    const auto written = write_file(scratch / "report.html", std::string(5000, 'x'));
    ::_exit(!written && written.error().what.find("largest file") != std::string::npos ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_EQ(*read_file(scratch / "report.html"), "old");
  EXPECT_THAT(scratch.names(), ElementsAre("report.html"));
}

TEST(Files, SayThatADiskIsFull) {
  // The device that is always full; a file there cannot be replaced, so only the words are tested.
  const int full = ::open("/dev/full", O_WRONLY);
  if (full < 0) GTEST_SKIP() << "this system has no /dev/full";
  ASSERT_EQ(::write(full, "x", 1), -1);
  EXPECT_EQ(system_reason(errno),
            "the disk is full (No space left on device); free space on the disk");
  ::close(full);
}

}  // namespace
}  // namespace rondure::record
