#include <chrono>
#include <csignal>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>

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

std::string spool() { return RONDURE_SOURCE_DIR "/plans/examples/01_spool_simulated.json"; }

/// The program as a server, on a port that it chose.
class Serving {
 public:
  explicit Serving(const std::vector<std::string>& more = {}, const std::string& plan = spool())
      : program_(arguments(folder_, more, plan), surroundings(folder_)) {
    while (port_ == 0 && !program_.ended()) {
      const std::string text = read(folder_ / "out");
      const std::size_t at = text.find("listens at 127.0.0.1:");
      unsigned port = 0;
      if (at != std::string::npos) std::sscanf(text.c_str() + at, "listens at 127.0.0.1:%u", &port);
      port_ = static_cast<std::uint16_t>(port);
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }

  [[nodiscard]] std::unique_ptr<wire::LineTransport> connect() const {
    auto line = wire::connect_tcp("127.0.0.1", port_);
    return line ? std::move(*line) : nullptr;
  }
  [[nodiscard]] Program& program() { return program_; }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] std::string wire_log() const { return read(folder_ / "wire.log"); }

 private:
  static std::vector<std::string> arguments(const Scratch& folder,
                                            const std::vector<std::string>& more,
                                            const std::string& plan) {
    std::vector<std::string> out = {"simulate-cmm", plan,  "--port",     "0",
                                    "--speed",      "inf", "--wire-log", folder / "wire.log"};
    out.insert(out.end(), more.begin(), more.end());
    return out;
  }
  static Surroundings surroundings(const Scratch& folder) {
    Surroundings out;
    out.standard_output = folder / "out";
    return out;
  }

  Scratch folder_;
  Program program_;
  std::uint16_t port_ = 0;
};

std::string ask(wire::LineTransport& line, const std::string& command) {
  std::string out;
  EXPECT_TRUE(line.write_line(command));
  while (!out.ends_with("%|")) {
    const auto read = line.read_line(std::chrono::seconds(60));
    if (!read || !*read) break;
    out += (*read)->text + "|";
  }
  return out;
}

TEST(SimulateCmm, ServesTheVirtualCellUntilItIsStopped) {
  Serving serving;
  const auto client = serving.connect();
  ASSERT_NE(client, nullptr);
  EXPECT_EQ(ask(*client, "00001 StartSession()"), "00001 &|00001 %|");
  EXPECT_EQ(ask(*client, "00002 Home()"), "00002 &|00002 %|");
  EXPECT_EQ(ask(*client, "00003 ChangeTool(\"T1\")"), "00003 &|00003 %|");
  EXPECT_EQ(ask(*client, "00004 Get(X(),Y(),Z())"), "00004 &|00004 # X(0), Y(0), Z(500)|00004 %|");
  EXPECT_THAT(ask(*client, "00005 AlignPart(0,0,1,0,0,1,0,1,0,0,1,0,0,0)"),
              HasSubstr("# 0,0,1,0,1,0|"));
  serving.program().send(SIGINT);
  const Outcome outcome = serving.program().wait();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("is connected"));
  EXPECT_THAT(outcome.err, HasSubstr("rondure: ended"));
  EXPECT_THAT(serving.wire_log(), HasSubstr("<- C: 00004 Get(X(),Y(),Z())"));
}

TEST(SimulateCmm, RefusesAPortInUseAPlanWithoutASimulationAndAStandstill) {
  auto taken = wire::TcpListener::open("127.0.0.1", 0);
  ASSERT_TRUE(taken.has_value());
  const std::string port = std::to_string(taken->port());
  const Outcome in_use = rondure({"simulate-cmm", spool(), "--port", port});
  EXPECT_EQ(in_use.status, 2);
  EXPECT_THAT(in_use.err, HasSubstr(port));
  const Outcome no_simulation =
      rondure({"simulate-cmm", RONDURE_SOURCE_DIR "/plans/examples/09_axle_points_file.json",
               "--port", "0"});
  EXPECT_EQ(no_simulation.status, 2);
  EXPECT_THAT(no_simulation.err, HasSubstr("no virtual machine to serve"));
  const Outcome no_log =
      rondure({"simulate-cmm", spool(), "--port", "0", "--wire-log", "/nowhere/x"});
  EXPECT_EQ(no_log.status, 2);
  EXPECT_THAT(no_log.err, HasSubstr("/nowhere/x: cannot be written"));
  for (const char* speed : {"0", "-1", "nan", "fast"}) {
    const Outcome standstill = rondure({"simulate-cmm", spool(), "--speed", speed});
    EXPECT_EQ(standstill.status, 2) << speed;
    EXPECT_THAT(standstill.err, HasSubstr("--speed")) << speed;
  }
  const Outcome no_profile = rondure({"simulate-cmm", spool(), "--profile", "as-dreamt"});
  EXPECT_EQ(no_profile.status, 2);
  EXPECT_THAT(no_profile.err, HasSubstr("--profile"));
}

