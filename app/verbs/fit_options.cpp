// The command line of `fit` and its verbs.

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/verbs/verbs.h"
#include "app/verbs/word_option.h"

namespace rondure::app {
namespace {

/// "--range-deg 0,90": one argument, so that a file may follow it.
template <class Value>
CLI::Option* add_list(CLI::App& verb, const char* name, std::vector<Value>& values,
                      const char* meaning, const char* type) {
  return verb.add_option(name, values, meaning)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name(type);
}

/// The keys of the plan, the questions, and where the result goes.
void add_settings(CLI::App& verb, AnalysisArguments& a, const char* type, const char* forms) {
  a.type = type;
  verb.add_option("--set", a.settings,
                  std::string("KEY=VALUE of the plan, may be given several times; KEY below ") +
                      type +
                      ",\nas uncertainty.point_um; behind a slash anywhere, as "
                      "/decision_rule/rule")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  verb.add_option("--ask", a.asked,
                  std::string("FORM, or FORM=LIMIT in um, may be given several times:\n") + forms)
      ->allow_extra_args(false)
      ->type_name("FORM[=LIMIT]");
  auto* const json = verb.add_flag("--json", a.json, "report.json of the run instead of text");
  auto* const out = verb.add_option("--out", a.out,
                                    "Run directory, absent or empty: with page, journal and "
                                    "digests, that verify and\nsign take");
  out->type_name("DIR")->excludes(json);
  verb.add_option("--save-plan", a.save_plan,
                  "Writes the plan of that run, to edit; without --out no run")
      ->type_name("FILE")
      ->excludes(json);
  verb.add_option("--serial", a.serial, "Serial number of the part (with --out)")->needs(out);
  verb.add_option("--operator", a.operator_name, "Who measures (with --out)")->needs(out);
}

/// Refuses what a page of one form does not show.
void check_page(const FitArguments& a) {
  const char* const option = a.out.empty() ? "--save-plan" : "--out";
  const auto refuse = [option](const char* why) { throw CLI::ValidationError(option, why); };
  if (a.shape == "line" || a.shape == "cone" || a.shape == "sphere") {
    refuse("a page is of a circle (RONt), a cylinder (CYLt) or a plane (FLTt)");
  }
  if (a.tolerance_um && !(*a.tolerance_um > 0.0 && *a.tolerance_um <= 10'000.0)) {
    throw CLI::ValidationError("--tolerance-um", "must be above 0 and at most 10000");
  }
  if (!a.sizes.empty()) refuse("it is about the form; sizes with limits: save the plan, add them");
  if (!a.outward.empty()) refuse("the direction is not needed for a flatness; take it out");
  if (a.json) refuse("the numbers stand in report.json of the run; take out --json");
  if (a.file == "-") refuse("a run keeps the name of its file, which standard input has not");
}

/// Refuses options that have no meaning for the shape.
void check_fit(const FitArguments& a) {
  const std::string& shape = a.shape;
  if (a.reference == "mc" || a.reference == "mi") {
    const char* const has = shape == "line"    ? "a line has ls and mz (the least cylinder that "
                                                 "encloses its points)"
                            : shape == "plane" ? "a plane has ls and mz (its outer plane is the "
                                                 "one-sided one)"
                            : shape == "cone"  ? "a cone has ls and mz"
                                               : nullptr;
    if (has != nullptr) throw CLI::ValidationError("--reference", has);
  }
  const bool sized = shape == "circle" || shape == "cylinder" || shape == "sphere";
  if (!a.sizes.empty() && !sized) {
    throw CLI::ValidationError("--size", shape == "cone"
                                             ? "a cone has a diameter at each height; one is given "
                                               "without this option"
                                             : "a " + shape + " has no size");
  }
  if (shape == "sphere" && std::ranges::find(a.sizes, "LP") != a.sizes.end()) {
    throw CLI::ValidationError("--size", "LP needs sections, a sphere has GG, GN, GX and GC");
  }
  const char* const tip = a.tip_diameter_mm ? "--tip-diameter-mm" : "--inside";
  const bool page = !a.out.empty() || !a.save_plan.empty();
  if (page) check_page(a);
  if ((a.tip_diameter_mm || a.inside) && a.sizes.empty() && shape != "cone" && !page) {
    throw CLI::ValidationError(tip,
                               "form and place are those of the tip centres; it acts on "
                               "--size and on the diameter of a cone only");
  }
  if (a.tip_diameter_mm && a.points_are == record::PointsAre::kSurface) {
    throw CLI::ValidationError("--points",
                               "points of the surface have no tip; leave out --points "
                               "surface or --tip-diameter-mm");
  }
  if (a.tip_diameter_mm && *a.tip_diameter_mm < 0.0) {
    throw CLI::ValidationError("--tip-diameter-mm", "must not be below 0");
  }
  if (!a.outward.empty() && shape != "plane") {
    throw CLI::ValidationError("--outward", "only a plane has one outward direction");
  }
}

}  // namespace

void add_fit(CLI::App& app, FitArguments& arguments) {
  auto* verb = app.add_subcommand(
      "fit", "Fits a circle, cylinder, cone, sphere, plane or line to a points file");
  verb->add_option("SHAPE", arguments.shape,
                   "circle (x, y); cylinder, cone, sphere, plane, line (x, y, z)")
      ->check(CLI::IsMember({"circle", "cylinder", "cone", "sphere", "plane", "line"}));
  verb->add_option("FILE", arguments.file,
                   "Points, tip centres: a text table as programs write it; - for standard input.\n"
                   "The line \"read as\" of the result says what was taken for what");
  add_list(*verb, "--columns", arguments.points.columns,
           "Columns of x, y and z: numbers from 1, or names in the head line", "X,Y[,Z]")
      ->expected(2, 3);
  add_words<record::LengthUnit>(*verb, "--unit", arguments.points.unit,
                                "Unit of the points (default: as the head says, otherwise mm)");
  add_words<record::LayersFrom>(
      *verb, "--layers", arguments.points.layers,
      "column: the column layer; heights: groups of z; none (default: the column, if\n"
      "there)");
  verb->add_option("--feature", arguments.points.feature,
                   "Takes the rows with this name in the column feature")
      ->type_name("NAME");
  verb->add_option(
          "--reference", arguments.reference,
          "ls least squares, mz minimum zone, mc minimum circumscribed, mi maximum inscribed, "
          "or all (default)")
      ->check(CLI::IsMember({"ls", "mz", "mc", "mi", "all"}));
  add_list(*verb, "--size", arguments.sizes,
           "Sizes of ISO 14405-1 besides, of a circle, cylinder or sphere: GG least squares,\n"
           "GN minimum circumscribed, GX maximum inscribed, GC minimax, LP two-point (not of\n"
           "a sphere); as GG,LP",
           "LIST")
      ->check(CLI::IsMember({"GG", "GN", "GX", "GC", "LP"}));
  verb->add_option("--tip-diameter-mm", arguments.tip_diameter_mm,
                   "Of the ball whose centres the file has: sizes and the diameter of a cone\n"
                   "are then those of the surface (default: 0)");
  add_words<record::PointsAre>(
      *verb, "--points", arguments.points_are,
      "surface: the points are corrected already, as of a scanner or another program;\n"
      "tip-centres (default)");
  verb->add_flag("--inside", arguments.inside, "A bore: the tip touches from the inside");
  add_list(*verb, "--outward", arguments.outward,
           "Direction out of the material of a plane: for peak, valley and outer plane", "X,Y,Z")
      ->expected(3);
  verb->add_flag("--json", arguments.json, "The stable JSON contract instead of text");
  verb->add_option("--out", arguments.out,
                   "Run directory, absent or empty: the form of a circle, cylinder or plane as a "
                   "run\nwith page, journal and digests, that verify and sign take")
      ->type_name("DIR");
  auto* const save = verb->add_option("--save-plan", arguments.save_plan,
                                      "Writes the plan of that run, to edit; without --out no run");
  save->type_name("FILE");
  verb->add_option("--tolerance-um", arguments.tolerance_um,
                   "Limit of the form (with --out or --save-plan)");
  verb->add_option("--part", arguments.part,
                   "Number of the part (default: the name of the file; with --out or --save-plan)");
  verb->add_option("--drawing", arguments.drawing,
                   "Its drawing with the issue (with --out or --save-plan)");
  verb->add_option("--serial", arguments.serial, "Serial number of the part (with --out)");
  verb->add_option("--operator", arguments.operator_name, "Who measures (with --out)");
  verb->footer(
      "\nExample: rondure fit cylinder tests/data/nist_cyl_13/points.csv --json\n"
      "         rondure fit cylinder tests/data/shaft_drawing/shaft.csv --feature A \\\n"
      "           --size GN,LP --tip-diameter-mm 2\n"
      "         rondure fit plane tests/data/shaft_drawing/shaft.csv --feature D --outward 0,0,1\n"
      "         rondure fit cylinder tests/data/nist_cyl_13/points.csv --tolerance-um 180 \\\n"
      "           --out runs/cylinder\n"
      "Shapes, sizes and keys of the JSON: docs/drawing.md");
  verb->require_subcommand(0, 1);
  verb->callback([verb, &arguments] {  // a verb such as roundness needs neither
    if (!verb->get_subcommands().empty()) return;
    if (arguments.shape.empty()) throw CLI::RequiredError("SHAPE");
    if (arguments.file.empty()) throw CLI::RequiredError("FILE");
    for (const auto& [written, place] :
         {std::pair("--out", &arguments.out), std::pair("--save-plan", &arguments.save_plan)}) {
      if (verb->count(written) > 0 && place->empty())
        throw CLI::ValidationError(written, "is empty; name a place, or leave it out");
    }
    for (const auto& [of_page, of_plan] :
         {std::pair("--tolerance-um", true), std::pair("--part", true),
          std::pair("--drawing", true), std::pair("--serial", false),
          std::pair("--operator", false)}) {
      const bool planned = of_plan && !arguments.save_plan.empty();
      if (verb->count(of_page) > 0 && arguments.out.empty() && !planned)
        throw CLI::RequiresError(of_page, of_plan ? "--out or --save-plan" : "--out");
    }
    check_fit(arguments);
  });
}

void add_roundness(CLI::App& fit_verb, RoundnessArguments& arguments) {
  auto* verb = fit_verb.add_subcommand(
      "roundness", "Filters one section and gives RONt, RONp, RONv, RONq and harmonics");
  verb->add_option("FILE", arguments.file, "CSV with the columns theta_deg,r_um or x,y (mm)")
      ->required();
  add_list(*verb, "--columns", arguments.points.columns,
           "Columns of x and y: numbers from 1, or names in the head line", "X,Y")
      ->expected(2);
  add_words<record::LengthUnit>(*verb, "--unit", arguments.points.unit,
                                "Unit of x and y (default: as the head says, otherwise mm)");
  add_list(*verb, "--cutoff-upr", arguments.cutoff_upr,
           "Cut-off in undulations per revolution (default: 50); LO,HI for a band", "N[,N]");
  verb->add_option("--filter", arguments.filter, "gaussian (default), 2rc, robust, spline or none")
      ->check(CLI::IsMember({"gaussian", "2rc", "robust", "spline", "none"}));
  verb->add_option("--pass", arguments.pass, "low (default), high or band")
      ->check(CLI::IsMember({"low", "high", "band"}));
  verb->add_option("--reference", arguments.reference,
                   "Reference circle: ls least squares, mz minimum zone, mc minimum circumscribed, "
                   "mi maximum inscribed, or all (default)")
      ->check(CLI::IsMember({"ls", "mz", "mc", "mi", "all"}));
  verb->add_flag("--override-sampling", arguments.override_sampling,
                 "Filter also with fewer than 7 points per undulation");
  verb->add_flag("--inside", arguments.inside, "A bore: peaks point to the centre");
  verb->add_flag("--json", arguments.json, "JSON instead of text");
  verb->footer(
      "\nExample: rondure fit roundness tests/data/spec_roundness/profile.csv --cutoff-upr 100\n"
      "Filters, formulas and end effects: docs/filters.md");
}

void add_spindle(CLI::App& fit_verb, AnalysisArguments& a) {
  auto* verb = fit_verb.add_subcommand(
      "spindle", "Separates the form of a part from the motion of its axis (three probes)");
  verb->add_option("FILE", a.files,
                   "CSV with the columns alpha_deg,H1_um,H2_um,H3_um[,beta_deg]; alpha is not "
                   "wrapped")
      ->required()
      ->expected(1);
  add_settings(*verb, a, "spindle",
               "roundness, roundness-rms, motion-total, motion-synchronous (default: these),\n"
               "motion-asynchronous");
  verb->footer(
      "\nExample: rondure fit spindle tests/data/spindle_dynamic/readings.csv \\\n"
      "           --set layout=reference --set crank_radius_mm=49 --set wheel_radius_mm=299.88 \\\n"
      "           --set pin_radius_mm=24.56\n"
      "Columns, keys and formulas: docs/spindle.md");
}

void add_contour(CLI::App& fit_verb, AnalysisArguments& a) {
  constexpr const char* kFiles = "FILE,...";
  auto* verb = fit_verb.add_subcommand(
      "contour",
      "Crank pins in follow grinding: which share of the contour error follows the axes, and which "
      "share repeats");
  add_list(*verb, "--axes", a.axes,
           "Traces of the control, one file a part; left out: f is t less the main journal",
           kFiles);
  add_list(*verb, "--pin", a.files, "Contours of the pins from the gauge, one file a part", kFiles)
      ->required();
  add_list(*verb, "--main", a.main, "Contours of the neighbouring main journals, if measured",
           kFiles);
  add_settings(*verb, a, "contour",
               "contour-deviation, contour-spread (default: these), following-deviation");
  verb->footer(
      "\nColumns (CSV, a header line, a row a sample); others by --set columns=[...]:\n"
      "  axes   c_deg, c_error_deg, x_error_mm: C position and the errors of both axes, with\n"
      "         d_cmd_mm, if recorded, to check crank, wheel and the zero of C; or\n"
      "         alpha_cmd_deg, d_cmd_mm, alpha_act_deg, d_act_mm: positions, 360 deg at least\n"
      "  pin, main   angle_deg, deviation_um: one turn, steps of at most 1 deg\n"
      "\nExample: rondure fit contour --axes tests/data/spec_contour/axes1.csv \\\n"
      "           --pin tests/data/spec_contour/pin1.csv --set filter=done-by-gauge\n"
      "Method, columns, keys: docs/contour.md");
}

void add_wheel(CLI::App& fit_verb, AnalysisArguments& a) {
  auto* verb = fit_verb.add_subcommand(
      "wheel", "Centre, radius and run-out of a grinding wheel; path of its centre over a surface");
  verb->add_option("FILE", a.files, "CSV with the columns x,z (mm), 8 points or more")
      ->required()
      ->expected(1);
  add_settings(*verb, a, "wheel",
               "roundness, radius, run-out (default: those that the keys allow)");
  verb->footer(
      "\nExample: rondure fit wheel tests/data/spec_wheel/example1.csv --set mode=indexed \\\n"
      "           --set axis_x_mm=12.02 --set axis_z_mm=-7 --ask run-out\n"
      "Method, columns and keys: docs/wheel.md");
}

void add_rotary_axes(CLI::App& fit_verb, RotaryAxesArguments& a) {
  auto* verb = fit_verb.add_subcommand(
      "rotary-axes", "Six errors of a rotary axis at each angle, from measured balls");
  verb->add_option("FILE", a.files, "CSV, one or more; a file may hold several axes")->required();
  verb->add_option("--axis", a.axis,
                   "Direction of the axis: x, y, z or a,b,c (default: by its name: A or phi_alpha "
                   "x, B or phi_beta y, C z)")
      ->type_name("DIRECTION");
  add_list(*verb, "--origin", a.origin_mm, "mm, a point of the axis (default: 0,0,0)", "X,Y,Z");
  verb->add_option("--reference-deg", a.reference_deg, "Angle of the reference pose (default: 0)");
  add_list(*verb, "--range-deg", a.range_deg, "Range of the axis; stations outside are refused",
           "LO,HI");
  verb->add_option("--method", a.method,
                   "exact (default), linear, or as-published: the printed matrices (3 balls)")
      ->check(CLI::IsMember({"exact", "linear", "as-published"}));
  verb->add_option("--curve", a.curve,
                   "Between stations: spline (default), fourier (circle) or polynomial (arc)")
      ->check(CLI::IsMember({"spline", "fourier", "polynomial"}));
  add_list(*verb, "--at", a.place_mm, "mm, a place of the part: its point uncertainty is stated",
           "X,Y,Z");
  verb->add_flag("--keep-outliers", a.keep_outliers, "No ball is left out");
  verb->add_option("--repeat-urad", a.repeat_urad,
                   "Standard uncertainty by the axis' repeatability")
      ->check(CLI::Range(0.0, 1e4));
  verb->add_option("--tool-um", a.tool_um,
                   "Standard uncertainty of y and z of the tools on which balls were set up one by "
                   "one (left out: a plate carries all)")
      ->check(CLI::Range(0.0, 1e4));
  verb->add_flag("--json", a.json, "JSON instead of text");
  verb->footer(
      "\nColumns: axis,station_deg,ball,x_mm,y_mm,z_mm,u_um (or ux_um,uy_um,uz_um)[,direction].\n"
      "Rows of the reference pose have the word reference for their station; measure it at start,\n"
      "middle and end. direction: + or - where each station is approached from both sides.\n"
      "\nExample: rondure fit rotary-axes tests/data/spec_rotary/c_axis.csv\n"
      "No interval is stated here: a plan with rotary_axes.uncertainty gives it "
      "(docs/fixture-calibration.md).\n"
      "How to set up balls, formulas, keys of the JSON: docs/rotary-axes.md");
}

}  // namespace rondure::app
