#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/error.h"
#include "core/message.h"
#include "core/pose.h"
#include "record/indication.h"
#include "record/words.h"

namespace rondure::record {

/// Shape of a feature in the plan. The journal stores it, so that a run can be evaluated without
/// the code that reads plans.
/// kSpindle, kWheel, kContour and kFiveAxis are analyses: their data are series, not touches.
/// kRotaryAxes, the calibration of the fixture, is an analysis of touches.
enum class Shape {
  kCylinder,
  kCircle,
  kPlane,
  kCone,
  kSphere,
  kSpindle,
  kWheel,
  kContour,
  kRotaryAxes,
  kFiveAxis
};
enum class Side { kOutside, kInside };
/// What a characteristic is the value of. form_facts.h holds what is true of each.
enum class Form {
  kCylindricity,  ///< CYLt.
  kRoundness,     ///< RONt.
  kDiameter,
  kStraightness,  ///< Of the generatrices, or of the median line.
  kGeneratrixParallelism,
  kTaper,
  kFlatness,
  kCoaxiality,
  kConcentricity,
  kParallelism,
  kPerpendicularity,
  kAngularity,
  kTotalRunOut,
  kRoundnessRms,        ///< RONq, about the least-squares circle.
  kHarmonicLimits,      ///< Amplitudes of harmonics against a mask.
  kMotionTotal,         ///< Total error motion value of an axis (ISO 230-7).
  kMotionSynchronous,   ///< Synchronous error motion value.
  kMotionAsynchronous,  ///< Asynchronous error motion value.
  kRadius,              ///< Departure of a radius from nominal.
  kRunOut,              ///< Circular run-out of a surface; radial one of a wheel.
  kContourDeviation,    ///< Peak to valley of a contour, the greatest of all parts.
  kContourSpread,       ///< Standard deviation of the parts about their mean contour.
  kFollowingDeviation,  ///< Peak to valley of f, of the mean of all parts.
  kFixtureResidual,     ///< Largest distance of a ball from its predicted position.
  kFixtureResidualRms,  ///< Root mean square of these distances.
  kAxisError,           ///< Largest of one error of a rotary axis over its stations.
  kLeftRms,             ///< Of a head: root mean square of what its errors do not explain.
  kLeftLargest,         ///< Largest of these distances.
  kLocation,            ///< A location error of an axis of a head, e.g. YOA.
};
enum class Reference { kLeastSquares, kMinimumZone, kMinimumCircumscribed, kMaximumInscribed };
/// kStartPose: no search, the cloud of the start pose. kMerged: no search, one cloud from several
/// poses. kStations: balls of a calibration.
enum class Strategy {
  kGuided,
  kAsPublished,
  kVirtual,
  kPointsFile,
  kSeries,
  kMerged,
  kStations,
  kStartPose,
};

/// Whether a shape is an analysis, which has its own evaluation, instead of a surface.
[[nodiscard]] bool is_analysis(Shape shape);

/// Combination of the poses of Strategy::kMerged: solved jointly with the part, or by the
/// kinematics of the fixture.
enum class Merge { kJoint, kKinematics };
enum class SamplingMethod { kTouch, kScan };

/// Spelling in plans, journals and JSON; name_of() and value_named() read these tables.
RONDURE_WORDS(Shape, {kCylinder, "cylinder"}, {kCircle, "circle"}, {kPlane, "plane"},
              {kCone, "cone"}, {kSphere, "sphere"}, {kSpindle, "spindle"}, {kWheel, "wheel"},
              {kContour, "contour"}, {kRotaryAxes, "rotary_axes"}, {kFiveAxis, "five_axis"});
RONDURE_WORDS(Side, {kOutside, "outside"}, {kInside, "inside"});
RONDURE_WORDS(Form, {kCylindricity, "cylindricity"}, {kRoundness, "roundness"},
              {kDiameter, "diameter"}, {kStraightness, "straightness"},
              {kGeneratrixParallelism, "generatrix-parallelism"}, {kTaper, "taper"},
              {kFlatness, "flatness"}, {kCoaxiality, "coaxiality"},
              {kConcentricity, "concentricity"}, {kParallelism, "parallelism"},
              {kPerpendicularity, "perpendicularity"}, {kAngularity, "angularity"},
              {kTotalRunOut, "total-run-out"}, {kRoundnessRms, "roundness-rms"},
              {kHarmonicLimits, "harmonic-limits"}, {kMotionTotal, "motion-total"},
              {kMotionSynchronous, "motion-synchronous"},
              {kMotionAsynchronous, "motion-asynchronous"}, {kRadius, "radius"},
              {kRunOut, "run-out"}, {kContourDeviation, "contour-deviation"},
              {kContourSpread, "contour-spread"}, {kFollowingDeviation, "following-deviation"},
              {kFixtureResidual, "fixture-residual"}, {kFixtureResidualRms, "fixture-residual-rms"},
              {kAxisError, "axis-error"}, {kLeftRms, "left-rms"}, {kLeftLargest, "left-largest"},
              {kLocation, "location"});
RONDURE_WORDS(Reference, {kMinimumZone, "mz"}, {kLeastSquares, "ls"}, {kMinimumCircumscribed, "mc"},
              {kMaximumInscribed, "mi"});
RONDURE_WORDS(Strategy, {kGuided, "guided"}, {kAsPublished, "as-published"}, {kVirtual, "virtual"},
              {kStartPose, "start-pose"}, {kMerged, "merged"}, {kPointsFile, "points-file"},
              {kSeries, "series"}, {kStations, "stations"});
RONDURE_WORDS(Merge, {kJoint, "joint"}, {kKinematics, "kinematics"});
RONDURE_WORDS(SamplingMethod, {kTouch, "touch"}, {kScan, "scan"});

/// Limit of the amplitudes of the harmonics first..last; one line of a harmonic mask.
struct HarmonicLimit {
  int first = 2;
  int last = 50;
  double amplitude_mm = 0.0;
};

/// One characteristic of a feature, toleranced or only reported.
struct Characteristic {
  std::string id;  ///< Name in the plan, unique within the feature.
  Form form = Form::kCylindricity;
  Reference reference = Reference::kMinimumZone;
  std::optional<double> tolerance_mm;  ///< Upper limit: of a deviation, or the greatest size [mm].
  std::string drawing_zone;            ///< Grid square on the drawing; may be empty.
  std::vector<HarmonicLimit> harmonic_limits = {};  ///< For kHarmonicLimits, never empty there.
  /// Lower limit: the least size, or of a value with a sign, which has both limits [mm].
  std::optional<double> lower_mm = {};
  Indication indication = {};  ///< With the defaults of the feature and of the plan.

