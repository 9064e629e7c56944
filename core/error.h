#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "core/phrase.h"

namespace rondure::core {

/// All error and warning codes. JSON spells them in kebab case (see code_name());
/// docs/developer/sources.md maps its E_ and W_ names to these codes.
enum class Code {
  // Data that cannot be evaluated.
  kNoPoints,        ///< no-points: nothing to evaluate
  kNotFinite,       ///< not-finite: NaN or infinity; `what` names the row
  kTooFewPoints,    ///< too-few-points: fewer distinct points than the shape has unknowns
  kCollinear,       ///< collinear: the points lie on one line, so a circle has no centre
  kNotFullSection,  ///< not-full-section: the points do not surround the centre (gap >= 180 deg)
  kRank,            ///< rank: a parameter is undetermined, e.g. the tilt of a single layer
  kNotConverged,    ///< not-converged: an iteration limit ended the computation
  kUnits,           ///< units: the size of a number suggests metres or micrometres
  // Grinding wheel and its path.
  kShortArc,       ///< short-arc: the points cover too little of the circle
  kTooFewCenters,  ///< too-few-centers: fewer than 6 quadruples of points give a usable centre
  kOutliers,       ///< outliers: single points off the surface, dropped or too many to drop
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
  kLocation,     ///< location: the part is not where the plan places it
  kCalibration,  ///< calibration: probe qualification outside its limits
  kMachine,      ///< machine: fault reported by the machine or by the fixture
  kStopped,      ///< stopped: by the operator
  kJournal,      ///< journal: the record cannot be written, read, or contradicts itself
  kArchive,      ///< archive: the results archive cannot be reached, read or written
  kInternal,     ///< internal: a broken invariant; a defect of the program
  // Warnings.
  kSparse,         ///< sparse: fewer than 3 layers, or fewer than 7 points per layer
  kNoCertificate,  ///< no-certificate: the optimum is not proven
  kExactFit,       ///< exact-fit: no more points than unknowns, the deviation is 0 by construction
  kNotLevel,       ///< not-level: f(pose) > 2 MZ, the pose and not the part dominates f
  kUndersampled,   ///< undersampled: filtered by option with fewer than 7 points per undulation
  kFilteredTwice,  ///< filtered-twice: the data seem filtered already, or not as stated
  kUndercut,       ///< undercut: the wheel path has loops; the contour is the envelope
  kSense,          ///< sense: a sign or direction that the data contradict
  kAlignment,      ///< alignment: the zero angles of two curves seem to differ
  kAngleOrder,     ///< angle-order: angles that were unsorted, repeated or ran over one turn
  kReferenceAbsent,  ///< reference-absent: a reference that does not exist for these data
  kCenterDisagrees,  ///< center-disagrees: wheel centres of two methods differ by more than noise
  kNoAxis,           ///< no-axis: roundness, but no run-out without the axis of rotation
  kLocalForm,        ///< local-form: neighbouring points off by form (wear, flat), not outliers
  kCorrelated,       ///< correlated: neighbouring residuals correlate, so are not only noise
  kLowMargin,        ///< low-margin: the wheel radius is close to a concave radius to be ground
  kSeveralOptima,    ///< several-optima: the reference is one of several nearly equal ones
  kHarmonicLoss,     ///< harmonic-loss: a separation or a filter loses or amplifies harmonics
  kInconsistent,     ///< inconsistent: the data contradict the geometry they were taken with
  kUnfiltered,       ///< unfiltered: dense points, evaluated as measured
  kRepeatedRows,     ///< repeated-rows: rows of a points file that are there twice take no part
};
/// The last code of the list.
inline constexpr Code kLastCode = Code::kRepeatedRows;

/// Returns the name of a code as JSON and messages spell it, e.g. "too-few-points".
[[nodiscard]] std::string_view code_name(Code code);

/// The reason why an operation failed.
struct Error {
  Code code = Code::kInternal;
  std::string what;        ///< One sentence with number, unit and limit.
  std::string where = {};  ///< JSON pointer into the plan, "file.csv:12", or empty.
  /// `what` as data, for reports in another language; empty where only its English is known.
  Phrase phrase = {};

  /// Returns this error with `where` set to `place`.
  [[nodiscard]] Error at(std::string place) const { return {code, what, std::move(place), phrase}; }
  /// `what` as a phrase; of one piece where only its English is known, or somebody added to it.
  [[nodiscard]] Phrase said() const { return phrase == what ? phrase : Phrase(what); }

  friend bool operator==(const Error& a, const Error& b) {
    return a.code == b.code && a.what == b.what && a.where == b.where;
  }
};

/// Makes an error whose sentence is data.
[[nodiscard]] Error error_of(Code code, Phrase said, std::string where = {});

/// Returns the error as one line of text for the operator: "where: what [code]".
[[nodiscard]] std::string to_line(const Error& error);

}  // namespace rondure::core
