#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "evaluation/uncertainty/statement.h"
#include "evaluation/uncertainty/uncertainty.h"
#include "record/run_record.h"
#include "record/tasks/uncertainty.h"

namespace rondure::evaluation {

/// Settings of predict(). A value outside its range gives kBadOption.
struct PredictionOptions {
  int least_inspections = 24;  ///< Simulated parts, each inspected once; 8..most.
  /// Greatest number of inspections, up to 10 000; fewer for large clouds, but at least 8.
  int most_inspections = 120;
  /// Stop when the standard deviation of the mean width is below this fraction of the width; >= 0.
  double tolerance_1 = 0.02;
  int trials = 200;           ///< Trials per inspection, 200..100 000.
  int budget_trials = 0;      ///< Trials per influence alone and per part; 0: no budget, else >= 2.
  bool whole_surface = true;  ///< false: no statement (b), in a fifth of the time.
  /// Leaves out all but CYLt and RONt without filter, portion or window, whose interval depends on
  /// the sampling of their feature alone and which have a budget.
  bool plain_forms_only = false;
  std::uint64_t seed = 1;  ///< Same seed, same numbers, at any number of threads.
  int threads = 0;         ///< 0: as many as the processor has.
};

/// The names of the influences of a touched surface that a plan leaves undeclared.
/// @param repeated  Points are touched more than once, which shows the repeatability of a touch.
[[nodiscard]] std::vector<std::string> undeclared_influences(
    const record::UncertaintyTask& said, const std::optional<double>& expansion_per_K,
    bool repeated);

/// The interval that a run would state, relative to the value that it would state.
struct PredictedStatement {
  Measurand measurand = Measurand::kSampledPoints;
  /// Mean of the estimate over the parts. The bounds are relative to it:
  double expected_mm = 0.0;
  double below_mm = 0.0;  ///< estimate minus lower end [mm], >= 0.
  double above_mm = 0.0;  ///< upper end minus estimate [mm], >= 0.
  /// Width that nine of ten parts stay below [mm]. The width differs from part to part, as do the
  /// contacts of the zone and the points that nearly touch it.
  double nine_of_ten_width_mm = 0.0;
  double one_of_ten_width_mm = 0.0;  ///< Width that one of ten parts stays below.

  /// Width of the interval, mean over the parts.
  [[nodiscard]] double width_mm() const { return below_mm + above_mm; }
  /// U: half the width.
  [[nodiscard]] double expanded_mm() const { return 0.5 * width_mm(); }
  /// U that nine of ten parts stay below.
  [[nodiscard]] double nine_of_ten_expanded_mm() const { return 0.5 * nine_of_ten_width_mm; }
};

/// Predicted statement of a run about a characteristic.
struct Prediction {
  /// Why the run would state no interval; the members below are then empty. Empty if it would.
  std::string why;
  double coverage_1 = 0.0;
  std::optional<PredictedStatement> sampled;  ///< (a)
  std::optional<PredictedStatement> whole;    ///< (b), where the plan states a spectrum.
  std::string form;                           ///< The assumed form of the parts, in words.
  /// The assumed repeatability, where the run would determine it itself.
  std::string repeatability;
  std::vector<BudgetLine> budget;  ///< Root mean squares; ranked, the largest first.

