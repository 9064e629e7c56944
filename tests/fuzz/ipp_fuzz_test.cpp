// Damaged dialogues. 4000 inputs each, a million with RONDURE_FULL=1; tests/fuzz/run.sh searches
// with libFuzzer where clang is installed.

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/fuzz/ipp_entries.h"
#include "tests/fuzz/mutation.h"

namespace rondure::fuzz {
namespace {

unsigned inputs() { return std::getenv("RONDURE_FULL") != nullptr ? 1'000'000U : 4'000U; }

/// Lines of one side of the recorded dialogue.
std::vector<std::string> recorded(const std::string& side) {
  std::ifstream file(RONDURE_SOURCE_DIR "/tests/data/ipp_dme_dialogue/dialogue.txt");
  std::vector<std::string> out;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with(side)) out.push_back(line.substr(side.size()));
  }
  return out;
}

std::vector<std::string> words() {
  return {"X(1)",
          "IJK(0,0,1)",
          "Tool.",
          "PtMeas(",
          "E0001 ",
          "00001 ",
          "\r\n",
          "\n",
          "1e999",
          "-1e-300",
          "1e300",
          "\"",
          "(((((",
          ")))",
          ",,",
          "AbortE()",
          "StartSession()",
          "Simulation.NextTouch(9)",
          "ClearAllErrors()",
          "0.0000001",
          "99999999999999",
          "PartCsy",
          "StopAllDaemons()",
          "GoTo(X(5))",
          "Home()",
          "OnMoveReportE(Time(0),Dis(1),X())",
          "ScanOnCircle(0,0,0,9,0,0,0,0,1,360,0,1)"};
}

/// Pieces of dialogue of some lines each, behind the byte that chooses how the server is.
std::vector<std::string> server_corpus() {
  const std::vector<std::string> lines = recorded("C: ");
  const std::string begin =
      "\x03"
      "00801 StartSession()\r\n00802 Home()\r\n";
  std::vector<std::string> out;
  for (std::size_t first = 0; first < lines.size(); first += 2) {
    std::string text = begin + "00803 ChangeTool(\"Probe1\")\r\n";
    text[0] = static_cast<char>(first % 12);
    for (std::size_t i = first; i < std::min(first + 8, lines.size()); ++i)
      text += lines[i] + "\r\n";
    out.push_back(std::move(text));
  }
  return out;
}

TEST(IppFuzz, NoDamagedDialogueUpsetsTheServer) {
  const Mutation mutation(server_corpus(), words());
  for (unsigned seed = 0; seed < inputs(); ++seed) {
    const std::string problem = try_ipp_server(mutation.input(seed));
    ASSERT_EQ(problem, "") << "seed " << seed;
  }
}

TEST(IppFuzz, NoDamagedLineUpsetsTheGrammar) {
  std::vector<std::string> lines = recorded("C: ");
  for (std::string& line : recorded("S: ")) lines.push_back(std::move(line));
  const Mutation mutation(lines, words());
  for (unsigned seed = 0; seed < inputs(); ++seed) {
    const std::string problem = try_ipp_grammar(mutation.input(seed));
    ASSERT_EQ(problem, "") << "seed " << seed;
  }
}

TEST(IppFuzz, TheUndamagedDialoguesAreAnswered) {
  for (const std::string& text : server_corpus()) EXPECT_EQ(try_ipp_server(text), "");
}

}  // namespace
}  // namespace rondure::fuzz
