// What servers do differently, each once, against the client: the machine behind the script stands
// where it is sent.

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cmm/ipp/grammar.h"
#include "cmm/ipp_client/client.h"
#include "core/noise.h"
#include "core/units.h"
#include "tests/cmm/scripted_server.h"

namespace rondure::cmm {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using Lines = std::vector<std::string>;
using Eigen::Vector3d;

constexpr const char* kNoEnd = "no end";  ///< In place of an answer: & and nothing more.

/// A server that answers as the specification says, but for what a test overrides: an answer by the
/// beginning of the command, without tags.
class Controller {
 public:
  std::vector<std::pair<std::string, Lines>> overrides;
  std::vector<std::string> heard;  ///< All commands, without tags.
  ScriptedServer* line = nullptr;  ///< Of the last connection.
  std::string stands = "X(0), Y(0), Z(500)";
  int connections = 0;

  IppMachine::Connect connect() {
    return [this]() -> core::Result<std::unique_ptr<wire::LineTransport>> {
      ++connections;
      auto out = std::make_unique<ScriptedServer>(
          [this](const std::string& tag, const std::string& method) {
            return answer(tag, method);
          });
      line = out.get();
      return out;
    };
  }

  core::Result<std::unique_ptr<IppMachine>> open(IppMachineOptions options = {}) {
    options.answer_limit = options.motion_limit = std::chrono::milliseconds(250);
    return IppMachine::open(connect(), options);
  }
  /// Open, homed, and nothing heard yet.
  std::unique_ptr<IppMachine> homed(const IppMachineOptions& options = {}) {
    auto machine = open(options);
    if (!machine) {
      ADD_FAILURE() << machine.error().what;
      return nullptr;
    }
    if (auto home = (*machine)->home(); !home) ADD_FAILURE() << home.error().what;
    heard.clear();
    return std::move(*machine);
  }
  void override_with(std::string beginning, Lines lines) {
    overrides.insert(overrides.begin(), {std::move(beginning), std::move(lines)});
  }

