#include "app/verbs/analyses.h"

#include <CLI/CLI.hpp>

#include "app/verbs/word_option.h"

namespace rondure::app {
namespace {

void add_spindle_geometry(CLI::App& verb, SpindleArguments& a) {
  using Layout = record::SpindleTask::Layout;
  add_words<Layout>(verb, "--layout", a.layout, "published-a, published-b or reference",
                    {Layout::kAngles});
  verb.add_option("--p1-to-p2", a.p1_to_p2_deg,
                  "deg from probe 1 to probe 2, against the rotation of the work");
  verb.add_option("--p2-to-p3", a.p2_to_p3_deg, "deg from probe 2 to probe 3 (a difference)");
  verb.add_option("--p1-to-p3", a.p1_to_p3_deg, "deg from probe 1 to probe 3 (cumulative)");
  verb.add_option("--crank-radius", a.crank_radius_mm,
                  "mm; the probes follow a crank pin (default: 0, an ordinary shaft)");
  verb.add_option("--wheel-radius", a.wheel_radius_mm, "mm; the pivot of the arm is its centre");
  verb.add_option("--pin-radius", a.pin_radius_mm, "mm; of the part that is measured");
}

}  // namespace

void add_spindle(CLI::App& fit_verb, SpindleArguments& a) {
  auto* verb = fit_verb.add_subcommand(
      "spindle", "Separates the form of a part from the motion of its axis (three probes)");
  verb->add_option("FILE", a.file,
                   "CSV with the columns alpha_deg,H1_um,H2_um,H3_um[,beta_deg]; alpha is not "
                   "wrapped")
      ->required();
  add_spindle_geometry(*verb, a);
  verb->add_option("--samples", a.samples, "Of a revolution (default: 1024; 0: as recorded)");
  verb->add_option("--highest-order", a.highest_order, "Highest harmonic recovered (default: 50)");
  verb->add_option("--greatest-gain", a.greatest_gain,
                   "Harmonics with a higher noise gain are not recovered (default: 100)");
  verb->add_option("--probe-noise", a.probe_noise_um,
                   "um, standard deviation of a reading (default: estimated)");
  verb->add_option("--regularise", a.expected_amplitude_um,
                   "um, amplitude expected of a harmonic: weak ones are attenuated");
  add_words<record::SpindleTask::SecondOrder>(*verb, "--second-order", a.second_order,
                                              "auto (default), on or off");
  verb->add_option("--cutoff-upr", a.cutoff_upr,
                   "Gaussian low pass of the profile (default: 50; 0: none)");
  verb->add_flag("--no-resampling", a.no_resampling,
                 "Readings count as uniform in the angle on the part; wrong for a crank pin");
  verb->add_flag("--as-published", a.as_published, "RY by the printed formula, which is wrong");
  verb->add_flag("--inside", a.inside, "A bore: peaks point to the centre");
  verb->add_flag("--json", a.json, "JSON instead of text");
  verb->footer(
      "\nExample: rondure fit spindle tests/data/spindle_dynamic/readings.csv --layout reference "
      "--crank-radius 49 --wheel-radius 299.88 --pin-radius 24.56\n"
      "Columns, keys and formulas: docs/spindle.md");
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

}  // namespace rondure::app
