#pragma once

#include <optional>
#include <string>

#include "evaluation/results/evaluation.h"
#include "fixture/error_model.h"

namespace rondure::evaluation {

/// What a record says of the fixture that carried the part.
struct FixtureFacts {
  fixture::Kinematics kinematics;  ///< Nominal, or with the errors of the calibration.
  std::optional<FixtureUse> use;   ///< The calibration; none: the fixture was taken as nominal.
};

/// Reads axes and calibration from the settings of the record and judges once more whether the run
/// may use it: fixture::check_calibration() at the start of the run. A pure function of the record.
[[nodiscard]] FixtureFacts fixture_facts(const record::RunRecord& record);

/// Makes the characteristics of a touched feature void when the calibration does not hold.
void apply_calibration(const std::optional<FixtureUse>& use, FeatureResult& result);

}  // namespace rondure::evaluation
