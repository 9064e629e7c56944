// Faults on the wire: one damaged transaction in a run with a machine behind I++ DME. Each run ends
// with the touches and the result of an undisturbed one, or stops and comes to them when it is
// resumed. RONDURE_FULL=all runs them all, RONDURE_FULL=1 a third; else every twentieth or so.

#include <algorithm>
#include <cctype>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/cutting_proxy.h"
#include "tests/app/files.h"
#include "tests/app/program.h"
#include "tests/core/full.h"

namespace rondure::app::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Lines = std::vector<Passed>;

constexpr double kAnswerLimit_s = 2.0;  // of the plan
constexpr int kTooLate_ms = 2600;       // beyond it, what the speeds of motions add included
constexpr auto kLongestRun = std::chrono::seconds(300);

Passed whole(const std::string& line) { return {line + "\r\n"}; }
Passed cut(const std::string& bytes) { return {bytes, 0, true}; }
char kind_of(const std::string& line) { return line.size() > 6 ? line[6] : ' '; }
std::string tag_of(const std::string& line) { return line.substr(0, 5); }

/// A kind of fault. The functions get each line of the transaction.
struct FaultKind {
  std::string name;
  bool of_data = false;  ///< Needs a command that is answered with data.
  std::function<WireFault::Damage()> to_client;
  WireFault::Damage to_server;
};

/// Damages the lines of one kind (& # %) only.
std::function<WireFault::Damage()> of(char kind, std::function<Lines(const std::string&)> damage) {
  return [kind, damage] {
    return [kind, damage](const std::string& line) {
      return kind_of(line) == kind ? damage(line) : Lines{whole(line)};
    };
  };
}

/// Keeps the lines of one kind back until the line of another one has passed.
std::function<WireFault::Damage()> behind(char late, char early) {
  return [late, early] {
    const auto kept = std::make_shared<std::string>();
    return [late, early, kept](const std::string& line) -> Lines {
      if (kind_of(line) == late) {
        *kept = line;
        return {};
      }
      if (kind_of(line) != early) return {whole(line)};
      return {whole(line), whole(*kept)};
    };
  };
}

/// An error before the end, in place of data.
FaultKind error(const std::string& text) {
  return {"error " + text,
          false,
          [text] {
            return [text](const std::string& line) -> Lines {
              if (kind_of(line) == '#') return {};
              if (kind_of(line) != '%') return {whole(line)};
              return {whole(tag_of(line) + " ! " + text), whole(line)};
            };
          },
          {}};
}

/// A line of somebody else between & and the end.
FaultKind between(const std::string& other) {
  return {"between: " + other,
          false,
          of('&',
             [other](const std::string& line) {
               return Lines{whole(line), whole(other)};
             }),
          {}};
}

/// Something in place of &.
FaultKind instead(const std::string& name, std::function<std::string(const std::string&)> bytes) {
  return {"instead of &: " + name,
          false,
          of('&', [bytes](const std::string& line) { return Lines{{bytes(line)}}; }),
          {}};
}

/// The data changed.
FaultKind data(const std::string& name, std::function<std::string(std::string)> change) {
  return {"data: " + name,
          true,
          of('#',
             [change](const std::string& line) {
               return Lines{whole(tag_of(line) + " # " +
                                  change(line.substr(std::min<std::size_t>(8, line.size()))))};
             }),
          {}};
}

FaultKind command(const std::string& name, WireFault::Damage damage) {
  return {"command: " + name, false, {}, std::move(damage)};
}

std::string with_tag(const std::string& line, const std::string& tag) {
  return tag + line.substr(std::min<std::size_t>(5, line.size()));
}

std::string numbers_replaced(std::string text, const std::string& by) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const auto number = [&](std::size_t at) {
      return at < text.size() && (std::isdigit(static_cast<unsigned char>(text[at])) != 0 ||
                                  text[at] == '.' || text[at] == '-');
    };
    if (!number(i)) {
      out += text[i++];
      continue;
    }
    while (number(i)) ++i;
    out += by;
  }
  return out;
}

