#include "cmm/ipp_server/controller.h"
#include "cmm/ipp_server/server.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ipp_talk.h"

namespace rondure::cmm::ipp {
namespace {

using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

ServerOptions timed() {
  ServerOptions options;
  options.speed = 1.0;
  return options;
}

TEST(IppServer, AcceptsNothingBeforeTheSession) {
  Talk talk;
  EXPECT_THAT(talk.say("00001 GetDMEVersion()"),
              ElementsAre("00001 &",
                          "00001 ! Error(3, 0008, \"00001 GetDMEVersion()\", \"Protocol error\")",
                          "00001 %"));
  EXPECT_THAT(talk.say("00002 EndSession()"), ElementsAre("00002 &", "00002 %"));
  EXPECT_THAT(talk.say("00003 StartSession()"), ElementsAre("00003 &", "00003 %"));
  EXPECT_EQ(talk.ask("GetDMEVersion()"), "# DMEVersion(\"1.4\")");
  EXPECT_EQ(talk.error("StartSession()"), 8);
  EXPECT_EQ(talk.ask("EndSession()"), "");
  EXPECT_EQ(talk.error("IsHomed()"), 8);
}

TEST(IppServer, AnErrorOfSeverityTwoLetsOnlyThreeCommandsThrough) {
  Talk talk;
  talk.begin();
  EXPECT_THAT(talk.ask("FooBar()"), HasSubstr("0507"));
  EXPECT_THAT(talk.ask("Get(X())"), HasSubstr("0514"));
  EXPECT_THAT(talk.ask("Home()"), HasSubstr("0514"));
  EXPECT_THAT(talk.ask("EndSession()"), HasSubstr("0514"));
  EXPECT_THAT(talk.say("E0001 GetErrStatusE()"),
              ElementsAre("E0001 &", "E0001 # ErrStatus(1)", "E0001 %"));
  EXPECT_EQ(talk.ask("GetXtdErrStatus()"),
            "# IsHomed(1)|# IsUserEnabled(0)|# \"0507 there is no method FooBar\"");
  EXPECT_EQ(talk.ask("ClearAllErrors()"), "");
  EXPECT_EQ(talk.ask("Get(X())"), "# X(0)");
  EXPECT_THAT(talk.say("E0001 GetErrStatusE()"),
              ElementsAre("E0001 &", "E0001 # ErrStatus(0)", "E0001 %"));
}

TEST(IppServer, AnErrorClosesTheCommandsThatWait) {
  Talk talk(timed());
  talk.begin();
  talk.machine().nothing_there = true;
  EXPECT_THAT(talk.say("00010 GoTo(X(10))"), ElementsAre("00010 &"));
  EXPECT_THAT(talk.say("00011 PtMeas(X(20),IJK(1,0,0))"), ElementsAre("00011 &"));
  EXPECT_THAT(talk.say("00012 Get(X())"), ElementsAre("00012 &"));
  EXPECT_THAT(talk.wait(5.0),
              ElementsAre("00010 %", StartsWith("00011 ! Error(2, 1006,"), "00011 %",
                          StartsWith("00012 ! Error(2, 0006,"), "00012 %"));
}

TEST(IppServer, AMotionTakesItsTimeAndResultsComeInOrder) {
  Talk talk(timed());
  talk.begin();
  EXPECT_THAT(talk.say("00010 GoTo(X(200))"), ElementsAre("00010 &"));  // 100 mm/s
  EXPECT_THAT(talk.say("00011 Get(X())"), ElementsAre("00011 &"));
  EXPECT_THAT(talk.say("E0001 GetErrStatusE()"),
              ElementsAre("E0001 &", "E0001 # ErrStatus(0)", "E0001 %"));
  EXPECT_THAT(talk.wait(1.95), IsEmpty());
  EXPECT_THAT(talk.wait(0.1), ElementsAre("00010 %", "00011 # X(200)", "00011 %"));
}

TEST(IppServer, SpeedScalesTheTime) {
  ServerOptions options = timed();
  options.speed = 10.0;
  Talk talk(options);
  talk.begin();
  talk.say("00010 GoTo(X(200))");
  EXPECT_THAT(talk.wait(0.18), IsEmpty());
  EXPECT_THAT(talk.wait(0.04), ElementsAre("00010 %"));
}

TEST(IppServer, AnAbortStopsOnTheWayAndClosesEveryCommandBeforeItself) {
  Talk talk(timed());
  talk.begin();
  talk.say("00010 GoTo(X(200))");
  talk.say("00011 GoTo(Y(200))");
  talk.wait(0.5);
  EXPECT_THAT(talk.say("E0101 AbortE()"),
              ElementsAre("E0101 &", StartsWith("00010 ! Error(2, 0006,"), "00010 %",
                          StartsWith("00011 ! Error(2, 0006,"), "00011 %", "E0101 %"));
  EXPECT_NEAR(talk.machine().position.x(), 50.0, 2.0);
  EXPECT_EQ(talk.machine().position.y(), 0.0);
  EXPECT_THAT(talk.ask("GoTo(X(0))"), HasSubstr("0514"));
  talk.ask("ClearAllErrors()");
  EXPECT_THAT(talk.ask("Get(Y())"), "# Y(0)");
  EXPECT_THAT(talk.wait(5.0), IsEmpty());
}

TEST(IppServer, AnAbortGetsThroughInTheErrorState) {
  Talk talk(timed());
  talk.begin();
  talk.say("00010 GoTo(X(200))");
  talk.say("7 Home()");  // an illegal tag: error state while the machine moves
  EXPECT_THAT(talk.say("E0101 AbortE()"),
              ElementsAre("E0101 &", StartsWith("00010 ! Error(2, 0006,"), "00010 %", "E0101 %"));
}

TEST(IppServer, DaemonsTellAboutMovesUntilTheyAreStopped) {
  Talk talk(timed());
  talk.begin();
  EXPECT_THAT(talk.say("E0100 OnMoveReportE(Time(0.5),Dis(20),X())"),
              ElementsAre("E0100 &", "E0100 %"));
  EXPECT_THAT(talk.wait(3.0), IsEmpty());  // nothing moves
  talk.say("00010 GoTo(X(100))");          // one second
  const auto lines = talk.wait(2.0);
  EXPECT_GE(lines.size(), 5U);
  EXPECT_LE(lines.size(), 12U);  // at most ten a second, and 00010 %
  EXPECT_THAT(lines.front(), StartsWith("E0100 # X("));
  talk.say("E0101 AbortE()");
  talk.say("00011 ClearAllErrors()");
  EXPECT_THAT(talk.say("E0100 OnMoveReportE(X())"),  // it survived the abort
              ElementsAre("E0100 &", StartsWith("E0100 ! Error(2, 0515,"), "E0100 %"));
  talk.say("00012 ClearAllErrors()");
  EXPECT_THAT(talk.say("00013 StopDaemon(E0100)"), ElementsAre("00013 &", "00013 %"));
  talk.say("00014 GoTo(X(0))");
  EXPECT_THAT(talk.wait(2.0), ElementsAre("00014 %"));
  EXPECT_EQ(talk.error("StopDaemon(E0100)"), 513);
  EXPECT_EQ(talk.error("StopAllDaemons()"), 512);
  EXPECT_EQ(talk.error("StopDaemon(1)"), 502);
}

TEST(IppServer, AnswersATagInUseAndABadTagWithoutTag) {
  Talk talk(timed());
  talk.begin();
  talk.say("00010 GoTo(X(200))");
  EXPECT_THAT(talk.say("00010 Get(X())"),
              ElementsAre("E0000 ! Error(2, 0001, \"00010 Get(X())\", \"Illegal tag\")"));
  EXPECT_THAT(talk.say("7 Home()"),
              ElementsAre("E0000 ! Error(2, 0001, \"7 Home()\", \"Illegal tag\")"));
  EXPECT_THAT(talk.wait(3.0), ElementsAre("00010 %"));
}

TEST(IppServer, AnEventCommandWithAPlainTagIsRefusedUnderItsTag) {
  Talk talk;
  talk.begin();
  EXPECT_THAT(talk.say("00010 AbortE()"),
              ElementsAre("00010 &", "00010 ! Error(2, 0001, \"00010 AbortE()\", \"Illegal tag\")",
                          "00010 %"));
}

TEST(IppServer, SendsNoNumberOfMoreThanSixteenCharactersOnRequest) {
  ServerOptions options;
  options.controller.numbers = NumberForm::kSixteenCharacters;
  Talk talk(options);
  talk.begin();
  talk.ask("GoTo(X(-123.4567890123),Y(0.000123456789012),Z(1))");
  EXPECT_EQ(talk.ask("Get(X(),Y())"), "# X(-123.4567890123), Y(0.00012345678901)");
}

TEST(IppServer, KeepsABoundedNumberOfCommands) {
  Talk talk(timed());
  talk.begin();
  talk.say("00010 GoTo(X(9000))");
  for (std::size_t i = 0; i < Server::kMaxWaiting; ++i) {
    EXPECT_EQ(talk.say(to_text(Tag{false, static_cast<int>(100 + i)}) + " Get(X())").size(), 1U);
  }
  EXPECT_THAT(talk.say("09000 Get(X())"), ElementsAre(StartsWith("E0000 ! Error(0, 0000,")));
}

TEST(IppServer, MovesOnlyTheAxesThatAreNamed) {
  Talk talk;
  talk.begin();
  EXPECT_EQ(talk.ask("GoTo(X(1.5),Y(2),Z(3))"), "");
  EXPECT_EQ(talk.ask("GoTo(Z(-3.25))"), "");
  EXPECT_EQ(talk.ask("Get(Z(),X(),Y(),R())"), "# Z(-3.25), X(1.5), Y(2), R(0)");
  EXPECT_EQ(talk.error("GoTo(X(100000))"), 2500);
  for (const char* bad : {"GoTo()", "GoTo(R(1))", "GoTo(X())", "GoTo(X(1),X(2))", "GoTo(1)",
                          "GoTo(X(\"1\"))", "GoTo(X(1,2))"}) {
    EXPECT_EQ(talk.error(bad), 502) << bad;
  }
  EXPECT_EQ(talk.error("Get(Q())"), 505);
  EXPECT_EQ(talk.error("Get()"), 502);
}

TEST(IppServer, MovesNothingBeforeHoming) {
  Talk talk;
  talk.say("00001 StartSession()");
  EXPECT_EQ(talk.ask("IsHomed()"), "# IsHomed(0)");
  EXPECT_EQ(talk.error("GoTo(X(1))"), 1011);
  EXPECT_EQ(talk.ask("Home()"), "");
  EXPECT_EQ(talk.ask("IsHomed()"), "# IsHomed(1)");
  EXPECT_EQ(talk.error("PtMeas(X(1),IJK(1,0,0))"), 1503);  // no tool
}

TEST(IppServer, PtMeasNamesThePointOfTheSurfaceOrTheCentreOfTheTip) {
  for (const auto point : {NamedPoint::kSurface, NamedPoint::kCenter}) {
    ServerOptions options;
    options.controller.point = point;
    Talk talk(options);
    talk.begin();
    const double r_mm = point == NamedPoint::kSurface ? IdealMachine::kTipRadius_mm : 0.0;
    talk.ask("SetProp(Tool.PtMeasPar.Approach(10), Tool.PtMeasPar.Retract(-1))");
    talk.ask("PtMeas(X(20),Y(0),Z(0),IJK(1,0,0))");
    EXPECT_EQ(talk.machine().last_touch.expected_tip_W_mm, Vector3d(20.0 + r_mm, 0.0, 0.0));
    EXPECT_EQ(talk.machine().position, Vector3d(30.0 + r_mm, 0.0, 0.0));
    for (const bool inside : {false, true}) {
      talk.ask("OnScanReport(X(),Y(),Z())");
      const auto points =
          parse_response("00001 " + talk.ask(inside ? "ScanOnCircle(0,0,5,20,0,5,0,0,1,360,180,90)"
                                                    : "ScanOnCircle(0,0,5,20,0,5,0,0,1,360,0,90)"));
      ASSERT_TRUE(points.has_value());
      const Vector3d first(points->data[0].number, points->data[1].number, 0.0);
      EXPECT_NEAR(first.norm(), 20.0 + (inside ? -r_mm : r_mm), 1e-9);
    }
    EXPECT_EQ(talk.error("ScanOnCircle(0,0,5,2.5,0,5,0,0,1,360,180,90)"), r_mm > 0.0 ? 509 : 0);
  }
}

TEST(IppServer, HandsTouchesOnBitByBit) {
  ServerOptions options;
  options.controller.point = NamedPoint::kCenter;
  Talk talk(options);
  talk.begin();
  EXPECT_EQ(talk.ask("SetProp(Tool.PtMeasPar.Approach(2.5), Tool.PtMeasPar.Search(1.25))"), "");
  const std::string line =
      "PtMeas(X(12.3456789012),Y(-0.0000000001),Z(7),IJK(0.6,-0.000000000000001,0.8))";
  EXPECT_EQ(talk.ask(line), "# X(12.3456789012), Y(-1e-10), Z(7)");
  const TouchCommand& touch = talk.machine().last_touch;
  EXPECT_EQ(touch.expected_tip_W_mm, Vector3d(12.3456789012, -0.0000000001, 7.0));
  EXPECT_EQ(touch.direction_W, Vector3d(-0.6, 0.000000000000001, -0.8));
  EXPECT_EQ(touch.approach_mm, 2.5);
  EXPECT_EQ(touch.search_mm, 1.25);
  EXPECT_EQ(touch.id, 0);
  talk.ask(line);
  EXPECT_EQ(talk.machine().last_touch.id, 1);
  EXPECT_EQ(talk.ask("SetProp(Simulation.NextTouch(70))"), "");
  talk.ask(line);
  EXPECT_EQ(talk.machine().last_touch.id, 70);
  EXPECT_EQ(talk.ask("GetProp(Simulation.NextTouch())"), "# Simulation.NextTouch(71)");
}

TEST(IppServer, RetractsAsTheParameterSays) {
  Talk talk;
  talk.begin();
  talk.ask("SetProp(Tool.PtMeasPar.Approach(10), Tool.PtMeasPar.Retract(-1))");
  talk.ask("PtMeas(X(20),Y(0),Z(0),IJK(1,0,0))");
  EXPECT_EQ(talk.ask("Get(X())"), "# X(33)");  // 10 mm before the contact at 23
  talk.ask("SetProp(Tool.PtMeasPar.Retract(5))");
  talk.ask("PtMeas(X(20),Y(0),Z(0),IJK(1,0,0))");
  EXPECT_EQ(talk.ask("Get(X())"), "# X(28)");  // contact at 23
}

TEST(IppServer, ADirectionIsNormalisedAndMayBeLeftOut) {
  Talk talk;
  talk.begin();
  talk.ask("PtMeas(X(20),Y(0),Z(0),IJK(10,0,0))");
  EXPECT_EQ(talk.machine().last_touch.direction_W, Vector3d(-1.0, 0.0, 0.0));
  talk.ask("GoTo(X(0),Y(50),Z(0))");
  talk.ask("PtMeas(X(0),Y(20),Z(0))");  // from the target to where the tip stands
  EXPECT_EQ(talk.machine().last_touch.direction_W, Vector3d(0.0, -1.0, 0.0));
  EXPECT_EQ(talk.error("PtMeas(X(20),IJK(0,0,0))"), 1010);
  EXPECT_EQ(talk.error("PtMeas(X(20),IJK(1,0))"), 502);
  talk.machine().nothing_there = true;
  EXPECT_EQ(talk.error("PtMeas(X(20),IJK(1,0,0))"), 1006);
}

TEST(IppServer, ReportsWhatWasAskedForInThatOrder) {
  Talk talk;
  talk.begin();
  EXPECT_EQ(talk.ask("OnPtMeasReport(ER(),Z(),IJK(),X(),Q(),Part.Temperature())"), "");
  EXPECT_EQ(talk.ask("PtMeas(X(20),Y(0),Z(4),IJK(1,0,0))"),
            "# ER(3), Z(4), IJK(1,0,0), X(23), Q(0), Part.Temperature(20)");
  EXPECT_EQ(talk.error("OnPtMeasReport()"), 502);
  EXPECT_EQ(talk.error("OnPtMeasReport(Foo())"), 505);
  talk.ask("EndSession()");
  talk.ask("StartSession()");
  EXPECT_EQ(talk.ask("PtMeas(X(20),Y(0),Z(4),IJK(1,0,0))"), "# X(23), Y(0), Z(4)");
}

TEST(IppServer, ParametersHaveFourValuesAndReturnToTheirDefault) {
  Talk talk;
  talk.begin();
  EXPECT_EQ(talk.ask("GetProp(Tool.GoToPar.Speed(),Tool.GoToPar.Speed.Max())"),
            "# Tool.GoToPar.Speed(100), Tool.GoToPar.Speed.Max(500)");
  EXPECT_EQ(talk.ask("SetProp(Tool.GoToPar.Speed(50))"), "");
  EXPECT_EQ(talk.machine().speeds.travel_mm_s, 50.0);
  EXPECT_THAT(talk.ask("SetProp(Tool.GoToPar.Speed(1000))"), HasSubstr("! Error(1, 0504,"));
  EXPECT_EQ(talk.machine().speeds.travel_mm_s, 500.0);
  EXPECT_EQ(talk.ask("ChangeTool(\"Probe1\")"), "");
  EXPECT_EQ(talk.ask("GetProp(Tool.GoToPar.Speed.Act())"), "# Tool.GoToPar.Speed.Act(100)");
  EXPECT_EQ(talk.machine().speeds.travel_mm_s, 100.0);
  for (const char* bad : {"GetProp(Tool.Foo())", "SetProp(Tool.GoToPar.Speed.Max(1))",
                          "SetProp(Tool.AvrRadius(1))", "SetProp(Foo(1))", "EnumProp(Foo())"}) {
    EXPECT_EQ(talk.error(bad), 510) << bad;
  }
  EXPECT_EQ(talk.error("GetProp()"), 502);
  EXPECT_EQ(talk.error("SetProp(Tool.GoToPar.Speed())"), 502);
  EXPECT_EQ(talk.ask("EnumProp(Tool.GoToPar())"),
            "# \"Speed\", \"Number\"|# \"Accel\", \"Number\"");
  EXPECT_THAT(talk.ask("EnumProp(Tool())"),
              HasSubstr("# \"PtMeasPar\", \"Property\"|# \"ScanPar\""));
  EXPECT_THAT(talk.say("E0005 GetPropE(Tool.Name())"),
              ElementsAre("E0005 &", "E0005 # Tool.Name(\"Probe1\")", "E0005 %"));
}

TEST(IppServer, ToolsAreFoundByName) {
  Talk talk;
  talk.begin();
  EXPECT_EQ(talk.ask("EnumTools()"), "# \"NoTool\"|# \"RefTool\"|# \"Probe1\"");
  EXPECT_EQ(talk.error("ChangeTool(\"Nope\")"), 1502);
  EXPECT_EQ(talk.ask("GetProp(Tool.Name())"), "# Tool.Name(\"Probe1\")");
  EXPECT_EQ(talk.ask("FindTool(\"RefTool\")"), "");
  EXPECT_EQ(talk.ask("GetProp(FoundTool.Name())"), "# FoundTool.Name(\"RefTool\")");
  EXPECT_EQ(talk.ask("ChangeTool(\"NoTool\")"), "");
  EXPECT_EQ(talk.ask("GetProp(Tool.Name(),Tool.AvrRadius())"),
            "# Tool.Name(\"NoTool\"), Tool.AvrRadius(0)");
}

TEST(IppServer, BothReadingsOfTheTranslationAreThoseOfTheProtocolPage) {
  const CsyTransformation t = {{1.0, 2.0, 3.0}, 30.0, 40.0, 50.0};
  const Vector3d machine(10.0, 5.0, 2.0);
  const Vector3d added = machine_to_csy(t).linear() * machine + t.x0_mm;
  const Vector3d subtracted = machine_to_csy(t) * machine;
  EXPECT_NEAR((added - Vector3d(7.03264, -7.13351, 6.03088)).norm(), 0.0, 1e-5);
  EXPECT_NEAR((subtracted - Vector3d(2.97485, -9.02111, 0.87745)).norm(), 0.0, 1e-5);
}

TEST(IppServer, TheTransformationToAPartIsItsFrameUnderEitherReading) {
  const CsyTransformation t = {{120.0, -80.0, 160.0}, 30.0, 40.0, -50.0};
  for (const double theta_deg : {30.0, 0.0, 180.0}) {
    SCOPED_TRACE(theta_deg);
    const Eigen::Isometry3d part =
        machine_to_csy({t.x0_mm, theta_deg, t.psi_deg, t.phi_deg}).inverse();
    EXPECT_TRUE(machine_to_csy(transformation_to(part, false)).isApprox(part.inverse(), 1e-12));
    Eigen::Isometry3d added = machine_to_csy(transformation_to(part, true));
    added.translation() = transformation_to(part, true).x0_mm;
    EXPECT_TRUE(added.isApprox(part.inverse(), 1e-12));
  }
}

TEST(IppServer, MeasuresInThePartSystem) {
  Talk talk;
  talk.begin();
  EXPECT_EQ(talk.ask("SetCsyTransformation(PartCsy,100,0,0,0,90,0)"), "");
  EXPECT_EQ(talk.ask("SetCoordSystem(PartCsy)"), "");
  EXPECT_EQ(talk.ask("GetCoordSystem()"), "# CoordSystem(PartCsy)");
  talk.ask("PtMeas(X(0),Y(-20),Z(5),IJK(0,-1,0))");  // machine (120, 0, 5), direction x
  EXPECT_NEAR((talk.machine().last_touch.expected_tip_W_mm - Vector3d(123.0, 0.0, 5.0)).norm(), 0.0,
              1e-12);
  EXPECT_NEAR((talk.machine().last_touch.direction_W + Vector3d::UnitX()).norm(), 0.0, 1e-12);
  EXPECT_EQ(talk.error("SetCsyTransformation(PartCsy,0,0,0,181,0,0)"), 1007);
  EXPECT_EQ(talk.error("SetCsyTransformation(PartCsy,0,0,0)"), 502);
  EXPECT_EQ(talk.error("SetCoordSystem(FooCsy)"), 505);
  EXPECT_EQ(talk.error("SetCoordSystem(MultipleArmCsy)"), 506);
}

TEST(IppServer, ScansGiveWholePointsInTheColumnsAskedFor) {
  Talk talk;
  talk.begin();
  EXPECT_EQ(talk.ask("OnScanReport(X(),Y(),Z())"), "");
  std::size_t numbers = 0;
  for (const std::string& line : talk.say("00010 ScanOnCircle(0,0,5,20,0,5,0,0,1,360,0,0.5)")) {
    const auto response = parse_response(line);
    ASSERT_TRUE(response.has_value());
    EXPECT_EQ(response->data.size() % 3, 0U);
    numbers += response->data.size();
  }
  EXPECT_EQ(numbers, 3U * 720U);
  EXPECT_EQ(talk.error("ScanOnCircle(0,0,5,20,0,5,0,0,1,360,90,1)"), 506);
  EXPECT_EQ(talk.error("ScanOnCircle(0,0,5,20,0,5,0,0,0,360,0,1)"), 1010);
  EXPECT_EQ(talk.error("ScanOnCircle(0,0,5,20,0,5,0,0,1,360,0,0)"), 509);
  EXPECT_EQ(talk.error("ScanOnCircle(0,0,5,20,0,9,0,0,1,360,0,1)"), 509);  // not in the plane
  EXPECT_EQ(talk.error("ScanOnCircle(0,0,5,20,0,5,0,0,1,360,0)"), 502);
  EXPECT_EQ(talk.error("OnScanReport(IJK())"), 505);
  EXPECT_EQ(talk.ask("ScanOnCircleHint(0.1,0.01)"), "");
}

TEST(IppServer, AlignsThePart) {
  Talk talk;
  talk.begin();
  EXPECT_EQ(talk.ask("AlignPart(1,0,0,0,1,0,0)"), "# 0,1,0");
  EXPECT_EQ(talk.ask("AlignPart(0,0,1,0.6,0,0.8,0,1,0,0,1,0,0,0)"), "# 0.6,0,0.8,0,1,0");
  EXPECT_EQ(talk.error("AlignPart(0,0,1,0,0,0,0)"), 1010);
  EXPECT_EQ(talk.error("AlignPart(0,0,1,0,0,1)"), 502);
  EXPECT_EQ(talk.ask("GetProp(Simulation.Pose())"), "# Simulation.Pose(0,0)");
  EXPECT_EQ(talk.ask("SetProp(Simulation.NextTurn(9))"), "");
  EXPECT_EQ(talk.backend().next_turn, 9U);
  EXPECT_EQ(talk.ask("SetProp(Simulation.Feature(1))"), "");
  EXPECT_EQ(talk.error("SetProp(Simulation.Feature(2))"), 509);
}

TEST(IppServer, TellsTemperaturesErrorsAndWhatItCan) {
  Talk talk;
  talk.begin();
  EXPECT_EQ(talk.ask("GetTemperatureSensors()"), "# \"Part\"|# \"Scale\"");
  EXPECT_EQ(talk.ask("ReadTemperatureSensor(\"Part\")"), "# ReadTemperatureSensor(20)");
  EXPECT_EQ(talk.ask("ReadAllTemperatures()"), "# Part(20)|# Scale(20)");
  EXPECT_EQ(talk.error("ReadTemperatureSensor(\"Foo\")"), 505);
  EXPECT_EQ(talk.ask("GetErrorInfo(1006)"), "# \"Surface not found\"");
  EXPECT_EQ(talk.error("GetErrorInfo(1006.5)"), 505);
  EXPECT_EQ(talk.error("GetErrorInfo(-1)"), 505);
  EXPECT_EQ(talk.error("ScanOnLine(0,0,0,1,1,1,0,0,1,1)"), 501);
  EXPECT_THAT(talk.ask("GetSupportedCommands()"), HasSubstr("# \"PtMeas\""));
  EXPECT_EQ(talk.ask("EnableUser()"), "");
  EXPECT_EQ(talk.ask("IsUserEnabled()"), "# IsUserEnabled(1)");
  talk.ask("GoTo(X(1))");
  EXPECT_EQ(talk.ask("IsUserEnabled()"), "# IsUserEnabled(0)");
}

TEST(IppServer, AClientThatGoesLeavesAMachineAtRestAndNoSession) {
  Talk talk(timed());
  talk.begin();
  talk.say("E0100 OnMoveReportE(X())");
  talk.say("00010 GoTo(X(200))");
  talk.say("00011 GoTo(Y(200))");
  talk.wait(0.5);
  talk.server().disconnect(talk.now_s);
  EXPECT_NEAR(talk.machine().position.x(), 50.0, 2.0);
  EXPECT_THAT(talk.wait(5.0), IsEmpty());
  EXPECT_EQ(talk.machine().position.y(), 0.0);
  EXPECT_THAT(talk.ask("Get(X())"), HasSubstr("0008"));
  EXPECT_EQ(talk.ask("StartSession()"), "");
  EXPECT_THAT(talk.ask("Get(X())"), StartsWith("# X("));
}

}  // namespace
}  // namespace rondure::cmm::ipp