 private:
  Lines answer(const std::string& tag, const std::string& method) {
    heard.push_back(method);
    if (method.starts_with("GoTo(")) stands = method.substr(5, method.size() - 6);
    Lines out = {tag + " &"};
    const auto found = std::find_if(overrides.begin(), overrides.end(), [&](const auto& entry) {
      return method.starts_with(entry.first);
    });
    for (const std::string& text : found != overrides.end() ? found->second : usual(method)) {
      if (text == kNoEnd) return out;
      out.push_back(tag + " " + text);
    }
    out.push_back(tag + " %");
    return out;
  }
  Lines usual(const std::string& method) {
    if (method == "GetDMEVersion()") return {"# DMEVersion(\"1.5\")"};
    if (method == "GetMachineClass()") return {"# GetMachineClass(CartCMMWithRotaryTable)"};
    if (method == "GetErrStatusE()") return {"# ErrStatus(0)"};
    if (method == "IsHomed()") return {"# IsHomed(1)"};
    if (method == "EnumTools()") return {"# \"NoTool\"", "# \"RefTool\"", "# \"Probe1\""};
    if (method == "GetProp(Tool.Name())") return {"# Tool.Name(\"Probe1\")"};
    if (method.starts_with("GetProp(Part")) return {"# Part.Temperature(20.5)"};
    if (method.starts_with("GetProp(")) {
      return {"# " + method.substr(8, method.find('(', 8) - 8) +
              (method.find(".Max(") != std::string::npos ? "(500)" : "(1)")};
    }
    if (method.starts_with("OnPtMeasReport") && method.find("Time") != std::string::npos) {
      return {"! Error(3, 0505, \"OnPtMeasReport\", \"Argument not recognized\")"};
    }
    if (method.starts_with("Get(")) return {"# " + stands};
    if (method.starts_with("PtMeas(")) return {"# X(27), Y(0), Z(10), ER(2)"};
    return {};
  }
};

TouchCommand touch_from_x() { return {5, {27.0, 0.0, 10.0}, -Vector3d::UnitX(), 3.0, 4.0}; }

TEST(IppClientTraps, OpensAFreshSessionInTheFrameOfTheMachineAndMovesNothing) {
  Controller server;
  const auto machine = server.open();
  ASSERT_TRUE(machine) << machine.error().what;
  const auto begun = server.heard;
  ASSERT_GT(begun.size(), 2U);
  EXPECT_EQ(begun[0], "EndSession()");
  EXPECT_EQ(begun[1], "StartSession()");
  EXPECT_THAT(begun, Contains("SetCoordSystem(MachineCsy)"));
  for (const char* never : {"SetCsyTransformation", "GoTo", "Home", "ChangeTool"}) {
    EXPECT_THAT(begun, Not(Contains(StartsWith(never))));
  }
  EXPECT_THAT((*machine)->capabilities().tools, ElementsAre("RefTool", "Probe1"));
  EXPECT_THAT((*machine)->description(),
              HasSubstr("I++ DME 1.5 machine CartCMMWithRotaryTable at script, tool Probe1"));
}

TEST(IppClientTraps, ReadsThePartSystemAndSaysEverythingElseInThatOfTheMachine) {
  Controller server;
  const auto machine = server.homed();
  ASSERT_TRUE(machine);
  server.stands = "X(1), Y(2), Z(3)";
  const auto tip = machine->tip_in_part_system_mm();
  ASSERT_TRUE(tip) << tip.error().what;
  EXPECT_EQ(*tip, Vector3d(1.0, 2.0, 3.0));
  EXPECT_THAT(server.heard, ElementsAre("SetCoordSystem(PartCsy)", "Get(X(), Y(), Z())",
                                        "SetCoordSystem(MachineCsy)"));
  EXPECT_EQ(machine->position_W_mm(), Vector3d(0.0, 0.0, 500.0)) << "it has not moved";
}

TEST(IppClientTraps, StaysInTheFrameOfTheMachineWhereTheControlHasNoPartSystem) {
  Controller server;
  const auto machine = server.homed();
  ASSERT_TRUE(machine);
  server.override_with("SetCoordSystem(PartCsy)",
                       {"! Error(2, 0506, \"SetCoordSystem\", \"Argument not supported\")"});
  const auto tip = machine->tip_in_part_system_mm();
  ASSERT_FALSE(tip);
  EXPECT_THAT(tip.error().what, HasSubstr("choosing the coordinate system PartCsy"));
  EXPECT_EQ(server.heard.back(), "SetCoordSystem(MachineCsy)");
  EXPECT_TRUE(machine->move_to({0.0, 0.0, 400.0}));
}

TEST(IppClientTraps, MovesNoMoreWhereTheFrameOfTheMachineDoesNotComeBack) {
  Controller server;
  const auto machine = server.homed();
  ASSERT_TRUE(machine);
  server.override_with("SetCoordSystem(MachineCsy)",
                       {"! Error(2, 0506, \"SetCoordSystem\", \"Argument not supported\")"});
  EXPECT_FALSE(machine->tip_in_part_system_mm());
  server.heard.clear();
  const auto moved = machine->move_to({0.0, 0.0, 400.0});
  ASSERT_FALSE(moved);
  EXPECT_EQ(moved.error().code, core::Code::kMachine);
  EXPECT_THAT(server.heard, Not(Contains(StartsWith("GoTo"))));
}

TEST(IppClientTraps, ClearsErrorsWhereEndSessionIsRefusedInTheErrorState) {
  Controller server;
  server.override_with("EndSession",
                       {"! Error(2, 0514, \"EndSession()\", \"Use ClearAllErrors to continue\")"});
  EXPECT_TRUE(server.open());
  EXPECT_THAT(Lines(server.heard.begin(), server.heard.begin() + 4),
              ElementsAre("EndSession()", "ClearAllErrors()", "EndSession()", "StartSession()"));
}

TEST(IppClientTraps, LeavesAFaultThatAnswersTheFirstCommandToAPerson) {
  Controller server;
  server.override_with("EndSession", {"! Error(3, 0500, \"EndSession()\", \"Emergency stop\")"});
  const auto machine = server.open();
  ASSERT_FALSE(machine);
  EXPECT_EQ(machine.error().code, core::Code::kMachine);
  EXPECT_THAT(machine.error().what,
              HasSubstr("the machine says error 0500, severity 3: Emergency"));
  EXPECT_THAT(server.heard, ElementsAre("EndSession()"));
}

TEST(IppClientTraps, SaysWhatTheMachineSaidBeforeItFellSilent) {
  Controller server;
  server.override_with("EndSession",
                       {"! Error(2, 0514, \"EndSession()\", \"Use ClearAllErrors to continue\")"});
  server.override_with("ClearAllErrors", {kNoEnd});
  const auto machine = server.open();
  ASSERT_FALSE(machine);
  EXPECT_THAT(machine.error().what, HasSubstr("did not finish ClearAllErrors() within 0.25 s"));
  EXPECT_THAT(machine.error().what, HasSubstr("before that the machine said error 0514"));
}

TEST(IppClientTraps, TakesAServerThatCannotTellItsVersion) {
  Controller server;
  server.override_with("GetDMEVersion",
                       {"! Error(3, 0501, \"GetDMEVersion()\", \"Unsupported command\")"});
  const auto machine = server.open();
  ASSERT_TRUE(machine);
  EXPECT_EQ((*machine)->identity().version, "before 1.4");
  EXPECT_THAT(server.heard, Contains("ClearAllErrors()"));
}

TEST(IppClientTraps, RefusesAnotherVersion) {
  Controller server;
  server.override_with("GetDMEVersion", {"# DMEVersion(\"7.0\")"});
  const auto machine = server.open();
  ASSERT_FALSE(machine);
  EXPECT_EQ(machine.error().code, core::Code::kMachine);
  EXPECT_THAT(machine.error().what, HasSubstr("I++ DME version \"7.0\""));
}

TEST(IppClientTraps, SaysWhatTheMachineReportsWhenItIsInItsErrorState) {
  Controller server;
  server.override_with("GetErrStatusE", {"# ErrStatus(1)"});
  server.override_with("GetXtdErrStatus", {"# IsHomed(0)", "# \"0500 Emergency stop\""});
  const auto machine = server.open();
  ASSERT_FALSE(machine);
  EXPECT_EQ(machine.error().code, core::Code::kMachine);
  EXPECT_THAT(machine.error().what, HasSubstr("IsHomed(0); \"0500 Emergency stop\""));
}

TEST(IppClientTraps, MatchesTheReportByNameAndPointsIjkOutOfThePart) {
  Controller server;
  server.override_with("PtMeas(", {"# ER(3.0), IJK(0,0,1), X(27.25), Y(0.5), Z(10.0)"});
  const auto machine = server.homed();
  ASSERT_TRUE(machine->move_to({30.0, 0.0, 10.0}));
  const auto reading = machine->touch(touch_from_x());
  ASSERT_TRUE(reading) << reading.error().what;
  EXPECT_EQ(reading->tip_W_mm, Vector3d(27.25, 0.5, 10.0));
  EXPECT_EQ(reading->tip_radius_mm, 3.0);
  EXPECT_EQ(reading->temperature_degC, 20.5);
  EXPECT_FALSE(reading->scale_temperature_degC) << "that of the part is another";
  EXPECT_EQ(machine->position_W_mm(), Vector3d(30.0, 0.0, 10.0));
  EXPECT_THAT(server.heard,
              ElementsAre("GoTo(X(30), Y(0), Z(10))", "SetProp(Tool.GoToPar.Speed(5))",
                          "SetProp(Tool.PtMeasPar.Approach(3), Tool.PtMeasPar.Search(4), "
                          "Tool.PtMeasPar.Retract(-1))",
                          "PtMeas(X(26), Y(0), Z(10), IJK(1,0,0))",
                          "SetProp(Tool.GoToPar.Speed(100))", "Get(X(), Y(), Z())"));
}

TEST(IppClientTraps, TheFirstTouchSuitsBothReadingsWhereTheTipCameStraightIn) {
  struct Case {
    ipp::NamedPoint meant;
    const char* distances;
    const char* point;
    const char* back;    ///< Where the tip stands after the touch.
    const char* advice;  ///< Of the failure; "": none.
  };
  const std::vector<Case> cases = {
      {ipp::NamedPoint::kSurface, "Approach(4), Tool.PtMeasPar.Search(4)", "PtMeas(X(26)", "X(31)",
       ""},
      {ipp::NamedPoint::kSurface, "Approach(4), Tool.PtMeasPar.Search(4)", "PtMeas(X(26)", "X(30)",
       "set \"point\": \"center\""},
      {ipp::NamedPoint::kCenter, "Approach(3), Tool.PtMeasPar.Search(5)", "PtMeas(X(27)", "X(30)",
       ""},
      {ipp::NamedPoint::kCenter, "Approach(3), Tool.PtMeasPar.Search(5)", "PtMeas(X(27)", "X(31)",
       "set \"point\": \"surface\""},
      {ipp::NamedPoint::kSurface, "Approach(4), Tool.PtMeasPar.Search(4)", "PtMeas(X(26)",
       "X(27.5)", "\"retract\": \"by-distance\""},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.back);
    Controller server;  // its tip has a radius of 1 mm
    IppMachineOptions options;
    options.point = c.meant;
    const auto machine = server.homed(options);
    ASSERT_TRUE(machine->move_to({40.0, 0.0, 10.0}));
    ASSERT_TRUE(machine->move_to({30.0, 0.0, 10.0}));
    server.override_with("Get(", {std::string("# ") + c.back + ", Y(0), Z(10)"});
    const auto reading = machine->touch(touch_from_x());
    EXPECT_THAT(server.heard, Contains(HasSubstr(c.distances)));
    EXPECT_THAT(server.heard, Contains(StartsWith(c.point)));
    ASSERT_EQ(reading.has_value(), *c.advice == '\0');
    if (!reading) {
      EXPECT_THAT(reading.error().what, HasSubstr(c.advice));
    }
    if (std::string_view(c.back) == "X(27.5)") continue;
    EXPECT_EQ(machine->position_W_mm(), Vector3d(30.0, 0.0, 10.0));
  }
}

