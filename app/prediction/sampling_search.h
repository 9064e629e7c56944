#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/prediction/sampling_layout.h"
#include "core/result.h"
#include "evaluation/uncertainty/uncertainty.h"
#include "plans/plan.h"

namespace rondure::app {

/// What was found for one feature.
struct SamplingSearch {
  std::size_t feature = 0;  ///< Index into the plan.
  evaluation::Measurand measurand =
      evaluation::Measurand::kSampledPoints;  ///< Of the decision rule.
  Sampling planned;
  std::vector<SamplingCandidate> candidates;  ///< By time.
  std::optional<std::size_t> best;            ///< The cheapest that meets the target.
  std::string limit;  ///< Without a best one: the largest influences of the smallest U.
  std::string why;    ///< Not empty: why nothing was tried.
};

/// A key of the plan with another value.
struct SamplingChange {
  std::string object;  ///< JSON pointer of the object it stands in: "/features/0/sampling".
  std::string key;
  int value = 0;
};

/// What to change in the plan for the best sampling; nothing where it has that already.
[[nodiscard]] std::vector<SamplingChange> changes_of(const SamplingSearch& search);

/// Looks for the sampling with the least time whose U meets a target, for each touched feature.
///
/// Knobs: layers, points of a layer, repeats. Where the decision rule is about the sampled points,
/// fewer points than the plan's are not tried: they would ask another, easier question; and only
/// few layouts with more. The
/// smallest number of repeats that meets the target is found for each layout by bisection, with few
/// simulated parts; the cheapest is then predicted again as `rondure plan` would, and passed over
/// if that does not confirm it. A scan keeps its points: more of them take no time.
/// @param target_mm  > 0.
/// @return  The errors of forecast() and predict() for the plan as it stands.
[[nodiscard]] core::Result<std::vector<SamplingSearch>> search_samplings(const plans::Plan& plan,
                                                                         double target_mm);

}  // namespace rondure::app
