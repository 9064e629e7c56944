#include <algorithm>
#include <cstdio>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "app/verbs.h"
#include "core/version.h"

namespace rondure::app {
namespace {

constexpr const char* kExits =
    "\nExit status: run, report: 0 all conform, 1 finished but something does not conform or is void,\n"
    "2 bad input, 3 machine or run failed. verify: 0 equal, 1 not equal, 2 unreadable. Others: 0 or 2.";

void add_validate(CLI::App& app, ValidateArguments& arguments) {
  auto* verb = app.add_subcommand("validate", "Checks a plan: every problem, one a line");
  verb->add_option("PLAN", arguments.plan, "Plan file (JSON)")->required();
  verb->footer("\nExample: rondure validate plans/examples/01_spool_simulated.json");
}

void add_run(CLI::App& app, RunArguments& arguments) {
  auto* verb = app.add_subcommand("run", "Executes a plan and writes its reports");
  verb->add_option("PLAN", arguments.plan, "Plan file (JSON)")->required();
  verb->add_option("--out", arguments.out, "Run directory, absent or empty (default: runs/<plan>-<UTC>)");
  verb->add_option("--serial", arguments.serial, "Serial number of the part");
  verb->add_option("--operator", arguments.operator_name, "Who measures");
  verb->add_option("--seed", arguments.seed, "Seed of the simulation, in place of the plan's");
  verb->add_option("--format", arguments.formats, "html,json,csv (default: as the plan says)")->delimiter(',');
  verb->add_flag("--quiet", arguments.quiet, "No progress, no summary");
  verb->footer(std::string("\nExample: rondure run plans/examples/01_spool_simulated.json --serial 0042 --operator mk\n"
                           "Ctrl-C stops after the present touch; what was measured is kept.\n") + kExits);
}

void add_fit(CLI::App& app, FitArguments& arguments) {
  auto* verb = app.add_subcommand("fit", "Fits a circle or a cylinder to a points file");
  verb->add_option("SHAPE", arguments.shape, "circle (columns x,y) or cylinder (columns x,y,z), mm")
      ->required()
      ->check(CLI::IsMember({"circle", "cylinder"}));
  verb->add_option("FILE", arguments.file, "CSV with a header line; # comments")->required();
  verb->add_option("--reference", arguments.reference, "ls, mz or all")->check(CLI::IsMember({"ls", "mz", "all"}));
  verb->add_flag("--json", arguments.json, "The stable JSON contract instead of text");
  verb->footer("\nExample: rondure fit cylinder tests/data/nist_cyl_13/points.csv --json");
}

void add_report(CLI::App& app, ReportArguments& arguments) {
  auto* verb = app.add_subcommand("report", "Writes the reports of a run again, from its journal");
  verb->add_option("RUN_DIR", arguments.directory, "Run directory")->required();
  verb->add_option("--format", arguments.formats, "html,json,csv (default: all)")->delimiter(',');
  verb->footer("\nExample: rondure report runs/01_spool_simulated-20261121T023302Z --format html");
}

void add_verify(CLI::App& app, VerifyArguments& arguments) {
  auto* verb = app.add_subcommand("verify", "Recomputes a run from its journal and compares every digit");
  verb->add_option("RUN_DIR", arguments.directory, "Run directory")->required();
  verb->footer("\nExample: rondure verify runs/01_spool_simulated-20261121T023302Z\n"
               "Finds accidents; whoever can write into the directory can also forge its digests.");
}

int main_of(int argc, char** argv) {
  CLI::App app{"Rondure: cylindricity inspection with a CMM and a two-axis fixture", "rondure"};
  app.set_version_flag("--version", std::string(core::kVersion));
  app.require_subcommand(1);
  app.footer(kExits);
  ValidateArguments validate_arguments;
  RunArguments run_arguments;
  FitArguments fit_arguments;
  ReportArguments report_arguments;
  VerifyArguments verify_arguments;
  add_validate(app, validate_arguments);
  add_run(app, run_arguments);
  add_fit(app, fit_arguments);
  add_report(app, report_arguments);
  add_verify(app, verify_arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return code == 0 ? kAllWell : kBadInput;
  }
  if (app.got_subcommand("validate")) return validate(validate_arguments);
  if (app.got_subcommand("run")) return run(run_arguments);
  if (app.got_subcommand("fit")) return fit(fit_arguments);
  if (app.got_subcommand("report")) return report(report_arguments);
  return verify(verify_arguments);
}

}  // namespace
}  // namespace rondure::app

int main(int argc, char** argv) { return rondure::app::main_of(argc, argv); }
