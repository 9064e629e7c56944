#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/phrase.h"
#include "core/words.h"
#include "evaluation/uncertainty/influences.h"

namespace rondure::evaluation {

/// Settings of measurement_uncertainty(). A value outside its range gives kBadOption.
struct UncertaintyOptions {
  /// Trials stop when twice the standard deviation of each printed number is below this [mm], JCGM
  /// 101 section 7.9; 0: run most_trials.
  double tolerance_mm = 0.0;
  int chains = 8;  ///< Chains of draws, compared with one another, 1..64. One has no comparison.
  int least_trials = 2000;   ///< >= 100; shared among the chains.
  int most_trials = 10000;   ///< >= least_trials, <= 10 000 000; 1000 above 20 000 points.
  int budget_trials = 1000;  ///< Trials of each influence alone, >= 2; 0: no budget.
  /// Expected spots on a part (single points that stand out), 0.01..10.
  double expected_spots = 0.5;
  double coverage = 0.95;  ///< Probability of the interval, 0.5..0.999.
  std::uint64_t seed = 1;  ///< Same seed, same numbers, at any number of threads.
  int threads = 0;         ///< 0: as many as the processor has.
};

/// Subject of a statement. The two are never mixed.
enum class Measurand {
  kSampledPoints,  ///< (a) the value of the surface at the sampled points, free of noise.
  kWholeSurface,   ///< (b) the value of the whole surface, under the stated form spectrum.
};
RONDURE_WORDS(Measurand, {kSampledPoints, "at the sampled points"},
              {kWholeSurface, "of the whole surface"});

/// A value with its interval.
struct UncertaintyStatement {
  Measurand measurand = Measurand::kSampledPoints;
  double estimate_mm = 0.0;  ///< Mean of the trials, corrected for the bias. Inside the interval.
  double low_mm = 0.0;       ///< Coverage interval, with equal probability on either side.
  double high_mm = 0.0;
  double standard_uncertainty_mm = 0.0;  ///< Standard deviation of the trials.
  /// Twice the standard deviation of the mean of the chains, the largest of estimate, standard
  /// uncertainty, low and high [mm]: the numerical error of a finite number of trials.
  double numerical_tolerance_mm = 0.0;
  /// Noise and influences make up so much of the value that only `high_mm` is stated: the value is
  /// at most that.
  bool at_most = false;
  std::vector<double> values_mm;  ///< Values of the trials, ascending: the whole distribution.

  /// U: half the width of the interval, which need not be symmetric about the estimate.
  [[nodiscard]] double expanded_mm() const { return 0.5 * (high_mm - low_mm); }
};

/// Decimals for a length in um with uncertainty U: two digits of U, 1 to 4 decimals.
[[nodiscard]] int decimals_for(double expanded_mm);

/// Effect of one influence alone on the measured value.
struct BudgetLine {
  std::string name;  ///< As in InfluenceStatement; "sampling" for (b).
  Measurand measurand = Measurand::kSampledPoints;
  double standard_uncertainty_mm = 0.0;  ///< Spread of the value.
  double shift_mm = 0.0;                 ///< Mean change of the value, signed.
  double share_1 = 0.0;                  ///< Fraction of the sum of the squared spreads, 0..1.
  /// Change of the value for +1 standard uncertainty, signed, where the line is linear propagation.
  std::optional<double> per_u_mm = {};
};

/// Composition of the cloud: means over the draws.
struct FormFinding {
  double noise_mm = 0.0;       ///< Standard deviation of the error of a point.
  double unresolved_mm = 0.0;  ///< Standard deviation of form rougher than the columns.
  double groups = 0.0;         ///< Number of undulations (of a degree along the axis) present.
  double spots = 0.0;          ///< Number of spots: burrs, dirt, scratches.
  /// Rows of the cloud that are spots in more than half of the draws.
  std::vector<std::size_t> spot_rows;
};

/// The uncertainty of one form value.
struct UncertaintyResult {
  double uncorrected_mm = 0.0;                ///< The value of the points as read.
  UncertaintyStatement sampled;               ///< (a)
  std::optional<UncertaintyStatement> whole;  ///< (b), where a spectrum was stated.
  /// Expected inflation by noise: uncorrected minus estimate (a) [mm]; usually > 0.
  double noise_inflation_mm = 0.0;
  /// Expected loss by sparse sampling: estimate (a) minus estimate (b) [mm]; <= 0. Hence
  /// uncorrected = estimate (b) + inflation + loss.
  std::optional<double> sampling_loss_mm;
  core::Phrase spectrum_source;  ///< Source of the spectrum of (b); empty without.
  FormFinding finding;
  std::vector<core::Phrase> notes;              ///< To be read beside the interval.
  std::vector<BudgetLine> budget;               ///< Ranked by spread, the largest first.
  std::vector<InfluenceStatement> declaration;  ///< Covered and uncovered influences.
  int trials = 0;
  bool tolerance_reached = false;  ///< false too when no tolerance was set.
};

}  // namespace rondure::evaluation