  [[nodiscard]] const std::optional<PredictedStatement>& about(Measurand measurand) const {
    return measurand == Measurand::kSampledPoints ? sampled : whole;
  }
};

/// Predicts the intervals of the characteristics of surfaces before the first touch.
///
/// Parts are drawn from an assumed form, each is inspected once with one draw of every declared
/// influence, and the intervals of each inspection are computed as in a run, with fewer trials: of
/// plain CYLt and RONt by measurement_uncertainty(), of all others by the trials of the part
/// (part/trials.h). Of a characteristic with two judged values the wider interval counts.
///
/// Form: the spectrum that the plan declares, with its amplitudes as they are. Without one: 2..15
/// undulations that fall as 1/n, taper, barrel and bend, scaled so that the expected value is half
/// the tolerance or, without a tolerance, ten times the standard deviation of a point.
/// Characteristics with common trials share their parts: the form of each surface uses half of the
/// form tolerance that it reaches first, and a surface with a tolerance about a datum is displaced
/// by half of the tightest one.
/// Repeatability of a touch: as declared; where the run would determine it from its repeats, at
/// most the value that the form limit of the qualification just allows (P / 3.93). With one touch
/// per point the run determines none, and then there is no interval.
///
/// @param expected  An error-free record: places, repeats and times of the touches, settings.
/// @param features  Indices into its features.
/// @return  For each of them, one prediction for each of its characteristics, whose `why` states
///          what prevents an interval; or kBadOption. Same input, same bits, on one kind of
///          processor. A plain form of 28 points: 0.1 s for (a), 0.4 s for (b) on two cores; all
///          others together at most about as long as the trials of the run.
/// Source: docs/uncertainty.md, "Before the first touch".
[[nodiscard]] core::Result<std::vector<std::vector<Prediction>>> predict(
    const record::RunRecord& expected, std::span<const int> features,
    const PredictionOptions& options = {});

/// Predicted statement of a run about a characteristic of an analysis of series.
struct AnalysisPrediction {
  /// Why nothing is predicted; the members below are then empty. Empty if something is.
  std::string why;
  double coverage_1 = 0.0;
  double as_read_mm = 0.0;   ///< The value as read of the simulated data.
  double expected_mm = 0.0;  ///< Its estimate; with `at_most` the upper bound.
  double below_mm = 0.0;     ///< expected minus lower end [mm], >= 0.
  double above_mm = 0.0;     ///< upper end minus expected [mm], >= 0.
  bool at_most = false;      ///< Only the upper bound would be stated: noise dominates.
  /// By linear propagation: root sum of squares of the budget [mm].
  double linear_u_mm = 0.0;
  std::vector<BudgetLine> budget;  ///< Linear propagation; ranked, the largest first.

  /// U: half the width of the interval.
  [[nodiscard]] double expanded_mm() const { return 0.5 * (below_mm + above_mm); }
};

/// Why the value of a characteristic cannot be foretold, whatever is declared: it is the scatter or
/// the error of what is measured, which only readings show. None of the others.
[[nodiscard]] std::optional<std::string> why_not_foretold(record::Form form);

/// Predicts the intervals of the characteristics of an analysis before its first reading, in their
/// order: evaluates one simulated set of data as a run does, with its declared influences.
///
/// @param simulated  A record that holds the simulated series of the feature.
/// @param feature    Index of a spindle, wheel or contour.
/// @return  kBadOption for another feature; `why` states what prevents an interval. Same input,
/// same
///          bits, on one kind of processor.
[[nodiscard]] core::Result<std::vector<AnalysisPrediction>> predict_analysis(
    const record::RunRecord& simulated, int feature);

/// The tip centres that touch one ball in one combined pose, free of errors [mm].
using BallTouches = std::vector<Eigen::Vector3d>;

/// The standard uncertainty that the residuals of a fixture calibration will have by linear
/// propagation, whatever the fixture does.
struct ResidualPrediction {
  std::string why;  ///< Why there is none; the members below are then empty. Else empty.
  /// Of a coordinate of a ball centre: touches, the ball itself, the machine [mm].
  double center_u_mm = 0.0;
  std::size_t centers = 0;    ///< Ball centres of all combined poses.
  double rms_u_mm = 0.0;      ///< Of the rms residual: u of a centre over the root of their number.
  double largest_u_mm = 0.0;  ///< Of the largest residual, at most: u of a centre.
  std::string repeatability;  ///< The repeatability of a touch, and where it comes from.
};

/// Predicts it from the declared influences and the planned touches, before the first of them.
/// Repeatability of a touch: as `uncertainty.probe` declares it, else at most the value that the
/// form limit of the qualification just allows (P / 3.93), as predict() assumes it.
///
/// @param expected  Settings and features; holds no touches of the feature.
/// @param feature   Index of a feature of the type rotary_axes.
/// @param combined  The balls of all combined poses.
/// @return  kBadOption for another feature; `why` states what prevents it.
/// Source: docs/fixture-calibration.md, "Residual at combined poses".
[[nodiscard]] core::Result<ResidualPrediction> predict_residual(
    const record::RunRecord& expected, int feature, std::span<const BallTouches> combined);

}  // namespace rondure::evaluation