std::vector<FaultKind> cuts_and_silence() {
  const auto nothing = [](const std::string&) { return Lines{}; };
  const auto closed = [](const std::string&) { return Lines{cut("")}; };
  const auto half = [](const std::string& line) {
    return Lines{cut(line.substr(0, line.size() / 2))};
  };
  const auto then_cut = [](const std::string& line) { return Lines{cut(line + "\r\n")}; };
  return {
      {"closed before &", false, of('&', closed), {}},
      {"closed behind &", false, of('&', then_cut), {}},
      {"closed in the middle of &", false, of('&', half), {}},
      {"closed before %", false, of('%', closed), {}},
      {"closed behind %", false, of('%', then_cut), {}},
      {"closed in the middle of %", false, of('%', half), {}},
      {"closed behind the data", true, of('#', then_cut), {}},
      {"closed in the middle of the data", true, of('#', half), {}},
      {"& is missing", false, of('&', nothing), {}},
      {"% is missing", false, of('%', nothing), {}},
      {"data are missing", true, of('#', nothing), {}},
      {"no answer at all", false, [nothing] { return WireFault::Damage(nothing); }, {}},
      command("lost", nothing),
      command("closed instead", closed),
      command(
          "half of it",
          [](const std::string& line) { return Lines{whole(line.substr(0, line.size() / 2))}; }),
      command("half of it, then closed", half),
      command("without CR", [](const std::string& line) { return Lines{{line + "\n"}}; }),
      command("another tag",
              [](const std::string& line) { return Lines{whole(with_tag(line, "99998"))}; }),
      command("no tag", [](const std::string& line) { return Lines{whole(line.substr(6))}; }),
      command("a byte beyond ASCII",
              [](const std::string& line) { return Lines{whole(line + "\xff")}; }),
      command("another method",
              [](const std::string& line) { return Lines{whole(tag_of(line) + " FooBar()")}; }),
  };
}

std::vector<FaultKind> order_and_time() {
  const auto twice = [](const std::string& line) { return Lines{whole(line), whole(line)}; };
  const auto late = [](int wait_ms) {
    return [wait_ms](const std::string& line) { return Lines{{line + "\r\n", wait_ms}}; };
  };
  const auto by_bytes = [](const std::string& line) {
    Lines out;
    for (const char c : line + "\r\n") out.push_back({std::string(1, c), 5});
    return out;
  };
  return {
      {"& twice", false, of('&', twice), {}},
      {"% twice", false, of('%', twice), {}},
      {"data twice", true, of('#', twice), {}},
      {"% before &", false, behind('&', '%'), {}},
      {"data before &", true, behind('&', '#'), {}},
      {"% before the data", true, behind('#', '%'), {}},
      {"the answer once more",
       false,
       of('%',
          [](const std::string& line) {
            return Lines{whole(line), whole(tag_of(line) + " &"), whole(line)};
          }),
       {}},
      {"& late", false, of('&', late(150)), {}},
      {"% late", false, of('%', late(150)), {}},
      {"data late", true, of('#', late(150)), {}},
      {"& too late", false, of('&', late(kTooLate_ms)), {}},
      {"% too late", false, of('%', late(kTooLate_ms)), {}},
      {"& byte by byte", false, of('&', by_bytes), {}},
      {"% byte by byte", false, of('%', by_bytes), {}},
  };
}

std::vector<FaultKind> tags() {
  const auto tagged = [](const std::string& tag) {
    return [tag](const std::string& line) { return Lines{whole(with_tag(line, tag))}; };
  };
  std::vector<FaultKind> out;
  for (const char* tag : {"00000", "99997", "E0042", "E0000", "0012", "000012", "abcde"}) {
    out.push_back({fmt::format("& with tag {}", tag), false, of('&', tagged(tag)), {}});
    out.push_back({fmt::format("% with tag {}", tag), false, of('%', tagged(tag)), {}});
    out.push_back({fmt::format("data with tag {}", tag), true, of('#', tagged(tag)), {}});
  }
  return out;
}

