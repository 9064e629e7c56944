#include "record/checksums.h"
#include "record/sha256.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "record/files.h"
#include "tests/record/sample_run.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

const std::string kDigest(64, 'a');

TEST(Checksums, ReplaceTheLinesOfTheSameFilesAndKeepTheOthers) {
  const Scratch scratch;
  ASSERT_TRUE(update_checksums(scratch.path(), {{"journal.db", kDigest}, {"a b.txt", kDigest}}));
  ASSERT_TRUE(update_checksums(scratch.path(), {{"x", kDigest}, {"a b.txt", sha256_hex("")}}));
  EXPECT_EQ(*read_file(scratch / "SHA256SUMS"),
            kDigest + "  journal.db\n" + sha256_hex("") + "  a b.txt\n" + kDigest + "  x\n");
  const auto list = read_checksums(scratch.path());
  ASSERT_TRUE(list) << list.error().what;
  ASSERT_EQ(list->size(), 3U);
  EXPECT_EQ((*list)[1].file, "a b.txt");
  EXPECT_EQ((*list)[1].sha256, sha256_hex(""));
}

TEST(Checksums, AreThoseOfSha256sum) {
  const Scratch scratch;
  ASSERT_TRUE(write_file(scratch / "file", "content"));
  ASSERT_TRUE(update_checksums(scratch.path(), {{"file", sha256_hex("content")}}));
  const std::string check =
      "cd '" + scratch.path().string() + "' && sha256sum --strict --status -c SHA256SUMS";
  EXPECT_EQ(std::system(check.c_str()), 0);
  ASSERT_TRUE(write_file(scratch / "file", "another"));
  EXPECT_NE(std::system(check.c_str()), 0);
  // And it reads what sha256sum writes, in both of its modes.
  const std::string make = "cd '" + scratch.path().string() +
                           "' && (sha256sum file; sha256sum --binary file) > SHA256SUMS";
  ASSERT_EQ(std::system(make.c_str()), 0);
  const auto list = read_checksums(scratch.path());
  ASSERT_TRUE(list) << list.error().what;
  ASSERT_EQ(list->size(), 2U);
  for (const Checksum& line : *list) EXPECT_EQ(line.sha256, sha256_hex("another"));
}

TEST(Checksums, NameFilesOfFoldersToo) {
  const Scratch scratch;
  fs::create_directory(scratch / "corrections");
  ASSERT_TRUE(write_file(scratch / "corrections/a.csv", "content"));
  ASSERT_TRUE(update_checksums(scratch.path(), {{"corrections/a.csv", sha256_hex("content")}}));
  const auto list = read_checksums(scratch.path());
  ASSERT_TRUE(list) << list.error().what;
  EXPECT_EQ(list->front().file, "corrections/a.csv");
  const std::string check =
      "cd '" + scratch.path().string() + "' && sha256sum --strict --status -c SHA256SUMS";
  EXPECT_EQ(std::system(check.c_str()), 0);
}

TEST(Checksums, LinesThatAreNoneAreNamed) {
  const Scratch scratch;
  const std::string good = kDigest + "  journal.db\n";
  for (const std::string& line :
       {std::string("x"), std::string(), kDigest, kDigest + "  ", kDigest + " file",
        std::string(64, 'G') + "  file", kDigest + "  ../file", kDigest + "  /etc/passwd",
        kDigest + "  ..", kDigest + "  a/../../b", kDigest + "  a//b", kDigest + "  a/",
        kDigest + "  a" + std::string(1, '\0')}) {
    SCOPED_TRACE(line);
    std::ofstream(scratch / "SHA256SUMS", std::ios::binary) << good << line << "\n" << good;
    for (const auto& problem : {read_checksums(scratch.path()).error(),
                                update_checksums(scratch.path(), {{"x", kDigest}}).error()}) {
      EXPECT_EQ(problem.code, core::Code::kSyntax);
      EXPECT_EQ(problem.where, "SHA256SUMS:2");
      EXPECT_THAT(problem.what, HasSubstr("no line of sha256sum"));
    }
  }
  fs::remove(scratch / "SHA256SUMS");
  EXPECT_EQ(read_checksums(scratch.path()).error().code, core::Code::kFile);
}

}  // namespace
}  // namespace rondure::record
