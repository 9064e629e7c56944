#pragma once

#include "core/error.h"
#include "plans/bodies_plan.h"
#include "plans/contour_plan.h"
#include "plans/five_axis_plan.h"
#include "plans/key_spec.h"
#include "plans/plan.h"
#include "plans/rotary_plan.h"
#include "plans/schema/internal/fixture_drivers_table.h"
#include "plans/schema/simulation_table.h"
#include "plans/spindle_plan.h"
#include "plans/wheel_plan.h"

// The table of the plan: every key with its unit (the suffix of the key), limits, spellings and
// meaning, once. Defaults are the member initialisers of plan.h. A visitor walks it: TableReader
// reads a plan, SchemaWriter writes the JSON Schema, KeyList the tables in docs/.

namespace rondure::plans {

inline constexpr double kMaxCoordinate_mm = 10'000.0;
inline constexpr double kMaxStep_deg = 5.0;

template <class Visitor>
void describe(Visitor& v, PlanHead& p) {
  v.text("name", p.name,
         {.required = true,
          .empty_allowed = false,
          .meaning = "Name of the plan, as the report shows it."});
  v.text("revision", p.revision,
         {.required = true,
          .empty_allowed = false,
          .meaning = "Revision of the plan, e.g. \"A\" or \"2\"."});
  v.text("note", p.note, {.meaning = "Anything a reader of the plan should know."});
}

template <class Visitor>
void describe(Visitor& v, DiscPlan& p) {
  const auto height = [](std::string_view meaning) {
    return required(within(kMaxCoordinate_mm, meaning));
  };
  v.number("from_mm", p.from_mm, height("Lower end of the section, part z."));
  v.number("to_mm", p.to_mm, height("Upper end of the section, part z."));
  v.number("diameter_mm", p.diameter_mm,
           required(above(0.0, 2000.0, "Outer diameter of the section.")));
}

template <class Visitor>
void describe(Visitor& v, SectionPlan& p) {
  describe(v, static_cast<DiscPlan&>(p));
  v.number("bore_diameter_mm", p.bore_diameter_mm, range(0.0, 2000.0, "Of its hole; 0: solid."));
}

template <class Visitor>
void describe(Visitor& v, AlignmentPlan& p) {
  v.text("axis", p.axis,
         {.required = true,
          .empty_allowed = false,
          .meaning = "Id of the touched cylinder whose two sections show the part axis."});
  v.text("face", p.face,
         {.required = true,
          .empty_allowed = false,
          .meaning = "Id of the touched plane that shows the height of the part origin."});
}

template <class Visitor>
void describe(Visitor& v, PartPlan& p) {
  v.text("id", p.id, {.required = true, .empty_allowed = false, .meaning = "Part number."});
  v.text("name", p.name, {.meaning = "What the part is called."});
  v.text("drawing", p.drawing, {.meaning = "Drawing number with its issue."});
  v.number("location_uncertainty_mm", p.location_uncertainty_mm,
           range(0.0, 100.0,
                 "Largest distance of the surface from its nominal place at the first touch."));
  v.number("expansion_per_K", p.expansion_per_K,
           range(0.0, 1e-4,
                 "Thermal expansion, e.g. 11.5e-6 for steel; sizes and forms are then brought to "
                 "20 degC. Left out: as measured."));
  v.number("expansion_uncertainty_per_K", p.expansion_uncertainty_per_K,
           range(0.0, 1e-4, "Its standard uncertainty."));
  v.list("sections", p.sections,
         {.meaning = "Shoulders, necks and neighbours of the inspected surfaces, which the path "
                     "avoids. It avoids touched outside surfaces without an entry."});
  v.numbers("position_mm", p.position_mm,
            within(kMaxCoordinate_mm,
                   "Without a fixture: origin of the part, x, y, z in the machine frame."));
  v.numbers("axis", p.axis,
            within(1.0, "Without a fixture: direction of part z in the machine frame."));
  v.text("system", p.system,
         {.meaning = "Without a fixture: where the frame of the part comes from. plan: position_mm "
                     "and axis. control: the part system that the operator has aligned in the "
                     "control of the machine (PartCsy); position_mm and axis then only serve the "
                     "check of the plan."});
  v.object("alignment", p.alignment,
           {.meaning = "Without a fixture: the run finds the frame of the part before it measures, "
                       "by three touches of a face and six of a cylinder; position_mm and axis "
                       "need to be right within location_uncertainty_mm."});
  v.object("held", p.held,
           {.meaning = "Without a fixture: where a chuck, a vice or a V-block holds the part. The "
                       "tool keeps clear of it."});
}

/// Settings of the server for the driver "ippdme".
template <class Visitor>
void describe_server(Visitor& v, MachinePlan& p) {
  v.text("host", p.host,
         {.empty_allowed = false, .meaning = "ippdme: computer that serves the machine."});
  v.whole("port", p.port, range(1, 65'535, "ippdme: port of the server."));
  v.text("tool", p.tool,
         {.meaning = "ippdme: name of the tool to take. Left out: the active tool."});
  v.number("answer_limit_s", p.answer_limit_s,
           range(0.1, 600.0,
                 "ippdme: longest wait for an acknowledgement or an answer; then the run ends."));
  v.number("motion_limit_s", p.motion_limit_s,
           range(1.0, 3600.0,
                 "ippdme: a motion, tool change or homing that takes this much longer than its "
                 "path needs is stopped."));
  v.text("abort", p.abort,
         {.meaning = "ippdme: whether AbortE stops a motion; with broken, a stop waits for the end "
                     "of the motion."});
  v.text("retract", p.retract,
         {.meaning = "ippdme: by-distance for a server that refuses a negative Retract (back to "
                     "the start of the touch)."});
  v.text(
      "numbers", p.numbers,
      {.meaning =
           "ippdme and simulate-cmm: length of numbers sent. 16-characters counts sign, point and "
           "exponent, for a peer that refuses longer ones; directions are then rounded to 1e-13."});
  v.text("point", p.point,
         {.meaning =
              "ippdme: the point that PtMeas and ScanOnCircle name: surface by the specification, "
              "or center of the tip. A wrong entry ends the run at the first touch."});
}

template <class Visitor>
void describe(Visitor& v, MachinePlan& p) {
  v.text(
      "driver", p.driver,
      {.meaning = "A simulation in this program, or a machine behind I++ DME (docs/ipp-dme.md)."});
  v.number("approach_mm", p.approach_mm,
           above(0.0, 100.0, "The slow search starts this far before the expected contact."));
  v.number("search_mm", p.search_mm,
           above(0.0, 100.0,
                 "The slow search ends this far beyond the expected contact; a deeper keyway ends "
                 "the scan or the touch in it."));
  v.number("clearance_mm", p.clearance_mm,
           above(0.0, 500.0, "Distance kept from part, fixture and table while travelling."));
  v.number("travel_speed_mm_s", p.travel_speed_mm_s, above(0.0, 1000.0, "Speed between touches."));
  v.number("touch_speed_mm_s", p.touch_speed_mm_s,
           above(0.0, 50.0, "Speed while searching the surface."));
  v.number("scan_speed_mm_s", p.scan_speed_mm_s,
           above(0.0, 500.0, "Speed of the tip along a scanned circle."));
  v.number("scale_expansion_per_K", p.scale_expansion_per_K,
           range(0.0, 1e-4,
                 "Expansion of the scales; readings are then brought to 20 degC by their "
                 "temperature. Left out: the machine does it, or nobody does."));
  v.number("scale_expansion_uncertainty_per_K", p.scale_expansion_uncertainty_per_K,
           range(0.0, 1e-4, "Its standard uncertainty."));
  v.numbers("park_mm", p.park_mm,
            within(kMaxCoordinate_mm, "Where the tip waits, above everything; machine frame."));
  v.numbers("volume_min_mm", p.volume_min_mm,
            within(kMaxCoordinate_mm, "Lower ends of the travel of the tip, machine frame."));
  v.numbers("volume_max_mm", p.volume_max_mm,
            within(kMaxCoordinate_mm, "Upper ends of the travel of the tip, machine frame."));
  v.number("step_speed_mm_s", p.step_speed_mm_s,
           above(0.0, 50.0, "Speed between touches of run --step."));
  v.number("resume_limit_um", p.resume_limit_um,
           above(0.0, 1000.0,
                 "Largest difference of a touch that a resumed run repeats; beyond it part or "
                 "machine has moved, and the run must start again."));
  describe_server(v, p);
}

template <class Visitor>
void describe(Visitor& v, DatumSpherePlan& p) {
  v.numbers("center_mm", p.center_mm,
            within(kMaxCoordinate_mm,
                   "Nominal centre in the base frame: the machine frame when the fixture stands in "
                   "its nominal place."));
}

template <class Visitor>
void describe(Visitor& v, DatumHolePlan& p) {
  v.numbers("center_mm", p.center_mm,
            within(kMaxCoordinate_mm, "Of its mouth or foot, base frame."));
  v.number("diameter_mm", p.diameter_mm, required(range(1.0, 500.0, "Nominal diameter.")));
  v.text("side", p.side, {.meaning = "outside: a dowel or bolt head."});
  v.number(
      "depth_mm", p.depth_mm,
      required(above(0.0, 500.0, "Touched depth, free by a ball more, or height above the foot.")));
}

template <class Visitor>
void describe(Visitor& v, DatumSeatPlan& p) {
  v.numbers("point_mm", p.point_mm,
            within(kMaxCoordinate_mm, "Touched from above, base frame; one z for all."));
}

template <class Visitor>
void describe(Visitor& v, DatumPlan& p) {
  v.number("sphere_diameter_mm", p.sphere_diameter_mm,
           range(1.0, 200.0, "Diameter of the spheres."));
  v.list("spheres", p.spheres,
         {.meaning = "Three or more, not on one line. Needed without holes."});
  v.list("holes", p.holes,
         {.meaning = "In place of spheres: two or more holes, dowels or bolt heads."});
  v.list("seat", p.seat,
         {.meaning = "With holes: three or more places of their plane, not on one line."});
  v.whole("points", p.points,
          range(5, 100, "Touches of each sphere, or of each height of a hole."));
  v.whole("heights", p.heights, range(1, 10, "Of the touches of a hole."));
  v.number("uncertainty_mm", p.uncertainty_mm,
           range(0.0, 50.0,
                 "Largest distance of the base, its rim and its bodies from their nominal "
                 "places."));
  v.number("residual_limit_um", p.residual_limit_um,
           above(0.0, 1000.0,
                 "Largest distance of a sphere or hole from its place in the base that was found, "
                 "and form of seat and holes."));
}

template <class Visitor>
void describe(Visitor& v, FixturePlan& p) {
  const NumberSpec coordinate = {
      .at_least = -kMaxCoordinate_mm, .at_most = kMaxCoordinate_mm, .meaning = {}};
  const auto place = [&](std::string_view meaning) {
    NumberSpec spec = coordinate;
    spec.meaning = meaning;
    return spec;
  };
  const auto limit = [](std::string_view meaning) {
    return NumberSpec{
        .at_least = -90.0, .at_most = 90.0, .code = core::Code::kPoseRange, .meaning = meaning};
  };
  v.text("id", p.id,
         {.meaning = "Name of this fixture, as on its label: a calibration belongs to it."});
  v.text("driver", p.driver,
         {.meaning =
              "What turns the part: a simulation, rotary axes of the machine (AlignPart), Zaber or "
              "Thorlabs stages, or a hand. Stages may also turn the part of a simulated machine. "
              "fixed: no axes, the part stands still (docs/cmm-without-fixture.md); the default "
              "where `fixture` is left out."});
  v.numbers("axis_point_mm", p.axis_point_mm,
            place("A point of the base-fixed axis (alpha), machine frame."));
  v.numbers(
      "axis_offset_mm", p.axis_offset_mm,
      place("From that axis to the carried axis (beta), hoop frame; 0 when the axes intersect."));
  v.numbers("part_position_mm", p.part_position_mm,
            place("Origin of the part, frame of the clamping ring."));
  v.number("min_alpha_deg", p.min_alpha_deg,
           limit("Lower end of travel about the base-fixed axis."));
  v.number("max_alpha_deg", p.max_alpha_deg,
           limit("Upper end of travel about the base-fixed axis."));
  v.number("min_beta_deg", p.min_beta_deg, limit("Lower end of travel about the carried axis."));
  v.number("max_beta_deg", p.max_beta_deg, limit("Upper end of travel about the carried axis."));
  v.number("resolution_deg", p.resolution_deg,
           range(0.0, 5.0, "Smallest step the fixture can hold; 0: any."));
  v.number("rim_height_mm", p.rim_height_mm,
           place("Height of the rim of the bowl, machine z: the tip never goes below."));
  v.number("clamp_from_mm", p.clamp_from_mm,
           place("Lower end of the band that the ring clamps, part z. No band unless it is below "
                 "clamp_to_mm."));
  v.number("clamp_to_mm", p.clamp_to_mm, place("Upper end of the clamped band, part z."));
  v.number("ring_diameter_mm", p.ring_diameter_mm,
           range(0.0, 5000.0,
                 "Outer diameter of the clamping ring; 0: unknown, then nothing is touched at or "
                 "below the clamped band."));
  v.number("rim_diameter_mm", p.rim_diameter_mm,
           range(0.0, 5000.0,
                 "Outer diameter of the bowl, about axis_point_mm; 0: unknown, then the tip goes "
                 "nowhere below rim_height_mm."));
  v.number("table_height_mm", p.table_height_mm, place("Height of the table, machine z."));
  v.list("bodies", p.bodies, {.meaning = "What else paths keep clear of (docs/planning.md)."});
  v.object("datum", p.datum,
           {.meaning = "Reference spheres or fixing holes of the base, touched before a run; "
                       "axis_point_mm is then in their base frame."});
  v.object(
      "calibration", p.calibration,
      {.meaning = "Errors of the fixture, which the run corrects (docs/fixture-calibration.md). "
                  "Left out: the fixture is taken as nominal."});
  v.object("zaber", p.zaber, {.meaning = "Connection and stages of the driver zaber."});
  v.object("thorlabs", p.thorlabs, {.meaning = "thorlabs: the units of the two axes."});
  v.object("reached_pose", p.reached_pose,
           {.meaning = "manual: reference spheres that turn with the part; their touches give the "
                       "pose reached."});
}

template <class Visitor>
void describe(Visitor& v, QualificationPlan& p) {
  v.text("artefact", p.artefact,
         {.meaning =
              "column: an upright certified cylinder, touched from its side; it says nothing of "
              "approaches from above."});
  v.number("sphere_diameter_mm", p.sphere_diameter_mm,
           range(1.0, 200.0, "Certified diameter of the reference sphere."));
  v.numbers("sphere_center_mm", p.sphere_center_mm,
            within(kMaxCoordinate_mm, "Centre of the reference sphere, machine frame."));
  v.whole("points", p.points, range(5, 100, "Touches on the reference sphere."));
  v.number("form_limit_um", p.form_limit_um,
           {.at_least = 0.0,
            .at_most = 1000.0,
            .above = true,
            .meaning = "Largest probing form (spread of the touches) of a usable probe."});
  v.number(
      "radius_tolerance_um", p.radius_tolerance_um,
      above(0.0, 1000.0, "Largest difference between the effective and the nominal tip radius."));
  v.number("stem_diameter_mm", p.stem_diameter_mm,
           range(0.0, 200.0, "Diameter of the stem below the sphere; 0: a third of the sphere's."));
  v.number("column_diameter_mm", p.column_diameter_mm,
           range(1.0, 500.0, "Certified diameter of the column. Needed with one."));
  v.numbers("column_point_mm", p.column_point_mm,
            within(kMaxCoordinate_mm, "A point of its axis, machine frame."));
  v.number("column_from_mm", p.column_from_mm,
           within(kMaxCoordinate_mm, "Lower end of what is touched, from that point up."));
  v.number("column_to_mm", p.column_to_mm, within(kMaxCoordinate_mm, "Upper end of the column."));
  v.whole("heights", p.heights, range(2, 20, "Of the touches, spread over the column."));
  v.whole("points_per_height", p.points_per_height, range(6, 100, "Touches of each height."));
  v.number("column_slope_deg", p.column_slope_deg,
           range(0.0, 60.0, "What is approached more steeply is void."));
}

template <class Visitor>
void describe(Visitor& v, ProbePlan& p) {
  v.number("tip_diameter_mm", p.tip_diameter_mm,
           above(0.0, 50.0, "Nominal diameter of the ball of the stylus."));
  v.number("stylus_length_mm", p.stylus_length_mm,
           range(0.0, 1000.0,
                 "From the centre of the ball up to the holder; 0: unknown, then only the ball is "
                 "kept clear."));
  v.number("stylus_diameter_mm", p.stylus_diameter_mm,
           range(0.0, 50.0, "Diameter of the shaft, less than the ball's. Needed with a length."));
  v.number(
      "holder_diameter_mm", p.holder_diameter_mm,
      range(0.0, 500.0, "Diameter of what carries the stylus (extension, probe head); 0: none."));
  v.object("qualification", p.qualification,
           {.meaning = "Reference sphere that gives the effective tip radius before a run."});
}

template <class Visitor>
void describe(Visitor& v, EnvironmentPlan& p) {
  v.number("min_degC", p.min_degC,
           range(10.0, 40.0, "A part colder than this makes the result void."));
  v.number("max_degC", p.max_degC,
           range(10.0, 40.0, "A part warmer than this makes the result void."));
  v.number("temperature_uncertainty_K", p.temperature_uncertainty_K,
           range(0.0, 5.0, "Standard uncertainty of a measured or assumed temperature."));
  v.number("assumed_degC", p.assumed_degC,
           range(10.0, 40.0,
                 "Temperature of part and scales where no sensor gives one; reports print it as "
                 "declared. Left out: such a result is void."));
  v.number("max_drift_K", p.max_drift_K,
           above(0.0, 10.0,
                 "Of spindle, wheel, contour, rotary_axes and five_axis: a greater change at one "
                 "place during the measurement makes the result void."));
}

template <class Visitor>
void describe(Visitor& v, NominalPlan& p) {
  v.number("diameter_mm", p.diameter_mm,
           {.at_least = 1.0,
            .at_most = 1000.0,
            .code = core::Code::kUnits,
            .hint = "that suggests metres or micrometres, give the diameter in mm",
            .meaning = "Diameter on the drawing, of a cone at from_mm. Needed unless the points "
                       "come from a file; the limits of a diameter are deviations from it."});
  v.number(
      "from_mm", p.from_mm,
      {.at_least = -kMaxCoordinate_mm,
       .at_most = kMaxCoordinate_mm,
       .meaning =
           "Lower end of the surface, part z. A circle is touched in the middle of its surface."});
  v.number("to_mm", p.to_mm, within(kMaxCoordinate_mm, "Upper end of the surface, part z."));
  v.number("half_angle_deg", p.half_angle_deg,
           within(85.0, "Of a cone: half of its angle; > 0: it opens along part z."));
  v.number("z_mm", p.z_mm, within(kMaxCoordinate_mm, "Of a plane: its place, part z."));
  v.text("faces", p.faces,
         {.meaning = "Of a plane: the side away from the material; up: toward greater z of part or "
                     "file. Needed where it is touched, is a datum or has a run-out."});
  const auto edge = [](std::string_view meaning) { return range(0.0, 1000.0, meaning); };
  v.number("from_diameter_mm", p.from_diameter_mm, edge("Of a plane: its inner edge."));
  v.number("to_diameter_mm", p.to_diameter_mm, edge("Of a plane: its outer edge."));
  v.numbers("center_mm", p.center_mm,
            within(kMaxCoordinate_mm, "Of a sphere: its centre, part frame."));
}

template <class Visitor>
void describe(Visitor& v, SamplingPlan& p) {
  v.text(
      "method", p.method,
      {.meaning =
           "touch: single touches; scan: each layer in one circle, where the machine can scan."});
  v.whole("layers", p.layers,
          range(1, 1000,
                "Sections along the axis: at least 2 for a cylinder; 1 for a circle, "
                "also when left out. Of a plane: circles, the innermost first."));
  v.whole("points_per_layer", p.points_per_layer,
          range(3, 100'000,
                "Equispaced points of each section; at least 4 for a circle. Of a scan: at least 7 "
                "per undulation of the filter, e.g. 360 at 50 UPR."));
  v.number("margin_mm", p.margin_mm,
           range(0.0, kMaxCoordinate_mm,
                 "Distance of the first and last layers from the ends of the surface, of a plane "
                 "from its edges."));
  v.number("start_deg", p.start_deg,
           within(360.0,
                  "Angle of the first point of the lowest layer, from part x, counter-clockwise "
                  "seen against part z."));
  v.number(
      "stagger", p.stagger,
      range(0.0, 1.0,
            "Shift of the angles from layer to layer: 0, none; 1, the layers interleave evenly."));
}

template <class Visitor>
void describe(Visitor& v, MeasuringPosePlan& p) {
  const NumberSpec angle = {.at_least = -90.0,
                            .at_most = 90.0,
                            .required = true,
                            .code = core::Code::kPoseRange,
                            .meaning = "Angle of the fixture."};
  v.number("alpha_deg", p.alpha_deg, angle);
  v.number("beta_deg", p.beta_deg, angle);
}

template <class Visitor>
void describe(Visitor& v, PoseSearchPlan& p) {
  using record::Strategy;
  const NumberSpec start = {.at_least = -90.0,
                            .at_most = 90.0,
                            .code = core::Code::kPoseRange,
                            .meaning = "Angle of the fixture before the first touch."};
  v.text("strategy", p.strategy,
         {.one_of = {name_of(Strategy::kGuided), name_of(Strategy::kAsPublished),
                     name_of(Strategy::kVirtual), name_of(Strategy::kStartPose),
                     name_of(Strategy::kMerged)},
          .meaning =
              "How the levelling pose is found. guided: each cloud predicts the next pose. "
              "as-published: grid of steps_deg. virtual: "
              "one cloud, turned in software. start-pose: no search, so that several features "
              "share one clamping; the default for a datum and what refers to it, and without a "
              "fixture; always so "
              "for a circle, plane, cone or sphere. merged: no search; measured in each of `poses` "
              "where it can be reached, clouds joined (docs/several-poses.md)."});
  v.list("poses", p.poses,
         {.meaning = "merged: at least two; every target must be reached in one of them, and "
                     "should be in several."});
  v.text("merge", p.merge,
         {.meaning = "merged: how clouds are joined. joint: pose errors are solved together with "
                     "the part. kinematics: the fixture is believed."});
  v.number("start_alpha_deg", p.start_alpha_deg, start);
  v.number("start_beta_deg", p.start_beta_deg, start);
  v.numbers("steps_deg", p.steps_deg,
            {.at_least = 0.0,
             .at_most = kMaxStep_deg,
             .above = true,
             .code = core::Code::kStep,
             .meaning = "Steps of the grid, from coarse to fine (as-published, virtual)."});
  v.number("min_step_deg", p.min_step_deg,
           {.at_least = 0.0,
            .at_most = kMaxStep_deg,
            .above = true,
            .code = core::Code::kStep,
            .meaning = "Step halving ends below this step (virtual)."});
  v.whole("max_poses", p.max_poses,
          range(1, 100, "Levelling gives up after so many poses (guided)."));
  v.whole("repeats", p.repeats,
          range(1, 1000,
                "Touches per point of the final cloud; their mean is evaluated. Scans are repeated "
                "as often: 1 is usual."));
}

template <class Visitor>
void describe(Visitor& v, ColumnPlan& p) {
  v.text("column", p.column,
         {.required = true,
          .empty_allowed = false,
          .meaning = "Name that the analysis gives it, with its unit, e.g. H1_um; of points x, y "
                     "or z."});
  v.text("in_file", p.in_file,
         {.required = true,
          .empty_allowed = false,
          .meaning = "Name in the file; of points also the number of the column, from 1."});
}

template <class Visitor>
void describe(Visitor& v, SourcePlan& p) {
  v.text("file", p.file,
         {.required = true,
          .empty_allowed = false,
          .meaning = "File of points (docs/points.md) or of spindle readings (docs/spindle.md), "
                     "relative to the plan."});
  v.number(
      "tip_diameter_mm", p.tip_diameter_mm,
      {.at_least = 0.0,
       .at_most = 50.0,
       .above = true,
       .meaning =
           "Of the probe that took the points; without it radii stay those of the tip centre."});
  v.text(
      "points", p.points,
      {.meaning =
           "surface: corrected hits, or points of a scanner or a mesh, whose sizes need no tip."});
  v.list("columns", p.columns,
         {.meaning = "Of points, which columns are x, y and z. Of a spindle, columns named "
                     "otherwise in its file; the rest are passed over."});
  v.text("unit", p.unit,
         {.meaning = "Of the points. Left out: as the head of the file says, otherwise mm."});
  v.text("mesh", p.mesh,
         {.meaning = "accepted: vertices of a mesh (STL, PLY with faces) are judged, although "
                     "another program computed them. Left out: refused."});
  v.text("layers", p.layers,
         {.meaning = "Layers of points: by the column layer, by groups of z, or none (a cloud). "
                     "Left out: by the column, where there is one."});
  v.text("feature", p.feature,
         {.meaning = "Takes only rows whose column feature says this. All features of a file were "
                     "measured in one clamping."});
  v.text("others", p.others,
         {.meaning = "left-out: rows of the file that no feature of the plan takes are left out, "
                     "and the report names them. Left out: refused."});
  v.text("clamping", p.clamping,
         {.meaning = "Name of the clamping, in one coordinate system. A datum in another file "
                     "needs the same name in both."});
  v.text("measured_utc", p.measured_utc,
         {.meaning = "Time of measurement, e.g. 2026-11-21T02:33:02Z. With valid_for_days, data "
                     "older than that at the start of the run, or measured after it, are void."});
  v.number("valid_for_days", p.valid_for_days,
           above(0.0, 36'500.0,
                 "How long the data stand for the part: until it is worked, the wheel dressed or "
                 "the machine set up anew."));
  v.text("plane", p.plane,
         {.meaning = "Of a circle whose plane of points leans: points evaluates it in that plane, "
                     "nominal about z of the file. Left out: points, and void where the two differ "
                     "by more than a tenth of the tolerance."});
}

template <class Visitor>
void describe(Visitor& v, FeaturePlan& p) {
  v.text("id", p.id,
         {.required = true,
          .empty_allowed = false,
          .meaning = "Name of the feature, unique in the plan."});
  v.text(
      "type", p.type,
      {.required = true,
       .meaning = "The surface, or an analysis: spindle (part form and axis motion from three "
                  "probes), wheel (grinding wheel, from points of its edge), contour (crank pins "
                  "in follow grinding), rotary_axes (calibration of the fixture with balls), "
                  "five_axis (axes C and A of a swivel head)."});
  v.text("side", p.side, {.meaning = "outside: a shaft; inside: a bore."});
  v.text(
      "letter", p.letter,
      {.meaning =
           "Datum letter, up to 3 letters, unique in the plan. Left out: the id names the datum."});
  v.object("nominal", p.nominal, {.meaning = "The surface on the drawing, part frame: axis z."});
  v.object("sampling", p.sampling, {.meaning = "Where it is touched."});
  v.object("pose_search", p.pose_search, {.meaning = "How the fixture levels it."});
  v.object("spindle", p.spindle, {.meaning = "Probes and evaluation of the type spindle."});
  v.object("wheel", p.wheel, {.meaning = "Points and evaluation of the type wheel."});
  v.object("contour", p.contour, {.meaning = "Crank, files and evaluation of the type contour."});
  v.object("rotary_axes", p.rotary_axes,
           {.meaning = "Balls, stations and poses of the type rotary_axes."});
  v.object("five_axis", p.five_axis,
           {.meaning = "Set-ups, stations, poses and table of the type five_axis."});
  v.object("source", p.source,
           {.meaning = "Points from a file in place of touches; no machine is needed then."});
  v.list("exclude", p.exclude,
         {.meaning = "Windows left out of the surface: a keyway, an oil hole. The machine still "
                     "touches and scans them."});
  v.object("defaults", p.defaults,
           {.meaning = "Used where a characteristic does not give these keys."});
  v.object("decision_rule", p.decision_rule,
           {.meaning = "Rule of this feature; it replaces that of the plan as a whole."});
  v.list("characteristics", p.characteristics,
         {.meaning = "Call-outs of the drawing, and what else is reported."});
}

template <class Visitor>
void describe(Visitor& v, ReportsPlan& p) {
  v.texts("formats", p.formats,
          {.one_of = spec_of_words<record::Format>({.meaning = {}}).one_of,
           .empty_allowed = false,
           .meaning = "Reports that a run writes: page, PDF, all numbers, tables, QIF 3.0 results, "
                      "DMIS output block, corrections for machines."});
  v.text("paper", p.paper, {.meaning = "Paper that the PDF is printed on."});
  v.text("archive", p.archive,
         {.meaning = "Archive of finished runs: a file of SQLite, relative to the plan; "
                     "postgresql://user@host/database without a password; none. Left out or empty: "
                     "archive.db beside the run directory."});
  v.text("laboratory", p.laboratory,
         {.meaning = "Whose reports they are: a JSON file, relative to the plan, with the texts "
                     "name, address, country and contact, and logo, a PNG or JPEG file relative to "
                     "the plan."});
}

template <class Visitor>
void describe(Visitor& v, Plan& p) {
  v.passed_over("$schema", "Place of the schema, for editors; the program does not read it.");
  v.object("plan", p.plan, {.required = true, .meaning = "The plan itself."});
  v.object("part", p.part, {.required = true, .meaning = "What is inspected."});
  v.object("machine", p.machine,
           {.meaning = "The coordinate measuring machine. Needed when a feature is touched."});
  v.object("fixture", p.fixture,
           {.meaning = "The two-axis fixture. Needed when a feature is touched."});
  v.object("probe", p.probe, {.meaning = "The touch probe. Needed when a feature is touched."});
  v.object("environment", p.environment,
           {.meaning = "Temperature limits outside which a result is void. They hold for points of "
                       "files and series only where this object stands."});
  v.list("features", p.features,
         {.required = true, .empty_allowed = false, .meaning = "What is measured, in this order."});
  v.object("defaults", p.defaults,
           {.meaning = "Used where neither characteristic nor feature gives these keys."});
  v.object("decision_rule", p.decision_rule,
           {.meaning = "How a value and its tolerance make a verdict."});
  v.object("uncertainty", p.uncertainty,
           {.meaning = "Declared influences on touched features and points of a file. Left out: "
                       "their values have no interval."});
  v.object("simulation", p.simulation,
           {.meaning = "The hidden truth of a simulation; no evaluation reads it. Needed with "
                       "simulated drivers. Empty, {}: a typical part on a typical machine; with "
                       "any key, what is left out is without error."});
  v.object("reports", p.reports, {.meaning = "What a run writes besides its journal."});
}

}  // namespace rondure::plans
