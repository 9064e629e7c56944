// The rooms and who may include whom: the table of DESIGN.md, held against every #include.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <vector>

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
    {"evaluation", {"evaluation", "core", "fit", "record"}},
    {"reports", {"reports", "core", "fit", "record", "evaluation"}},
    {"web", {"web", "core", "fit", "record", "evaluation", "reports"}},
    {"app",
     {"app", "core", "fit", "wire", "record", "fixture", "cmm", "plans", "evaluation", "reports",
      "web"}},
};

/// Headers that may be included from beyond the table.
bool is_error_model(const std::string& header) {
  return header == "cmm/error_model.h" || header == "fixture/error_model.h";
}

struct Include {
  fs::path file;
  std::string header;
};

/// What stands between the marks of an #include of this kind; empty for another line.
std::string included(const std::string& line, char open, char close) {
  const auto hash = line.find_first_not_of(" \t");
  if (hash == std::string::npos || line.compare(hash, 8, "#include") != 0) return "";
  const auto first = line.find(open, hash);
  const auto last = line.find(close, first + 1);
  if (first == std::string::npos || last == std::string::npos) return "";
  return line.substr(first + 1, last - first - 1);
}

std::vector<Include> includes_of(const std::string& room) {
  std::vector<Include> out;
  const fs::path folder = fs::path(RONDURE_SOURCE_DIR) / room;
  if (!fs::exists(folder)) return out;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const auto extension = entry.path().extension();
    if (extension != ".h" && extension != ".cpp") continue;
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      const std::string header = included(line, '"', '"');
      if (!header.empty()) out.push_back({entry.path(), header});
    }
  }
  return out;
}

TEST(IncludeArrows, PointOneWay) {
  std::size_t checked = 0;
  for (const auto& [room, allowed] : kMayInclude) {
    for (const Include& include : includes_of(room)) {
      const std::string target = include.header.substr(0, include.header.find('/'));
      EXPECT_TRUE(allowed.count(target) == 1 ||
                  ((room == "evaluation" || room == "reports") && is_error_model(include.header)))
          << include.file << " includes " << include.header;
      ++checked;
    }
  }
  EXPECT_GT(checked, 100U);  // the rooms were found
}

using Arrows = std::map<std::string, std::set<std::string>>;

/// One circle of the arrows, "a -> b -> a"; "" when there is none.
std::string circle_of(Arrows arrows) {
  const auto leads_on = [&](const std::string& name) { return arrows.count(name) == 1; };
  for (auto place = arrows.begin(); place != arrows.end();) {
    const bool dead_end = std::none_of(place->second.begin(), place->second.end(), leads_on);
    if (dead_end) arrows.erase(place);  // it is part of no circle; nor may those be that led to it
    place = dead_end ? arrows.begin() : std::next(place);
  }
  if (arrows.empty()) return "";
  std::vector<std::string> path = {arrows.begin()->first};
  while (true) {
    const std::set<std::string>& next = arrows.at(path.back());
    path.push_back(*std::find_if(next.begin(), next.end(), leads_on));
    const auto first = std::find(path.begin(), path.end(), path.back());
    if (first == path.end() - 1) continue;
    std::string circle = *first;
    for (auto place = first + 1; place != path.end(); ++place) circle += " -> " + *place;
    return circle;
  }
}

/// The includes within a room as arrows between the places of the files.
Arrows arrows_within(const std::string& room,
                     const std::function<std::string(const fs::path&)>& place_of) {
  Arrows arrows;
  for (const Include& include : includes_of(room)) {
    const std::string from = place_of(fs::relative(include.file, RONDURE_SOURCE_DIR));
    const std::string to = place_of(include.header);
    if (include.header.rfind(room + "/", 0) == 0 && from != to) arrows[from].insert(to);
  }
  return arrows;
}

TEST(IncludeArrows, FormNoCircleOfFiles) {
  EXPECT_EQ(circle_of({{"a", {"b"}}, {"b", {"c", "d"}}, {"d", {"b"}}}), "b -> d -> b");
  EXPECT_EQ(circle_of({{"a", {"b"}}, {"b", {"c"}}}), "");
  // A header and the source beside it are one: what a source includes, its header stands upon.
  const auto stem = [](fs::path file) { return file.replace_extension().generic_string(); };
  for (const auto& [room, allowed] : kMayInclude) {
    EXPECT_EQ(circle_of(arrows_within(room, stem)), "") << room;
  }
}

