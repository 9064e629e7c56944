#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "ipp_talk.h"

namespace rondure::cmm::ipp {
namespace {

struct Exchange {
  std::string client;
  std::vector<std::string> server;
};

std::vector<Exchange> recorded() {
  std::ifstream file(RONDURE_SOURCE_DIR "/tests/data/ipp_dme_dialogue/dialogue.txt");
  std::vector<Exchange> out;
  std::string line;
  while (std::getline(file, line)) {
    if (line.starts_with("C: ")) out.push_back({line.substr(3), {}});
    if (line.starts_with("S: ")) out.back().server.push_back(line.substr(3));
  }
  return out;
}

/// Without spaces, in lower case, and without the direction that the tool estimates.
std::string reduced(std::string text) {
  if (const std::size_t ijk = text.find("IJK("); ijk != std::string::npos) {
    text.erase(ijk, text.find(')', ijk) - ijk + 1);
  }
  std::string out;
  for (const char c : text) {
    if (c != ' ') out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return out;
}

/// Whether two lines say the same: numbers may differ by what the recorded machine scatters.
bool say_the_same(const std::string& a, const std::string& b) {
  const std::string left = reduced(a);
  const std::string right = reduced(b);
  const char* p = left.c_str();
  const char* q = right.c_str();
  const auto begins_number = [](const char* c) {
    return std::isdigit(static_cast<unsigned char>(*c)) != 0 ||
           (*c == '-' && std::isdigit(static_cast<unsigned char>(c[1])) != 0);
  };
  while (*p != '\0' && *q != '\0') {
    if (begins_number(p) && begins_number(q)) {
      char* p_end = nullptr;
      char* q_end = nullptr;
      if (std::abs(std::strtod(p, &p_end) - std::strtod(q, &q_end)) > 5e-4) return false;
      p = p_end;
      q = q_end;
    } else if (*p++ != *q++) {
      return false;
    }
  }
  return *p == *q;
}

Talk talk_of(const Profile& profile) {
  ServerOptions options;
  options.speed = 1.0;
  options.controller.defaults = {{100.0, 20.0, 10.0}, 10.0, 10.0, 10.0};
  options.controller.profile = profile;
  return Talk(options);
}

/// The answers to a recorded command. The abort comes while the machine moves; everything before it
/// has come to its end.
std::vector<std::string> said(Talk& talk, const std::string& command) {
  std::vector<std::string> out = talk.say(command);
  if (command == "00900 GoTo(X(300))") return out;
  for (std::string& line : talk.wait(command == "00901 GoTo(Y(200))" ? 1.0 : 10.0)) {
    out.push_back(std::move(line));
  }
  return out;
}

bool is_of_daemon(const std::string& line) { return line.starts_with("E0100 #"); }

TEST(IppDialogue, TheRecordedProfileAnswersTheRecordedClientAsTheRecordedServerDid) {
  Talk talk = talk_of(as_recorded());
  const std::vector<Exchange> all = recorded();
  ASSERT_EQ(all.size(), 45U);
  std::size_t moves_reported = 0;
  double last_x_mm = -1.0;
  double start_x_mm = 0.0;
  for (const Exchange& exchange : all) {
    SCOPED_TRACE(exchange.client);
    if (exchange.client == "00900 GoTo(X(300))") start_x_mm = talk.machine().position.x();
    std::vector<std::string> answers = said(talk, exchange.client);
    for (const std::string& line : answers) {
      if (!is_of_daemon(line)) continue;
      const auto report = parse_response(line);
      ASSERT_TRUE(report.has_value());
      const double x_mm = single_number(*find_call(report->data, "X")).value_or(-1.0);
      EXPECT_GT(x_mm, last_x_mm);
      last_x_mm = x_mm;
      ++moves_reported;
    }
    std::erase_if(answers, is_of_daemon);
    std::vector<std::string> wanted = exchange.server;
    std::erase_if(wanted, is_of_daemon);
    ASSERT_EQ(answers.size(), wanted.size()) << ::testing::PrintToString(answers);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      EXPECT_TRUE(say_the_same(answers[i], wanted[i])) << answers[i] << "\n" << wanted[i];
    }
  }
  EXPECT_GE(moves_reported, 2U);
  EXPECT_NEAR(talk.machine().position.x(), start_x_mm + 50.0, 1.0);  // 50 mm/s for a second
  EXPECT_NEAR(talk.machine().position.x(), last_x_mm, 20.0);
}

TEST(IppDialogue, BySpecificationItDiffersOnlyWhereThePageSaysSo) {
  Talk talk = talk_of({});
  std::vector<std::string> differing;
  for (const Exchange& exchange : recorded()) {
    const std::vector<std::string> answers = said(talk, exchange.client);
    if (!std::equal(answers.begin(), answers.end(), exchange.server.begin(), exchange.server.end(),
                    say_the_same)) {
      differing.push_back(exchange.client.substr(0, exchange.client.find('(')));
    }
  }
  // Class as a name; translation subtracted; values in the order asked for; bare numbers of
  // AlignPart; times of the daemon; the pending command of an abort is answered; daemons survive
  // it.
  EXPECT_EQ(differing,
            (std::vector<std::string>{"00003 GetMachineClass", "00015 Get", "00021 PtMeas",
                                      "00022 Get", "00026 ScanOnCircle", "00027 AlignPart",
                                      "00901 GoTo", "E0101 AbortE", "00904 StopDaemon"}));
}

TEST(IppDialogue, EachProfileRefusesWhatItsServerDoes) {
  struct Refused {
    const char* command;
    std::vector<int> errors;  ///< As specified, as recorded, touches only.
  };
  const std::vector<Refused> table = {
      {"StartSession()", {8, 507, 507}},
      {"GoTo(X(1),R(90))", {502, 502, 502}},
      {"SetCoordSystem(Sideways)", {505, 502, 502}},
      {"GetProp(Tool.Reach())", {510, 502, 502}},
      {"GetProp(Simulation.NextTouch())", {0, 502, 502}},
      {"SetProp(Simulation.NextTouch(7))", {0, 502, 502}},
      {"GetProp(Part.Temperature())", {0, 502, 502}},
      {"OnPtMeasReport(X(),Y(),Z(),ER(),Part.Temperature())", {0, 502, 502}},
      {"GetSupportedCommands()", {0, 507, 507}},
      {"GetDMEVersion()", {0, 0, 507}},
      {"SetProp(Tool.PtMeasPar.Retract(-1))", {0, 0, 504}},
      {"GetProp(Tool.ScanPar.Speed())", {0, 0, 502}},
      {"OnScanReport(X(),Y(),Z())", {0, 0, 507}},
      {"ScanOnCircle(0,0,10,20,0,10,0,0,1,90,0,30)", {0, 0, 507}},
  };
  for (std::size_t i = 0; i < profiles().size(); ++i) {
    SCOPED_TRACE(profiles()[i].name);
    ServerOptions options;
    options.controller.profile = profiles()[i];
    Talk talk(options);
    EXPECT_EQ(talk.error("IsHomed()"), 8);
    talk.begin();
    for (const auto& [command, errors] : table)
      EXPECT_EQ(talk.error(command), errors[i]) << command;
    talk.say("00001 FooBar()");
    EXPECT_EQ(talk.say("00002 EndSession()").at(1),
              "00002 ! Error(2, 0514, \"00002 EndSession()\", \"Use ClearAllErrors to continue\")");
  }
}

TEST(IppDialogue, TheRecordedProfileWritesFiveDecimalsAndSortsTheValues) {
  Talk talk = talk_of(as_recorded());
  talk.begin();
  EXPECT_EQ(talk.ask("GetProp(Tool.PtMeasPar.Approach())"), "# Tool.PtMeasPar.Approach(10.00000)");
  EXPECT_EQ(talk.ask("IsHomed()"), "# IsHomed(1)");
  EXPECT_EQ(talk.ask("Get(Z(),R(),X(),Y())"), "# R(0.00000), X(0.00000), Y(0.00000), Z(0.00000)");
  EXPECT_EQ(talk.ask("AlignPart(1,0,0,0,1,0,0,0,1,0,0,1,0,0)"),
            "# (0.00000,1.00000,0.00000), (0.00000,0.00000,1.00000)");
}

TEST(IppDialogue, TheComparisonSeesDifferences) {
  EXPECT_TRUE(say_the_same("00001 # X(1.0001), Y(2)", "00001 # X(1.00010),Y( 2.0 )"));
  EXPECT_FALSE(say_the_same("00001 # X(1.001)", "00001 # X(1.002)"));
  EXPECT_FALSE(say_the_same("00001 # X(1)", "00001 # Y(1)"));
  EXPECT_FALSE(say_the_same("00001 # X(1)", "00001 # X(1), Y(2)"));
  EXPECT_FALSE(say_the_same("00001 &", "00001 %"));
}

}  // namespace
}  // namespace rondure::cmm::ipp
