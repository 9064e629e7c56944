// Whole runs over the wire: `rondure simulate-cmm` in one process, `rondure run` in another.

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <sstream>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/cutting_proxy.h"
#include "tests/app/files.h"
#include "tests/app/on_terminal.h"
#include "tests/app/program.h"
#include "wire/tcp_line.h"

namespace rondure::app::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kPlan = "02_spool_over_ippdme.json";

/// An example plan without intervals, with a port and drivers of its own.
void write_wire_plan(const fs::path& file, std::uint16_t port, const char* driver = "ippdme",
                     const char* name = kPlan) {
  json plan = json::parse(read(example(name)));
  leave_out_intervals(plan);
  plan["machine"]["port"] = port;
  plan["machine"]["driver"] = driver;
  if (plan.contains("fixture")) plan["fixture"]["driver"] = driver;
  write(file, plan.dump(2));
}

/// `rondure simulate-cmm` at work.
class Simulator {
 public:
  /// @param speed  Simulated seconds in a second; "inf": motions take no time.
  explicit Simulator(std::uint16_t port = free_port(), const std::string& speed = "inf",
                     const char* plan = kPlan, const std::string& profile = "as-specified")
      : port_(port),
        program_({"simulate-cmm", example(plan), "--port", std::to_string(port), "--speed", speed,
                  "--profile", profile}) {
    EXPECT_TRUE(wait_for_port(port_));
  }
  ~Simulator() {
    if (killed_) return;
    program_.send(SIGTERM);
    (void)program_.wait();
  }

  [[nodiscard]] std::uint16_t port() const { return port_; }
  void kill() {
    program_.send(SIGKILL);
    (void)program_.wait();
    killed_ = true;
  }

 private:
  std::uint16_t port_;
  Program program_;
  bool killed_ = false;
};

/// What must not depend on how the machine is reached.
void expect_same_touches(const record::RunRecord& run, const record::RunRecord& other) {
  ASSERT_EQ(run.touches.size(), other.touches.size());
  for (std::size_t i = 0; i < run.touches.size(); ++i) {
    const record::Touch& a = run.touches[i];
    const record::Touch& b = other.touches[i];
    ASSERT_EQ(a.tip_mm, b.tip_mm) << "touch " << i;
    ASSERT_EQ(a.approach, b.approach) << "touch " << i;
    ASSERT_EQ(a.temperature_degC, b.temperature_degC) << "touch " << i;
    ASSERT_TRUE(a.purpose == b.purpose && a.pose == b.pose && a.layer == b.layer &&
                a.point == b.point && a.repeat == b.repeat)
        << "touch " << i;
  }
  ASSERT_EQ(run.poses.size(), other.poses.size());
  for (std::size_t i = 0; i < run.poses.size(); ++i) {
    ASSERT_EQ(run.poses[i].reached, other.poses[i].reached) << "pose " << i;
  }
}

/// What the client sent by a wire log, without times and tags.
std::vector<std::string> commands_in(const std::string& log) {
  const std::string sent = " -> C: ";
  const std::size_t tag = std::string_view("00001 ").size();
  std::vector<std::string> out;
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t at = line.find(sent);
    if (at != std::string::npos) out.push_back(line.substr(at + sent.size() + tag));
  }
  return out;
}

double cylt_um(const fs::path& run) {
  return json::parse(read(run / "report.json")).at("/features/0/mz/deviation_um"_json_pointer);
}