/// The example over the wire, evaluated without trials and reported as JSON alone.
json light_plan() {
  json plan = json::parse(read(example("02_spool_over_ippdme.json")));
  plan.merge_patch(R"({"reports": {"formats": ["json"]}, "uncertainty": null,
                       "decision_rule": {"rule": "simple-acceptance"}})"_json);
  return plan;
}

/// A run over the wire, halted in the middle of its touches.
class HaltedRun {
 public:
  explicit HaltedRun(const Serving& serving) : run_(prepare(folder_, serving.port())) {
    while (!run_.ended() && serving.wire_log().find(" PtMeas(") == std::string::npos) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    run_.send(SIGSTOP);
  }

  [[nodiscard]] std::filesystem::path directory(const std::string& name) const {
    return folder_ / name;
  }
  [[nodiscard]] Outcome another(const std::string& name, bool resume = false) const {
    auto words = arguments(folder_, name);
    if (resume) words.emplace_back("--resume");
    return rondure(words);
  }
  [[nodiscard]] Outcome go_on() {
    run_.send(SIGCONT);
    return run_.wait();
  }

 private:
  static std::vector<std::string> arguments(const Scratch& folder, const std::string& name) {
    return {"run", folder / "plan.json", "--out", folder / name, "--archive", "none"};
  }
  static std::vector<std::string> prepare(const Scratch& folder, std::uint16_t port) {
    json plan = light_plan();
    plan["machine"]["port"] = port;
    plan["machine"]["answer_limit_s"] = 300;  // the clock of the halted run goes on
    plan["machine"]["motion_limit_s"] = 300;
    write(folder / "plan.json", plan.dump());
    return arguments(folder, "halted");
  }

  Scratch folder_;
  Program run_;
};

TEST(SimulateCmm, AClientThatWasHaltedForAMomentHoldsItsPlace) {
  const Serving serving;
  HaltedRun halted(serving);
  const Outcome other = halted.another("other");
  EXPECT_EQ(other.status, 3);
  EXPECT_THAT(other.err, HasSubstr("this server has a client already"));
  const Outcome went_on = halted.go_on();
  EXPECT_EQ(went_on.status, 0) << went_on.err;
}

TEST(SimulateCmm, AClientThatWasHaltedLosesItsPlaceAndGoesOnWhenItIsResumed) {
  const Serving serving({"--silence-limit", "0.2"});
  HaltedRun halted(serving);
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  const Outcome other = halted.another("other");
  EXPECT_EQ(other.status, 0) << other.err;
  const Outcome told = halted.go_on();
  EXPECT_EQ(told.status, 3);
  EXPECT_THAT(told.err, HasSubstr("another client takes its place"));
  const Outcome resumed = halted.another("halted", true);
  EXPECT_EQ(resumed.status, 0) << resumed.err;
  const auto one = journal_of(halted.directory("halted"));
  const auto two = journal_of(halted.directory("other"));
  ASSERT_EQ(one.touches.size(), two.touches.size());
  for (std::size_t i = 0; i < one.touches.size(); ++i) {
    EXPECT_EQ(one.touches[i].tip_mm, two.touches[i].tip_mm) << "touch " << i;
  }
}

/// Whole runs over a server that is not known as a simulation: no word of Simulation, values in
/// alphabetical order, surface points, five decimals, and the same part behind it.
class SimulateCmmProfile : public ::testing::Test {
 protected:
  static constexpr double kSame_um = 0.05;  // five decimals of a millimetre, and of directions

