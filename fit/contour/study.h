#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/result.h"
#include "core/units.h"
#include "core/words.h"
#include "fit/contour/axis_trace.h"
#include "fit/contour/error.h"
#include "fit/contour/ground_contour.h"
#include "fit/contour/measured_contour.h"
#include "fit/contour/repeatability.h"
#include "fit/contour/separation.h"

namespace rondure::fit {

/// Method that aligns the curves of the two machines.
enum class ContourMethod {
  kCorrected,  ///< Known offset of the gauge; correlation is a diagnosis only. The default.
  /// A reading of the source, whose equations are lost: parallel curve by central
  /// differences, and every following part turned onto its own total by correlation.
  kAsPublished,
};
RONDURE_WORDS(ContourMethod, {kCorrected, "corrected"}, {kAsPublished, "as-published"});

/// Settings of contour_study().
struct ContourStudyOptions {
  ContourMethod method = ContourMethod::kCorrected;
  CrankGeometry geometry;
  double main_radius_mm = 30.0;  ///< Radius of the main journals.
  AxisTraceOptions axes;
  bool refine_path = true;             ///< See GroundContourOptions::refine.
  std::size_t samples = 1440;          ///< Samples M of every contour.
  ContourErrorOptions error;           ///< Base circle and filter of every contour.
  bool prefiltered = false;            ///< The gauge has filtered pins and mains.
  double phase_offset_rad = 0.0;       ///< Gauge angle of the direction O to pin centre, pins.
  double main_phase_offset_rad = 0.0;  ///< The same for the main journals.
  int gauge_direction = 1;             ///< -1: the gauge turns against beta.
};

/// A contour as recorded by the gauge.
struct GaugeRows {
  std::vector<double> angle_rad;
  std::vector<double> deviation_mm;
};

/// One ground part: the recording of the control, and the contours from the gauge.
struct ContourPart {
  std::optional<AxisTrace> trace;  ///< None: f is t less the main journal, which must be there.
  GaugeRows pin;
  std::optional<GaugeRows> main;  ///< The neighbouring main journal.
};

/// Indirect separation: a main journal represents the rest.
struct IndirectSeparation {
  std::vector<double> following_mm;  ///< t minus the main journal.
  double correlation = 0.0;          ///< Correlation with the direct following part.
  double rms_difference_mm = 0.0;    ///< Rms difference from the direct following part.
};

/// Recorded positions of X, held against crank, wheel and the zero of C.
struct PositionCheck {
  static constexpr double kStrokeLimit = 0.05;  ///< mm
  static constexpr double kCourseLimit = 0.02;  ///< mm, rms

