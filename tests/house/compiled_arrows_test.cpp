// What the compiler finds for a file of each room: its own headers and the public ones of the rooms
// it links.

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/core/scratch.h"

namespace rondure {
namespace {

namespace fs = std::filesystem;

const std::map<std::string, std::set<std::string>> kLinks = {
    {"core", {}},
    {"fit", {"core"}},
    {"wire", {"core"}},
    {"record", {"core"}},
    {"fixture", {"core", "wire"}},
    {"cmm", {"core", "wire"}},
    {"plans", {"core", "fit", "wire", "record", "fixture", "cmm"}},
    {"evaluation", {"core", "fit", "record"}},
    {"reports", {"core", "fit", "record", "evaluation"}},
    {"web", {"core", "fit", "record", "evaluation", "reports"}},
};
/// Of these two rooms, evaluation may know the error model and what that header includes.
const std::set<std::string> kErrorModel = {"cmm/error_model.h",     "fixture/axis_motion.h",
                                           "fixture/calibration.h", "fixture/calibration_draws.h",
                                           "fixture/error_model.h", "fixture/kinematics.h",
                                           "fixture/axis_motion.h"};

bool is_internal(const std::string& header) {
  return header.find("/internal/") != std::string::npos;
}

std::set<std::string> headers_of(const std::string& room) {
  std::set<std::string> out;
  const fs::path root = RONDURE_SOURCE_DIR;
  for (const auto& entry : fs::recursive_directory_iterator(root / room)) {
    if (entry.path().extension() == ".h") out.insert(fs::relative(entry.path(), root).string());
  }
  return out;
}

/// The compiler and the include paths that a file of the room is compiled with.
std::string compiler_of(const std::string& room) {
  std::ifstream file(fs::path(RONDURE_BINARY).parent_path() / "compile_commands.json");
  for (const auto& entry : nlohmann::json::parse(file)) {
    std::istringstream words(entry.at("command").get<std::string>());
    if (words.str().find("/rondure_" + room + ".dir/") == std::string::npos) continue;
    std::string out;
    words >> out;
    for (std::string word; words >> word;) {
      if (word.rfind("-I", 0) == 0) out += " " + word;
      if (word == "-isystem" && words >> word) out += " -isystem " + word;
    }
    return out + " -std=c++20 ";
  }
  return "";
}

/// What the command says, and with it how it ended.
std::string said(const std::string& command, int& status) {
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  std::string out;
  char part[4096];
  while (const std::size_t count = std::fread(part, 1, sizeof part, pipe)) out.append(part, count);
  status = pclose(pipe);
  return out;
}

TEST(CompiledArrows, ARoomFindsItsOwnHeadersAndThePublicOnesOfTheRoomsItLinks) {
  std::set<std::string> headers;
  for (const auto& [room, links] : kLinks) headers.merge(headers_of(room));
  headers.merge(headers_of("app"));
  const test::Scratch folder;
  const fs::path question = folder / "has_include.cpp";
  std::ofstream(question) << [&] {
    std::string text;
    for (const std::string& header : headers) {
      text += "#if __has_include(\"" + header + "\")\nseen<" + header + ">\n#endif\n";
    }
    return text;
  }();
  for (const auto& [room, links] : kLinks) {
    int status = 1;
    const std::string compiler = compiler_of(room);
    ASSERT_FALSE(compiler.empty()) << room;
    const std::string seen = said(compiler + "-E -P '" + question.string() + "'", status);
    ASSERT_EQ(status, 0) << seen;
    for (const std::string& header : headers) {
      const std::string owner = header.substr(0, header.find('/'));
      const bool public_one = links.count(owner) == 1 && !is_internal(header);
      const bool model = kErrorModel.count(header) == 1 &&
                         (room == "evaluation" || room == "reports" || room == "web");
      EXPECT_EQ(seen.find("seen<" + header + ">") != std::string::npos,
                owner == room || public_one || model)
          << "for " << room << ": " << header;
    }
  }
}

TEST(CompiledArrows, AWrongIncludeDoesNotCompile) {
  const test::Scratch folder;
  const auto compiled = [&](const std::string& room, const std::string& header) {
    const fs::path file = folder / "wrong.cpp";
    std::ofstream(file) << "#include \"" << header << "\"\n";
    int status = 0;
    const std::string text =
        said(compiler_of(room) + "-fsyntax-only '" + file.string() + "'", status);
    if (status != 0) {
      EXPECT_THAT(text, testing::HasSubstr(header + ": No such file or directory"));
    }
    return status == 0;
  };
  EXPECT_TRUE(compiled("fit", "core/result.h"));
  EXPECT_FALSE(compiled("fit", "record/run_record.h"));      // against the arrows
  EXPECT_FALSE(compiled("evaluation", "cmm/machine.h"));     // judging knows no drivers
  EXPECT_TRUE(compiled("evaluation", "cmm/error_model.h"));  // but the error model
  EXPECT_FALSE(compiled("plans", "record/journal/internal/rows.h"));
}

class HeadersOf : public testing::TestWithParam<const char*> {};

TEST_P(HeadersOf, ARoomCompileAlone) {
  if (std::getenv("RONDURE_FULL") == nullptr) {
    GTEST_SKIP() << "Up to a minute per room: run by ./test.sh --full";
  }
  const std::string room = GetParam();
  const std::string compiler = compiler_of(room);
  // What the build puts before every file is read once for all. Other programs include the headers
  // of the fits and of core: these bring everything themselves, but for Eigen/Core, in which most
  // of the time goes.
  const bool installed = room == "fit" || room == "core";
  const fs::path common =
      fs::path(RONDURE_BINARY).parent_path() / "CMakeFiles/rondure_headers.dir/cmake_pch.hxx";
  const test::Scratch folder;
  const std::string before = (folder / "before.h").string();
  std::ofstream(before) << "#include "
                        << (installed ? "<Eigen/Core>" : "\"" + common.string() + "\"") << "\n";
  int status = 0;
  const std::string made =
      said(compiler + "-x c++-header '" + before + "' -o '" + before + ".gch'", status);
  ASSERT_EQ(status, 0) << made;
  for (const std::string& header : headers_of(room)) {
    const std::string text = said(compiler + "-x c++ -fsyntax-only -include '" + before +
                                      "' -include " + header + " /dev/null",
                                  status);
    EXPECT_EQ(status, 0) << header << "\n" << text;
  }
}

INSTANTIATE_TEST_SUITE_P(Rooms, HeadersOf,
                         testing::Values("core", "fit", "wire", "record", "fixture", "cmm", "plans",
                                         "evaluation", "reports", "web"));

}  // namespace
}  // namespace rondure
