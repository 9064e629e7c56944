#pragma once

#include <concepts>
#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

#include "core/phrase.h"
#include "core/result.h"
#include "evaluation/uncertainty/cloud.h"
#include "evaluation/uncertainty/internal/error_modes.h"
#include "evaluation/uncertainty/internal/sampler.h"
#include "evaluation/uncertainty/statement.h"

// Private to the room: the statement that trials make, and the guards that void it. Common to the
// form values of one cloud and to the characteristics of a part.

namespace rondure::evaluation {

/// Composition of a cloud according to the draws of one chain: sums.
struct DrawTally {
  double draws = 0.0;
  double unresolved_mm = 0.0;
  double noise_mm = 0.0;
  double groups = 0.0;
  double spots = 0.0;
  double scatter_1 = 0.0;        ///< Sum over the draws without unresolved form.
  int resolved = 0;              ///< Number of those draws.
  std::vector<int> spot_counts;  ///< For each point, the number of draws in which it is a spot.

  void add(const FormDraw& draw);
};

/// For KeptDraws.
template <class Tally, class Use>
requires std::same_as<std::remove_const_t<Tally>, DrawTally>
bool members_of(Tally& t, const Use& use) {
  return use(t.draws, t.unresolved_mm, t.noise_mm, t.groups, t.spots, t.scatter_1, t.resolved,
             t.spot_counts);
}

/// Estimate, standard uncertainty and interval of trials: JCGM 101 sections 7.6 and 7.7.
[[nodiscard]] UncertaintyStatement statement_of(std::vector<double> trials, double coverage);

/// JCGM 101 section 7.9.4: twice the standard deviation of the mean of the chains, the worst of the
/// four numbers of a statement. 0 for one chain, or without values.
[[nodiscard]] double numerical_tolerance_mm(std::span<const std::span<const double>> chains,
                                            double coverage);

/// Gives each line its share of the lines of (a), sampling its share of all lines; then ranks them,
/// the largest spread first.
void share_out(std::vector<BudgetLine>& budget);

[[nodiscard]] core::Result<void> check_cloud(const FormCloud& cloud);
[[nodiscard]] core::Result<void> check_options(const UncertaintyOptions& options);
/// A reference that exists for the measured points may not exist for every possible drawn form.
[[nodiscard]] core::Result<void> check_values(std::span<const double> values);

[[nodiscard]] int threads_of(const UncertaintyOptions& options);

/// Whether nothing is known of the errors of single touches.
[[nodiscard]] bool noise_is_unknown(const ErrorModel& errors, const Influences& influences);

[[nodiscard]] FormFinding finding_of(std::span<const DrawTally> chains, std::size_t points);

/// Checks that a smooth form stands behind the points.
[[nodiscard]] core::Result<void> guard_outliers(const FormModel& model);
/// Checks that the points do not scatter less than declared. Adds a note where that cannot be
/// shown. Points without any deviation pass: no form hides behind what was declared of them.
[[nodiscard]] core::Result<void> guard_scatter(std::span<const DrawTally> chains,
                                               const FormCloud& cloud, const FormFinding& finding,
                                               std::vector<core::Phrase>& notes);
/// Checks that the model would read the measured value. A value of zero passes likewise.
/// @param read_mm  Values of simulated inspections of drawn forms.
[[nodiscard]] core::Result<void> guard_reading(std::vector<double> read_mm, double uncorrected_mm);

}  // namespace rondure::evaluation