TEST(IncludeArrows, FormNoCircleOfFolders) {
  // `internal` counts with its folder.
  const auto folder = [](const fs::path& file) {
    const fs::path parent = file.parent_path();
    return (parent.filename() == "internal" ? parent.parent_path() : parent).generic_string();
  };
  for (const auto& [room, allowed] : kMayInclude) {
    EXPECT_EQ(circle_of(arrows_within(room, folder)), "") << room;
  }
}

TEST(IncludeArrows, KeepsEveryTopLevelFolderARoomOfTheDesign) {
  const std::set<std::string> others = {"tests", "benchmarks", "docs", "build", "runs"};
  for (const auto& entry : fs::directory_iterator(RONDURE_SOURCE_DIR)) {
    const std::string name = entry.path().filename();
    if (!entry.is_directory() || name.front() == '.') continue;
    EXPECT_TRUE(kMayInclude.count(name) == 1 || others.count(name) == 1) << name;
  }
}

// Tests run beside each other: a folder of a fixed name is sooner or later that of two of them.
TEST(Tests, MakeTheirFoldersInOnePlace) {
  const std::string system = "TempDir", standard = "temp_directory_path";
  const std::set<std::string> makers = {"scratch.h", "postgres_server.cpp"};
  for (const auto& entry :
       fs::recursive_directory_iterator(fs::path(RONDURE_SOURCE_DIR) / "tests")) {
    if (!entry.is_regular_file() || makers.count(entry.path().filename()) == 1) continue;
    std::ifstream stream(entry.path());
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    for (const std::string& word : {system + "()", standard + "()"}) {
      EXPECT_EQ(text.find(word), std::string::npos) << entry.path() << ": test::Scratch";
    }
  }
}

TEST(PublicHeaders, KeepHeavyLibrariesInTheirSourceFiles) {
  // JSON in private headers of plans and reports only; CGAL, Ceres, libusb and Asio in no header.
  const std::set<std::string> heavy = {"CGAL", "ceres",    "libusb.h", "libusb-1.0",
                                       "asio", "asio.hpp", "CLI"};
  for (const auto& [room, allowed] : kMayInclude) {
    const fs::path folder = fs::path(RONDURE_SOURCE_DIR) / room;
    if (!fs::exists(folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.path().extension() != ".h") continue;
      std::ifstream file(entry.path());
      for (std::string line; std::getline(file, line);) {
        const std::string header = included(line, '<', '>');
        EXPECT_EQ(heavy.count(header.substr(0, header.find('/'))), 0U)
            << entry.path() << ": " << line;
      }
    }
  }
}

/// The name in "struct Name {" or "class Name : Base {" at the start of a line; "" in any other.
std::string type_begun(const std::string& line) {
  for (const std::string word : {"struct ", "class "}) {
    if (line.rfind(word, 0) != 0 || line.back() != '{') continue;
    return line.substr(word.size(), line.find(' ', word.size()) - word.size());
  }
  return "";
}

TEST(PublicHeaders, NameEachTypeOfARoomOnce) {
  // Two types of one name in one namespace link, and then destroy each other.
  for (const auto& [room, allowed] : kMayInclude) {
    const fs::path folder = fs::path(RONDURE_SOURCE_DIR) / room;
    if (!fs::exists(folder)) continue;
    std::map<std::string, fs::path> seen;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.path().extension() != ".h") continue;
      std::ifstream file(entry.path());
      std::string scope;
      for (std::string line; std::getline(file, line);) {
        if (line.rfind("namespace ", 0) == 0) scope = line;
        const std::string name = type_begun(line);
        if (name.empty()) continue;
        const auto [twin, added] = seen.emplace(scope + name, entry.path());
        EXPECT_TRUE(added) << name << " in " << twin->second << " and " << entry.path();
      }
    }
  }
}

}  // namespace
}  // namespace rondure