TEST(IppClientTraps, GivesNoTemperatureThatTheServerDoesNotGive) {
  Controller server;
  server.override_with("GetProp(Part", {"! Error(3, 0510, \"GetProp\", \"Bad property\")"});
  const auto machine = server.homed();
  EXPECT_FALSE(machine->knows_temperature());
  EXPECT_THAT(machine->description(), HasSubstr("gives no part temperature"));
  ASSERT_TRUE(machine->move_to({30.0, 0.0, 10.0}));
  const auto reading = machine->touch(touch_from_x());
  ASSERT_TRUE(reading) << reading.error().what;
  EXPECT_FALSE(reading->temperature_degC);
  EXPECT_FALSE(reading->scale_temperature_degC);
}

TEST(IppClientTraps, GoesBackItselfWhereANegativeRetractIsRefused) {
  Controller server;
  IppMachineOptions options;
  options.returns_to_approach = false;
  const auto machine = server.homed(options);
  ASSERT_TRUE(machine->move_to({30.0, 0.0, 10.0}));
  server.override_with("PtMeas(", {"# X(27.1), Y(0), Z(10)"});
  ASSERT_TRUE(machine->touch(touch_from_x()));
  EXPECT_THAT(machine->description(), HasSubstr("which point its PtMeas means cannot be checked"));
  EXPECT_THAT(server.heard, Contains("SetProp(Tool.GoToPar.Speed(5))"));
  EXPECT_THAT(server.heard, Contains(HasSubstr("Retract(3)")));
  EXPECT_EQ(server.heard.back(), "GoTo(X(30), Y(0), Z(10))");
}

TEST(IppClientTraps, TakesBackAMissedTouchAndReturnsToItsStart) {
  Controller server;
  const auto machine = server.homed();
  ASSERT_TRUE(machine->move_to({30.0, 0.0, 10.0}));
  server.override_with("PtMeas(", {"! Error(2, 1006, PtMeas, \"Surface not found\")"});
  server.override_with("Get(", {"# Z(10), Y(0), X(23)"});  // the end of the search, any order
  server.heard.clear();
  const auto missed = machine->touch(touch_from_x());
  ASSERT_FALSE(missed);
  EXPECT_EQ(missed.error().code, core::Code::kNoTouch);
  EXPECT_THAT(missed.error().what, HasSubstr("Surface not found"));
  EXPECT_THAT(missed.error().what, HasSubstr("the plan says \"surface\" (machine.point)"));
  EXPECT_EQ(server.heard[3], "ClearAllErrors()");
  EXPECT_THAT(server.heard, Contains("GoTo(X(30), Y(0), Z(10))"));
  EXPECT_EQ(machine->position_W_mm(), Vector3d(30.0, 0.0, 10.0));
}