  /// Whether there is a limit to judge by; else the value is reported only.
  [[nodiscard]] bool toleranced() const { return tolerance_mm || lower_mm; }
};

/// One setting of a feature or of the whole run, by its key in the plan ("phi2_deg"): a number or a
/// text, e.g. a keyword.
struct Setting {
  std::string name;
  std::optional<double> number;
  std::string text;  ///< Used only when there is no number.
};

/// One feature and how its points are obtained.
struct Feature {
  std::string id;
  Shape shape = Shape::kCylinder;
  Side side = Side::kOutside;
  double nominal_diameter_mm = 0.0;
  int layers = 0;  ///< 0 for a points file: layers are found in the data or unknown.
  int points_per_layer = 0;
  Strategy strategy = Strategy::kGuided;
  std::vector<double> search_steps_deg;  ///< Steps of the software pose search, in order.
  std::string points_file;               ///< The data file or files, as named in the plan.
  /// SHA-256 of the file's bytes; for several files, of the lines "sha256 name".
  std::string points_sha256;
  /// Tip radius of the probe that measured a points file, if stated.
  std::optional<double> tip_radius_mm;
  std::vector<Characteristic> characteristics;
  std::vector<Setting> settings;  ///< A list repeats its key for each item.
};

/// Head of a run: part, plan, machine, program and conditions.
struct Header {
  std::string run_id;       ///< Name of the run, e.g. "01_spool_simulated-20261121T023302Z".
  std::string version;      ///< core::kVersion of the program that measured.
  std::string processor;    ///< Model and vector units; results are bit-identical on the same kind.
  std::string started_utc;  ///< ISO 8601.
  std::string plan_file;    ///< Name as given on the command line, without folders.
  std::string plan_name;
  std::string plan_revision;
  std::string plan_text;  ///< The plan itself, byte for byte.
  std::string plan_sha256;
  std::string part_id;
  std::string part_name;
  std::string drawing;
  std::string serial;         ///< --serial; may be empty.
  std::string operator_name;  ///< --operator; may be empty.
  std::string machine;        ///< e.g. "simulated CMM".
  std::string fixture;        ///< e.g. "simulated two-axis fixture, resolution 0.05 deg".
  std::string decision_rule;  ///< "simple-acceptance".
  bool simulated = false;
  std::uint64_t seed = 0;             ///< Seed of the simulation; 0 when nothing is simulated.
  double temperature_min_degC = 0.0;  ///< Outside these limits a result is void.
  double temperature_max_degC = 0.0;
};

/// Reference sphere and limits of the probe qualification.
struct Artefact {
  double radius_mm = 0.0;  ///< Certified radius of the sphere.
  double nominal_tip_radius_mm = 0.0;
  double radius_tolerance_mm = 0.0;  ///< Limit of |rho - nominal|.
  double form_limit_mm = 0.0;        ///< Limit of the probing form.
};

/// A pose of the fixture in which a cloud was measured.
struct PoseVisit {
  int id = 0;       ///< 0-based, counts through the whole run.
  int feature = 0;  ///< Index into RunRecord::features.
  core::Pose commanded;
  core::Pose reached;        ///< Pose as read back from the fixture.
  bool final_cloud = false;  ///< Marks the cloud that is evaluated; set by a later decision.
  double time_s = 0.0;       ///< Time of the machine clock.
};

/// One touch of the probe (or one row of a points file).
struct Touch {
  /// kLocate finds the position of the part before the first measuring touch. Without a pose it
  /// finds the base of the fixture (`layer` counts its spheres, or its seat and holes) or the pose
  /// in which the fixture was set (the count continues with the spheres on its ring).
  /// kCheck repeats an earlier touch before an interrupted run is resumed.
  /// Neither enters a result.
  enum class Purpose { kQualification, kLocate, kMeasure, kCheck };
  std::int64_t id = 0;  ///< 0-based, counts through the whole run; checks count from -1 downward.
  Purpose purpose = Purpose::kMeasure;
  int pose = -1;   ///< PoseVisit::id; -1 for a qualification touch.
  int layer = 0;   ///< 0-based from the lower end.
  int point = 0;   ///< 0-based within its layer.
  int repeat = 0;  ///< 0-based.
  Eigen::Vector3d tip_mm = Eigen::Vector3d::Zero();    ///< Tip centre, machine frame.
  Eigen::Vector3d approach = Eigen::Vector3d::Zero();  ///< Unit direction of the approach.
  std::optional<double> temperature_degC;              ///< Part temperature; none: not measured.
  double time_s = 0.0;                                 ///< Time of the machine clock.
  /// Temperature of the machine scales; none: not measured.
  std::optional<double> scale_temperature_degC;
};

RONDURE_WORDS(Touch::Purpose, {kQualification, "qualification"}, {kLocate, "locate"},
              {kMeasure, "measure"}, {kCheck, "check"});

/// A decision of the program during the run, e.g. why the pose search stopped.
struct Decision {
  int feature = -1;  ///< Feature index; -1: concerns the whole run.
  double time_s = 0.0;
  core::Message message;
};

struct RunRecord;
/// Adds a decision to a record; the digest of files that were read after an answer goes to their
/// feature, as that of others stands there from the start.
/// @pre  Its feature is one of the record, or -1.
void take(Decision decision, RunRecord& record);

/// One column of a series: its name in the file, which carries the unit ("H1_um"), and that unit.
struct SeriesColumn {
  std::string name;
  std::string unit;
};

/// Rows of numbers recorded together by probes or a controller, in the units of the columns.
struct Series {
  /// kTruth: the hidden truth of a simulation, which results are held against. One with the name
  /// and columns of data is these without errors of measurement.
  enum class Role { kData, kTruth };
  int feature = 0;  ///< Index into RunRecord::features.
  std::string name = "data";
  Role role = Role::kData;
  std::vector<SeriesColumn> columns;
  std::vector<double> values;  ///< Row by row: columns.size() numbers each; finite.

