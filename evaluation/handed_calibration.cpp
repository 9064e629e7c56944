#include "evaluation/handed_calibration.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <variant>

#include "core/numbers.h"
#include "evaluation/analysis_result.h"

namespace rondure::evaluation {
namespace {

/// Whether two texts of a calibration differ by no more than rounding, which differs from one kind
/// of processor to another.
bool same_calibration(std::string_view a, std::string_view b) {
  constexpr double kSame_um = 1e-6;
  constexpr double kSameShare = 1e-9;  // of a covariance
  constexpr std::string_view kNumber = "+-.0123456789eE";
  const auto take = [&](std::string_view& text, bool number) {
    const std::size_t end = std::min(
        text.size(), number ? text.find_first_not_of(kNumber) : text.find_first_of(kNumber));
    const std::string_view token = text.substr(0, end);
    text.remove_prefix(end);
    return token;
  };
  for (bool number = false; !a.empty() || !b.empty(); number = !number) {
    const std::string_view one = take(a, number);
    const std::string_view other = take(b, number);
    if (one == other) continue;
    const auto x = core::parse_number(one);
    const auto y = core::parse_number(other);
    if (!number || !x || !y) return false;
    if (!(std::abs(*x - *y) <= kSame_um + kSameShare * std::abs(*x))) return false;
  }
  return true;
}

}  // namespace

HandedCalibration handed_calibration(const FeatureResult& result) {
  if (!result.analysis) {
    return {
        "{\"format\": \"none\", \"note\": \"the fixture was not calibrated, see report.json\"}\n",
        result.failure ? result.failure->said() : core::phrase("there is no result")};
  }
  const auto& facts = std::get<RotaryResult>(result.analysis->found);
  if (!facts.withheld) return {fixture::calibration_text(facts.calibration), std::nullopt};
  return {"{\"format\": \"none\", \"note\": \"the calibration does not hold, see report.json\"}\n",
          facts.withheld};
}

void hold_against(const FeatureResult& source, const std::string* taken, FixtureUse& use) {
  const HandedCalibration found = handed_calibration(source);
  if (found.void_because) {
    use.invalid = core::error_of(core::Code::kCalibration,
                                 core::phrase("{}, which calibrates the fixture, is void: {}",
                                              source.feature.id, *found.void_because));
  } else if (taken != nullptr && !same_calibration(*taken, found.text)) {
    use.invalid = core::error_of(
        core::Code::kCalibration,
        core::phrase("the run took another calibration of the fixture than the touches of {} give",
                     source.feature.id));
  }
}

}  // namespace rondure::evaluation