TEST(IppRun, TouchesOverTheWireAreThoseOfTheRunInOneProcess) {
  const Scratch folder;
  const Simulator simulator;
  write_wire_plan(folder / "wire.json", simulator.port());
  write_wire_plan(folder / "inside.json", simulator.port(), "simulated");
  const auto start = std::chrono::steady_clock::now();
  const Outcome wire = rondure({"run", folder / "wire.json", "--out", folder / "wire", "--archive",
                                "none", "--wire-log", folder / "wire.log"});
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  ASSERT_EQ(wire.status, 0) << wire.err << wire.out;
  const Outcome inside =
      rondure({"run", folder / "inside.json", "--out", folder / "inside", "--archive", "none"});
  ASSERT_EQ(inside.status, 0) << inside.err;
  const auto run = journal_of(folder / "wire");
  const auto other = journal_of(folder / "inside");
  expect_same_touches(run, other);
  for (std::size_t i = 0; i < run.touches.size(); ++i) {
    ASSERT_EQ(run.touches[i].time_s, other.touches[i].time_s) << "touch " << i;
  }
  EXPECT_EQ(cylt_um(folder / "wire"), cylt_um(folder / "inside"));
  EXPECT_TRUE(run.header.simulated);
  EXPECT_THAT(run.header.machine, HasSubstr("I++ DME 1.4"));
  EXPECT_EQ(rondure({"verify", folder / "wire"}).status, 0);
  const std::string log = read(folder / "wire.log");
  EXPECT_THAT(log, HasSubstr(" -> C: 00002 StartSession()\n"));
  EXPECT_THAT(log, HasSubstr(" <- S: 00002 %\n"));
  EXPECT_EQ(log.find(" ! Error("), std::string::npos) << "no error is provoked";
  std::printf("%zu touches over the wire, with reports and journal: %.3f ms a touch\n",
              run.touches.size(), 1e3 * took.count() / static_cast<double>(run.touches.size()));
}

constexpr const char* kFixed = "17_cmm_without_fixture.json";

/// Writes the example without a fixture for a simulator and for its client.
/// @param patch  Changes of both.
void write_fixed_plans(const Scratch& folder, std::uint16_t port, const json& patch) {
  json plan = json::parse(read(example(kFixed)));
  leave_out_intervals(plan);
  plan.merge_patch(patch);
  write(folder / "served.json", plan.dump(2));
  plan["machine"]["port"] = port;
  plan["machine"]["driver"] = "ippdme";
  write(folder / "wire.json", plan.dump(2));
}

std::ptrdiff_t count_of(const std::vector<std::string>& commands, std::string_view start) {
  return std::count_if(commands.begin(), commands.end(),
                       [&](const std::string& command) { return command.starts_with(start); });
}

TEST(IppRun, WithoutAFixtureNoPartIsTurned) {
  const Scratch folder;
  const Simulator simulator(free_port(), "inf", kFixed);
  write_wire_plan(folder / "wire.json", simulator.port(), "ippdme", kFixed);
  write_wire_plan(folder / "inside.json", simulator.port(), "simulated", kFixed);
  const Outcome wire = rondure({"run", folder / "wire.json", "--out", folder / "wire", "--archive",
                                "none", "--format", "json", "--wire-log", folder / "wire.log"});
  ASSERT_EQ(wire.status, 0) << wire.err << wire.out;
  const Outcome inside = rondure({"run", folder / "inside.json", "--out", folder / "inside",
                                  "--archive", "none", "--format", "json"});
  ASSERT_EQ(inside.status, 0) << inside.err << inside.out;
  const auto run = journal_of(folder / "wire");
  expect_same_touches(run, journal_of(folder / "inside"));
  EXPECT_THAT(run.header.machine, HasSubstr("machine CartCMM at"));
  const auto sent = commands_in(read(folder / "wire.log"));
  EXPECT_EQ(count_of(sent, "AlignPart"), 0);
  EXPECT_EQ(count_of(sent, "SetCoordSystem(PartCsy)"), 0);
}

TEST(IppRun, MeasuresInThePartSystemOfTheControl) {
  const Scratch folder;
  const std::uint16_t port = free_port();
  const json elsewhere = {{"base_offset_mm", {-30, 20, 15}}, {"base_rotation_deg", {0, 0, 9}}};
  write_fixed_plans(folder, port,
                    {{"part", {{"system", "control"}}}, {"simulation", {{"fixture", elsewhere}}}});
  const Simulator simulator(port, "inf", (folder / "served.json").c_str());
  const Outcome ran = rondure({"run", folder / "wire.json", "--out", folder / "run", "--archive",
                               "none", "--format", "json", "--wire-log", folder / "wire.log"});
  ASSERT_EQ(ran.status, 0) << ran.err << ran.out;
  const auto sent = commands_in(read(folder / "wire.log"));
  EXPECT_EQ(count_of(sent, "AlignPart"), 0);
  EXPECT_EQ(count_of(sent, "SetCoordSystem(PartCsy)"), 13);
  EXPECT_EQ(count_of(sent, "SetCoordSystem(MachineCsy)"), 14);
  EXPECT_EQ(journal_of(folder / "run").decisions.front().message.code,
            core::MessageCode::kFixtureBaseFound);
}

