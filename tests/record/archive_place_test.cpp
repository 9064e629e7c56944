#include "record/archive/place.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "record/archive/internal/postgresql.h"
#include "record/archive/internal/server_url.h"

namespace rondure::record {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Kind = ArchivePlace::Kind;

TEST(ArchivePlace, IsAFileAServerOrNone) {
  EXPECT_EQ(parse_archive_place("none")->kind, Kind::kNone);
  EXPECT_EQ(parse_archive_place("runs/archive.db")->kind, Kind::kFile);
  EXPECT_EQ(parse_archive_place("archive.db", "/plans")->address, "/plans/archive.db");
  EXPECT_EQ(parse_archive_place("/a/archive.db", "/plans")->address, "/a/archive.db");
  EXPECT_EQ(parse_archive_place("postgres://h/d")->kind, Kind::kServer);
  EXPECT_EQ(parse_archive_place("postgresql://h/d", "/plans")->address, "postgresql://h/d");
  for (const char* wrong :
       {"", "mysql://h/d", "https://h", "postgresql://u:p/w@h/d", "postgresql://u:p@w@h/d",
        "host=h password=secret", "postgresql://h/d?a=1", "postgresql://u:p%zz@h/d"}) {
    const auto place = parse_archive_place(wrong);
    ASSERT_FALSE(place) << wrong;
    EXPECT_EQ(place.error().code, core::Code::kBadOption);
  }
}

TEST(ArchivePlace, NeverShowsAPassword) {
  const std::vector<std::array<const char*, 2>> urls = {
      {"postgresql://u:secret@h:5432/d", "postgresql://u@h:5432/d"},
      {"postgresql://u:secret@h", "postgresql://u@h"},
      {"postgres://u:secret@h?sslmode=require", "postgres://u@h?sslmode=require"},
      {"postgresql://u:sec?ret@h:5432/d", "postgresql://u@h:5432/d"},
      {"postgresql://u:?@h/d?connect_timeout=3", "postgresql://u@h/d?connect_timeout=3"},
      {"postgresql://u:sec%3Fr%40t@[::1]:1/d%20b", "postgresql://u@[::1]:1/d%20b"},
      {"postgresql://u:secret@h1:1,h2:2/d", "postgresql://u@/d?host=h1%2Ch2&port=1%2C2"},
      {"postgresql:///d?password=secret&host=h", "postgresql://h/d"},
      {"postgresql:///d?pass%77ord=secret&user=u", "postgresql://u@/d"},
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

TEST(ArchivePlace, IsRefusedWithoutAWordOfItsPassword) {
  for (const char* url :
       {"postgresql://u:sec%zzret@h/d", "postgresql://u:sec@ret@h/d", "postgresql://u:sec/ret@h/d",
        "postgresql://u:sec@h/d?ret", "postgresql://u:sec@h/d?ret=1", "postgresql://u:sec@[h/ret",
        "postgresql://u:sec@[h]ret/d", "user=u password=sec host=ret", "postgresql:/u:sec@ret/d"}) {
    const auto place = parse_archive_place(url);
    ASSERT_FALSE(place) << url;
    EXPECT_THAT(place.error().what, Not(AnyOf(HasSubstr("sec"), HasSubstr("ret")))) << url;
  }
}

TEST(ServerUrl, SaysTheSameWhenItIsSpelledAnew) {
  for (const char* url : {"postgresql://u:s?e%40c\"r e't@h:5432/d", "postgresql:///?host=%2Ftmp",
                          "postgresql://h1:1,h2:2/d?sslmode=require", "postgresql://"}) {
    const auto settings = parse_server_url(url).value();
    const auto again = parse_server_url(server_url(settings)).value();
    ASSERT_EQ(again.size(), settings.size()) << url;
    for (std::size_t i = 0; i < settings.size(); ++i) {
      EXPECT_EQ(again[i].keyword + "=" + again[i].value,
                settings[i].keyword + "=" + settings[i].value);
    }
    EXPECT_EQ(server_url(settings).find_first_of(" '\""), std::string::npos);
  }
}

TEST(ServerUrl, AndItsPasswordAreTakenOutOfWhatTheLibrarySays) {
  const std::string url = "postgresql://u:s%3Fcret@h/d";
  EXPECT_EQ(without_secrets("no \"" + url + "\", no s?cret, no s%3Fcret", url),
            "no \"...\", no ..., no ...");
}

TEST(ServerUrl, NeedsALibraryThatMayBeMissing) {
  const auto missing = load_postgresql("libsoci_of_nobody.so.1");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, core::Code::kFile);
  EXPECT_THAT(missing.error().what,
              AllOf(HasSubstr("libsoci_of_nobody.so.1"), HasSubstr("install libsoci-postgresql")));
  // Another library of SOCI has not what is looked for.
  const auto other = load_postgresql("libsoci_core.so.4.0");
  ASSERT_FALSE(other);
  EXPECT_THAT(other.error().what, HasSubstr("factory_postgresql"));
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