  /// The example with a part that is measured without scatter.
  static json quiet_plan(bool scanned) {
    json plan = light_plan();
    plan["simulation"]["probe"]["repeatability_um"] = 0;
    plan["simulation"]["fixture"]["repeatability_deg"] = 0;
    plan["environment"]["assumed_degC"] = plan["simulation"]["temperature_degC"];
    if (scanned) {
      plan["features"][0]["sampling"] = {
          {"method", "scan"}, {"layers", 4}, {"points_per_layer", 120}, {"margin_mm", 5}};
      plan["features"][0]["pose_search"]["repeats"] = 1;
    }
    return plan;
  }

  /// Serves the part; its scans are those of real servers.
  std::unique_ptr<Serving> served(const std::string& profile) const {
    json plan = quiet_plan(false);
    plan["simulation"]["machine"] = {
        {"scan_start_deg", 1}, {"scan_step_percent", 3}, {"scan_dropped_percent", 2}};
    write(folder_ / "served.json", plan.dump());
    return std::make_unique<Serving>(std::vector<std::string>{"--profile", profile},
                                     folder_ / "served.json");
  }

  /// Runs a plan over a port, or with the simulated drivers at port 0.
  Outcome run(json plan, std::uint16_t port, const std::string& name, bool resume = false) const {
    plan["machine"]["driver"] = plan["fixture"]["driver"] = port == 0 ? "simulated" : "ippdme";
    plan["machine"]["port"] = port == 0 ? 1294 : port;
    if (port != 0) plan.erase("simulation");  // the other side knows it
    write(folder_ / (name + ".json"), plan.dump());
    std::vector<std::string> words = {
        "run", folder_ / (name + ".json"), "--out", folder_ / name, "--archive", "none"};
    if (resume) words.emplace_back("--resume");
    return rondure(words);
  }

  double cylindricity_um(const std::string& name) const {
    return json::parse(read(folder_ / name / "report.json"))
        .at("/features/0/mz/deviation_um"_json_pointer);
  }

  Scratch folder_;
};

TEST_F(SimulateCmmProfile, GivesTheCylindricityOfTheSimulatedDriver) {
  struct Case {
    std::string profile;
    bool scanned;
    std::string retract;
  };
  const std::vector<Case> cases = {{"as-recorded", false, "to-approach"},
                                   {"as-recorded", true, "to-approach"},
                                   {"touches-only", false, "by-distance"}};
  for (const bool scanned : {false, true}) {
    const Outcome own = run(quiet_plan(scanned), 0, scanned ? "own-scans" : "own-touches");
    ASSERT_EQ(own.status, 0) << own.err;
  }
  for (const auto& [profile, scanned, retract] : cases) {
    const std::string name = profile + (scanned ? "-scans" : "-touches");
    SCOPED_TRACE(name);
    json plan = quiet_plan(scanned);
    plan["machine"]["retract"] = retract;
    const auto serving = served(profile);
    const Outcome ran = run(plan, serving->port(), name);
    ASSERT_EQ(ran.status, 0) << ran.err << ran.out;
    EXPECT_EQ(rondure({"verify", folder_ / name}).status, 0);
    EXPECT_FALSE(journal_of(folder_ / name).header.simulated);
    const double own_um = cylindricity_um(scanned ? "own-scans" : "own-touches");
    EXPECT_NEAR(cylindricity_um(name), own_um, kSame_um);
    std::printf("%s: CYLt %.3f um, %.3f um in one process\n", name.c_str(), cylindricity_um(name),
                own_um);
  }
}

TEST_F(SimulateCmmProfile, ARunThatWasCutGoesOnInANewSessionAndGivesTheSameCylindricity) {
  const auto serving = served("as-recorded");
  CuttingProxy proxy(serving->port());
  ASSERT_EQ(run(quiet_plan(false), proxy.port(), "whole").status, 0);
  const std::uint64_t bytes = proxy.take_count();
  for (const char* name : {"2", "3", "5"}) {  // cut at this part of the run
    proxy.cut_after(bytes / static_cast<std::uint64_t>(name[0] - '0'));
    const Outcome stopped = run(quiet_plan(false), proxy.port(), name);
    EXPECT_EQ(stopped.status, 3) << stopped.err;
    const Outcome ended = run(quiet_plan(false), proxy.port(), name, true);
    ASSERT_EQ(ended.status, 0) << ended.err;
    EXPECT_NEAR(cylindricity_um(name), cylindricity_um("whole"), kSame_um);
  }
}

}  // namespace
}  // namespace rondure::app::testing
