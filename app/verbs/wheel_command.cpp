#include "app/verbs/wheel_command.h"

#include <CLI/CLI.hpp>

#include "app/verbs/word_option.h"

namespace rondure::app {
namespace {

using record::WheelTask;

CLI::Option* add_pair(CLI::App& verb, const char* name, std::vector<double>& values,
                      const char* meaning, const char* type) {
  return verb.add_option(name, values, meaning)
      ->delimiter(',')
      ->expected(2)
      ->allow_extra_args(false)
      ->type_name(type);
}

void add_measuring(CLI::App& verb, WheelArguments& arguments) {
  add_words<WheelTask::Mode>(
      verb, "--mode", arguments.mode,
      "indexed: wheel at rest at known angles, points of its body; envelope: wheel at\n"
      "speed, points of the circle it sweeps. It decides what the result means")
      ->required();
  add_pair(verb, "--axis-mm", arguments.axis_mm,
           "Spindle axis (indexed): gives run-out and the effective radius", "X,Z");
  verb.add_option("--nominal-radius-mm", arguments.nominal_radius_mm,
                  "R must be within 5 % of it; also the path without compensation");
  add_words<WheelTask::Center>(
      verb, "--center", arguments.center,
      "least-squares (default), or a mean of four-point centres: as-published, the\n"
      "plain one, or weighted by the conditioning");
  add_words<WheelTask::Quadruples>(
      verb, "--quadruples", arguments.quadruples,
      "Of those means: all (default), best, or random: as published, without a kappa\n"
      "limit");
  verb.add_option("--count", arguments.count,
                  "Quadruples of best and random (default: 6, at least)");
  verb.add_option("--seed", arguments.seed, "Of random quadruples (default: 1)");
  verb.add_option("--kappa-limit", arguments.kappa_limit,
                  "Worst conditioning accepted (default: 5, or twice the best)");
  verb.add_flag("--robust", arguments.robust, "Drop isolated points beyond 5 scales first");
  verb.add_flag("--override-arc", arguments.override_arc, "Evaluate less than 20 deg, too");
}

void add_grinding(CLI::App& verb, WheelArguments& arguments) {
  verb.add_option(
      "--surface", arguments.surface,
      "Surface z = f(x) to grind: polynomial:a0,a1,a2,... | asphere:R=120,K=-1,A4=2e-8\n"
      "(c=1/mm for R; A2 to A20) | table:FILE.csv with the columns x,z (mm)");
  verb.add_option("--removal", arguments.removal, "CSV x,depth_um: a depth to take off the surface")
      ->type_name("FILE.csv");
  add_pair(verb, "--range-mm", arguments.range_mm, "Contacts from, to (default: the whole table)",
           "X0,X1");
  add_pair(verb, "--surface-range-mm", arguments.surface_range_mm,
           "Where the surface must not be cut into (default: the contacts)", "X0,X1");
  verb.add_option("--step-mm", arguments.step_mm, "Step of x (default: 0.1)");
  verb.add_option("--cusp-um", arguments.cusp_um, "Highest cusp between passes, for the step");
  add_words<record::GroundSurfaceTask::Radius>(verb, "--radius", arguments.radius,
                                               "Radius of the path: mean (default) or effective");
  add_pair(verb, "--wheel-arc-deg", arguments.wheel_arc_deg,
           "Trued arc of the wheel about its lowest point", "A,B");
  verb.add_option("--repeatability-um", arguments.repeatability_um,
                  "Of the machine: limits the improvement (default: 0)");
  verb.add_option("--touch-off-mm", arguments.touch_off_mm, "x of the touch-off (default: 0)");
  verb.add_flag("--lowest-point", arguments.lowest_point,
                "z of the wheel's lowest point in place of its centre");
  verb.add_option("--path", arguments.path, "Writes the path as CSV")->type_name("FILE.csv");
  verb.add_option("--gcode", arguments.gcode, "Writes the path as G-code")->type_name("FILE");
  verb.add_option("--feed-mm-min", arguments.feed_mm_min, "Feed of the G-code (default: 100)")
      ->check(CLI::PositiveNumber);
  verb.add_option("--retract-mm", arguments.retract_mm, "Above the path (default: 5)")
      ->check(CLI::NonNegativeNumber);
}

}  // namespace

void add_wheel(CLI::App& fit_verb, WheelArguments& arguments) {
  auto* verb = fit_verb.add_subcommand(
      "wheel", "Centre, radius and run-out of a grinding wheel; path of its centre over a surface");
  verb->add_option("FILE", arguments.file, "CSV with the columns x,z or x,y (mm), 8 points or more")
      ->required();
  add_measuring(*verb, arguments);
  add_grinding(*verb, arguments);
  verb->add_flag("--json", arguments.json, "JSON instead of text, with the whole path");
  verb->footer(
      "\nExample: rondure fit wheel tests/data/spec_wheel/example1.csv --mode indexed "
      "--axis-mm 12.02,-7 \\\n"
      "           --nominal-radius-mm 50 --surface asphere:R=120,K=-1,A4=2e-8 --range-mm -40,40 "
      "\\\n"
      "           --cusp-um 0.1 --path path.csv --gcode path.nc\n"
      "Method, columns and JSON: docs/wheel.md");
}

}  // namespace rondure::app
