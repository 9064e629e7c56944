#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "record/run_record.h"

namespace rondure::record {

/// What holds for every characteristic of a form.
struct FormFacts {
  Form form = Form::kCylindricity;
  std::string_view symbol;  ///< In reports, e.g. "CYLt".
  /// Shape of the reference that a plan may choose; none: there is nothing to choose.
  std::optional<Shape> about = std::nullopt;
};

/// One row for each form, in the order of the enumerators.
inline constexpr auto kFormFacts =
    std::to_array<FormFacts>({{Form::kCylindricity, "CYLt", Shape::kCylinder},
                              {Form::kRoundness, "RONt", Shape::kCircle},
                              {Form::kDiameter, "d"},
                              {Form::kStraightness, "STRt"},
                              {Form::kGeneratrixParallelism, "GPRt"},
                              {Form::kTaper, "CYLtt"},
                              {Form::kFlatness, "FLTt"},
                              {Form::kCoaxiality, "COAX"},
                              {Form::kConcentricity, "CONC"},
                              {Form::kParallelism, "PAR"},
                              {Form::kPerpendicularity, "PER"},
                              {Form::kAngularity, "ANG"},
                              {Form::kTotalRunOut, "Total run-out"},
                              {Form::kRoundnessRms, "RONq"},
                              {Form::kHarmonicLimits, "A(k)"},
                              {Form::kMotionTotal, "EM total"},
                              {Form::kMotionSynchronous, "EM sync"},
                              {Form::kMotionAsynchronous, "EM async"},
                              {Form::kRadius, "dR"},
                              {Form::kRunOut, "Run-out"},
                              {Form::kContourDeviation, "Contour"},
                              {Form::kContourSpread, "Spread"},
                              {Form::kFixtureResidual, "Left max"},
                              {Form::kFixtureResidualRms, "Left rms"}});

[[nodiscard]] constexpr const FormFacts& facts_of(Form form) {
  return kFormFacts[static_cast<std::size_t>(form)];
}

/// Whether each form has its row and its word.
[[nodiscard]] constexpr bool form_facts_are_complete() {
  for (const auto& word : words_of(Form{})) {
    const auto index = static_cast<std::size_t>(word.value);
    if (index >= kFormFacts.size() || kFormFacts[index].form != word.value) return false;
  }
  return words_of(Form{}).size() == kFormFacts.size();
}
static_assert(form_facts_are_complete());

}  // namespace rondure::record
