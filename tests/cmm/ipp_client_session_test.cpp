#include "cmm/ipp_client/session.h"

#include <fstream>
#include <map>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cmm/ipp_client/dialogue.h"
#include "cmm/ipp_client/internal/failure.h"
#include "tests/cmm/scripted_server.h"

namespace rondure::cmm::ipp::client {
namespace {

using std::chrono::milliseconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Lines = std::vector<std::string>;

constexpr milliseconds kShort(250);
constexpr milliseconds kLong(60'000);

/// A session with a script, and what was sent.
struct Scripted {
  explicit Scripted(ScriptedServer::Answer answer, SessionOptions options = {kShort, true}) {
    auto line = std::make_unique<ScriptedServer>(
        [this, answer](const std::string& tag, const std::string& method) {
          sent.push_back(tag + " " + method);
          return answer(tag, method);
        });
    server = line.get();
    session = std::make_unique<Session>(std::move(line), options);
  }

  ScriptedServer* server = nullptr;
  std::vector<std::string> sent;
  std::unique_ptr<Session> session;
};

Lines done(const std::string& tag) { return {tag + " &", tag + " %"}; }

TEST(IppClientSession, NumbersItsCommandsFromOneOn) {
  Scripted s([](const std::string& tag, const std::string&) { return done(tag); });
  ASSERT_TRUE(s.session->call("StartSession", {}, kLong));
  ASSERT_TRUE(s.session->call_event("GetErrStatusE", {}, kLong));
  ASSERT_TRUE(s.session->call("GoTo", {call_item("X", {1.5})}, kLong));
  EXPECT_THAT(s.sent,
              ElementsAre("00001 StartSession()", "E0001 GetErrStatusE()", "00002 GoTo(X(1.5))"));
}

TEST(IppClientSession, BeginsAgainBehindTheLastTagAndSkipsTagsInUse) {
  Scripted s([](const std::string& tag, const std::string& method) {
    return method == "Home()" ? Lines{tag + " &"} : done(tag);
  });
  const auto pending = s.session->begin("Home", {});  // 00001 stays in use
  ASSERT_TRUE(pending);
  for (int i = 2; i <= 99'999; ++i) ASSERT_TRUE(s.session->call("IsHomed", {}, kLong));
  EXPECT_EQ(s.sent.back(), "99999 IsHomed()");
  ASSERT_TRUE(s.session->call("IsHomed", {}, kLong));
  EXPECT_EQ(s.sent.back(), "00002 IsHomed()");
}

TEST(IppClientSession, KeepsDataAndWarningsOfItsOwnTagOnly) {
  Scripted s([](const std::string& tag, const std::string&) {
    return Lines{"E0000 # KeyPress(\"F1\")",
                 tag + " &",
                 "E0007 # X(99), Y(99), Z(99)",
                 tag + " ! Error(1, 0504, \"00001 SetProp()\", \"Argument out of range\")",
                 "99999 # X(98)",
                 "99999 %",
                 tag + " # X(1), Y(2), Z(3)",
                 "E0000 ! Error(1, 0000, \"\", \"Buffer full\")",
                 tag + " %"};
  });
  const auto reply = s.session->call("Get", {call_item("X")}, kLong);
  ASSERT_TRUE(reply);
  ASSERT_EQ(reply->data.size(), 1U);
  EXPECT_EQ(*find_point(*reply), Eigen::Vector3d(1, 2, 3));
  ASSERT_EQ(reply->warnings.size(), 1U);
  EXPECT_EQ(reply->warnings[0].number, 504);
  EXPECT_THAT(s.session->take_unsolicited(), HasSubstr("Buffer full"));
}

TEST(IppClientSession, GivesTheFirstErrorAndReadsToTheEndOfItsTransaction) {
  Scripted s([](const std::string& tag, const std::string& method) {
    if (method != "Home()") return done(tag);
    return Lines{tag + " &", tag + " ! Error(3, 500, Home, \"Emergency stop\")",
                 tag + " ! Error(2, 0006, \"Home()\", \"Transaction aborted\")", tag + " %"};
  });
  const auto failed = s.session->call("Home", {}, kLong);
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().kind, Failure::Kind::kServer);
  EXPECT_EQ(failed.error().report.number, 500);
  const core::Error error = error_of(failed.error(), "homing");
  EXPECT_EQ(error.code, core::Code::kMachine);
  EXPECT_THAT(error.what, HasSubstr("homing: the machine says error 0500, severity 3: Emergency"));
  EXPECT_THAT(error.what, HasSubstr("release the emergency stop"));
  EXPECT_TRUE(s.session->call("ClearAllErrors", {}, kLong));
}

TEST(IppClientSession, AnUnsolicitedFaultEndsTheMotionThatGoesOn) {
  Scripted s([](const std::string& tag, const std::string& method) {
    if (!method.starts_with("GoTo")) return done(tag);
    return Lines{tag + " &", "E0000 ! Error(9, 0503, \"\", \"Controller communications failure\")"};
  });
  const auto failed = s.session->call("GoTo", {}, kLong, Session::Watch::kStop);
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().kind, Failure::Kind::kServer);
  EXPECT_EQ(failed.error().report.number, 503);
  EXPECT_THAT(s.sent, ElementsAre("00001 GoTo()", "E0001 AbortE()"));
  EXPECT_TRUE(s.session->call("Get", {}, kLong)) << "told once";
}

TEST(IppClientSession, TakesTheEndOfAbortForTheEndOfAllThatIsOlder) {
  // Seen: the running command is closed with 0006, the pending one is dropped without a word.
  Scripted s([](const std::string& tag, const std::string& method) {
    if (method == "AbortE()") {
      return Lines{tag + " &", "00001 ! Error(2, 0006, \"GoTo\", \"Transaction aborted\")",
                   "00001 %", tag + " %"};
    }
    return method.starts_with("GoTo") ? Lines{tag + " &"} : done(tag);
  });
  const auto running = s.session->begin("GoTo", {call_item("X", {300.0})});
  const auto pending = s.session->begin("GoTo", {call_item("Y", {200.0})});
  ASSERT_TRUE(running && pending);
  ASSERT_TRUE(s.session->abort());
  const auto first = s.session->finish(*running, kShort);
  const auto second = s.session->finish(*pending, kShort);
  ASSERT_FALSE(first);
  ASSERT_FALSE(second);
  EXPECT_EQ(first.error().kind, Failure::Kind::kStopped);
  EXPECT_EQ(second.error().kind, Failure::Kind::kStopped);
  EXPECT_TRUE(s.session->call("ClearAllErrors", {}, kLong));
}

TEST(IppClientSession, StopsAMotionWhenAskedToAndNothingElse) {
  bool wish = false;
  const auto answer = [&](const std::string& tag, const std::string& method) {
    wish = true;
    return method.starts_with("GoTo") ? Lines{tag + " &"} : done(tag);
  };
  Scripted s(answer);
  s.session->ask_for_stop([&] { return wish; });
  EXPECT_TRUE(s.session->call("Get", {call_item("X")}, kLong));
  const auto stopped = s.session->call("GoTo", {}, kLong, Session::Watch::kStop);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().kind, Failure::Kind::kStopped);
  EXPECT_EQ(s.sent.back(), "E0001 AbortE()");
}

TEST(IppClientSession, LetsAMotionEndWhereAbortIsBroken) {
  Scripted s([](const std::string& tag, const std::string&) { return done(tag); }, {kShort, false});
  s.session->ask_for_stop([] { return true; });
  EXPECT_TRUE(s.session->call("GoTo", {}, kLong, Session::Watch::kStop));
  EXPECT_THAT(s.sent, ElementsAre("00001 GoTo()"));
}

TEST(IppClientSession, EndsWhenNothingIsAcknowledged) {
  Scripted s([](const std::string&, const std::string&) { return Lines{}; });
  const auto silent = s.session->call("Home", {}, kLong);
  ASSERT_FALSE(silent);
  EXPECT_EQ(silent.error().kind, Failure::Kind::kLine);
  EXPECT_THAT(silent.error().what, HasSubstr("did not acknowledge Home() within 0.25 s"));
  EXPECT_EQ(s.sent.back(), "E0001 AbortE()");  // it may move all the same
  EXPECT_FALSE(s.session->usable());
  EXPECT_EQ(s.session->call("IsHomed", {}, kLong).error().what, silent.error().what);
}

TEST(IppClientSession, SaysWhatCameOfALineThatNeverEnded) {
  Scripted s([](const std::string&, const std::string&) { return Lines{}; });
  s.server->trail_off("00001 ! Error(3, 05");
  const auto silent = s.session->call("Home", {}, kLong);
  ASSERT_FALSE(silent);
  EXPECT_THAT(silent.error().what, HasSubstr("half a line came: \"00001 ! Error(3, 05\""));
}

TEST(IppClientSession, StopsWhatDoesNotEnd) {
  Scripted s([](const std::string& tag, const std::string&) { return Lines{tag + " &"}; });
  const auto endless = s.session->call("GoTo", {}, kShort);
  ASSERT_FALSE(endless);
  EXPECT_THAT(endless.error().what, HasSubstr("did not finish GoTo() within 0.25 s"));
  EXPECT_THAT(endless.error().what, HasSubstr("the last line from there: \"00001 &\""));
  EXPECT_EQ(s.sent.back(), "E0001 AbortE()");
}

TEST(IppClientSession, EndsAtWhatIsNoAnswer) {
  for (const char* garbage : {"HTTP/1.1 400 Bad Request", "", "00001", "0001 &", "00001 ?",
                              "00001 ! Error()", "\x01\x02\xff", "00001 ! nonsense"}) {
    SCOPED_TRACE(garbage);
    Scripted s([&](const std::string& tag, const std::string& method) {
      return method == "AbortE()" ? done(tag) : Lines{tag + " &", garbage, tag + " %"};
    });
    const auto failed = s.session->call("Home", {}, kLong);
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().kind, Failure::Kind::kLine);
    EXPECT_THAT(failed.error().what, HasSubstr("does not speak I++ DME"));
    EXPECT_THAT(s.sent, ElementsAre("00001 Home()", "E0001 AbortE()"));
  }
}

