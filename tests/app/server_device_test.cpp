// `rondure devices ippdme`: what a server can, told without moving anything.

#include <chrono>
#include <functional>
#include <sstream>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/cutting_proxy.h"
#include "tests/app/files.h"
#include "tests/app/program.h"
#include "wire/tcp_line.h"

namespace rondure::app::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

/// The virtual machine of the example over the wire.
class Cmm {
 public:
  explicit Cmm(const std::string& profile = "as-specified")
      : port_(free_port()),
        program_({"simulate-cmm", example("02_spool_over_ippdme.json"), "--port",
                  std::to_string(port_), "--speed", "inf", "--wire-log", folder_ / "wire.log",
                  "--profile", profile}) {
    EXPECT_TRUE(wait_for_port(port_));
  }
  [[nodiscard]] std::string place() const { return fmt::format("127.0.0.1:{}", port_); }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] std::string log() const { return read(folder_ / "wire.log"); }

 private:
  Scratch folder_;
  std::uint16_t port_;
  Program program_;
};

void expect_eighty_columns(const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80U) << line;
}

TEST(ServerDevice, SaysWhatTheServerCanInEightyColumnsAndMovesNothing) {
  const Cmm cmm;
  const Outcome told = rondure({"devices", "ippdme", cmm.place()});
  ASSERT_EQ(told.status, 0) << told.err;
  EXPECT_THAT(told.out, HasSubstr("I++ DME 1.4, CartCMMWithRotaryTable (rondure simulate-cmm)\n"));
  EXPECT_THAT(told.out, HasSubstr("homed               no: a run homes it"));
  EXPECT_THAT(told.out, HasSubstr("rotary axes         yes (AlignPart)\n"));
  EXPECT_THAT(told.out, HasSubstr("PtMeasPar.Retract"));
  EXPECT_THAT(told.out, HasSubstr("\"driver\": \"ippdme\""));
  expect_eighty_columns(told.out);
  const std::string log = cmm.log();
  EXPECT_THAT(log, HasSubstr("EndSession()"));
  for (const char* moving :
       {" Home(", "GoTo(", "PtMeas(", "ScanOnCircle(", "AlignPart(", "ChangeTool(", "SetTool(",
        "SetProp(", "SetCoordSystem(", "SetCsyTransformation(", "EnableUser("}) {
    EXPECT_THAT(log, Not(HasSubstr(moving)));
  }
}

TEST(ServerDevice, SaysWhatAServerThatOnlyTouchesLacksInEightyColumns) {
  const Cmm cmm("touches-only");
  const Outcome told = rondure({"devices", "ippdme", cmm.place()});
  ASSERT_EQ(told.status, 0) << told.err;
  EXPECT_THAT(told.out, HasSubstr("I++ DME of unknown version, CartCMMWithRotaryTable\n"));
  EXPECT_THAT(told.out, HasSubstr("rotary axes         yes (AlignPart)"));
  EXPECT_THAT(told.out, HasSubstr("part temperature    results are void unless the plan says"));
  EXPECT_THAT(told.out, HasSubstr("circle scans        a plan with sampling.method \"scan\""));
  EXPECT_THAT(told.out, HasSubstr("GetDMEVersion(): error 0507"));
  EXPECT_THAT(told.out, HasSubstr("\"retract\": \"by-distance\""));
  expect_eighty_columns(told.out);
}

TEST(ServerDevice, ItsKeysArePartOfAPlanThatRuns) {
  const Cmm cmm;
  const Outcome told = rondure({"devices", "ippdme", cmm.place(), "--json"});
  ASSERT_EQ(told.status, 0) << told.err;
  const json found = json::parse(told.out);
  EXPECT_EQ(found["version"], "1.4");
  EXPECT_EQ(found["homed"], false);
  EXPECT_EQ(found["machine"]["port"], cmm.port());
  json plan = json::parse(read(example("02_spool_over_ippdme.json")));
  const json park = plan["machine"]["park_mm"];
  plan["machine"] = found["machine"];
  plan["machine"]["park_mm"] = park;
  const Scratch folder;
  write(folder / "plan.json", plan.dump());
  const Outcome ran =
      rondure({"run", folder / "plan.json", "--out", folder / "run", "--archive", "none"});
  EXPECT_EQ(ran.status, 0) << ran.err;
  const Outcome homed = rondure({"devices", "ippdme", cmm.place(), "--json"});
  EXPECT_EQ(json::parse(homed.out)["homed"], true);
  EXPECT_EQ(json::parse(homed.out)["tool"], "T1");
}

/// A server that gives each line an answer, until the client goes.
class Answering {
 public:
  using Answer = std::function<std::string(const std::string& tag, const std::string& method)>;

