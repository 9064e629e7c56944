#pragma once

#include <string>
#include <string_view>

namespace rondure::core {

/// The one list of error and warning codes. JSON spells them in kebab case (code_name()); the
/// E_ and W_ names of docs/sources.md map to them.
enum class Code {
  // Data that cannot be evaluated.
  kNoPoints,        ///< no-points: nothing to evaluate
  kNotFinite,       ///< not-finite: NaN or infinity; `what` names the row
  kTooFewPoints,    ///< too-few-points: fewer distinct points than the shape has unknowns
  kCollinear,       ///< collinear: the points lie on one line, a circle would have no centre
  kNotFullSection,  ///< not-full-section: the points do not surround the centre (gap >= 180 deg)
  kRank,            ///< rank: a parameter is undetermined, e.g. the tilt of a single layer
  kNotConverged,    ///< not-converged: an iteration limit ended the computation
  kUnits,           ///< units: a size that suggests metres or micrometres
  // Grinding wheel and its path.
  kShortArc,       ///< short-arc: the points cover too little of the circle
  kTooFewCenters,  ///< too-few-centers: fewer than 6 quadruples of points give a usable centre
  kOutliers,       ///< outliers: single points that are not the surface; dropped, or too many
  kSurface,        ///< surface: a height that does not exist or is not known at this x
  kTable,          ///< table: x not strictly increasing, or fewer than 5 rows
  kGouge,          ///< gouge: the wheel would cut into the surface beside its contact
  kWheelArc,       ///< wheel-arc: the contact leaves the trued arc of the wheel
  // Plans, files, arguments.
  kBadOption,    ///< bad-option: a setting outside its range
  kSyntax,       ///< syntax: the text is not JSON or not CSV
  kUnknownKey,   ///< unknown-key
  kRepeatedKey,  ///< repeated-key
  kWrongUnit,    ///< wrong-unit: the key exists with another unit suffix
  kMissingKey,   ///< missing-key
  kWrongType,    ///< wrong-type
  kOutOfRange,   ///< out-of-range: a number beyond its stated limit
  kPoseRange,    ///< pose-range: an angle beyond the limits of the fixture
  kStep,         ///< step: an angle step that is not positive or above 5 deg
  kSampling,     ///< sampling: layers or points that cannot be placed, or too few for a filter
  kMeaning,      ///< meaning: keys that contradict each other
  kFile,         ///< file: cannot be opened, read or written
  // Machine, fixture, run.
  kUnreachable,  ///< unreachable: a target the probe cannot reach; named before anything moves
  kNoTouch,      ///< no-touch: the probe met nothing within its search distance
  kCollision,    ///< collision: the probe met something where nothing was expected
  kLocation,     ///< location: the part does not sit where the plan says
  kCalibration,  ///< calibration: probe qualification outside its limits
  kMachine,      ///< machine: fault reported by the machine or by the fixture
  kStopped,      ///< stopped: by the operator
  kJournal,      ///< journal: the record cannot be written, read, or contradicts itself
  kArchive,      ///< archive: the results archive cannot be reached, read or written
  kInternal,     ///< internal: a broken invariant; a defect of the program
  // Warnings.
  kSparse,         ///< sparse: fewer than 3 layers or 7 points a layer
  kNoCertificate,  ///< no-certificate: the optimum is not proven
  kExactFit,       ///< exact-fit: no more points than unknowns, the deviation is 0 by construction
  kNotLevel,       ///< not-level: f(pose) > 2 MZ, the pose and not the part dominates f
  kUndersampled,   ///< undersampled: filtered by option with fewer than 7 points per undulation
  kFilteredTwice,  ///< filtered-twice: the data seem filtered already, or not as said
  kUndercut,       ///< undercut: the wheel path has loops; the contour is the envelope
  kSense,          ///< sense: a sign or direction that the data speak against
  kAlignment,      ///< alignment: the zero of two curves seems to differ
  kAngleOrder,     ///< angle-order: angles that were unsorted, repeated or ran over one turn
  kReferenceAbsent,  ///< reference-absent: a reference that does not exist for these data
  kCenterDisagrees,  ///< center-disagrees: two ways to a wheel centre differ by more than noise
  kNoAxis,           ///< no-axis: without the axis of rotation there is roundness but no run-out
  kLocalForm,        ///< local-form: neighbouring points that are form (wear, flat), not outliers
  kCorrelated,       ///< correlated: neighbouring residuals are alike; they are not noise alone
  kLowMargin,        ///< low-margin: a wheel radius close to the concave radius it must grind
  kSeveralOptima,    ///< several-optima: a reference is one of several that are nearly alike
  kHarmonicLoss,     ///< harmonic-loss: harmonics that a separation loses or amplifies much
  kInconsistent,     ///< inconsistent: data that contradict the geometry they were taken with
};
/// The last of them.
inline constexpr Code kLastCode = Code::kInconsistent;

/// The name of a code as JSON and messages spell it, e.g. "too-few-points".
[[nodiscard]] std::string_view code_name(Code code);

/// Why something could not be done.
struct Error {
  Code code = Code::kInternal;
  std::string what;   ///< One sentence with number, unit and limit.
  std::string where;  ///< JSON pointer into the plan, "file.csv:12", or empty.

  /// The same error with its place.
  [[nodiscard]] Error at(std::string place) const { return {code, what, std::move(place)}; }

  friend bool operator==(const Error&, const Error&) = default;
};

/// One line for a person: "where: what [code]".
[[nodiscard]] std::string to_line(const Error& error);

}  // namespace rondure::core
