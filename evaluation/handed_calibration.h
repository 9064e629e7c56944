#pragma once

#include <optional>
#include <string>

#include "core/phrase.h"
#include "evaluation/results/evaluation.h"

namespace rondure::evaluation {

/// The calibration that a feature of the type "rotary_axes" gives to other measurements.
struct HandedCalibration {
  std::string text;  ///< fixture-calibration.json; where it is void, a text that no run accepts.
  std::optional<core::Phrase> void_because;  ///< None: it holds.
};
[[nodiscard]] HandedCalibration handed_calibration(const FeatureResult& result);

/// Makes `use` invalid where the feature that calibrated the fixture is void, or where its touches
/// give another calibration than the run took.
/// @param source  That feature, evaluated.
void hold_against(const FeatureResult& source, const std::string* taken, FixtureUse& use);

}  // namespace rondure::evaluation