TEST(IppClientTraps, DoesNotTouchWhereTheDistancesOfTheTouchAreRefused) {
  Controller server;
  const auto machine = server.homed();
  ASSERT_TRUE(machine->move_to({30.0, 0.0, 10.0}));
  server.override_with("SetProp(Tool.PtMeasPar",
                       {"! Error(1, 0504, \"SetProp()\", \"Argument out of range\")"});
  server.heard.clear();
  const auto refused = machine->touch(touch_from_x());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Code::kOutOfRange);
  EXPECT_THAT(server.heard, Not(Contains(HasSubstr("PtMeas("))));
}

TEST(IppClientTraps, LeavesAnEmergencyStopToAPerson) {
  Controller server;
  const auto machine = server.homed();
  server.override_with("GoTo(", {"! Error(3, 500, \"GoTo\", \"Emergency stop\")"});
  const auto stopped = machine->move_to({30.0, 0.0, 10.0});
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, core::Code::kMachine);
  EXPECT_THAT(server.heard, Not(Contains("ClearAllErrors()")));
  EXPECT_THAT(machine->move_to({0.0, 0.0, 500.0}).error().what, HasSubstr("Emergency stop"));
  EXPECT_EQ(server.heard.size(), 1U) << "nothing more was sent";
  server.override_with("GoTo(", {});
  ASSERT_TRUE(machine->recover());
  EXPECT_TRUE(machine->move_to({30.0, 0.0, 10.0}));
}

TEST(IppClientTraps, TellsWhereACollisionLeftTheTipAndWaits) {
  Controller server;
  const auto machine = server.homed();
  server.override_with("GoTo(", {"! Error(3, 2504, \"GoTo\", \"Collision\")"});
  server.override_with("Get(", {"# X(12), Y(1), Z(20)"});
  const auto crash = machine->move_to({30.0, 0.0, 10.0});
  ASSERT_FALSE(crash);
  EXPECT_EQ(crash.error().code, core::Code::kCollision);
  EXPECT_EQ(machine->position_W_mm(), Vector3d(12, 1, 20));
  EXPECT_EQ(machine->move_to({0.0, 0.0, 500.0}).error().code, core::Code::kMachine);
}

TEST(IppClientTraps, SaysThatATargetIsOutOfTheVolume) {
  Controller server;
  const auto machine = server.homed();
  server.override_with("GoTo(", {"! Error(3, 2500, \"GoTo\", \"Machine limit encountered [Move Out "
                                 "Of Limits]\")"});
  const auto refused = machine->move_to({1e5, 0.0, 10.0});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Code::kUnreachable);
  EXPECT_THAT(refused.error().what, HasSubstr("Machine limit encountered"));
  EXPECT_THAT(server.heard, Contains("ClearAllErrors()"));
}

TEST(IppClientTraps, DoesNotMeasureWithADistanceThatWasClamped) {
  Controller server;
  const auto machine = server.homed();
  ASSERT_TRUE(machine->move_to({30.0, 0.0, 10.0}));
  server.override_with("SetProp(", {"! Error(1, 0504, \"SetProp\", \"Argument out of range\")"});
  const auto refused = machine->touch(touch_from_x());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Code::kOutOfRange);
  EXPECT_THAT(server.heard, Not(Contains(StartsWith("PtMeas"))));
}

TEST(IppClientTraps, SetsEverythingAgainAfterAToolChange) {
  Controller server;
  const auto machine = server.homed();
  ASSERT_TRUE(machine->move_to({30.0, 0.0, 10.0}));
  ASSERT_TRUE(machine->touch(touch_from_x()));
  server.heard.clear();
  ASSERT_TRUE(machine->touch(touch_from_x()));
  EXPECT_EQ(server.heard.size(), 1U) << "distances are known";
  server.override_with("GetProp(Tool.Name", {"# Tool.Name(\"RefTool\")"});
  server.override_with("Get(", {"# X(30), Y(0), Z(10)"});
  ASSERT_TRUE(machine->select_tool("RefTool"));
  server.heard.clear();
  ASSERT_TRUE(machine->touch(touch_from_x()));
  EXPECT_THAT(server.heard, Contains(StartsWith("SetProp(Tool.PtMeasPar.Approach")));
}

TEST(IppClientTraps, NamesTheToolsThereAre) {
  Controller server;
  const auto machine = server.homed();
  EXPECT_THAT(machine->select_tool("Nope").error().what, HasSubstr("RefTool, Probe1"));
  server.override_with("ChangeTool",
                       {"! Error(3, 1502, \"ChangeTool('RefTool')\", \"Tool not found\")"});
  const auto refused = machine->select_tool("RefTool");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Code::kMachine);
  EXPECT_THAT(refused.error().what, HasSubstr("Tool not found"));
  EXPECT_THAT(refused.error().what, HasSubstr("RefTool, Probe1"));
}

TEST(IppClientTraps, RefusesAToolWithAnotherTip) {
  Controller server;
  server.override_with("GetProp(Tool.AvrRadius", {"# Tool.AvrRadius(1.5)"});
  IppMachineOptions options;
  options.tip_radius_mm = 2.0;
  const auto machine = server.open(options);
  ASSERT_TRUE(machine);
  const auto refused = (*machine)->home();
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what,
              HasSubstr("radius of 1.5000 mm, the tip of the plan has 2.0000"));
}

