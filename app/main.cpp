#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <functional>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/command_documents.h"
#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "app/verbs/word_option.h"
#include "cmm/ipp_server/profile.h"
#include "core/numbers.h"
#include "core/version.h"
#include "plans/key_spec.h"
#include "plans/schema/simulation_table.h"
#include "reports/formats/exports.h"
#include "reports/words/language.h"

namespace rondure::app {
namespace {

constexpr const char* kExits =
    "\nExit status: run, report: 0 all conform, 1 finished but something does not conform, is\n"
    "undecided or void, 2 bad input, 3 machine, fixture or run failed (go on with run --resume).\n"
    "verify: 0 equal, 1 not equal, 2 unreadable. Others: 0 or 2.";

/// "--format html,json": one argument, so that the plan may follow it.
void add_formats(CLI::App& verb, std::vector<std::string>& formats, const char* meaning) {
  verb.add_option("--format", formats, meaning)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(reports::all_formats()))
      ->type_name("LIST");
}

void add_edition(CLI::App& verb, std::string& language, bool& detail, bool& verbose) {
  verb.add_flag("--verbose", verbose,
                "On the terminal all details: every feature, warnings, settings, files");
  verb.add_flag("--detail", detail,
                "Open all of the page, on paper too: call-outs that conform, numbers, searches");
  verb.add_option("--lang", language, "Language of page and terminal: en or zh (default: en)")
      ->check(CLI::IsMember(reports::language_names()))
      ->type_name("LANG");
}

void add_paper(CLI::App& verb, std::optional<record::Paper>& paper) {
  add_words<record::Paper>(verb, "--paper", paper,
                           "Paper of report.pdf: a4 or letter (default: as the plan says, else a4)")
      ->type_name("PAPER");
}

/// Accepts a whole number that every reader of JSON preserves, as in a plan.
std::string check_seed(const std::string& text) {
  const bool digits = !text.empty() && text.size() <= 16 &&
                      text.find_first_not_of("0123456789") == std::string::npos;
  if (digits && std::stod(text) <= plans::kMaxSeed) return {};
  return fmt::format("{} is not a whole number from 0 to {:.0f}", text, plans::kMaxSeed);
}

/// Accepts a number in a range; NaN is outside every range.
std::function<std::string(const std::string&)> number_from(double low, double high) {
  return [low, high](const std::string& text) {
    const auto number = core::parse_number(text);
    if (number && *number >= low && *number <= high) return std::string();
    return fmt::format("{} is no number from {} to {}", text, low, high);
  };
}

/// Accepts the factor by which time passes faster than on a machine.
std::string check_factor(const std::string& text) { return number_from(1e-3, 1e6)(text); }

/// Accepts the factor by which a simulation runs faster than a real machine; "inf": without
/// waiting.
std::string check_speed(const std::string& text) {
  return text == "inf" ? std::string() : check_factor(text);
}

void add_validate(CLI::App& app, ValidateArguments& arguments) {
  auto* verb = app.add_subcommand("validate", "Checks a plan: every problem, one a line");
  verb->add_option("PLAN", arguments.plan, "Plan file (JSON)")->required();
  verb->footer("\nExample: rondure validate plans/examples/01_spool_simulated.json");
}

void add_plan(CLI::App& app, PlanArguments& arguments) {
  auto* verb = app.add_subcommand(
      "plan", "What a run would do: poses, touches, path, time, reach, uncertainty; nothing moves");
  verb->add_option("PLAN", arguments.plan, "Plan file (JSON)")->required();
  verb->add_flag("--json", arguments.json, "JSON instead of text");
  verb->add_option("--svg", arguments.svg, "Draws the way of the tip: side and top view")
      ->type_name("FILE");
  verb->add_option("--feature", arguments.feature,
                   "Feature to draw (default: the first that is touched)")
      ->type_name("ID");
  verb->add_option("--target-U", arguments.target_expanded,
                   "Cheapest sampling with U of at most this, as 1um, 500nm")
      ->type_name("LENGTH");
  verb->footer(
      "\nExample: rondure plan plans/examples/01_spool_simulated.json --svg path.svg\n"
      "         rondure plan plans/examples/01_spool_simulated.json --target-U 1um\n"
      "With a section \"uncertainty\" the intervals of CYLt and RONt are predicted: what the run\n"
      "would state, for parts of the declared form. --target-U tries layers, points and repeats,\n"
      "tells time and U of each, and what to change in the plan; exit status 2 when none meets "
      "it.\n"
      "The run follows the same path. Targets out of reach are named with the reason and what "
      "would\nhelp; then the exit status is 2. More: docs/planning.md");
}

/// Accepts a port, or "auto": any free one.
std::string check_port(const std::string& text) {
  const auto port = core::parse_number(text);
  const bool whole = port && *port >= 1.0 && *port <= 65535.0 && *port == std::floor(*port);
  return text == "auto" || whole ? std::string()
                                 : fmt::format("{} is no port from 1 to 65535", text);
}

void add_watching(CLI::App& verb, RunArguments& arguments) {
  auto* watch = verb.add_flag("--watch{auto}", arguments.watch,
                              "Serves a page on this computer that shows the run while it is\n"
                              "measured, and prints its address; --watch=PORT chooses the port");
  watch->check(check_port);
  verb.add_flag("--control", arguments.control, "With --watch: the page has a stop button")
      ->needs(watch);
  verb.add_option("--speed", arguments.speed,
                  "Of a simulated machine: seconds of its clock in one second (default: no\n"
                  "waiting), to watch a simulated run; the result is the same")
      ->check(check_factor)
      ->type_name("FACTOR");
}

void add_run(CLI::App& app, RunArguments& arguments) {
  auto* verb = app.add_subcommand("run", "Executes a plan and writes its reports");
  verb->add_option("PLAN", arguments.plan, "Plan file (JSON); with --resume also a run directory")
      ->required();
  verb->add_option("--out", arguments.out,
                   "Run directory, absent or empty (default: runs/<plan>-<UTC>)");
  verb->add_flag("--resume", arguments.resume,
                 "Resumes the run in that directory after its last touch");
  verb->add_flag("--relocate", arguments.relocate,
                 "With --resume: a part that has moved is located again, and its present cloud\n"
                 "measured anew")
      ->needs("--resume");
  verb->add_option("--serial", arguments.serial, "Serial number of the part");
  verb->add_option("--operator", arguments.operator_name, "Who measures");
  verb->add_option("--order", arguments.order, "Order that the run belongs to");
  verb->add_option("--customer", arguments.customer, "For whom the part is inspected");
  verb->add_option("--seed", arguments.seed, "Seed of the simulation, in place of the plan's")
      ->check(check_seed);
  add_formats(*verb, arguments.formats,
              "html,pdf,json,csv,qif,dmis,corrections (default: as the plan says)");
  add_edition(*verb, arguments.language, arguments.detail, arguments.verbose);
  add_paper(*verb, arguments.paper);
  verb->add_option("--archive", arguments.archive,
                   "Where the results are kept besides: a file, postgresql://... or none\n"
                   "(default: as the plan says, else archive.db beside the run directory)");
  verb->add_option("--wire-log", arguments.wire_log,
                   "File for every line to and from a machine behind I++ DME");
  verb->add_flag("--quiet", arguments.quiet, "No progress, no answer on the terminal");
  verb->add_flag("--step", arguments.step,
                 "First run: slow, each move confirmed on the terminal (Enter go, c continue\n"
                 "without asking, q stop in order)");
  add_watching(*verb, arguments);
  verb->footer(
      std::string("\nExample: rondure run plans/examples/01_spool_simulated.json --serial "
                  "0042 --operator mk\n"
                  "Ctrl-C stops after the present touch and retracts; a second one ends the "
                  "program at once.\n"
                  "What was measured is kept in every case, also when the power fails.\n"
                  "\nTo watch it in a browser: rondure run plan.json --watch (docs/live.md); a "
                  "simulated run:\n"
                  "  rondure run plans/examples/01_spool_simulated.json --watch --control --speed "
                  "20\n"
                  "\nTo go on with a run that was interrupted, stopped or failed:\n"
                  "  rondure run runs/01_spool_simulated-20261121T023302Z --resume\n"
                  "or with its plan, which must not have changed:\n"
                  "  rondure run plan.json --out runs/7 --resume\n"
                  "(where runs/7 does not exist yet the run begins there). Machine and "
                  "fixture are homed again and the\n"
                  "last touches repeated: when one differs by more than the plan's "
                  "resume_limit_um, part or machine\n"
                  "has moved and the run must start again. Before you resume, see that "
                  "the way up is free for the tip.\n"
                  "More: docs/reliability.md\n") +
      kExits);
}

void add_simulate_cmm(CLI::App& app, SimulateCmmArguments& arguments) {
  auto* verb = app.add_subcommand(
      "simulate-cmm",
      "Serves the virtual machine of a plan over I++ DME, for one client at a time");
  verb->add_option("PLAN", arguments.plan, "Plan file (JSON) with a simulation")->required();
  verb->add_option("--port", arguments.port, "TCP port (default: 1294); 0: any free one");
  verb->add_option("--listen", arguments.address,
                   "Address to listen at (default: 127.0.0.1, this computer only)")
      ->type_name("ADDRESS");
  verb->add_option("--speed", arguments.speed,
                   "How much faster than a real machine (default: 1); inf: motions take no time")
      ->check(check_speed)
      ->type_name("FACTOR");
  verb->add_option("--seed", arguments.seed, "Seed of the simulation, in place of the plan's")
      ->check(check_seed);
  std::vector<std::string> profiles;
  for (const auto& profile : cmm::ipp::profiles()) profiles.emplace_back(profile.name);
  verb->add_option("--profile", arguments.profile,
                   "How it answers: as other servers do too (default: as-specified)")
      ->check(CLI::IsMember(profiles));
  verb->add_option("--silence-limit", arguments.silence_limit_s,
                   "A client that says nothing for so long, while nothing moves, loses its place\n"
                   "to the next one that connects (default: 60)")
      ->check(check_factor)
      ->type_name("SECONDS");
  verb->add_option("--wire-log", arguments.wire_log, "Every line both ways, added to this file")
      ->type_name("FILE");
  verb->footer(
      "\nExample: rondure simulate-cmm plans/examples/01_spool_simulated.json --speed inf\n"
      "Any I++ DME client can be tried against it. What it speaks: docs/ipp-dme-server.md");
}

void add_report(CLI::App& app, ReportArguments& arguments) {
  auto* verb = app.add_subcommand("report", "Writes the reports of a run again, from its journal");
  verb->add_option("RUN_DIR", arguments.directory, "Run directory")->required();
  add_formats(*verb, arguments.formats,
              "html,pdf,json,csv,qif,dmis,corrections (default: all but corrections;\npdf where "
              "there is Chromium)");
  add_edition(*verb, arguments.language, arguments.detail, arguments.verbose);
  add_paper(*verb, arguments.paper);
  verb->footer("\nExample: rondure report runs/01_spool_simulated-20261121T023302Z --format html");
}

void add_verify(CLI::App& app, VerifyArguments& arguments) {
  auto* verb =
      app.add_subcommand("verify", "Recomputes a run from its journal and compares every digit");
  verb->add_option("RUN_DIR", arguments.directory, "Run directory")->required();
  verb->add_option("--key", arguments.key, "Public key file (PEM) of who signed the run");
  verb->footer(
      "\nExample: rondure verify runs/01_spool_simulated-20261121T023302Z --key public.pem\n"
      "Without --key this finds accidents: whoever can write into the directory can also forge "
      "its\n"
      "digests. With the key of who signed (rondure sign) it finds forgery, too.");
}

void add_compare(CLI::App& app, CompareArguments& arguments) {
  auto* verb = app.add_subcommand(
      "compare",
      "Why another program prints another number: reference x filter x outliers x sampling");
  verb->add_option("RUN_DIR", arguments.directory, "Run directory")->required();
  verb->add_flag("--all", arguments.all, "Every combination, not only one change at a time");
  verb->add_flag("--json", arguments.json, "JSON instead of text, with every combination");
  verb->footer(
      "\nExample: rondure compare runs/01_spool_simulated-20261121T023302Z\n"
      "Levels, rules and how shares are computed: docs/compare.md");
}

void add_sign(CLI::App& app, SignArguments& arguments) {
  auto* verb = app.add_subcommand("sign", "Signs a finished run that verifies (Ed25519)");
  verb->add_option("RUN_DIR", arguments.directory, "Run directory")->required();
  verb->add_option("--key", arguments.key, "Private key file (PEM)")->required();
  verb->footer(
      "\nExample: rondure sign runs/01_spool_simulated-20261121T023302Z --key key.pem\n"
      "Keys: openssl genpkey -algorithm ed25519 -out key.pem\n"
      "      openssl pkey -in key.pem -pubout -out public.pem");
}

void add_history_filters(CLI::App& verb, HistoryArguments& arguments) {
  record::ArchiveFilter& filter = arguments.filter;
  verb.add_option("--part", filter.part, "Part number");
  verb.add_option("--feature", filter.feature, "Feature of the plan");
  verb.add_option("--characteristic", filter.characteristic, "Characteristic of the plan");
  verb.add_option("--serial", filter.serial, "Serial number of the part");
  verb.add_option("--machine", filter.machine, "Machine");
  verb.add_option("--operator", filter.operator_name, "Who measured");
  verb.add_option("--verdict", arguments.verdict,
                  "conforms, does-not-conform, undecided, void or not-toleranced");
  verb.add_option("--since", arguments.since,
                  "Started then or later: 2026-11-21 or with THH:MM:SSZ");
  verb.add_option("--until", arguments.until, "Started then or earlier");
}

void add_history(CLI::App& app, HistoryArguments& arguments) {
  auto* verb =
      app.add_subcommand("history", "Past runs, one a line; filter, run chart, capability");
  verb->add_option("ARCHIVE", arguments.archive,
                   "File or postgresql://user@host/database (default: runs/archive.db)");
  add_history_filters(*verb, arguments);
  verb->add_option("--last", arguments.last,
                   "The newest N runs (default: 50); of charts, JSON and CSV the newest N\n"
                   "results (default: 1000; of CSV all)")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1'000'000}));
  verb->add_flag("--chart", arguments.chart, "Run chart of the newest result's characteristic");
  verb->add_option("--svg", arguments.svg, "The same chart as a file")->type_name("FILE");
  verb->add_option("--csv", arguments.csv, "All columns as CSV; - for standard output")
      ->type_name("FILE");
  verb->add_flag("--json", arguments.json, "Results and chart as JSON");
  verb->add_flag("--push", arguments.push, "Sends the runs that wait for an archive");
  verb->add_option("--queue", arguments.queue, "Where they wait (default: runs/archive-queue.db)")
      ->type_name("FILE");
  verb->add_option("--add", arguments.add, "Adds finished runs, each a run directory")
      ->type_name("RUN_DIR");
  verb->footer(
      "\nExample: rondure history --part SP-100 --characteristic cylindricity --chart\n"
      "Columns, statistics and PostgreSQL: docs/archive.md");
}

