#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "plans/bodies_plan.h"
#include "plans/contour_plan.h"
#include "plans/five_axis_plan.h"
#include "plans/fixture_drivers_plan.h"
#include "plans/machine_errors_plan.h"
#include "plans/rotary_plan.h"
#include "plans/spindle_plan.h"
#include "plans/wheel_plan.h"
#include "record/decision_rule.h"
#include "record/points/points.h"
#include "record/run_record.h"
#include "record/tasks/characteristic.h"
#include "record/tasks/contour.h"
#include "record/tasks/five_axis.h"
#include "record/tasks/rotary_axes.h"
#include "record/tasks/run.h"
#include "record/tasks/spindle.h"
#include "record/tasks/surface.h"
#include "record/tasks/uncertainty.h"
#include "record/tasks/wheel.h"
#include "record/words.h"

namespace rondure::plans {

// The plan with the names and units of its JSON: degrees and micrometres where the key says so.
// Keys, units, ranges and meanings are defined only in plans/schema/internal/plan_table.h; a member
// initialiser here is the default.

using record::name_of;  // finds the words of the enums below

struct PlanHead {
  std::string name;
  std::string revision;
  std::string note;
};

/// A disc about the part axis, which the path planner avoids.
struct DiscPlan {
  double from_mm = 0.0;  ///< Lower end, part z.
  double to_mm = 0.0;
  double diameter_mm = 0.0;
};

/// A piece of the part beside the inspected surfaces.
struct SectionPlan : DiscPlan {
  double bore_diameter_mm = 0.0;  ///< 0: solid.
};

/// The two touched features from whose first touches the frame of a part without a fixture comes.
struct AlignmentPlan {
  std::string axis;  ///< A cylinder: two of its sections show part z.
  std::string face;  ///< A plane: it shows the height of the origin.
};

struct PartPlan {
  enum class System { kPlan, kControl };

  std::string id;
  std::string name;
  std::string drawing;
  double location_uncertainty_mm =
      1.0;  ///< Largest deviation of the surface from nominal at first touch.
  std::optional<double> expansion_per_K;  ///< None: no correction to 20 degC.
  double expansion_uncertainty_per_K = 1e-6;
  std::vector<SectionPlan> sections;
  // The following members are for the fixture "fixed".
  std::array<double, 3> position_mm = {0.0, 0.0, 0.0};  ///< Part origin, machine frame.
  std::array<double, 3> axis = {0.0, 0.0, 1.0};         ///< Direction of part z; any length > 0.
  System system = System::kPlan;                        ///< kControl: PartCsy of I++ DME.
  std::optional<AlignmentPlan> alignment;
  std::optional<DiscPlan> held;  ///< Contains what holds it: chuck, vice, V-block.
};

RONDURE_WORDS(PartPlan::System, {kPlan, "plan"}, {kControl, "control"});

struct MachinePlan {
  enum class Driver { kSimulated, kIppdme };
  enum class Abort { kWorks, kBroken };
  enum class Retract { kToApproach, kByDistance };
  enum class Numbers { kSixteenDigits, kSixteenCharacters };
  enum class Point { kSurface, kCenter };