TEST(IppRun, APartThatIsNotInItsPlaceEndsTheRunAtItsFirstTouch) {
  const Scratch folder;
  const std::uint16_t port = free_port();
  write_fixed_plans(folder, port,
                    {{"simulation", {{"fixture", {{"base_offset_mm", {50, 0, 0}}}}}}});
  const Simulator simulator(port, "inf", (folder / "served.json").c_str());
  const Outcome ran = rondure({"run", folder / "wire.json", "--out", folder / "run", "--archive",
                               "none", "--format", "json", "--wire-log", folder / "wire.log"});
  EXPECT_EQ(ran.status, 3) << ran.out;
  EXPECT_THAT(ran.err, HasSubstr("the part is not within 3.5 mm of its place in the plan"));
  EXPECT_EQ(count_of(commands_in(read(folder / "wire.log")), "PtMeas"), 14)
      << "13 of the reference sphere, one of the part";
}

TEST(IppRun, JudgesTheTwentyCallOutsOfADrawingAsTheRunInOneProcess) {
  constexpr const char* kDrawing = "15_shaft_drawing.json";
  const Scratch folder;
  const Simulator simulator(free_port(), "inf", kDrawing);
  std::vector<json> judged;
  for (const char* driver : {"ippdme", "simulated"}) {
    const std::string name = driver;
    write_wire_plan(folder / (name + ".json"), simulator.port(), driver, kDrawing);
    const Outcome ran = rondure({"run", folder / (name + ".json"), "--out", folder / name,
                                 "--archive", "none", "--format", "json"});
    ASSERT_EQ(ran.status, 0) << ran.err << ran.out;
    judged.emplace_back(json::parse(read(folder / name / "report.json")).at("features"));
  }
  const auto wire = journal_of(folder / "ippdme");
  const auto inside = journal_of(folder / "simulated");
  ASSERT_EQ(wire.touches.size(), inside.touches.size());
  for (std::size_t i = 0; i < wire.touches.size(); ++i) {
    ASSERT_EQ(wire.touches[i].tip_mm, inside.touches[i].tip_mm) << "touch " << i;
  }
  int conform = 0;
  for (std::size_t f = 0; f < judged[1].size(); ++f) {
    const json& asked = judged[1][f].at("characteristics");
    for (std::size_t c = 0; c < asked.size(); ++c) {
      SCOPED_TRACE(asked[c].at("id"));
      const json& over_wire = judged[0][f].at("characteristics")[c];
      conform += over_wire.at("verdict") == "conforms" ? 1 : 0;
      EXPECT_EQ(over_wire.at("verdict"), asked[c].at("verdict"));
      EXPECT_EQ(over_wire.at("finding"), asked[c].at("finding"));
    }
  }
  EXPECT_EQ(conform, 20);
}

TEST(IppRun, CalibratesAFixtureAsTheRunInOneProcess) {
  for (const char* name : {"03_calibrate_fixture.json", "03_inspect_calibrated.json",
                           "18_calibrate_and_inspect.json"}) {
    SCOPED_TRACE(name);
    const Scratch folder;
    fs::copy(example("03_calibration"), folder / "03_calibration");
    fs::copy(example("18_stand.stl"), folder / "18_stand.stl");
    const Simulator simulator(free_port(), "inf", name);
    std::vector<json> reports;
    for (const char* driver : {"ippdme", "simulated"}) {
      const std::string plan = std::string(driver) + ".json";
      write_wire_plan(folder / plan, simulator.port(), driver, name);
      const Outcome ran = rondure({"run", folder / plan, "--out", folder / driver, "--archive",
                                   "none", "--format", "json"});
      ASSERT_EQ(ran.status, 0) << ran.err << ran.out;
      EXPECT_EQ(rondure({"verify", folder / driver}).status, 0);
      reports.emplace_back(json::parse(read(folder / driver / "report.json")));
    }
    const auto wire = journal_of(folder / "ippdme");
    const auto inside = journal_of(folder / "simulated");
    expect_same_touches(wire, inside);
    for (std::size_t i = 0; i < wire.touches.size(); ++i) {
      ASSERT_EQ(wire.touches[i].time_s, inside.touches[i].time_s) << "touch " << i;
    }
    for (std::size_t f = 0; f < wire.features.size(); ++f) {
      json& alone = reports[1]["features"][f]["characteristics"];
      for (json& asked : alone) EXPECT_EQ(asked.erase("simulation"), 1U) << "a served run has none";
      EXPECT_EQ(reports[0]["features"][f]["characteristics"], alone);
    }
  }
}