  explicit Answering(Answer answer)
      : listener_(*wire::TcpListener::open("127.0.0.1", 0)),
        thread_([this, answer = std::move(answer)] {
          auto client = listener_.accept(std::chrono::milliseconds(10'000));
          if (!client || !*client) return;
          while (const auto line = (*client)->read_line(std::chrono::milliseconds(2'000))) {
            if (!*line) return;
            const std::string& text = (*line)->text;
            const std::string said = answer(text.substr(0, 5), text.substr(6));
            if (!said.empty() && !(*client)->write_line(said)) return;
          }
        }) {}
  ~Answering() { thread_.join(); }
  [[nodiscard]] std::string place() const { return fmt::format("127.0.0.1:{}", listener_.port()); }

 private:
  wire::TcpListener listener_;
  std::thread thread_;
};

TEST(ServerDevice, SaysWhatAPoorServerLacksAndWhichKeysFollow) {
  // Touches, and nothing else: the names of a bare server, in its own order.
  const Answering server([](const std::string& tag, const std::string& method) {
    const auto done = [&](const std::string& data) {
      return fmt::format("{} &\r\n{}{} %", tag, data.empty() ? "" : tag + " # " + data + "\r\n",
                         tag);
    };
    if (method == "IsHomed()") return done("IsHomed(1)");
    if (method == "EnumTools()") return done("\"Probe1\"");
    if (method == "GetProp(Tool.Name())") return done("\"NoTool\"");
    if (method == "Get(X(), Y(), Z())") return done("Z(3.0), Y(2.0), X(1.0)");
    if (method == "GetProp(Tool.PtMeasPar.Approach())") return done("Tool.PtMeasPar.Approach(2)");
    if (method == "GetProp(Tool.PtMeasPar.Approach.Max())") {
      return done("Tool.PtMeasPar.Approach.Max(2.5)");
    }
    for (const char* known : {"StartSession()", "EndSession()", "ClearAllErrors()",
                              "GetErrStatusE()", "OnPtMeasReport(X(), Y(), Z())"}) {
      if (method == known) return done("");
    }
    return fmt::format("{0} &\r\n{0} ! Error(3, 0507, \"{0} x\", \"Illegal command\")\r\n{0} %",
                       tag);
  });
  const Outcome told = rondure({"devices", "ippdme", server.place(), "--json"});
  ASSERT_EQ(told.status, 0) << told.err;
  const json found = json::parse(told.out);
  std::string lacks;
  for (const json& lack : found["lacks"]) lacks += lack["what"].get<std::string>() + "\n";
  for (const char* what : {"GetDMEVersion", "rotary axes", "tool in the head", "negative Retract",
                           "part temperature", "time of a point", "circle scans"}) {
    EXPECT_THAT(lacks, HasSubstr(what));
  }
  EXPECT_EQ(found["tip_mm"], json({1.0, 2.0, 3.0}));
  EXPECT_EQ(found["machine"]["tool"], "Probe1");
  EXPECT_EQ(found["machine"]["retract"], "by-distance");
  EXPECT_EQ(found["machine"]["approach_mm"], 2.5);
  EXPECT_FALSE(found["machine"].contains("scan_speed_mm_s"));
}

TEST(ServerDevice, SaysTheFaultOfTheMachineAndAsksNothingElse) {
  const Answering server([](const std::string& tag, const std::string& method) {
    if (method == "GetErrStatusE()")
      return fmt::format("{0} &\r\n{0} # ErrStatus(1)\r\n{0} %", tag);
    if (method == "GetXtdErrStatus()") {
      return fmt::format("{0} &\r\n{0} # \"0500 Emergency stop\"\r\n{0} %", tag);
    }
    EXPECT_THAT(method, ::testing::AnyOf("StartSession()", "EndSession()"));
    return fmt::format("{0} &\r\n{0} %", tag);
  });
  const Outcome told = rondure({"devices", "ippdme", server.place()});
  EXPECT_EQ(told.status, 0) << told.err;
  EXPECT_THAT(told.out, HasSubstr("0500 Emergency stop"));
  EXPECT_THAT(told.out, Not(HasSubstr("\"machine\"")));
}

TEST(ServerDevice, SaysWhyThereIsNoAnswer) {
  const Outcome nobody = rondure({"devices", "ippdme", fmt::format("127.0.0.1:{}", free_port())});
  EXPECT_EQ(nobody.status, 2);
  EXPECT_THAT(nobody.err, HasSubstr("check that the server runs and listens on port"));
  const Answering web([](const std::string&, const std::string&) {
    return std::string("HTTP/1.1 400 Bad Request");
  });
  const Outcome other = rondure({"devices", "ippdme", web.place()});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("does not speak I++ DME"));
  const Answering mute([](const std::string&, const std::string&) { return std::string(); });
  const Outcome silent = rondure({"devices", "ippdme", mute.place(), "--limit", "0.4"});
  EXPECT_EQ(silent.status, 2);
  EXPECT_THAT(silent.err, HasSubstr("did not acknowledge StartSession() within 0.4 s"));
  const Answering in_session([](const std::string& tag, const std::string&) {
    return fmt::format("{0} &\r\n{0} ! Error(3, 0508, \"x\", \"Bad context\")\r\n{0} %", tag);
  });
  EXPECT_THAT(rondure({"devices", "ippdme", in_session.place()}).err,
              HasSubstr("begins no session"));
  for (const char* place : {"", ":1294", "host:0", "host:x", "[::1", "host:70000"}) {
    EXPECT_EQ(rondure({"devices", "ippdme", place}).status, 2) << place;
  }
}

TEST(ServerDevice, SaysThatTheServerHasAnotherClientAndLeavesItAlone) {
  const Cmm cmm;
  auto first = wire::connect_tcp("127.0.0.1", cmm.port());
  ASSERT_TRUE(first);
  const auto heard = [&](int lines) {
    std::string out;
    for (int i = 0; i < lines; ++i) {
      const auto line = (*first)->read_line(std::chrono::seconds(60));
      if (line && *line) out += (*line)->text + "|";
    }
    return out;
  };
  ASSERT_TRUE((*first)->write_line("00001 StartSession()"));
  EXPECT_EQ(heard(2), "00001 &|00001 %|");
  const Outcome busy = rondure({"devices", "ippdme", cmm.place()});
  EXPECT_EQ(busy.status, 2);
  EXPECT_THAT(busy.err, HasSubstr("this server has a client already"));
  ASSERT_TRUE((*first)->write_line("00002 IsHomed()"));
  EXPECT_EQ(heard(3), "00002 &|00002 # IsHomed(0)|00002 %|");
}

}  // namespace
}  // namespace rondure::app::testing
