// Documents promise what a test shows: every test that they name must be there.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <fnmatch.h>
#include <gtest/gtest.h>

namespace rondure {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ostringstream out;
  out << std::ifstream(file).rdbuf();
  return out.str();
}

std::vector<std::smatch> matches_of(const std::string& text, const std::string& expression) {
  const std::regex pattern(expression);
  return {std::sregex_iterator(text.begin(), text.end(), pattern), std::sregex_iterator()};
}

/// Suites, and tests as `Suite.Test`, as the sources under tests/ declare them.
struct DeclaredTests {
  std::set<std::string> suites;
  std::set<std::string> names;

  [[nodiscard]] bool any(const std::string& pattern) const {
    return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
      return ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
    });
  }
};

DeclaredTests declared_tests() {
  DeclaredTests out;
  for (const auto& entry :
       fs::recursive_directory_iterator(fs::path(RONDURE_SOURCE_DIR) / "tests")) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string text = text_of(entry.path());
    for (const auto& test : matches_of(text, R"(TEST(_[FP])?\(\s*(\w+),\s*(\w+)\))")) {
      out.suites.insert(test[2]);
      out.names.insert(test.str(2) + "." + test.str(3));
    }
  }
  return out;
}

std::vector<fs::path> documents() {
  const fs::path root = RONDURE_SOURCE_DIR;
  std::vector<fs::path> out = {root / "README.md"};
  for (const auto& entry : fs::recursive_directory_iterator(root / "docs")) {
    if (entry.path().extension() == ".md") out.push_back(entry.path());
  }
  return out;
}

TEST(Documents, NameTestsThatAreThere) {
  const DeclaredTests tests = declared_tests();
  ASSERT_GT(tests.names.size(), 1000U);
  std::size_t checked = 0;
  for (const fs::path& document : documents()) {
    const std::string text = text_of(document);
    for (const auto& filter : matches_of(text, R"(gtest_filter='?([\w*.:/]+))")) {
      std::istringstream patterns(filter.str(1));
      for (std::string pattern; std::getline(patterns, pattern, ':'); ++checked) {
        EXPECT_TRUE(tests.any(pattern)) << document << ": " << pattern;
      }
    }
    for (const auto& quoted : matches_of(text, R"(`(\w+)\.(\w+)(\*|\.\.\.)?`)")) {
      if (tests.suites.count(quoted[1]) == 0) continue;  // also members and keys have a point
      const std::string pattern =
          quoted.str(1) + "." + quoted.str(2) + (quoted[3].matched ? "*" : "");
      EXPECT_TRUE(tests.any(pattern)) << document << ": " << pattern;
      ++checked;
    }
  }
  EXPECT_GT(checked, 100U);
}

// Its tables name tests without their suites.
TEST(Documents, PromiseNothingOfReliabilityWithoutATest) {
  const DeclaredTests tests = declared_tests();
  const std::string text = text_of(fs::path(RONDURE_SOURCE_DIR) / "docs" / "reliability.md");
  std::size_t checked = 0;
  for (const auto& quoted : matches_of(text, "`((?:[A-Z][a-z0-9]+|A){3,})`")) {
    EXPECT_TRUE(tests.any("*." + quoted.str(1))) << quoted[1];
    ++checked;
  }
  EXPECT_GT(checked, 8U);
}

// A path that a document names is one that a reader can open: of the sources, from the root.
TEST(Documents, NameSourcesThatAreThere) {
  const fs::path root = RONDURE_SOURCE_DIR;
  std::vector<fs::path> all = documents();
  std::set<std::string> rooms;
  for (const auto& entry : fs::directory_iterator(root)) {
    if (!fs::exists(entry.path() / "README.md")) continue;
    rooms.insert(entry.path().filename());
    all.push_back(entry.path() / "README.md");
  }
  std::size_t checked = 0;
  for (const fs::path& document : all) {
    const std::string text = text_of(document);  // matches refer to it
    for (const auto& quoted : matches_of(text, R"(`(([a-z]+)/[\w/]+\.(h|cpp|py|sh))`)")) {
      if (rooms.count(quoted[2]) == 0 && quoted[2] != "tests") continue;
      EXPECT_TRUE(fs::exists(root / quoted.str(1))) << document << ": " << quoted[1];
      ++checked;
    }
  }
  EXPECT_GT(checked, 50U);
}

// A relative link of a page leads to a file that is there.
TEST(Documents, LinkToFilesThatAreThere) {
  std::size_t checked = 0;
  for (const fs::path& document : documents()) {
    const std::string text = text_of(document);
    for (const auto& link : matches_of(text, R"(\]\(([^)#:\s]+)(#[^)\s]*)?\))")) {
      EXPECT_TRUE(fs::exists(document.parent_path() / link.str(1))) << document << ": " << link[1];
      ++checked;
    }
  }
  EXPECT_GT(checked, 100U);
}

TEST(Documents, ReadmeHasAtMost700Words) {
  std::istringstream text(text_of(fs::path(RONDURE_SOURCE_DIR) / "README.md"));
  std::size_t words = 0;
  for (std::string word; text >> word;) ++words;
  EXPECT_LE(words, 700U);
}

}  // namespace
}  // namespace rondure
