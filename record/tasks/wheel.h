#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "record/key_spec.h"
#include "record/tasks/analysis_influences.h"
#include "record/tasks/feature_reference.h"
#include "record/words.h"

namespace rondure::record {

/// The surface that the wheel is to grind, and the generation of its path.
struct GroundSurfaceTask {
  enum class Form { kPolynomial, kAsphere, kTable };
  enum class Radius { kMean, kEffective };

  Form form = Form::kPolynomial;
  std::vector<double> coefficients;
  std::optional<double> vertex_radius_mm;
  double conic = 0.0;
  std::vector<double> even_terms;
  std::vector<double> table_x_mm;
  std::vector<double> table_z_mm;
  std::vector<double> removal_x_mm;
  std::vector<double> removal_depth_um;
  double from_mm = 0.0;
  double to_mm = 0.0;
  double step_mm = 0.1;
  std::optional<double> cusp_um;  ///< Replaces the step.
  Radius radius = Radius::kMean;
  double wheel_arc_from_deg = -90.0;
  double wheel_arc_to_deg = 90.0;
  double repeatability_um = 0.0;
  std::optional<double> touch_off_mm;
};

RONDURE_WORDS(GroundSurfaceTask::Form, {kPolynomial, "polynomial"}, {kAsphere, "asphere"},
              {kTable, "table"});
RONDURE_WORDS(GroundSurfaceTask::Radius, {kMean, "mean"}, {kEffective, "effective"});

/// How the program of a path is written. A member initialiser is the default of its key.
struct WheelProgramTask {
  double feed_mm_min = 100.0;
  double retract_mm = 5.0;
  Switch lowest_point = Switch::kOff;     ///< z of the lowest point of the wheel, not its centre.
  std::optional<double> surface_from_mm;  ///< Where the surface begins that must not be cut into.
  std::optional<double> surface_to_mm;
};

/// Settings of the evaluation of a feature of the type "wheel" in plan and journal: a grinding
/// wheel, from points of its edge. A member initialiser is the default of its key.
struct WheelTask {
  enum class Mode { kIndexed, kEnvelope };
  enum class Center { kLeastSquares, kAsPublished };
  enum class ShortArc { kRefused, kAllowed };

