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

void add_contour_files(CLI::App& verb, ContourArguments& arguments) {
  constexpr const char* kFiles = "FILE,...";
  add_list(verb, "--axes", arguments.axes,
           "Traces of the control, one file a part; left out: f is t less the main journal",
           kFiles);
  add_list(verb, "--pin", arguments.pin, "Contours of the pins from the gauge, one file a part",
           kFiles)
      ->required();
  add_list(verb, "--main", arguments.main,
           "Contours of the neighbouring main journals, if measured", kFiles);
  verb.add_option("--mapping", arguments.mapping, "JSON file that names the columns")
      ->type_name("FILE");
  verb.add_option("--column", arguments.columns,
                  "One column: quantity=column[:unit[:sign]]; may be given several times")
      ->allow_extra_args(false)
      ->type_name("TEXT");
  verb.add_option("--curves", arguments.curves, "Writes t, f, n of all parts as CSV")
      ->type_name("FILE");
  verb.add_flag("--json", arguments.json, "JSON instead of text");
}

void add_contour_settings(CLI::App& verb, ContourArguments& arguments) {
  using record::ContourTask;
  ContourTask& task = arguments.task;
  // An option of which -1 stands for a word of the plan.
  const auto add_sign = [&](const char* name, auto& value, auto reversed, const char* meaning) {
    verb.add_option_function<int>(
            name,
            [&value, reversed](int sign) {
              if (sign < 0) value = reversed;
            },
            meaning)
        ->check(CLI::IsMember({1, -1}));
  };
  verb.add_option("--crank-radius-mm", task.crank_radius_mm, "R (default: 49)");
  verb.add_option("--wheel-radius-mm", task.wheel_radius_mm, "Rgw (default: 299.88)");
  verb.add_option("--pin-radius-mm", task.pin_radius_mm, "r (default: 24.56)");
  verb.add_option("--main-radius-mm", task.main_radius_mm, "Main journal (default: 30)");
  verb.add_option("--cutoff-upr", task.cutoff_upr, "Gaussian low pass (default: 50)");
  verb.add_option("--samples", task.samples, "Points of a contour (default: 1440)")
      ->check(CLI::NonNegativeNumber);
  verb.add_option("--phase-offset-deg", task.phase_offset_deg,
                  "Gauge angle of the direction from the crankshaft's to the pin's axis");
  verb.add_option("--main-phase-offset-deg", arguments.main_phase_offset_deg,
                  "The same of the main journals (default: as the pins)");
  add_sign("--gauge-direction", task.gauge, ContourTask::Gauge::kClockwise,
           "1 (default), or -1: the gauge turns the other way");
  add_sign("--c-direction", task.c_axis, ContourTask::CAxis::kAgainstWheel,
           "1 (default), or -1: C turns the crank counter-clockwise under the wheel");
  add_sign("--error-sign", task.error, ContourTask::Error::kCommandMinusActual,
           "1 (default): actual minus command; -1: command minus actual, as a following error of "
           "most controls");
  add_words<ContourTask::BaseCircle>(verb, "--base", task.base_circle,
                                     "Base circle: limacon (default) or geometric");
  add_words<ContourTask::Method>(
      verb, "--method", task.method,
      "corrected (default), or as-published: each f is turned onto its t");
  verb.add_flag_callback(
      "--prefiltered", [&task] { task.filter = ContourTask::Filter::kDoneByGauge; },
      "The gauge has filtered the contours");
}

void add_spindle_geometry(CLI::App& verb, SpindleArguments& a) {
  using Layout = record::SpindleTask::Layout;
  add_words<Layout>(verb, "--layout", a.task.layout, "published-a, published-b or reference",
                    {Layout::kAngles});
  verb.add_option("--p1-to-p2", a.task.p1_to_p2_deg,
                  "deg from probe 1 to probe 2, against the rotation of the work");
  verb.add_option("--p2-to-p3", a.task.p2_to_p3_deg, "deg from probe 2 to probe 3 (a difference)");
  verb.add_option("--p1-to-p3", a.task.p1_to_p3_deg, "deg from probe 1 to probe 3 (cumulative)");
  verb.add_option("--crank-radius", a.task.crank_radius_mm,
                  "mm; the probes follow a crank pin (default: 0, an ordinary shaft)");
  verb.add_option("--wheel-radius", a.task.wheel_radius_mm,
                  "mm; the pivot of the arm is its centre");
  verb.add_option("--pin-radius", a.task.pin_radius_mm, "mm; of the part that is measured");
}

