#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evaluation/results/evaluation.h"

namespace rondure::reports {

/// A judged value of a simulated run beside what it is without errors of measurement.
struct HeldAgainstTruth {
  std::string name;  ///< Of the characteristic, with that of the value where it has several.
  evaluation::StatedValue found;
  double truth_mm = 0.0;  ///< As all numbers of `found`.
  std::optional<double> u_mm = {};

  /// The quoted value; where that is only a bound, the value as read.
  [[nodiscard]] double found_mm() const {
    return found.bound() == evaluation::StatedValue::Bound::kNone ? found.quoted_mm()
                                                                  : found.value_mm();
  }
  [[nodiscard]] double difference_mm() const { return found_mm() - truth_mm; }
  /// Nothing without an uncertainty.
  [[nodiscard]] std::optional<double> difference_over_u() const {
    return u_mm && *u_mm > 0.0 ? std::optional(difference_mm() / *u_mm) : std::nullopt;
  }
};

/// In the order of the plan; empty where the truth is not known, as of every real run.
[[nodiscard]] std::vector<HeldAgainstTruth> held_against_truth(
    const evaluation::CharacteristicResult& result);
[[nodiscard]] std::vector<HeldAgainstTruth> held_against_truth(
    const evaluation::FeatureResult& feature);

}  // namespace rondure::reports
