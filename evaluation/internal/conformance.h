#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "evaluation/interval/internal/part_intervals.h"
#include "evaluation/results/evaluation.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// A characteristic that find() computed, with its uncertainty.
struct FoundCharacteristic {
  core::Result<Finding> finding;
  PartInterval interval = {};
  std::vector<double> about_nominal_mm = {};  ///< The judged values about z; see FeatureResult.
};

/// What find() computes of a part: for each feature one element for each of its characteristics,
/// empty where find() has none. Points far off the surface are named in the warnings of the other
/// forms' features. The trials of all intervals move all features together.
using PartFindings = std::vector<std::vector<std::optional<FoundCharacteristic>>>;

[[nodiscard]] PartFindings find_all(const record::RunRecord& record,
                                    std::span<FeatureResult> features,
                                    const std::optional<fit::ProbeTip>& probe);

/// Fills the characteristics of an evaluated feature: stated value, verdict under the rule and its
/// reason. Void when a condition is missing: no result, a reference that does not exist for the
/// points, no certificate for it, a section that proves nothing, temperature or probe qualification
/// outside the limits of the plan, a run that did not finish, an unknown rule, or one that cannot
/// be applied (apply_rule()).
///
/// @param probe  The qualification of the run; a touched feature without a valid one is void.
/// @param found  Those of its characteristics that find() computes.
void decide(const record::RunRecord& record, const core::Result<DecisionRule>& rule,
            const std::optional<fit::ProbeTip>& probe,
            std::span<std::optional<FoundCharacteristic>> found, FeatureResult& result);

/// How warm the part was: "20.3 degC", "20.0 degC declared, not measured", "temperature not
/// recorded"; with what bringing it to 20 degC did.
[[nodiscard]] core::Phrase temperature_words(const FeatureResult& result);

/// Why temperature makes a result void: outside the limits, or neither measured nor declared. The
/// limits apply to all touched features, and to points of files and series where the plan has the
/// object `environment`.
[[nodiscard]] std::optional<core::Phrase> temperature_fault(const record::RunRecord& record,
                                                            const FeatureResult& result);

/// Applies the rule to a characteristic that has a stated, valid value.
void apply(const core::Result<DecisionRule>& rule, CharacteristicResult& out);

/// The worst verdict of all toleranced characteristics, in the order does not conform, void,
/// undecided, conforms; not toleranced when there is none. A feature that failed is void.
[[nodiscard]] Verdict overall(const std::vector<FeatureResult>& features);

}  // namespace rondure::evaluation