std::vector<FaultKind> errors() {
  std::vector<FaultKind> out;
  for (const char* text :
       {"Error(3, 0500, \"x\", \"Emergency stop\")", "Error(9, 0503, \"x\", \"Controller\")",
        "Error(2, 0514, \"x\", \"Use ClearAllErrors to continue\")",
        "Error(3, 1000, \"x\", \"Machine in error state\")", "Error(2, 0006, \"x\", \"Aborted\")",
        "Error(3, 0511, \"x\", \"Error processing method\")",
        "Error(3, 1500, \"x\", \"Failed to re-seat head\")", "Error(3, 2504, \"x\", \"Collision\")",
        "Error(9, 2503, \"x\", \"Scale read head\")", "Error(3, 1009, \"x\", \"Air pressure\")",
        "Error(3, 1501, \"x\", \"Probe not armed\")", "Error(3, 8123, \"x\", \"of the maker\")",
        "Error(3, 500, x, Emergency stop)", "Error()", "Error(3)", "Emergency stop", ""}) {
    out.push_back(error(text));
  }
  return out;
}

std::vector<FaultKind> strangers() {
  std::vector<FaultKind> out;
  for (const char* other :
       {"E0000 ! Error(0, 0000, \"\", \"Buffer full\")",
        "E0000 ! Error(1, 0504, \"\", \"Argument out of range\")", "E0000 # KeyPress(\"F1\")",
        "E0000 # X(99), Y(99), Z(99)", "E0007 # X(99), Y(99), Z(99)", "99996 # X(98), Y(98), Z(98)",
        "99996 ! Error(3, 0500, \"\", \"Emergency stop\")", "99996 %", "E0000 &", "E0000 %",
        "E0000 ! Error(9, 0503, \"\", \"Controller communications failure\")",
        "E0000 ! Error(3, 0500, \"\", \"Emergency stop\")"}) {
    out.push_back(between(other));
  }
  return out;
}