/// A server that does not say it is simulated stands for a real machine: people change what it
/// holds, here by another server at its place.
TEST(IppRun, APersonChangesBallsForThePartAndTheRunGoesOnThere) {
  const char* const name = "18_calibrate_and_inspect.json";
  const Scratch folder;
  fs::copy(example("18_stand.stl"), folder / "18_stand.stl");
  const std::uint16_t port = free_port();
  write_wire_plan(folder / "plan.json", port, "ippdme", name);
  json plan = json::parse(read(folder / "plan.json"));
  plan["environment"]["assumed_degC"] = 20.1;  // this server measures none
  write(folder / "plan.json", plan.dump());
  json part = json::parse(read(example(name)));
  part["features"].erase(0);
  part["fixture"].erase("calibration");
  write(folder / "part.json", part.dump());
  // With the plan, beside which its STL file is.
  const std::vector<std::string> resumed = {"run",          folder / "plan.json", "--out",
                                            folder / "run", "--resume",           "--archive",
                                            "none",         "--format",           "json"};
  {
    const Simulator balls(port, "inf", name, "as-recorded");
    const Outcome alone = rondure({"run", folder / "plan.json", "--out", folder / "run",
                                   "--archive", "none", "--format", "json"});
    EXPECT_EQ(alone.status, 3) << alone.out;
    EXPECT_THAT(alone.err, AllOf(HasSubstr("nobody can answer"),
                                 HasSubstr("clamp the part \"SP-50-80\" as the plan says"),
                                 HasSubstr("to resume it after its last touch: rondure run '" +
                                           (folder / "plan.json").string() + "' --out ")));
    EXPECT_EQ(journal_of(folder / "run").decisions.back().message.code,
              core::MessageCode::kCalibrationTaken);
    OnTerminal asked(resumed);
    ASSERT_TRUE(asked.wait_for("clamp the part")) << asked.shown();
    asked.type("q\n");
    EXPECT_EQ(asked.finish(), 3) << asked.shown();
    OnTerminal answered(resumed);
    ASSERT_TRUE(answered.wait_for("clamp the part")) << answered.shown();
    answered.type("\n");
    EXPECT_EQ(answered.finish(), 3) << "the part is not there yet: " << answered.shown();
  }
  const Simulator changed(port, "inf", (folder / "part.json").c_str(), "as-recorded");
  const Outcome ended = rondure(resumed);
  EXPECT_EQ(ended.status, 0) << ended.err << ended.out;
  const auto run = journal_of(folder / "run");
  const auto change = std::find_if(run.decisions.begin(), run.decisions.end(), [](const auto& d) {
    return d.message.code == core::MessageCode::kClampingChanged;
  });
  ASSERT_NE(change, run.decisions.end());
  EXPECT_THAT(change->message.text(2), ::testing::EndsWith("Z"));
  EXPECT_EQ(rondure({"verify", folder / "run"}).status, 0);
}

TEST(IppRun, AServedWorldMeasuresTheNextPartAsTheFirst) {
  const Scratch folder;
  const Simulator simulator;
  write_wire_plan(folder / "plan.json", simulator.port());
  for (const char* name : {"first", "second"}) {
    const Outcome ran =
        rondure({"run", folder / "plan.json", "--out", folder / name, "--archive", "none"});
    ASSERT_EQ(ran.status, 0) << ran.err;
  }
  expect_same_touches(journal_of(folder / "first"), journal_of(folder / "second"));
}