void add_measuring(CLI::App& verb, WheelArguments& arguments) {
  using record::WheelTask;
  add_words<WheelTask::Mode>(
      verb, "--mode", arguments.task.mode,
      "indexed: wheel at rest at known angles, points of its body; envelope: wheel at\n"
      "speed, points of the circle it sweeps. It decides what the result means")
      ->required();
  add_list(verb, "--axis-mm", arguments.axis_mm,
           "Spindle axis (indexed): gives run-out and the effective radius", "X,Z")
      ->expected(2);
  verb.add_option("--nominal-radius-mm", arguments.task.nominal_radius_mm,
                  "R must be within 5 % of it; also the path without compensation");
  add_words<WheelTask::Center>(
      verb, "--center", arguments.task.center,
      "least-squares (default), or as-published: the mean of four-point centres");
  verb.add_option("--seed", arguments.seed,
                  "Of quadruples drawn of more than 20 points (default: 1)");
  verb.add_option("--kappa-limit", arguments.task.kappa_limit,
                  "Worst conditioning accepted (default: 5, or twice the best)");
  verb.add_flag_callback(
      "--robust", [&arguments] { arguments.task.robust = record::Switch::kOn; },
      "Drop isolated points beyond 5 scales first");
  verb.add_flag_callback(
      "--override-arc", [&arguments] { arguments.task.short_arc = WheelTask::ShortArc::kAllowed; },
      "Evaluate less than 20 deg, too");
}

void add_grinding(CLI::App& verb, WheelArguments& arguments) {
  verb.add_option(
      "--surface", arguments.surface,
      "Surface z = f(x) to grind: polynomial:a0,a1,a2,... | asphere:R=120,K=-1,A4=2e-8\n"
      "(c=1/mm for R; A2 to A20) | table:FILE.csv with the columns x,z (mm)");
  verb.add_option("--removal", arguments.removal, "CSV x,depth_um: a depth to take off the surface")
      ->type_name("FILE.csv");
  add_list(verb, "--range-mm", arguments.range_mm, "Contacts from, to (default: the whole table)",
           "X0,X1")
      ->expected(2);
  add_list(verb, "--surface-range-mm", arguments.surface_range_mm,
           "Where the surface must not be cut into (default: the contacts)", "X0,X1")
      ->expected(2);
  verb.add_option("--step-mm", arguments.step_mm, "Step of x (default: 0.1)");
  verb.add_option("--cusp-um", arguments.cusp_um, "Highest cusp between passes, for the step");
  add_words<record::GroundSurfaceTask::Radius>(verb, "--radius", arguments.radius,
                                               "Radius of the path: mean (default) or effective");
  add_list(verb, "--wheel-arc-deg", arguments.wheel_arc_deg,
           "Trued arc of the wheel about its lowest point", "A,B")
      ->expected(2);
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
                   "The first line of the result says what was taken for what");
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
    for (const char* of_page : {"--tolerance-um", "--serial", "--operator"}) {
      if (verb->count(of_page) > 0 && arguments.out.empty() && arguments.save_plan.empty())
        throw CLI::RequiresError(of_page, "--out");
    }
    check_fit(arguments);
  });
}