TEST(IppClientTraps, SeesThatScanColumnsAreNotXyz) {
  // Recorded: with Q in the report the quality comes first; twelve numbers look like four points.
  Controller server;
  server.override_with("ScanOnCircle",
                       {"# 0.00000,19.91857,11.50002,10.00000,0.00000,11.49995,19.91861,10.00000,"
                        "0.00000,-0.00008,23.00000,10.00000"});
  const auto machine = server.homed();
  ScanCircleCommand scan;
  scan.center_W_mm = {0.0, 0.0, 10.0};
  scan.start_tip_W_mm = {23.0, 0.0, 10.0};
  scan.sweep_rad = 0.25 * core::kTwoPi;
  scan.points = 4;
  ASSERT_TRUE(machine->move_to({26.0, 0.0, 10.0}));
  const auto refused = machine->scan_circle(scan);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("the columns of the scan report are not X, Y, Z"));
  server.override_with("ScanOnCircle",
                       {"# 23,0,10, 21.25,8.8,10", "# 16.26,16.26,10,8.8,21.25,10"});
  ASSERT_TRUE(machine->recover());
  ASSERT_TRUE(machine->move_to({26.0, 0.0, 10.0}));
  server.override_with("Get(", {"# X(0), Y(26), Z(10)"});
  server.heard.clear();
  const auto scanned = machine->scan_circle(scan);
  ASSERT_TRUE(scanned) << scanned.error().what;
  EXPECT_EQ(scanned->size(), 4U);
  EXPECT_THAT(server.heard, Contains("ScanOnCircle(0,0,10,22,0,10,0,0,1,90,0,22.5)"));
}

TEST(IppClientTraps, AServerWithoutScanParametersTouchesAndSaysWhyItDoesNotScan) {
  const Lines refused = {"! Error(3, 0510, \"Prop\", \"Bad property\")"};
  for (const bool lists : {false, true}) {
    Controller server;
    server.override_with("GetProp(Tool.ScanPar", refused);
    server.override_with("SetProp(Tool.GoToPar.Speed(100), Tool.PtMeasPar.Speed(5), Tool.ScanPar",
                         refused);
    if (lists) {
      server.override_with("EnumAllProp(Tool())",
                           {"# \"Name\", \"String\"", "# \"PtMeasPar.Speed\", \"Number\""});
    }
    const auto opened = server.open();
    ASSERT_TRUE(opened) << opened.error().what;
    IppMachine& machine = **opened;
    EXPECT_FALSE(machine.capabilities().scans_circles);
    EXPECT_EQ(machine.capabilities().no_scans, "its tool has no Tool.ScanPar");
    const auto homed = machine.home();
    ASSERT_TRUE(homed) << homed.error().what;
    ASSERT_TRUE(machine.move_to({30.0, 0.0, 10.0}));
    EXPECT_TRUE(machine.touch(touch_from_x()));
    if (lists) {
      EXPECT_THAT(server.heard, Not(Contains(HasSubstr("Scan"))));
    }
  }
}

TEST(IppClientTraps, ANormalStartProvokesNoErrorOfAServerOfIssue14) {
  Controller server;
  const Lines refused = {"! Error(3, 0510, \"GetProp\", \"Bad property\")"};
  server.override_with("GetDMEVersion", {"# DMEVersion(\"1.4\")"});
  server.override_with(
      "EnumAllProp(Tool())",
      {"# \"Name\", \"String\"", "# \"Id\", \"String\"", "# \"AvrRadius\", \"Number\"",
       "# \"GoToPar.Speed\", \"Number\"", "# \"PtMeasPar.Speed\", \"Number\""});
  for (const char* unknown : {"GetProp(Simulation", "GetProp(Part", "GetProp(Tool.ScanPar",
                              "OnScanReport", "GetSupportedCommands"}) {
    server.override_with(unknown, refused);
  }
  server.override_with("GetProp(Tool.Id", {"# Tool.Id(\"4711\")"});
  const auto machine = server.open();
  ASSERT_TRUE(machine) << machine.error().what;
  ASSERT_TRUE((*machine)->home());
  EXPECT_THAT(server.heard, Not(Contains("ClearAllErrors()")));
  EXPECT_THAT(server.heard, Contains("OnPtMeasReport(X(), Y(), Z(), ER())"));
  EXPECT_FALSE((*machine)->is_simulated());
}

TEST(IppClientTraps, TakesAServerThatTellsNothingOfAToolBeforeOneIsTaken) {
  Controller server;
  for (const char* asked : {"GetProp(Tool", "EnumAllProp(Tool"}) {
    server.override_with(asked, {"! Error(3, 1503, \"GetProp\", \"Tool not defined\")"});
  }
  IppMachineOptions options;
  options.tool = "Probe1";
  const auto machine = server.open(options);
  ASSERT_TRUE(machine) << machine.error().what;
  server.overrides.clear();
  const auto homed = (*machine)->home();
  ASSERT_TRUE(homed) << homed.error().what;
  EXPECT_THAT(server.heard, Contains("ChangeTool(\"Probe1\")"));
  EXPECT_TRUE((*machine)->capabilities().scans_circles);
}

TEST(IppClientTraps, AToolThatIsNotThereIsNamedBeforeAnythingMoves) {
  Controller server;
  server.override_with("IsHomed", {"# IsHomed(0)"});
  IppMachineOptions options;
  options.tool = "Nope";
  const auto refused = server.open(options);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("no tool Nope; its tools: RefTool, Probe1"));
  EXPECT_THAT(server.heard, Contains("GetProp(Tool.Name())"));
  EXPECT_THAT(server.heard, Not(Contains("Home()")));
}

TEST(IppClientTraps, AnUnsolicitedFaultStopsWhateverIsAnswered) {
  Controller server;
  const auto machine = server.homed();
  ASSERT_TRUE(machine->move_to({30.0, 0.0, 10.0}));
  server.line->say("E0000 ! Error(9, 0503, \"\", \"Controller communications failure\")");
  const auto stopped = machine->touch(touch_from_x());
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, core::Code::kMachine);
  EXPECT_THAT(stopped.error().what, HasSubstr("error 0503, severity 9"));
  EXPECT_THAT(server.heard, Not(Contains(StartsWith("PtMeas("))));
  EXPECT_THAT(server.heard, Not(Contains("ClearAllErrors()")));
  server.heard.clear();
  EXPECT_FALSE(machine->move_to({0.0, 0.0, 500.0}));
  EXPECT_TRUE(server.heard.empty()) << "until a person has looked";
}