  double stroke_mm = 0.0;     ///< max X - min X.
  double expected_mm = 0.0;   ///< 2 R.
  double course_mm = 0.0;     ///< rms of X(alpha) - d(alpha) after a constant.
  std::string contradiction;  ///< With the geometry that the positions fit; empty where they agree.
};
/// @return  Nothing where the turn has no positions.
[[nodiscard]] std::optional<PositionCheck> check_positions(const AxisTurn& axes,
                                                           const CrankGeometry& geometry);

/// Least samples of the control for one undulation at the cut-off.
inline constexpr double kSamplesPerUndulation = 6.0;

/// The separated contour of one part. Without traces f is t less the main journal, n is the main
/// journal, and `axes`, `positions`, `ground` and `offset` are empty.
struct ContourPartResult {
  bool traced = true;
  AxisTurn axes;
  std::optional<PositionCheck> positions;  ///< None: no positions were recorded.
  GroundContour ground;
  ContourError following;  ///< f, as separated (turned, as published).
  MeasuredContour pin;     ///< t.
  std::optional<MeasuredContour> main;
  ContourSeparation direct;
  std::optional<IndirectSeparation> indirect;  ///< Beside the direct one.
  CorrelationOffset offset;  ///< Angle by which correlation would turn f; diagnosis.
};

/// What may be wrong with the errors of one axis, and f without that mistake.
struct AxisDoubt {
  enum class Kind { kSignOfX, kSignOfC, kRadiansAsDegrees };
  Kind kind = Kind::kSignOfX;
  double given_mm = 0.0;  ///< rms(t - f) of the mean of all parts, as given.
  double rms_mm = 0.0;    ///< The same without that mistake.
};

/// All parts side by side. The comparisons need two parts and are absent otherwise.
struct ContourStudy {
  std::vector<ContourPartResult> parts;
  std::optional<Repeatability> total;
  std::optional<Repeatability> following;
  std::optional<Repeatability> rest;
  std::optional<Repeatability> main;     ///< If every part has a main journal.
  std::optional<Repeatability> c_error;  ///< rad, over the command angle.
  std::optional<Repeatability> x_error;  ///< mm, over the command angle.
  double amplitude_ratio = 0.0;          ///< rms(f) / rms(n) over all parts; 0 when n is zero.
  CorrelationOffset offset;              ///< Common offset of all parts, a diagnosis.
  SenseEvidence sense;
  std::optional<AxisDoubt> axis;      ///< The likeliest that fits better, beyond chance.
  std::vector<core::Error> warnings;  ///< `where` is "parts/i/..." for warnings about one part.

  /// false: no part has traces, all f are by the main journals.
  [[nodiscard]] bool traced() const { return parts.empty() || parts.front().traced; }
};

/// What axis errors grind: the contour, and its error from the base circle, filtered as the study
/// filters every contour.
struct FollowingContour {
  GroundContour ground;
  ContourError error;
};
/// @return the errors of ground_contour() and contour_error().
[[nodiscard]] core::Result<FollowingContour> following_contour(const AxisErrors& errors,
                                                               const ContourStudyOptions& options);

/// Separates the contour of one part. See contour_study() for the errors.
[[nodiscard]] core::Result<ContourPartResult> contour_part(const ContourPart& part,
                                                           const ContourStudyOptions& options);

/// Separates the contours of all parts and compares them.
///
/// @return kNoPoints without parts, where some parts have traces and others none, and for a part
///         with neither traces nor a main journal; kBadOption for the method as published without
///         traces; the errors of last_turn(), ground_contour(), contour_error()
///         and measured_contour(), with `where` "parts/i/axes|pin|main"; kSampling if the control
///         has fewer than two samples per undulation at the cut-off; kInconsistent if recorded
///         positions of X contradict crank, wheel or the zero of C (stroke 0.05 mm, 0.02 mm rms).
///         Further warnings: kUndersampled below 6 samples per undulation, kUndercut,
///         kAlignment for a correlation offset that the rest does not explain, kSense for axis
///         errors that oppose the contour.
/// Source: methods, contour sections 6 to 9.
[[nodiscard]] core::Result<ContourStudy> contour_study(std::span<const ContourPart> parts,
                                                       const ContourStudyOptions& options = {});

/// f of the mean of all parts, at the angles of the contours [mm].
[[nodiscard]] const std::vector<double>& mean_following(const ContourStudy& study);

/// The table of a correction of X as a control takes it.
struct XTableOptions {
  std::size_t rows = 360;
  int highest_order = 0;       ///< Of x over C; below half the rows. 0: all that f has.
  double resolution_mm = 0.0;  ///< Rows are whole multiples of it; 0: as computed.
};

/// What a control adds to the command of X to take the mean f away, at the C positions of the
/// method 0, 360/rows, ... deg, without its mean: the size of the pin stays.
[[nodiscard]] std::vector<double> x_table_mm(const ContourStudy& study,
                                             const CrankGeometry& geometry,
                                             const XTableOptions& options);

/// A closed curve of equal steps, linear between them.
[[nodiscard]] double closed_at(std::span<const double> curve, double angle_rad);

}  // namespace rondure::fit
