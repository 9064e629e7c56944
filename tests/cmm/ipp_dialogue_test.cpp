#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "ipp_talk.h"
#include "tests/cmm/seen_server.h"

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

ServerOptions as_recorded() {
  ServerOptions options;
  options.speed = 1.0;
  options.controller.defaults = {{100.0, 20.0, 10.0}, 10.0, 10.0, 10.0};
  options.controller.tip_radius_mm = IdealMachine::kTipRadius_mm;
  return options;
}

/// The double of the recorded server, an ideal machine and a clock.
class SeenTalk {
 public:
  SeenTalk() : server_(backend_, as_recorded_profile()) {}

  std::vector<std::string> say(const std::string& line) {
    server_.receive({line}, now_s_);
    return server_.take_output();
  }
  std::vector<std::string> wait(double seconds) {
    std::vector<std::string> out;
    for (const double until_s = now_s_ + seconds; now_s_ < until_s;) {
      now_s_ += 0.01;
      server_.advance(now_s_);
      for (std::string& line : server_.take_output()) out.push_back(std::move(line));
    }
    return out;
  }
  [[nodiscard]] Eigen::Vector3d position() { return backend_.machine().position_W_mm(); }

 private:
  static SeenProfile as_recorded_profile() {
    SeenProfile profile;
    profile.speed = 1.0;
    profile.tip_radius_mm = IdealMachine::kTipRadius_mm;
    profile.defaults = as_recorded().controller.defaults;
    return profile;
  }

  IdealBackend backend_;
  SeenServer server_;
  double now_s_ = 0.0;
};

TEST(IppDialogue, TheDoubleAnswersTheRecordedClientAsTheRecordedServerDid) {
  SeenTalk talk;
  const std::vector<Exchange> all = recorded();
  ASSERT_EQ(all.size(), 45U);
  std::size_t moves_reported = 0;
  double last_x_mm = -1.0;
  double start_x_mm = 0.0;
  for (const Exchange& exchange : all) {
    SCOPED_TRACE(exchange.client);
    std::vector<std::string> said = talk.say(exchange.client);
    // The abort comes while the machine moves; everything before it has come to its end.
    const bool moves = exchange.client == "00900 GoTo(X(300))";
    if (moves) start_x_mm = talk.position().x();
    const bool is_watched = exchange.client == "00901 GoTo(Y(200))";
    if (!moves) {
      for (std::string& line : talk.wait(is_watched ? 1.0 : 10.0)) said.push_back(std::move(line));
    }
    std::vector<std::string> answers;
    for (const std::string& line : said) {
      if (!line.starts_with("E0100 #")) {
        answers.push_back(line);
        continue;
      }
      const auto report = parse_response(line);
      ASSERT_TRUE(report.has_value());
      const double x_mm = single_number(*find_call(report->data, "X")).value_or(-1.0);
      EXPECT_GT(x_mm, last_x_mm);
      last_x_mm = x_mm;
      ++moves_reported;
    }
    std::vector<std::string> wanted;
    for (const std::string& line : exchange.server) {
      if (!line.starts_with("E0100 #")) wanted.push_back(line);
    }
    ASSERT_EQ(answers.size(), wanted.size()) << ::testing::PrintToString(answers);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      EXPECT_TRUE(say_the_same(answers[i], wanted[i])) << answers[i] << "\n" << wanted[i];
    }
  }
  EXPECT_GE(moves_reported, 2U);
  EXPECT_NEAR(talk.position().x(), start_x_mm + 50.0, 1.0);  // 50 mm/s for a second
  EXPECT_NEAR(talk.position().x(), last_x_mm, 20.0);
}

TEST(IppDialogue, BySpecificationItDiffersOnlyWhereThePageSaysSo) {
  Talk talk(as_recorded());
  std::vector<std::string> differing;
  for (const Exchange& exchange : recorded()) {
    std::vector<std::string> said = talk.say(exchange.client);
    const bool moves = exchange.client == "00900 GoTo(X(300))";
    if (!moves) {
      for (std::string& line : talk.wait(exchange.client == "00901 GoTo(Y(200))" ? 1.0 : 10.0)) {
        said.push_back(std::move(line));
      }
    }
    bool same = said.size() == exchange.server.size();
    for (std::size_t i = 0; same && i < said.size(); ++i) {
      same = say_the_same(said[i], exchange.server[i]);
    }
    if (!same) differing.push_back(exchange.client.substr(0, exchange.client.find('(')));
  }
  // Class as a name; translation subtracted; values in the order asked for; bare numbers of
  // AlignPart; times of the daemon; the pending command of an abort is answered; daemons survive
  // it.
  EXPECT_EQ(differing,
            (std::vector<std::string>{"00003 GetMachineClass", "00015 Get", "00021 PtMeas",
                                      "00022 Get", "00026 ScanOnCircle", "00027 AlignPart",
                                      "00901 GoTo", "E0101 AbortE", "00904 StopDaemon"}));
}

TEST(IppDialogue, TheDoubleRefusesWhatTheRecordedServerRefused) {
  SeenTalk talk;
  const auto refused = [&talk](const std::string& command) {
    talk.wait(10.0);
    int number = 0;
    for (const std::string& line : talk.say("09998 " + command)) {
      const auto response = parse_response(line);
      if (response && response->kind == Response::Kind::kError) number = response->error.number;
    }
    talk.say("09997 ClearAllErrors()");
    return number;
  };
  EXPECT_EQ(refused("IsHomed()"), 8);
  for (const char* command : {"StartSession()", "Home()", "ChangeTool(\"Probe1\")"}) {
    EXPECT_EQ(refused(command), 0) << command;
  }
  EXPECT_EQ(refused("StartSession()"), 507);
  EXPECT_EQ(refused("GoTo(X(1),R(90))"), 502);
  EXPECT_EQ(refused("GetProp(Simulation.NextTouch())"), 502);
  EXPECT_EQ(refused("GetProp(Part.Temperature())"), 502);
  EXPECT_EQ(refused("OnPtMeasReport(X(),Y(),Z(),ER(),Part.Temperature())"), 502);
  EXPECT_EQ(refused("GetSupportedCommands()"), 507);
  talk.say("00001 FooBar()");
  EXPECT_EQ(talk.say("00002 EndSession()").at(1),
            "00002 ! Error(2, 0514, \"00002 EndSession()\", \"Use ClearAllErrors to continue\")");
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
