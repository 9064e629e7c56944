#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "evaluation/uncertainty/uncertainty.h"
#include "plans/plan.h"

namespace rondure::app {

/// A sampling of a feature, spelled as in its plan.
struct Sampling {
  int layers = 0;
  int points_per_layer = 0;
  int repeats = 0;  ///< Touches of each point of the final cloud.

  friend bool operator==(const Sampling&, const Sampling&) = default;
};

/// A sampling that was tried.
struct SamplingCandidate {
  Sampling sampling;
  int touches = 0;                       ///< Touches of the whole run.
  double time_s = 0.0;                   ///< Time of the whole run, as predicted by forecast().
  double expanded_mm = 0.0;              ///< Predicted U, the largest over the characteristics.
  double nine_of_ten_expanded_mm = 0.0;  ///< U that nine of ten parts do not exceed.
  bool meets = false;      ///< Whether `nine_of_ten_expanded_mm` is not above the target.
  bool confirmed = false;  ///< Predicted with the full number of simulated parts.
  int stated = 0;          ///< Characteristics whose interval is predicted.
  std::string missing;     ///< Why another characteristic has no interval; empty: all have one.
  /// Why this sampling cannot be touched, or loses an interval that the plan has; the numbers are
  /// then unset. Empty if it can be used.
  std::string out_of_reach;
};

/// Result of the search for one feature.
struct SamplingSearch {
  std::size_t feature = 0;  ///< Index into the plan.
  evaluation::Measurand measurand =
      evaluation::Measurand::kSampledPoints;  ///< Measurand of the decision rule.
  Sampling planned;
  std::vector<SamplingCandidate> candidates;  ///< Sorted by time.
  std::optional<std::size_t> best;            ///< The fastest that meets the target.
  std::string limit;  ///< Without `best`: main influences on the smallest U.
  std::string why;    ///< Why nothing was tried; empty if something was.
};

/// A key of the plan with another value.
struct SamplingChange {
  /// JSON pointer of the object that contains the key: "/features/0/sampling".
  std::string object;
  std::string key;
  int value = 0;
};

/// The changes of the plan for the best sampling; empty if the plan already has it.
[[nodiscard]] std::vector<SamplingChange> changes_of(const SamplingSearch& search);

/// For each touched feature, finds the fastest sampling whose U meets a target.
///
/// Varied: layers, points per layer, repeats. If the decision rule concerns the sampled points,
/// fewer points than the plan's are not tried, because they would make the measurand easier, and
/// only a few layouts have more. For each layout, bisection with few simulated parts finds the
/// smallest number of repeats that meets the target. The fastest layout is then predicted as by
/// `rondure plan`, and skipped if that does not confirm it. A scan keeps its points, because more
/// points cost no time.
/// @param target_mm  > 0.
/// @return  The errors of forecast() and predict() for the unchanged plan.
[[nodiscard]] core::Result<std::vector<SamplingSearch>> search_samplings(const plans::Plan& plan,
                                                                         double target_mm);

}  // namespace rondure::app