TEST(IppClientSession, SaysThatTheConnectionWasLost) {
  Scripted s([](const std::string& tag, const std::string&) { return Lines{tag + " &"}; });
  s.server->hang_up();
  const auto lost = s.session->call("GoTo", {}, kLong);
  ASSERT_FALSE(lost);
  EXPECT_THAT(
      error_of(lost.error(), "the move").what,
      HasSubstr(
          "closed the connection; the last line from there: \"00001 &\"; the machine ends the "
          "motion it was told last"));
}

/// The recorded dialogue: what the client says and what comes back for it, by turns.
struct Turn {
  std::string sent;
  std::vector<std::string> received;
};

std::vector<Turn> recorded_dialogue() {
  std::ifstream file(RONDURE_SOURCE_DIR "/tests/data/ipp_dme_dialogue/dialogue.txt");
  std::vector<Turn> out;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("C: ")) out.push_back({line.substr(3), {}});
    if (line.starts_with("S: ")) out.back().received.push_back(line.substr(3));
  }
  return out;
}

/// A recorded command; FooBar, which is none, too.
Command command_of(const std::string& line) {
  if (const auto command = parse_command(line)) return *command;
  return {*read_tag(line.substr(0, 5)), line.substr(6, line.find('(') - 6), {}};
}

/// Answers with the recording. Tags are matched to those of the recording in the order they appear.
class Recording {
 public:
  explicit Recording(std::vector<Turn> turns) : turns_(std::move(turns)) {}