TEST(IppClientTraps, SendsNoNumberOfMoreThanSixteenCharactersOnRequest) {
  Controller server;
  IppMachineOptions options;
  options.numbers = ipp::NumberForm::kSixteenCharacters;
  const auto machine = server.homed(options);
  ASSERT_TRUE(machine->move_to({-130.1234567891, 0.0, 10.0}));
  const Vector3d outward = Vector3d(-1.0, -0.1, 0.3).normalized();
  const TouchCommand touch = {0, machine->position_W_mm() - 3.0 * outward, -outward, 3.0, 4.0};
  const Vector3d& tip = touch.expected_tip_W_mm;
  server.override_with(
      "PtMeas(", {fmt::format("# X({:.6f}), Y({:.6f}), Z({:.6f})", tip.x(), tip.y(), tip.z())});
  const auto reading = machine->touch(touch);
  ASSERT_TRUE(reading) << reading.error().what;
  for (const std::string& line : server.heard) {
    std::size_t length = 0;
    for (const char c : line) {
      length = ipp::is_digit(c) || c == '-' || c == '.' ? length + 1 : 0;
      ASSERT_LE(length, 16U) << line;
    }
  }
  EXPECT_THAT(server.heard, Contains(StartsWith("GoTo(X(-130.1234567891)")));
}

TEST(IppClientTraps, ReadsTheVectorsOfATableHoweverTheyAreWritten) {
  for (const char* form : {"# (0, 0.6, 0.8), (0, 0.8, -0.6)", "# 0,0.6,0.8,0,0.8,-0.6",
                           "# AlignPart((0,0.6,0.8),(0,0.8,-0.6))"}) {
    SCOPED_TRACE(form);
    Controller server;
    server.override_with("AlignPart", {form});
    const auto machine = server.homed();
    const auto reached = machine->align_part({{0, 0.59, 0.8}, {0, 0.8, -0.59}});
    ASSERT_TRUE(reached) << reached.error().what;
    EXPECT_EQ(reached->first_W, Vector3d(0, 0.6, 0.8));
    EXPECT_EQ(reached->second_W, Vector3d(0, 0.8, -0.6));
    EXPECT_EQ(server.heard.back(), "AlignPart(0,0,1,0,0.59,0.8,0,1,0,0,0.8,-0.59,0,0)");
  }
}

/// What the error of a stopped command says, and that nothing moves before a person has looked.
void expect_held(Controller& server, IppMachine& machine, const core::Error& error,
                 const std::string& says) {
  EXPECT_EQ(error.code, core::Code::kMachine);
  EXPECT_THAT(error.what, HasSubstr(says));
  EXPECT_THAT(error.what, HasSubstr("then resume"));
  server.heard.clear();
  EXPECT_FALSE(machine.move_to({30.0, 0.0, 100.0}));
  EXPECT_TRUE(server.heard.empty()) << server.heard.front();
}

TEST(IppClientTraps, StopsAtAnAnswerThatCannotBeTheContact) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"# X(1027), Y(0), Z(10), ER(2)",
       "1000.000 mm before the expected contact: the search went "
       "from 3.000 mm before it to 4.000 mm behind it"},
      {"# X(27), Y(2), Z(10), ER(2)", "2.000 mm beside the line of the search, at most 1 mm"},
      {"# X(22.5), Y(0), Z(10), ER(2)", "4.500 mm behind the expected contact"},
      {"# X(31), Y(0), Z(10), ER(2)", "4.000 mm before the expected contact"},
      {"# X(27), Y(0), Z(10), ER(2.2)", "(ER) as 2.2000 mm, it was 2.0000 mm up to here"},
      {"# X(27), Y(0), Z(10), ER(2), IJK(0,0,0)", "of length 0: no direction"},
      {"# X(27), Y(0), Z(10), ER(2), IJK(0,0,9)", "of length 9: no direction"},
  };
  for (const auto& [answer, says] : cases) {
    SCOPED_TRACE(answer);
    Controller server;
    IppMachineOptions options;
    options.tip_radius_mm = 2.0;
    server.override_with("GetProp(Tool.AvrRadius", {"# Tool.AvrRadius(2)"});
    const auto machine = server.homed(options);
    ASSERT_TRUE(machine->move_to({30.0, 0.0, 10.0}));
    server.override_with("PtMeas(", {answer});
    const auto refused = machine->touch(touch_from_x());
    ASSERT_FALSE(refused);
    expect_held(server, *machine, refused.error(), says);
  }
}

TEST(IppClientTraps, StopsAtTheAnswerOfTheTouchBefore) {
  Controller server;
  const auto machine = server.homed();
  ASSERT_TRUE(machine->move_to({30.0, 0.0, 10.0}));
  ASSERT_TRUE(machine->touch(touch_from_x()));
  ASSERT_TRUE(machine->touch(touch_from_x())) << "the same place may read the same digits";
  TouchCommand next = touch_from_x();
  next.expected_tip_W_mm.z() += 0.5;  // as near as the line of the search is checked
  ASSERT_TRUE(machine->move_to({30.0, 0.0, 10.5}));
  const auto stale = machine->touch(next);
  ASSERT_FALSE(stale);
  expect_held(server, *machine, stale.error(),
              "the answer of the touch before once more, which was 0.500 mm away");
}