TEST(IppRun, ACutConnectionStopsCleanlyAndTheResumedRunEndsTheSame) {
  const Scratch folder;
  const Simulator simulator;
  CuttingProxy proxy(simulator.port());
  write_wire_plan(folder / "plan.json", proxy.port());
  const auto arguments = [&](const std::string& name) {
    return std::vector<std::string>{
        "run",  folder / "plan.json", "--out", folder / name, "--archive",
        "none", "--format",           "json"};
  };
  ASSERT_EQ(rondure(arguments("whole")).status, 0);
  const auto whole = journal_of(folder / "whole");
  const std::uint64_t bytes = proxy.take_count();
  const int cuts = std::getenv("RONDURE_FULL") != nullptr ? 60 : 3;
  std::mt19937_64 random(1294);
  int resumed = 0;
  for (int i = 0; i < cuts; ++i) {
    const std::uint64_t cut = 1 + random() % (bytes - 1);
    SCOPED_TRACE(cut);
    const std::string name = "run" + std::to_string(i);
    proxy.cut_after(cut);
    const Outcome stopped = rondure(arguments(name));
    // Behind the last touch the connection is not needed any more.
    ASSERT_THAT(stopped.status, AnyOf(0, 3)) << stopped.err;
    if (stopped.status == 3) {
      EXPECT_THAT(stopped.err, HasSubstr("[machine]"));
      auto again = arguments(name);
      again.emplace_back("--resume");
      const Outcome ended = rondure(again);
      ASSERT_EQ(ended.status, 0) << ended.err;
      ++resumed;
    }
    expect_same_touches(journal_of(folder / name), whole);
    EXPECT_EQ(cylt_um(folder / name), cylt_um(folder / "whole"));
    fs::remove_all(folder / name);
  }
  EXPECT_GE(resumed, cuts - 1 - cuts / 20);
  std::printf("%d cuts within %llu bytes: %d runs resumed, all with the same touches and result\n",
              cuts, static_cast<unsigned long long>(bytes), resumed);
}

