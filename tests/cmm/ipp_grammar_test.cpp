#include "cmm/ipp/grammar.h"

#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cmm/ipp/internal/reader.h"

namespace rondure::cmm::ipp {
namespace {

Command parsed(std::string_view line) {
  auto command = parse_command(line);
  EXPECT_TRUE(command.has_value()) << line << ": " << command.error().what;
  return command.value_or(Command{});
}

Response answered(std::string_view line) {
  auto response = parse_response(line);
  EXPECT_TRUE(response.has_value()) << line << ": " << response.error().what;
  return response.value_or(Response{});
}

TEST(IppGrammar, ReadsEveryLineThatMustParse) {
  EXPECT_EQ(parsed("00001 StartSession()"), (Command{{false, 1}, "StartSession", {}}));
  EXPECT_EQ(parsed("E0001 GetErrStatusE()"), (Command{{true, 1}, "GetErrStatusE", {}}));
  EXPECT_EQ(parsed("00002 GoTo ( X ( 1 ) , Y(-2.6E01) )"),
            (Command{{false, 2}, "GoTo", {call_item("X", {1.0}), call_item("Y", {-26.0})}}));
  EXPECT_EQ(
      parsed("00003 PtMeas(X(+1.),Y(.5),IJK(0,0,1))"),
      (Command{{false, 3},
               "PtMeas",
               {call_item("X", {1.0}), call_item("Y", {0.5}), call_item("IJK", {0.0, 0.0, 1.0})}}));
  EXPECT_EQ(parsed("00004 SetProp(Tool.PtMeasPar.Speed(10))"),
            (Command{{false, 4}, "SetProp", {call_item("Tool.PtMeasPar.Speed", {10.0})}}));
  EXPECT_EQ(parsed("00005 ChangeTool(\"Probe 1\")"),
            (Command{{false, 5}, "ChangeTool", {string_item("Probe 1")}}));
  EXPECT_EQ(parsed("00006 StopDaemon(E0001)"),
            (Command{{false, 6}, "StopDaemon", {name_item("E0001")}}));
  EXPECT_EQ(parsed("00007 SetCoordSystem(PartCsy)"),
            (Command{{false, 7}, "SetCoordSystem", {name_item("PartCsy")}}));
  const Command scan = parsed("00008 ScanOnCircle(0,0,0,10,0,0,0,0,1,360,0,1)");
  EXPECT_EQ(scan.arguments.size(), 12U);
  EXPECT_EQ(scan.arguments[3], number_item(10.0));
}

TEST(IppGrammar, RefusesWithTheNumbersOfAnIndependentParser) {
  struct Case {
    const char* line;
    int number;
  };
  for (const Case& c : std::vector<Case>{{"1 Home()", 1},
                                         {"00000 Home()", 1},
                                         {"E0000 AbortE()", 1},
                                         {"E0001 Home()", 1},
                                         {"00001 AbortE()", 1},
                                         {"00001Home()", 2},
                                         {"00001  Home()", 502},
                                         {"00001 home()", 507},
                                         {"00001 GoTo(X(1)", 502},
                                         {"00001 GoTo(X(1e1234))", 509},
                                         {"00001 GoTo(X(.))", 509},
                                         {"00001 Home()\x80", 7},
                                         {"00001 Home()\t", 7},
                                         {"00001 Home()\r", 7}}) {
    SCOPED_TRACE(c.line);
    const auto command = parse_command(c.line);
    ASSERT_FALSE(command.has_value());
    EXPECT_EQ(command.error().number, c.number) << command.error().what;
    EXPECT_FALSE(command.error().what.empty());
  }
}

TEST(IppGrammar, RefusesWhatTheVectorsDoNotName) {
  struct Case {
    const char* line;
    int number;
  };
  for (const Case& c : std::vector<Case>{{"", 1},
                                         {"00001", 2},
                                         {"00001 ", 502},
                                         {"00001 Home", 502},
                                         {"00001 Home)", 502},
                                         {"00001 Home(", 502},
                                         {"00001 Home() Home()", 502},
                                         {"00001 GoTo(X(1),)", 502},
                                         {"00001 GoTo(,X(1))", 502},
                                         {"00001 GoTo(X(1) Y(1))", 502},
                                         {"00001 GoTo(X(1 2))", 502},
                                         {"00001 GoTo(X((1)))", 502},
                                         {"00001 ChangeTool(\"\")", 502},
                                         {"00001 ChangeTool(\"T)", 502},
                                         {"00001 SetProp(Tool..Speed(1))", 502},
                                         {"00001 GoTo(X(--1))", 509},
                                         {"00001 GoTo(X(1.2.3))", 509},
                                         {"00001 GoTo(X(1e))", 509},
                                         {"00001 GoTo(X(0x10))", 509},
                                         {"00001 GoTo(X(12345678901234567))", 509},
                                         {"00001 GoTo(X(1e999))", 509},
                                         {"00001 GoTo(X(-inf))", 509},
                                         {"E001 AbortE()", 1},
                                         {"e0001 AbortE()", 1},
                                         {"00001 FooBar()", 507},
                                         {"00001 GoTo(X(1e1234", 509}}) {
    SCOPED_TRACE(c.line);
    const auto command = parse_command(c.line);
    ASSERT_FALSE(command.has_value());
    EXPECT_EQ(command.error().number, c.number) << command.error().what;
  }
}

TEST(IppGrammar, AcceptsSpacesBehindTheLastParenthesis) {
  EXPECT_EQ(parsed("00001 Home()  "), (Command{{false, 1}, "Home", {}}));
}

TEST(IppGrammar, TellsTheTagThatCanBeAnswered) {
  EXPECT_EQ(parse_command("00042 Foo()").error().tag, (Tag{false, 42}));
  EXPECT_EQ(parse_command("00042 GoTo(X(1)").error().tag, (Tag{false, 42}));
  EXPECT_EQ(parse_command("42 Home()").error().tag, std::nullopt);
  EXPECT_EQ(parse_command("00042Home()").error().tag, std::nullopt);
}

TEST(IppGrammar, LimitsDepthAndLength) {
  const std::string deep = "00001 GoTo" + std::string(9, '(') + std::string(9, ')');
  EXPECT_EQ(parse_command(deep).error().number, 502);  // a bare parenthesis is no argument
  std::string nested = "00001 GoTo(";
  for (int i = 0; i < 30000; ++i) nested += "X(";
  EXPECT_EQ(parse_command(nested).error().number, 8);
  EXPECT_EQ(parse_command("00001 Home()" + std::string(kMaxLineLength - 12, ' ')).has_value(),
            true);
  EXPECT_EQ(parse_command("00001 Home()" + std::string(kMaxLineLength - 11, ' ')).error().number,
            8);
}

TEST(IppGrammar, WritesCommandsThatReadBackTheSame) {
  const Command commands[] = {
      {{false, 99999}, "PtMeas", {call_item("X", {0.1}), call_item("IJK", {0.6, 0.0, -0.8})}},
      {{true, 9999}, "OnMoveReportE", {call_item("Time", {0.5}), call_item("X")}},
      {{false, 1}, "ChangeTool", {string_item("a tool (long), 4 mm")}},
      {{false, 1}, "ScanOnCircle", {number_item(1.5), number_item(-2.25)}},
      {{false, 1}, "SetProp", {call_item("Tool.Name", {string_item("T")})}}};
  for (const Command& command : commands) {
    SCOPED_TRACE(to_line(command));
    EXPECT_EQ(parsed(to_line(command)), command);
  }
  EXPECT_EQ(to_line(commands[0]), "99999 PtMeas(X(0.1), IJK(0.6,0,-0.8))");
  EXPECT_EQ(to_line(commands[3]), "00001 ScanOnCircle(1.5,-2.25)");
}

TEST(IppGrammar, StringsHoldNoQuotesAndNothingButAscii) {
  EXPECT_EQ(to_text(string_item("a \"b\" \xC3\xA9\n")), "\"a 'b' ???\"");
  EXPECT_EQ(to_text(string_item("")), "\" \"");
}

TEST(IppGrammar, ReadsAndWritesTheFourResponses) {
  EXPECT_EQ(answered("00001 &").kind, Response::Kind::kAck);
  EXPECT_EQ(answered("E0101 %").kind, Response::Kind::kComplete);
  EXPECT_EQ(answered("E0000 ! Error(3, 0500, \"\", \"Emergency stop\")").tag, kUnsolicited);
  const Response data = answered("00004 # X(99.93), Y(17.148)");
  ASSERT_EQ(data.data.size(), 2U);
  EXPECT_EQ(single_number(*find_call(data.data, "Y")), 17.148);
  EXPECT_EQ(data_line(data.tag, data.data), "00004 # X(99.93), Y(17.148)");
  const ErrorReport report = error_report(1006, "00007 PtMeas(X(1))");
  EXPECT_EQ(error_line({false, 7}, report),
            "00007 ! Error(2, 1006, \"00007 PtMeas(X(1))\", \"Surface not found\")");
  EXPECT_EQ(answered(error_line({false, 7}, report)).error, report);
  EXPECT_EQ(ack_line({true, 12}), "E0012 &");
  EXPECT_EQ(complete_line({false, 12}), "00012 %");
}

TEST(IppGrammar, UnderstandsServersThatKeepTheGrammarLoosely) {
  EXPECT_EQ(string_of(answered("00001 # \"RefTool\"").data.at(0)), "RefTool");
  const Response vector = answered("00001 # (0.6, 0.0, 0.8)");
  EXPECT_EQ(vector_of(vector.data.at(0)), Eigen::Vector3d(0.6, 0.0, 0.8));
  const Response quoted = answered("00003 # GetMachineClass(\"CartCMMWithRotaryTable\")");
  EXPECT_EQ(string_of(quoted.data.at(0)), "CartCMMWithRotaryTable");
  EXPECT_EQ(string_of(answered("00001 # Tool.Name(\"Probe1\")").data.at(0)), "Probe1");
  EXPECT_EQ(answered("00001 # X(1.00000000000000000001)").data.at(0), call_item("X", {1.0}));
  EXPECT_EQ(answered("00001 # \"\"").data.at(0), string_item(""));
  const Response xml = answered("00001 # <Tool name=\"a\"><Tip/></Tool>");
  EXPECT_TRUE(xml.data.empty());
  EXPECT_EQ(xml.raw, "<Tool name=\"a\"><Tip/></Tool>");
}

TEST(IppGrammar, UnderstandsErrorsThatKeepTheGrammarLoosely) {
  const ErrorReport wanted = {3, 500, "GoTo", "Emergency stop"};
  for (const char* line :
       {"00001 ! Error(3, 0500, \"GoTo\", \"Emergency stop\")",
        "00001 ! Error(3,500,GoTo,\"Emergency stop\")", "00001 ! Error(3,500,GoTo,Emergency stop)",
        "00001 !  Error ( 3 , \"0500\" , GoTo , \"Emergency stop\" ) "}) {
    SCOPED_TRACE(line);
    EXPECT_EQ(answered(line).error, wanted);
  }
  const Response whole =
      answered("00011 ! Error(1, 0504, \"00011 SetProp(A(1), B(2))\", \"Argument out of range\")");
  EXPECT_EQ(whole.error.method, "00011 SetProp(A(1), B(2))");
  EXPECT_EQ(answered("00001 ! Error(3, 1003)").error.number, 1003);
  EXPECT_EQ(answered("00001 ! Error(3, 1003, \"No touch, at all\")").error.text,
            "No touch, at all");
}

TEST(IppGrammar, RefusesResponsesWithoutTagOrCharacter) {
  for (const char* line : {"", "&", "00001", "00001 ", "00001&", "00001 x", "0001 &", "00000 &",
                           "00001 ! Error(a, 1, \"\", \"\")", "00001 ! Error(1, 12345, \"\", \"\")",
                           "00001 ! oops", "00001 # \x81", "HTTP/1.1 400 Bad Request"}) {
    SCOPED_TRACE(line);
    const auto response = parse_response(line);
    ASSERT_FALSE(response.has_value());
    EXPECT_EQ(response.error().code, core::Code::kSyntax);
  }
}

TEST(IppGrammar, ReadsEveryLineOfTheRecordedDialogue) {
  std::ifstream file(RONDURE_SOURCE_DIR "/tests/data/ipp_dme_dialogue/dialogue.txt");
  std::string line;
  int commands = 0;
  int responses = 0;
  while (std::getline(file, line)) {
    SCOPED_TRACE(line);
    if (line.starts_with("C: ") && line != "C: 7 Home()" && line != "C: 00028 FooBar()") {
      EXPECT_TRUE(parse_command(std::string_view(line).substr(3)).has_value());
      ++commands;
    } else if (line.starts_with("S: ")) {
      const Response response = answered(std::string_view(line).substr(3));
      EXPECT_EQ(response.kind == Response::Kind::kData, !response.data.empty());
      ++responses;
    }
  }
  EXPECT_EQ(commands, 43);
  EXPECT_EQ(responses, 119);
}

TEST(IppErrors, EveryNumberIsFoundWithASeverity) {
  int count = 0;
  for (int number = 0; number <= 9999; ++number) {
    const ErrorEntry* entry = find_error(number);
    if (entry == nullptr) continue;
    ++count;
    EXPECT_EQ(entry->number, number);
    EXPECT_TRUE(entry->severity == 0 || entry->severity == 1 || entry->severity == 2 ||
                entry->severity == 3 || entry->severity == 9);
    EXPECT_FALSE(entry->text.empty());
  }
  EXPECT_EQ(count, 55);
  EXPECT_EQ(find_error(3), nullptr);
  EXPECT_EQ(find_error(1006)->text, "Surface not found");
  EXPECT_EQ(in_words(error_report(1006, "PtMeas")),
            "error 1006, severity 2: Surface not found (PtMeas)");
}

TEST(IppMethods, EventMethodsEndInEAndHaveAnEventTag) {
  EXPECT_TRUE(parse_command("E0001 AbortE()"));
  EXPECT_EQ(parse_command("00001 AbortE()").error().number, kIllegalTag);
  EXPECT_EQ(parse_command("E0001 Home()").error().number, kIllegalTag);
  EXPECT_EQ(parse_command("E0001 FooE()").error().number, kIllegalCommand);
  EXPECT_TRUE(parse_command("00001 ScanOnCircle()"));
  EXPECT_EQ(parse_command("00001 scanoncircle()").error().number, kIllegalCommand);
}

TEST(IppGrammar, ALineEndedByLineFeedAloneIsAnIllegalCharacter) {
  EXPECT_EQ(parse_command(RawLine{"00001 Home()", false}).error().number, 7);
  EXPECT_TRUE(parse_command(RawLine{"00001 Home()"}).has_value());
  EXPECT_EQ(parse_command(RawLine{"00001 Home()\r"}).error().number, 7);
}

}  // namespace
}  // namespace rondure::cmm::ipp