std::vector<FaultKind> garbage() {
  return {
      instead("another protocol",
              [](const std::string&) { return "HTTP/1.1 400 Bad Request\r\n\r\n"; }),
      instead("an empty line", [](const std::string&) { return "\r\n"; }),
      instead("an empty line before it",
              [](const std::string& line) { return "\r\n" + line + "\r\n"; }),
      instead("70 000 characters",
              [](const std::string&) { return std::string(70'000, 'x') + "\r\n"; }),
      instead("2 MB without an end",
              [](const std::string&) { return std::string(2'000'000, 'x'); }),
      instead("a byte beyond ASCII", [](const std::string& line) { return line + "\xff\r\n"; }),
      instead("a zero byte",
              [](const std::string& line) { return line + std::string(1, '\0') + "\r\n"; }),
      instead("a tab", [](const std::string& line) { return tag_of(line) + "\t&\r\n"; }),
      instead("LF alone", [](const std::string& line) { return line + "\n"; }),
      instead("CR alone", [](const std::string& line) { return line + "\r"; }),
      instead("no space", [](const std::string& line) { return tag_of(line) + "&\r\n"; }),
      instead("a word", [](const std::string& line) { return tag_of(line) + " ok\r\n"; }),
      instead("another character", [](const std::string& line) { return tag_of(line) + " ?\r\n"; }),
      instead("text behind it", [](const std::string& line) { return line + " yes\r\n"; }),
      instead("two lines in one",
              [](const std::string& line) { return line + " " + line + "\r\n"; }),
      data("nothing", [](const std::string&) { return ""; }),
      data("half", [](const std::string& text) { return text.substr(0, text.size() / 2); }),
      data("no last parenthesis",
           [](std::string text) {
             text.pop_back();
             return text;
           }),
      data("words for numbers",
           [](const std::string& text) { return numbers_replaced(text, "abc"); }),
      data("1e999", [](const std::string& text) { return numbers_replaced(text, "1e999"); }),
      data("nan", [](const std::string& text) { return numbers_replaced(text, "nan"); }),
      data("strings for numbers",
           [](const std::string& text) { return numbers_replaced(text, "\"1\""); }),
      data("no numbers", [](const std::string& text) { return numbers_replaced(text, ""); }),
      data("lower case",
           [](std::string text) {
             std::transform(text.begin(), text.end(), text.begin(),
                            [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
             return text;
           }),
      data("something more", [](const std::string& text) { return text + ", Foo(1)"; }),
      data("XML", [](const std::string&) { return "<a b=\"1\"/>"; }),
  };
}

std::vector<FaultKind> versions() {
  std::vector<FaultKind> out;
  for (const char* text : {"DMEVersion(\"3.0\")", "DMEVersion(\"2.5\")", "DMEVersion(\"1.4.3\")",
                           "DMEVersion(1.4)", "\"1.4\"", "DMEVersion()", "DMEVersion(\"one\")",
                           "DMEVersion(\" 1.4\")", "1.4.3", "Version(\"1\")"}) {
    out.push_back(data(text, [text](const std::string&) { return text; }));
  }
  return out;
}

/// A command of a run, and whether it is answered with data.
struct Target {
  std::string command;
  int occurrence;
  bool has_data;
};

const std::vector<Target>& targets() {
  static const std::vector<Target> kTargets = {{"EndSession", 1, false},
                                               {"StartSession", 1, false},
                                               {"GetErrStatusE", 1, true},
                                               {"GetDMEVersion", 1, true},
                                               {"GetMachineClass", 1, true},
                                               {"SetCoordSystem", 1, false},
                                               {"EnumTools", 1, true},
                                               {"OnPtMeasReport", 1, false},
                                               {"GetProp(Tool.Name", 1, true},
                                               {"IsHomed", 1, true},
                                               {"Get(", 1, true},
                                               {"Home", 1, false},
                                               {"GetProp(Tool.AvrRadius", 1, true},
                                               {"SetProp(Tool", 1, false},
                                               {"GoTo", 1, false},
                                               {"PtMeas", 1, true},
                                               {"AlignPart", 1, true},
                                               {"GoTo", 12, false},
                                               {"PtMeas", 9, true},
                                               {"AlignPart", 2, true},
                                               {"PtMeas", 20, true}};
  return kTargets;
}

struct FaultCase {
  FaultKind kind;
  Target target;
};

/// Each kind at a third of the commands that it fits, another third for the next kind.
std::vector<FaultCase> fault_cases_of(const std::vector<FaultKind>& kinds,
                                      const std::string& only = {}) {
  std::vector<FaultCase> out;
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    for (std::size_t t = 0; t < targets().size(); ++t) {
      const Target& target = targets()[t];
      if (!only.empty() ? target.command != only : (k + t) % 3 != 0) continue;
      if (kinds[k].of_data && !target.has_data) continue;
      out.push_back({kinds[k], target});
    }
  }
  return out;
}

/// The example with a small plan: 3 layers of 5 points in at most 3 poses.
void write_small_plan(const fs::path& file, std::uint16_t port) {
  json plan = json::parse(read(example("02_spool_over_ippdme.json")));
  plan["machine"]["port"] = port;
  plan["machine"]["answer_limit_s"] = kAnswerLimit_s;
  plan["machine"]["motion_limit_s"] = kAnswerLimit_s;
  plan["machine"]["touch_speed_mm_s"] = 50;  // the limit of a motion grows with its time
  plan["features"][0]["sampling"]["layers"] = 3;
  plan["features"][0]["sampling"]["points_per_layer"] = 5;
  plan["features"][0]["pose_search"] = {{"strategy", "guided"}, {"max_poses", 3}, {"repeats", 1}};
  plan["probe"]["qualification"]["points"] = 7;
  plan["reports"]["formats"] = {"json"};
  plan.erase("uncertainty");
  plan["decision_rule"] = {{"rule", "simple-acceptance"}};
  write(file, plan.dump(2));
}

/// A run that must end in time.
Outcome run_in_time(const std::vector<std::string>& arguments) {
  Program program(arguments);
  const auto deadline = std::chrono::steady_clock::now() + kLongestRun;
  while (!program.ended()) {
    if (std::chrono::steady_clock::now() > deadline) {
      ADD_FAILURE() << "the run hangs: " << program.told();
      program.send(SIGKILL);
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return program.wait();
}

/// The world, the proxy before it, and what an undisturbed run gives.
class FaultyWire : public ::testing::Test {
 protected:
  FaultyWire() : server_port_(free_port()), proxy_(server_port_) {
    start_server();
    write_small_plan(folder_ / "plan.json", proxy_.port());
    const Outcome whole = run_in_time(arguments("whole"));
    EXPECT_EQ(whole.status, 0) << whole.err;
    whole_ = journal_of(folder_ / "whole");
    result_ = result_of("whole");
  }

  /// A machine that is not homed, in place of the one that was.
  void start_server() {
    server_.reset();
    server_ = std::make_unique<Program>(
        std::vector<std::string>{"simulate-cmm", example("02_spool_over_ippdme.json"), "--port",
                                 std::to_string(server_port_), "--speed", "inf"});
    EXPECT_TRUE(wait_for_port(server_port_));
  }

  std::vector<std::string> arguments(const std::string& name) const {
    return {"run", folder_ / "plan.json", "--out", folder_ / name, "--archive", "none"};
  }

  double result_of(const std::string& name) const {
    return json::parse(read(folder_ / name / "report.json"))
        .at("/features/0/mz/deviation_um"_json_pointer);
  }

  void expect_the_same(const std::string& name) const {
    const record::RunRecord run = journal_of(folder_ / name);
    ASSERT_EQ(run.touches.size(), whole_.touches.size());
    for (std::size_t i = 0; i < run.touches.size(); ++i) {
      ASSERT_EQ(run.touches[i].tip_mm, whole_.touches[i].tip_mm) << "touch " << i;
      ASSERT_EQ(run.touches[i].temperature_degC, whole_.touches[i].temperature_degC);
    }
    EXPECT_EQ(result_of(name), result_);
  }

  /// Runs one fault to its end; whether the run had to be resumed.
  bool meet(const FaultCase& fault, const std::string& name) {
    if (fault.target.command == "Home") start_server();
    proxy_.damage({fault.target.command, fault.target.occurrence, fault.kind.to_server,
                   fault.kind.to_client ? fault.kind.to_client() : WireFault::Damage{}});
    const Outcome first = run_in_time(arguments(name));
    EXPECT_TRUE(proxy_.fault_met());
    if (first.status == 0) {
      expect_the_same(name);
      return false;
    }
    EXPECT_EQ(first.status, 3) << first.err;
    EXPECT_THAT(first.err, ::testing::HasSubstr("rondure: "));
    auto again = arguments(name);
    again.emplace_back("--resume");
    const Outcome second = run_in_time(again);
    EXPECT_EQ(second.status, 0) << first.err << second.err;
    if (second.status == 0) expect_the_same(name);
    return true;
  }

  void meet_all(const std::vector<FaultCase>& cases) {
    const auto step =
        static_cast<std::size_t>(test::cases(static_cast<int>(cases.size() / 3), 3, 1));
    std::size_t met = 0;
    std::size_t resumed = 0;
    for (std::size_t i = 0; i < cases.size(); i += step) {
      const std::string text = fmt::format("{} at {} {}", cases[i].kind.name,
                                           cases[i].target.command, cases[i].target.occurrence);
      SCOPED_TRACE(text);
      const std::string name = fmt::format("run{}", i);
      if (meet(cases[i], name)) ++resumed;
      ++met;
      fs::remove_all(folder_ / name);
    }
    std::printf("%zu of %zu faults: %zu went on, %zu stopped and were resumed\n", met, cases.size(),
                met - resumed, resumed);
  }

 private:
  Scratch folder_;
  std::uint16_t server_port_;
  std::unique_ptr<Program> server_;
  CuttingProxy proxy_;
  record::RunRecord whole_;
  double result_ = 0.0;
};

TEST_F(FaultyWire, ACutOrASilenceStopsTheRunAndItComesToTheSameResult) {
  meet_all(fault_cases_of(cuts_and_silence()));
}

TEST_F(FaultyWire, LinesTwiceSwappedOrLateChangeNoResult) {
  meet_all(fault_cases_of(order_and_time()));
}

TEST_F(FaultyWire, LinesWithAnotherTagAreNeverTakenForAnAnswer) {
  meet_all(fault_cases_of(tags()));
}

TEST_F(FaultyWire, AnErrorAtAnyCommandStopsTheRunAndItComesToTheSameResult) {
  meet_all(fault_cases_of(errors()));
}

TEST_F(FaultyWire, LinesOfOthersChangeNoResult) { meet_all(fault_cases_of(strangers())); }

TEST_F(FaultyWire, GarbageStopsTheRunAndItComesToTheSameResult) {
  meet_all(fault_cases_of(garbage()));
}

TEST_F(FaultyWire, OddVersionsAreReadOrRefused) {
  meet_all(fault_cases_of(versions(), "GetDMEVersion"));
}

}  // namespace
}  // namespace rondure::app::testing