  std::vector<std::string> answer(const std::string& tag, const std::string& method) {
    const Turn& turn = turns_.at(next_++);
    const Command said = command_of(tag + " " + method);
    const Command recorded = command_of(turn.sent);
    EXPECT_TRUE(said.method == recorded.method && said.arguments == recorded.arguments)
        << method << " instead of " << turn.sent;
    tags_[turn.sent.substr(0, 5)] = tag;
    std::vector<std::string> out;
    for (std::string line : turn.received) {
      const auto known = tags_.find(line.substr(0, 5));
      if (known != tags_.end()) line.replace(0, 5, known->second);
      out.push_back(std::move(line));
    }
    return out;
  }
  [[nodiscard]] std::size_t used() const { return next_; }

 private:
  std::vector<Turn> turns_;
  std::map<std::string, std::string> tags_;
  std::size_t next_ = 0;
};

TEST(IppClientSession, ReplaysTheRecordedDialogue) {
  auto turns = recorded_dialogue();
  turns.pop_back();  // the bad tag, which this client cannot send
  ASSERT_EQ(turns.size(), 44U);
  Recording recording(turns);
  Scripted s([&](const std::string& tag, const std::string& method) {
    return recording.answer(tag, method);
  });
  int errors = 0;
  for (const Turn& turn : turns) {
    SCOPED_TRACE(turn.sent);
    const Command command = command_of(turn.sent);
    if (turn.received.size() == 1) {  // & only: GoTo, GoTo, then AbortE
      ASSERT_TRUE(s.session->begin(command.method, command.arguments));
      continue;
    }
    if (turn.sent.starts_with("00901")) {  // & and then the lines of a daemon
      ASSERT_TRUE(s.session->begin(command.method, command.arguments));
      continue;
    }
    if (command.method == "AbortE") {
      ASSERT_TRUE(s.session->abort());
      continue;
    }
    const auto reply = command.tag.event
                           ? s.session->call_event(command.method, command.arguments, kLong)
                           : s.session->call(command.method, command.arguments, kLong);
    if (!reply) {
      ++errors;
      EXPECT_EQ(reply.error().kind, Failure::Kind::kServer) << reply.error().what;
    }
  }
  EXPECT_EQ(recording.used(), turns.size());
  EXPECT_EQ(errors, 5);  // FooBar, Get and again after the abort, ChangeTool, StopDaemon
}