  Mode mode = Mode::kIndexed;  ///< Required in a plan.
  std::optional<double> nominal_radius_mm;
  std::optional<double> axis_x_mm;  ///< Both coordinates or none.
  std::optional<double> axis_z_mm;
  std::optional<FeatureReference> axis_from;  ///< In place of the coordinates.
  Center center = Center::kLeastSquares;
  std::optional<double> kappa_limit;
  Switch robust = Switch::kOff;
  ShortArc short_arc = ShortArc::kRefused;
  std::optional<GroundSurfaceTask> surface;
  std::optional<WheelProgramTask> program;  ///< Of the path over the surface.
  std::optional<WheelInfluencesTask> uncertainty;
  std::optional<double> expansion_per_K;  ///< Of the wheel; none: its radius stays as measured.
};

RONDURE_WORDS(WheelTask::Mode, {kIndexed, "indexed"}, {kEnvelope, "envelope"});
RONDURE_WORDS(WheelTask::Center, {kLeastSquares, "least-squares"}, {kAsPublished, "as-published"});
RONDURE_WORDS(WheelTask::ShortArc, {kRefused, "refused"}, {kAllowed, "allowed"});

namespace wheel_specs {

inline NumberSpec place_mm(std::string_view meaning) { return within(10'000.0, meaning); }

inline NumberSpec radius_mm(bool required, std::string_view meaning) {
  return {.at_least = 0.5,
          .at_most = 1000.0,
          .required = required,
          .code = core::Code::kUnits,
          .hint = "that suggests another unit, give it in mm",
          .meaning = meaning};
}

}  // namespace wheel_specs

template <class Visitor>
void describe_surface_form(Visitor& v, GroundSurfaceTask& p) {
  v.text("form", p.form,
         {.required = true,
          .meaning = "Surface z = f(x) [mm], material below. polynomial: coefficients; asphere: "
                     "vertex_radius_mm, conic, even_terms; table: table_x_mm, table_z_mm."});
  v.numbers("coefficients", p.coefficients,
            within(1e9, "a0, a1, a2, ... of a polynomial in x [mm]."));
  v.number("vertex_radius_mm", p.vertex_radius_mm,
           within(1e7, "Of an asphere, 1/c; above 0: hollow; left out: a plane with even terms."));
  v.number("conic", p.conic, within(1e4, "K: 0 a sphere, -1 a paraboloid."));
  v.numbers("even_terms", p.even_terms, within(1e9, "A2, A4, A6, ... of an asphere."));
  v.numbers("table_x_mm", p.table_x_mm,
            wheel_specs::place_mm("x of a table, rising; five places or more."));
  v.numbers("table_z_mm", p.table_z_mm, wheel_specs::place_mm("z of a table."));
  v.numbers("removal_x_mm", p.removal_x_mm,
            wheel_specs::place_mm("x of a depth that is taken off the surface."));
  v.numbers("removal_depth_um", p.removal_depth_um, range(0.0, 1e6, "That depth."));
}

template <class Visitor>
void describe(Visitor& v, GroundSurfaceTask& p) {
  describe_surface_form(v, p);
  NumberSpec end = wheel_specs::place_mm("First contact, x.");
  end.required = true;
  v.number("from_mm", p.from_mm, end);
  end.meaning = "Last contact, x.";
  v.number("to_mm", p.to_mm, end);
  v.number("step_mm", p.step_mm, above(0.0, 1000.0, "Step of x."));
  v.number("cusp_um", p.cusp_um,
           above(0.0, 1000.0, "Highest cusp between passes; gives the step in place of step_mm."));
  v.text("radius", p.radius,
         {.meaning = "Radius of the path. effective: of the point farthest from the axis."});
  v.number("wheel_arc_from_deg", p.wheel_arc_from_deg,
           within(90.0, "Trued arc of the wheel, from its lowest point: begin."));
  v.number("wheel_arc_to_deg", p.wheel_arc_to_deg, within(90.0, "End of the trued arc."));
  v.number("repeatability_um", p.repeatability_um,
           range(0.0, 1000.0, "Of the grinding machine: no compensation is better."));
  v.number("touch_off_mm", p.touch_off_mm,
           wheel_specs::place_mm("x where the depth is touched off; left out: 0."));
}

template <class Visitor>
void describe(Visitor& v, WheelProgramTask& p) {
  v.number("feed_mm_min", p.feed_mm_min, above(0.0, 10'000.0, "Feed along the path."));
  v.number("retract_mm", p.retract_mm,
           range(0.0, 1000.0, "Height above the path, before and after it."));
  v.text("lowest_point", p.lowest_point,
         {.meaning = "on: z of the lowest point of the wheel in place of its centre."});
  v.number("surface_from_mm", p.surface_from_mm,
           wheel_specs::place_mm("x where the surface begins that must not be cut into; left out: "
                                 "from_mm, or that of the table."));
  v.number("surface_to_mm", p.surface_to_mm, wheel_specs::place_mm("x where it ends."));
}

template <class Visitor>
void describe(Visitor& v, WheelTask& p) {
  v.text("mode", p.mode,
         {.required = true,
          .empty_allowed = false,
          .meaning = "indexed: wheel at rest at known angles, points of its body. envelope: wheel "
                     "at speed, points of the circle it sweeps; no run-out."});
  v.number("nominal_radius_mm", p.nominal_radius_mm,
           wheel_specs::radius_mm(false,
                                  "Nominal radius; R must be within 5 % of it. The "
                                  "characteristic radius needs it."));
  v.number("axis_x_mm", p.axis_x_mm,
           wheel_specs::place_mm("Spindle axis, from calibration; run-out needs it."));
  v.number("axis_z_mm", p.axis_z_mm, wheel_specs::place_mm("The same, z."));
  v.object("axis_from", p.axis_from,
           {.meaning = "Instead of axis_x_mm and axis_z_mm: centre of an earlier wheel of mode "
                       "envelope on the same stage, with its uncertainty."});
  v.text("center", p.center,
         {.meaning = "as-published: mean of the centres of quadruples of points."});
  v.number("kappa_limit", p.kappa_limit,
           range(1.0, 1e9, "Worst conditioning accepted; left out: 5, or twice the best."));
  v.number("expansion_per_K", p.expansion_per_K,
           range(0.0, 1e-4,
                 "Expansion of the wheel: its radius is judged at 20 degC, by the temperature of "
                 "its points. Left out: as measured."));
  v.text("robust", p.robust, {.meaning = "on: isolated points beyond 5 scales are dropped."});
  v.text("short_arc", p.short_arc, {.meaning = "Less than 20 deg of the circle."});
  v.object("surface", p.surface, {.meaning = "A surface to grind: gives the wheel-centre path."});
  v.object(
      "program", p.program,
      {.meaning = "The path over the surface as G-code, beside its table, where reports.formats "
                  "has corrections."});
  v.object("uncertainty", p.uncertainty,
           {.meaning = "Declared influences: standard uncertainty, or value and distribution. "
                       "Without them: no interval."});
}

}  // namespace rondure::record