  [[nodiscard]] std::size_t rows() const {
    return columns.empty() ? 0 : values.size() / columns.size();
  }
  /// The values of a column, or nothing when there is no such column.
  [[nodiscard]] std::optional<std::vector<double>> column(std::string_view wanted) const;
};

/// The series of a simulated feature that says where its touches would have met the part without
/// errors, the fixture at its nominal axes: touch, x_mm, y_mm, z_mm.
inline constexpr const char* kTrueTips = "true tips";

RONDURE_WORDS(Series::Role, {kData, "data"}, {kTruth, "truth"});

/// A number of the hidden truth of a simulated analysis.
struct TruthValue {
  int feature = 0;
  std::string name;  ///< Name with unit, e.g. "RONt_um".
  double value = 0.0;
};

/// A number of the evaluation as the run stored it; `rondure verify` compares it.
struct StoredResult {
  std::string name;  ///< JSON pointer into report.json, e.g. "/features/0/mz/deviation_um".
  double value = 0.0;
};

/// All data of a run: the contents of journal.db.
struct RunRecord {
  Header header;
  std::string ending;  ///< "finished", "stopped", "failed: ..."; "" while the run is active.
  std::optional<core::Error> failure;  ///< Why a run did not finish.
  Artefact artefact;                   ///< Only meaningful when there are qualification touches.
  std::vector<Setting> settings;       ///< Settings of the whole run; known before its first touch.
  std::vector<Feature> features;
  std::vector<PoseVisit> poses;
  std::vector<Touch> touches;  ///< By id, without checks.
  std::vector<Touch> checks;   ///< Repeated touches of a resumed run, in order.
  std::vector<Decision> decisions;
  std::vector<Series> series;            ///< In the order of recording.
  std::vector<TruthValue> truth_values;  ///< Hidden truth of analyses.
  std::vector<StoredResult> results;
  bool sealed = false;  ///< The journal was closed with digests of its tables.

  /// The recorded series of a feature by name, or nullptr. Never one of the hidden truth.
  [[nodiscard]] const Series* data_of(int feature, std::string_view name) const;
  /// Same as data_of(), for the hidden truth shown in reports.
  [[nodiscard]] const Series* truth_series_of(int feature, std::string_view name) const;
};

}  // namespace rondure::record
