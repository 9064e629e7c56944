#include "app/verbs/rotary_axes_command.h"

#include <CLI/CLI.hpp>

namespace rondure::app {

void add_rotary_axes(CLI::App& fit_verb, RotaryAxesArguments& a) {
  auto* verb = fit_verb.add_subcommand(
      "rotary-axes", "Six errors of a rotary axis at each angle, from measured balls");
  verb->add_option("FILE", a.files, "CSV, one or more; a file may hold several axes")->required();
  const auto add_list = [&](const char* name, std::vector<double>& list, const char* meaning) {
    return verb->add_option(name, list, meaning)->delimiter(',')->allow_extra_args(false);
  };
  verb->add_option("--axis", a.axis,
                   "Direction of the axis: x, y, z or a,b,c (default: by its name: A or phi_alpha "
                   "x, B or phi_beta y, C z)")
      ->type_name("DIRECTION");
  add_list("--origin", a.origin_mm, "mm, a point of the axis (default: 0,0,0)")->type_name("X,Y,Z");
  verb->add_option("--reference-deg", a.reference_deg, "Angle of the reference pose (default: 0)");
  add_list("--range-deg", a.range_deg, "Range of the axis; stations outside are refused")
      ->type_name("LO,HI");
  verb->add_option("--method", a.method,
                   "exact (default), linear, or as-published: the printed matrices (3 balls)")
      ->check(CLI::IsMember({"exact", "linear", "as-published"}));
  verb->add_option("--curve", a.curve,
                   "Between stations: spline (default), fourier (circle) or polynomial (arc)")
      ->check(CLI::IsMember({"spline", "fourier", "polynomial"}));
  add_list("--at", a.place_mm, "mm, a place of the part: its point uncertainty is stated")
      ->type_name("X,Y,Z");
  verb->add_flag("--keep-outliers", a.keep_outliers, "No ball is left out");
  verb->add_flag("--json", a.json, "JSON instead of text");
  verb->footer(
      "\nColumns: axis,station_deg,ball,x_mm,y_mm,z_mm,u_um (or ux_um,uy_um,uz_um)[,direction].\n"
      "Rows of the reference pose have the word reference for their station; measure it at start,\n"
      "middle and end. direction: + or - where each station is approached from both sides.\n"
      "\nExample: rondure fit rotary-axes tests/data/spec_rotary/c_axis.csv\n"
      "How to set up balls, formulas, keys of the JSON: docs/rotary-axes.md");
}

}  // namespace rondure::app
