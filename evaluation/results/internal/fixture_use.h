#pragma once

#include <limits>
#include <optional>
#include <string>

#include "evaluation/results/evaluation.h"
#include "fixture/error_model.h"

namespace rondure::evaluation {

/// The fixture that carried the part, according to the record.
struct FixtureFacts {
  fixture::Kinematics kinematics;  ///< Nominal, or with the calibrated errors.
  std::optional<FixtureUse> use;   ///< The calibration; none: the fixture was treated as nominal.
  std::optional<fixture::Calibration> calibration;  ///< As the record holds it, whole.
};

/// Reads axes and calibration from the settings of the record, or the calibration that a feature of
/// the run found and those after it took, and checks again whether the run may use it:
/// fixture::check_calibration() at the start of the run. A pure function of the record.
/// @param feature  Index of the feature that the fixture carried; by default, after all.
[[nodiscard]] FixtureFacts fixture_facts(const record::RunRecord& record,
                                         int feature = std::numeric_limits<int>::max());

/// What the run took as its calibration from feature `source`; null where it did not come to that.
[[nodiscard]] const std::string* taken_calibration(const record::RunRecord& record, int source);

/// Makes the characteristics of a touched feature void when the calibration does not hold, and
/// checks how far temperature has moved the axes since: a gate of the feature.
void apply_calibration(const std::optional<FixtureUse>& use, FeatureResult& result);

}  // namespace rondure::evaluation