void add_roundness(CLI::App& fit_verb, RoundnessArguments& arguments) {
  auto* verb = fit_verb.add_subcommand(
      "roundness", "Filters one section and gives RONt, RONp, RONv, RONq and harmonics");
  verb->add_option("FILE", arguments.file, "CSV with the columns theta_deg,r_um or x,y (mm)")
      ->required();
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

void add_spindle(CLI::App& fit_verb, SpindleArguments& a) {
  auto* verb = fit_verb.add_subcommand(
      "spindle", "Separates the form of a part from the motion of its axis (three probes)");
  verb->add_option("FILE", a.file,
                   "CSV with the columns alpha_deg,H1_um,H2_um,H3_um[,beta_deg]; alpha is not "
                   "wrapped")
      ->required();
  add_spindle_geometry(*verb, a);
  verb->add_option("--samples", a.task.samples, "Of a revolution (default: 1024; 0: as recorded)");
  verb->add_option("--highest-order", a.task.highest_order,
                   "Highest harmonic recovered (default: 50)");
  verb->add_option("--greatest-gain", a.task.greatest_gain,
                   "Harmonics with a higher noise gain are not recovered (default: 100)");
  verb->add_option("--probe-noise", a.task.probe_noise_um,
                   "um, standard deviation of a reading (default: estimated)");
  verb->add_option("--tip-width", a.task.tip_width_mm,
                   "mm, diameter of tip or spot, taken out of the part (default: a point)");
  add_words<record::SpindleTask::SecondOrder>(*verb, "--second-order", a.task.second_order,
                                              "auto (default), on or off");
  verb->add_option("--cutoff-upr", a.task.cutoff_upr,
                   "Gaussian low pass of the profile (default: 50; 0: none)");
  verb->add_flag_callback(
      "--no-resampling", [&a] { a.task.resampling = record::Switch::kOff; },
      "Readings count as uniform in the angle on the part; wrong for a crank pin");
  verb->add_flag_callback(
      "--as-published", [&a] { a.task.motion = record::SpindleTask::Motion::kAsPublished; },
      "RY by the printed formula, which is wrong");
  verb->add_flag("--inside", a.inside, "A bore: peaks point to the centre");
  verb->add_flag("--json", a.json, "JSON instead of text");
  verb->footer(
      "\nExample: rondure fit spindle tests/data/spindle_dynamic/readings.csv --layout reference "
      "--crank-radius 49 --wheel-radius 299.88 --pin-radius 24.56\n"
      "No interval is stated here: a plan with spindle.uncertainty gives it "
      "(plans/examples/16_four_analyses.json).\n"
      "Columns, keys and formulas: docs/spindle.md");
}

void add_contour(CLI::App& fit_verb, ContourArguments& arguments) {
  auto* verb = fit_verb.add_subcommand(
      "contour",
      "Crank pins in follow grinding: which share of the contour error follows the axes, and which "
      "share repeats");
  add_contour_files(*verb, arguments);
  add_contour_settings(*verb, arguments);
  verb->footer(
      "\nColumns without a mapping (CSV, a header line, a row a sample):\n"
      "  axes   c_deg, c_error_deg, x_error_mm: C position and the errors of both axes, with\n"
      "         d_cmd_mm, if recorded, to check crank, wheel and the zero of C; or\n"
      "         alpha_cmd_deg, d_cmd_mm, alpha_act_deg, d_act_mm: positions, 360 deg at least\n"
      "  pin, main   angle_deg, deviation_um: one turn, steps of at most 1 deg\n"
      "Quantities of a mapping: c, c_error, x_error, alpha_cmd, d_cmd, alpha_act, d_act, angle,\n"
      "deviation, main_angle, main_deviation. Units: deg, mdeg, arcsec, rad, mrad; mm, um, nm.\n"
      "As a file: {\"columns\": {\"x_error\": {\"column\": \"X_FOLLOW\", \"unit\": \"um\", "
      "\"sign\": "
      "-1}}}\n"
      "\nExample:\n"
      "  rondure fit contour --axes tests/data/spec_contour/axes1.csv --pin "
      "tests/data/spec_contour/pin1.csv --prefiltered\n"
      "  rondure fit contour --axes a1.csv,a2.csv,a3.csv,a4.csv --pin p1.csv,p2.csv,p3.csv,p4.csv\n"
      "      --column c_error=C_FOLLOW:mdeg:-1 --column x_error=X_FOLLOW:um:-1 "
      "--phase-offset-deg 12.5\n"
      "No interval is stated here: a plan with contour.uncertainty gives it\n"
      "(plans/examples/16_four_analyses.json).\n"
      "Method, columns, keys of the JSON: docs/contour.md");
}

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
      "No interval is stated here: a plan with wheel.uncertainty gives it "
      "(plans/examples/16_four_analyses.json).\n"
      "Method, columns and JSON: docs/wheel.md");
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