TEST(IppClientDialogue, ReadsTheRecordedValuesByName) {
  std::map<std::string, Reply> replies;
  for (const Turn& turn : recorded_dialogue()) {
    Reply reply;
    for (const std::string& line : turn.received) {
      const auto response = parse_response(line);
      ASSERT_TRUE(response) << line;
      if (response->kind == Response::Kind::kData) reply.data.push_back(*response);
    }
    replies[turn.sent.substr(0, 5)] = reply;
  }
  // The report X(),Y(),Z(),IJK(),ER() comes back with ER first.
  EXPECT_EQ(*find_point(replies.at("00021")), Eigen::Vector3d(23, 0, 10));
  EXPECT_EQ(*find_number(replies.at("00021"), "ER"), 3.0);
  EXPECT_EQ(*find_point(replies.at("00022")), Eigen::Vector3d(33, 0, 10));
  EXPECT_EQ(*find_number(replies.at("00009"), "Tool.PtMeasPar.Approach"), 10.0);
  const auto scan = scan_points(replies.at("00024"));
  ASSERT_TRUE(scan);
  ASSERT_EQ(scan->size(), 6U);
  EXPECT_NEAR((*scan)[0].head<2>().norm(), 23.0, 1e-4);
  EXPECT_FALSE(find_point(replies.at("00007")));
}

TEST(IppClientDialogue, FindsValuesInsideAMethodAndOverSeveralLines) {
  Reply reply;
  reply.data.push_back(*parse_response("00001 # GetProp(X(1), Y(2))"));
  reply.data.push_back(*parse_response("00001 # Z(3)"));
  EXPECT_EQ(*find_point(reply), Eigen::Vector3d(1, 2, 3));
}

TEST(IppClientDialogue, RefusesScanLinesThatAreNoGroupsOfThree) {
  for (const char* bad : {"00001 # 1,2", "00001 # 1,2,X(3)", "00001 # 1,2,3,4"}) {
    SCOPED_TRACE(bad);
    Reply reply;
    reply.data.push_back(*parse_response(bad));
    EXPECT_FALSE(scan_points(reply));
  }
}

}  // namespace
}  // namespace rondure::cmm::ipp::client