void add_record(CLI::App& app, RecordArguments& arguments) {
  auto* verb = app.add_subcommand(
      "record", "Reads indicators at stopped angles of a part, into a file for fit spindle");
  verb->add_option("--probe", arguments.probes,
                   "An indicator: " + indicator_words() + "; three times for fit spindle")
      ->required()
      ->expected(1, 8)
      ->type_name("WORD");
  verb->add_option("--from-deg", arguments.from_deg, "First angle (default: 0)")
      ->check(CLI::Range(-3600.0, 3600.0));
  verb->add_option("--step-deg", arguments.step_deg, "Between two angles (default: 10)")
      ->check(CLI::Range(-360.0, 360.0));
  verb->add_option("--count", arguments.count, "Angles (default: 36)")
      ->check(CLI::Range(1, 10'000));
  verb->add_option("--out", arguments.out, "The file; a recording that it holds goes on")
      ->required()
      ->type_name("FILE.csv");
  verb->add_flag("--inches", arguments.inches, "The indicators show inches");
  verb->add_option("--rate-hz", arguments.rate_Hz,
                   "Readings a second of a turning part: refused, indicators cannot follow it")
      ->check(CLI::Range(1e-3, 1e6));
  verb->footer(
      "\nExample: rondure record --probe itn:0012 --probe itn:0013 --probe itn:0014\n"
      "             --step-deg 5 --count 72 --out shaft.csv\n"
      "Every row is on disk before the next angle is asked for; the same command goes on behind "
      "it.\nWiring, kinds: docs/indicators.md");
}

void add_server_device(CLI::App& devices_verb, ServerDeviceArguments& arguments) {
  auto* verb = devices_verb.add_subcommand(
      "ippdme", "Asks a machine behind I++ DME what it can; nothing moves");
  verb->add_option("HOST:PORT", arguments.place, "Where it listens; without a port: 1294")
      ->required();
  verb->add_option("--limit", arguments.limit_s, "For each answer (default: 5)")
      ->check(number_from(0.1, 600.0))
      ->type_name("SECONDS");
  verb->add_flag("--json", arguments.json, "JSON instead of text");
  verb->footer(
      "\nExample: rondure devices ippdme cmm.lab:1294\n"
      "Says what the server can, what it lacks and what that means, and the keys of \"machine\" "
      "for a\nplan. No motion, no homing, no tool change; a session of somebody else is not ended. "
      "Exit status\n2 when nobody answers, or not as a machine of I++ DME. More: docs/ipp-dme.md");
}

void add_devices(CLI::App& app, DevicesArguments& arguments) {
  auto* verb =
      app.add_subcommand("devices", "Fixtures, indicators and serial lines that are plugged in");
  verb->add_flag("--json", arguments.json, "JSON instead of text");
  verb->footer(
      "\nExample: rondure devices\n"
      "Nothing is claimed and nothing moves. Wiring, permissions: docs/fixtures.md, "
      "docs/indicators.md");
  verb->require_subcommand(0, 1);
}

void add_design_probes(CLI::App& app, DesignArguments& a) {
  auto* verb = app.add_subcommand("design-probes",
                                  "Probe angles with the least noise gain for a band of harmonics");
  fit::LayoutSearch& s = a.search;
  verb->add_option("--first-order", s.first, "Of the band (default: 2)");
  verb->add_option("--last-order", s.last, "Of the band (default: 50)");
  verb->add_option("--p2", a.p2_deg, "LO,HI deg from P1 (default: 40,140)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("LO,HI");
  verb->add_option("--p3", a.p3_deg, "LO,HI deg from P1 (default: -140,-40)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("LO,HI");
  verb->add_option("--least-apart", s.least_apart_deg, "deg between probes (default: 20)");
  verb->add_option("--samples", s.samples,
                   "Angles are whole samples of so many a turn (default: 0, any angle)");
  verb->add_option("--count", s.count, "Layouts to give (default: 5)");
  verb->add_flag("--json", a.json, "JSON instead of text");
  verb->footer("\nExample: rondure design-probes --last-order 50 --p2 40,140 --p3=-140,-40");
}

void add_completion(CLI::App& app, std::string& shell) {
  auto* verb = app.add_subcommand("completion", "Prints the completion script of a shell");
  verb->add_option("SHELL", shell, "bash")->required()->check(CLI::IsMember({"bash"}));
  verb->footer(
      "\nExample: source <(rondure completion bash)\n"
      "The Debian package installs it.");
}

void add_manual(CLI::App& app) {
  app.add_subcommand("manual", "Prints the manual page, for man")
      ->footer("\nExample: rondure manual | man -l -");
}

void add_explain(CLI::App& app, ExplainArguments& arguments) {
  auto* verb = app.add_subcommand("explain", "What the code of a message means, and what to do");
  verb->add_option("CODE", arguments.code,
                   "Code of an error, a warning or a decision, or name of an influence; without\n"
                   "it all are listed");
  verb->footer("\nExample: rondure explain no-certificate\n         rondure explain probe-lobing");
}

void add_help(CLI::App& app, std::vector<std::string>& verb_words) {
  auto* verb = app.add_subcommand("help", "Options and examples of a verb, as its --help");
  verb->add_option("VERB", verb_words, "A verb, or two words: fit roundness");
  verb->footer("\nExample: rondure help fit roundness");
}

/// "; did you mean report?", or nothing.
std::string hint(std::string_view word, const std::vector<std::string>& known) {
  const std::vector<std::string_view> views(known.begin(), known.end());
  const std::string_view near = plans::nearest_word(word, views);
  return near.empty() ? std::string() : fmt::format("; did you mean {}?", near);
}

std::vector<std::string> verbs_of(const CLI::App& app) {
  std::vector<std::string> out;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    out.push_back(verb->get_name());
  return out;
}

bool has_verb(const CLI::App& app, const std::string& word) {
  const std::vector<std::string> known = verbs_of(app);
  return std::ranges::find(known, word) != known.end();
}

/// Names options that the verb does not have, with the nearest that it has.
void tell_unknown_options(const CLI::App& verb, const std::vector<std::string>& words) {
  std::vector<std::string> known;
  for (const CLI::Option* option : verb.get_options()) {
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  }
  for (const std::string& word : words) {
    const std::string option = word.substr(0, word.find('='));
    if (!option.starts_with("--") || option == "--" ||
        std::ranges::find(known, option) != known.end())
      continue;
    tell(fmt::format("rondure: there is no option {}{}\n", option, hint(option, known)));
  }
}

/// Prints help and version on standard output; any other case is a mistake in the arguments.
int answer_parse(const CLI::App& app, const CLI::ParseError& error,
                 const std::vector<std::string>& words) {
  const bool option_first = words.empty() || words.front().starts_with('-');
  const bool verb_known = !option_first && has_verb(app, words.front());
  if (error.get_exit_code() == 0 && (option_first || verb_known)) {
    app.exit(error);
    return kAllWell;
  }
  if (!verb_known) {
    tell(option_first ? "rondure: a verb is missing\n"
                      : fmt::format("rondure: there is no verb {}{}\n", words.front(),
                                    hint(words.front(), verbs_of(app))));
    tell("The verbs: rondure --help\n");
    return kBadInput;
  }
  const CLI::App* verb = app.get_subcommand(words.front());
  std::string name = words.front();
  if (words.size() > 1 && has_verb(*verb, words[1])) {
    verb = verb->get_subcommand(words[1]);
    name += " " + words[1];
  }
  tell(fmt::format("rondure: {}\n", error.what()));
  tell_unknown_options(*verb, words);
  tell(fmt::format("What it takes, with an example: rondure {} --help\n", name));
  return kBadInput;
}

/// Limits numbers on the command line as in files; refuses "nan" and "inf".
void limit_numbers(CLI::App& app) {
  constexpr std::array<std::string_view, 7> kNumbers = {"FLOAT", "LO,HI", "X,Y,Z", "N[,N]",
                                                        "X,Z",   "X0,X1", "A,B"};
  for (CLI::Option* option : app.get_options()) {
    const std::string type = option->get_type_name();
    if (std::find(kNumbers.begin(), kNumbers.end(), type) == kNumbers.end()) continue;
    option->check([](const std::string& text) {
      return core::parse_number(text)
                 ? std::string()
                 : fmt::format("{} is no number up to {:g}", text, core::kGreatestNumber);
    });
  }
  for (CLI::App* verb : app.get_subcommands([](CLI::App*) { return true; })) limit_numbers(*verb);
}

/// A verb on the command line, and its action.
struct Verb {
  const CLI::App* table;
  std::function<int()> run;
};

/// Adds a verb whose options are written into its own arguments.
template <class Arguments>
void add_verb(CLI::App& app, void (*add)(CLI::App&, Arguments&), int (*run)(const Arguments&),
              std::vector<Verb>& verbs) {
  const auto arguments = std::make_shared<Arguments>();
  add(app, *arguments);
  const CLI::App* const table = app.get_subcommands([](CLI::App*) { return true; }).back();
  verbs.push_back({table, [arguments, run] { return run(*arguments); }});
}

int main_of(int argc, char** argv) {
  CLI::App app{"Rondure: cylindricity inspection with a CMM and a two-axis fixture", "rondure"};
  app.set_version_flag("--version",
                       fmt::format("rondure {} (commit {})", core::kVersion, core::commit()));
  app.require_subcommand(1);
  app.footer(kExits);
  std::vector<Verb> verbs;
  add_verb(app, add_validate, validate, verbs);
  add_verb(app, add_plan, plan, verbs);
  add_verb(app, add_run, run, verbs);
  add_verb(app, add_simulate_cmm, simulate_cmm, verbs);
  add_verb(app, add_fit, fit_or_run, verbs);
  CLI::App& fit_verb = *app.get_subcommand("fit");
  add_verb(fit_verb, add_roundness, roundness, verbs);
  add_verb(fit_verb, add_spindle, fit_analysis, verbs);
  add_verb(fit_verb, add_contour, fit_analysis, verbs);
  add_verb(fit_verb, add_wheel, fit_analysis, verbs);
  add_verb(fit_verb, add_rotary_axes, rotary_axes, verbs);
  add_verb(app, add_report, report, verbs);
  add_verb(app, add_verify, verify, verbs);
  add_verb(app, add_compare, compare, verbs);
  add_verb(app, add_history, history, verbs);
  add_verb(app, add_sign, sign, verbs);
  add_verb(app, add_design_probes, design_probes, verbs);
  add_verb(app, add_devices, devices, verbs);
  add_verb(*app.get_subcommand("devices"), add_server_device, server_device, verbs);
  add_verb(app, add_record, record_readings, verbs);
  add_verb(app, add_explain, explain, verbs);
  std::vector<std::string> help_of;
  add_help(app, help_of);
  std::string shell;
  add_completion(app, shell);
  add_manual(app);
  limit_numbers(app);
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (!words.empty() && words.front() == "help") {
    words.erase(words.begin());
    words.emplace_back("--help");
  }
  try {
    app.parse(
        std::vector<std::string>(words.rbegin(), words.rend()));  // CLI11 takes the last first
  } catch (const CLI::ParseError& error) {
    return answer_parse(app, error, words);
  }
  // The verbs of `fit` and `devices` follow their parents in the list, and take precedence.
  const auto given = std::find_if(verbs.rbegin(), verbs.rend(),
                                  [](const Verb& verb) { return verb.table->parsed(); });
  if (given != verbs.rend()) {
    const CLI::Option* const quiet = given->table->get_option_no_throw("--quiet");
    const WaitingLine waiting(quiet != nullptr && quiet->count() > 0);
    return given->run();
  }
  say(app.got_subcommand("completion") ? bash_completion(app) : manual_page(app));
  return kAllWell;
}

}  // namespace
}  // namespace rondure::app

int main(int argc, char** argv) {
  using namespace rondure::app;
  hold_standard_streams();
  int status = argc > 1 && std::string_view(argv[1]) == "run" ? kRunFailed : kBadInput;
  try {
    status = main_of(argc, argv);
  } catch (const std::bad_alloc&) {
    tell("rondure: the memory of this computer is not enough; use fewer points\n");
  } catch (const std::exception& error) {
    tell(fmt::format("rondure: {}; please report this [internal]\n", error.what()));
  }
  return output_reached() ? status : std::max<int>(status, kBadInput);
}