  Driver driver = Driver::kSimulated;
  double approach_mm = 3.0;   ///< Start of the search before the expected contact.
  double search_mm = 3.0;     ///< End of the search beyond it.
  double clearance_mm = 5.0;  ///< Kept from the part while travelling.
  double travel_speed_mm_s = 100.0;
  double touch_speed_mm_s = 5.0;
  double scan_speed_mm_s = 10.0;
  /// Expansion of the scales; none: the machine compensates.
  std::optional<double> scale_expansion_per_K;
  double scale_expansion_uncertainty_per_K = 1e-6;
  std::array<double, 3> park_mm = {0.0, 0.0, 500.0};  ///< Tip position above all obstacles.
  std::array<double, 3> volume_min_mm = {-10'000.0, -10'000.0, -10'000.0};  ///< Reach of the tip.
  std::array<double, 3> volume_max_mm = {10'000.0, 10'000.0, 10'000.0};
  double step_speed_mm_s = 10.0;  ///< Speed for a first run in single steps.
  double resume_limit_um = 5.0;   ///< Largest change of a repeated touch at which a run is resumed.
  // The following members are for the driver "ippdme".
  std::string host = "127.0.0.1";
  int port = 1294;
  std::string tool;  ///< Empty: the active tool.
  double answer_limit_s = 5.0;
  double motion_limit_s = 120.0;
  Abort abort = Abort::kWorks;
  Retract retract = Retract::kToApproach;
  Numbers numbers = Numbers::kSixteenDigits;  ///< On the wire.
  Point point = Point::kSurface;              ///< Named by PtMeas; kCenter: of the tip.
};

RONDURE_WORDS(MachinePlan::Driver, {kSimulated, "simulated"}, {kIppdme, "ippdme"});
RONDURE_WORDS(MachinePlan::Abort, {kWorks, "works"}, {kBroken, "broken"});
RONDURE_WORDS(MachinePlan::Retract, {kToApproach, "to-approach"}, {kByDistance, "by-distance"});
RONDURE_WORDS(MachinePlan::Numbers, {kSixteenDigits, "16-digits"},
              {kSixteenCharacters, "16-characters"});
RONDURE_WORDS(MachinePlan::Point, {kSurface, "surface"}, {kCenter, "center"});

/// A reference sphere on the base of the fixture.
struct DatumSpherePlan {
  std::array<double, 3> center_mm = {0.0, 0.0, 0.0};  ///< Nominal, base frame.
};

/// A reamed hole or counterbore of the base, or a dowel or bolt head that stands out of it. Its
/// axis is z of the base.
struct DatumHolePlan {
  std::array<double, 3> center_mm = {0.0, 0.0,
                                     0.0};  ///< Nominal centre of its mouth or foot, base frame.
  double diameter_mm = 0.0;
  record::Side side = record::Side::kInside;
  double depth_mm =
      0.0;  ///< Of the touches below its mouth, or height of what stands above its foot.
};

/// A place of the seat, which is touched from above.
struct DatumSeatPlan {
  std::array<double, 3> point_mm = {0.0, 0.0, 0.0};  ///< Base frame.
};

/// Position of the fixture base, found by touching its spheres, or its seat and holes.
struct DatumPlan {
  double sphere_diameter_mm = 20.0;
  std::vector<DatumSpherePlan> spheres;
  std::vector<DatumHolePlan> holes;
  std::vector<DatumSeatPlan> seat;
  int points = 7;               ///< Touches of each sphere, or of each height of a hole.
  int heights = 2;              ///< Of the touches of a hole.
  double uncertainty_mm = 1.0;  ///< Largest distance of the base from its nominal place.
  double residual_limit_um = 20.0;

  [[nodiscard]] bool on_holes() const { return !holes.empty() || !seat.empty(); }
  /// Layers that its touches have: one a sphere; the seat, and one a hole.
  [[nodiscard]] std::size_t layers() const {
    return on_holes() ? holes.size() + 1 : spheres.size();
  }
  [[nodiscard]] std::size_t touches() const {
    return (spheres.size() + holes.size() * static_cast<std::size_t>(heights)) *
               static_cast<std::size_t>(points) +
           seat.size();
  }
};

struct FixturePlan {
  enum class Driver { kSimulated, kIppdme, kZaber, kThorlabs, kManual, kFixed };

  std::string id;
  Driver driver = Driver::kSimulated;
  std::array<double, 3> axis_point_mm = {0.0, 0.0, 0.0};     ///< A, machine frame.
  std::array<double, 3> axis_offset_mm = {0.0, 0.0, 0.0};    ///< d, hoop frame.
  std::array<double, 3> part_position_mm = {0.0, 0.0, 0.0};  ///< Part origin in the body frame.
  std::array<double, 3> part_axis = {0.0, 0.0, 1.0};         ///< Direction of part z there; no key.
  double min_alpha_deg = -90.0;
  double max_alpha_deg = 90.0;
  double min_beta_deg = -90.0;
  double max_beta_deg = 90.0;
  double resolution_deg = 0.05;
  double rim_height_mm = -1000.0;  ///< Machine z below which the tip must not go.
  double clamp_from_mm = 0.0;      ///< Clamped band on the part, part z; empty when from >= to.
  double clamp_to_mm = 0.0;
  double ring_diameter_mm = 0.0;     ///< Outside of the clamping ring; 0: no tool passes it.
  double rim_diameter_mm = 0.0;      ///< Outside of the bowl; 0: the rim is everywhere.
  double table_height_mm = -1000.0;  ///< Machine z.
  std::vector<BodyPlan> bodies;      ///< What else stands in the way.
  std::optional<DatumPlan> datum;
  std::optional<CalibrationPlan> calibration;   ///< None: the fixture is treated as nominal.
  std::optional<ZaberPlan> zaber;               ///< Used only by the driver of that name.
  std::optional<ThorlabsPlan> thorlabs;         ///< Needed and accepted only by that driver.
  std::optional<ReachedPosePlan> reached_pose;  ///< Needed and accepted only by "manual".
};

RONDURE_WORDS(FixturePlan::Driver, {kSimulated, "simulated"}, {kIppdme, "ippdme"},
              {kZaber, "zaber"}, {kThorlabs, "thorlabs"}, {kManual, "manual"}, {kFixed, "fixed"});

struct QualificationPlan {
  record::ReferenceArtefact artefact = record::ReferenceArtefact::kSphere;
  double sphere_diameter_mm = 25.0;  ///< Certified.
  std::array<double, 3> sphere_center_mm = {300.0, 0.0, 100.0};
  int points = 13;
  double form_limit_um = 5.0;
  double radius_tolerance_um = 100.0;
  double stem_diameter_mm = 0.0;  ///< Diameter below the sphere; 0: a third of it.
  // Of a column, an upright cylinder on the table.
  double column_diameter_mm = 0.0;                              ///< Certified.
  std::array<double, 3> column_point_mm = {300.0, 0.0, 100.0};  ///< Of its axis, machine frame.
  double column_from_mm = 0.0;                                  ///< Lower end, above that point.
  double column_to_mm = 0.0;
  int heights = 3;
  int points_per_height = 8;
  double column_slope_deg = record::QualificationSettings{}.column_slope_deg;

  [[nodiscard]] bool on_column() const { return artefact == record::ReferenceArtefact::kColumn; }
  [[nodiscard]] const char* name() const {
    return on_column() ? "reference column" : "reference sphere";
  }
  /// Touches of the qualification.
  [[nodiscard]] int touches() const { return on_column() ? heights * points_per_height : points; }
  /// Where it stands: centre of the sphere, or point of the axis of the column.
  [[nodiscard]] const std::array<double, 3>& place_mm() const {
    return on_column() ? column_point_mm : sphere_center_mm;
  }
  [[nodiscard]] double diameter_mm() const {
    return on_column() ? column_diameter_mm : sphere_diameter_mm;
  }
  /// Its top above place_mm().
  [[nodiscard]] double top_mm() const {
    return on_column() ? column_to_mm : 0.5 * sphere_diameter_mm;
  }
};

struct ProbePlan {
  double tip_diameter_mm = 4.0;
  /// Length from the centre of the ball up; 0: only the ball is considered.
  double stylus_length_mm = 0.0;
  double stylus_diameter_mm = 0.0;  ///< Diameter of the shaft.
  double holder_diameter_mm = 0.0;  ///< Diameter of the stylus holder; 0: none.
  QualificationPlan qualification;
};

struct EnvironmentPlan {
  double min_degC = 18.0;
  double max_degC = 22.0;
  double temperature_uncertainty_K = 0.1;
  std::optional<double> assumed_degC;  ///< Temperature of part and scales when not measured.
  double max_drift_K = record::EnvironmentSettings{}.max_drift_K;
};

/// The keys that count depend on the type of the feature.
struct NominalPlan {
  double diameter_mm = 0.0;                           ///< Of a cone at from_mm; 0: not given.
  double from_mm = 0.0;                               ///< Lower end of the surface, part z.
  double to_mm = 0.0;                                 ///< Upper end.
  double half_angle_deg = 0.0;                        ///< Of a cone; > 0: it opens along part z.
  double z_mm = 0.0;                                  ///< Of a plane.
  std::optional<record::Faces> faces = {};            ///< Of a plane.
  double from_diameter_mm = 0.0;                      ///< Inner edge of a plane.
  double to_diameter_mm = 0.0;                        ///< Outer edge of a plane; 0: not given.
  std::array<double, 3> center_mm = {0.0, 0.0, 0.0};  ///< Of a sphere, part frame.
};

struct SamplingPlan {
  int layers = 4;
  int points_per_layer = 7;
  double margin_mm = 5.0;
  double start_deg = 0.0;
  double stagger = 1.0;  ///< 0: all layers start at one angle; 1: evenly interleaved.
  record::SamplingMethod method = record::SamplingMethod::kTouch;
};

/// A pose in which part of a feature is measured.
struct MeasuringPosePlan {
  double alpha_deg = 0.0;
  double beta_deg = 0.0;
};

struct PoseSearchPlan {
  record::Strategy strategy = record::Strategy::kGuided;  ///< A strategy for touched surfaces.
  std::vector<MeasuringPosePlan> poses;                   ///< For "merged": at least two.
  record::Merge merge = record::Merge::kJoint;            ///< For "merged".
  double start_alpha_deg = 0.0;
  double start_beta_deg = 0.0;
  std::vector<double> steps_deg = {5.0, 2.0};
  double min_step_deg = 0.05;  ///< End of step halving (virtual).
  int max_poses = 6;           ///< guided: limit of levelling poses.
  int repeats = 5;             ///< Touches of each point of the final cloud.
};

/// The name of a column in a file that uses another one.
struct ColumnPlan {
  std::string column;   ///< Name in the analysis, e.g. "H1_um".
  std::string in_file;  ///< Name in the file.
};

struct SourcePlan {
  std::string file;  ///< CSV of tip centres or of series, relative to the plan.
  std::optional<double>
      tip_diameter_mm;  ///< Diameter of the probe tip used; none: radii stay tip-centre radii.
  std::vector<ColumnPlan> columns;         ///< Where the file names or has them otherwise.
  std::optional<record::LengthUnit> unit;  ///< Of points; none: as the file says, or mm.
  record::PointsAre points = record::PointsAre::kTipCentres;
  std::optional<record::MeshUse> mesh;       ///< Of a file of triangles; none: refused.
  std::optional<record::LayersFrom> layers;  ///< Of points; none: the column, where there is one.
  std::string feature;  ///< Only the rows whose column `feature` says this; empty: all rows.
  std::optional<record::UntakenRows> others;  ///< Rows no feature takes; none: refused.
  std::string clamping;                       ///< Files of one name were measured in one clamping.
  std::string measured_utc;                   ///< When the data were measured; may be empty.
  std::optional<double> valid_for_days;       ///< How long they stand; needs `measured_utc`.
  std::optional<record::SectionPlane> plane;  ///< Of a circle.
};

struct FeaturePlan {
  std::string id;
  record::Shape type = record::Shape::kCylinder;
  record::Side side = record::Side::kOutside;
  std::string letter;  ///< Datum letter on the drawing; may be empty.
  NominalPlan nominal;
  SamplingPlan sampling;
  PoseSearchPlan pose_search;
  std::optional<record::SpindleTask>
      spindle;                             ///< Needed and accepted only by the type of that name.
  std::optional<record::WheelTask> wheel;  ///< As spindle.
  std::optional<record::ContourTask> contour;     ///< As spindle.
  std::optional<record::RotaryTask> rotary_axes;  ///< As spindle.
  std::optional<record::FiveAxisTask> five_axis;  ///< As spindle.
  std::optional<SourcePlan> source;
  std::vector<record::WindowTask> exclude;
  record::DefaultsTask defaults;
  std::optional<record::DecisionRuleTask> decision_rule;  ///< In place of that of the plan.
  std::vector<record::CharacteristicTask> characteristics;
};

struct LobePlan {
  int order = 2;
  double amplitude_um = 0.0;
  double phase_deg = 0.0;
  double twist_deg = 0.0;
};

/// Form of a simulated surface.
struct SimulatedFormPlan {
  double diameter_error_um = 0.0;
  std::vector<LobePlan> lobes;
  double taper_um = 0.0;
  double barrel_um = 0.0;
  double bend_um = 0.0;
  double bend_phase_deg = 0.0;
  std::vector<KeywayPlan> keyways;
};

/// The part of a simulation. Its form is that of every surface without an entry of its own.
struct SimulatedPartPlan : SimulatedFormPlan {
  double tilt_deg = 0.0;  ///< Tilt of the part in the clamping ring.
  double tilt_toward_deg = 0.0;
  double offset_x_mm = 0.0;
  double offset_y_mm = 0.0;
  double expansion_per_K = 0.0;  ///< True value.
  std::vector<BurrPlan> burrs;
  double dust_share = 0.0;  ///< Share of the touches.
  double dust_um = 0.0;     ///< Largest particle.
};

/// One surface of a simulated part: how its own axis lies against that of the part, and its form.
struct SimulatedFeaturePlan : SimulatedFormPlan {
  std::string id;  ///< Of the feature.
  double offset_x_um = 0.0;
  double offset_y_um = 0.0;
  double slope_x_urad = 0.0;
  double slope_y_urad = 0.0;
  std::vector<FlatPlan> flats;
  // Of a plane.
  double tilt_urad = 0.0;
  double tilt_toward_deg = 0.0;
  double saucer_um = 0.0;
  double wave_um = 0.0;
  int wave_order = 2;
};

struct SimulatedProbePlan {
  double repeatability_um = 0.0;
  double tip_radius_error_um = 0.0;
  double column_lean_deg = 0.0;  ///< Of the reference column, toward x.
};

struct SimulatedFixturePlan {
  std::array<double, 3> axis_point_error_um = {0.0, 0.0, 0.0};
  std::array<double, 3> axis_offset_error_um = {0.0, 0.0, 0.0};
  std::array<double, 3> base_offset_mm = {0.0, 0.0, 0.0};
  std::array<double, 3> base_rotation_deg = {0.0, 0.0, 0.0};  ///< Rotation about x, then y, then z.
  double zero_alpha_deg = 0.0;
  double zero_beta_deg = 0.0;
  double squareness_deg = 0.0;
  double repeatability_deg = 0.0;
  std::optional<SimulatedMotionPlan> motion;  ///< None: the axes have no errors.
};

/// Faults that interrupt a simulated run, once: a resumed run does not repeat them.
struct SimulatedFaultsPlan {
  int connection_lost_at_touch = 0;  ///< Number of the touch, from 1; 0: never.
  int fixture_stalls_at_move = 0;    ///< Number of the move, from 1; 0: never.
  double part_moved_um = 0.0;        ///< Shift of the part while the run is interrupted, ring x.
  /// Offset of alpha from the commanded angle after the interruption.
  double fixture_off_deg = 0.0;
};

struct SimulationPlan {
  std::uint64_t seed = 1;
  double temperature_degC = 20.0;
  SimulatedPartPlan part;
  std::vector<SimulatedFeaturePlan> features;
  SimulatedMachinePlan machine;
  SimulatedProbePlan probe;
  SimulatedFixturePlan fixture;
  SimulatedFaultsPlan faults;
  std::optional<SimulatedSpindlePlan> spindle;
  std::optional<SimulatedWheelPlan> wheel;
  std::optional<SimulatedContourPlan> contour;
  std::optional<SimulatedFiveAxisPlan> five_axis;
};

struct ReportsPlan {
  std::vector<std::string> formats = {"html", "json", "csv"};
  record::Paper paper = record::Paper::kA4;  ///< Paper of the PDF.
  std::string archive;                       ///< Empty: archive.db beside the run directory.
  std::string laboratory;  ///< File that says whose reports they are; empty: none.
};

struct Plan {
  PlanHead plan;
  PartPlan part;
  std::optional<MachinePlan> machine;  ///< Needed when a feature is touched, not read from a file.
  std::optional<FixturePlan> fixture;  ///< Left out: "fixed", when a feature is touched.
  std::optional<ProbePlan> probe;
  std::optional<EnvironmentPlan> environment;  ///< None: its defaults, for touched features.
  std::vector<FeaturePlan> features;
  record::DefaultsTask defaults;
  record::DecisionRuleTask decision_rule;
  std::optional<record::UncertaintyTask> uncertainty;
  std::optional<SimulationPlan> simulation;
  ReportsPlan reports;

  std::filesystem::path folder;  ///< Folder of the plan file: points files are relative to it.
  std::string text;              ///< Contents of the file, byte for byte.
};

/// A plan, or all its problems.
using PlanOrProblems = tl::expected<Plan, std::vector<core::Error>>;

/// Reads and checks a plan. All problems are reported, not only the first: `where` is the JSON
/// pointer of the value ("name.json:line:column" for text that is not JSON), `what` one sentence
/// with value, unit and limit. Points files are opened and read, too.
[[nodiscard]] PlanOrProblems read_plan(const std::filesystem::path& path);

/// read_plan() for a text; `folder` resolves points files, `name` is used in places of syntax
/// errors.
[[nodiscard]] PlanOrProblems parse_plan(std::string_view text, const std::filesystem::path& folder,
                                        std::string_view name);

/// The plan that a journal holds: its keys and values, each within its limits. What no single key
/// can say is not checked again, and no other file is read.
/// @return kJournal with the first fault and its place.
[[nodiscard]] core::Result<Plan> recorded_plan(std::string_view text);

/// The paper that the plan in a journal asks for; of text that is no plan, what plans default to.
[[nodiscard]] record::Paper recorded_paper(std::string_view text);

/// The JSON Schema (draft 7) of a plan, from the same table that reads it.
[[nodiscard]] std::string plan_schema();

}  // namespace rondure::plans
