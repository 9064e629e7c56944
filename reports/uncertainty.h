#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "reports/form_cloud.h"
#include "reports/form_spectrum.h"
#include "reports/influences.h"

namespace rondure::reports {

/// Settings of measurement_uncertainty(). A value outside its range gives kBadOption.
struct UncertaintyOptions {
  /// Trials stop when twice the standard deviation of each printed number is below this [mm], JCGM
  /// 101 section 7.9; 0: when the most trials are done.
  double tolerance_mm = 0.0;
  int block_trials = 1000;   ///< Trials between two looks at the tolerance; >= 100.
  int least_trials = 2000;   ///< At least two blocks, so that they can be compared.
  int most_trials = 10000;   ///< >= least_trials, <= 10 000 000.
  int budget_trials = 1000;  ///< Of each influence alone, >= 2; 0: no budget.
  double coverage = 0.95;    ///< Probability of the interval, 0.5..0.999.
  std::uint64_t seed = 1;    ///< Same seed, same numbers, at any number of threads.
  int threads = 0;           ///< 0: as many as the processor has.
};

/// What a statement is about. Never mixed.
enum class Measurand {
  kSampledPoints,  ///< (a) the value of the surface at the sampled points, free of noise.
  kWholeSurface,   ///< (b) the value of the whole surface, under the stated form spectrum.
};
/// "at the sampled points", "of the whole surface".
[[nodiscard]] std::string_view name_of(Measurand measurand);

/// A value with its interval.
struct UncertaintyStatement {
  Measurand measurand = Measurand::kSampledPoints;
  double estimate_mm = 0.0;  ///< Corrected for the bias: mean of the trials.
  double low_mm = 0.0;       ///< Coverage interval, as much outside on either side.
  double high_mm = 0.0;
  double standard_uncertainty_mm = 0.0;  ///< Standard deviation of the trials.
  /// Twice the standard deviation of the mean of the blocks, the largest of estimate, standard
  /// uncertainty, low and high [mm]: what the number of trials leaves open.
  double numerical_tolerance_mm = 0.0;
  std::vector<double> values_mm;  ///< Of the trials, ascending: the whole distribution.

  /// U: half the width of the interval, which need not lie evenly about the estimate.
  [[nodiscard]] double expanded_mm() const { return 0.5 * (high_mm - low_mm); }
};

/// What one influence alone does to the measured value.
struct BudgetLine {
  std::string name;  ///< As in InfluenceStatement; "sampling" for (b).
  Measurand measurand = Measurand::kSampledPoints;
  double standard_uncertainty_mm = 0.0;  ///< Spread it gives the value.
  double shift_mm = 0.0;                 ///< Mean change of the value, with sign.
  double share_1 = 0.0;                  ///< Of the sum of the squares of the spreads, 0..1.
};

/// The uncertainty of one form value.
struct UncertaintyResult {
  double uncorrected_mm = 0.0;                ///< The value of the points as measured.
  UncertaintyStatement sampled;               ///< (a)
  std::optional<UncertaintyStatement> whole;  ///< (b), where a spectrum was stated.
  /// Expected inflation by noise: uncorrected minus estimate (a) [mm]; commonly > 0.
  double noise_inflation_mm = 0.0;
  /// Expected loss by sparse sampling: estimate (a) minus estimate (b) [mm]; commonly < 0. Hence
  /// uncorrected = estimate (b) + inflation + loss.
  std::optional<double> sampling_loss_mm;
  std::string spectrum_source;                  ///< Of (b); empty without.
  std::vector<BudgetLine> budget;               ///< Ranked by spread, the largest first.
  std::vector<InfluenceStatement> declaration;  ///< Covered and not covered.
  int trials = 0;
  bool tolerance_reached = false;  ///< false too when none was asked for.
};

/// Uncertainty of a form value by propagating distributions (Monte Carlo).
///
/// The deviations are form + errors; adding errors to them again would inflate twice. So each trial
/// makes a part (form of the estimated size) and an inspection (errors of every influence), has the
/// form estimated from it exactly as from the real deviations, and lays the error of that estimate
/// onto the real estimate: a form that may stand behind the data. Its minimum zone is one value of
/// the distribution. (a) takes the forms of the points as independent; (b) as of the spectrum.
///
/// @param cloud       >= 4 (section) or 6 (cylinder) points that determine place and size;
/// measured,
///                    or nominal with deviations made by somebody else.
/// @param spectrum    For (b); none: no statement about the whole surface.
/// @return  kTooFewPoints, kNotFinite (row), kRank, kBadOption. Same input, same bits, on one kind
///          of processor. 28 points: some 10 us a trial of (a), 40 us of (b).
/// Sources: JCGM 101:2008 (propagation of distributions, 7.9 adaptive trials); ISO/TS 15530-4:2008
/// (declaration); A. G. Journel, C. J. Huijbregts, Mining Geostatistics, 1978 (conditioning a draw
/// by the error of its own estimate). The method in words: docs/uncertainty.md.
[[nodiscard]] core::Result<UncertaintyResult> measurement_uncertainty(
    const FormCloud& cloud, const Influences& influences,
    const std::optional<FormSpectrum>& spectrum = std::nullopt,
    const UncertaintyOptions& options = {});

/// What one inspection of a part of a form spectrum would read: for a prediction before the first
/// touch, whose measurement_uncertainty() is then that of such an inspection.
///
/// @param nominal   Places; their deviations are not looked at.
/// @param spectrum  Its amplitudes are taken as they are.
/// @param seed      Another seed, another part and another inspection.
/// @return  The cloud with deviations, about its axis; as measurement_uncertainty() otherwise.
[[nodiscard]] core::Result<FormCloud> simulated_cloud(const FormCloud& nominal,
                                                      const Influences& influences,
                                                      const FormSpectrum& spectrum,
                                                      std::uint64_t seed);

}  // namespace rondure::reports
