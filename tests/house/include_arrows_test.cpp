// The rooms and who may include whom: the table of DESIGN.md, held against every #include.

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace rondure {
namespace {

namespace fs = std::filesystem;

const std::map<std::string, std::set<std::string>> kMayInclude = {
    {"core", {"core"}},
    {"fit", {"fit", "core"}},
    {"wire", {"wire", "core"}},
    {"record", {"record", "core"}},
    {"fixture", {"fixture", "core", "wire"}},
    {"cmm", {"cmm", "core", "wire"}},
    {"plans", {"plans", "core", "fit", "wire", "record", "fixture", "cmm"}},
    {"reports", {"reports", "core", "fit", "record"}},
    {"app", {"app", "core", "fit", "wire", "record", "fixture", "cmm", "plans", "reports"}},
};

/// Headers that may be included from beyond the table.
bool is_error_model(const std::string& header) {
  return header == "cmm/error_model.h" || header == "fixture/error_model.h";
}

struct Include {
  fs::path file;
  std::string header;
};

std::vector<Include> includes_of(const std::string& room) {
  static const std::regex pattern("^\\s*#include\\s+\"([^\"]+)\"");
  std::vector<Include> out;
  const fs::path folder = fs::path(RONDURE_SOURCE_DIR) / room;
  if (!fs::exists(folder)) return out;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const auto extension = entry.path().extension();
    if (extension != ".h" && extension != ".cpp") continue;
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      std::smatch found;
      if (std::regex_search(line, found, pattern)) out.push_back({entry.path(), found[1]});
    }
  }
  return out;
}

TEST(IncludeArrows, PointOneWay) {
  std::size_t checked = 0;
  for (const auto& [room, allowed] : kMayInclude) {
    for (const Include& include : includes_of(room)) {
      const std::string target = include.header.substr(0, include.header.find('/'));
      EXPECT_TRUE(allowed.count(target) == 1 || (room == "reports" && is_error_model(include.header)))
          << include.file << " includes " << include.header;
      ++checked;
    }
  }
  EXPECT_GT(checked, 100U);  // the rooms were found
}

TEST(IncludeArrows, KeepsEveryTopLevelFolderARoomOfTheDesign) {
  const std::set<std::string> others = {"tests", "benchmarks", "docs", "build", "runs"};
  for (const auto& entry : fs::directory_iterator(RONDURE_SOURCE_DIR)) {
    const std::string name = entry.path().filename();
    if (!entry.is_directory() || name.front() == '.') continue;
    EXPECT_TRUE(kMayInclude.count(name) == 1 || others.count(name) == 1) << name;
  }
}

TEST(PublicHeaders, KeepHeavyLibrariesInTheirSourceFiles) {
  // JSON in private headers of plans and reports only; CGAL, Ceres, libusb and Asio in no header.
  static const std::regex heavy("^\\s*#include\\s+<(CGAL|ceres|libusb|asio|CLI)");
  for (const auto& [room, allowed] : kMayInclude) {
    const fs::path folder = fs::path(RONDURE_SOURCE_DIR) / room;
    if (!fs::exists(folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.path().extension() != ".h") continue;
      std::ifstream file(entry.path());
      for (std::string line; std::getline(file, line);) {
        EXPECT_FALSE(std::regex_search(line, heavy)) << entry.path() << ": " << line;
      }
    }
  }
}

}  // namespace
}  // namespace rondure
