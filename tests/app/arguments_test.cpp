#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/message.h"
#include "tests/app/files.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(Arguments, HelpOfEveryVerbShowsAnExample) {
  for (const char* verb : {"validate", "plan", "run", "fit", "report", "verify"}) {
    SCOPED_TRACE(verb);
    const Outcome outcome = rondure({verb, "--help"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_THAT(outcome.out, HasSubstr(std::string("Example: rondure ") + verb));
    EXPECT_THAT(outcome.err, IsEmpty());
  }
}

TEST(Arguments, HelpNamesEveryVerbAndTheExitStatus) {
  const Outcome outcome = rondure({"--help"});
  EXPECT_EQ(outcome.status, 0);
  for (const char* word : {"validate", "plan", "run", "fit", "report", "verify", "Exit status"}) {
    EXPECT_THAT(outcome.out, HasSubstr(word));
  }
}

TEST(Arguments, HelpVerbIsTheHelpOfThatVerb) {
  for (const std::vector<std::string>& verb :
       {std::vector<std::string>{}, {"run"}, {"fit", "roundness"}, {"help"}}) {
    std::vector<std::string> by_verb = {"help"};
    std::vector<std::string> by_flag = verb;
    by_verb.insert(by_verb.end(), verb.begin(), verb.end());
    by_flag.emplace_back("--help");
    const Outcome outcome = rondure(by_verb);
    EXPECT_EQ(outcome.status, 0);
    EXPECT_THAT(outcome.out, HasSubstr("--help"));
    if (verb != std::vector<std::string>{"help"}) {
      EXPECT_EQ(outcome.out, rondure(by_flag).out);
    }
  }
  const Outcome unknown = rondure({"help", "mesure"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err, HasSubstr("there is no verb mesure"));
}

/// The commands that the examples of all --help texts show: the manual page holds them all.
std::vector<std::vector<std::string>> examples_of_help() {
  std::string manual = rondure({"manual"}).out;
  manual.erase(0, manual.find(".SH VERBS"));
  for (std::size_t at = 0; (at = manual.find("\\-", at)) != std::string::npos; ++at)
    manual.erase(at, 1);
  std::vector<std::vector<std::string>> out;
  std::istringstream lines(manual);
  bool in_example = false;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
    std::string text = line.substr(indent);
    for (const std::string_view before : {"Example: ", "source <("})
      if (text.starts_with(before)) text.erase(0, before.size());
    const bool begins = text.starts_with("rondure ");
    in_example = begins || (in_example && indent >= 4 && text.starts_with("--"));
    if (!in_example) continue;
    if (begins) out.emplace_back();
    std::istringstream words(begins ? text.substr(text.find(' ')) : text);
    for (std::string word; words >> word && word != "|";) {
      if (word == "\\e") continue;  // the line goes on
      if (word.ends_with(')')) word.pop_back();
      out.back().push_back(word == "cmm.lab:1294" ? "127.0.0.1:1" : word);
    }
  }
  return out;
}

// Those that only compute are run; the others stand in an empty folder, where they are understood
// and then find no plan, no run or no machine.
TEST(Arguments, EveryExampleOfHelpIsUnderstood) {
  const Scratch folder;
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::create_directory(folder / "empty");
  for (const char* named : {"plans", "tests"})
    std::filesystem::create_directory_symlink(source_dir() / named, folder / named);
  const auto examples = examples_of_help();
  EXPECT_GE(examples.size(), 30U);
  for (const std::vector<std::string>& words : examples) {
    SCOPED_TRACE(::testing::PrintToString(words));
    const bool computes = words.front() == "fit" || words.front() == "validate";
    bool complete = computes;
    for (const std::string& word : words) {
      const bool ours = word.starts_with("plans/") || word.starts_with("tests/");
      EXPECT_TRUE(!ours || std::filesystem::exists(source_dir() / word)) << word;
      complete = complete && word.find("a1.csv") == std::string::npos;
    }
    std::filesystem::current_path(computes ? folder.path() : folder / "empty");
    const Outcome outcome = rondure(words);
    std::filesystem::current_path(before);
    EXPECT_THAT(outcome.err, ::testing::Not(HasSubstr("--help")));
    EXPECT_TRUE(!complete || outcome.status == 0) << outcome.err;
  }
}

TEST(Arguments, AMisspeltVerbOrOptionFindsItsWord) {
  EXPECT_THAT(rondure({"raport", "runs/7"}).err,
              HasSubstr("there is no verb raport; did you mean report?"));
  EXPECT_THAT(rondure({"run", "plan.json", "--serail", "7"}).err,
              HasSubstr("there is no option --serail; did you mean --serial?"));
  EXPECT_THAT(rondure({"fit", "roundness", "a.csv", "--cutof-upr=50"}).err,
              HasSubstr("there is no option --cutof-upr; did you mean --cutoff-upr?"));
  const std::string far = rondure({"run", "plan.json", "--colour"}).err;
  EXPECT_THAT(far, AllOf(HasSubstr("there is no option --colour\n"),
                         ::testing::Not(HasSubstr("did you mean"))));
}

TEST(Explain, KnowsEveryCodeAndSaysWhatToDo) {
  std::istringstream words(rondure({"explain"}).out);
  std::vector<std::string> names;
  for (std::string word; words >> word;) names.push_back(word);
  for (int i = 0; i <= static_cast<int>(core::kLastCode); ++i)
    EXPECT_THAT(names, ::testing::Contains(core::code_name(static_cast<core::Code>(i))));
  for (int i = 0; i <= static_cast<int>(core::kLastMessageCode); ++i)
    EXPECT_THAT(names, ::testing::Contains(core::message_name(static_cast<core::MessageCode>(i))));
  const Outcome one = rondure({"explain", "[no-touch]"});
  EXPECT_EQ(one.status, 0);
  EXPECT_THAT(one.out, AllOf(::testing::StartsWith("no-touch: The probe met nothing"),
                             HasSubstr("correct its place in the plan.\n")));
  const Outcome unknown = rondure({"explain", "no-toch"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err, HasSubstr("there is no code no-toch; did you mean no-touch?"));
}

// What `validate` names as not declared has its line, too.
TEST(Explain, KnowsTheInfluences) {
  const std::string names = rondure({"explain"}).out;
  const Scratch folder;
  write_plan(folder / "plan.json", {{"/uncertainty", {{"coverage_percent", 95}}}});
  std::string told = rondure({"validate", folder / "plan.json"}).out;
  told.erase(0, told.find("so in no interval: ") + 19);
  std::istringstream words(told);
  int known = 0;
  for (std::string word; words >> word; ++known) {
    if (word.ends_with(',')) word.pop_back();
    EXPECT_THAT(names, HasSubstr(word));
  }
  EXPECT_GT(known, 10) << told;
}

/// Collects the names of influences and the codes that a report prints.
void collect_names(const nlohmann::json& node, std::set<std::string>& out) {
  for (const char* list : {"budget", "influences", "warnings", "decisions", "gates"}) {
    if (!node.is_object() || !node.contains(list)) continue;
    for (const auto& item : node.at(list)) {
      for (const char* name : {"name", "influence", "code"}) {
        if (item.contains(name)) out.insert(item.at(name));
      }
    }
  }
  for (const auto& item : node) {
    if (item.is_structured()) collect_names(item, out);
  }
}

TEST(Explain, KnowsEveryNameOnThePagesOfTheExamples) {
  std::set<std::string> names;
  for (const auto& run : std::filesystem::directory_iterator(example_runs())) {
    if (!std::filesystem::exists(run.path() / "report.json")) continue;
    collect_names(nlohmann::json::parse(read(run.path() / "report.json")), names);
  }
  EXPECT_THAT(names, ::testing::IsSupersetOf({"probe-2-gain", "wheel-wear", "gauge-noise"}));
  for (const std::string& name : names) {
    EXPECT_EQ(rondure({"explain", name}).status, 0) << name;
  }
}

TEST(Arguments, WhatIsNotUnderstoodIsNamed) {
  const std::string plan = example("01_spool_simulated.json").string();
  struct Case {
    std::vector<std::string> arguments;
    std::string named;
  };
  const std::vector<Case> cases = {
      {{}, "a verb is missing"},
      {{"measure"}, "there is no verb measure"},
      {{"--colour"}, "a verb is missing"},
      {{"run"}, "PLAN is required"},
      {{"run", plan, "--colour"}, "--colour"},
      {{"run", plan, "again"}, "again"},
      {{"run", plan, "--format", "docx"}, "docx"},
      {{"run", plan, "--seed", "-1"}, "0 to 9007199254740991"},
      {{"run", plan, "--seed", "1.5"}, "0 to 9007199254740991"},
      {{"run", plan, "--seed", "9007199254740992"}, "0 to 9007199254740991"},
      {{"fit", "torus", "points.csv"}, "torus"},
      {{"fit", "circle"}, "FILE is required"},
      {{"fit", "circle", "points.csv", "--reference", "mx"}, "mx"},
      {{"fit", "line", "points.csv", "--reference", "mc"}, "a line has ls and mz"},
      {{"fit", "plane", "points.csv", "--reference", "mi"}, "a plane has ls and mz"},
      {{"fit", "cone", "points.csv", "--reference", "mc"}, "a cone has ls and mz"},
      {{"fit", "plane", "points.csv", "--size", "GG"}, "a plane has no size"},
      {{"fit", "cone", "points.csv", "--size", "GG"}, "a cone has a diameter at each height"},
      {{"fit", "sphere", "points.csv", "--size", "GG,LP"}, "LP needs sections"},
      {{"fit", "cylinder", "points.csv", "--size", "LS"}, "LS"},
      {{"fit", "cylinder", "points.csv", "--tip-diameter-mm", "2"}, "--size"},
      {{"fit", "cylinder", "points.csv", "--inside"}, "--inside"},
      {{"fit", "cylinder", "points.csv", "--size", "GG", "--tip-diameter-mm", "-2"}, "below 0"},
      {{"fit", "cylinder", "points.csv", "--size", "GG", "--tip-diameter-mm", "nan"}, "nan"},
      {{"fit", "sphere", "points.csv", "--outward", "0,0,1"}, "only a plane"},
      {{"fit", "plane", "points.csv", "--outward", "0,1"}, "--outward"},
      {{"verify"}, "RUN_DIR is required"},
      {{"report", "run", "--format", "html,doc"}, "doc"},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(::testing::PrintToString(c.arguments));
    const Outcome outcome = rondure(c.arguments);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, HasSubstr(c.named));
    EXPECT_THAT(outcome.err, HasSubstr("--help"));
    EXPECT_THAT(outcome.out, IsEmpty());
  }
}

TEST(Arguments, ThePlanMayFollowTheFormats) {
  const Scratch folder;
  auto plan = example_plan("09_axle_points_file");
  leave_out_intervals(plan);
  write(folder / "plan.json", plan.dump());
  const Outcome outcome =
      rondure({"run", "--out", folder / "run", "--format", "html,csv", folder / "plan.json"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(names_in(folder / "run"),
              ::testing::ElementsAre("SHA256SUMS", "journal.db", "report.html", "results.csv",
                                     "touches.csv"));
}

TEST(Arguments, ANameThatNoReportCanShowIsRefused) {
  const Scratch folder;
  for (const std::string& option : {std::string("--serial"), std::string("--operator"),
                                    std::string("--order"), std::string("--customer")}) {
    for (const std::string name : {"S\uFFFE", "S\uFDD0", "S\x1b[2J", "S\u009b2J", "S\xff"}) {
      const Outcome outcome = rondure(
          {"run", example("09_axle_points_file.json"), "--out", folder / "run", option, name});
      EXPECT_EQ(outcome.status, 2) << name;
      EXPECT_THAT(outcome.err, AllOf(HasSubstr(option), HasSubstr("which no report can show")));
      EXPECT_FALSE(std::filesystem::exists(folder / "run"));
    }
  }
}

// Page one shows both in a line: what breaks or reorders it is refused, with its code point.
TEST(Arguments, AnOrderOrCustomerOfManyOrReorderedWordsIsRefused) {
  const Scratch folder;
  const std::string run = folder / "run";
  const auto told = [&](const std::string& option, const std::string& name) {
    const Outcome outcome =
        rondure({"run", example("09_axle_points_file.json"), "--out", run, option, name});
    EXPECT_EQ(outcome.status, 2) << name;
    EXPECT_FALSE(std::filesystem::exists(run));
    return outcome.err;
  };
  for (const std::string option : {"--order", "--customer"}) {
    EXPECT_THAT(told(option, "A\u202EB"),
                AllOf(HasSubstr(option), HasSubstr("contains the character U+202E")));
    EXPECT_THAT(told(option, "A\u2066B"), HasSubstr("U+2066"));
    EXPECT_THAT(told(option, "A\nB"), HasSubstr("U+000A"));
    EXPECT_THAT(told(option, "A\tB"), HasSubstr("U+0009"));
    EXPECT_THAT(told(option, std::string(201, 'x')),
                HasSubstr("has 201 characters, the limit is 200; shorten it"));
  }
}

/// Whether a terminal would obey something in a text.
bool holds_controls(const std::string& text) {
  return std::any_of(text.begin(), text.end(),
                     [](unsigned char c) { return c == 0x7F || (c < 0x20 && c != '\n'); }) ||
         text.find("\xC2\x9B") != std::string::npos;
}

TEST(Arguments, FilesAndWordsRuleNoTerminal) {
  const Scratch folder;
  const std::string evil = "e\x1b[2J\u009b31m\x07\nequal: all";
  write(folder / "bad.json", "{\"a\": \x1b[2J}");
  write(folder / "bad.csv", "x,y\n1,2\n\x1b[2J,\u009b4\n");
  write(folder / (evil + ".json"), "{");
  const std::string run = folder / evil;
  ASSERT_EQ(run_without_intervals("09_axle_points_file", {"--out", run, "--quiet"}).err, "");
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{evil},
        {"run", "--" + evil},
        {"validate", folder / (evil + ".json")},
        {"validate", folder / evil / "absent.json"},
        {"validate", folder / "bad.json"},
        {"fit", "circle", folder / "bad.csv"},
        {"fit", "circle", evil},
        {"fit", "circle", folder / "bad.csv", "--reference", evil},
        {"report", run, "--format", "json"},
        {"run", run, "--resume", "--archive", "none"},
        {"run", example("09_axle_points_file.json"), "--out", run},
        {"verify", run},
        {"verify", evil},
        {"history", evil},
        {"history", evil + "://h/d"}}) {
    const Outcome outcome = rondure(words);
    EXPECT_FALSE(holds_controls(outcome.out)) << words.front() << outcome.out;
    EXPECT_FALSE(holds_controls(outcome.err)) << words.front() << outcome.err;
    EXPECT_EQ(("\n" + outcome.out + "\n" + outcome.err).find("\nequal: all"), std::string::npos)
        << words.front() << outcome.out << outcome.err;
  }
}

TEST(Arguments, APipeIsRefusedAndNotWaitedFor) {
  const Scratch folder;
  const std::string run = folder / "run";
  ASSERT_EQ(run_without_intervals("09_axle_points_file", {"--out", run, "--quiet"}).err, "");
  const std::string pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const std::vector<std::string> key = {"sign", run, "--key", pipe};
  for (const std::vector<std::string>& words : {std::vector<std::string>{"fit", "circle", pipe},
                                                {"fit", "roundness", pipe},
                                                {"validate", pipe},
                                                {"run", pipe},
                                                {"verify", run, "--key", pipe},
                                                key,
                                                {"history", pipe}}) {
    const Outcome outcome = rondure(words);
    EXPECT_EQ(outcome.status, 2) << words.front() << words[1];
    EXPECT_NE(outcome.err, "") << words.front();
  }
  for (const char* name : {"SHA256SUMS", "report.json", "journal.db-wal", "journal.db"}) {
    std::filesystem::remove(folder / "run" / name);
    ASSERT_EQ(::mkfifo((folder / "run" / name).c_str(), 0600), 0);
    const Outcome outcome = rondure({"verify", run});
    EXPECT_NE(outcome.status, 0) << name;
    EXPECT_THAT(outcome.out + outcome.err, HasSubstr(name));
    std::filesystem::remove(folder / "run" / name);
  }
}

TEST(Arguments, WhatIsNoPlanIsRefusedInOneSentence) {
  const Scratch folder;
  write(folder / "empty.json", "");
  for (const std::string& plan :
       {(folder / "empty.json").string(), folder.path().string(), (folder / "absent.json").string(),
        std::string("/dev/zero"), std::string()}) {
    SCOPED_TRACE(plan);
    const Outcome outcome = rondure({"run", plan, "--out", folder / "run"});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "run"));
  }
}

}  // namespace
}  // namespace rondure::app::testing
