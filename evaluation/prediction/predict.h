#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "evaluation/uncertainty/uncertainty.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// Settings of predict(). A value outside its range gives kBadOption.
struct PredictionOptions {
  int least_inspections = 24;  ///< Simulated parts, each inspected once; 8..most.
  /// The inspections end here at the latest, up to 10 000; large clouds: earlier, with at least 8.
  int most_inspections = 120;
  /// They end when the standard deviation of the mean width is below this share of it; >= 0.
  double tolerance_1 = 0.02;
  int trials = 200;           ///< Of each inspection, 200..100 000.
  int budget_trials = 0;      ///< Of each influence alone, of each part; 0: no budget, else >= 2.
  bool whole_surface = true;  ///< false: nothing is said about (b), in a fifth of the time.
  std::uint64_t seed = 1;     ///< Same seed, same numbers, at any number of threads.
  int threads = 0;            ///< 0: as many as the processor has.
};

/// The interval that a run would state, about the value that it would state.
struct PredictedStatement {
  Measurand measurand = Measurand::kSampledPoints;
  double expected_mm = 0.0;  ///< Mean over the parts of the estimate; of each bound its distance:
  double below_mm = 0.0;     ///< estimate minus lower end [mm], >= 0.
  double above_mm = 0.0;     ///< upper end minus estimate [mm], >= 0.
  /// Width that nine of ten parts stay below [mm]: where the contacts of the zone lie, and how near
  /// others come to them, differs from part to part, and so does the width.
  double nine_of_ten_width_mm = 0.0;
  double one_of_ten_width_mm = 0.0;  ///< Width that one of ten parts stays below.

  /// Of the interval, mean over the parts.
  [[nodiscard]] double width_mm() const { return below_mm + above_mm; }
  /// U: half the width.
  [[nodiscard]] double expanded_mm() const { return 0.5 * width_mm(); }
  /// The U that nine of ten parts stay below.
  [[nodiscard]] double nine_of_ten_expanded_mm() const { return 0.5 * nine_of_ten_width_mm; }
};

/// What a run would say about a characteristic.
struct Prediction {
  std::string why;  ///< Not empty: why the run would state no interval; all below is empty then.
  double coverage_1 = 0.0;
  std::optional<PredictedStatement> sampled;  ///< (a)
  std::optional<PredictedStatement> whole;    ///< (b), where the plan states a spectrum.
  std::string form;                ///< The form that the parts are assumed to have, in words.
  std::string repeatability;       ///< Where the run would find it by itself: what is assumed.
  std::vector<BudgetLine> budget;  ///< Root mean squares; ranked, the largest first.

  [[nodiscard]] const std::optional<PredictedStatement>& about(Measurand measurand) const {
    return measurand == Measurand::kSampledPoints ? sampled : whole;
  }
};

/// Predicts the interval of a characteristic before the first touch.
///
/// Parts are drawn from an assumed form, each is inspected once with one draw of every declared
/// influence, and the interval of each inspection is found as a run finds it, by
/// uncertainty_question() and measurement_uncertainty() with fewer trials.
///
/// Form: the spectrum that the plan declares, its amplitudes as they are. Where it declares none:
/// 2..15 undulations that fall as 1/n, taper, barrel and bend, of the size that the value expected
/// is half the tolerance; without a tolerance ten times the standard deviation of a point.
/// Repeatability of a touch: as declared; where the run would find it from its repeats: what the
/// form limit of the qualification just lets pass (P / 3.93), at most that. With one touch a point
/// the run finds none, and then there is no interval.
///
/// @param expected  A record without errors: places, repeats and times of the touches, settings.
/// @param feature   Index into its features.
/// @return  kBadOption; what stands in the way of an interval is in `why`. Same input, same bits,
///          on one kind of processor. 28 points: 0.1 s for (a), 0.4 s for (b) on two cores.
/// Source: docs/uncertainty.md, "Before the first touch".
[[nodiscard]] core::Result<Prediction> predict(const record::RunRecord& expected, int feature,
                                               const record::Characteristic& asked,
                                               const PredictionOptions& options = {});

}  // namespace rondure::evaluation
