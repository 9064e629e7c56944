#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "evaluation/uncertainty/uncertainty.h"
#include "plans/plan.h"

namespace rondure::app {

/// A sampling of a feature, as its plan spells it.
struct Sampling {
  int layers = 0;
  int points_per_layer = 0;
  int repeats = 0;  ///< Touches of every point of the final cloud.

  friend bool operator==(const Sampling&, const Sampling&) = default;
};

/// A sampling that was tried.
struct SamplingCandidate {
  Sampling sampling;
  int touches = 0;                       ///< Of the whole run.
  double time_s = 0.0;                   ///< Of the whole run, as forecast() predicts it.
  double expanded_mm = 0.0;              ///< Predicted U, the largest of its characteristics.
  double nine_of_ten_expanded_mm = 0.0;  ///< U that nine of ten parts do not exceed.
  bool meets = false;                    ///< Whether that U is not above the target.
  bool confirmed = false;                ///< Predicted with the full number of simulated parts.
  int stated = 0;                        ///< Characteristics whose interval is predicted.
  std::string missing;                   ///< Why another has none; empty: each has one.
  std::string out_of_reach;  ///< Not empty: why it cannot be touched, or loses an interval that the
                             ///< plan has; no numbers then.
};

/// Result of the search for one feature.
struct SamplingSearch {
  std::size_t feature = 0;  ///< Index into the plan.
  evaluation::Measurand measurand =
      evaluation::Measurand::kSampledPoints;  ///< Of the decision rule.
  Sampling planned;
  std::vector<SamplingCandidate> candidates;  ///< By time.
  std::optional<std::size_t> best;            ///< The cheapest that meets the target.
  std::string limit;  ///< Without a best one: main influences on the smallest U.
  std::string why;    ///< Not empty: why nothing was tried.
};

/// A key of the plan with another value.
struct SamplingChange {
  std::string object;  ///< JSON pointer of its object: "/features/0/sampling".
  std::string key;
  int value = 0;
};

/// The changes of the plan for the best sampling; empty if the plan has it already.
[[nodiscard]] std::vector<SamplingChange> changes_of(const SamplingSearch& search);

/// For each touched feature, finds the sampling of least time whose U meets a target.
///
/// Varied: layers, points per layer, repeats. If the decision rule concerns the sampled points,
/// fewer points than the plan's are not tried, because they would make the measurand easier, and
/// only a few layouts with more. For each layout, bisection with few simulated parts finds the
/// smallest number of repeats that meets the target. The cheapest layout is then predicted as by
/// `rondure plan`, and skipped if that does not confirm it. A scan keeps its points: more of them
/// take no time.
/// @param target_mm  > 0.
/// @return  The errors of forecast() and predict() for the unchanged plan.
[[nodiscard]] core::Result<std::vector<SamplingSearch>> search_samplings(const plans::Plan& plan,
                                                                         double target_mm);

}  // namespace rondure::app