TEST(IppClientTraps, StopsAtATemperatureThatNoRoomHas) {
  for (const char* kelvin : {"293.5", "68", "-273.15"}) {
    SCOPED_TRACE(kelvin);
    Controller server;
    server.override_with("GetProp(Part", {std::string("# Part.Temperature(") + kelvin + ")"});
    const auto machine = server.open();
    ASSERT_FALSE(machine);
    EXPECT_EQ(machine.error().code, core::Code::kMachine);
    EXPECT_THAT(machine.error().what, HasSubstr(std::string("gives Part.Temperature as ") + kelvin +
                                                " degC, outside 5..45 degC"));
  }
  for (const char* name : {"Part.Temperature", "Scale.Temperature"}) {
    Controller server;
    const auto machine = server.homed();
    ASSERT_TRUE(machine->move_to({30.0, 0.0, 10.0}));
    server.override_with("PtMeas(", {std::string("# X(27), Y(0), Z(10), ") + name + "(293.5)"});
    const auto refused = machine->touch(touch_from_x());
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().what, HasSubstr(std::string(name) + " as 293.5 degC"));
    EXPECT_TRUE(machine->move_to({30.0, 0.0, 100.0})) << "the tip stands where it shall";
  }
}

TEST(IppClientTraps, StopsWhereThePartWasNotTurnedAsAsked) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"# 0,0,0,0,1,0", "a direction has the length 0, not 1"},
      {"# 0,0,2,0,1,0", "a direction has the length 2, not 1"},
      {"# 0,0,1,0,0.8,0.6", "53.13 deg apart, not 90 deg"},
      {"# 0,-0.5,0.8660254,0,0.8660254,0.5", "30.00 deg off, at most 8 deg"},
      {"# 0,0,-1,0,1,0", "180.00 deg off"},
  };
  for (const auto& [answer, says] : cases) {
    SCOPED_TRACE(answer);
    Controller server;
    server.override_with("AlignPart", {answer});
    const auto machine = server.homed();
    const auto refused = machine->align_part({});
    ASSERT_FALSE(refused);
    expect_held(server, *machine, refused.error(), says);
  }
}

TEST(IppClientTraps, StopsWhereTheTipIsNotWhereItWent) {
  Controller server;
  const auto machine = server.open();
  ASSERT_TRUE(machine);
  server.override_with("Get(", {"# X(0), Y(0), Z(480)"});
  const auto refused = (*machine)->home();
  ASSERT_FALSE(refused);
  expect_held(server, **machine, refused.error(),
              "says that the tip stands at (0.000, 0.000, 480.000) mm, 20.000 mm away, at most 1 "
              "mm are possible");
}

/// A circle of 48 points about z at 10 mm height, radius 23 mm.
ScanCircleCommand circle_scan() {
  ScanCircleCommand scan;
  scan.center_W_mm = {0.0, 0.0, 10.0};
  scan.start_tip_W_mm = {23.0, 0.0, 10.0};
  scan.sweep_rad = core::kTwoPi;
  scan.points = 48;
  return scan;
}

/// A line of a scan: points at these angles.
template <class Place>
Lines scan_lines(const std::vector<double>& angles_deg, const Place& place) {
  std::string text;
  for (const double angle_deg : angles_deg) {
    const Vector3d p = place(angle_deg);
    text += fmt::format("{}{:.5f},{:.5f},{:.5f}", text.empty() ? "# " : ",", p.x(), p.y(), p.z());
  }
  return {text};
}

Vector3d on_circle(double angle_deg, double radius_mm = 23.0, double z_mm = 10.0) {
  const double angle_rad = angle_deg * core::kDegree;
  return {radius_mm * std::cos(angle_rad), radius_mm * std::sin(angle_rad), z_mm};
}

std::vector<double> angles(int count, double from_deg, double step_deg) {
  std::vector<double> out;
  for (int i = 0; i < count; ++i) out.push_back(from_deg + i * step_deg);
  return out;
}

core::Result<std::vector<TouchReading>> scan_answered(Controller& server, const Lines& lines,
                                                      std::unique_ptr<IppMachine>& machine) {
  machine = server.homed();
  EXPECT_TRUE(machine->move_to({26.0, 0.0, 10.0}));
  server.override_with("ScanOnCircle", lines);
  server.override_with("Get(", {"# X(26), Y(0), Z(10)"});
  return machine->scan_circle(circle_scan());
}

TEST(IppClientTraps, StopsAtPointsThatAreNotTheScanThatWasAsked) {
  const auto usual = [](double angle_deg) { return on_circle(angle_deg); };
  const auto even = angles(48, 0.0, 7.5);
  auto gap = even;
  gap.erase(gap.begin() + 20, gap.begin() + 24);
  auto back = even;
  std::swap(back[20], back[22]);
  const std::vector<std::pair<Lines, std::string>> cases = {
      {scan_lines(angles(5, 0.0, 72.0), usual),
       "gave 5 points, 48 were asked for and 38 to 97 are possible"},
      {scan_lines(even, [](double a) { return on_circle(a, a > 200.0 ? 27.0 : 23.0); }),
       "4.000 mm outside the circle of 23.000 mm radius"},
      {scan_lines(even, [](double a) { return on_circle(a, 23.0, a > 200.0 ? 12.0 : 10.0); }),
       "lies 2.000 mm off its plane, at most 1 mm"},
      {scan_lines(angles(48, 0.0, -7.5), usual), "352.5 deg the other way round"},
      {scan_lines(angles(48, 30.0, 7.5), usual), "begins 30.00 deg beside its start"},
      {scan_lines(angles(48, 0.0, 6.0), usual), "ends after 282.00 deg, 360.00 deg were asked for"},
      {scan_lines(gap, usual), "has a gap of 37.50 deg before point 21"},
      {scan_lines(back, usual), "goes back by"},
  };
  for (const auto& [lines, says] : cases) {
    SCOPED_TRACE(says);
    Controller server;
    std::unique_ptr<IppMachine> machine;
    const auto refused = scan_answered(server, lines, machine);
    ASSERT_FALSE(refused);
    expect_held(server, *machine, refused.error(), says);
  }
}