TEST(IppRun, GoesOnWithAServerThatWasStartedAgain) {
  const Scratch folder;
  const std::uint16_t port = free_port();
  write_wire_plan(folder / "plan.json", port);
  const std::vector<std::string> arguments = {"run",          folder / "plan.json", "--out",
                                              folder / "run", "--archive",          "none"};
  {
    Simulator simulator(port);
    Program run(arguments);
    std::error_code absent;
    while (!run.ended() &&
           !(fs::file_size(folder / "run" / "journal.db-wal", absent) > 150'000 && !absent)) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    simulator.kill();
    const Outcome lost = run.wait();
    ASSERT_EQ(lost.status, 3) << lost.err;
    EXPECT_THAT(lost.err, HasSubstr("to resume it after its last touch"));
  }
  const Outcome nobody = rondure({"run", folder / "run", "--resume", "--archive", "none"});
  EXPECT_EQ(nobody.status, 3);
  EXPECT_THAT(nobody.err, HasSubstr("check that the server runs"));
  const Simulator again(port);
  const Outcome ended = rondure({"run", folder / "run", "--resume", "--archive", "none"});
  EXPECT_EQ(ended.status, 0) << ended.err;
}

TEST(IppRun, CtrlCStopsTheMachineAtOnceAndNothingMovesAfterwards) {
  const Scratch folder;
  const Simulator simulator(free_port(), "0.01");  // the first move takes 300 s
  write_wire_plan(folder / "plan.json", simulator.port());
  Program run({"run", folder / "plan.json", "--out", folder / "run", "--archive", "none",
               "--wire-log", folder / "wire.log"});
  while (!run.ended() && read(folder / "wire.log").find(" GoTo(") == std::string::npos) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const auto start = std::chrono::steady_clock::now();
  run.send(SIGINT);
  const Outcome stopped = run.wait();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(200));
  EXPECT_EQ(stopped.status, 3);
  EXPECT_THAT(stopped.err, HasSubstr("[stopped]"));
  EXPECT_THAT(stopped.err, HasSubstr("to resume it after its last touch"));
  const std::string log = read(folder / "wire.log");
  const std::size_t abort = log.find(" AbortE()");
  ASSERT_NE(abort, std::string::npos)
      << log.substr(log.size() - std::min<std::size_t>(log.size(), 500));
  // Of the server's lines one may still name the motion: the report that it was aborted.
  EXPECT_THAT(commands_in(log.substr(log.rfind('\n', abort) + 1)),
              ElementsAre("AbortE()", "ClearAllErrors()", "Get(X(), Y(), Z())", "EndSession()"));
}

TEST(IppRun, SaysWhichPointTheServerMeansWhereThePlanSaysTheOther) {
  const Scratch folder;
  const Simulator simulator;
  write_wire_plan(folder / "plan.json", simulator.port());
  replace_in(folder / "plan.json", "\"approach_mm\"", "\"point\": \"center\", \"approach_mm\"");
  const Outcome refused =
      rondure({"run", folder / "plan.json", "--out", folder / "run", "--archive", "none"});
  EXPECT_EQ(refused.status, 3);
  EXPECT_THAT(refused.err, HasSubstr("set \"point\": \"surface\" under machine"));
  EXPECT_TRUE(journal_of(folder / "run").touches.empty());
}

TEST(IppRun, SaysThatNobodyServesTheMachine) {
  const Scratch folder;
  write_wire_plan(folder / "plan.json", free_port());
  const Outcome refused = rondure({"run", folder / "plan.json", "--out", folder / "run"});
  EXPECT_EQ(refused.status, 3);
  EXPECT_THAT(refused.err, HasSubstr("no connection to 127.0.0.1:"));
  EXPECT_FALSE(fs::exists(folder / "run"));
}

/// A server that answers the first line with something, and then only listens until the client has
/// gone.
class StrangeServer {
 public:
  explicit StrangeServer(std::string answer)
      : listener_(*wire::TcpListener::open("127.0.0.1", 0)), thread_([this, answer] {
          auto client = listener_.accept(std::chrono::milliseconds(10'000));
          if (!client || !*client) return;
          (void)(*client)->read_line(std::chrono::milliseconds(5'000));
          if (!answer.empty()) (void)(*client)->write_line(answer);
          while ((*client)->read_line(std::chrono::milliseconds(1'000))) continue;
        }) {}
  ~StrangeServer() { thread_.join(); }
  [[nodiscard]] std::uint16_t port() const { return listener_.port(); }

 private:
  wire::TcpListener listener_;
  std::thread thread_;
};

TEST(IppRun, SaysWhatAStrangeServerSaid) {
  struct Case {
    std::string answer;
    std::string message;
    double limit_s = 20.0;  ///< Short where the client is to wait in vain.
  };
  const std::vector<Case> cases = {
      {"HTTP/1.1 400 Bad Request", "HTTP/1.1 400 Bad Request"},
      {"00001 &\r\n00001 ! Error(3, 0500, \"EndSession()\", \"Emergency stop\")\r\n00001 %",
       "opening a session: the machine says error 0500, severity 3: Emergency stop"},
      {"00001 &\r\n00001 ! Error(3, 2504, \"EndSession()\", \"Collision\")\r\n00001 %",
       "opening a session: the machine says error 2504, severity 3: Collision"},
      {"00001 &\r\n00001 ! Error(2, 0514, \"EndSession()\", \"Use ClearAllErrors\")\r\n00001 %",
       "did not acknowledge ClearAllErrors() within 0.3 s; is another client connected to it?; "
       "the last line from there: \"00001 %\"; before that the machine said error 0514, severity "
       "2: Use ClearAllErrors",
       0.3},
      {"00001 ! Error(3, 05", "the last line from there: \"00001 ! Error(3, 05\"", 0.3},
      {std::string(100'000'000, 'x'), "a line of more than 1048576 bytes"},
      {"", "did not acknowledge EndSession() within 0.3 s", 0.3},
  };
  for (const auto& [answer, message, limit_s] : cases) {
    SCOPED_TRACE(answer.substr(0, 40));
    const Scratch folder;
    const StrangeServer server(answer);
    write_wire_plan(folder / "plan.json", server.port());
    replace_in(folder / "plan.json", "\"approach_mm\"",
               fmt::format("\"answer_limit_s\": {}, \"approach_mm\"", limit_s));
    const Outcome refused = rondure({"run", folder / "plan.json", "--out", folder / "run"});
    EXPECT_EQ(refused.status, 3);
    EXPECT_THAT(refused.err, HasSubstr(message));
  }
}

}  // namespace
}  // namespace rondure::app::testing
