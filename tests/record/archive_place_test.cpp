#include "record/archive_place.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace rondure::record {
namespace {

using ::testing::HasSubstr;
using Kind = ArchivePlace::Kind;

TEST(ArchivePlace, IsAFileAServerOrNone) {
  EXPECT_EQ(parse_archive_place("none")->kind, Kind::kNone);
  EXPECT_EQ(parse_archive_place("runs/archive.db")->kind, Kind::kFile);
  EXPECT_EQ(parse_archive_place("archive.db", "/plans")->address, "/plans/archive.db");
  EXPECT_EQ(parse_archive_place("/a/archive.db", "/plans")->address, "/a/archive.db");
  EXPECT_EQ(parse_archive_place("postgres://h/d")->kind, Kind::kServer);
  EXPECT_EQ(parse_archive_place("postgresql://h/d", "/plans")->address, "postgresql://h/d");
  for (const char* wrong : {"", "mysql://h/d", "https://h", "postgresql://u:p/w@h/d"}) {
    const auto place = parse_archive_place(wrong);
    ASSERT_FALSE(place) << wrong;
    EXPECT_EQ(place.error().code, core::Code::kBadOption);
  }
}

TEST(ArchivePlace, NeverShowsAPassword) {
  const std::vector<std::array<const char*, 2>> urls = {
      {"postgresql://u:secret@h:5432/d", "postgresql://u@h:5432/d"},
      {"postgresql://u:se@cret@h/d", "postgresql://u@h/d"},
      {"postgresql://u:secret@h", "postgresql://u@h"},
      {"postgresql://u:secret@h?a=1", "postgresql://u@h?a=1"},
      {"postgresql:///d?password=secret&host=h", "postgresql:///d?host=h"},
      {"postgresql:///d?host=h&password=secret&user=u", "postgresql:///d?host=h&user=u"},
      {"postgresql:///d?sslpassword=secret", "postgresql:///d"}};
  for (const auto& [url, shown] : urls) {
    const auto place = parse_archive_place(url);
    ASSERT_TRUE(place) << url;
    EXPECT_EQ(place->shown, shown);
    EXPECT_TRUE(place->has_password());
    EXPECT_EQ(place->address, url);
  }
  EXPECT_FALSE(parse_archive_place("postgresql://u@h:5432/d?host=x")->has_password());
}

TEST(FolderBeside, IsTheParentOfTheRun) {
  EXPECT_EQ(folder_beside("runs/7"), "runs");
  EXPECT_EQ(folder_beside("/data/runs/7"), "/data/runs");
  EXPECT_EQ(folder_beside("/data/runs/7/"), "/data/runs");
  EXPECT_EQ(folder_beside("7"), "");
  EXPECT_EQ(folder_beside("."), std::filesystem::current_path().parent_path());
}

}  // namespace
}  // namespace rondure::record