TEST(IppClientTraps, TakesTheScansOfHonestServers) {
  core::KeyedNoise random(20261122, {});
  const auto rough = [&](double angle_deg) {  // a rough part, held to some hundredths
    return on_circle(angle_deg, 23.0 + 2.0 * random.uniform() - 1.0, 10.0 + 0.1 * random.uniform());
  };
  std::vector<std::vector<double>> scans = {
      angles(48, 7.5, 7.5),  // recorded: one step late, the end included
      angles(49, 0.0, 7.5),  // both ends
      angles(48, 1.0, 7.5),
      angles(90, 0.0, 4.0),
  };
  for (int scan = 0; scan < 200; ++scan) {  // start within 1 deg, steps +-3 %, 2 % missing
    std::vector<double> some;
    double angle_deg = 2.0 * random.uniform() - 1.0;
    for (int i = 0; i < 48; ++i) {
      if (random.uniform() > 0.02) some.push_back(angle_deg);
      angle_deg += 7.5 * (1.0 + 0.06 * (random.uniform() - 0.5));
    }
    scans.push_back(some);
  }
  for (std::size_t i = 0; i < scans.size(); ++i) {
    SCOPED_TRACE(i);
    Controller server;
    std::unique_ptr<IppMachine> machine;
    const auto scanned = scan_answered(server, scan_lines(scans[i], rough), machine);
    ASSERT_TRUE(scanned) << scanned.error().what;
    EXPECT_EQ(scanned->size(), scans[i].size());
  }
}

TEST(IppClientTraps, SaysThatASecondRotaryAxisIsMissing) {
  Controller server;
  server.override_with("AlignPart", {"# (0, 1, 0)"});
  const auto machine = server.homed();
  const auto refused = machine->align_part({});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("it needs two rotary axes"));
}

TEST(IppClientTraps, StopsWithAbortClearsAndTellsWhereItStands) {
  Controller server;
  bool wish = false;
  IppMachineOptions options;
  options.stop_requested = [&] {
    return wish || (!server.heard.empty() && server.heard.back().starts_with("GoTo(X(30)"));
  };
  const auto machine = server.homed(options);
  server.override_with("GoTo(", {kNoEnd});
  server.override_with("Get(", {"# X(7), Y(8), Z(99)"});
  const auto stopped = machine->move_to({30.0, 0.0, 10.0});
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, core::Code::kStopped);
  EXPECT_THAT(stopped.error().what, HasSubstr("the tip stands at (7.000, 8.000, 99.000) mm"));
  EXPECT_THAT(server.heard, ElementsAre("GoTo(X(30), Y(0), Z(10))", "AbortE()", "ClearAllErrors()",
                                        "Get(X(), Y(), Z())"));
  server.heard.clear();
  EXPECT_EQ(machine->move_to({0.0, 0.0, 500.0}).error().code, core::Code::kStopped);
  EXPECT_TRUE(server.heard.empty());
  ASSERT_TRUE(machine->recover());
  server.heard.clear();
  wish = true;
  EXPECT_EQ(machine->move_to({0.0, 0.0, 500.0}).error().code, core::Code::kStopped);
  EXPECT_TRUE(server.heard.empty()) << "a motion that was not wanted any more did not begin";
}

TEST(IppClientTraps, NothingRetractsBehindAStop) {
  const std::vector<Lines> ends = {{kNoEnd},  // ended by AbortE
                                   {"! Error(2, 1006, PtMeas, \"Surface not found\")"},
                                   {"# X(27.1), Y(0), Z(10)"}};
  for (const Lines& end : ends) {
    SCOPED_TRACE(end.front());
    Controller server;
    IppMachineOptions options;
    options.returns_to_approach = false;  // a GoTo of its own leads back
    bool wish = false;
    options.stop_requested = [&] {
      wish = wish || (!server.heard.empty() && server.heard.back().starts_with("PtMeas("));
      return wish;
    };
    const auto machine = server.homed(options);
    ASSERT_TRUE(machine->move_to({30.0, 0.0, 10.0}));
    server.override_with("PtMeas(", end);
    const auto stopped = machine->touch(touch_from_x());
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().code, core::Code::kStopped) << stopped.error().what;
    const auto touch = std::find_if(server.heard.begin(), server.heard.end(),
                                    [](const auto& line) { return line.starts_with("PtMeas("); });
    EXPECT_THAT(Lines(touch + 1, server.heard.end()), Not(Contains(StartsWith("GoTo("))));
  }
}

TEST(IppClientTraps, ConnectsAgainWhenTheLineWasLost) {
  Controller server;
  const auto machine = server.homed();
  server.line->hang_up();
  server.line->close();
  const auto lost = machine->move_to({30.0, 0.0, 10.0});
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().code, core::Code::kMachine);
  EXPECT_THAT(machine->status()->fault, HasSubstr("the connection is lost"));
  server.heard.clear();
  ASSERT_TRUE(machine->recover());
  EXPECT_EQ(server.connections, 2);
  EXPECT_EQ(server.heard[0], "EndSession()");
  EXPECT_EQ(server.heard[1], "StartSession()");
  EXPECT_TRUE(machine->move_to({30.0, 0.0, 10.0}));
}

TEST(IppClientTraps, HomesOnlyAMachineThatIsNotHomed) {
  Controller server;
  server.override_with("IsHomed", {"# IsHomed(0)"});
  const auto machine = server.open();
  ASSERT_TRUE(machine);
  EXPECT_EQ((*machine)->move_to({0, 0, 0}).error().code, core::Code::kMachine);
  server.heard.clear();
  ASSERT_TRUE((*machine)->home());
  EXPECT_THAT(server.heard, Contains("Home()"));
  server.override_with("IsHomed", {"# IsHomed(1)"});
  server.heard.clear();
  ASSERT_TRUE((*machine)->home());
  EXPECT_THAT(server.heard, Not(Contains("Home()")));
}

}  // namespace
}  // namespace rondure::cmm
